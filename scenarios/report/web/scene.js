import { byId, digits, listenToKeys } from "./dom.js";
import { data, listeners, moment, seek, seekBy, tell } from "./page.js";
import { ProofMap } from "./proof_map.js";
import { AttemptPanel, Attempts } from "./scene_attempts.js";
import { Timeline, toggleHelp, ViewControls } from "./scene_controls.js";
import { concernsPicked, EventFilter, EventTable, FilterForm } from "./scene_events.js";
import { explainCells, PageAddress, printView, showMore, stripOfRun, Tabs } from "./scene_page.js";
import { AnswerLine, Panel, RowLinks, Selection } from "./scene_panels.js";
import { Body, Events, eventSentence, Explanations, lastAtMost, NONE, SIDES } from "./scene_run.js";
import { poseInPage, tellingEvent, Wrappers } from "./scene_run.js";
import { SceneView, webglWorks } from "./scene_view.js";
import { WhyPanel } from "./scene_why.js";
import { WorkIcicle } from "./scene_work.js";

// ---- all events of a run whose page has only some: loaded from its trace, which the user chooses or drops
// here. Pages from disk cannot fetch it.
class TraceLoader {
  /** `loaded`: called when the events have been replaced. */
  constructor(scene, events, loaded) {
    Object.assign(this, { scene, events, loaded });
    if (!scene.thinned || !scene.trace) return;
    byId("load").hidden = false;
    byId("load-button").textContent = `load ${scene.trace}`;
    byId("load-button").onclick = () => byId("load-file").click();
    byId("load-file").onchange = () => this.open(byId("load-file").files[0]);
    for (const type of ["dragover", "drop"])
      document.addEventListener(type, (e) => {
        e.preventDefault();
        if (type === "drop" && e.dataTransfer.files.length) this.open(e.dataTransfer.files[0]);
      });
  }

  say(text) {
    byId("load-state").textContent = text;
  }

  async open(file) {
    if (!file) return;
    this.say(`reading ${file.name} \u2026`);
    try {
      const packed = file.name.endsWith(".gz"),
        stream = packed ? file.stream().pipeThrough(new DecompressionStream("gzip")) : file.stream();
      this.take(JSON.parse(await new Response(stream).text()));
      this.say("");
    } catch (e) {
      this.say(`${file.name}: ${e.message}`);
    }
  }

  /** Replaces the page's events by those in a trace. Throws if the trace is of another run. */
  take(trace) {
    const { scene, events } = this, metadata = trace.metadata;
    if (!metadata || metadata.format !== "lrbscope trace") throw new Error("this is no trace of lrbscope's");
    const slices = trace.traceEvents.filter((e) => e.ph === "X" && e.args && e.args.event !== undefined),
      same = metadata.bodies.every((b, i) => scene.bodies[i] && scene.bodies[i].hash === b.hash);
    if (!same || slices.length !== scene.allEvents) throw new Error("this is the trace of another run");
    const read = new TraceReader(scene, events.kinds, metadata);
    const columns = read.columns(slices);
    for (let i = 0; i < events.count; i++) {
      const id = events.id(i);
      if (["kind", "a", "b"].some((name) => this.known(i, name) && columns[name][id] !== events[name][i]))
        throw new Error("this is the trace of another run");
    }
    events.replace(columns);
    this.loaded(read.poses());
    byId("load").hidden = true;
    byId("thinned").textContent = `All ${digits(events.count)} events of the trace are here.`;
  }

  /** Unnamed numbers are not in a trace. */
  known(i, name) {
    return name === "kind" || this.events.kindOf(i)[name].words !== "";
  }
}

/** Reads the events of a trace's JSON (trace.schema.json) into columns as scene_json.cpp packs them. */
class TraceReader {
  constructor(scene, kinds, metadata) {
    Object.assign(this, { scene, metadata, kinds });
    this.kindByName = new Map(kinds.map((k, i) => [k.name, i]));
    this.words = [];
    this.parts = new Map((scene.work?.outcomes || []).map((o, i) => [`${o.phase}: ${o.outcome}`, i]));
    this.walk = metadata.request.recursion === "complete" ? "walk of the bodies" : "recursion";
  }

