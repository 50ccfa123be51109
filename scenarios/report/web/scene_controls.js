// ---- buttons and keys of the view in three dimensions
const EXPLODED = 0.6; // what the key sets; the slider goes from 0 to 2

class ViewControls {
  constructor(view, selection) {
    Object.assign(this, { view, selection });
    this.listDepths();
    const change = (id, action) => byId(id).addEventListener("input", () => action(byId(id)));
    change("colour-by", (e) => this.colourBy(e.value));
    change("colour-per", (e) => view.look({ per: e.value }));
    change("colour-scope", (e) => view.look({ scope: e.value }));
    change("boxes", (e) => view.look({ boxes: Number(e.value) }));
    change("explode", (e) => this.explode(Number(e.value)));
    byId("ghost").onclick = () => this.toggle("ghost");
    byId("lids").onclick = () => this.toggle("lids");
    byId("isolate").onclick = byId("picked-isolate").onclick = () => this.isolatePicked();
    byId("proof").onclick = () => this.toggle("why");
    if (!view.camera.plane) byId("orthographic").onclick = () => this.orthographic();
    byId("frame-all").onclick = () => view.frameAll();
    byId("frame-it").onclick = byId("picked-frame").onclick = () => view.frameSelection();
    if (!view.camera.plane) byId("copy-camera").onclick = () => this.copyCamera();
    selection.listeners.push(() => this.show());
    this.show();
  }

  /** Offers the depths of boxes. Below those that the page has whole, it has the boxes above faces that were compared. */
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

  /** Shows on the buttons how things are. */
  show() {
    const { now, camera } = this.view,
      picked = this.selection.picked;
    for (const [id, on] of [
      ["ghost", now.ghost],
      ["lids", now.lids],
      ["isolate", Boolean(now.isolate)],
      ...(camera.plane ? [] : [["orthographic", camera.orthographic]]),
      ["proof", now.why],
    ])
      byId(id).setAttribute("aria-pressed", on);
    byId("isolate").disabled = !now.isolate && !(picked && picked.region !== NONE);
    byId("explode").value = now.explode;
    byId("boxes").value = now.boxes;
    byId("colour-by").value = now.by;
    for (const id of ["colour-per", "colour-scope"]) byId(id).hidden = !COUNTERS.includes(now.by);
  }

  change(what) {
    this.view.look(what);
    this.show();
  }
  toggle(name) {
    this.change({ [name]: !this.view.now[name] });
  }
  /** Most of what is tested lies inside: with counters the bodies become ghosts, until somebody wants them
      solid. */
  colourBy(by) {
    const was = COUNTERS.includes(this.view.now.by),
      is = COUNTERS.includes(by);
    this.change(was === is ? { by } : { by, ghost: is });
  }
  explode(share) {
    this.change({ explode: share, isolate: null });
    this.view.draw(); // what is framed has to be there
    this.view.frameAll();
  }
  isolate(region) {
    this.change({ isolate: region });
  }
  isolatePicked() {
    const picked = this.selection.picked;
    if (this.view.now.isolate) return this.isolate(null);
    if (!picked || picked.region === NONE) return;
    this.isolate({ side: picked.side, region: picked.region });
    this.view.frameSelection();
  }
  orthographic() {
    this.view.camera.setOrthographic(!this.view.camera.orthographic);
    this.change({});
  }
  /** Moves a choice on by so many places, round the end. */
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
    const { view } = this,
      turn = 0.09;
    const ofSolids = view.camera.plane
      ? {}
      : {
          o: () => this.orthographic(),
          v: () => this.copyCamera(),
          a: () => view.camera.turn(-turn, 0),
          d: () => view.camera.turn(turn, 0),
          e: () => view.camera.turn(0, turn),
          q: () => view.camera.turn(0, -turn),
        };
    return {
      ...ofSolids,
      g: () => this.toggle("ghost"),
      w: () => this.toggle("lids"),
      x: () => this.explode(view.now.explode > 0 ? 0 : EXPLODED),
      i: () => this.isolatePicked(),
      n: (shift) => this.cycle("boxes", shift ? -1 : 1),
      k: (shift) => this.cycle("colour-by", shift ? -1 : 1),
      f: (shift) => (shift ? view.frameAll() : view.frameSelection()),
      y: () => this.toggle("why"),
      "+": () => view.camera.zoom(1.2),
      "=": () => view.camera.zoom(1.2),
      "-": () => view.camera.zoom(1 / 1.2),
    };
  }
}
