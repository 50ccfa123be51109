// ---- all events of a run whose page holds some: from its trace, which a person chooses or drops here. Pages from disk
// cannot fetch it.
class TraceLoader {
  /** `loaded`: called when the events have been replaced. */
  constructor(scene, events, loaded) {
    Object.assign(this, { scene, events, loaded });
    if (!scene.thinned) return;
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

  /** Replaces the page's events by those of a trace. Throws if it is of another run. */
  take(trace) {
    const { scene, events } = this,
      metadata = trace.metadata;
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

  /** Numbers without a name are not in a trace. */
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
    this.parts = new Map((scene.work ? scene.work.outcomes : []).map((o, i) => [`${o.phase}: ${o.outcome}`, i]));
    this.walk = metadata.request.recursion === "complete" ? "walk of the bodies" : "recursion";
  }

  columns(slices) {
    const names = ["kind", "side", "meet", "a", "b", "cause", "boundary", "depthA", "depthB", "outcome", "work"],
      out = Object.fromEntries(names.map((name) => [name, new Uint32Array(slices.length)])),
      steps = [];
    for (const slice of slices) {
      const i = slice.args.event,
        event = this.event(slice);
      for (const name of names) out[name][i] = event[name];
      if (slice.args["time step"] !== undefined) steps.push([slice.args["time step"], i]);
    }
    steps.sort((p, q) => p[1] - q[1]);
    return {
      ...out,
      count: slices.length,
      ids: null,
      outcomes: this.words,
      stepNumbers: Uint32Array.from(steps, (s) => s[0]),
      firstOfStep: Uint32Array.from(steps, (s) => s[1]),
    };
  }

  event(slice) {
    const { args } = slice,
      kind = this.kindOf(slice),
      { a, b } = this.kinds[kind],
      orNone = (n) => (n === undefined ? NONE : n);
    return {
      kind,
      side: Math.max(0, SIDES.indexOf(args.side || args.of || args["plane of"])),
      meet: Math.max(0, this.scene.meets.indexOf(args.meet)),
      a: this.number(args, a.words),
      b: this.number(args, b.words),
      cause: orNone(args.cause),
      boundary: orNone(args["wrapper faces"]),
      depthA: args["depth of A"] || 0,
      depthB: args["depth of B"] || 0,
      outcome: this.word(args.meet || args.where || args.verdict || args.stage || args.step),
      work: this.part(slice, this.kinds[kind].name),
    };
  }

  /** Steps, passes and phases are named by what they found; all others by their kind. */
  kindOf({ name, cat }) {
    const named = { step: "step", phase: "begin", pass: "pass" }[cat];
    return this.kindByName.has(name) ? this.kindByName.get(name) : this.kindByName.get(named);
  }

  number(args, words) {
    if (words === "") return 0;
    let value = args[words];
    if (value === undefined) value = args[words.replace("real", "pseudo")]; // of an answer to a tolerance
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
        return of(this.walk, args.step === "leaves" ? "boxes and planes of faces" : "boxes of nodes");
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
    const { origin, unit, bodies } = this.scene;
    return bodies.map(({ middle }, side) =>
      Float32Array.from(
        this.metadata.steps.flatMap((step) => {
          const p = side === 0 ? step.pose_a : step.pose_b;
          return p.map((x, i) => {
            if (i % 4 !== 3) return x;
            const row = p.slice(i - 3, i);
            return (row.reduce((sum, r, k) => sum + r * middle[k], x) - origin[(i - 3) / 4]) / unit;
          });
        }),
      ),
    );
  }
}
