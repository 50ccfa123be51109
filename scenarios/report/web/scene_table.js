// ---- the events as a table. Only the rows that can be seen are in the document, so that a million is as
// quick as ten.
const TALLEST = 5e6; // pixels: browsers cannot scroll much further

class EventTable {
  constructor(events, selection, filter) {
    this.events = events;
    this.selection = selection;
    this.filter = filter;
    this.box = byId("event-rows");
    this.body = byId("event-body");
    this.spacer = byId("event-spacer");
    this.rows = new Uint32Array(0); // events that pass the filter
    this.first = 0; // of these, the uppermost that is shown
    this.known = 0; // where the bar was put for `first`, which is then not to be rounded
    this.box.addEventListener("scroll", () => {
      if (Math.abs(this.box.scrollTop - this.known) >= 1) this.first = this.rowAt(this.box.scrollTop);
      this.draw();
    });
    this.body.addEventListener("click", (e) => {
      const row = e.target.closest("[data-event]");
      if (row) this.selection.goTo(Number(row.dataset.event));
    });
    selection.listeners.push((what) => {
      if (what === "event") this.follow();
    });
    new ResizeObserver(() => this.resize()).observe(this.box);
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
    byId("event-count").textContent =
      this.rows.length === this.events.count
        ? plural(this.rows.length, "event")
        : `${digits(this.rows.length)} of ${plural(this.events.count, "event")}`;
    this.follow();
  }

  /** Scrolls, if need be, to the event that is selected, or the last one before it that is listed. */
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

  /** Moves the selection by so many listed events. */
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
    const i = this.rows[row],
      events = this.events,
      line = document.createElement("div"),
      level = events.level(i);
    line.className = "row";
    line.setAttribute("role", "row");
    line.setAttribute("aria-rowindex", row + 1);
    line.setAttribute("aria-selected", i === this.selection.event);
    line.dataset.event = i;
    const cause = events.cause[i];
    const cells = [
      digits(events.id(i)),
      digits(events.stepNumber(i)),
      events.kindOf(i).name,
      eventWords(events, i),
      outcomeWords(events, i),
      level < 0 ? "" : level,
      cause === NONE ? "" : digits(cause),
    ];
    cells.forEach((text, column) => {
      const cell = document.createElement("span");
      cell.setAttribute("role", "cell");
      cell.textContent = text;
      cell.title = text; // which may not fit
      if (column === 2) cell.style.setProperty("--kind", events.kindOf(i).colour);
      line.append(cell);
    });
    return line;
  }
}
