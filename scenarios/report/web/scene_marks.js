import { byId, digits, element } from "./dom.js";
import { COUNTERS, mixed } from "./scene_colours.js";
import { discard, edgesOf, FaceMesh } from "./scene_faces.js";
import { boxEdges, roundPoints, thickGeometry, thickLines, thickMaterial, WHITE } from "./scene_lines.js";
import { SIDES, unpack } from "./scene_run.js";

// ---- the elements of the event and of the selection: painted over the bodies, with outlines visible through
// everything
export class Marks {
  /** `lens`: see fadingLines(). */
  constructor(views, colours, lens) {
    Object.assign(this, { views, colours, lens });
    this.shown = new Map(); // by name: {key, parts: [{group, object}]}
  }

  /** Shows the objects that `make` returns for a body, {view, own: its elements}. Nothing is rebuilt while
      `key` stays the same. */
  show(name, key, elements, make) {
    if (this.shown.get(name)?.key === key) return;
    this.clear(name);
    const parts = this.views.flatMap((view, side) => {
      const own = elements.filter((e) => e.side === side), objects = own.length ? make(view, own) : [];
      for (const object of objects) view.group.add(object);
      return objects.map((object) => ({ group: view.group, object }));
    });
    this.shown.set(name, { key, parts });
  }

  /** Shows faces in a colour, or `hatched` with it. `through`: outlines are visible through everything. */
  set(name, key, faces, { colour, opacity = 1, width = 1.5, over = false, through = true, hatched = false }) {
    this.show(name, key, faces, (view, shown) => {
      const own = shown.map((f) => f.face);
      const material = new THREE.MeshLambertMaterial({
        color: new THREE.Color(...colour), side: THREE.DoubleSide, transparent: opacity < 1 || over, opacity,
        depthWrite: opacity === 1 && !over, depthTest: !over, polygonOffset: true, polygonOffsetFactor: 0,
        polygonOffsetUnits: -2,
      });
      if (hatched)
        material.onBeforeCompile = (shader) => {
          shader.fragmentShader = shader.fragmentShader.replace(/}\s*$/,
              "if (mod(gl_FragCoord.x + gl_FragCoord.y, 12.0) < 6.0) gl_FragColor.rgb = vec3(1.0); }");
        };
      const strips = new FaceMesh(view.body, own, material), mesh = strips.mesh;
      mesh.renderOrder = over ? 5 : opacity < 1 ? 3 : 0;
      const rim = thickLines(
        edgesOf(view.body, own, true).flatMap((v) => view.point(v)),
        thickMaterial(mixed(colour, this.colours.ink, 0.35), width, this.lens),
      );
      rim.renderOrder = 6;
      if (!through)
        Object.assign(rim.material,
            { depthTest: true, polygonOffset: true, polygonOffsetFactor: 0, polygonOffsetUnits: -40 });
      return [mesh, rim];
    });
  }

  /** Shows a vertex, {side, vertex}, as a disc of a colour; null: none. */
  setPoint(name, at, colour) {
    this.show(name, at ? `${at.side} ${at.vertex}` : "", at ? [at] : [], (view) => {
      const disc = roundPoints(view.point(at.vertex), colour, 14, mixed(colour, this.colours.ink, 0.75));
      disc.renderOrder = 8;
      return [disc];
    });
  }

  /** As in BodyView, a little wider. */
  widen(pixel) {
    for (const { parts } of this.shown.values())
      for (const { object } of parts) if (object.userData.faces) object.userData.faces.widen(6 * pixel);
  }

  /** Shows boxes of tree nodes. */
  setBoxes(name, key, nodes, colour) {
    this.show(name, key, nodes, (view, shown) => {
      const { node, places } = view.body.boxes,
        own = shown.map((n) => node.indexOf(n.number)).filter((i) => i >= 0);
      if (!own.length) return [];
      const lines = thickLines(
        boxEdges(places, own), thickMaterial(mixed(colour, this.colours.ink, 0.35), 1.5, this.lens),
      );
      lines.renderOrder = 6;
      return [lines];
    });
  }

  clear(name) {
    for (const { group, object } of (this.shown.get(name) || { parts: [] }).parts) discard(group, object);
    this.shown.delete(name);
  }
}

