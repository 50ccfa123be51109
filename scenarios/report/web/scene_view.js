import { byId, oncePerFrame } from "./dom.js";
import { BodyView } from "./scene_bodies.js";
import { Colours, COUNTERS, countsSoFar, sumsOfGroups } from "./scene_colours.js";
import { Glass } from "./scene_faces.js";
import { SceneCamera } from "./scene_camera.js";
import { ContactCurves, Legend, Marks, MeasuredMarks, WhyMarks } from "./scene_marks.js";
import { lensOf, setHoles } from "./scene_lines.js";
import { NONE, unpack } from "./scene_run.js";

// ---- clicks in the view: picks the face
/** Calls `action` for clicks on a canvas, but not at the end of a rotation. */
export function onClick(canvas, action) {
  let down = null;
  canvas.addEventListener("pointerdown", (e) => (down = [e.clientX, e.clientY]));
  canvas.addEventListener("click", (e) => {
    if (!down || Math.hypot(e.clientX - down[0], e.clientY - down[1]) <= 4) action(e);
  });
}

class Picker {
  constructor(view) {
    this.view = view;
    const { canvas, selection } = view;
    onClick(canvas, (e) => {
      const hit = this.under(e.clientX, e.clientY, e.altKey),
        vertex = hit && selection.events.attempts ? this.vertexNear(hit, e.clientX, e.clientY) : NONE;
      if (vertex !== NONE) selection.pickVertex(hit.side, vertex);
      else if (hit) selection.pickFace(hit.side, hit.face, hit.simplex, this.realFaceUnder(hit, e));
      else selection.pick(null);
    });
    canvas.addEventListener("dblclick", (e) => {
      if (this.under(e.clientX, e.clientY, e.altKey)) view.frameSelection();
      else view.frameAll();
    });
  }

  /** Returns a face's corner next to a point of the screen, at most a third of an edge away; NONE: none. */
  vertexNear({ side, face }, x, y) {
    const { view } = this, body = view.bodies[side], box = view.canvas.getBoundingClientRect(),
      most = 9; // pixels
    const corners = [...body.face(face)].map((vertex) => {
      const at = view.views[side].toWorld(view.views[side].point(vertex)).project(view.camera.camera);
      const [right, down] = [(1 + at.x) / 2, (1 - at.y) / 2];
      return { vertex, x: box.left + right * box.width, y: box.top + down * box.height };
    });
    const edges = corners.map((p, i) => Math.hypot(p.x - corners.at(i - 1).x, p.y - corners.at(i - 1).y));
    const reach = Math.min(most, Math.min(...edges) / 3);
    const near = corners.find((p) => Math.hypot(p.x - x, p.y - y) <= reach);
    return near ? near.vertex : NONE;
  }

  /** Returns the body's own face that a lid hides at a place of the screen; without one, or if the lid is
      away from the body, the lid. */
  realFaceUnder({ side, face }, { clientX, clientY }) {
    const { view } = this, isAway = view.now.explode > 0 && !view.now.isolate,
      real = isAway ? null : view.nearest(clientX, clientY, [view.views[side].real]);
    return real && !view.bodies[side].isReal(face) ? real.face : face;
  }

  /** Returns the face under a point of the screen, {side, face, simplex}; `through`: lids are ignored. */
  under(x, y, through = false) {
    const { view } = this, { views, now } = view;
    const pieces = views.flatMap((v) => v.pieces);
    const lids = through ? [] : views.filter((v) => v.lids.mesh.visible).map((v) => v.lids);
    const real = views.map((v) => v.real);
    if (now.isolate) return view.nearest(x, y, pieces) || view.nearest(x, y, real);
    // A ghost's real faces are picked only if no lids are visible.
    return now.ghost && lids.length ? view.nearest(x, y, lids)
      : view.nearest(x, y, [...pieces, ...lids, ...real]);
  }
}

export function webglWorks() {
  const canvas = document.createElement("canvas");
  return Boolean(canvas.getContext("webgl") || canvas.getContext("experimental-webgl"));
}

