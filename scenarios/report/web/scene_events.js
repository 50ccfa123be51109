// ---- the run's events, as far as the page has them. An event is known here by its index among these; what
// people see is its id, its number in the trace. What the numbers `a` and `b` of a kind mean is taken from
// the
// kind's words, so that new kinds are shown too.
class Events {
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
    this.work = unpack(json.events.work); // number of the part of the work that the event is; NONE: none
    this.wrong = wrongPairs(json.wrong, json.steps.count);
    this.phases = json.phases;
    this.relations = json.relations;
    this.stepNumbers = unpack(json.steps.index);
    this.firstOfStep = unpack(json.steps.first).map((id) => this.from(id));
    const kind = (name) => this.kinds.findIndex((k) => k.name === name);
    this.STEP = kind("step");
    this.FACE_TEST = kind("face test");
    this.REFINE = kind("refine");
    this.COARSEN = kind("coarsen");
    this.CONTACT = kind("contact");
    this.RESULT = kind("result");
    this.PATCH = kind("patch");
    this.CAP = kind("cap");
    this.REGION = kind("region");
    this.PASS = kind("pass");
    this.PASS_END = kind("pass end");
    /** Of a construction, which begins with the body itself: [{first, last, words}], ids of events; else null. */
    this.passes = json.passes;
  }

  /** Takes other events of the same run: all of them. */
  replace(columns) {
    const wrong = new Map([...this.stepNumbers].map((number, step) => [number, this.wrong[step]]));
    Object.assign(this, columns);
    this.wrong = [...this.stepNumbers].map((number) => wrong.get(number) || []);
  }

  id(i) {
    return this.ids ? this.ids[i] : i;
  }
  /** Returns the last event that is here and not later than the one with this id. */
  at(id) {
    return Math.max(0, this.ids ? lastAtMost(this.ids, id) : Math.min(id, this.count - 1));
  }
  /** Returns the first event that is here and not earlier than the one with this id. */
  from(id) {
    return this.ids ? lastAtMost(this.ids, id - 1) + 1 : id;
  }
  /** Returns the event with this id; -1: it is not here. */
  find(id) {
    const i = id === NONE ? -1 : this.at(id);
    return i >= 0 && this.id(i) === id ? i : -1;
  }

  /** Returns the index of an event's time step among those that are here. */
  step(i) {
    return lastAtMost(this.firstOfStep, i);
  }
  endOfStep(step) {
    return step + 1 < this.firstOfStep.length ? this.firstOfStep[step + 1] : this.count;
  }
  /** Returns the number of an event's time step, as the scenario has it. */
  stepNumber(i) {
    return this.stepNumbers[this.step(i)];
  }
  kindOf(i) {
    return this.kinds[this.kind[i]];
  }
  changesWrapper(i) {
    return [this.REFINE, this.COARSEN, this.REGION].includes(this.kind[i]);
  }
  /** Tells whether an event concerns a body. */
  concerns(i, side) {
    const { a, b } = this.kindOf(i);
    if (a.side >= 0 || b.side >= 0) return true; // both
    return (a.sort === "region" || a.sort === "vertex") && this.side[i] === side;
  }
  isHit(i) {
    return this.meet[i] > 0;
  }

  /** Returns what an event is about, of one sort: [{side, number}]. */
  about(i, sort) {
    const kind = this.kindOf(i),
      out = [];
    for (const [r, number] of [
      [kind.a, this.a[i]],
      [kind.b, this.b[i]],
    ])
      if (r.sort === sort && number !== NONE) out.push({ side: r.side >= 0 ? r.side : this.side[i], number });
    return out;
  }
  /** Returns the faces that an event compares: [{side, face}]; none if the bodies are too large for the
      page. */
  faces(i) {
    return this.about(i, "simplex")
      .filter((s) => this.bodies[s.side].complete)
      .map((s) => ({ side: s.side, face: this.bodies[s.side].faceOfSimplex(s.number) }));
  }
  regions(i) {
    return this.about(i, "region").map((r) => ({ side: r.side, region: r.number }));
  }
  /** Returns the number of regions between what the event is about and the outside; of two faces the
      greater; -1: none. */
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
  /** Returns the regions that a construction made in the pass of an event, so far: [{side, region}]. */
  builtIn(i) {
    const pass = this.pass(i),
      out = [];
    for (let k = pass ? this.from(pass.first) : i + 1; k <= i; k++)
      if (this.kind[k] === this.REGION) out.push({ side: 0, region: this.a[k] });
    return out;
  }
  /** Returns the event that compares the faces which led to this one; -1: none that is here. */
  test(i) {
    if (this.about(i, "simplex").length > 0) return i;
    const cause = this.find(this.cause[i]);
    return cause >= 0 && this.about(cause, "simplex").length > 0 ? cause : -1;
  }
}

/** Returns what a number of an event stands for: {sort, side, words}; side -1: that of the event, if it has one. */
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
