// ---- which events the table lists
class EventFilter {
  constructor() {
    this.clear();
  }

  clear() {
    this.kind = -1; // all
    this.side = -1;
    this.region = NONE;
    this.leastLevel = 0;
    this.mostLevel = Infinity;
    this.work = null; // {name, phase, parts: numbers of parts of the work}; null: any
    this.pair = [NONE, NONE]; // faces of A and B; NONE: any
  }

  /** Takes "12, 34", "12," or ",34"; returns false if it is none of these. */
  setPair(text) {
    const match = /^\s*(\d*)\s*[,–-]?\s*(\d*)\s*$/.exec(text);
    if (!match) return false;
    this.pair = [match[1], match[2]].map((n) => (n === "" ? NONE : Number(n)));
    return true;
  }

  /** Takes "3", "2-5", "2-" or "" (all). */
  setLevel(text) {
    const match = /^\s*(\d*)\s*([–-]?)\s*(\d*)\s*$/.exec(text);
    if (!match) return false;
    this.leastLevel = match[1] === "" ? 0 : Number(match[1]);
    this.mostLevel =
      match[3] !== "" ? Number(match[3]) : match[2] || match[1] === "" ? Infinity : this.leastLevel;
    return true;
  }

  /** Returns the indices of the events that pass. */
  apply(events) {
    const out = new Uint32Array(events.count),
      tests = this.tests(events);
    let n = 0;
    for (let i = 0; i < events.count; i++) if (tests.every((test) => test(i))) out[n++] = i;
    return out.subarray(0, n);
  }

  tests(events) {
    const out = [],
      { side, region, leastLevel, mostLevel, pair } = this;
    if (this.kind >= 0) out.push((i) => events.kind[i] === this.kind);
    if (this.work) out.push((i) => this.work.parts.has(events.work[i]));
    if (side >= 0) out.push((i) => events.concerns(i, side));
    if (region !== NONE) out.push((i) => this.concernsRegion(events, i));
    if (leastLevel > 0 || mostLevel < Infinity)
      out.push((i) => {
        const level = events.level(i);
        return level >= leastLevel && level <= mostLevel;
      });
    if (pair.some((face) => face !== NONE))
      out.push((i) => {
        const faces = events.faces(i);
        return faces.length > 0 && faces.every((f) => pair[f.side] === NONE || pair[f.side] === f.face);
      });
    return out;
  }

  /** Tells whether an event changes the region, or compares one of its faces. */
  concernsRegion(events, i) {
    const { side, region } = this;
    if (events.regions(i).some((r) => r.region === region && (side < 0 || r.side === side))) return true;
    return events.faces(i).some((f) => {
      const body = events.bodies[f.side];
      return (
        (side < 0 || f.side === side) && (body.inner[f.face] === region || body.outer[f.face] === region)
      );
    });
  }
}