// ---- the bodies on a canvas that follows the size of its frame. In subclasses, draw() ends with render()
export class BodiesCanvas {
  constructor(scene, bodies) {
    Object.assign(this, { bodies, canvas: byId("view-canvas"), colours: new Colours(scene.colours) });
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.size = new THREE.Vector2(1, 1);
    /** For the shaders of lines: size of the picture in pixels; depth of the front of the bodies, and from
        there to their back; size of a pixel in the world; holes in wrappers. */
    this.lens = lensOf(this.size);
    this.stage = new THREE.Scene();
    this.camera = new SceneCamera(this.canvas, scene, () => this.redraw());
    this.stage.add(new THREE.AmbientLight(0xffffff, 0.54), this.camera.perspective, this.camera.flat);
    this.views = bodies.map((b) => new BodyView(b, this.colours, this.lens));
    this.views.forEach((v) => this.stage.add(v.group));
    this.glass = new Glass(this.views[0].materials.lids);
    this.stage.add(this.glass.mesh);
    this.marks = new Marks(this.views, this.colours, this.lens);
    this.legend = new Legend(this);
  }

  /** Called by a subclass once it can draw. */
  start() {
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    this.canvas.addEventListener("webglcontextlost", (e) => e.preventDefault()); // it is restored later
    this.canvas.addEventListener("webglcontextrestored", () => this.redraw());
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.size.set(width, height);
    this.renderer.setSize(width, height, false);
    this.camera.resize(width, height);
    if (this.camera.fitted) this.camera.fit(this.extremes());
    this.redraw();
  }

  redraw = oncePerFrame(() => this.draw());
  draw() {
    this.render();
  }

  render() {
    const { camera, lens } = this, ball = this.reach(), { radius } = ball;
    lens.pixel.value = (2 * camera.halfHeight) / this.size.y;
    lens.depths.set(camera.distance - radius, 2 * radius);
    if (camera.plane) for (const part of [...this.views, this.marks]) part.widen(lens.pixel.value);
    camera.prepare(ball, this.now ? this.now.slice : 0);
    this.stage.updateMatrixWorld();
    this.glass.show(this.views.flatMap((v) => v.panes), camera.camera.getWorldDirection(new THREE.Vector3()));
    this.renderer.render(this.stage, camera.camera);
  }

  /** Returns points that span both bodies at their current poses. */
  extremes() {
    return this.views.flatMap((view) => view.reached.map((p) => view.toWorld(p)));
  }

  /** Returns a bounding ball of them. */
  reach() {
    const points = this.extremes();
    const ball = ballOf(new THREE.Box3().setFromPoints(points));
    ball.radius = points.reduce((most, p) => Math.max(most, p.distanceTo(ball.centre)), 1e-6);
    return ball;
  }

  frameAll(from) {
    this.camera.fit(this.extremes(), from);
    this.redraw();
  }

  /** Returns true if a hit lid is cut away in front of a contact; see HOLES. */
  isCut({ object, point }) {
    const { lens } = this, { camera, orthographic } = this.camera;
    if (!this.views.some((v) => v.lids.mesh === object)) return false;
    return lens.holes.value.slice(0, lens.holeCount.value).some(({ x, y, z, w }) => {
      const centre = new THREE.Vector3(x, y, z),
        ahead = orthographic ? camera.getWorldDirection(new THREE.Vector3())
            : centre.clone().sub(camera.position).normalize(),
        [depth, until] = [point, centre].map((p) => p.clone().sub(camera.position).dot(ahead)),
        aside = point.clone().sub(centre).addScaledVector(ahead, until - depth);
      return depth < until + w && aside.length() * (orthographic ? 1 : until / depth) < w;
    });
  }

  /** Returns the nearest face of FaceMeshes at a point of the screen: {side, face, simplex}, or null. */
  nearest(x, y, among) {
    const box = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, this.camera.camera);
    const hits = ray.intersectObjects(among.filter((f) => f.triangles > 0).map((f) => f.mesh));
    const isSliced = ({ point }) => point.clone().project(this.camera.camera).z < -1,
      hit = hits.find((h) => !isSliced(h) && !this.isCut(h));
    if (!hit) return null;
    const faces = hit.object.userData.faces;
    return { side: faces.body.side, ...faces.at(hit) };
  }
}