/** Lines in the world that a view shows with the bodies. */
class WorldLines {
  constructor(view) {
    Object.assign(this, { view, group: new THREE.Group() });
    view.stage.add(this.group);
  }

  /** `ends`: see thickLines(); `look`: see thickMaterial(). */
  addLines(ends, colour, width, order, look) {
    this.add(thickLines(ends, thickMaterial(colour, width, this.view.lens, look)), order);
  }
  add(object, order) {
    object.renderOrder = order;
    this.group.add(object);
  }
  clear() {
    for (const object of this.group.children.slice()) discard(this.group, object);
  }
}

// ---- in the view: where two faces intersect, or what separates them; and what separates the bodies
export const PLANE = [0.5, 0.53, 0.57]; // seen on light and dark pages; no face has it
export class WhyMarks extends WorldLines {
  /** `why`: the panel with the same explanation in words. */
  constructor(view, why) {
    super(view);
    Object.assign(this, { why, key: null });
    why.listeners.push(() => view.redraw());
  }

  draw() {
    const { view, why } = this, nodes = why.nodes();
    view.marks.setBoxes("way", nodes.map((n) => n.number).join(" "), nodes, view.colours.selected);
    const key = why.now && view.now.why ? why.now.key : "";
    if (key === this.key) return;
    this.key = key;
    this.clear();
    view.legend.also([], "why");
    if (!key) return;
    if (why.now.kind === "pair") this.addPair(why.now.found);
    else this.addSeparation(why.now.found);
  }

  addPair({ meet, points }) {
    const { colours } = this.view;
    // Under the line a wider white one: contacts are seen on intersecting faces, which have their colour.
    const colour = meet === 0 ? colours.ink : colours.contact;
    this.addPath(points, points.length > 2, WHITE, 6);
    this.addPath(points, points.length > 2, colour, 3);
    const { radius } = this.view.ballOfFaces(this.view.comparedFaces());
    if (meet === 0 && this.view.events.dim === 3) this.addSquare(squareBetween(...points, radius));
    this.view.legend.also(
      meet === 0
        ? [
            [colours.ink, "between the nearest points", WHITE], [PLANE, "plane that separates the faces"],
          ] : [],
      "why",
    );
  }

  addSeparation({ plane, boxes }) {
    const { colours } = this.view;
    if (boxes) {
      const places = unpack(boxes.places);
      this.view.bodies.forEach((_, side) =>
        this.addLines(boxEdges(places, [side]), mixed(colours.bodies[side], colours.ink, 0.3), 1.8, 7),
      );
    }
    const square = unpack((plane || boxes || { square: "f4:" }).square);
    if (square.length) this.addSquare([0, 3, 6, 9].map((i) => [...square.subarray(i, i + 3)]));
    this.view.legend.also(
      [
        ...(boxes ? [[mixed(colours.bodies[0], colours.ink, 0.3), "nearest disjoint boxes"]] : []),
        ...(square.length ? [[PLANE, plane ? "plane between the bodies" : "plane between these boxes"]] : []),
      ],
      "why",
    );
  }

  /** Joins points in order. */
  addPath(points, closed, colour, width) {
    const ends = [];
    for (let i = 0; i + 1 < points.length + (closed ? 1 : 0); i++)
      ends.push(...points[i], ...points[(i + 1) % points.length]);
    if (ends.length) this.addLines(ends, colour, width, 7);
  }

  addSquare(corners) {
    const colour = PLANE, geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(corners.flat()), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const square = new THREE.Mesh(
      geometry,
      new THREE.MeshBasicMaterial({
        color: new THREE.Color(...colour), transparent: true, opacity: 0.35, depthWrite: false,
        side: THREE.DoubleSide,
      }),
    );
    square.frustumCulled = false;
    this.add(square, 4);
    this.addPath(corners, true, colour, 1.2);
  }
}

