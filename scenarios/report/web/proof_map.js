import { byId, digits, element, oncePerFrame, plural, short, style, textButton } from "./dom.js";
import { NONE, SIDES, unpack } from "./scene_run.js";

// ---- the proof map: a square of all pairs of faces, A's down and B's across, in the order of their trees.
// The pairs that a test rejected are a rectangle: with the slider the square fills, down to specks.

// The order of Argument in proof_map.hpp.
const [CHILD_BOXES, NODE_BOXES, FACE_BOXES, PLANES, FLOATS, FILTER, EXPANSIONS, CONTACT, TOLERANCE, OPEN] =
  Array(10).keys();
const WAITING = OPEN + 1, // a pair of simplices before its test
  isSingle = (argument) => argument >= PLANES && argument !== OPEN,
  isHit = (argument) => argument === CONTACT || argument === TOLERANCE,
  BLOCK = 128, // cells that are painted as one where they are far away
  SHADES = 32; // of an argument, by the number of pairs of a cell

/** Returns the ranges of a tree's nodes in the order of the leaves. */
const axisOf = ({ low, high, leaf, rank }) =>
  ({ low: unpack(low), high: unpack(high), leaf: unpack(leaf), rank: unpack(rank), size: unpack(high)[0] });

/** The cells of the last traversal of a step, by event, as map_json.cpp found them: there may be a million.
    `step`: its index among the steps that were on the page at first; -1: none of them. */
class MapCells {
  constructor({ trees, cells }, step) {
    const part = (name) => cells[name].subarray(cells.first[step], cells.first[step + 1]);
    for (const name of ["event", "argument", "a", "b"]) this[name] = part(name);
    this.count = this.event.length;
    if (!this.count) return;
    const walked = [...cells.walked.subarray(2 * step, 2 * step + 2)];
    this.ofBodies = walked.every((w) => w === 0);
    this.axes = walked.map((w, side) => axisOf(trees.find((t) => t.side === side && t.walked === w)));
    this.pairs = this.axes[0].size * this.axes[1].size;
    this.nearest = Math.min(1, 40 / Math.max(...this.axes.map((x) => x.size)));
    this.hits = [];
    this.shade = new Uint8Array(this.count);
    // The ranges of A's and B's simplices; and those around each block of cells.
    const numbers = (n) => [0, 1].map(() => new Uint32Array(n)), blocks = Math.ceil(this.count / BLOCK);
    [this.low, this.high] = [numbers(this.count), numbers(this.count)];
    this.blocks = { low: numbers(blocks).map((x) => x.fill(NONE)), high: numbers(blocks) };
    for (let i = 0; i < this.count; i++) {
      const single = isSingle(this.argument[i]), block = Math.floor(i / BLOCK);
      for (let side = 0; side < 2; side++) {
        const axis = this.axes[side], at = side ? this.b[i] : this.a[i], { low, high } = this.blocks;
        this.low[side][i] = single ? axis.rank[at] : axis.low[at];
        this.high[side][i] = single ? axis.rank[at] + 1 : axis.high[at];
        low[side][block] = Math.min(low[side][block], this.low[side][i]);
        high[side][block] = Math.max(high[side][block], this.high[side][i]);
      }
      this.shade[i] = Math.round((SHADES - 1) * Math.log(this.pairsOf(i) + 1) / Math.log(this.pairs + 1));
      if (isHit(this.argument[i])) this.hits.push(i);
    }
  }

  pairsOf(i) {
    return (this.high[0][i] - this.low[0][i]) * (this.high[1][i] - this.low[1][i]);
  }

  /** Returns the argument of the cell that a tested pair is upon. */
  upon(i) {
    const argument = this.argument[i];
    return argument === WAITING || argument === PLANES ? FACE_BOXES : isSingle(argument) ? OPEN : NONE;
  }
}