// ---- the 3D view: draws the selection, and selects by clicks
const LEAST_HOLE = 0.05, HOLE_MARGIN = 1.2; // of the radius of the bodies; of that of the contact
export class SceneView extends BodiesCanvas {
  constructor(scene, selection, wrappers, why) {
    super(scene, selection.events.bodies);
    Object.assign(this, { selection, wrappers, events: selection.events });
    this.poses = scene.steps.poses.map(unpack);
    /** The display state; change it through look(). */
    this.now = {
      ghost: false,
      explode: 0,
      slice: 0,
      open: true, // wrappers, in front of contacts
      isolate: null,
      lids: !scene.engine, // another engine compares the bodies themselves
      boxes: -1,
      by: "kind",
      per: "face",
      scope: "run",
      why: true,
    };
    this.opened = { ...this.now };
    this.whyMarks = new WhyMarks(this, why);
    this.measured = new MeasuredMarks(this, scene.measured);
    this.curves = new ContactCurves(this, scene.curves);
    this.keys = {};
    selection.listeners.push(() => this.redraw());
    this.picker = new Picker(this);
    this.start();
  }

  /** Takes the poses of all steps, for other events. */
  takePoses(poses) {
    this.poses = poses;
    this.keys = {};
    for (const name of [...this.marks.shown.keys()]) this.marks.clear(name);
    this.redraw();
  }

  look(change) {
    Object.assign(this.now, change);
    this.redraw();
  }

  draw() {
    this.place();
    this.once("step", this.events.step(this.selection.event), () => this.keepInView());
    this.paint();
    this.shape();
    this.paint(); // the objects made by shape()
    this.mark();
    this.whyMarks.draw();
    this.measured.draw();
    this.curves.draw();
    this.open();
    this.legend.write();
    this.render();
    this.circle();
    this.measured.write();
  }

  /** Fits the view again if a step has bodies outside of it, unless the user has moved it. */
  keepInView() {
    const { camera } = this, ends = this.extremes();
    const isOut = (p) => [p.x, p.y].some((x) => Math.abs(x) > 1);
    if (camera.fitted && ends.some((p) => isOut(p.clone().project(camera.camera)))) camera.fit(ends);
  }

  /** Cuts the wrappers open in front of the step's contacts. */
  open() {
    const { now, lens, camera } = this, least = LEAST_HOLE * this.reach().radius,
      isOpen = now.open && now.by === "kind" && !camera.plane && now.explode === 0 && !now.isolate;
    setHoles(lens, (isOpen ? this.curves.now : []).map((curve) => {
      const points = curve.map((p) => new THREE.Vector3(...p)),
        { centre } = ballOf(new THREE.Box3().setFromPoints(points));
      return { centre,
          radius: points.reduce((most, p) => Math.max(most, HOLE_MARGIN * p.distanceTo(centre)), least) };
    }));
  }

  /** Draws a ring around the faces that the event compares, if they are too small to be noticed. */
  circle() {
    const faces = this.comparedFaces(), ring = byId("ring"), ball = this.ballOfFaces(faces);
    const radius = (ball.radius * this.size.y) / (2 * this.camera.halfHeight),
      at = ball.centre.project(this.camera.camera);
    ring.hidden = !faces.length || radius > 18 || Math.abs(at.x) > 1 || Math.abs(at.y) > 1 || at.z > 1;
    ring.style.left = `${50 * (1 + at.x)}%`;
    ring.style.top = `${50 * (1 - at.y)}%`;
  }

  /** Repeats an action if its inputs have changed. */
  once(what, key, action) {
    if (this.keys[what] === key) return;
    this.keys[what] = key;
    action();
  }

  place() {
    const step = this.events.step(this.selection.event);
    this.views.forEach((view, side) => {
      const poses = this.poses[side];
      view.setPose(poses.length > 12 ? poses.subarray(12 * step, 12 * step + 12) : poses);
      view.group.updateMatrixWorld(true);
    });
  }

  /** Shows or hides parts of the bodies. */
  shape() {
    const { ghost, explode, isolate, lids, boxes, by, per } = this.now, exploded = explode > 0 && !isolate;
    // The faces that were tested, which lids would hide.
    const insideOnly = ghost && per === "face" && COUNTERS.includes(by);
    this.views.forEach((view, side) => {
      const shown = lids && !isolate && !exploded && !insideOnly;
      view.lids.mesh.visible = view.lidEdges.visible = shown;
      view.lookInside(!ghost && !isolate, shown);
      if (shown)
        this.once(`lids${side}`, this.wrappers.versions[side], () =>
          view.showLids((f) => this.wrappers.onBoundary(side, f), !this.wrappers.byFace));
      this.once(`ghost${side}`, ghost || Boolean(isolate), () => view.ghost(ghost || Boolean(isolate)));
      this.once(`boxes${side}`, boxes, () => view.showBoxes(boxes));
      this.once(
        `pieces${side}`,
        isolate ? `isolate ${isolate.side} ${isolate.region}` : exploded
            ? `explode ${explode} ${this.wrappers.versions[side]}` : "",
        () => {
          if (exploded) view.showRegions(this.includedRegions(side), explode);
          else if (isolate && isolate.side === side) view.showRegions([isolate.region], 0);
          else view.clearPieces();
          this.keys.paint = null;
        },
      );
    });
  }

