import { byId, digits, element, oncePerFrame, plural, short, style, textButton } from "./dom.js";
import { grouped, NONE, SIDES, unpack } from "./scene_run.js";

// ---- the proof map: a square of all pairs of faces, A's down and B's across, in the order of their trees.
// The pairs that a test rejected are a rectangle: with the slider the square fills, down to specks.

// The order of Argument in proof_map.hpp.
const [CHILD_BOXES, NODE_BOXES, FACE_BOXES, PLANES, FLOATS, FILTER, EXPANSIONS, CONTACT, TOLERANCE, OPEN] =
  Array(10).keys();
const isPoint = (argument) => argument >= PLANES && argument < OPEN,
  isHit = (argument) => argument === CONTACT || argument === TOLERANCE,
  keyOf = (a, b) => a * 2 ** 26 + b,
  SHADES = 32; // of an argument, by the number of pairs of a cell

/** A tree: the ranges of its nodes in the order of the leaves. */
class MapAxis {
  constructor(json) {
    for (const name of ["parent", "low", "high", "leaf", "rank"]) this[name] = unpack(json[name]);
    const children = grouped(this.parent, this.parent.length);
    this.isLeaf = (node) => !children.of(node).length;
    this.below = (node, stays) => (stays || this.isLeaf(node) ? [node] : [...children.of(node)]);
    this.size = this.high[0];
  }
}

/** The cells of a step's last traversal, by event, made as in proof_map.cpp. */
class MapCells {
  constructor(scene, events, step) {
    const open = new Set(scene.map.open);
    Object.assign(this, { events, list: [], visits: new Map(), tests: new Map(), open });
    const first = events.firstOfStep[step],
      end = events.endOfStep(step);
    this.complete = events.id(end - 1) - events.id(first) === end - 1 - first;
    let begin = -1;
    for (let i = first, walk = -1; i < end; i++) {
      const { name } = events.kindOf(i);
      if (name === "begin") walk = /^(tree walk|cache making)$/.test(events.phases[events.a[i]]) ? i : -1;
      if (name === "node pair" && walk >= 0) begin = walk;
    }
    if (begin < 0 || !this.complete) return;
    const walked = [events.depthA[begin], events.depthB[begin]],
      tree = (w, side) => scene.map.trees.find((t) => t.side === side && t.walked === w);
    this.ofBodies = walked.every((w) => w === 0);
    this.axes = walked.map((w, side) => new MapAxis(tree(w, side)));
    this.pairs = this.axes[0].size * this.axes[1].size;
    this.parts = scene.work ? scene.work.outcomes.map((o) => o.outcome) : [];
    for (let i = begin; i < end; i++) this.collect(i);
    if (this.visits.has(0)) this.divide(0, 0);
    else this.add(0, 0, begin, OPEN);
    this.list.sort((p, q) => p.event - q.event);
  }

  /** Finds the first visit of each pair of nodes, and the last test of each pair in a pair of leaves. */
  collect(i) {
    const { name } = this.events.kindOf(i),
      [a, b] = [this.events.a[i], this.events.b[i]],
      key = keyOf(a, b);
    if (name === "node pair" && !this.visits.has(key)) this.visits.set(key, i);
    if (name !== "face test" && name !== "plane test") return;
    const leaves = keyOf(this.axes[0].leaf[a], this.axes[1].leaf[b]);
    if (!this.tests.has(leaves)) this.tests.set(leaves, new Map());
    this.tests.get(leaves).set(key, i);
  }

  /** Adds the pairs below two nodes as a cell, and returns its argument. */
  add(a, b, event, argument) {
    const [rows, columns] = this.axes,
      by = this.open.has(`${this.events.id(event)} ${a} ${b}`) ? OPEN : argument;
    this.push([rows.low[a], columns.low[b]], [rows.high[a], columns.high[b]], event, by, [a, b]);
    return by;
  }
  /** `upon`: the argument of the cell that this one is upon. */
  push(low, high, event, argument, nodes, upon = NONE) {
    const pairs = (high[0] - low[0]) * (high[1] - low[1]);
    if (pairs) this.list.push({ low, high, event, argument, nodes, pairs, upon });
  }

