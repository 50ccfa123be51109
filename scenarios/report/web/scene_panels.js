import { byId, digits, element, linkRow, plural, textButton } from "./dom.js";
import { seek, showEvent } from "./page.js";
import { placeText } from "./scene_events.js";
import { eventPlace, eventText, NONE, outcomeText, SIDES, sizeText } from "./scene_run.js";

// ---- widgets that several parts of the page use
/** What the terms of lists count or name; lists give titles of their own to others. */
const TERMS = {
  kind: "sort of the event",
  what: "elements that the event concerns",
  result: "outcome of the event",
  cause: "event that led to it",
  wrapper: "visible faces of each wrapper after the event",
  front: "faces of the surface under construction after the event",
  sort: "real faces are the body's own; pseudo faces hide detail",
  "behind it": "region behind the face, or the body",
  "in front": "region that hides the face, or the outside",
  region: "region that the face belongs to",
  parent: "region that hides this one",
  "bounding boxes": "gap or overlap of the boxes at the roots of both trees",
  "pairs of nodes": "pairs of tree nodes that the query visited",
  "pairs of faces": "pairs of faces whose boxes were compared",
  "nearest boxes": "the two boxes found disjoint that are closest to each other",
  plane: "plane with one body on each side; the gap is a lower bound of the distance",
  "nearest faces": "the pair of compared faces that is closest",
  distance: "between the two faces, in mesh units of the page's frame",
  contact: "common points of the two faces, world frame",
};

/** Fills a list of terms: [[term, value or element, title of the term]]. */
export function fillList(list, rows) {
  list.replaceChildren(
    ...rows.flatMap(([term, value, title]) => {
      const meaning = { title: title || TERMS[term] || "" };
      return [element("dt", meaning, term), element("dd", meaning, value)];
    }),
  );
}

// ---- the selection that all views show: one event, and possibly a face or a region. Views change it here
// and their listeners are notified.
export class Selection {
  constructor(events) {
    this.events = events;
    this.event = 0;
    // {side, face, region, vertex}: face NONE: a region as a whole; region NONE: a face that no region hides;
    // vertex: of a construction, with neither; otherwise NONE.
    this.picked = null;
    this.resolved = null; // {side, goal}: the wrapper of a body is refined down to a face
    this.chosen = [NONE, NONE]; // simplices of A and B that were picked in succession
    this.listeners = [];
  }

  tell(what) {
    for (const listener of this.listeners) listener(what);
  }
  /** Adds a listener to one kind of change: "event", "pick" or "look". */
  on(kind, action) {
    this.listeners.push((what) => what === kind && action());
  }
  /** Adds a listener to all changes but those of the look. */
  onContent(action) {
    this.listeners.push((what) => what !== "look" && action());
  }

  /** Moves to an event, by its index; frames and charts are already there. */
  standAt(event) {
    this.event = Math.max(0, Math.min(this.events.count - 1, event));
    this.chosen = [NONE, NONE];
    this.tell("event");
  }
  /** Moves to an event; frames and charts follow. */
  goTo(event) {
    this.standAt(event);
    showEvent(this.events.id(this.event), this.events.stepNumber(this.event));
  }

  /** `simplex`: the selected one of the face; by default the first. `goal`: the real face under it. */
  pickFace(side, face, simplex, goal = face) {
    const body = this.events.bodies[side], meant = simplex === undefined ? body.firstSimplex[face] : simplex;
    this.chosen = this.chosen.map((s, i) => (i !== side ? s : body.isReal(face) ? meant : NONE));
    this.pickOnly({ side, face, goal, region: body.regionOf(face) });
  }
  pickRegion(side, region) {
    this.pick({ side, face: NONE, region });
  }
  pickVertex(side, vertex) {
    this.pick({ side, face: NONE, region: NONE, vertex });
  }
  /** Picks a simplex of A and one of B. */
  choose(simplices) {
    this.chosen = simplices.slice();
    this.pickOnly(null);
  }
  pick(picked) {
    this.chosen = [NONE, NONE];
    if (!picked) this.resolved = null;
    this.pickOnly(picked);
  }
  pickOnly(picked) {
    this.picked = picked && { vertex: NONE, ...picked };
    this.tell("pick");
  }

  /** True if the wrapper is refined down to the selected face. */
  get isResolved() {
    const { picked, resolved } = this;
    return Boolean(resolved) && picked?.side === resolved.side && picked.goal === resolved.goal;
  }
  /** Refines the wrapper down to the selected face, or undoes it. */
  resolve() {
    const { picked, events } = this,
      isNew = picked && !this.isResolved && events.canResolve(events.bodies[picked.side], picked);
    if (!isNew && !this.resolved) return;
    this.resolved = isNew ? { side: picked.side, goal: picked.goal } : null;
    this.tell("pick");
  }
}