/** Returns a vector perpendicular to one of unit length. */
const acrossTo = (n) => new THREE.Vector3(Math.abs(n.x) < 0.6, Math.abs(n.x) >= 0.6, 0).cross(n);

/** Returns a square perpendicular to the line between two points, at its midpoint. `half`: from there to
    its corners. */
function squareBetween(p, q, half) {
  const a = new THREE.Vector3(...p), b = new THREE.Vector3(...q), n = b.clone().sub(a);
  if (n.length() === 0) return [p, p, p, p];
  n.normalize();
  const u = acrossTo(n).setLength(half),
    v = n.clone().cross(u),
    midpoint = a.add(b).multiplyScalar(0.5);
  return [u, v, u.clone().negate(), v.clone().negate()].map((way) => midpoint.clone().add(way).toArray());
}

// ---- in the view: the distance of the bodies in the current step, the separation vector where they overlap,
// near pairs, contact manifolds and points of B
const MEASURED = [
  { colour: "ink", key: "nearest points of the bodies", width: 3.5, isArrow: false },
  { colour: "ink", key: "B leaves A this way", width: 3.5, isArrow: true },
  { colour: "ink", key: "between the closest points of near pairs", width: 1.5, isArrow: false },
  { colour: "ink", key: "normals of contacts, from A to B", width: 2.5, isArrow: true },
  { colour: "ink", key: "from points of B to the closest points of A", width: 1.5, isArrow: false },
  { colour: "contact", key: "the same, of points inside A", width: 1.5, isArrow: false },
];

export class MeasuredMarks extends WorldLines {
  /** `measured`: as the page has it; null: not requested. */
  constructor(view, measured) {
    super(view);
    this.shown = null;
    this.ofStep = new Map(); // by number: a list of {kind, from, to, words}, the first of which has the text
    if (measured) {
      const ends = unpack(measured.ends), kinds = unpack(measured.kind),
        at = (i) => new THREE.Vector3(...ends.subarray(i, i + 3));
      unpack(measured.step).forEach((step, i) => {
        if (!this.ofStep.has(step)) this.ofStep.set(step, []);
        this.ofStep.get(step).push(
            { kind: kinds[i], from: at(6 * i), to: at(6 * i + 3), words: measured.words[i] });
      });
    }
  }

  /** Rebuilds the lines if the step has changed. */
  draw() {
    const { events, selection, legend, colours } = this.view,
      now = this.ofStep.get(events.stepNumber(selection.event)) || [];
    if ((now[0] || null) === this.shown) return;
    this.shown = now[0] || null;
    this.clear();
    const key = [];
    MEASURED.forEach(({ colour, key: text, width, isArrow }, kind) => {
      const marks = now.filter((mark) => mark.kind === kind);
      if (marks.length === 0) return;
      const ends = thickGeometry(marks
          .flatMap(({ from, to }) => (isArrow ? arrowOf(from, to, events.dim) : [from, to]))
          .flatMap((p) => p.toArray()));
      this.addLines(ends, WHITE, 2 * width, 8); // so that they are visible on bodies of any colour
      this.addLines(ends, colours[colour], width, 9);
      key.push([colours[colour], text, WHITE]);
    });
    legend.also(key, "measured");
  }

