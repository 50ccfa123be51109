import { asButton, byId, oncePerFrame, percent, plural, short, svgElement } from "./dom.js";
import { unpack } from "./scene_run.js";

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
    selection.on("event", () => {
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
          return { ...o, events: columns.events[at], operations: columns.operations[at],
              micros: columns.micros[at] };
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
        svg.append(this.part(depth === 0 ? { ...part, value: all } : part, all,
            { x, y: depth * (height + gap), w, height, colour, depth }));
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
      words = [`${part.name}  ${amount}, ${share}`, `${part.name}  ${share}`, part.name, share]
          .find((text) => 7.2 * text.length + 14 <= w),
      rect = svgElement("rect", { x, y, width: w, height, rx: 3 });
    if (colour) rect.style.fill = colour;
    rect.style.fillOpacity = colour ? 0.4 : 0.25;
    const group = svgElement(
      "g",
      { role: "button", "aria-label": title },
      svgElement("title", {}, title),
      rect,
      svgElement("text", { x: x + 7, y: y + height / 2 }, words || ""),
    );
    group.dataset.parts = part.parts.join(" ");
    const phase = depth === 1 ? part.name : this.zoom;
    asButton(group, () => this.choose(depth === 0 ? null : { ...part, phase }));
    return group;
  }

  /** Lists the events of a part, and fills the chart with a phase; null, or the same part again: all. */
  choose(part) {
    const key = part ? part.parts.join(" ") : "",
      same = this.filter.work && [...this.filter.work.parts].join(" ") === key;
    this.form.showWork(part && !same ? { name: part.key, phase: part.phase, parts: new Set(part.parts) }
        : null);
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
