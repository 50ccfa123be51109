import { byId, digits, element, linkRow, oncePerFrame, percent, plural, short, svgElement, textButton } from "./dom.js";
import { seek, showEvent } from "./page.js";
import { eventPlace, eventText, lastAtMost, NONE, outcomeText, SIDES, sizeText, unpack } from "./scene_run.js";

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

/** Copies text; returns true on success. `element` contains the text, and is selected if there is no
    clipboard, as on pages from disk. */
export async function copyText(text, element) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    getSelection().selectAllChildren(element);
    return document.execCommand("copy");
  }
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
    this.chosen = [NONE, NONE]; // simplices of A and B that were picked in succession
    this.listeners = [];
  }

  tell(what) {
    for (const listener of this.listeners) listener(what);
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

  /** `simplex`: the selected one of the face; by default the first. */
  pickFace(side, face, simplex) {
    const body = this.events.bodies[side], meant = simplex === undefined ? body.firstSimplex[face] : simplex;
    this.chosen = this.chosen.map((s, i) => (i !== side ? s : body.isReal(face) ? meant : NONE));
    this.pickOnly({ side, face, region: body.regionOf(face) });
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
    this.pickOnly(picked);
  }
  pickOnly(picked) {
    this.picked = picked && { vertex: NONE, ...picked };
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
    selection.listeners.push((what) => {
      if (what === "event") this.show(events.stepNumber(selection.event));
    });
  }

  show(step) {
    if (step === this.step) return;
    this.step = step;
    const { names, meanings } = this.answers,
      rows = (this.ofStep.get(step) || []).map(([name, value, note]) => [names[name], value, [meanings[name], note].filter(Boolean).join("; ")]),
      inBadge = this.badge && rows.length > 0;
    if (inBadge) this.badge.textContent = rows[0][1];
    if (inBadge) this.badge.title = rows[0][2];
    if (this.events.firstOfStep.length > 1) rows.unshift(["Step", digits(step), "time step that the figures and the view are about"]);
    this.box.replaceChildren(
      ...rows
        .filter(([name]) => name !== "Relation" || !inBadge)
        .map(([name, value, title]) => element("div", { title }, element("dt", {}, name), element("dd", {}, value))),
    );
  }
}

// ---- the events listed in the table
export class EventFilter {
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
    this.place = null; // {name, events: indices}, of a construction; null: any
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
    const out = new Uint32Array(events.count), tests = this.tests(events);
    let n = 0;
    for (let i = 0; i < events.count; i++) if (tests.every((test) => test(i))) out[n++] = i;
    return out.subarray(0, n);
  }

  tests(events) {
    const out = [], { side, region, leastLevel, mostLevel, pair } = this;
    if (this.kind >= 0) out.push((i) => events.kind[i] === this.kind);
    if (this.work) out.push((i) => this.work.parts.has(events.work[i]));
    if (this.place) out.push((i) => this.place.events.has(i));
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

  /** Returns true if an event changes the region, or compares one of its faces. */
  concernsRegion(events, i) {
    return concernsRegion(events, i, this.side, this.region);
  }
}

/** Returns true if an event changes a region, or compares one of its faces. `side`: -1: of any body. */
function concernsRegion(events, i, side, region) {
  if (events.regions(i).some((r) => r.region === region && (side < 0 || r.side === side))) return true;
  return events.faces(i).some((f) => {
    const body = events.bodies[f.side];
    return (
      (side < 0 || f.side === side) && (body.inner[f.face] === region || body.outer[f.face] === region)
    );
  });
}

/** Returns the name of a selected vertex, face or region. */
const placeText = (body, { vertex, face, region }) =>
  vertex !== NONE ? `vertex ${digits(vertex)}` : face !== NONE ? body.faceText(face) : `region ${digits(region)}`;

/** Returns true if an event concerns the selected vertex, face or region; of a construction, if it is of an attempt
    there. */
export function concernsPicked(events, i, picked) {
  if (!picked) return false;
  if (events.attempts) return events.attempts.eventsAt(picked).has(i);
  if (picked.face === NONE) return concernsRegion(events, i, picked.side, picked.region);
  return events.faces(i).some((f) => f.side === picked.side && f.face === picked.face);
}

