import { digits, plural } from "./dom.js";

// ---- number arrays packed as text by assets.hpp
export const NONE = 0xffffffff;

/** Returns a Float32Array, or a Uint32Array in which NONE encodes kNull. */
export function unpack(text) {
  const raw = atob(text.slice(3)), size = Number(text[1]), count = raw.length / size;
  if (text[0] === "f") {
    const bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
    const view = new DataView(bytes.buffer), out = new Float32Array(count);
    for (let i = 0; i < count; i++) out[i] = view.getFloat32(4 * i, true);
    return out;
  }
  const out = new Uint32Array(count), none = size === 4 ? NONE : 256 ** size - 1;
  for (let i = 0; i < count; i++) {
    let n = 0;
    for (let k = size; k-- > 0;) n = n * 256 + raw.charCodeAt(i * size + k);
    out[i] = n === none ? NONE : n;
  }
  return out;
}

/** Returns a body's pose in the page's frame, as scene_json.cpp does: vertices are relative to its centre. */
export const poseInPage = (rows, side, { origin, unit, bodies }) => rows.map((x, i) => {
  if (i % 4 !== 3) return x;
  const turned = rows.slice(i - 3, i).reduce((sum, r, k) => sum + r * bodies[side].centre[k], x);
  return (turned - origin[(i - 3) / 4]) / unit;
});

/** Returns the largest index whose value is at most `value`, in an ascending array; -1: none. */
export function lastAtMost(ascending, value) {
  let low = 0, high = ascending.length;
  while (low < high) {
    const midpoint = (low + high) >> 1;
    if (ascending[midpoint] <= value) low = midpoint + 1;
    else high = midpoint;
  }
  return low - 1;
}

// ---- a body: its LRB-rep as arrays, and the history of its faces
export const SIDES = ["A", "B"];

export class Body {
  constructor(json, side, dim) {
    this.side = side;
    this.dim = dim; // 2: faces are segments
    this.name = json.name;
    this.faceCount = json.faces;
    this.realCount = json.realFaces;
    this.regionCount = json.regions;
    this.complete = Boolean(json.geometry); // false: too large for a page
    if (!this.complete) return;
    const g = json.geometry;
    this.vertices = unpack(g.vertices);
    this.corners = unpack(g.corners);
    this.triangles = g.triangles ? unpack(g.triangles) : null; // of all corners; null: polygons are fans
    this.inner = unpack(g.inner); // region behind each face; NONE: the solid
    this.outer = unpack(g.outer); // region in front of it; NONE: the outside
    this.parent = unpack(g.parent);
    this.layer = unpack(g.layer);
    this.countCorners(unpack(g.sizes), g.shown ? unpack(g.shown) : null);
    this.lidsOf = grouped(this.inner, this.regionCount);
    this.floorOf = grouped(this.outer, this.regionCount);
    this.boxes = {
      node: unpack(json.boxes.node),
      depth: unpack(json.boxes.depth),
      places: unpack(json.boxes.places),
      whole: json.boxes.whole, // the page has all boxes down to this depth
      atDepth: unpack(json.boxes.atDepth), // number of boxes
    };
    this.counts = Object.fromEntries(Object.entries(json.counts).map(([name, text]) => [name, unpack(text)]));
    this.counts.misses = this.counts.tests.map((n, f) => n - this.counts.hits[f]);
  }

  /** Numbers the triangles of all faces (2D: segments), as LrbRep does. `shown`: the pseudo faces that have
      corners on the page; null: all. */
  countCorners(sizes, shown) {
    this.offsets = new Uint32Array(sizes.length + 1);
    this.firstSimplex = new Uint32Array(sizes.length + 1);
    const has = new Uint8Array(sizes.length).fill(1, 0, shown ? this.realCount : sizes.length);
    for (const f of shown || []) has[f] = 1;
    for (let f = 0; f < sizes.length; f++) {
      this.offsets[f + 1] = this.offsets[f] + has[f] * sizes[f];
      this.firstSimplex[f + 1] = this.firstSimplex[f] + Math.max(1, sizes[f] - 2);
    }
  }

