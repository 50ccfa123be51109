import { byId, copyText, digits, Playback } from "./dom.js";
import { COUNTERS } from "./scene_colours.js";

// ---- the time line: sliders over steps and over the events of a step, buttons, and playback
export class Timeline {
  constructor(events, selection) {
    Object.assign(this, { events, selection });
    this.stepSlider = byId("step");
    this.eventSlider = byId("event");
    this.playback = new Playback(byId("play-events"), byId("play-speed"), () => this.next(),
        () => (byId("play-what").value === "step" ? this.toStep(0) : selection.goTo(this.firstHere)));
    this.measure();
    this.stepSlider.oninput = () => this.go(() => this.toStep(Number(this.stepSlider.value)));
    this.eventSlider.oninput = () =>
      this.go(() => selection.goTo(this.firstHere + Number(this.eventSlider.value)));
    const buttons = {
      "step-back": () => this.byStep(-1),
      "step-next": () => this.byStep(1),
      "event-back": () => this.by(-1),
      "event-next": () => this.by(1),
    };
    for (const [id, action] of Object.entries(buttons)) byId(id).onclick = () => this.go(action);
    selection.on("event", () => this.show());
  }

  /** Sets the slider's length to the number of steps. */
  measure() {
    this.stepSlider.max = this.events.firstOfStep.length - 1;
    byId("step-row").hidden = this.events.firstOfStep.length < 2;
  }

  get step() {
    return this.events.step(this.selection.event);
  }
  get firstHere() {
    return this.events.firstOfStep[this.step];
  }
  get lastHere() {
    return this.events.endOfStep(this.step) - 1;
  }

  /** Runs an action of the user: playback stops. */
  go(action) {
    this.playback.pause();
    action();
  }
  by(n) {
    this.selection.goTo(this.selection.event + n);
  }
  /** Moves to the end of a step, which has its answer. */
  toStep(step) {
    this.selection.goTo(
      this.events.endOfStep(Math.max(0, Math.min(this.events.firstOfStep.length - 1, step))) - 1,
    );
  }
  byStep(n) {
    this.toStep(this.step + n);
  }
  /** Moves to the next event, or the previous one, that passes. Does not move if there is no such event. */
  find(passes, way = 1) {
    for (let i = this.selection.event + way; i >= 0 && i < this.events.count; i += way)
      if (passes(i)) return this.selection.goTo(i);
  }
  toChange(way) {
    this.find((i) => this.events.changesWrapper(i) || this.events.kind[i] === this.events.STEP, way);
  }
  toContact(way) {
    this.find((i) => this.events.kind[i] === this.events.CONTACT, way);
  }

  show() {
    const { events, selection } = this;
    this.stepSlider.value = this.step;
    this.eventSlider.max = this.lastHere - this.firstHere;
    this.eventSlider.value = selection.event - this.firstHere;
    const [first, last] = [0, -1].map((at) => digits(events.stepNumbers.at(at)));
    byId("step-count").textContent = `step ${digits(events.stepNumber(selection.event))} (${first}–${last})`;
    const [here, all] = [selection.event, this.lastHere].map((i) => digits(i - this.firstHere + 1));
    byId("event-place").textContent = events.firstOfStep.length > 1 ? `event ${here} / ${all}`
        : `event ${digits(events.id(selection.event))} (0–${digits(events.id(this.lastHere))})`;
  }

  // -- playback: the wrappers of this step are refined, one region after the other; or all events; or the
  // steps
  /** Returns the function that moves on by one; null at the end. */
  next() {
    const what = byId("play-what").value, end = this.lastHere;
    if (what === "step") return this.step + 1 < this.events.firstOfStep.length ? () => this.byStep(1) : null;
    const stops = (i) =>
      what === "pass" ? this.events.kind[i] === this.events.PASS_END : this.events.changesWrapper(i);
    for (let i = this.selection.event + 1; i <= end; i++)
      if (what === "event" || i === end || stops(i)) return () => this.selection.goTo(i);
    return null;
  }
}

/** Opens or closes the list of keys, from its start: its button at the end has the focus. */
export function toggleHelp() {
  const help = byId("help");
  if (help.open) return help.close();
  help.showModal();
  help.scrollTop = 0;
}

// ---- buttons and keys of the 3D view
const EXPLODE_BY = 0.1, SLICE_BY = 0.02; // by which a key changes its slider, which goes from 0 to 1

export class ViewControls {
  constructor(view, selection) {
    Object.assign(this, { view, selection });
    this.listDepths();
    const change = (id, action) => byId(id).addEventListener("input", () => action(byId(id)));
    change("colour-by", (e) => this.colourBy(e.value));
    change("colour-per", (e) => this.change({ per: e.value }));
    change("colour-scope", (e) => this.change({ scope: e.value }));
    change("boxes", (e) => this.change({ boxes: Number(e.value) }));
    change("explode", (e) => this.explode(Number(e.value)));
    if (!view.camera.plane) change("slice", (e) => this.slice(Number(e.value)));
    byId("ghost").onclick = () => this.toggle("ghost");
    byId("lids").onclick = () => this.toggle("lids");
    if (!view.camera.plane) byId("open").onclick = () => this.toggle("open");
    byId("isolate").onclick = byId("picked-isolate").onclick = () => this.isolatePicked();
    byId("proof").onclick = () => this.toggle("why");
    if (!view.camera.plane) byId("orthographic").onclick = () => this.orthographic();
    byId("frame-all").onclick = () => view.frameAll();
    byId("frame-it").onclick = byId("picked-frame").onclick = () => view.frameSelection();
    if (!view.camera.plane) byId("copy-camera").onclick = () => this.copyCamera();
    selection.listeners.push(() => this.show());
    this.show();
  }