  /** Writes the length beside the bodies, with a line that leads to the midpoint of the segment. */
  write() {
    const [label, leader] = ["measured", "leader"].map(byId), { shown, view } = this,
      { x: width, y: height } = view.size,
      onScreen = (p) => {
        const at = p.project(view.camera.camera);
        return [(width * (1 + at.x)) / 2, (height * (1 - at.y)) / 2];
      };
    const [x, y] = shown ? onScreen(shown.from.clone().add(shown.to).multiplyScalar(0.5)) : [-1, -1];
    label.hidden = leader.hidden = !(x > 0 && x < width && y > 0 && y < height);
    if (label.hidden) return;
    label.textContent = shown.words;
    const ends = view.extremes().map(onScreen),
      [left, top] = [0, 1].map((i) => Math.min(...ends.map((p) => p[i]))),
      [right, bottom] = [0, 1].map((i) => Math.max(...ends.map((p) => p[i]))),
      [w, h] = [label.offsetWidth / 2 + 10, label.offsetHeight / 2 + 10],
      within = (v, half, size) => Math.max(half, Math.min(size - half, v));
    const places = [[x, top - h], [x, bottom + h], [left - w, y], [right + w, y]].map(([u, v]) => {
      const at = [within(u, w, width), within(v, h, height)];
      return { at, far: Math.hypot(at[0] - x, at[1] - y) + 3 * Math.hypot(at[0] - u, at[1] - v) }; // in it
    });
    const [u, v] = places.reduce((p, q) => (q.far < p.far ? q : p)).at;
    Object.assign(label.style, { left: `${u}px`, top: `${v}px` });
    const way = `rotate(${Math.atan2(y - v, x - u)}rad)`;
    Object.assign(leader.style,
        { left: `${u}px`, top: `${v}px`, width: `${Math.hypot(x - u, y - v)}px`, transform: way });
  }
}

/** Returns the ends of an arrow's lines. */
function arrowOf(from, to, dim) {
  const along = to.clone().sub(from), length = along.length(), n = along.clone().normalize(),
    across = dim === 2 ? new THREE.Vector3(0, 0, 1).cross(n) : acrossTo(n);
  across.setLength(0.11 * length);
  const sides = [across, across.clone().negate()];
  if (dim === 3) for (const s of sides.slice()) sides.push(n.clone().cross(s));
  const back = to.clone().addScaledVector(along, -0.24);
  return [from, to, ...sides.flatMap((side) => [back.clone().add(side), to])];
}

// ---- the curves along which the surfaces meet in the current step, over the wrappers: solid where they are
// seen, dashed where a body hides them, as in frames
export class ContactCurves extends WorldLines {
  /** `curves`: as the page has them; null: not known. */
  constructor(view, curves) {
    super(view);
    Object.assign(this, { shown: -1, now: [], ofStep: new Map() });
    if (!curves) return;
    const [points, sizes, closed] = ["points", "size", "closed"].map((name) => unpack(curves[name]));
    let at = 0;
    unpack(curves.step).forEach((step, i) => {
      const number = view.events.stepNumbers[step],
        own = Array.from({ length: sizes[i] }, () => [...points.subarray(at, (at += 3))]);
      if (closed[i]) own.push(own[0]);
      this.ofStep.set(number, [...(this.ofStep.get(number) || []), own]);
    });
  }

  draw() {
    const { view, group } = this, step = view.events.stepNumber(view.selection.event);
    group.visible = !view.now.isolate && view.now.explode === 0;
    if (step === this.shown) return;
    this.shown = step;
    this.clear();
    const curves = this.ofStep.get(step) || [], { contact } = view.colours,
      lines = curves.flatMap((points) => points.slice(1).flatMap((p, i) => [...points[i], ...p])),
      ends = thickGeometry(lines),
      hidden = view.events.dim === 3 ? [[WHITE, 5, 0.5, 0], [contact, 2.2, 0.85, 9]] : [];
    this.now = curves;
    this.dashed = hidden.length > 0 && lines.length > 0;
    for (const [colour, width, opacity, dash] of lines.length ? hidden : [])
      this.addLines(ends, colour, width, 7, { opacity, dash });
    for (const [colour, width, order] of lines.length ? [[WHITE, 6, 8], [contact, 3, 9]] : [])
      this.addLines(ends, colour, width, order, { hides: view.events.dim === 3 });
    // Curves too small to be noticed, and single points, have a dot.
    const least = 0.01 * view.reach().radius,
      small = curves
          .filter((points) => points.every((p) => Math.hypot(...p.map((x, i) => x - points[0][i])) < least));
    if (small.length) this.add(roundPoints(small.flatMap((points) => points[0]), contact, 10), 10);
  }
}

// ---- the meaning of the colours that the view shows now
const MARKED = [
  ["tested", "underTest", "pair under test"], ["refined", "refining", "region being refined"],
  ["attempt", "underTest", "patch of this attempt"], ["picked", "selected", "selected"],
  ["resolved", "refining", "faces on the way in"], ["way", "selected", "boxes of nodes in the panel"],
  ["wrong", "wrong", "pairs that the engine got wrong"],
];