/** Returns the largest gap of two boxes, centre and half axes in the world, along a normal: {gap, axis}. */
function separation(boxes) {
  const way = boxes[1][0].clone().sub(boxes[0][0]), halves = boxes.flatMap(([, ...half]) => half);
  return halves.map((half, i) => {
    const n = half.clone().normalize(), reach = halves.reduce((sum, h) => sum + Math.abs(n.dot(h)), 0);
    return { gap: Math.abs(n.dot(way)) - reach,
        axis: `axis ${(i % 3) + 1} of ${SIDES[i < 3 ? 0 : 1]}\u2019s box` };
  }).reduce((p, q) => (q.gap > p.gap ? q : p));
}

export class ProofMap {
  /** `view`: null without a 3D view. */
  constructor(scene, events, selection, view) {
    // Listeners are notified of the part of the map that is shown, and of the painted picture.
    Object.assign(this, { scene, events, selection, view, key: "", window: [0, 0, 1], corners: [0, 0, 0, 0],
        listeners: [] });
    for (const [name, packed] of Object.entries(scene.map.cells)) scene.map.cells[name] = unpack(packed);
    const label = "Proof map: all pairs of faces, by the test that decided them",
      whole = textButton("whole", () => this.zoom([0, 0], [0, 0], 1), "Show all pairs; the wheel enlarges");
    this.stepOf = new Map([...events.stepNumbers].map((number, step) => [number, step]));
    this.deep = element("input", { type: "range", max: 100, style: "accent-color: var(--accent)" });
    this.deep.oninput = () => this.approach(this.deep.value / 100);
    this.canvas = element("canvas",
        { style: "flex:none;cursor:crosshair", role: "img", "aria-label": label });
    this.words = element("p", { class: "note", style: "max-width:60ch" });
    this.legend = element("table");
    this.target = element("span");
    const zoom = element("label", { class: "note" }, this.target, this.deep),
      side = element("div", {}, this.legend, element("p", { class: "parts" }, whole, zoom), this.words);
    this.box = element("div", { style: "display:flex;flex-wrap:wrap;gap:16px" }, this.canvas, side);
    byId("scene").append(element("div", { class: "tab", "data-tab": "Proof map" }, this.box));
    this.redraw = oncePerFrame(() => this.draw());
    selection.on("event", () => this.redraw());
    new ResizeObserver(this.redraw).observe(this.box);
    const place = (e) => [e.offsetX, e.offsetY].map((x) => x / this.canvas.clientWidth),
      at = (e) => place(e).map((x, i) => this.window[i] + x * this.window[2]);
    this.canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.zoom(at(e), place(e), Math.max(1e-5, Math.min(1, this.window[2] * 1.0015 ** e.deltaY)));
    });
    this.canvas.addEventListener("pointermove", (e) => this.point(at(e)));
    this.canvas.addEventListener("pointerleave", () => this.point(null));
    this.canvas.addEventListener("click", (e) => this.go(at(e)));
  }

  /** Shows a part of the map of a given size, with a point of it at a place of the canvas. */
  zoom(point, place, size) {
    this.show([...point.map((x, i) => Math.max(0, Math.min(1 - size, x - place[i] * size))), size]);
    this.tell({ window: this.window });
  }
  show(window) {
    this.window = window;
    this.painted = null;
    this.redraw();
  }
  /** Shows a part around the first wrong pair, or a contact: from the whole, 0, to some forty simplices, 1, by equal factors. */
  approach(share) {
    const { axes, hits, low, count, nearest } = this.cells || {};
    if (!count) return;
    const hit = hits.length ? hits[hits.length >> 1] : count - 1,
      [wrong] = this.events.wrong[this.events.step(this.selection.event)],
      place = (side) => (wrong ? axes[side].rank[wrong.simplices[side]] : low[side][hit]),
      point = [1, 0].map((side) => (place(side) + 0.5) / axes[side].size);
    this.zoom(point, point, nearest ** share);
  }
  tell(what) {
    for (const listener of this.listeners) listener(what);
  }

  /** Takes the cells of the current event's step. */
  take() {
    const step = this.stepOf.get(this.events.stepNumber(this.selection.event)) ?? -1,
      key = `${step} ${this.events.count}`;
    if (this.key === key) return;
    this.cells = new MapCells(this.scene.map, step);
    Object.assign(this, { key, painted: null, counted: null, pointed: -1 });
  }

  /** Returns what decided two simplices in the current step: {nodes, event, words}, with an id; null: not
      known. */
  decision(simplices) {
    this.take();
    const { axes, count, ofBodies } = this.cells, ranks = simplices.map((s, side) => count && axes[side].rank[s]);
    if (!count || ranks.includes(NONE)) return null;
    const i = this.find([1, 0].map((side) => (ranks[side] + 0.5) / axes[side].size), Infinity);
    if (i < 0) return null;
    const by = this.cells.argument[i], nodes = ofBodies ? this.nodes(i) : [],
      event = this.cells.event[i], when = `(event ${digits(event)})`,
      pair = nodes.map((n, side) => `${digits(n)} of ${SIDES[side]}`).join(" and ");
    const words = by === CONTACT ? `its test of the two triangles found them to intersect ${when}.`
      : by === OPEN ? "no test of nodes or triangles rejected them: it did not come to them."
      : isSingle(by) ? `its test of the two triangles called them disjoint ${when}.`
      : `it found nodes ${pair}, which contain them, disjoint ${when}. ${this.apart(nodes)}`;
    return { nodes, event, words };
  }

  draw() {
    if (!this.box.offsetParent) return; // another tab is shown
    const room = this.box.closest(".tab-body"),
      most = Math.min(room ? room.clientHeight - 32 : 400, 0.55 * this.box.clientWidth),
      size = Math.round(Math.max(240, most)),
      pixels = Math.round(size * Math.min(2, window.devicePixelRatio || 1));
    this.take();
    if (this.canvas.width !== pixels) this.painted = null;
    this.canvas.hidden = this.legend.hidden = !this.cells.count;
    if (!this.cells.count) {
      this.words.textContent = "This step has no traversal, or the page has no map of it.";
      return this.tell({ map: null });
    }
    const { hits, nearest } = this.cells;
    const [wrong] = this.events.wrong[this.events.step(this.selection.event)];
    this.target.textContent = wrong ? "towards a wrong pair " : hits.length ? "towards the contact " : "enlarge ";
    this.deep.value = nearest < 1 ? 100 * Math.log(this.window[2]) / Math.log(nearest) : 0;
    if (!this.painted) {
      this.canvas.width = this.canvas.height = pixels;
      this.canvas.style.width = this.canvas.style.height = `${size}px`;
    }
    this.paint(pixels);
    this.count();
  }

  /** Returns the pixels of a cell, or of a block: [x0, x1, y0, y1], an array that the next call changes.
      Neighbours round their common border alike. */
  rectangle({ low, high }, i, size, least) {
    const { window, corners: out } = this, { axes } = this.cells, part = size / window[2];
    for (let side = 0; side < 2; side++) {
      const count = axes[side].size, start = window[1 - side], k = 2 - 2 * side;
      out[k] = Math.round((low[side][i] / count - start) * part);
      out[k + 1] = Math.round((high[side][i] / count - start) * part);
      const more = Math.max(0, least - (out[k + 1] - out[k]));
      out[k] -= more >> 1;
      out[k + 1] += more - (more >> 1);
    }
    return out;
  }

  /** Returns the colours of an argument's cells: those of many pairs are pale, as in figures. */
  shades({ colour, pale }) {
    const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16)),
      paper = rgb(style("--card")),
      word = ([r, g, b]) => (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
    return Array.from({ length: SHADES }, (_, k) => {
      const faded = pale * Math.sqrt(k / (SHADES - 1)),
        inside = rgb(colour).map((c, i) => Math.round(c + (paper[i] - c) * faded));
      return { inside: word(inside), rim: word(inside.map((c) => Math.round(0.8 * c))) };
    });
  }

  /** Paints the cells of the events since the last call; all of them if the slider went back. */
  paint(size) {
    const { cells } = this, { event, count, hits } = cells, context = this.canvas.getContext("2d"),
      now = this.events.id(this.selection.event);
    if (!this.painted || (this.painted.next > 0 && event[this.painted.next - 1] > now)) {
      const image = context.createImageData(size, size), { arguments: all } = this.scene.map,
        shades = [...all, all[OPEN]].map((a) => this.shades(a)),
        pixels = new Uint32Array(image.data.buffer).fill(shades[OPEN].at(-1).inside);
      this.painted = { next: 0, image, pixels, shades };
    }
    const { painted } = this;
    for (let i = painted.next; i < count && event[i] <= now; painted.next = ++i) {
      if (i % BLOCK === 0 && event[i + BLOCK - 1] <= now && this.isFar(i / BLOCK, size)) i += BLOCK - 1;
      this.fill(i, size);
    }
    for (const i of hits) if (event[i] <= now) this.fill(i, size); // on top of later neighbours
    context.putImageData(painted.image, 0, 0);
    if (painted.reported !== painted.next) this.tell({ map: painted.pixels });
    painted.reported = painted.next;
    // The cell under the pointer or of the event, and the pairs that another engine got wrong.
    const { axes } = cells, at = this.selection.event,
      nodes = this.events.about(at, "node").map((n) => n.number),
      of = ({ low, high }, numbers) => numbers.map((i, side) => [low[side][i], high[side][i]]),
      marked = this.pointed >= 0 ? of(cells, [this.pointed, this.pointed])
        : of({ low: axes.map((x) => x.low), high: axes.map((x) => x.high) }, nodes),
      wrong = this.events.wrong[this.events.step(at)]
          .map((w) => w.simplices.map((s, side) => axes[side].rank[s]).map((low) => [low, low + 1])),
      frames = wrong.map((ranges) => [ranges, this.scene.colours.wrong]);
    for (const [ranges, colour] of marked.length ? [...frames, [marked, style("--ink")]] : frames) {
      const [low, high] = [0, 1].map((end) => ranges.map((range) => [range[end]])),
        [x0, x1, y0, y1] = this.rectangle({ low, high }, 0, size, 3);
      for (const [width, ink] of [[5, style("--card")], [2, colour]]) {
        Object.assign(context, { lineWidth: width, strokeStyle: ink });
        context.strokeRect(x0, y0, x1 - x0, y1 - y0);
      }
    }
  }

  /** Returns true for a block beyond the window, or as small as a pixel. */
  isFar(block, size) {
    const [x0, x1, y0, y1] = this.rectangle(this.cells.blocks, block, size, 0);
    return x1 < 0 || y1 < 0 || x0 > size || y0 > size || (x1 - x0 <= 1 && y1 - y0 <= 1);
  }

  fill(i, size) {
    const { argument, shade } = this.cells, by = argument[i],
      out = this.rectangle(this.cells, i, size, isHit(by) ? 3 : isSingle(by) ? 2 : 0),
      x0 = out[0], x1 = out[1], y0 = out[2], y1 = out[3];
    if (x1 <= 0 || y1 <= 0 || x0 >= size || y0 >= size || x0 === x1 || y0 === y1) return;
    const { pixels, shades } = this.painted, { inside, rim } = shades[by][shade[i]],
      outlined = Math.min(x1 - x0, y1 - y0) >= 8, [from, to] = [Math.max(0, x0), Math.min(size, x1)];
    for (let y = Math.max(0, y0); y < Math.min(size, y1); y++) {
      pixels.fill(outlined && (y === y0 || y === y1 - 1) ? rim : inside, y * size + from, y * size + to);
      if (outlined && x0 >= 0) pixels[y * size + x0] = rim;
      if (outlined && x1 <= size) pixels[y * size + x1 - 1] = rim;
    }
  }

  /** Writes what was decided so far, and by which argument. */
  count() {
    const { cells } = this, { next } = this.painted;
    if (!this.counted || this.counted.next > next)
      this.counted = { next: 0, sums: new Float64Array(WAITING + 1) };
    const { counted, counted: { sums } } = this;
    for (; counted.next < next; counted.next++) {
      sums[cells.argument[counted.next]] += cells.pairsOf(counted.next);
      if (cells.upon(counted.next) !== NONE) sums[cells.upon(counted.next)]--;
    }
    const { pairs } = cells,
      { arguments: all } = this.scene.map,
      open = pairs - sums.subarray(0, OPEN).reduce((n, x) => n + x, 0);
    const row = (name, n, { colour, pale } = { colour: "transparent", pale: 0 }) => {
      const paint = `color-mix(in srgb, var(--card) ${100 * pale}%, ${colour}), ${colour}`,
        look = `display:inline-block;width:2.2em;height:.8em;background:linear-gradient(to right, ${paint})`,
        cells = [element("i", { style: look }), name, digits(n),
            `${Number((100 * n / pairs).toPrecision(2))} %`];
      return element("tr", {}, ...cells.map((cell, i) => element("td", { class: i > 1 ? "n" : "" }, cell)));
    };
    this.legend.replaceChildren(
      ...all.flatMap((a, i) => (sums[i] && i !== OPEN ? [row(a.name, sums[i], a)] : [])),
      ...(open ? [row(next < cells.count ? "not decided yet" : all[OPEN].name, open, all[OPEN])] : []),
      row("all pairs", pairs),
    );
  }

  /** Returns the last cell at a place that was decided up to an event; -1: none. */
  find(at, last) {
    const { event, low, high, axes, count } = this.cells || { count: 0 };
    for (let i = count - 1; i >= 0; i--) {
      const holds = (side) => {
        const x = at[1 - side] * axes[side].size;
        return low[side][i] <= x && x < high[side][i];
      };
      if (event[i] <= last && holds(0) && holds(1)) return i;
    }
    return -1;
  }

  /** Goes to the event that decides the pairs at a place. */
  go(at) {
    if (document.documentElement.classList.contains("mapping")) return; // another run's map would stay
    const cell = this.find(at, Infinity), event = cell < 0 ? -1 : this.events.find(this.cells.event[cell]);
    if (event >= 0) this.selection.goTo(event);
  }

  /** Describes the cell at a place, and shows its boxes in the view; null: none. */
  point(at) {
    const cell = at ? this.find(at, this.events.id(this.selection.event)) : -1;
    if (cell === this.pointed) return;
    this.pointed = cell;
    this.words.textContent = cell >= 0 ? this.text(cell) : "";
    if (this.view && this.cells.ofBodies) {
      const nodes = cell >= 0 ? this.nodes(cell).map((number, side) => ({ side, number })) : [];
      this.view.marks.setBoxes("map", `${nodes.map((n) => n.number)}`, nodes, this.view.colours.selected);
      this.view.redraw();
    }
    this.redraw();
  }

  /** Returns the nodes of a cell, or the leaves of a pair of simplices. */
  nodes(i) {
    const { a, b, argument } = this.cells;
    return [a[i], b[i]].map((n, side) => (isSingle(argument[i]) ? this.cells.axes[side].leaf[n] : n));
  }

  text(i) {
    const { low, high, event, argument, a, b } = this.cells, by = argument[i],
      name = `${this.scene.map.arguments[Math.min(by, OPEN)].name}.`,
      what = isSingle(by) ? "Triangles" : "Nodes",
      sizes = high.map((x, side) => digits(x[i] - low[side][i])).join(" \u00d7 "),
      apart = by <= NODE_BOXES ? this.apart(this.nodes(i)) : "";
    return `Event ${digits(event[i])}. ${what} ${digits(a[i])} of A, ${digits(b[i])} of B; ` +
      `${sizes} = ${plural(this.cells.pairsOf(i), "pair")}: ${name} ${apart}`;
  }

  /** Says along which axis the boxes of two nodes are disjoint; empty: not known. */
  apart(nodes) {
    if (!this.view || !this.cells.ofBodies) return "";
    this.view.place(); // at the current step
    const boxes = this.view.views.map(({ body, group }, side) => {
      const first = 12 * body.boxes.node.indexOf(nodes[side]),
        part = (k) => new THREE.Vector3(...body.boxes.places.subarray(first + k, first + k + 3)),
        centre = part(0).applyMatrix4(group.matrix);
      return first < 0 ? null
          : [centre, ...[3, 6, 9].map((k) => part(0).add(part(k)).applyMatrix4(group.matrix).sub(centre))];
    });
    if (boxes.includes(null)) return "";
    const { gap, axis } = separation(boxes);
    return gap > 0 ? `Apart by ${short(gap * this.scene.unit)} along ${axis}.`
      : `Their boxes overlap along every axis of a box, least by ${short(-gap * this.scene.unit)} along ${axis}.`;
  }
}