  columns(slices) {
    const names = "kind side meet a b cause boundary depthA depthB outcome work".split(" "),
      out = Object.fromEntries(names.map((name) => [name, new Uint32Array(slices.length)])),
      steps = [];
    for (const slice of slices) {
      const i = slice.args.event, event = this.event(slice);
      for (const name of names) out[name][i] = event[name];
      if (slice.args["time step"] !== undefined) steps.push([slice.args["time step"], i]);
    }
    steps.sort((p, q) => p[1] - q[1]);
    const patches = slices.filter((s) => s.name === "patch").sort((p, q) => p.args.event - q.args.event);
    return {
      ...out,
      patches: {
        counts: Uint32Array.from(patches, (s) => (s.args.vertices || []).length),
        vertices: Uint32Array.from(patches.flatMap((s) => s.args.vertices || [])),
      },
      count: slices.length,
      ids: null,
      outcomes: this.words,
      stepNumbers: Uint32Array.from(steps, (s) => s[0]),
      firstOfStep: Uint32Array.from(steps, (s) => s[1]),
    };
  }

  event(slice) {
    const { args } = slice, kind = this.kindOf(slice), { a, b } = this.kinds[kind],
      orNone = (n) => (n === undefined ? NONE : n);
    return {
      kind,
      side: Math.max(0, SIDES.indexOf(args.side || args.of || args["plane of"])),
      meet: Math.max(0, this.scene.meets.indexOf(args.meet)),
      a: this.number(args, a.words),
      b: this.number(args, b.words),
      cause: orNone(args.cause),
      boundary: orNone(args["wrapper faces"]),
      depthA: args["depth of A"] || args["interior vertices"] || 0,
      depthB: args["depth of B"] || 0,
      outcome: this.word(args.meet || args.where || args.verdict || args.stage || args.step),
      work: this.part(slice, this.kinds[kind].name),
    };
  }

  /** Steps, passes and phases are named by their result; all others by their kind. */
  kindOf({ name, cat }) {
    const named = { step: "step", phase: "begin", pass: "pass" }[cat];
    return this.kindByName.has(name) ? this.kindByName.get(name) : this.kindByName.get(named);
  }

  number(args, words) {
    if (words === "") return 0;
    let value = args[words];
    if (value === undefined) value = args[words.replace("real", "pseudo")]; // of an approximate answer
    if (words === "relation") return this.scene.relations.indexOf(value);
    if (words === "phase") return this.scene.phases.indexOf(value);
    return value === undefined ? NONE : value;
  }

  word(word) {
    if (!word) return NONE;
    if (!this.words.includes(word)) this.words.push(word);
    return this.words.indexOf(word);
  }

  /** Returns the part of the work that an event is, as trace/work.cpp has it; NONE: none. */
  part({ args }, kind) {
    if (kind === "begin") {
      const walk = { "tree walk": "walk of the bodies", "cache making": "cache making" }[args.phase];
      if (walk) this.walk = args["level of A"] > 0 || args["level of B"] > 0 ? "walk of levels" : walk;
      if (["cached pairs", "wrappers kept"].includes(args.phase)) this.walk = "cached pairs";
    }
    const of = (phase, outcome) => this.parts.get(`${phase}: ${outcome}`) ?? NONE;
    switch (kind) {
      case "node pair":
        return of(this.walk, args.step === "leaves"
            ? (this.scene.engine ? "boxes of leaves" : "boxes and planes of faces") : "boxes of nodes");
      case "plane test":
        return of(this.walk, "boxes and planes of faces");
      case "face test":
        return of(this.walk, args["decided by"] ? `face tests: ${args["decided by"]}` : "face tests");
      case "refine":
      case "coarsen":
        return of(this.walk, "wrappers refined");
      case "point":
        return of("relation", "");
      case "end":
        return args.phase === "cache making" ? of("cache making", "pairs kept") : of(args.phase, "");
    }
    return NONE;
  }

  /** Returns the poses of each body at all steps in the page's frame, as scene_json.cpp does. */
  poses() {
    return this.scene.bodies.map((_, side) =>
      Float32Array.from(this.metadata.steps.flatMap((step) =>
          poseInPage(side === 0 ? step.pose_a : step.pose_b, side, this.scene))),
    );
  }
}

// ---- the same view beside another run's, in a page that compares them (index.html?alone in a frame): common
// camera and step
class Together {
  constructor(view, selection, events, map) {
    Object.assign(this, { view, selection, events, map });
    this.listening = false; // while applying the other view's state: not to be sent back
    document.documentElement.classList.add("alone");
    view.camera.controls.addEventListener("change", () => this.tell({ camera: view.camera.json() }));
    selection.on("event", () => this.tell({ step: this.step }));
    window.addEventListener("message", (e) => e.source === parent && e.data?.lrbscope
        && this.hear(e.data.lrbscope));
    this.tell({ camera: view.camera.json(), step: this.step }); // the view that is created last sets both
    if (!map) return;
    this.tell({ hasMap: true });
    map.listeners.push((what) => this.tell(what));
  }