// ---- the events as a table. The document has only the visible rows, so that a million is as fast as ten.
const TALLEST = 5e6; // pixels: browsers cannot scroll much further

export class EventTable {
  constructor(events, selection, filter) {
    this.events = events;
    this.selection = selection;
    this.filter = filter;
    this.box = byId("event-rows");
    this.body = byId("event-body");
    this.spacer = byId("event-spacer");
    this.rows = new Uint32Array(0); // events that pass the filter
    this.first = 0; // the first visible one
    this.known = 0; // scroll position set for `first`, which is then not to be rounded
    this.box.addEventListener("scroll", () => {
      if (Math.abs(this.box.scrollTop - this.known) >= 1) this.first = this.rowAt(this.box.scrollTop);
      this.draw();
    });
    this.body.addEventListener("click", (e) => {
      const row = e.target.closest("[data-event]");
      if (!row) return;
      this.selection.goTo(Number(row.dataset.event));
      if (events.attempts) events.attempts.pickPlace(this.selection.event, selection);
    });
    selection.listeners.push((what) => {
      if (what === "event") this.follow();
      if (what === "pick") this.draw();
    });
    new ResizeObserver(oncePerFrame(() => this.resize())).observe(this.box);
    this.refilter();
  }

  get rowHeight() {
    return parseFloat(getComputedStyle(this.box).getPropertyValue("--row"));
  } // pixels
  get fitting() {
    return Math.max(1, Math.floor(this.box.clientHeight / this.rowHeight) - 1);
  } // below the row of titles
  get height() {
    return Math.min(TALLEST, (this.rows.length + 1) * this.rowHeight);
  }
  get slack() {
    return Math.max(1, this.height - this.box.clientHeight);
  }
  get lastFirst() {
    return Math.max(0, this.rows.length - this.fitting);
  }
  rowAt(top) {
    return Math.round(Math.min(1, top / this.slack) * this.lastFirst);
  }

  resize() {
    this.spacer.style.height = `${this.height}px`;
    this.follow();
  }

  refilter() {
    this.rows = this.filter.apply(this.events);
    this.spacer.style.height = `${this.height}px`;
    byId("event-count").textContent = this.rows.length === this.events.count
        ? plural(this.rows.length, "event")
        : `${digits(this.rows.length)} of ${plural(this.events.count, "event")}`;
    this.follow();
  }

  /** Scrolls, if necessary, to the selected event, or to the last one before it that is listed. */
  follow() {
    this.row = Math.max(0, lastAtMost(this.rows, this.selection.event));
    if (this.row < this.first || this.row >= this.first + this.fitting - 1)
      this.scrollTo(this.row - Math.floor(this.fitting / 3));
    this.draw();
  }

  scrollTo(row) {
    this.first = Math.max(0, Math.min(this.lastFirst, row));
    this.box.scrollTop = this.lastFirst > 0 ? (this.first / this.lastFirst) * this.slack : 0;
    this.known = this.box.scrollTop;
  }

  /** Moves the selection by `by` listed events. */
  step(by) {
    if (!this.rows.length) return;
    const here = lastAtMost(this.rows, this.selection.event),
      exact = here >= 0 && this.rows[here] === this.selection.event;
    const row = here + by + (by < 0 && !exact ? 1 : 0);
    this.selection.goTo(this.rows[Math.max(0, Math.min(this.rows.length - 1, row))]);
  }

  draw() {
    const end = Math.min(this.rows.length, this.first + this.fitting);
    this.body.style.top = `${this.box.scrollTop + this.rowHeight}px`;
    this.body.replaceChildren(
      ...Array.from({ length: end - this.first }, (_, k) => this.line(this.first + k)),
    );
    byId("event-none").hidden = this.rows.length > 0;
  }