  isReal(face) {
    return face < this.realCount;
  }
  face(face) {
    return this.corners.subarray(this.offsets[face], this.offsets[face + 1]);
  }
  /** Returns a corner, 0 to 2, of the i-th triangle of a face (not 2D). */
  cornerOf(face, i, corner) {
    if (this.triangles) return this.triangles[3 * (this.firstSimplex[face] + i) + corner];
    return this.corners[this.offsets[face] + (corner ? i + corner : 0)];
  }
  faceOfSimplex(simplex) {
    return lastAtMost(this.firstSimplex, simplex);
  }
  /** Returns the region that a face belongs to: the one that a pseudo face hides, or that covers a real
      face; NONE: none. */
  regionOf(face) {
    return this.isReal(face) ? this.outer[face] : this.inner[face];
  }
  /** Returns faces as the view marks them. */
  sided(faces) {
    return [...faces].map((face) => ({ side: this.side, face }));
  }
  lids(region) {
    return this.lidsOf.of(region);
  }
  /** Returns true if the page has the corners of a region's lids: of large bodies it may not. */
  hasLids(region) {
    return region !== NONE && this.hasCorners(this.lids(region));
  }
  hasCorners(faces) {
    return faces.every((f) => this.offsets[f] < this.offsets[f + 1]);
  }
  floor(region) {
    return this.floorOf.of(region);
  }
  /** Returns the number of steps from the outside along parents. */
  depth(region) {
    let depth = 0;
    for (let r = region; r !== NONE; r = this.parent[r]) depth++;
    return depth;
  }
  /** Returns the transitions face, region by which one comes to a face from the outside, [{lid, region}]: of
      each region the nearest lid. */
  wayTo(face) {
    const out = [], corner = (f, c) => this.vertices[3 * this.face(f)[0] + c],
      far = (f) => Math.hypot(...[0, 1, 2].map((c) => corner(f, c) - corner(face, c)));
    for (let region = this.outer[face]; region !== NONE; region = this.parent[region]) {
      const lids = this.lids(region).filter((f) => this.outer[f] === this.parent[region]);
      out.unshift({ region, lid: lids.reduce((p, q) => (far(q) < far(p) ? q : p)) });
    }
    return out;
  }
  faceText(face) {
    return `${this.isReal(face) ? "face" : "pseudo face"} ${digits(face)}`;
  }
}

/** Returns the indices that have each value below `groups`. */
export function grouped(values, groups) {
  const offsets = new Uint32Array(groups + 1);
  for (const v of values) if (v !== NONE) offsets[v + 1]++;
  for (let g = 0; g < groups; g++) offsets[g + 1] += offsets[g];
  const members = new Uint32Array(offsets[groups]), next = offsets.slice();
  values.forEach((v, i) => {
    if (v !== NONE) members[next[v]++] = i;
  });
  return { of: (g) => members.subarray(offsets[g], offsets[g + 1]) };
}

