import { byId, copyText, digits, element, plural, rounded, textButton } from "./dom.js";
import { fillList } from "./scene_panels.js";
import { NONE, SIDES } from "./scene_run.js";

// ---- beside the view: why the two faces of an event, or two that were clicked, intersect or not; and for a
// step without contact what separates the bodies
const short = (x) => rounded(x, 3);
/** Returns a positive number rounded down, for lower bounds. */
const least = (x) => {
  const near = Number(x.toPrecision(3));
  return short(near > x ? x - 0.5 * 10 ** (Math.floor(Math.log10(x)) - 2) : x);
};
/** Distances of more ulps are shown without them: double arithmetic decides them reliably. */
const MOST_ULPS = 1e6;

export class WhyPanel {
  constructor(explanations, events, selection) {
    Object.assign(this, { explanations, events, selection });
    this.listeners = []; // notified when the explanation, or the highlighted row, has changed
    this.now = null; // {kind: "pair" | "step", key, found}
    this.map = null; // the proof map, which knows what an engine's test rejected
    this.decision = null; // of the pair that another engine got wrong
    this.row = -1; // of the path, whose boxes the view shows
    byId("why-copy").onclick = () => this.copy();
    byId("why-way").addEventListener("click", (e) => this.point(e.target.closest("[data-row]")));
    if (!explanations.none) selection.onContent(() => this.show());
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
    const wrong = simplices && events.wrong[events.step(selection.event)]
        .find((w) => w.simplices.every((s, side) => s === simplices[side]));
    this.decision = wrong && this.map ? this.map.decision(simplices) : null;
    if (this.decision) this.decision.missed = wrong.missed;
    const found = simplices ? explanations.pair(step, simplices) : separation;
    this.now = found && {
      kind: simplices ? "pair" : "step", key: `${step} ${simplices || ""}`, found,
    };
    this.command = explanations.commandFor(events.stepNumber(selection.event), simplices);
    byId("why").hidden = !(simplices ? found || this.decision || this.command : separation);
    if (simplices) this.showPair(simplices, found);
    else if (separation) this.showStep(separation);
    // Lines break between words, not after a hyphen of an option.
    byId("why-command").replaceChildren(...(this.command || "").split(" ").flatMap((word, i) =>
      [i ? " " : "", element("span", { style: "display: inline-block; max-width: 100%" }, word)]));
    byId("why-ask").hidden = !this.command;
    byId("why-copied").textContent = "";
    this.tell();
  }

  /** `note`: before it, lrbscope's own walk is named, whose nodes are others than the engine's. */
  title(text, note) {
    byId("why-title").textContent = text;
    const own = this.events.engine ? "The exact answer, by lrbscope\u2019s own walk. " : "";
    byId("why-note").textContent = own + note;
  }

  // -- a pair
  showPair(simplices, e) {
    const { events } = this;
    const names = simplices.map((s, side) => {
      const body = events.bodies[side];
      return body.complete ? `${body.faceText(body.faceOfSimplex(s))} of ${SIDES[side]}`
        : `simplex ${digits(s)} of ${SIDES[side]}`;
    });
    const { decision } = this, { engine } = events,
      exact = e ? `${["The faces are disjoint", "The faces touch", "The faces cross"][e.meet]}.` : "";
    this.title(`${decision ? (decision.missed ? "Missed" : "Reported wrongly") : "Why"}: ${names.join(", ")}`,
      e ? `${decision ? exact : ""} ${engine ? `Decided by ${e.by}.` : ""}`
        : `${this.explanations.cut || "Not among the pairs that were compared one by one here."} ` +
          "The command below explains it.");
    byId("why-verdict").textContent = decision ? `${engine}: ${decision.words}`
      : e ? `${exact} ${engine ? "" : `Decided by ${e.by}.`}` : "";
    this.showWay(e ? e.rows : []);
    fillList(byId("why-facts"), e ? this.pairFacts(e) : []);
    this.showRegions(simplices);
  }

  pairFacts(e) {
    const rows = e.corners.map((corners, side) => [
      `${SIDES[side]}\u2019s corners`,
      corners
        .slice(0, this.events.dim)
        .map(({ distance, exact, inDouble }) => {
          const wrong = inDouble === exact ? "" : ` (doubles: side ${inDouble})`;
          return (exact ? (exact > 0 ? "+" : "\u2212") + short(Math.abs(distance)) : "0") + wrong;
        })
        .join(", "),
      `Distances from the other face\u2019s ${this.events.dim === 3 ? "plane" : "line"}; +: in front`,
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
    // another engine has no regions
    byId("why-regions").replaceChildren(...(this.events.engine ? [] : lines));
  }

  // -- a step
  showStep(e) {
    this.title("What separates the bodies", "");
    byId("why-regions").replaceChildren();
    byId("why-verdict").textContent = this.stepText(e);
    this.showWay([]);
    const pairs = e.depths.reduce((n, [all]) => n + all, 0);
    fillList(byId("why-facts"), [
      ["bounding boxes", e.roots.gap > 0 ? `gap ${short(e.roots.gap)}` : `overlap by ${short(-e.roots.gap)}`],
      ["pairs of nodes", `${digits(pairs)}, to depth ${e.depths.length - 1}`],
      [
        "pairs of faces",
        e.facePairs > 0
          ? `${digits(e.facePairs)} with overlapping boxes; planes separate ` +
            `${digits(e.facePairs - e.left)}, ${digits(e.left)} are compared`
          : "none: the walk did not come so far",
      ],
      ...(e.boxes ? [["nearest boxes", this.boxText(e.boxes)]] : []),
      ...(e.plane
        ? [["plane",
          `across (${e.plane.normal.map((x) => short(Number(x.toFixed(4)))).join(", ")}), ` +
            `gap \u2265 ${least(e.plane.gap)}`]]
        : []),
      ...(e.near ? [["nearest faces", this.nearButton(e.near)]] : []),
    ]);
  }

  stepText(e) {
    if (e.plane)
      return `Apart: a plane has A on one side and B on the other, gap \u2265 ${least(e.plane.gap)}.`;
    const what = e.relation === "undefined" ? "No faces intersect" // a surface that bounds no solid
      : e.relation === "separate" ? "Apart, though no plane was found that has one body on each side"
      : "No faces intersect; one body is inside the other";
    const last = e.left > 0 ? ", or in faces separated by planes and tests" : e.facePairs > 0
          ? ", or in faces separated by planes" : "";
    return `${what}: the traversal ended in pairs of disjoint boxes${last}.`;
  }

  boxText(boxes) {
    const of = boxes.ofFaces ? "faces in nodes" : "nodes";
    const gap = `gap ${short(boxes.gap)} along ${boxes.axis}`;
    return `${of} ${digits(boxes.a)} of A and ${digits(boxes.b)} of B, ${gap}`;
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
        cell(row.axis.replace("'s box", "")); // the column is narrow
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
    // The nodes of rows are lrbscope's; with another engine, the view has the boxes of that engine's trees.
    if (this.decision) return this.decision.nodes.map((number, side) => ({ side, number }));
    if (this.events.engine || this.row < 0 || !this.now || this.now.kind !== "pair") return [];
    return this.now.found.rows[this.row].nodes.map((number, side) => ({ side, number }));
  }

  async copy() {
    byId("why-copied").textContent = (await copyText(this.command, byId("why-command"))) ? "Copied." : "";
  }
}