  line(row) {
    const i = this.rows[row], events = this.events, level = events.level(i),
      selected = i === this.selection.event,
      line = element("div", { class: "row", role: "row", "aria-rowindex": row + 1, "aria-selected": selected });
    line.classList.toggle("concerned", concernsPicked(events, i, this.selection.picked));
    line.dataset.event = i;
    const cause = events.cause[i];
    const cells = [
      digits(events.id(i)), digits(events.stepNumber(i)), events.kindOf(i).name, eventText(events, i),
      outcomeText(events, i), level < 0 ? "" : level, cause === NONE ? "" : digits(cause),
    ];
    cells.forEach((text, column) => {
      const cell = element("span", { role: "cell", title: text }, String(text)); // which may be too long
      if (column === 2) cell.style.setProperty("--kind", events.kindOf(i).colour);
      line.append(cell);
    });
    return line;
  }
}

// ---- the fields that filter the table
export class FilterForm {
  constructor(events, filter, table) {
    Object.assign(this, { events, filter, table });
    this.listeners = []; // notified when another part of the work is listed
    this.listKinds();
    byId("filter-side").closest("label").hidden = byId("filter-pair").closest("label").hidden =
      events.bodies.length < 2;
    for (const field of ["kind", "side", "region", "level", "pair"])
      byId(`filter-${field}`).addEventListener("input", () => this.read());
    byId("filters").addEventListener("submit", (e) => e.preventDefault());
    byId("filter-clear").onclick = () => this.clear();
  }

  /** Lists the kinds of events of the run. */
  listKinds() {
    const kind = byId("filter-kind"), present = new Set(this.events.kind), chosen = kind.value;
    kind.replaceChildren(new Option("all", -1));
    this.events.kinds.forEach((k, i) => {
      if (present.has(i)) kind.append(new Option(k.name, i));
    });
    kind.value = chosen;
  }

  read() {
    const value = (field) => byId(`filter-${field}`).value.trim(),
      valid = (field, is) => byId(`filter-${field}`).setAttribute("aria-invalid", !is);
    this.filter.kind = Number(value("kind"));
    this.filter.side = Number(value("side"));
    valid("region", /^\d*$/.test(value("region")));
    this.filter.region = /^\d+$/.test(value("region")) ? Number(value("region")) : NONE;
    valid("level", this.filter.setLevel(value("level")));
    valid("pair", this.filter.setPair(value("pair")));
    const { work, place } = this.filter;
    byId("filter-work").hidden = !work && !place;
    byId("filter-work").textContent = work ? `part: ${work.name}` : place ? `attempts at ${place.name}` : "";
    this.table.refilter();
    for (const listener of this.listeners) listener();
  }

  clear() {
    this.filter.work = this.filter.place = null;
    byId("filter-kind").value = byId("filter-side").value = "-1";
    for (const field of ["region", "level", "pair"]) byId(`filter-${field}`).value = "";
    this.read();
  }

  /** Lists the events of a part of the work; null: all. */
  showWork(work) {
    this.clear();
    this.filter.work = work;
    this.read();
  }

  /** Lists the events of a face, or of a region. */
  showPicked(picked) {
    this.clear();
    const { attempts } = this.events;
    if (attempts) this.filter.place = { name: placeText(attempts.body, picked), events: attempts.eventsAt(picked) };
    else if (picked.face !== NONE)
      byId("filter-pair").value = picked.side === 0 ? `${picked.face},` : `,${picked.face}`;
    else {
      byId("filter-side").value = String(picked.side);
      byId("filter-region").value = String(picked.region);
    }
    this.read();
  }
}

// ---- beside the view: the event, and the selected face or region, in words and numbers
export class Panel {
  constructor(events, selection, wrappers) {
    this.events = events;
    this.bodies = events.bodies;
    this.selection = selection;
    this.wrappers = wrappers;
    this.filterBy = () => {}; // called with a face or region, to list its events
    selection.listeners.push((what) => {
      if (what === "event") this.showEvent();
      if (what === "pick") this.showPicked();
    });
    byId("picked-none").onclick = () => selection.pick(null);
  }

  name(side) {
    return this.bodies.length > 1 ? ` of ${SIDES[side]}` : "";
  }

