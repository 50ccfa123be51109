// ---- the run's page: puts table, panel, sliders and the view in three dimensions together
function startScene() {
  const scene = JSON.parse(byId("scene-data").textContent),
    bodies = scene.bodies.map((b, side) => new Body(b, side, scene.dim));
  const events = new Events(scene, bodies),
    complete = bodies.every((b) => b.complete);
  let shownId = 0; // of the event
  if (!events.count) {
    byId("scene").hidden = true;
    return null;
  }
  leaveOut(events.passes ? ".of-query" : ".of-build");
  byId("scene").classList.toggle("building", Boolean(events.passes));
  const selection = new Selection(events),
    wrappers = complete ? new Wrappers(bodies, events, scene.wrapper) : null;
  if (wrappers)
    selection.listeners.push((what) => {
      if (what === "event") wrappers.seek(selection.event);
    }); // before those who show them
  const timeline = new Timeline(events, selection),
    panel = new Panel(events, selection, wrappers);
  const filter = new EventFilter(),
    table = new EventTable(events, selection, filter),
    form = new FilterForm(events, filter, table);
  const work = new WorkIcicle(scene.work, events, filter, form, selection);
  const why = new WhyPanel(new Explanations(scene.why, events.stepNumbers.slice()), events, selection);
  const view = openView(scene, selection, wrappers, why),
    controls = view ? new ViewControls(view, selection) : null;
  byId("thinned").textContent = scene.thinned;
  byId("thinned").hidden = !scene.thinned;
  selection.listeners.push((what) => {
    if (what === "event") byId("view-caption").textContent = eventSentence(events, wrappers, selection.event);
  });
  new RowLinks(events, selection);
  const loader = new TraceLoader(scene, events, (poses) => {
    if (wrappers) wrappers.at = -1;
    if (view) view.takePoses(poses);
    form.listKinds();
    timeline.measure();
    table.refilter();
    selection.goTo(events.at(shownId));
  });
  selection.listeners.push((what) => {
    if (what === "event") shownId = events.id(selection.event);
  });
  byId("picked-events").onclick = () => {
    form.showPicked(selection.picked);
    byId("events").scrollIntoView({ block: "nearest" });
  };
  followPage(events, selection);
  listenToKeys(keysOf(timeline, table, selection, controls));
  const first = scene.firstContact >= 0 ? scene.firstContact : 0,
    asked = /^#e(\d+)$/.exec(location.hash);
  selection.goTo(events.at(asked ? Number(asked[1]) : first));
  if (view) view.frameAll(view.camera.from);
  if (controls && events.passes) controls.colourBy("region");
  if (view && new URLSearchParams(location.search).has("alone")) new Together(view, selection, events);
  return { scene, events, selection, wrappers, timeline, table, filter, form, panel, why, work, view, controls, loader };
}

/** Takes out what is about queries where a construction is shown, or the other way round. */
function leaveOut(which) {
  for (const part of document.querySelectorAll(which)) part.remove();
}

/** Returns the view; null, with the reason on the page, where there can be none. Frames are then what
    there is to see. */
function openView(scene, selection, wrappers, why) {
  const no = (reason) => {
    byId("stage").classList.add("without-view");
    byId("no-view").textContent = reason;
    byId("no-view").hidden = false;
    const pictures = byId("frames");
    if (pictures) {
      pictures.open = true;
      byId("no-view").after(pictures); // in the place of the view
    }
    return null;
  };
  const frames = data.frames.length ? " These frames show the run." : "";
  leaveOut(scene.dim === 2 ? ".of-solids" : ".of-flat");
  if (scene.tooLarge) return no(scene.tooLarge);
  if (!webglWorks())
    return no(`This browser has no WebGL, which the view in three dimensions needs.${frames}`);
  return new SceneView(scene, selection, wrappers, why);
}

function webglWorks() {
  const canvas = document.createElement("canvas");
  return Boolean(canvas.getContext("webgl") || canvas.getContext("experimental-webgl"));
}

/** Frames and charts lead to events, and the other way round; the address names the event. */
function followPage(events, selection) {
  let timer = 0;
  listeners.push(() => {
    if (moment.event >= 0 && events.at(moment.event) !== selection.event)
      selection.standAt(events.at(moment.event)); // by a frame
    clearTimeout(timer);
    timer = setTimeout(() => history.replaceState(null, "", `#e${events.id(selection.event)}`), 300);
  });
  seek = (key, value) => {
    if (key === "event") return selection.goTo(events.at(Math.max(0, Math.round(value))));
    const step = Math.max(0, lastAtMost(events.stepNumbers, Math.round(value)));
    selection.goTo(events.endOfStep(step) - 1);
  };
}

function keysOf(timeline, table, selection, controls) {
  const keys = {
    ArrowLeft: (shift) => timeline.go(() => timeline.by(shift ? -10 : -1)),
    ArrowRight: (shift) => timeline.go(() => timeline.by(shift ? 10 : 1)),
    ArrowUp: (shift) => timeline.go(() => table.step(shift ? -10 : -1)),
    ArrowDown: (shift) => timeline.go(() => table.step(shift ? 10 : 1)),
    Home: () => timeline.go(() => selection.goTo(timeline.firstHere)),
    End: () => timeline.go(() => selection.goTo(timeline.lastHere)),
    "[": () => timeline.go(() => timeline.byStep(-1)),
    "]": () => timeline.go(() => timeline.byStep(1)),
    " ": () => timeline.toggle(),
    r: (shift) => timeline.go(() => timeline.toChange(shift ? -1 : 1)),
    c: (shift) => timeline.go(() => timeline.toContact(shift ? -1 : 1)),
    "?": () => {
      const help = byId("help");
      if (help.open) help.close();
      else help.showModal();
    },
    Escape: () => {
      selection.pick(null);
      if (controls) controls.isolate(null);
    },
  };
  return controls ? { ...keys, ...controls.keys() } : keys;
}

const run = startScene();
