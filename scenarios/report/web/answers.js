// ---- the page of answers about one body: distances of points, or pairs of faces that intersect. An answer, or all
// answers of a group (a curve), is selected in the view or in a table
import { byId, digits, linkRow } from "./dom.js";
import { discard, rgb, roundPoints, thickLines, thickMaterial, WHITE } from "./scene_bodies.js";
import { Body, NONE, unpack } from "./scene_run.js";
import { ballOf, BodiesCanvas, onClick, webglWorks } from "./scene_view.js";

/** The answers. An index into these arrays; `numbers` are those that commands and tables use. */
class Answers {
  constructor(json) {
    this.what = json.what; // of one answer: "point"
    this.group = json.group; // of those that belong together: "curve"; empty: none do
    this.kinds = json.kinds.map(({ name, colour }) => ({ name, colour: rgb(colour) }));
    this.hasPoints = json.hasPoints;
    for (const name of ["numbers", "kind", "groups", "faces", "first", "ends"]) this[name] = unpack(json[name]);
    this.count = this.numbers.length;
    this.indexOf = new Map(Array.from(this.numbers, (number, i) => [number, i]));
  }

  /** Returns the faces of an answer: one, or the two of a pair. */
  facesOf(i) {
    return [...this.faces.subarray(2 * i, 2 * i + 2)].filter((face) => face !== NONE);
  }

  /** Returns the segments of an answer, six numbers each. A point is the first end of its only segment. */
  endsOf(i) {
    return this.ends.subarray(6 * this.first[i], 6 * this.first[i + 1]);
  }

  with(test) {
    return [...Array(this.count).keys()].filter(test);
  }
}

class AnswersView extends BodiesCanvas {
  constructor(json, body, answers) {
    super(json, [body]);
    this.answers = answers;
    this.shown = new THREE.Group(); // of the selection
    this.items = []; // selected
    this.views[0].paint({ of: () => this.colours.bodies[0] }, 0);
    this.views[0].lookInside(true, false);
    const kinds = answers.kinds.map((kind, k) => ({ ...kind, items: answers.with((i) => answers.kind[i] === k) })).filter((kind) => kind.items.length);
    for (const { colour, items } of kinds)
      if (answers.hasPoints) this.addPoints(this.stage, items, colour, answers.count > 300 ? 7 : 11, 10);
      else this.addSegments(this.stage, items, colour, 2, 8);
    this.stage.add(this.shown);
    this.legend.also(kinds.map(({ name, colour }) => [colour, name, WHITE]), "kinds");
    this.start();
  }

  draw() {
    this.render();
  }

  addPoints(group, items, colour, size, order) {
    const points = roundPoints(
      items.flatMap((i) => [...this.answers.endsOf(i).subarray(0, 3)]),
      colour,
      size * this.renderer.getPixelRatio(),
    );
    points.renderOrder = order;
    group.add(points);
  }

  /** Adds lines on a pale ground, and points where both ends are equal. */
  addSegments(group, items, colour, width, order) {
    const lines = [],
      points = [];
    for (const i of items) {
      const ends = [...this.answers.endsOf(i)];
      for (let k = 0; k < ends.length; k += 6) {
        const [p, q] = [ends.slice(k, k + 3), ends.slice(k + 3, k + 6)];
        if (p.every((x, axis) => x === q[axis])) points.push(...p);
        else lines.push(...p, ...q);
      }
    }
    for (const [c, w, at] of [
      [WHITE, 2.4 * width, order],
      [colour, width, order + 0.5],
    ]) {
      const mesh = thickLines(lines, thickMaterial(c, w, this.size));
      mesh.renderOrder = at;
      group.add(mesh);
    }
    if (!points.length) return;
    const ends = roundPoints(points, colour, 4 * width * this.renderer.getPixelRatio());
    ends.renderOrder = order + 1;
    group.add(ends);
  }