  divide(a, b) {
    const visit = this.visits.get(keyOf(a, b)),
      { events, axes } = this,
      step = events.outcomes[events.outcome[visit]];
    if (step === "whole") return this.add(a, b, visit, NODE_BOXES);
    if (axes[0].isLeaf(a) && axes[1].isLeaf(b)) return this.divideLeaves(a, b, visit);
    for (const i of axes[0].below(a, step === "B"))
      for (const k of axes[1].below(b, step === "A"))
        if (this.visits.has(keyOf(i, k))) this.divide(i, k);
        else this.add(i, k, visit, CHILD_BOXES);
  }

  divideLeaves(a, b, visit) {
    const { events, axes } = this,
      rest = this.add(a, b, visit, events.engine ? CHILD_BOXES : FACE_BOXES);
    for (const i of (this.tests.get(keyOf(a, b)) || new Map()).values()) {
      const low = [axes[0].rank[events.a[i]], axes[1].rank[events.b[i]]],
        high = low.map((x) => x + 1),
        argument = this.argumentOf(i);
      // Until it is tested, a pair that planes do not separate is open.
      const waits = argument !== PLANES && rest !== OPEN;
      if (waits) this.push(low, high, visit, OPEN, [a, b], rest);
      this.push(low, high, i, argument, [a, b], waits ? OPEN : rest);
    }
  }

  argumentOf(i) {
    const part = this.parts[this.events.work[i]] || "";
    if (this.events.kindOf(i).name === "plane test") return PLANES;
    if (this.events.isHit(i)) return this.ofBodies ? CONTACT : TOLERANCE;
    return /expansions$/.test(part) ? EXPANSIONS : /filter$|corners$/.test(part) ? FILTER : FLOATS;
  }
}

/** Returns the largest gap of two boxes, centre and half axes in the world, along a normal: {gap, axis}. */
function separation(boxes) {
  const way = boxes[1][0].clone().sub(boxes[0][0]),
    halves = boxes.flatMap(([, ...half]) => half);
  const axes = halves.map((half, i) => {
    const n = half.clone().normalize(),
      reach = halves.reduce((sum, h) => sum + Math.abs(n.dot(h)), 0);
    return { gap: Math.abs(n.dot(way)) - reach,
        axis: `axis ${(i % 3) + 1} of ${SIDES[i < 3 ? 0 : 1]}\u2019s box` };
  });
  return axes.reduce((p, q) => (q.gap > p.gap ? q : p));
}