// ---- in the header: the relation of the bodies at the current step as a badge, and its other key figures
export class AnswerLine {
  /** `answers`: as the page has them; null: the header is about the whole run. */
  constructor(answers, events, selection) {
    Object.assign(this, { answers, events, badge: document.querySelector(".verdict:not(.bad)") });
    this.box = document.querySelector("header .numbers");
    if (!answers || !this.box) return;
    this.ofStep = new Map([...events.stepNumbers].map((number, step) => [number, answers.steps[step]]));
    selection.on("event", () => this.show(events.stepNumber(selection.event)));
  }

  show(step) {
    if (step === this.step) return;
    this.step = step;
    const { names, meanings } = this.answers,
      meaning = (name, note) => [meanings[name], note].filter(Boolean).join("; "),
      given = this.ofStep.get(step) || [],
      rows = given.map(([name, value, note]) => [names[name], value, meaning(name, note)]),
      inBadge = this.badge && rows.length > 0;
    if (inBadge) this.badge.textContent = rows[0][1];
    if (inBadge) this.badge.title = rows[0][2];
    if (this.events.firstOfStep.length > 1)
      rows.unshift(["Step", digits(step), "time step that the figures and the view are about"]);
    this.box.replaceChildren(
      ...rows
        .filter(([name]) => name !== "Relation" || !inBadge)
        .map(([name, value, title]) =>
          element("div", { title }, element("dt", {}, name), element("dd", {}, value))),
    );
  }
}

// ---- beside the view: the event, and the selected face or region, in words and numbers
export class Panel {
  constructor(events, selection, wrappers) {
    this.events = events;
    this.bodies = events.bodies;
    this.selection = selection;
    this.wrappers = wrappers;
    selection.listeners.push((what) => {
      if (what === "event" || selection.resolved !== this.resolved) this.showEvent();
      if (what === "pick") this.showPicked();
    });
    byId("picked-none").onclick = () => selection.pick(null);
  }

  name(side) {
    return this.bodies.length > 1 ? ` of ${SIDES[side]}` : "";
  }

  regionButton(side, region, words = `region ${digits(region)}`) {
    return textButton(words, () => this.selection.pickRegion(side, region));
  }

  showEvent() {
    const i = this.selection.event, events = this.events, kind = events.kindOf(i), level = events.level(i),
      cause = events.find(events.cause[i]);
    this.resolved = this.selection.resolved;
    byId("event-title").textContent = eventPlace(events, i);
    const rows = [["kind", kind.name], ["what", eventText(events, i)]];
    if (outcomeText(events, i)) rows.push(["result", outcomeText(events, i)]);
    const attempt = events.attempts && events.attempts.ofEvent.get(i);
    if (attempt && i === attempt.cap)
      rows.push([attempt.rejected ? "rejected" : "accepted", events.attempts.reason(attempt)]);
    if (level >= 0 && !events.engine) rows.push(["level", level, "number of regions up to the outside"]);
    if (cause >= 0)
      rows.push(["cause", textButton(`event ${digits(events.id(cause))}`, () => this.selection.goTo(cause))]);
    if (this.wrappers && !events.engine)
      rows.push(events.passes ? ["front", `${digits(this.wrappers.sizes[0])} faces`]
          : ["wrapper", sizeText(this.bodies, this.wrappers.sizes)]);
    const wrong = events.wrong[events.step(i)];
    if (wrong.length) rows.push(["wrong", this.wrongButton(wrong), "Pairs that the engine got wrong here"]);
    fillList(byId("event-facts"), rows);
    const parts = [
      ...events
        .faces(i)
        .map(({ side, face }) => textButton(this.bodies[side].faceText(face) + this.name(side),
            () => this.selection.pickFace(side, face))),
      ...events
        .regions(i)
        .filter((r) => this.bodies[r.side].complete)
        .map((r) => this.regionButton(r.side, r.region, `region ${digits(r.region)}${this.name(r.side)}`)),
    ];
    if (attempt && this.bodies[0].complete)
      parts.push(
        textButton(`vertex ${digits(attempt.vertex)}`, () => this.selection.pickVertex(0, attempt.vertex),
            "Start vertex of the patch (P)"),
      );
    byId("event-parts").replaceChildren(...parts);
  }

  /** Moves from one wrong pair of the step to the next, and explains it. */
  wrongButton(wrong) {
    let next = 0;
    const button = textButton(plural(wrong.length, "wrong pair"), () => {
      const { simplices, missed } = wrong[next % wrong.length];
      button.textContent =
          `${(next++ % wrong.length) + 1} of ${wrong.length}: ${missed ? "missed" : "reported"}`;
      this.selection.choose(simplices);
    });
    return button;
  }

