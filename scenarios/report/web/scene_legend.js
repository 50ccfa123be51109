// ---- what the colours of the view mean
class Legend {
  constructor(view) {
    this.view = view;
    this.items = [];
    this.more = {};
  }

  /** Adds what is pointed out at the moment, in place of what the same `who` had: [[colour, words, colour of the rim]]; a rim
      where the colour alone is not seen on a dark card. */
  also(items, who) {
    this.more[who] = items.map(([colour, text, rim]) => [Legend.css(colour), text, rim ? Legend.css(rim) : ""]);
    this.write();
  }

  static css(c) {
    return `rgb(${c.map((x) => Math.round(255 * x)).join(" ")})`;
  }

  write() {
    byId("legend").replaceChildren(
      ...[...this.items, ...Object.values(this.more).flat()].map(([colour, text, rim]) => {
        const item = document.createElement("span"),
          dot = document.createElement("i");
        dot.style.background = colour;
        if (rim) dot.style.outline = `1.5px solid ${rim}`;
        item.append(dot, text);
        return item;
      }),
    );
  }

  /** `key`: the scale of the colours; null: bodies have one colour each. */
  show(key) {
    const { colours, bodies, now } = this.view,
      { passes } = this.view.events,
      { css } = Legend,
      items = [];
    bodies.forEach((b) => {
      const name = bodies.length > 1 ? `${SIDES[b.side]} ${b.name}` : b.name,
        colour = colours.bodies[b.side];
      items.push([
        css(key ? mixed(colour, WHITE, colours.shares.noValue) : colour),
        `${name}, real faces${key && COUNTERS.includes(now.by) ? ` without ${now.by}` : ""}`,
        key ? css(colours.edge(b.side)) : "",
      ]);
      if (!key && now.by === "kind" && b.regionCount)
        items.push([css(colours.lid(b.side)), `${name}, pseudo faces`, css(colours.edge(b.side))]);
    });
    if (now.by === "region")
      items.push([css(colours.categories[0]), `pseudo faces, a colour for each region${passes ? "; pale: of earlier passes" : ""}`, ""]);
    if (this.view.events.passes) items.push([css(colours.refining), "lids that are new in this pass", ""]);
    else
      items.push(
        [css(colours.contact), "faces that meet", ""],
        [css(colours.refining), "region being refined", ""],
        [css(colours.underTest), "pair under test", ""],
      );
    items.push([css(colours.selected), "selected", ""]);
    if (this.view.events.wrong.some((pairs) => pairs.length))
      items.push([css(colours.wrong), `pairs that ${this.view.events.engine} got wrong`, ""]);
    this.items = items;
    this.write();
    this.showScale(key);
  }

  showScale(key) {
    const { colours, bodies, now } = this.view;
    byId("scale").hidden = !key;
    if (!key) return;
    byId("scale-bar").style.background = `linear-gradient(to right, ${colours.stops.join(", ")})`;
    byId("scale-most").textContent = digits(key.most);
    const whose = bodies.length > 1 ? " of both bodies" : "";
    const when = now.scope === "run" ? "in the whole run" : "in this step so far";
    byId("scale-title").textContent = key.title || `${now.by}, for each ${now.per}${whose}, ${when}`;
  }
}
