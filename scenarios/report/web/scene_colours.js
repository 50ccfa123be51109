import { WHITE } from "./scene_lines.js";
import { NONE } from "./scene_run.js";

// ---- counters as colours: one number for each face, on a scale common to both bodies
export const COUNTERS = ["tests", "hits", "misses"];

/** Returns tests, hits and misses of each body's faces in a step, up to an event, from the events on the
    page. */
export function countsSoFar(events, event) {
  const out = events.bodies.map((b) =>
    Object.fromEntries(COUNTERS.map((name) => [name, new Uint32Array(b.faceCount)])),
  );
  for (let i = events.firstOfStep[events.step(event)]; i <= event; i++) {
    if (events.kind[i] !== events.FACE_TEST) continue;
    for (const f of events.faces(i)) {
      out[f.side].tests[f.face]++;
      out[f.side][events.isHit(i) ? "hits" : "misses"][f.face]++;
    }
  }
  return out;
}

/** Assigns each face the sum over the faces of its group, "region" or "level". A real face belongs to the
    region that covers it, a pseudo face to the one that it hides; a face without a region keeps its own
    number. */
export function sumsOfGroups(body, per, counts) {
  const groupOf = per === "region" ? (f) => body.regionOf(f) : (f) => body.depth(body.outer[f]),
    sums = new Map();
  const groups = Uint32Array.from(counts, (_, f) => groupOf(f));
  counts.forEach((n, f) => sums.set(groups[f], (sums.get(groups[f]) || 0) + n));
  return counts.map((n, f) => (groups[f] === NONE ? n : sums.get(groups[f])));
}

// ---- colours of faces, as in the frames (render/include/lrbscope/render/style.hpp, repeated in the page's
// data)
export const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
export const mixed = (from, to, t) => from.map((c, i) => c + (to[i] - c) * t);

export class Colours {
  constructor(json) {
    this.bodies = json.bodies.map(rgb);
    this.scale = json.scale.map(rgb);
    this.categories = json.categories.map(rgb);
    for (const n of ["contact", "refining", "underTest", "selected", "ink", "wrong"]) this[n] = rgb(json[n]);
    this.stops = json.scale;
    this.edgeInk = rgb(json.edgeInk);
    this.shares = json.shares; // interpolation weights: of edges towards edgeInk, of pale faces towards white
  }

  onScale(t) {
    const at = Math.max(0, Math.min(1, t)) * (this.scale.length - 1),
      i = Math.min(Math.floor(at), this.scale.length - 2);
    return mixed(this.scale[i], this.scale[i + 1], at - i);
  }
  edge(side) {
    return mixed(this.bodies[side], this.edgeInk, this.shares.edge);
  }

  lid(side) {
    return mixed(this.bodies[side], WHITE, this.shares.lid);
  }
  /** Of the inside of a 2D body, darker than its regions. */
  solid(side) {
    return mixed(this.bodies[side], this.edgeInk, 0.28);
  }

  /** Returns the face colours of a mode: {of(side, face), key: {most, title} or null}. `newest`: regions
      of earlier layers are pale; 0: none is. */
  mode(bodies, by, counts, newest = 0) {
    const layers = 1 + bodies.reduce((most, b) => b.layer.reduce((m, l) => Math.max(m, l), most), 0);
    const pale = (side) => mixed(this.bodies[side], WHITE, this.shares.ground);
    if (by === "kind")
      return {
        of: (side, face) =>
          bodies[side].isReal(face) ? this.bodies[side] : mixed(this.bodies[side], WHITE, 0.4),
        key: null,
      };
    if (by === "layer")
      return {
        of: (side, face) => bodies[side].isReal(face) ? pale(side)
            : this.onScale(layers > 1 ? bodies[side].layer[bodies[side].inner[face]] / (layers - 1) : 1),
        key: { most: layers - 1, title: "layer" },
      };
    if (by === "region")
      return {
        of: (side, face) => bodies[side].isReal(face) ? pale(side)
            : mixed(
                this.categories[bodies[side].inner[face] % this.categories.length], WHITE,
                bodies[side].layer[bodies[side].inner[face]] < newest ? 0.68 : 0,
              ),
        key: null,
      };
    // The scale ends at what 99 of 100 counted faces do not exceed: few outliers would hide the others.
    const counted = counts.flatMap((values) => [...values.filter((v) => v > 0)]).sort((x, y) => x - y),
      most = counted.length ? counted[Math.ceil(0.99 * counted.length) - 1] : 0,
      top = counted.length ? counted[counted.length - 1] : 0;
    return {
      of: (side, face) => counts[side][face] > 0 ? this.onScale(counts[side][face] / most)
          : mixed(this.bodies[side], WHITE, this.shares.noValue),
      key: { most, top, title: "" },
    };
  }
}