export class ProofMap {
  /** `view`: null without a 3D view. */
  constructor(scene, events, selection, view) {
    // Listeners are notified of the part of the map that is shown, and of the painted picture.
    Object.assign(this, { scene, events, selection, view, key: "", window: [0, 0, 1], corners: [0, 0, 0, 0],
        listeners: [] });
    const label = "Proof map: all pairs of faces, by the test that decided them",
      whole = textButton("whole", () => this.zoom([0, 0], [0, 0], 1), "Show all pairs; the wheel enlarges");
    const look = "flex:none;cursor:crosshair";
    this.canvas = element("canvas", { style: look, role: "img", "aria-label": label });
    this.words = element("p", { class: "note", style: "max-width:60ch" });
    this.legend = element("table");
    const side = element("div", {}, this.legend, element("p", { class: "parts" }, whole), this.words);
    this.box = element("div", { style: "display:flex;flex-wrap:wrap;gap:16px" }, this.canvas, side);
    byId("scene").append(element("div", { class: "tab", "data-tab": "Proof map" }, this.box));
    this.redraw = oncePerFrame(() => this.draw());
    selection.listeners.push((what) => what === "event" && this.redraw());
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
  tell(what) {
    for (const listener of this.listeners) listener(what);
  }

  draw() {
    if (!this.box.offsetParent) return; // another tab is shown
    const room = this.box.closest(".tab-body"),
      most = Math.min(room ? room.clientHeight - 32 : 400, 0.55 * this.box.clientWidth),
      size = Math.round(Math.max(240, most)),
      pixels = Math.round(size * Math.min(2, window.devicePixelRatio || 1)),
      step = this.events.step(this.selection.event),
      key = `${step} ${this.events.count} ${pixels}`;
    if (this.key !== key) {
      this.cells = new MapCells(this.scene, this.events, step);
      Object.assign(this, { key, painted: null, pointed: undefined });
    }
    const { list, complete } = this.cells;
    this.canvas.hidden = this.legend.hidden = !list.length;
    if (!list.length) {
      this.words.textContent = complete ? "This step has no traversal of its own."
        : "The tab Events loads the events of this step.";
      return this.tell({ map: null });
    }
    if (!this.painted) {
      this.canvas.width = this.canvas.height = pixels;
      this.canvas.style.width = this.canvas.style.height = `${size}px`;
    }
    this.paint(pixels);
    this.count();
  }

  /** Returns the pixels of a cell: [x0, x1, y0, y1], an array that the next call changes: there may be a
      million. Neighbours round their common border alike. */
  rectangle({ low, high, argument }, size) {
    const { window, corners: out } = this, { axes } = this.cells, part = size / window[2],
      least = isHit(argument) ? 3 : isPoint(argument) ? 2 : 0;
    for (let side = 0; side < 2; side++) {
      const count = axes[side].size, start = window[1 - side], i = 2 - 2 * side;
      out[i] = Math.round((low[side] / count - start) * part);
      out[i + 1] = Math.round((high[side] / count - start) * part);
      const more = Math.max(0, least - (out[i + 1] - out[i]));
      out[i] -= more >> 1;
      out[i + 1] += more - (more >> 1);
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
    const { list } = this.cells,
      context = this.canvas.getContext("2d"),
      now = this.selection.event;
    if (!this.painted || (this.painted.next > 0 && list[this.painted.next - 1].event > now)) {
      const image = context.createImageData(size, size),
        shades = this.scene.map.arguments.map((a) => this.shades(a)),
        pixels = new Uint32Array(image.data.buffer).fill(shades[OPEN].at(-1).inside);
      this.painted = { next: 0, image, pixels, sums: new Float64Array(shades.length), hits: [], shades };
    }
    const { painted } = this;
    for (; painted.next < list.length && list[painted.next].event <= now; painted.next++) {
      const cell = list[painted.next];
      painted.sums[cell.argument] += cell.pairs;
      if (cell.upon !== NONE) painted.sums[cell.upon]--;
      if (isHit(cell.argument)) painted.hits.push(cell);
      this.fill(cell, size);
    }
    for (const cell of painted.hits) this.fill(cell, size); // small ones stay on top of later neighbours
    context.putImageData(painted.image, 0, 0);
    if (painted.reported !== painted.next) this.tell({ map: painted.pixels });
    painted.reported = painted.next;
    // The cell under the pointer or of the event, and the pairs that another engine got wrong.
    const { axes } = this.cells,
      nodes = this.events.about(now, "node").map((n) => n.number),
      range = (name) => nodes.map((n, side) => axes[side][name][n]),
      marked = this.pointed || (nodes.length && { low: range("low"), high: range("high") }),
      wrong = this.events.wrong[this.events.step(now)]
          .map((w) => w.simplices.map((s, side) => axes[side].rank[s])),
      frames = wrong.map((low) => [{ low, high: low.map((x) => x + 1) }, this.scene.colours.wrong]);
    for (const [cell, colour] of marked ? [...frames, [marked, style("--ink")]] : frames) {
      const [x0, x1, y0, y1] = this.rectangle({ argument: CONTACT, ...cell }, size);
      for (const [width, ink] of [[5, style("--card")], [2, colour]]) {
        Object.assign(context, { lineWidth: width, strokeStyle: ink });
        context.strokeRect(x0, y0, x1 - x0, y1 - y0);
      }
    }
  }

  fill(cell, size) {
    const out = this.rectangle(cell, size), x0 = out[0], x1 = out[1], y0 = out[2], y1 = out[3];
    if (x1 <= 0 || y1 <= 0 || x0 >= size || y0 >= size || x0 === x1 || y0 === y1) return;
    const { pixels, shades } = this.painted,
      shade = Math.round(((SHADES - 1) * Math.log(cell.pairs + 1)) / Math.log(this.cells.pairs + 1)),
      { inside, rim } = shades[cell.argument][shade],
      outlined = Math.min(x1 - x0, y1 - y0) >= 8,
      [from, to] = [Math.max(0, x0), Math.min(size, x1)];
    for (let y = Math.max(0, y0); y < Math.min(size, y1); y++) {
      pixels.fill(outlined && (y === y0 || y === y1 - 1) ? rim : inside, y * size + from, y * size + to);
      if (outlined && x0 >= 0) pixels[y * size + x0] = rim;
      if (outlined && x1 <= size) pixels[y * size + x1 - 1] = rim;
    }
  }

  /** Writes what was decided so far, and by which argument. */
  count() {
    const { sums, next } = this.painted,
      { pairs, list } = this.cells,
      { arguments: all } = this.scene.map,
      open = pairs - sums.reduce((n, x, i) => (i === OPEN ? n : n + x), 0);
    const row = (name, n, { colour, pale } = { colour: "transparent", pale: 0 }) => {
      const paint = `color-mix(in srgb, var(--card) ${100 * pale}%, ${colour}), ${colour}`,
        look = `display:inline-block;width:2.2em;height:.8em;background:linear-gradient(to right, ${paint})`,
        cells = [element("i", { style: look }), name, digits(n),
            `${Number((100 * n / pairs).toPrecision(2))} %`];
      return element("tr", {}, ...cells.map((cell, i) => element("td", { class: i > 1 ? "n" : "" }, cell)));
    };
    this.legend.replaceChildren(
      ...all.flatMap((a, i) => (sums[i] && i !== OPEN ? [row(a.name, sums[i], a)] : [])),
      ...(open ? [row(next < list.length ? "not decided yet" : all[OPEN].name, open, all[OPEN])] : []),
      row("all pairs", pairs),
    );
  }

  /** Returns the last cell at a place that was decided up to an event. */
  find(at, last) {
    const { list, axes } = this.cells || { list: [] },
      holds = ({ low, high }) =>
        [at[1], at[0]]
            .every((x, side) => low[side] <= x * axes[side].size && x * axes[side].size < high[side]);
    return list.findLast((cell) => cell.event <= last && holds(cell));
  }

  /** Goes to the event that decides the pairs at a place. */
  go(at) {
    if (document.documentElement.classList.contains("mapping")) return; // another run's map would stay
    const cell = this.find(at, Infinity);
    if (cell) this.selection.goTo(cell.event);
  }

  /** Describes the cell at a place, and shows its boxes in the view; null: none. */
  point(at) {
    const cell = at ? this.find(at, this.selection.event) : undefined;
    if (cell === this.pointed) return;
    this.pointed = cell;
    this.words.textContent = cell ? this.text(cell) : "";
    if (this.view && this.cells.ofBodies) {
      const nodes = cell ? cell.nodes.map((number, side) => ({ side, number })) : [];
      this.view.marks.setBoxes("map", `${cell?.nodes}`, nodes, this.view.colours.selected);
      this.view.redraw();
    }
    this.redraw();
  }

  text({ low, high, event, argument, nodes, pairs }) {
    const name = `${this.scene.map.arguments[argument].name}.`,
      [what, two] = isPoint(argument) ? ["Triangles", [this.events.a[event], this.events.b[event]]]
          : ["Nodes", nodes],
      sizes = high.map((x, side) => digits(x - low[side])).join(" \u00d7 "),
      [a, b] = two.map(digits),
      apart = argument <= NODE_BOXES ? this.apart(nodes) : "";
    return `Event ${digits(this.events.id(event))}. ${what} ${a} of A, ${b} of B; ` +
      `${sizes} = ${plural(pairs, "pair")}: ${name} ${apart}`;
  }

  /** Says along which axis the boxes of two nodes are disjoint; empty: not known. */
  apart(nodes) {
    if (!this.view || !this.cells.ofBodies) return "";
    const boxes = this.view.views.map(({ body, group }, side) => {
      const first = 12 * body.boxes.node.indexOf(nodes[side]),
        part = (k) => new THREE.Vector3(...body.boxes.places.subarray(first + k, first + k + 3)),
        centre = part(0).applyMatrix4(group.matrix);
      return first < 0 ? null
          : [centre, ...[3, 6, 9].map((k) => part(0).add(part(k)).applyMatrix4(group.matrix).sub(centre))];
    });
    if (boxes.includes(null)) return "";
    const { gap, axis } = separation(boxes);
    return gap > 0 ? `Apart by ${short(gap * this.scene.unit)} along ${axis}.` : "Apart along another axis.";
  }
}
