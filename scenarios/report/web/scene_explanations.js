// ---- why two faces come out as they do, and what parts bodies that are apart: what explanations.cpp packed
class Explanations {
  /** `json`: null where the page explains nothing. `stepNumbers`: of the steps that it was made for. */
  constructor(json, stepNumbers) {
    this.none = !json;
    if (!json) return;
    const { by, meets, axes, cut, command, pairs, steps } = json;
    Object.assign(this, { by, meets, axes, cut, command });
    this.columns = Object.fromEntries(
      Object.entries(pairs).map(([name, text]) => [name, typeof text === "string" ? unpack(text) : text]),
    );
    const number = (step) => stepNumbers[step]; // steps are known by their numbers: more may be loaded
    this.steps = new Map(steps.map((s) => [number(s.step), s]));
    this.numbers = new Map();
    for (let i = 0; i < pairs.count; i++)
      this.numbers.set(
        Explanations.key(number(this.columns.step[i]), [this.columns.a[i], this.columns.b[i]]),
        i,
      );
  }

  static key(step, [a, b]) {
    return `${step} ${a} ${b}`;
  }

  /** Returns the explanation of a pair of simplices at a step, by its number; null: none. */
  pair(step, simplices) {
    const i = this.none ? undefined : this.numbers.get(Explanations.key(step, simplices));
    if (i === undefined) return null;
    const c = this.columns,
      part = (ends, values, size = 1) =>
        values.subarray(size * (i > 0 ? ends[i - 1] : 0), size * ends[i]);
    const rows = [...part(c.wayEnd, c.gap)].map((gap, k) => {
      const at = (i > 0 ? c.wayEnd[i - 1] : 0) + k;
      return { nodes: [c.nodeA[at], c.nodeB[at]], gap, axis: this.axes[c.axis[at]], faces: false };
    });
    if (c.reachesFaces[i]) rows.at(-1).faces = true;
    const points = part(c.pointsEnd, c.points, 3);
    return {
      meet: c.meet[i],
      by: this.by[c.by[i]],
      rows,
      points: Array.from({ length: points.length / 3 }, (_, k) => [...points.subarray(3 * k, 3 * k + 3)]),
      distance: c.distance[i],
      ulps: c.ulps[i],
      // For A's corners by B's plane, then B's by A's: {distance, exact, inDouble}.
      corners: [0, 3].map((first) =>
        [0, 1, 2].map((k) => {
          const sign = c.signs[6 * i + first + k];
          return {
            distance: c.corner[6 * i + first + k],
            exact: Math.floor(sign / 3) - 1,
            inDouble: (sign % 3) - 1,
          };
        }),
      ),
    };
  }

  /** Returns what parts the bodies at a step; null: they meet there, or the page does not say. */
  step(step) {
    return this.none ? null : this.steps.get(step) || null;
  }

  /** Returns the command that explains a pair, or without one the step; empty: there is none. */
  commandFor(stepNumber, simplices) {
    if (this.none || !this.command) return "";
    return `${this.command} --step ${stepNumber}${simplices ? ` --pair ${simplices.join(",")}` : ""}`;
  }
}