// ---- the events of the run that the page has. An event's index is its position among these; the number
// shown to users is its id, its number in the trace. The meaning of the numbers `a` and `b` of a kind is
// taken from the kind's words, so that new kinds are shown without a change.
export class Events {
  constructor(json, bodies) {
    this.bodies = bodies;
    this.count = json.events.count;
    for (const name of ["kind", "side", "meet", "a", "b", "cause", "boundary", "depthA", "depthB"])
      this[name] = unpack(json.events[name]);
    this.ids = json.events.id ? unpack(json.events.id) : null;
    this.kinds = json.kinds.map((k) => ({ name: k.name, colour: k.colour, a: role(k.a), b: role(k.b) }));
    this.outcome = unpack(json.events.outcomes.numbers);
    this.outcomes = json.events.outcomes.words;
    this.dim = json.dim;
    this.engine = json.engine;
    this.frame = { origin: json.origin, unit: json.unit }; // x_world = origin + unit * x
    this.work = unpack(json.events.work); // number of the event's part of the work; NONE: none
    this.wrong = wrongPairs(json.wrong, json.steps.count);
    this.phases = json.phases;
    this.relations = json.relations;
    this.stepNumbers = unpack(json.steps.index);
    this.firstOfStep = unpack(json.steps.first).map((id) => this.from(id));
    // The numbers of kinds as STEP, FACE_TEST and so on.
    const names = "step,face test,refine,coarsen,contact,result,patch,cap,region,pass,pass end";
    for (const name of names.split(","))
      this[name.toUpperCase().replace(" ", "_")] = this.kinds.findIndex((k) => k.name === name);
    /** Passes of a construction, which begins with the body itself: [{first, last, words}], ids of events;
        else null. */
    this.passes = json.passes;
    /** What the builder tried where: set by the page; null for other runs. */
    this.attempts = null;
  }

  /** Replaces the events by others of the same run: all of them. */
  replace(columns) {
    const wrong = new Map([...this.stepNumbers].map((number, step) => [number, this.wrong[step]]));
    Object.assign(this, columns);
    this.wrong = [...this.stepNumbers].map((number) => wrong.get(number) || []);
    if (this.attempts) this.attempts.take(columns.patches);
  }

  id(i) {
    return this.ids ? this.ids[i] : i;
  }
  /** Returns the last event on the page that is not later than the one with this id. */
  at(id) {
    return Math.max(0, this.ids ? lastAtMost(this.ids, id) : Math.min(id, this.count - 1));
  }
  /** Returns the first event on the page that is not earlier than the one with this id. */
  from(id) {
    return this.ids ? lastAtMost(this.ids, id - 1) + 1 : id;
  }
  /** Returns the event with this id; -1: not on the page. */
  find(id) {
    const i = id === NONE ? -1 : this.at(id);
    return i >= 0 && this.id(i) === id ? i : -1;
  }

  /** Returns the index of an event's time step among those on the page. */
  step(i) {
    return lastAtMost(this.firstOfStep, i);
  }
  endOfStep(step) {
    return step + 1 < this.firstOfStep.length ? this.firstOfStep[step + 1] : this.count;
  }
  /** Returns the number of an event's time step in the scenario. */
  stepNumber(i) {
    return this.stepNumbers[this.step(i)];
  }
  kindOf(i) {
    return this.kinds[this.kind[i]];
  }
  changesWrapper(i) {
    const kind = this.kind[i];
    return kind === this.REFINE || kind === this.COARSEN || kind === this.REGION;
  }
  /** Returns true if an event concerns a body. */
  concerns(i, side) {
    const { a, b } = this.kindOf(i);
    if (a.side >= 0 || b.side >= 0) return true; // both
    return (a.sort === "region" || a.sort === "vertex") && this.side[i] === side;
  }
  isHit(i) {
    return this.meet[i] > 0;
  }