  showPicked() {
    const { picked, resolved, isResolved } = this.selection;
    byId("picked").hidden = !picked;
    if (!picked) return;
    document.querySelector(".panel").scrollTop = 0;
    const body = this.bodies[picked.side], hasFace = picked.face !== NONE,
      hasWay = isResolved || (!hasFace && resolved?.side === picked.side);
    const name = placeText(body, picked);
    byId("picked-title").textContent = name[0].toUpperCase() + name.slice(1) + this.name(picked.side);
    fillList(byId("picked-facts"), [
      ...(hasFace && !this.events.engine ? this.faceRows(body, picked.face) : []),
      ...(hasWay ? [["way in", this.wayTo(body, resolved.goal), "faces, and the regions behind them"]] : []),
      ...(picked.vertex !== NONE ? this.vertexRows(body, picked.vertex)
        : this.regionRows(body, picked.region)),
      ...(this.events.passes ? [] : this.countRows(body, picked)),
    ]);
    byId("picked-isolate").disabled = !body.hasLids(picked.region);
    const resolve = byId("resolve"); // not with other engines and of constructions
    if (!resolve) return;
    resolve.disabled = !hasWay && !this.events.canResolve(body, picked);
    resolve.setAttribute("aria-pressed", hasWay);
  }

  faceRows(body, face) {
    const cell = (region, none) => (region === NONE ? none : `region ${digits(region)}`);
    return [
      ["sort", body.isReal(face) ? "real: the body's own" : "pseudo: hides details"],
      ["behind it", cell(body.inner[face], "the solid")],
      ["in front", cell(body.outer[face], "the outside")],
    ];
  }

  wayTo(body, goal) {
    const way = body.wayTo(goal).flatMap(({ lid, region }) =>
        [`${digits(lid)} \u2192 `, this.regionButton(body.side, region), " \u2192 "]);
    return element("span", {}, ...way, digits(goal));
  }

  /** Of a construction. */
  vertexRows(body, vertex) {
    const region = this.events.attempts.coverOf(vertex),
      made = this.events.attempts.around(vertex).every((f) => !body.isReal(f));
    return [
      ["sort", made ? "of pseudo faces alone" : "the body's own", "those of pseudo faces are made by caps"],
      ["covered by", region === NONE ? "no region: it is on the outermost wrapper"
          : this.regionButton(body.side, region)],
    ];
  }

  regionRows(body, region) {
    if (this.events.engine) return [];
    if (region === NONE) return [["region", "none hides it"]];
    const parent = body.parent[region], side = body.side;
    return [
      ["region", this.regionButton(side, region)],
      ["layer", body.layer[region], "pass of the builder that made the region; 0 lies on the solid"],
      ["depth", body.depth(region), "number of steps to the outside, along parents"],
      ["parent", parent === NONE ? "the outside" : this.regionButton(side, parent)],
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
      ["misses", sum("misses"), `tests of disjoint faces, ${of}`], ["contacts", sum("contacts"), of],
    ];
  }
}

// ---- rows of tables link to regions, time steps, pairs and boxes, and show which of them is selected
export class RowLinks {
  /** `controls`: of the view; null: there is none. */
  constructor(events, selection, controls) {
    Object.assign(this, { events, selection, controls, rows: [] });
    for (const row of document.querySelectorAll("tr[data-to]")) this.take(row);
    selection.listeners.push(() => this.mark());
    this.mark();
  }

  take(row) {
    const [sort, ...numbers] = row.dataset.to.split(" "), link = { row, sort, numbers: numbers.map(Number) };
    if (sort === "region" && !this.events.bodies[link.numbers[0]].complete) return;
    if (sort === "boxes" && !this.controls) return;
    linkRow(row, () => this.follow(link));
    this.rows.push(link);
  }

  follow({ sort, numbers }) {
    if (sort === "region") this.selection.pickRegion(...numbers);
    else if (sort === "boxes") this.controls.change({ boxes: numbers[0] });
    else seek("step", numbers[0]);
    if (sort === "pair") this.selection.choose(numbers.slice(1));
    byId("stage").scrollIntoView({ block: "nearest" });
  }

  isCurrent({ sort, numbers }) {
    const { picked, chosen, event } = this.selection;
    if (sort === "region") return picked && picked.side === numbers[0] && picked.region === numbers[1];
    if (sort === "boxes") return this.controls.view.now.boxes === numbers[0];
    if (this.events.stepNumber(event) !== numbers[0]) return false;
    return sort === "step" || chosen.every((s, side) => s === numbers[side + 1]);
  }

  mark() {
    for (const link of this.rows) {
      if (this.isCurrent(link)) link.row.setAttribute("aria-current", "true");
      else link.row.removeAttribute("aria-current");
    }
  }
}