  get step() {
    return this.events.stepNumber(this.selection.event);
  }

  tell(what) {
    if (!this.listening) parent.postMessage({ lrbscope: what }, "*");
  }

  hear({ camera, step, region, window, mapping }) {
    if (region !== undefined) return this.showRegion(region);
    this.listening = true;
    if (mapping !== undefined && this.map) {
      byId("scene").append(this.map.box);
      document.documentElement.classList.toggle("mapping", mapping);
      if (mapping) seek("step", this.step); // to its end
      this.map.redraw();
    }
    if (window) this.map?.show(window);
    if (camera) this.view.camera.set(camera);
    if (step !== undefined && step !== this.step) seek("step", step);
    this.listening = false;
  }

  /** Selects a region, and frames it just after it was made or before it is refined; null: selects none. */
  showRegion(region) {
    const { events, selection, view } = this;
    if (region === null) return selection.pick(null);
    if (!view.bodies[0].complete || region >= view.bodies[0].regionCount) return;
    for (let i = 0; i < events.count; i++)
      if (events.kind[i] === (events.passes ? events.REGION : events.REFINE) && events.a[i] === region) {
        selection.goTo(events.passes ? i : Math.max(0, i - 1));
        break;
      }
    selection.pickRegion(0, region);
    view.frameSelection();
  }
}

// ---- the run's page: connects table, panel, sliders and the 3D view
function startScene() {
  const scene = JSON.parse(byId("scene-data").textContent),
    bodies = scene.bodies.map((b, side) => new Body(b, side, scene.dim));
  const events = new Events(scene, bodies),
    complete = bodies.every((b) => b.complete);
  if (scene.attempts) events.attempts = new Attempts(events, scene.attempts);
  let shownId = 0; // of the current event
  if (!events.count) {
    byId("scene").hidden = true;
    return null;
  }
  leaveOut(events.passes ? ".of-query" : ".of-build");
  if (events.engine) {
    leaveOut(".of-wrappers"); // another engine has none
    leaveOut(".about"); // nor the terms that the tab Words explains
    for (const part of document.querySelectorAll(".of-regions")) part.hidden = true;
    byId("scene").classList.add("of-engine");
    document.querySelector(".row.head span:nth-child(6)").removeAttribute("title"); // levels, not shown
  }
  byId("scene").classList.toggle("building", Boolean(events.passes));
  const selection = new Selection(events),
    wrappers = complete ? new Wrappers(bodies, events, scene.wrapper) : null;
  if (wrappers) // before the listeners that display them
    selection.onContent(() => wrappers.seek(selection.event, selection.resolved));
  const timeline = new Timeline(events, selection), panel = new Panel(events, selection, wrappers);
  const filter = new EventFilter(), table = new EventTable(events, selection, filter),
    form = new FilterForm(events, filter, table);
  const work = new WorkIcicle(scene.work, events, filter, form, selection);
  const why = new WhyPanel(new Explanations(scene.why, events.stepNumbers.slice()), events, selection);
  const attempts = events.attempts ? new AttemptPanel(events.attempts, selection) : null;
  const view = openView(scene, selection, wrappers, why),
    controls = view ? new ViewControls(view, selection) : null;
  byId("thinned").textContent = scene.thinned;
  byId("thinned").hidden = !scene.thinned;
  selection.onContent(() => {
    byId("view-caption").textContent = eventSentence(events, wrappers, selection.event);
  });
  new RowLinks(events, selection, controls);
  new AnswerLine(scene.answers, events, selection);
  const strip = stripOfRun(scene, events, selection, work.ofStep || new Map());
  const map = scene.map ? new ProofMap(scene, events, selection, view) : null;
  why.map = map;
  const tabs = new Tabs();
  tabs.listeners.push(() => table.follow());
  explainCells();
  if (view) printView(view);
  for (const row of document.querySelectorAll(".tools, .keys, header .numbers")) showMore(row);
  showMore(document.querySelector(".panel"));
  selection.on("pick", () => markAbout(events, selection));
  const loader = new TraceLoader(scene, events, (poses) => {
    if (wrappers) wrappers.at = -1;
    if (view) view.takePoses(poses);
    form.listKinds();
    timeline.measure();
    table.refilter();
    selection.goTo(events.at(shownId));
    if (attempts) selection.pick(selection.picked);
  });
  selection.on("event", () => (shownId = events.id(selection.event)));
  const listPicked = () => {
    if (!selection.picked) return;
    form.showPicked(selection.picked);
    tabs.show("Events");
    byId("events").scrollIntoView({ block: "nearest" });
  };
  byId("picked-events").onclick = listPicked;
  if (byId("resolve")) byId("resolve").onclick = () => selection.resolve();
  byId("help-open").onclick = toggleHelp;
  followPage(events, selection);
  const keys = { ...keysOf(timeline, table, selection, controls), ...keysOfTabs(tabs, listPicked) };
  listenToKeys(attempts ? { ...keys, ...keysOfAttempts(attempts) } : keys);
  if (controls && events.passes) {
    controls.colourBy("region");
    view.opened = { ...view.now };
  }
  selection.goTo(tellingEvent(events));
  const [wrong] = events.wrong[events.step(selection.event)];
  if (wrong) {
    // The test that rejected it, if the page has its event.
    const test = map ? map.decision(wrong.simplices) : null, at = test ? events.find(test.event) : -1;
    if (at >= 0) selection.goTo(at);
    selection.choose(wrong.simplices);
  }
  if (view) view.frameAll(view.camera.from);
  const address = new PageAddress({ events, selection, view, controls, tabs });
  if (location.hash.length > 1) address.read();
  if (view && new URLSearchParams(location.search).has("alone")) new Together(view, selection, events, map);
  return { scene, events, map, selection, wrappers, timeline, table, filter, form, panel, why, work,
      attempts, view, controls, loader, strip, tabs, address };
}