export class Legend {
  constructor(view) {
    this.view = view;
    this.more = {};
    this.shown = "";
  }

  /** Adds highlighted items, and replaces the previous ones of the same `who`: [[colour, words, colour of
      the rim]]; an outline where the colour alone is not visible on a dark card. */
  also(items, who) {
    this.more[who] = items;
    this.write();
  }

  static css(c) {
    return `rgb(${c.map((x) => Math.round(255 * x)).join(" ")})`;
  }

  write() {
    const { css } = Legend, items = [...this.items(), ...Object.values(this.more).flat()],
      text = JSON.stringify(items);
    if (text === this.shown) return;
    this.shown = text;
    byId("legend").replaceChildren(
      ...items.map(([colour, words, rim, mark]) => {
        const dot = element("i", { class: mark || "" });
        dot.style[mark ? "borderColor" : "background"] = css(colour);
        if (rim) dot.style.outline = `1.5px solid ${css(rim)}`;
        return element("span", {}, dot, words);
      }),
    );
  }

  /** Returns the items of a run's view: [colour, words, rim, "line" or "dashed"]. */
  items() {
    const { colours, bodies, now, views, marks, events, curves } = this.view,
      coloured = ["layer", "region"].includes(now?.by),
      counting = COUNTERS.includes(now?.by);
    if (!now) return []; // of other pages
    const pale = coloured ? colours.shares.ground : counting ? colours.shares.noValue : 0,
      items = bodies.map((b, side) => [
        mixed(b.dim === 2 ? colours.solid(side) : colours.bodies[side], WHITE, pale),
        `${bodies.length > 1 ? `${SIDES[side]}: ` : ""}${b.name}${counting ? ` without ${now.by}` : ""}`,
        pale ? colours.edge(side) : null,
      ]),
      withLids = bodies.filter((_, side) =>
          views[side].pieces.some((piece) => piece.triangles) ||
          (views[side].lids.mesh.visible && views[side].lidCount));
    if (now.by === "kind")
      for (const { side } of withLids)
        items.push([colours.lid(side), `pseudo faces${bodies.length > 1 ? ` of ${SIDES[side]}` : ""}`,
            colours.edge(side)]);
    if (now.by === "region" && withLids.length)
      items.push([colours.categories[0],
          `pseudo faces, a colour for each region${events.passes ? "; pale: of earlier passes" : ""}`]);
    const { contact } = colours, seen = curves?.group.visible, kind = events.kind[this.view.selection.event];
    if (seen && curves.now.length > 0) items.push([contact, "contact", null, "line"]);
    if (seen && curves.dashed) items.push([contact, "contact, hidden", null, "dashed"]);
    for (const [name, colour, words] of MARKED)
      if (marks.shown.get(name)?.parts.length && !(name === "attempt" && kind === events.REGION))
        items.push(
          name === "tested" && kind === events.CONTACT ? [colours.contact, "intersecting pair"]
            : [colours[colour], name === "refined" && events.passes ? "lids that are new in this pass"
              : words],
        );
    return items;
  }

  /** `key`: the scale of the colours; null: there is none. */
  showScale(key) {
    const { colours, bodies, now } = this.view;
    byId("scale").hidden = !key;
    if (!key) return;
    byId("scale-bar").style.background = `linear-gradient(to right, ${colours.stops.join(", ")})`;
    byId("scale-most").textContent = key.top > key.most
        ? `\u2265 ${digits(key.most)} (at most ${digits(key.top)})` : digits(key.most);
    const whose = bodies.length > 1 ? " of both bodies" : "";
    const when = now.scope === "run" ? "in the whole run" : "in this step so far";
    byId("scale-title").textContent = key.title || `${now.by} for each ${now.per}`;
    byId("scale").title = key.title ? ""
        : `${now.by}, for each ${now.per}${whose}, ${when}; 99 % of the counted faces are on the scale`;
  }
}