  /** Returns the elements of one sort that an event concerns: [{side, number}]. */
  about(i, sort) {
    const kind = this.kindOf(i), out = [];
    for (const [r, number] of [[kind.a, this.a[i]], [kind.b, this.b[i]]])
      if (r.sort === sort && number !== NONE) out.push({ side: r.side >= 0 ? r.side : this.side[i], number });
    return out;
  }
  /** Returns the faces that an event compares: [{side, face}]; empty if the bodies are too large for the
      page. */
  faces(i) {
    return this.about(i, "simplex")
      .filter((s) => this.bodies[s.side].complete)
      .map((s) => ({ side: s.side, face: this.bodies[s.side].faceOfSimplex(s.number) }));
  }
  regions(i) {
    return this.about(i, "region").map((r) => ({ side: r.side, region: r.number }));
  }
  /** Returns the number of regions between the event's element and the outside; the larger one of two
      faces; -1: none. */
  level(i) {
    const [region] = this.regions(i);
    if (region) return this.bodies[region.side].complete ? this.bodies[region.side].depth(region.region) : -1;
    return this.kind[i] === this.FACE_TEST ? Math.max(this.depthA[i], this.depthB[i]) : -1;
  }
  /** Returns the pass of a construction that an event belongs to; null: none. */
  pass(i) {
    const id = this.id(i);
    return (this.passes || []).find((p) => p.first <= id && id <= p.last) || null;
  }
  /** Returns the regions that a construction has made so far in the pass of an event: [{side, region}]. */
  builtIn(i) {
    const pass = this.pass(i), out = [];
    for (let k = pass ? this.from(pass.first) : i + 1; k <= i; k++)
      if (this.kind[k] === this.REGION) out.push({ side: 0, region: this.a[k] });
    return out;
  }
  /** Returns true if the wrapper of a body can be refined down to a selected face: if the page has the
      corners of what that shows. */
  canResolve(body, { goal = NONE }) {
    const way = this.engine || this.passes || goal === NONE ? [] : body.wayTo(goal);
    return way.length > 0
        && way.every(({ region }) => body.hasLids(region) && body.hasCorners(body.floor(region)));
  }
  /** Returns the event of the face comparison that led to this one; -1: none on the page. */
  test(i) {
    if (this.about(i, "simplex").length > 0) return i;
    const cause = this.find(this.cause[i]);
    return cause >= 0 && this.about(cause, "simplex").length > 0 ? cause : -1;
  }
}

/** Returns the most telling event, with which the page opens: with another engine's wrong answers, the end of
    the first such step, else its first contact; of a run of lrbscope, the last contact of the step that has
    most; without contact, the end of the step with most events; of one body, the change halfway. */
export function tellingEvent(events) {
  const { kind, firstOfStep, bodies, wrong, CONTACT } = events, steps = [...firstOfStep.keys()],
    all = [...kind.keys()],
    end = (step) => events.endOfStep(step) - 1,
    most = (count) => steps.reduce((p, q) => (count[q] > count[p] ? q : p), 0);
  if (bodies.length === 1) {
    const changes = all.filter((i) => events.changesWrapper(i));
    return changes.length ? changes[changes.length >> 1] : 0;
  }
  const faulty = steps.find((step) => wrong[step].length);
  if (faulty !== undefined) return end(faulty);
  if (events.engine && kind.includes(CONTACT)) return kind.indexOf(CONTACT);
  const contacts = new Uint32Array(steps.length);
  for (const i of all) contacts[events.step(i)] += kind[i] === CONTACT;
  const step = most(contacts);
  if (!contacts[step]) return end(most(steps.map((s) => end(s) - firstOfStep[s])));
  return kind.subarray(0, end(step) + 1).lastIndexOf(CONTACT);
}

/** Returns the meaning of a number of an event: {sort, side, words}; side -1: that of the event, if it has
    one. */
function role(words) {
  const side = / of A$/.test(words) ? 0 : / of B$/.test(words) ? 1 : -1;
  const sorts = ["simplex", "node", "region", "vertex", "relation", "phase"];
  return { sort: sorts.find((sort) => words.split(" ").includes(sort)) || words, side, words };
}

/** Returns, for each step, the pairs that another engine got wrong: [{simplices, missed}]. */
function wrongPairs(json, steps) {
  const out = Array.from({ length: steps }, () => []);
  if (!json) return out;
  const [step, a, b, missed] = ["step", "a", "b", "missed"].map((name) => unpack(json[name]));
  step.forEach((s, i) => out[s].push({ simplices: [a[i], b[i]], missed: missed[i] === 1 }));
  return out;
}

