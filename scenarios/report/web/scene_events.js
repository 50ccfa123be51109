import { byId, digits, element, oncePerFrame, plural } from "./dom.js";
import { eventText, lastAtMost, NONE, outcomeText } from "./scene_run.js";

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
    if (region !== NONE) out.push((i) => concernsRegion(events, i, side, region));
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
export const placeText = (body, { vertex, face, region }) =>
  vertex !== NONE ? `vertex ${digits(vertex)}` : face !== NONE ? body.faceText(face)
      : `region ${digits(region)}`;

/** Returns true if an event concerns the selection; of a construction, if it is of an attempt there. */
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
    selection.on("event", () => this.follow());
    selection.on("pick", () => this.draw());
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
    if (this.box.closest("[hidden]")) return; // resize() follows when it is shown
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
      line = element("div",
          { class: "row", role: "row", "aria-rowindex": row + 1, "aria-selected": selected });
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
    if (attempts)
      this.filter.place = { name: placeText(attempts.body, picked), events: attempts.eventsAt(picked) };
    else if (picked.face !== NONE)
      byId("filter-pair").value = picked.side === 0 ? `${picked.face},` : `,${picked.face}`;
    else {
      byId("filter-side").value = String(picked.side);
      byId("filter-region").value = String(picked.region);
    }
    this.read();
  }
}