/** Removes the elements about queries if a construction is shown, and vice versa. */
function leaveOut(which) {
  for (const part of document.querySelectorAll(which)) part.remove();
}

/** Returns the 3D view. Returns null, with the reason on the page, if it is not available; the page then
    shows the frames. */
function openView(scene, selection, wrappers, why) {
  const no = (reason) => {
    byId("stage").classList.add("without-view");
    byId("no-view").textContent = reason;
    byId("no-view").hidden = false;
    const pictures = byId("frames");
    if (pictures) byId("no-view").after(pictures); // to the position of the view
    return null;
  };
  const frames = data.frames.length ? " These frames show the run." : "";
  leaveOut(scene.dim === 2 ? ".of-solids" : ".of-flat");
  if (scene.tooLarge) return no(scene.tooLarge);
  if (!webglWorks())
    return no(`This browser has no WebGL, which the view in three dimensions needs.${frames}`);
  return new SceneView(scene, selection, wrappers, why);
}

/** Marks the events of the selected face or region on the charts. */
function markAbout(events, selection) {
  const { picked } = selection, about = [];
  for (let i = 0; picked && i < events.count; i++) if (concernsPicked(events, i, picked)) about.push(i);
  moment.about = { event: about.map((i) => events.id(i)),
      step: [...new Set(about.map((i) => events.stepNumber(i)))] };
  tell();
}

/** Links frames and charts to events, and vice versa. */
function followPage(events, selection) {
  listeners.push(() => {
    if (moment.event >= 0 && events.at(moment.event) !== selection.event)
      selection.standAt(events.at(moment.event)); // set by a frame
  });
  seekBy((key, value) => {
    if (key === "event") return selection.goTo(events.at(Math.max(0, Math.round(value))));
    const step = Math.max(0, lastAtMost(events.stepNumbers, Math.round(value)));
    selection.goTo(events.endOfStep(step) - 1);
  });
}

function keysOfAttempts(panel) {
  return {
    p: () => panel.attempts.pickPlace(panel.selection.event, panel.selection),
    h: (shift) => panel.step(shift ? -1 : 1),
    b: () => panel.flip(),
  };
}

function keysOfTabs(tabs, listPicked) {
  const numbered = tabs.names.slice(0, 9).map((name, i) => [String(i + 1), () => tabs.toggle(name)]);
  return { ...Object.fromEntries(numbered), t: () => tabs.toggleHeight(), l: listPicked };
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
    " ": () => timeline.playback.toggle(),
    m: () => selection.resolve(),
    r: (shift) => timeline.go(() => timeline.toChange(shift ? -1 : 1)),
    c: (shift) => timeline.go(() => timeline.toContact(shift ? -1 : 1)),
    "?": toggleHelp,
    Escape: () => {
      selection.pick(null);
      if (controls && controls.view.now.isolate) controls.isolate(null);
    },
  };
  return controls ? { ...keys, ...controls.keys() } : keys;
}

export const run = startScene();