// ---- why two faces intersect or not, and what separates the bodies: the data packed by explanations.cpp
export class Explanations {
  /** `json`: null if the page has no explanations. `stepNumbers`: the steps with explanations. */
  constructor(json, stepNumbers) {
    this.none = !json;
    if (!json) return;
    const { by, meets, axes, cut, command, pairs, steps } = json;
    Object.assign(this, { by, meets, axes, cut, command });
    this.columns = Object.fromEntries(
      Object.entries(pairs).map(([name, text]) => [name, typeof text === "string" ? unpack(text) : text]),
    );
    const number = (step) => stepNumbers[step]; // more steps may be loaded: identified by number
    this.steps = new Map(steps.map((s) => [number(s.step), s]));
    this.numbers = new Map();
    for (let i = 0; i < pairs.count; i++)
      this.numbers.set(
        Explanations.key(number(this.columns.step[i]), [this.columns.a[i], this.columns.b[i]]),
        i,
      );
  }

  static key(step, [a, b]) {
    return `${step} ${a} ${b}`;
  }

  /** Returns the explanation of a pair of simplices at a step, by its number; null: none. */
  pair(step, simplices) {
    const i = this.none ? undefined : this.numbers.get(Explanations.key(step, simplices));
    if (i === undefined) return null;
    const c = this.columns,
      part = (ends, values, size = 1) => values.subarray(size * (i > 0 ? ends[i - 1] : 0), size * ends[i]);
    const rows = [...part(c.wayEnd, c.gap)].map((gap, k) => {
      const at = (i > 0 ? c.wayEnd[i - 1] : 0) + k;
      return { nodes: [c.nodeA[at], c.nodeB[at]], gap, axis: this.axes[c.axis[at]], faces: false };
    });
    if (c.reachesFaces[i]) rows.at(-1).faces = true;
    const points = part(c.pointsEnd, c.points, 3);
    return {
      meet: c.meet[i],
      by: this.by[c.by[i]],
      rows,
      points: Array.from({ length: points.length / 3 }, (_, k) => [...points.subarray(3 * k, 3 * k + 3)]),
      distance: c.distance[i],
      ulps: c.ulps[i],
      // A's corners against B's plane, then B's against A's: {distance, exact, inDouble}.
      corners: [0, 3].map((first) =>
        [0, 1, 2].map((k) => {
          const sign = c.signs[6 * i + first + k];
          return {
            distance: c.corner[6 * i + first + k], exact: Math.floor(sign / 3) - 1, inDouble: (sign % 3) - 1,
          };
        }),
      ),
    };
  }

  /** Returns what separates the bodies at a step; null: they intersect, or the page has no explanation. */
  step(step) {
    return this.none ? null : this.steps.get(step) || null;
  }

  /** Returns the command that explains a pair, or the step if no pair is given; empty: no command. */
  commandFor(stepNumber, simplices) {
    if (this.none || !this.command) return "";
    return `${this.command} --step ${stepNumber}${simplices ? ` --pair ${simplices.join(",")}` : ""}`;
  }
}

// ---- both wrappers after an event: replayed from the beginning of its time step, as in
// trace/include/lrbscope/trace/replay.hpp
export class Wrappers {
  constructor(bodies, events, mode) {
    this.bodies = bodies;
    this.events = events;
    this.byFace = mode === "unregularised";
    this.excluded = bodies.map((b) => new Uint8Array(b.regionCount));
    this.discarded = bodies.map((b) => (this.byFace ? new Uint8Array(b.faceCount) : null));
    this.bare = events.passes !== null; // wrappers start as the bodies themselves
    this.outermost = bodies.map((b) => b.outer.reduce((n, cell) => n + (cell === NONE ? 1 : 0), 0));
    this.at = -1; // the event after which the wrappers are current
    this.versions = bodies.map(() => 0); // incremented whenever the wrapper of a body changes
    this.reset();
  }

