// ---- where the work went, as an icicle: the query above, its phases, and beneath each what decided
const SVG = document.querySelector(".about svg").namespaceURI;

class WorkIcicle {
  /** `work`: {outcomes: [{phase, outcome, events, operations, micros}], timed}; null: was not recorded. */
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
    new ResizeObserver(() => this.draw()).observe(this.box);
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
  /** The parts that the chart shows: of the run, or of the step that is on show. */
  get outcomes() {
    return this.scope === "run" ? this.work.outcomes : this.ofStep.get(this.shownStep) || [];
  }

  /** The phase that fills the chart; null: all do. */
  get zoom() {
    return this.filter.work ? this.filter.work.phase : null;
  }

  /** Returns the parts, a row for each depth: {key, name, value, from, parts: numbers of outcomes}. `wide`: returns the
      value of an outcome that shows. */
  rows(wide) {
    const { outcomes } = this;
    const row = (nameOf) => {
      const out = [];
      let from = 0;
      outcomes.forEach((o, i) => {
        const name = nameOf(o),
          last = out.at(-1);
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
        ...p,
        name: outcomes[p.parts[0]].outcome,
      })),
    ];
  }

  draw() {
    this.shownStep = this.events.stepNumber(this.selection.event);
    const width = Math.max(240, this.box.clientWidth),
      height = 30,
      gap = 2;
    const measure = byId("work-measure").value,
      { zoom } = this,
      rows = this.rows((o) => (zoom === null || o.phase === zoom ? o[measure] : 0)),
      shown = rows[0].length ? rows[0][0].value : 0,
      svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("viewBox", `0 0 ${width} ${rows.length * (height + gap)}`);
    svg.setAttribute("role", "group");
    svg.setAttribute("aria-label", "Parts of the query by their work");
    const all = this.outcomes.reduce((n, o) => n + o[measure], 0);
    const phases = [...new Set(this.outcomes.map((o) => o.phase))];
    rows.forEach((row, depth) => {
      for (const part of row) {
        if (!(part.value > 0)) continue;
        const x = (part.from / shown) * width,
          w = Math.max(1.5, (part.value / shown) * width - gap);
        const phase = phases.indexOf(this.outcomes[part.parts[0]].phase),
          colour = depth === 0 ? "" : `var(--s${phase % 7})`;
        svg.append(this.part(depth === 0 ? { ...part, value: all } : part, all, { x, y: depth * (height + gap), w, height, colour, depth }));
      }
    });
    this.box.replaceChildren(svg);
    this.mark();
  }

  /** Makes a rectangle with its name, if that fits, that is a button for the filter. */
  part(part, all, { x, y, w, height, colour, depth }) {
    const group = document.createElementNS(SVG, "g"),
      rect = document.createElementNS(SVG, "rect"),
      title = document.createElementNS(SVG, "title"),
      text = document.createElementNS(SVG, "text");
    const share = `${short((100 * part.value) / all)} %`,
      events = part.parts.reduce((n, i) => n + this.outcomes[i].events, 0),
      micros = byId("work-measure").value === "micros",
      amount = micros ? `${short(part.value)} \u00b5s` : plural(part.value, "operation");
    title.textContent = `${part.name}: ${amount}, ${share}; ${plural(events, "event")}`;
    for (const [name, value] of Object.entries({ x, y, width: w, height, rx: 3 }))
      rect.setAttribute(name, value);
    if (colour) rect.style.fill = colour;
    rect.style.fillOpacity = depth === 2 ? 0.18 : 0.38;
    text.setAttribute("x", x + 7);
    text.setAttribute("y", y + height / 2);
    const fits = (words) => 7.2 * words.length + 14 <= w;
    text.textContent = [`${part.name}  ${share}`, part.name].find(fits) || "";
    group.append(title, rect, text);
    group.setAttribute("tabindex", 0);
    group.setAttribute("role", "button");
    group.setAttribute("aria-label", title.textContent);
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

  /** Marks the part that is listed, and the one that the event belongs to. */
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
