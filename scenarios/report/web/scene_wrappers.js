// ---- both wrappers after an event: replayed from the beginning of its time step, as trace/include/lrbscope/trace/replay.hpp
// does it
class Wrappers {
  constructor(bodies, events, mode) {
    this.bodies = bodies;
    this.events = events;
    this.byFace = mode === "unregularised";
    this.excluded = bodies.map((b) => new Uint8Array(b.regionCount));
    this.discarded = bodies.map((b) => (this.byFace ? new Uint8Array(b.faceCount) : null));
    this.bare = events.passes !== null; // wrappers begin with the bodies themselves
    this.outermost = bodies.map((b) => b.outer.reduce((n, cell) => n + (cell === NONE ? 1 : 0), 0));
    this.at = -1; // the event that the wrappers stand after
    this.version = 0; // grows whenever a wrapper changes
    this.reset();
  }

  reset() {
    for (const flags of this.excluded) flags.fill(this.bare ? 1 : 0);
    for (const flags of this.discarded) if (flags) flags.fill(0);
    this.sizes = this.bare ? this.bodies.map((b) => b.realCount) : this.outermost.slice(); // faces on the boundaries
    this.version++;
  }

  /** The solid is always included, the outside never: `solid` says which of the two NONE stands for. */
  included(side, cell, solid) {
    return cell === NONE ? solid : !this.excluded[side][cell];
  }
  onBoundary(side, face) {
    const body = this.bodies[side],
      inFront = this.included(side, body.outer[face], false);
    if (this.byFace) return !inFront && (body.isReal(face) || !this.discarded[side][face]);
    return this.included(side, body.inner[face], true) !== inFront;
  }

  /** Moves to just after an event: forward by what lies between, backward by beginning the step again. */
  seek(event) {
    const first = this.events.firstOfStep[this.events.step(event)];
    const forward = this.at >= first && this.at <= event;
    if (!forward) this.reset();
    for (let i = forward ? this.at + 1 : first; i <= event; i++)
      if (this.events.changesWrapper(i)) this.apply(i);
    this.at = event;
  }

  apply(event) {
    const side = this.events.side[event],
      region = this.events.a[event];
    const before = this.visibleOf(side, region);
    if (this.events.kind[event] !== this.events.REFINE) this.coarsen(side, region);
    else this.refine(side, region, this.byFace ? this.refinedFace(event, side, region) : -1);
    this.sizes[side] += this.visibleOf(side, region) - before;
    this.version++;
  }

  /** Returns the face that a refinement takes away where wrappers are refined face by face; -1: all of the
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

  /** Returns the number of a region's faces on the boundary. Refining it changes nothing but these. */
  visibleOf(side, region) {
    const count = (faces) => faces.reduce((n, face) => n + (this.onBoundary(side, face) ? 1 : 0), 0);
    return count(this.bodies[side].lids(region)) + count(this.bodies[side].floor(region));
  }
}