  reset() {
    for (const flags of this.excluded) flags.fill(this.bare ? 1 : 0);
    for (const flags of this.discarded) if (flags) flags.fill(0);
    this.sizes = this.bare ? this.bodies.map((b) => b.realCount) : this.outermost.slice(); // of boundaries
    this.versions = this.versions.map((n) => n + 1);
  }

  /** The solid is always included, the outside never: `solid` selects which of the two NONE means. */
  included(side, cell, solid) {
    return cell === NONE ? solid : !this.excluded[side][cell];
  }
  onBoundary(side, face) {
    const body = this.bodies[side], inFront = this.included(side, body.outer[face], false);
    if (this.byFace) return !inFront && (body.isReal(face) || !this.discarded[side][face]);
    return this.included(side, body.inner[face], true) !== inFront;
  }

  /** Moves to just after an event: forward by the events in between, backward by restarting the step.
      `goal`: {side, goal}, a face down to which a wrapper is refined, as by Wrapper::refine_path(). */
  seek(event, goal) {
    const first = this.events.firstOfStep[this.events.step(event)];
    const forward = this.at >= first && this.at <= event;
    if (!forward) this.reset();
    for (let i = forward ? this.at + 1 : first; i <= event; i++)
      if (this.events.changesWrapper(i)) this.apply(i);
    this.at = event;
    if (!goal) return;
    this.at = -1; // not the state after an event
    for (const { region } of this.bodies[goal.side].wayTo(goal.goal))
      this.change(goal.side, region, () => this.refine(goal.side, region, -1));
  }

  apply(event) {
    const side = this.events.side[event], region = this.events.a[event];
    this.change(side, region, () => {
      if (this.events.kind[event] !== this.events.REFINE) this.coarsen(side, region);
      else this.refine(side, region, this.byFace ? this.refinedFace(event, side, region) : -1);
    });
  }
  change(side, region, action) {
    const before = this.visibleOf(side, region);
    action();
    this.sizes[side] += this.visibleOf(side, region) - before;
    this.versions[side]++;
  }

  /** Returns the face that a refinement removes if wrappers are refined face by face; -1: the entire
      region. */
  refinedFace(event, side, region) {
    const cause = this.events.find(this.events.cause[event]);
    if (cause < 0 || this.events.kind[cause] !== this.events.FACE_TEST) return -1;
    const face = this.events.faces(cause)[side].face;
    return this.bodies[side].inner[face] === region ? face : -1;
  }

  refine(side, region, face) {
    if (face >= 0 && !this.onBoundary(side, face)) return;
    if (face < 0 && this.excluded[side][region]) return;
    this.excluded[side][region] = 1;
    if (!this.byFace) return;
    for (const lid of face < 0 ? this.bodies[side].lids(region) : [face]) this.discarded[side][lid] = 1;
  }

  coarsen(side, region) {
    this.excluded[side][region] = 0;
    if (this.byFace) for (const lid of this.bodies[side].lids(region)) this.discarded[side][lid] = 0;
  }

  /** Returns the number of a region's faces on the boundary. Only these change when it is refined. */
  visibleOf(side, region) {
    const count = (faces) => faces.reduce((n, face) => n + (this.onBoundary(side, face) ? 1 : 0), 0);
    return count(this.bodies[side].lids(region)) + count(this.bodies[side].floor(region));
  }
}

// ---- an event, a face, a region in words
/** Returns a whole number with its digits in groups, as the rest of the page has them. */
const relationText = (name) =>
  ({ a_inside_b: "A inside B", b_inside_a: "B inside A" })[name] || name.replaceAll("_", " ");