  /** Shows a selection: the answers in it, of which the first is meant if it is not a group. */
  select(key, items, { ghost, isolate }) {
    const { answers, colours, marks } = this,
      [view] = this.views,
      faces = items.flatMap((i) => answers.facesOf(i)),
      own = new Set(faces);
    for (const object of this.shown.children.slice()) discard(this.shown, object);
    for (const k of answers.kinds.keys()) {
      const some = items.filter((i) => answers.kind[i] === k);
      if (some.length) this.addSegments(this.shown, some, answers.kinds[k].colour, answers.hasPoints ? 2 : 4, 11);
      if (some.length && answers.hasPoints) this.addPoints(this.shown, some, colours.selected, 15, 13);
    }
    // The two faces of one pair differ in colour.
    const second = items.length === 1 ? faces.slice(1) : [],
      first = items.length === 1 ? faces.slice(0, 1) : [...own];
    const mark = (name, some, colour) =>
      marks.set(name, key, some.map((face) => ({ side: 0, face })), { colour, opacity: 0.65, width: 2.5, over: true });
    mark("first", first, colours.selected);
    mark("second", second, colours.bodies[1]);
    this.legend.also(
      [
        [colours.selected, answers.hasPoints ? "selected, with its closest face" : second.length ? "first face of the pair" : "faces of the curve"],
        ...(second.length ? [[colours.bodies[1], "second face"]] : []),
      ],
      "selected",
    );
    view.ghost(ghost && view.body.dim === 3 && !isolate);
    view.real.show((face) => !isolate || own.has(face));
    view.edges.visible = !isolate;
    this.items = items;
    this.redraw();
  }

  /** Returns the points that span some answers. */
  pointsOf(items) {
    const out = [];
    for (const i of items) {
      const ends = this.answers.endsOf(i);
      for (let k = 0; k < ends.length; k += 3) out.push(new THREE.Vector3(...ends.subarray(k, k + 3)));
    }
    return out.filter((p) => p.toArray().every(Number.isFinite)); // floats may not hold points far away
  }

  extremes() {
    this.all ||= this.pointsOf(this.answers.with(() => true));
    return [...super.extremes(), ...this.all];
  }

  frameSelected() {
    const faces = this.items.flatMap((i) => this.answers.facesOf(i)),
      box = new THREE.Box3().setFromPoints(this.pointsOf(this.items));
    this.views[0].eachCorner(faces, (x, y, z) => box.expandByPoint(new THREE.Vector3(x, y, z)));
    const ball = ballOf(box);
    this.camera.lookAt(ball.centre, Math.max(1.5 * ball.radius, 1e-4 * this.reach().radius));
    this.redraw();
  }

  /** Returns the answer nearest to a point of the screen, at most `most` pixels away; -1: none. */
  nearestAnswer(x, y, most = 10) {
    const frame = this.canvas.getBoundingClientRect(),
      at = new THREE.Vector3(),
      place = (ends, k) => {
        at.set(ends[k], ends[k + 1], ends[k + 2]).project(this.camera.camera);
        return [frame.left + (frame.width * (1 + at.x)) / 2 - x, frame.top + (frame.height * (1 - at.y)) / 2 - y];
      };
    let best = -1;
    for (let i = 0; i < this.answers.count; i++) {
      const ends = this.answers.endsOf(i);
      for (let k = 0; k < ends.length; k += 6) {
        const [px, py] = place(ends, k),
          [qx, qy] = this.answers.hasPoints ? [px, py] : place(ends, k + 3),
          [dx, dy] = [qx - px, qy - py],
          t = Math.max(0, Math.min(1, -(px * dx + py * dy) / (dx * dx + dy * dy || 1))),
          far = Math.hypot(px + t * dx, py + t * dy);
        if (far < most) [most, best] = [far, i];
      }
    }
    return best;
  }
}

class AnswersPage {
  constructor(json) {
    this.answers = new Answers(json);
    this.body = new Body(json.body, 0, json.dim);
    this.look = { ghost: true, isolate: false };
    this.heads = new Map(); // by name of a selection's sort: titles of the columns of its table
    this.rows = new Map(); // by target: the row
    for (const row of document.querySelectorAll("tr[data-to]")) {
      this.rows.set(row.dataset.to, row);
      this.heads.set(row.dataset.to.split(" ")[0], [...row.closest("table").tHead.rows[0].cells]);
    }
    this.view = webglWorks() ? new AnswersView(json, this.body, this.answers) : null;
    if (!this.view) {
      document.body.classList.add("without-view");
      byId("no-view").textContent = "This browser has no WebGL, so the body is not drawn.";
      byId("no-view").hidden = false;
    }
    this.connect();
    if (!this.answers.count) {
      byId("item").hidden = true;
      byId("item-state").textContent = `no ${this.answers.what}`;
    } else if (!this.read()) this.select("item", this.answers.numbers[0]);
    if (this.view) this.view.frameAll(this.view.camera.from);
  }

  /** Selects an answer, or all of a group, by number. */
  select(sort, number) {
    const { answers } = this,
      items = sort === "item" ? answers.with((i) => answers.numbers[i] === number) : answers.with((i) => answers.groups[i] === number);
    byId("item-state").textContent = items.length ? "" : "not on this page";
    if (!items.length) return false;
    Object.assign(this, { sort, number, items });
    this.write();
    this.draw();
    history.replaceState(null, "", `#${sort}=${number}`);
    return true;
  }