  includedRegions(side) {
    const body = this.bodies[side];
    return Array.from({ length: body.regionCount }, (_, r) => r)
        .filter((r) => this.wrappers.included(side, r, true) && body.hasLids(r));
  }

  paint() {
    const { by, per, scope, isolate } = this.now, counter = COUNTERS.includes(by),
      newest = by === "region" ? this.newestLayer() : 0;
    this.once(
      "paint",
      [by, per, scope, newest, Boolean(isolate), counter && scope === "step" && this.selection.event].join(),
      () => {
        const counts = counter ? this.countsOf(by, per, scope) : null,
          mode = this.colours.mode(this.bodies, by, counts, newest);
        // Mostly real faces are tested: they must be visible.
        const veil = by === "kind" || isolate ? 0.6 : counter && per === "face" ? 0.2 : 0.69;
        this.views.forEach((view, side) => {
          view.paint(mode, veil, by === "kind" && !isolate ? 1 : 0);
          view.showCounted(counter ? view.realFaces.filter((f) => counts[side][f] > 0) : [],
            (f) => mode.of(side, f));
        });
        this.legend.showScale(mode.key);
      },
    );
  }

  /** Returns the layer that a construction makes in the current pass; 0 between passes. */
  newestLayer() {
    const { events } = this,
      built = events.passes && events.pass(this.selection.event) ? events.builtIn(this.selection.event) : [];
    return built.length ? this.bodies[0].layer[built[built.length - 1].region] : 0;
  }

  countsOf(by, per, scope) {
    const all =
      scope === "run" ? this.bodies.map((b) => b.counts) : countsSoFar(this.events, this.selection.event);
    return this.bodies
        .map((b, side) => (per === "face" ? all[side][by] : sumsOfGroups(b, per, all[side][by])));
  }

  // -- highlights
  mark() {
    const { events, colours } = this, i = this.selection.event, kind = events.kind[i],
      compared = this.comparedFaces();
    const key = compared.map((f) => f.face);
    this.marks.set("tested", `${key} ${kind === events.CONTACT}`, compared, {
      colour: kind === events.CONTACT ? colours.contact : colours.underTest, opacity: 0.85, over: true,
    });
    const refined = events.passes ? events.builtIn(i) : kind === events.REFINE || kind === events.COARSEN
        ? events.regions(i) : [];
    const lastly = refined.length ? refined[refined.length - 1].region : -1;
    this.marks.set(
      "refined",
      refined.length ? (events.passes ? `built ${refined.length} ${lastly} ${this.now.by}` : i) : -1,
      refined.flatMap((r) => this.bodies[r.side].sided(this.bodies[r.side].lids(r.region))),
      {
        colour: colours.refining, opacity: events.passes && this.now.by === "region" ? 0.25 : 0.5,
        width: events.passes ? 4 : 2, through: !events.passes,
      },
    );
    if (events.attempts) this.markAttempt();
    const wrong = events.wrong[events.step(i)];
    this.marks.set("wrong", wrong.length ? events.step(i) : -1, this.facesOfPairs(wrong), {
      colour: colours.wrong, opacity: 0.7, width: 3, over: true, hatched: true,
    });
    const { picked: p, resolved, isResolved } = this.selection, body = resolved && this.bodies[resolved.side],
      way = body ? body.sided(body.wayTo(resolved.goal).map(({ lid }) => lid)) : [];
    this.marks.set("resolved", body ? `${body.side} ${resolved.goal}` : "", way, {
      colour: colours.refining, opacity: 0.3, width: 1.5,
    });
    const nodes = events.about(i, "node");
    this.marks.setBoxes("nodes", nodes.length ? i : -1, nodes, colours.underTest);
    if (events.attempts) this.marks.setPoint("vertex", p && p.vertex !== NONE ? p : null, colours.selected);
    const picked = this.pickedFaces();
    const shown = events.attempts ? picked.map((f) => f.face) : [],
      pickedKey = p ? [p.side, p.face, p.region, isResolved && p.goal, ...shown].join(" ") : "";
    this.marks.set("picked", pickedKey, picked, {
      colour: colours.selected, opacity: 0.65, width: 2.5, over: p && p.face !== NONE,
    });
  }