  /** Lists the depths of boxes. Below those that the page has in full, it has only the boxes above faces
      that were compared. */
  listDepths() {
    const { bodies } = this.view,
      deepest = bodies.reduce((most, b) => b.boxes.depth.reduce((m, d) => Math.max(m, d), most), 0);
    for (let depth = 0; depth <= deepest; depth++) {
      const whole = bodies.every((b) => depth <= b.boxes.whole || depth >= b.boxes.atDepth.length),
        here = bodies.reduce((n, b) => n + b.boxes.depth.reduce((m, d) => m + (d === depth), 0), 0),
        all = bodies.reduce((n, b) => n + (b.boxes.atDepth[depth] || 0), 0);
      const words = depth === 0 ? "depth 0, the root" : `depth ${depth}`;
      byId("boxes").append(new Option(whole ? words : `${words}: ${digits(here)} of ${digits(all)}`, depth));
    }
    byId("boxes").title = "The boxes of the tree's nodes; of deep ones those above faces that were compared";
  }

  /** Updates the buttons to the current state. */
  show() {
    const { now, camera } = this.view, picked = this.selection.picked;
    for (const [id, on] of [
      ["ghost", now.ghost], ["lids", now.lids], ["isolate", Boolean(now.isolate)],
      ...(camera.plane ? [] : [["orthographic", camera.orthographic], ["open", now.open]]),
      ["proof", now.why],
    ])
      byId(id).setAttribute("aria-pressed", on);
    byId("isolate").disabled =
        !now.isolate && !(picked && this.view.bodies[picked.side].hasLids(picked.region));
    byId("explode").value = now.explode;
    if (!camera.plane) byId("slice").value = now.slice;
    byId("boxes").value = now.boxes;
    byId("colour-by").value = now.by;
    byId("colour-per").value = now.per;
    byId("colour-scope").value = now.scope;
    for (const id of ["colour-per", "colour-scope"]) byId(id).hidden = !COUNTERS.includes(now.by);
  }

  /** Changes the view's display state; listeners of the selection are notified. */
  change(what) {
    this.view.look(what);
    this.selection.tell("look");
  }
  toggle(name) {
    this.change({ [name]: !this.view.now[name] });
  }
  /** Most tested faces lie inside: with counters the bodies become ghosts, until the user makes them
      opaque. */
  colourBy(by) {
    const was = COUNTERS.includes(this.view.now.by), is = COUNTERS.includes(by);
    this.change(was === is ? { by } : { by, ghost: is });
  }
  explode(share) {
    const { view } = this, { fitted } = view.camera;
    this.change({ explode: Math.max(0, Math.min(1, Number(share.toFixed(2)))), isolate: null });
    view.draw(); // the framed objects must exist
    if (fitted) view.frameAll();
  }
  slice(share) {
    this.change({ slice: Math.max(0, Math.min(1, Number(share.toFixed(3)))) });
  }
  /** Shows a region alone and frames it; null: everything again, from where it was seen before. */
  isolate(region) {
    const { view } = this, { now, camera } = view;
    if (region && !now.isolate) this.seenFrom = { camera: camera.json(), fitted: camera.fitted };
    const ends = !region && now.isolate;
    this.change({ isolate: region });
    if (region) view.frame(view.collector(region));
    else if (ends && this.seenFrom) {
      camera.set(this.seenFrom.camera);
      camera.fitted = this.seenFrom.fitted;
    } else if (ends) view.frameAll();
  }
  isolatePicked() {
    const picked = this.selection.picked;
    if (this.view.now.isolate) return this.isolate(null);
    if (picked && this.view.bodies[picked.side].hasLids(picked.region))
      this.isolate({ side: picked.side, region: picked.region });
  }
  orthographic() {
    this.view.camera.setOrthographic(!this.view.camera.orthographic);
    this.change({});
  }
  /** Advances a choice by `by` entries, cyclically. */
  cycle(id, by) {
    const select = byId(id);
    select.selectedIndex = (select.selectedIndex + by + select.length) % select.length;
    select.dispatchEvent(new Event("input"));
  }

  async copyCamera() {
    const text = JSON.stringify(this.view.camera.json());
    byId("camera-json").textContent = text;
    byId("camera").hidden = false;
    const copied = await copyText(text, byId("camera-json"));
    byId("camera-note").textContent =
      `${copied ? "Copied. " : ""}Put it into "frames": {"views": [...]} of a scenario.`;
  }

  keys() {
    const { view } = this, turn = 0.09;
    const ofSolids = view.camera.plane ? {}
      : {
          o: () => this.orthographic(),
          v: () => this.copyCamera(),
          a: () => view.camera.turn(-turn, 0),
          d: () => view.camera.turn(turn, 0),
          e: () => view.camera.turn(0, turn),
          q: () => view.camera.turn(0, -turn),
          s: (shift) => this.slice(view.now.slice + (shift ? -SLICE_BY : SLICE_BY)),
          z: () => this.toggle("open"),
        };
    return {
      ...ofSolids,
      g: () => this.toggle("ghost"),
      w: () => this.toggle("lids"),
      x: (shift) => this.explode(view.now.explode + (shift ? -EXPLODE_BY : EXPLODE_BY)),
      i: () => this.isolatePicked(),
      n: (shift) => this.cycle("boxes", shift ? -1 : 1),
      k: (shift) => this.cycle("colour-by", shift ? -1 : 1),
      j: () => this.cycle("colour-per", 1),
      u: () => this.cycle("colour-scope", 1),
      f: (shift) => (shift ? view.frameAll() : view.frameSelection()),
      y: () => this.toggle("why"),
      "+": () => view.camera.zoom(1.2),
      "=": () => view.camera.zoom(1.2),
      "-": () => view.camera.zoom(1 / 1.2),
    };
  }
}