  showEvent() {
    const i = this.selection.event, events = this.events, kind = events.kindOf(i), level = events.level(i),
      cause = events.find(events.cause[i]);
    byId("event-title").textContent = eventPlace(events, i);
    const rows = [["kind", kind.name], ["what", eventText(events, i)]];
    if (outcomeText(events, i)) rows.push(["result", outcomeText(events, i)]);
    const attempt = events.attempts && events.attempts.ofEvent.get(i);
    if (attempt && i === attempt.cap) rows.push([attempt.rejected ? "rejected" : "accepted", events.attempts.reason(attempt)]);
    if (level >= 0 && !events.engine) rows.push(["level", level, "number of regions between it and the outside"]);
    if (cause >= 0)
      rows.push(["cause", textButton(`event ${digits(events.id(cause))}`, () => this.selection.goTo(cause))]);
    if (this.wrappers && !events.engine)
      rows.push([
        events.passes ? "front" : "wrapper",
        events.passes ? `${digits(this.wrappers.sizes[0])} faces` : sizeText(this.bodies, this.wrappers.sizes),
      ]);
    const wrong = events.wrong[events.step(i)];
    if (wrong.length) rows.push(["wrong", this.wrongButton(wrong), "Pairs that the engine got wrong in this step"]);
    fillList(byId("event-facts"), rows);
    const parts = [
      ...events
        .faces(i)
        .map((f) => textButton(this.bodies[f.side].faceText(f.face) + this.name(f.side), () =>
            this.selection.pickFace(f.side, f.face),
          ),
        ),
      ...events
        .regions(i)
        .filter((r) => this.bodies[r.side].complete)
        .map((r) => textButton(`region ${digits(r.region)}${this.name(r.side)}`, () =>
            this.selection.pickRegion(r.side, r.region),
          ),
        ),
    ];
    if (attempt && this.bodies[0].complete)
      parts.push(
        textButton(`vertex ${digits(attempt.vertex)}`, () => this.selection.pickVertex(0, attempt.vertex), "Start vertex of the patch (P)"),
      );
    byId("event-parts").replaceChildren(...parts);
  }

