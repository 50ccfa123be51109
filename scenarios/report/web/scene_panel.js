// ---- beside the view: the event, and the face or region that is selected, in words and numbers
class Panel {
  constructor(events, selection, wrappers) {
    this.events = events;
    this.bodies = events.bodies;
    this.selection = selection;
    this.wrappers = wrappers;
    this.filterBy = () => {}; // called with a face or region, to list its events
    selection.listeners.push((what) => (what === "event" ? this.showEvent() : this.showPicked()));
  }

  name(side) {
    return this.bodies.length > 1 ? ` of ${SIDES[side]}` : "";
  }

  showEvent() {
    const i = this.selection.event,
      events = this.events,
      kind = events.kindOf(i),
      level = events.level(i),
      cause = events.find(events.cause[i]);
    byId("event-title").textContent = eventPlace(events, i);
    const rows = [
      ["kind", kind.name],
      ["what", eventWords(events, i)],
    ];
    if (outcomeWords(events, i)) rows.push(["result", outcomeWords(events, i)]);
    if (level >= 0) rows.push(["level", level, "number of regions between it and the outside"]);
    if (cause >= 0)
      rows.push([
        "cause",
        textButton(`event ${digits(events.id(cause))}`, () => this.selection.goTo(cause)),
      ]);
    if (this.wrappers)
      rows.push([
        events.passes ? "hull" : "wrapper",
        events.passes ? `${digits(this.wrappers.sizes[0])} faces` : sizeWords(this.bodies, this.wrappers.sizes),
      ]);
    const wrong = events.wrong[events.step(i)];
    if (wrong.length) rows.push(["wrong", this.wrongButton(wrong), "Pairs that the engine got wrong in this step"]);
    fillList(byId("event-facts"), rows);
    const parts = [
      ...events
        .faces(i)
        .map((f) =>
          textButton(this.bodies[f.side].faceWords(f.face) + this.name(f.side), () =>
            this.selection.pickFace(f.side, f.face),
          ),
        ),
      ...events
        .regions(i)
        .filter((r) => this.bodies[r.side].complete)
        .map((r) =>
          textButton(`region ${digits(r.region)}${this.name(r.side)}`, () =>
            this.selection.pickRegion(r.side, r.region),
          ),
        ),
    ];
    byId("event-parts").replaceChildren(...parts);
  }

  /** Goes from one wrong pair of the step to the next, and asks why. */
  wrongButton(wrong) {
    let next = 0;
    const button = textButton(plural(wrong.length, "wrong pair"), () => {
      const { simplices, missed } = wrong[next % wrong.length];
      button.textContent = `${(next++ % wrong.length) + 1} of ${wrong.length}: ${missed ? "missed" : "reported"}`;
      this.selection.choose(simplices);
    });
    return button;
  }

  showPicked() {
    const picked = this.selection.picked;
    byId("picked").hidden = !picked;
    byId("nothing-picked").hidden = Boolean(picked);
    if (!picked) return;
    const body = this.bodies[picked.side],
      hasFace = picked.face !== NONE;
    const name = hasFace ? body.faceWords(picked.face) : `region ${digits(picked.region)}`;
    byId("picked-title").textContent = name[0].toUpperCase() + name.slice(1) + this.name(picked.side);
    fillList(byId("picked-facts"), [
      ...(hasFace ? this.faceRows(body, picked.face) : []),
      ...this.regionRows(body, picked.region),
      ...(this.events.passes ? [] : this.countRows(body, picked)),
    ]);
    byId("picked-isolate").disabled = picked.region === NONE;
  }

  faceRows(body, face) {
    const cell = (region, none) => (region === NONE ? none : `region ${digits(region)}`);
    return [
      ["sort", body.isReal(face) ? "real: the body's own" : "pseudo: hides details"],
      ["behind it", cell(body.inner[face], "the solid")],
      ["in front", cell(body.outer[face], "the outside")],
    ];
  }

  regionRows(body, region) {
    if (region === NONE) return [["region", "none hides it"]];
    const parent = body.parent[region],
      side = body.side;
    return [
      ["region", textButton(digits(region), () => this.selection.pickRegion(side, region))],
      ["layer", body.layer[region], "pass of the builder that made the region; 0 lies on the solid"],
      ["depth", body.depth(region), "number of steps to the outside, along parents"],
      [
        "parent",
        parent === NONE
          ? "the outside"
          : textButton(digits(parent), () => this.selection.pickRegion(side, parent)),
      ],
      ["lids", body.lids(region).length, "faces that hide the region"],
      ["floor", body.floor(region).length, "faces that the region hides"],
    ];
  }

  countRows(body, { face, region }) {
    const faces = face !== NONE ? [face] : [...body.lids(region), ...body.floor(region)];
    const sum = (name) => digits(faces.reduce((n, f) => n + body.counts[name][f], 0));
    const of = face !== NONE ? "in the whole run" : "of all its faces, in the whole run";
    return [
      ["tests", sum("tests"), `exact comparisons ${of}`],
      ["hits", sum("hits"), `tests that found faces to meet, ${of}`],
      ["misses", sum("misses"), `tests that found faces apart, ${of}`],
      ["contacts", sum("contacts"), of],
    ];
  }
}