/** Describes the elements that an event concerns. */
export function eventText(events, i) {
  const two = events.bodies.length > 1, kind = events.kind[i], a = events.a[i], b = events.b[i];
  const side = two ? ` of ${SIDES[events.side[i]]}` : "";
  if (events.passes) return builtText(events, i);
  if (kind === events.STEP) return firstWrapperText(events.bodies);
  if (kind === events.REFINE) return `region ${digits(a)}${side}: ${plural(b, "face")} exposed`;
  if (kind === events.COARSEN) return `region ${digits(a)}${side} added`;
  if (kind === events.RESULT)
    return relationText(events.relations[a]) + ": " +
      plural(b, "intersecting pair of faces", "intersecting pairs of faces");
  const faces = events.faces(i);
  if (faces.length)
    return faces.map((f) => `${events.bodies[f.side].faceText(f.face)} of ${SIDES[f.side]}`).join(", ");
  const { a: ra, b: rb } = events.kindOf(i);
  const one = (r, n) => {
    if (r.sort === "phase") return events.phases[n];
    return `${r.words} ${digits(n)}${r.sort === "vertex" ? side : ""}`;
  };
  return [[ra, a], [rb, b]]
    .filter(([r, n]) => r.sort && n !== NONE)
    .map(([r, n]) => one(r, n))
    .join(", ");
}

/** Describes the state at the start of a step. A body without regions, such as an open one, has no
    wrapper. */
function firstWrapperText(bodies) {
  const bare = bodies.filter((b) => !b.regionCount);
  if (bodies.length === 1) return bare.length ? "the body (it has no wrapper)" : "the outermost wrapper";
  if (bare.length === 2) return "the bodies (they have no wrappers)";
  if (!bare.length) return "both outermost wrappers";
  return `${SIDES[bare[0].side]} (it has no wrapper) and ${SIDES[1 - bare[0].side]}'s outermost wrapper`;
}

/** Returns the number of visible faces of each body: of its wrapper, or of the body itself if it has no
    wrapper. */
export function sizeText(bodies, sizes) {
  const one = (n, side) =>
    (bodies.length > 1 ? `${SIDES[side]} ` : "") + digits(n) +
    (bodies[side].regionCount ? "" : " (no wrapper)");
  return `${sizes.map(one).join(" + ")} faces`;
}

/** Describes an event of a construction. */
function builtText(events, i) {
  const a = events.a[i], b = events.b[i];
  switch (events.kind[i]) {
    case events.STEP:
      return "the body";
    case events.PASS:
      return `pass ${digits(a + 1)} begins`;
    case events.PATCH:
      return `${plural(b, "face")}, grown from vertex ${digits(a)}`;
    case events.CAP:
      return b ? `${plural(a, "face")} over ${digits(b)}` : "none: no vertex could be removed";
    case events.REGION:
      return `region ${digits(a)}: ${plural(b, "face")} covered`;
    case events.PASS_END:
      return events.pass(i).words;
  }
  const kind = events.kindOf(i);
  return `${digits(a)} ${kind.a.words}, ${digits(b)} ${kind.b.words}`;
}

/** Returns the outcome of an event; empty: unknown. */
export const outcomeText = (events, i) => events.outcomes[events.outcome[i]] || "";

/** Returns the position of an event in the run. */
export function eventPlace(events, i) {
  const event = `event ${digits(events.id(i))}`;
  return events.firstOfStep.length > 1 ? `Step ${digits(events.stepNumber(i))}, ${event}`
    : `E${event.slice(1)}`;
}

/** Returns a sentence on an event and the wrappers after it. */
export function eventSentence(events, wrappers, i) {
  const meet = outcomeText(events, i);
  const result = meet ? ` (${meet})` : "";
  const about = `${eventPlace(events, i)}, ${events.kindOf(i).name}: ${eventText(events, i)}${result}.`;
  if (!wrappers || events.engine) return about;
  if (events.passes) return `${about} Front: ${digits(wrappers.sizes[0])} faces.`;
  const { sizes } = wrappers;
  return `${about} ${sizes.length > 1 ? "Wrappers" : "Wrapper"}: ${sizeText(events.bodies, sizes)}.`;
}