  /** Moves from one wrong pair of the step to the next, and explains it. */
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
    if (!picked) return;
    document.querySelector(".panel").scrollTop = 0;
    const body = this.bodies[picked.side], hasFace = picked.face !== NONE;
    const name = placeText(body, picked);
    byId("picked-title").textContent = name[0].toUpperCase() + name.slice(1) + this.name(picked.side);
    fillList(byId("picked-facts"), [
      ...(hasFace && !this.events.engine ? this.faceRows(body, picked.face) : []),
      ...(picked.vertex !== NONE ? this.vertexRows(body, picked.vertex) : this.regionRows(body, picked.region)),
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

  /** Of a construction. */
  vertexRows(body, vertex) {
    const region = this.events.attempts.coverOf(vertex),
      made = this.events.attempts.around(vertex).every((f) => !body.isReal(f));
    return [
      ["sort", made ? "of pseudo faces alone" : "the body's own", "vertices of pseudo faces are made by caps"],
      [
        "covered by",
        region === NONE ? "no region: it is on the outermost wrapper"
          : textButton(`region ${digits(region)}`, () => this.selection.pickRegion(body.side, region)),
      ],
    ];
  }

  regionRows(body, region) {
    if (this.events.engine) return [];
    if (region === NONE) return [["region", "none hides it"]];
    const parent = body.parent[region], side = body.side;
    return [
      ["region", textButton(digits(region), () => this.selection.pickRegion(side, region))],
      ["layer", body.layer[region], "pass of the builder that made the region; 0 lies on the solid"],
      ["depth", body.depth(region), "number of steps to the outside, along parents"],
      [
        "parent",
        parent === NONE ? "the outside"
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
      ["misses", sum("misses"), `tests of disjoint faces, ${of}`], ["contacts", sum("contacts"), of],
    ];
  }
}

// ---- beside the view: why the two faces of an event, or two that were clicked, intersect or not; and for a
// step without contact what separates the bodies
/** Returns a positive number rounded down to four digits, for lower bounds. */
const least = (x) => {
  const near = Number(x.toPrecision(4));
  return short(near > x ? x - 0.5 * 10 ** (Math.floor(Math.log10(x)) - 3) : x);
};
/** Distances of more ulps are shown without them: double arithmetic decides them reliably. */
const MOST_ULPS = 1e6;

export class WhyPanel {
  constructor(explanations, events, selection) {
    Object.assign(this, { explanations, events, selection });
    this.listeners = []; // notified when the explanation, or the highlighted row, has changed
    this.now = null; // {kind: "pair" | "step", key, found}
    this.row = -1; // of the path, whose boxes the view shows
    byId("why-copy").onclick = () => this.copy();
    byId("why-way").addEventListener("click", (e) => this.point(e.target.closest("[data-row]")));
    if (!explanations.none)
      selection.listeners.push((what) => {
        if (what !== "look") this.show();
      });
  }

  tell() {
    for (const listener of this.listeners) listener();
  }

  /** Returns the two simplices to be explained; null: none. */
  requested() {
    const { events, selection } = this, chosen = selection.chosen;
    if (chosen.every((s) => s !== NONE)) return chosen;
    const test = events.test(selection.event);
    if (test < 0) return null;
    const simplices = [NONE, NONE];
    for (const s of events.about(test, "simplex")) simplices[s.side] = s.number;
    return simplices.some((s) => s === NONE) ? null : simplices;
  }

  show() {
    const { events, selection, explanations } = this, step = events.stepNumber(selection.event),
      simplices = this.requested(),
      separation = simplices ? null : explanations.step(step);
    this.row = -1;
    const found = simplices ? explanations.pair(step, simplices) : separation;
    this.now = found && {
      kind: simplices ? "pair" : "step", key: `${step} ${simplices || ""}`, found,
    };
    byId("why").hidden = !simplices && !separation;
    if (simplices) this.showPair(simplices, found);
    else if (separation) this.showStep(separation);
    this.command = explanations.commandFor(events.stepNumber(selection.event), simplices);
    byId("why-command").textContent = this.command;
    byId("why-ask").hidden = !this.command;
    byId("why-copied").textContent = "";
    this.tell();
  }

  title(text) {
    const engine = this.events.engine ? ", by lrbscope\u2019s own walk" : "";
    byId("why-title").textContent = text + engine;
  }

  // -- a pair
  showPair(simplices, e) {
    const { events } = this;
    const names = simplices.map((s, side) => {
      const body = events.bodies[side];
      return body.complete ? `${body.faceText(body.faceOfSimplex(s))} of ${SIDES[side]}`
        : `simplex ${digits(s)} of ${SIDES[side]}`;
    });
    this.title(`Why: ${names.join(", ")}`);
    byId("why-note").textContent = e ? ""
      : `${this.explanations.cut || "Not among the pairs that were compared one by one here."} ` +
        "The command below explains it.";
    byId("why-verdict").textContent = e
      ? `${["The faces are disjoint", "The faces touch", "The faces cross"][e.meet]}. Decided by ${e.by}.`
      : "";
    this.showWay(e ? e.rows : []);
    this.showFacts(e ? this.pairFacts(e) : []);
    this.showRegions(simplices);
  }

  pairFacts(e) {
    const rows = e.corners.map((corners, side) => [
      `${SIDES[side]}\u2019s corners`,
      corners
        .slice(0, this.events.dim)
        .map(({ distance, exact, inDouble }) => {
          const where = exact > 0 ? "in front" : exact < 0 ? "behind" : "in it";
          const wrong = inDouble === exact ? "" : `, where doubles say ${inDouble}`;
          return `${where}${exact ? ` ${short(Math.abs(distance))}` : ""}${wrong}`;
        })
        .join("; "),
      `On which side of the other face\u2019s ${this.events.dim === 3 ? "plane" : "line"}, exactly, and at which distance`,
    ]);
    if (e.meet === 0)
      rows.push(
        e.ulps < MOST_ULPS
          ? ["distance", `${short(e.distance)}, ${short(e.ulps)} ulps`, "Of the largest coordinate"]
          : ["distance", short(e.distance)],
      );
    else {
      // Those with equal text, once.
      const points = [...new Set(e.points.map((p) => `(${this.world(p).map(short).join(", ")})`))];
      rows.push([
        "contact",
        `${["nothing", "a point", "a segment"][points.length] || "a polygon"}, ${points.join(" to ")}`,
      ]);
    }
    return rows;
  }

  world(p) {
    return p.map((x, i) => this.events.frame.origin[i] + this.events.frame.unit * x);
  }

  /** The regions that hide the faces, from the outside inward. */
  showRegions(simplices) {
    const lines = simplices.map((s, side) => {
      const body = this.events.bodies[side], line = element("p");
      if (!body.complete) return line;
      const regions = [];
      for (let r = body.outer[body.faceOfSimplex(s)]; r !== NONE; r = body.parent[r]) regions.unshift(r);
      line.className = "parts";
      const words = regions.length ? `hidden by ${plural(regions.length, "region")}:` : "hidden by no region";
      line.append(
        `${SIDES[side]}\u2019s face is ${words} `,
        ...regions.map((r) =>
          textButton(
            digits(r),
            () => this.selection.pickRegion(side, r),
            `Region ${digits(r)} of ${SIDES[side]}, layer ${body.layer[r]}`,
          ),
        ),
      );
      return line;
    });
    byId("why-regions").replaceChildren(...(this.events.engine ? [] : lines)); // another engine has no regions
  }

  // -- a step
  showStep(e) {
    this.title("What separates the bodies");
    byId("why-note").textContent = "";
    byId("why-regions").replaceChildren();
    byId("why-verdict").textContent = this.stepText(e);
    this.showWay([]);
    const pairs = e.depths.reduce((n, [all]) => n + all, 0);
    this.showFacts([
      ["bounding boxes", e.roots.gap > 0 ? `gap ${short(e.roots.gap)}` : `overlap by ${short(-e.roots.gap)}`],
      ["pairs of nodes", `${digits(pairs)}, to depth ${e.depths.length - 1}`],
      [
        "pairs of faces",
        e.facePairs > 0
          ? `${digits(e.facePairs)} with overlapping boxes; planes separate ${digits(e.facePairs - e.left)}, ` +
            `${digits(e.left)} are compared` : "none: the walk did not come so far",
      ],
      ...(e.boxes ? [["nearest boxes", this.boxText(e.boxes)]] : []),
      ...(e.plane
        ? [["plane", `across (${e.plane.normal.map((x) => short(Number(x.toFixed(4)))).join(", ")}), gap \u2265 ${least(e.plane.gap)}`]]
        : []),
      ...(e.near ? [["nearest faces", this.nearButton(e.near)]] : []),
    ]);
  }

  stepText(e) {
    const inside = e.relation !== "separate";
    if (e.plane)
      return `Apart: a plane has all of A on one side and all of B on the other, gap \u2265 ${least(e.plane.gap)}.`;
    const what = inside ? "No faces intersect; one body is inside the other"
      : "Apart, though no plane was found that has one body on each side";
    const last = e.left > 0 ? ", or in faces that planes and tests part" : e.facePairs > 0
          ? ", or in faces separated by planes" : "";
    return `${what}: the traversal ended in pairs of disjoint boxes${last}.`;
  }

  boxText(boxes) {
    const of = boxes.ofFaces ? "faces in nodes" : "nodes";
    return `${of} ${digits(boxes.a)} of A and ${digits(boxes.b)} of B, gap ${short(boxes.gap)} along ${boxes.axis}`;
  }

  nearButton(near) {
    return textButton("why they do not meet", () => this.selection.choose(near));
  }

  // -- the path from the roots, and facts
  showWay(rows) {
    byId("why-table").hidden = !rows.length;
    byId("why-way").replaceChildren(
      ...rows.map((row, k) => {
        const line = element("tr"),
          cell = (content, numeric) => line.append(element("td", { class: numeric ? "n" : "" }, content));
        const button = textButton(row.nodes.map(digits).join(", "), null, "Show the two boxes");
        button.dataset.row = k;
        button.setAttribute("aria-pressed", false);
        if (row.faces) cell("faces");
        else cell(this.events.engine ? button.textContent : button); // see nodes()
        cell(short(row.gap), true);
        cell(row.axis.replace(/^(.*) of (.)'s box$/, "$2, $1"));
        return line;
      }),
    );
  }

  /** Highlights the boxes of a row, or clears the highlight. */
  point(button) {
    if (!button) return;
    const row = Number(button.dataset.row);
    this.row = this.row === row ? -1 : row;
    for (const b of byId("why-way").querySelectorAll("[data-row]"))
      b.setAttribute("aria-pressed", Number(b.dataset.row) === this.row);
    this.tell();
  }

  /** Returns the nodes of the highlighted row. */
  nodes() {
    // The nodes are lrbscope's; with another engine, the view has the boxes of that engine's trees.
    if (this.events.engine || this.row < 0 || !this.now || this.now.kind !== "pair") return [];
    return this.now.found.rows[this.row].nodes.map((number, side) => ({ side, number }));
  }

  showFacts(rows) {
    fillList(byId("why-facts"), rows);
  }

  async copy() {
    byId("why-copied").textContent = (await copyText(this.command, byId("why-command"))) ? "Copied." : "";
  }
}

// ---- the sorts of work, as the picture at the top and the icicle colour them
export const WORK_SORTS = [
  { name: "boxes", of: /^boxes( of nodes)?$/, colour: "var(--work-boxes)" },
  { name: "bounds of faces", of: /planes|leaves/, colour: "var(--work-planes)" },
  { name: "face tests", of: /^face tests/, colour: "var(--work-tests)" },
  { name: "refined", of: /^wrappers refined/, colour: "var(--work-refined)" },
  { name: "others", of: /./, colour: "var(--work-others)" },
];
/** Returns the sort of a part of the work. */
export const workSort = ({ phase, outcome }) => WORK_SORTS.find((s) => s.of.test(outcome || phase));

// ---- the distribution of the work, as an icicle: the query on top, its phases, and beneath each the
// deciding tests
export class WorkIcicle {
  /** `work`: {outcomes: [{phase, outcome, events, operations, micros}], timed}; null: not recorded. */
  constructor(work, events, filter, form, selection) {
    if (!work) return;
    Object.assign(this, { work, events, filter, form, selection });
    this.box = byId("work-chart");
    byId("work").hidden = false;
    byId("work-measure").closest("label").hidden = !work.timed;
    if (!work.timed) byId("work-measure").value = "operations";
    byId("work-measure").addEventListener("input", () => this.draw());
    byId("work-scope").addEventListener("input", () => this.draw());
    byId("work-scope").closest("label").hidden = work.steps.index.length < 2;
    this.ofStep = WorkIcicle.bySteps(work);
    new ResizeObserver(oncePerFrame(() => this.draw())).observe(this.box);
    form.listeners.push(() => this.draw());
    selection.listeners.push((what) => {
      if (what !== "event") return;
      if (this.scope === "step" && this.shownStep !== events.stepNumber(selection.event)) this.draw();
      else this.mark();
    });
    this.draw();
  }

  /** Returns the parts of each step, by its number. */
  static bySteps({ outcomes, steps }) {
    const columns = Object.fromEntries(
      ["events", "operations", "micros"].map((name) => [name, unpack(steps[name])]),
    );
    return new Map(
      [...unpack(steps.index)].map((number, k) => [
        number,
        outcomes.map((o, i) => {
          const at = k * outcomes.length + i;
          return { ...o, events: columns.events[at], operations: columns.operations[at], micros: columns.micros[at] };
        }),
      ]),
    );
  }

  get scope() {
    return byId("work-scope").value;
  }
  /** The parts in the chart: of the run, or of the current step. */
  get outcomes() {
    return this.scope === "run" ? this.work.outcomes : this.ofStep.get(this.shownStep) || [];
  }

  /** The phase that fills the chart; null: all. */
  get zoom() {
    return this.filter.work ? this.filter.work.phase : null;
  }

  /** Returns the parts, a row for each depth: {key, name, value, from, parts: numbers of outcomes}.
      `wide`: returns the value of a visible outcome. */
  rows(wide) {
    const { outcomes } = this;
    const row = (nameOf) => {
      const out = [];
      let from = 0;
      outcomes.forEach((o, i) => {
        const name = nameOf(o), last = out.at(-1);
        if (last && last.key === name) {
          last.value += wide(o);
          last.parts.push(i);
        } else if (name !== null) out.push({ key: name, name, value: wide(o), from, parts: [i] });
        from += wide(o);
      });
      return out;
    };
    return [
      row(() => "query"),
      row((o) => o.phase),
      row((o) => (o.outcome ? `${o.phase}: ${o.outcome}` : null)).map((p) => ({
        ...p, name: outcomes[p.parts[0]].outcome,
      })),
    ];
  }

  draw() {
    this.shownStep = this.events.stepNumber(this.selection.event);
    const width = Math.max(240, this.box.clientWidth), height = 30, gap = 2;
    const measure = byId("work-measure").value, { zoom } = this,
      rows = this.rows((o) => (zoom === null || o.phase === zoom ? o[measure] : 0)),
      shown = rows[0].length ? rows[0][0].value : 0,
      svg = svgElement("svg", {
        viewBox: `0 0 ${width} ${rows.length * (height + gap)}`, role: "group",
        "aria-label": "Parts of the query by their work",
      });
    const all = this.outcomes.reduce((n, o) => n + o[measure], 0);
    rows.forEach((row, depth) => {
      for (const part of row) {
        if (!(part.value > 0)) continue;
        const x = (part.from / shown) * width, w = Math.max(1.5, (part.value / shown) * width - gap);
        const first = this.outcomes[part.parts[0]],
          colour = depth === 2 || (depth === 1 && !first.outcome) ? workSort(first).colour : "";
        svg.append(this.part(depth === 0 ? { ...part, value: all } : part, all, { x, y: depth * (height + gap), w, height, colour, depth }));
      }
    });
    this.box.replaceChildren(svg);
    this.mark();
  }

  /** Makes a rectangle that is a button for the filter, with its name if that fits. */
  part(part, all, { x, y, w, height, colour, depth }) {
    const share = percent(part.value, all),
      events = part.parts.reduce((n, i) => n + this.outcomes[i].events, 0),
      micros = byId("work-measure").value === "micros",
      amount = micros ? `${short(part.value)} \u00b5s` : plural(part.value, "operation");
    const recorded = events ? plural(events, "event") : "no events: record the run with --events nodes";
    const title = `${part.name}: ${amount}, ${share}; ${recorded}`,
      fits = (words) => 7.2 * words.length + 14 <= w,
      rect = svgElement("rect", { x, y, width: w, height, rx: 3 });
    if (colour) rect.style.fill = colour;
    rect.style.fillOpacity = colour ? 0.5 : 0.25;
    const group = svgElement(
      "g",
      { tabindex: 0, role: "button", "aria-label": title },
      svgElement("title", {}, title),
      rect,
      svgElement("text", { x: x + 7, y: y + height / 2 }, [`${part.name}  ${share}`, part.name].find(fits) || ""),
    );
    group.dataset.parts = part.parts.join(" ");
    const phase = depth === 1 ? part.name : this.zoom;
    const choose = () => this.choose(depth === 0 ? null : { ...part, phase });
    group.addEventListener("click", choose);
    group.addEventListener("keydown", (e) => {
      if (e.key !== "Enter" && e.key !== " ") return;
      e.preventDefault();
      e.stopPropagation();
      choose();
    });
    return group;
  }

  /** Lists the events of a part, and fills the chart with a phase; null, or the same part again: all. */
  choose(part) {
    const key = part ? part.parts.join(" ") : "",
      same = this.filter.work && [...this.filter.work.parts].join(" ") === key;
    this.form.showWork(part && !same ? { name: part.key, phase: part.phase, parts: new Set(part.parts) } : null);
  }

  /** Marks the listed part, and the part of the event. */
  mark() {
    const listed = this.filter.work ? [...this.filter.work.parts].join(" ") : "",
      here = this.events.work[this.selection.event];
    for (const group of this.box.querySelectorAll("[data-parts]")) {
      const { parts } = group.dataset;
      group.setAttribute("aria-pressed", parts === listed);
      group.classList.toggle("here", parts === String(here));
    }
  }
}

// ---- rows of the page's tables link to regions, time steps, pairs and boxes, and show which of them is selected
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