  /** Shows the event's attempt: its patch on the front with the start vertex, or the lids that cover it. */
  markAttempt() {
    const { events, colours } = this, i = this.selection.event, attempt = events.attempts.ofEvent.get(i),
      covers = attempt && events.kind[i] === events.REGION,
      faces = this.attemptFaces(attempt);
    this.marks.set("attempt", attempt ? `${i} ${faces.length}` : "", faces, {
      colour: covers ? colours.refining : colours.underTest, opacity: 0.45, width: 3, over: true,
    });
    const start = attempt && !covers && !attempt.whole ? { side: 0, vertex: attempt.vertex } : null;
    this.marks.setPoint("start", start, colours.underTest);
  }
  /** Returns the faces that show an attempt after the current event. */
  attemptFaces(attempt) {
    const { events, bodies, wrappers } = this;
    if (!attempt) return [];
    if (events.kind[this.selection.event] !== events.REGION)
      return events.attempts.facesOf(attempt, wrappers);
    return attempt.regions.flatMap(({ region }) => bodies[0].sided(bodies[0].lids(region)));
  }

  /** Returns the two faces that were chosen, or else those of the event: [{side, face}]. */
  comparedFaces() {
    const { chosen, event } = this.selection;
    if (chosen.every((s) => s !== NONE))
      return chosen.map((s, side) => ({ side, face: this.bodies[side].faceOfSimplex(s) }));
    const test = this.events.test(event);
    return test >= 0 ? this.events.faces(test) : [];
  }

  /** Returns the faces of pairs of simplices, each once: [{side, face}]. */
  facesOfPairs(pairs) {
    return this.bodies.flatMap((body, side) =>
      body.sided(new Set(pairs.map((p) => body.faceOfSimplex(p.simplices[side])))));
  }

  pickedFaces() {
    const p = this.selection.picked, { attempts } = this.events, body = p && this.bodies[p.side];
    if (!p || this.now.isolate || p.vertex !== NONE) return [];
    if (p.face !== NONE) return body.sided([this.selection.isResolved ? p.goal : p.face]);
    // In a construction: its faces on the front now.
    if (!attempts || this.wrappers.included(p.side, p.region, false)) return body.sided(body.lids(p.region));
    return attempts.ofEvent.has(this.selection.event) ? []
      : body.sided(body.floor(p.region)).filter((f) => this.wrappers.onBoundary(f.side, f.face));
  }

  // -- framing
  extremes() {
    this.place();
    return super.extremes();
  }

  ballOfFaces(faces) {
    const box = new THREE.Box3();
    for (const { side, face } of faces)
      this.views[side].eachCorner([face], (...p) => box.expandByPoint(this.views[side].toWorld(p)));
    return ballOf(box);
  }

  /** Frames the selection, else the elements of the event, else everything. */
  frameSelection() {
    const { picked, event } = this.selection, compared = this.comparedFaces();
    const { attempts } = this.events, tried = attempts ? this.attemptFaces(attempts.ofEvent.get(event)) : [];
    const faces = picked ? picked.face !== NONE ? [picked] : picked.vertex !== NONE
          ? [...this.bodies[picked.side].sided(attempts.around(picked.vertex)), ...tried]
          : this.collector(picked) : compared.length ? compared : tried.length ? tried
          : this.events.regions(event).flatMap((r) => this.collector(r));
    this.frame(faces);
  }

  /** Fills the view with faces; with everything if there are none. */
  frame(faces) {
    if (!faces.length) return this.frameAll();
    const ball = this.ballOfFaces(faces);
    const margin = this.now.isolate ? 1.2 : 2.2;
    this.camera.lookAt(ball.centre, Math.max(margin * ball.radius, 0.02 * this.reach().radius));
    this.redraw();
  }

  collector({ side, region }) {
    return this.bodies[side].sided([...this.bodies[side].lids(region), ...this.bodies[side].floor(region)]);
  }
}

export function ballOf(box) {
  const centre = new THREE.Vector3();
  if (box.isEmpty()) return { centre, radius: 1 };
  return {
    centre: box.getCenter(centre),
    radius: Math.max(1e-6, box.getSize(new THREE.Vector3()).length() / 2),
  };
}