  /** Takes the selection from the address. */
  read() {
    const [, sort, number] = /^#(item|group)=(\d+)$/.exec(location.hash) || [];
    return Boolean(sort) && this.select(sort, Number(number));
  }

  draw() {
    if (this.view) this.view.select(`${this.sort} ${this.number}`, this.items, this.look);
  }

  write() {
    const { answers, sort, number, items } = this,
      isGroup = sort === "group",
      what = isGroup ? answers.group : answers.what,
      row = this.rows.get(`${sort} ${number}`);
    byId("item-what").textContent = what[0].toUpperCase() + what.slice(1);
    byId("item").value = number;
    const facts = [...(row ? row.cells : [])].slice(1).map((cell, k) => [this.heads.get(sort)[k + 1].textContent, cell.textContent]);
    byId("item-facts").replaceChildren(
      ...facts.flatMap((fact) =>
        fact.map((text, k) => Object.assign(document.createElement(k ? "dd" : "dt"), { textContent: text })),
      ),
    );
    byId("view-caption").textContent = `${what} ${number}: ${facts.slice(0, 2).filter(([, value]) => value).map((fact) => fact.join(" ")).join(", ")}`;
    const link = (text, action) => {
      const button = document.createElement("button");
      Object.assign(button, { type: "button", className: "text", textContent: text, onclick: action });
      return button;
    };
    const most = 12,
      others = isGroup ? items : [];
    byId("item-near").replaceChildren(
      ...(answers.group && !isGroup ? [link(`${answers.group} ${answers.groups[items[0]]}`, () => this.select("group", answers.groups[items[0]]))] : []),
      ...others.slice(0, most).map((i) => link(`${answers.what} ${answers.numbers[i]}`, () => this.select("item", answers.numbers[i]))),
      ...(others.length > most ? [`and ${others.length - most} more`] : []),
    );
    for (const [target, marked] of this.rows) {
      if (target === `${sort} ${number}`) marked.setAttribute("aria-current", "true");
      else marked.removeAttribute("aria-current");
    }
  }

  /** Selects the answer `by` places after this one, or the first or last one of a group. */
  go(by) {
    const { answers, items } = this,
      at = by > 0 ? items[items.length - 1] : items[0],
      next = Math.max(0, Math.min(answers.count - 1, at + by));
    this.select("item", answers.numbers[next]);
  }

  toggle(name) {
    this.look[name] = !this.look[name];
    byId(name).setAttribute("aria-pressed", String(this.look[name]));
    this.draw();
  }

  connect() {
    const { answers, view } = this;
    for (const [target, row] of this.rows) {
      const [sort, number] = target.split(" ");
      linkRow(row, () => {
        this.select(sort, Number(number));
        byId("stage").scrollIntoView({ block: "nearest" });
      });
    }
    byId("item").onchange = () => this.select(this.sort, Number(byId("item").value));
    window.addEventListener("hashchange", () => this.read());
    document.addEventListener("keydown", (e) => this.press(e));
    if (!view) return;
    if (this.body.dim === 2) byId("ghost").hidden = byId("orthographic").hidden = true;
    byId("fit-all").onclick = () => view.frameAll();
    byId("fit-selected").onclick = () => view.frameSelected();
    for (const name of ["ghost", "isolate"]) byId(name).onclick = () => this.toggle(name);
    byId("orthographic").onclick = () => {
      view.camera.setOrthographic(!view.camera.orthographic);
      byId("orthographic").setAttribute("aria-pressed", String(view.camera.orthographic));
    };
    onClick(view.canvas, (e) => {
      const near = view.nearestAnswer(e.clientX, e.clientY);
      if (near >= 0) return this.select("item", answers.numbers[near]);
      const hit = view.nearest(e.clientX, e.clientY, [view.views[0].real]),
        [of] = hit ? answers.with((i) => answers.facesOf(i).includes(hit.face)) : [];
      if (of !== undefined) this.select("item", answers.numbers[of]);
      else if (hit) byId("item-state").textContent = `face ${digits(hit.face)}: none`;
      return true;
    });
  }

  press(e) {
    if (e.ctrlKey || e.metaKey || e.altKey || ["INPUT", "SELECT"].includes(e.target.tagName)) return;
    const keys = { F: "fit-all", f: "fit-selected", g: "ghost", i: "isolate", o: "orthographic" };
    if (e.key === "ArrowLeft" || e.key === "ArrowRight") this.go(e.key === "ArrowLeft" ? -1 : 1);
    else if (keys[e.key] && this.view) byId(keys[e.key]).click();
    else return;
    e.preventDefault();
  }
}

export const answersPage = new AnswersPage(JSON.parse(byId("scene-data").textContent));
