// ---- the page of a crowd: one time step, and a body or a pair of bodies, selected in the view, the tables, the
// matrix and the charts
import { byId, digits, linkRow, plural, style } from "./dom.js";
import { data, listeners, moment, seek, seekBy, showEvent } from "./page.js";
import { boxEdges, Colours, FaceMesh, FlatFill, mixed, rgb, WHITE } from "./scene_bodies.js";
import { listenToKeys, toggleHelp } from "./scene_controls.js";
import { Legend, PLANE } from "./scene_marks.js";
import { CostStrip, explainCells, printView, showMore, Tabs } from "./scene_page.js";
import { copyText, fillList, textButton } from "./scene_panels.js";
import { Body, lastAtMost, unpack } from "./scene_run.js";
import { ballOf, BodiesCanvas, onClick, webglWorks } from "./scene_view.js";

/** The run: bodies, and by step the poses and the queries. Steps are indices into those on the page. */
class Crowd {
  constructor(json) {
    this.kinds = json.kinds.map((k, i) => ({ ...k, body: k.body ? new Body(k.body, i, json.dim) : null }));
    this.dim = json.dim;
    this.kindOf = [];
    this.names = [];
    this.kinds.forEach((kind, k) => {
      for (let i = 1; i <= kind.count; i++) {
        this.kindOf.push(k);
        this.names.push(`${kind.name} ${i}`);
      }
    });
    this.readSteps(json.steps);
    this.readQueries(json.queries);
  }

  get count() {
    return this.names.length;
  }
  get steps() {
    return this.numbers.length;
  }
  kind(body) {
    return this.kinds[this.kindOf[body]];
  }

  /** Assigns each body the steps at which it moved, and its poses there. */
  readSteps(json) {
    this.numbers = unpack(json.index); // of the steps, in the run
    this.allSteps = json.all;
    this.contactSteps = json.contacts;
    const ends = unpack(json.ends),
      moved = unpack(json.moved);
    this.poses = unpack(json.poses);
    this.movesOf = this.names.map(() => ({ steps: [], poses: [] }));
    for (let step = 0, i = 0; step < ends.length; step++)
      for (; i < ends[step]; i++) {
        this.movesOf[moved[i]].steps.push(step);
        this.movesOf[moved[i]].poses.push(i);
      }
  }

  /** Returns a body's pose at a step: rows of [R | t]. */
  pose(body, step) {
    const { steps, poses } = this.movesOf[body],
      at = poses[lastAtMost(steps, step)];
    return this.poses.subarray(12 * at, 12 * at + 12);
  }

  readQueries(json) {
    this.ends = unpack(json.ends);
    for (const name of ["a", "b", "relation", "kept", "pairs", "boxes", "planes", "faces"]) this[name] = unpack(json[name]);
    this.relations = json.relations;
    this.measures = Object.entries(json.measures); // [name, values of the queries]
    this.contactEnds = unpack(json.contactEnds);
    this.contactFaces = unpack(json.contactFaces);
    this.tests = this.a.map((_, q) => this.boxes[q] + this.planes[q] + this.faces[q]);
    this.SEPARATE = this.relations.indexOf("separate");
    this.UNDEFINED = this.relations.indexOf("undefined");
  }

  /** Returns the queries of a step, ascending by bodies. */
  queries(step) {
    const first = step > 0 ? this.ends[step - 1] : 0;
    return Array.from({ length: this.ends[step] - first }, (_, i) => first + i);
  }
  meets(query) {
    return ![this.SEPARATE, this.UNDEFINED].includes(this.relation[query]);
  }
  /** Returns the query of two bodies at a step; -1: their boxes are disjoint. */
  find([a, b], step) {
    const query = this.queries(step).find((q) => this.a[q] === a && this.b[q] === b);
    return query === undefined ? -1 : query;
  }
  /** Returns the faces of both bodies of a query that intersect the other one: [{side: body, face}]. */
  contacts(query) {
    return [this.a[query], this.b[query]].flatMap((body, i) => {
      const end = 2 * query + i,
        first = end > 0 ? this.contactEnds[end - 1] : 0;
      return [...this.contactFaces.subarray(first, this.contactEnds[end])].map((face) => ({ side: body, face }));
    });
  }
  pairName([a, b]) {
    return `${this.names[a]} and ${this.names[b]}`;
  }
}

// ---- a body of a crowd in the view: it shares the mesh of its kind, and has a material of its own
class CrowdBody {
  constructor(crowd, index, shared) {
    this.body = shared.faces.body;
    this.shared = shared;
    this.open = crowd.kind(index).open;
    this.group = new THREE.Group();
    this.group.matrixAutoUpdate = false;
    this.material = shared.material.clone();
    this.mesh = new THREE.Mesh(shared.faces.mesh.geometry, this.material);
    this.mesh.userData.index = index;
    this.group.add(this.mesh);
    if (this.body.dim === 2) {
      this.fill = new FlatFill(this.body, rgb(crowd.kind(index).colour), 0.5, 0, 0.01);
      this.fill.show(Array.from({ length: this.body.realCount }, (_, face) => face));
      this.group.add(this.fill.fan, this.fill.sheet);
    }
  }

  point(vertex) {
    return [0, 1, 2].map((i) => this.body.vertices[3 * vertex + i]);
  }
  get reached() {
    return this.shared.extremes;
  }
  toWorld(p) {
    return new THREE.Vector3(...p).applyMatrix4(this.group.matrix);
  }
  setPose(p) {
    this.group.matrix.set(...p, 0, 0, 0, 1);
    this.group.matrixWorldNeedsUpdate = true;
    this.group.updateMatrixWorld(true);
  }
  widen(pixel) {
    this.shared.faces.widen(3 * pixel);
  }

  /** `faded`: the body is only hinted at. Open bodies have no inside and hide nothing. */
  look(colour, visible, faded) {
    const opacity = faded ? 0.1 : this.open ? 0.4 : 1;
    this.group.visible = visible;
    this.material.color.setRGB(...colour);
    if (this.opacity === opacity) return;
    this.opacity = opacity;
    Object.assign(this.material, { transparent: opacity < 1, opacity, depthWrite: opacity === 1 });
    this.material.needsUpdate = true;
    this.mesh.renderOrder = faded ? 4 : opacity < 1 ? 2 : 0;
  }
}

class CrowdView extends BodiesCanvas {
  constructor(json, crowd, state) {
    super(json, crowd);
    Object.assign(this, { crowd, state });
    this.addRoom(json.room);
    this.placed = -1;
    this.picking();
    this.start();
  }

  /** Makes a mesh for each kind, and an object that shares it for each body. */
  makeViews(crowd) {
    const shared = crowd.kinds.map(({ body }) => {
      const faces = new FaceMesh(
        body,
        Uint32Array.from({ length: body.realCount }, (_, face) => face),
        null,
      );
      faces.paint(() => WHITE); // the material's colour is that of the body
      faces.mesh.geometry.computeBoundingBox();
      const { min, max } = faces.mesh.geometry.boundingBox,
        extremes = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => [0, 1, 2].map((i) => (k & (1 << i) ? max : min).getComponent(i)));
      const Material = crowd.dim === 2 ? THREE.MeshBasicMaterial : THREE.MeshLambertMaterial;
      return { faces, extremes, material: new Material({ side: THREE.DoubleSide }) };
    });
    return crowd.names.map((_, i) => new CrowdBody(crowd, i, shared[crowd.kindOf[i]]));
  }

  addRoom(packed) {
    if (!packed) return;
    const room = unpack(packed),
      axes = [0, 1, 2].map((axis) => [0, 1, 2].map((i) => (i === axis ? room[3 + i] : 0)));
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute(
      "position",
      new THREE.BufferAttribute(Float32Array.from(boxEdges([...room.slice(0, 3), ...axes.flat()], [0])), 3),
    );
    this.room = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: new THREE.Color(...PLANE) }));
    this.stage.add(this.room);
  }

  draw() {
    const { crowd, state } = this;
    if (this.placed !== state.step) this.views.forEach((view, i) => view.setPose(crowd.pose(i, state.step)));
    this.placed = state.step;
    this.paint();
    this.mark();
    this.render();
  }

  /** Colours the bodies. With a selection, the others may be faded or hidden. */
  paint() {
    const { crowd, state, colours } = this,
      { by } = state.look,
      queries = crowd.queries(state.step),
      selected = new Set(state.bodies),
      alone = state.look.isolate && selected.size > 0 ? new Set(selected) : null,
      tests = new Float64Array(crowd.count),
      meet = new Set();
    for (const q of queries) {
      const pair = [crowd.a[q], crowd.b[q]];
      for (const body of pair) tests[body] += crowd.tests[q];
      if (crowd.meets(q)) pair.forEach((body) => meet.add(body));
      // Of a selected pair the two alone, of a body also those near it.
      if (alone && selected.size === 1 && pair.some((body) => selected.has(body))) pair.forEach((body) => alone.add(body));
    }
    const most = tests.reduce((m, x) => Math.max(m, x), 0),
      pale = (colour) => mixed(colour, WHITE, 0.75);
    this.views.forEach((view, i) => {
      const kind = rgb(crowd.kind(i).colour),
        colour =
          by === "tests"
            ? tests[i] > 0 ? colours.onScale(tests[i] / most) : pale(PLANE)
            : by === "meets"
              ? meet.has(i) ? colours.contact : pale(PLANE)
              : kind;
      view.look(selected.has(i) ? mixed(colour, colours.selected, 0.75) : colour, !alone || alone.has(i), state.look.ghost && !selected.has(i));
    });
    byId("scale").hidden = by !== "tests";
    byId("scale-bar").style.background = `linear-gradient(to right, ${colours.stops.join(", ")})`;
    byId("scale-most").textContent = digits(most);
    byId("scale-title").textContent = "tests of boxes, planes and faces of each body, in this step";
    this.legend.also(
      [
        ...(by === "kind"
          ? crowd.kinds.map((k) => [rgb(k.colour), `${digits(k.count)} × ${k.name}${k.open ? ", open" : ""}`])
          : []),
        ...(by === "meets" ? [[pale(PLANE), "meets no other"]] : []),
        [colours.contact, by === "meets" ? "intersects another" : "faces in contact"],
        [colours.selected, "selected"],
      ],
      "crowd",
    );
  }

  /** Shows the faces in contact, of a selected pair through everything. */
  mark() {
    const { crowd, state, colours, marks } = this,
      pair = state.bodies.length === 2 ? crowd.find(state.bodies, state.step) : -1,
      shown = (q) => [crowd.a[q], crowd.b[q]].every((body) => this.views[body].group.visible),
      queries = state.look.contacts ? crowd.queries(state.step).filter((q) => q !== pair && shown(q)) : [],
      key = `${state.step} ${state.look.contacts} ${state.look.isolate ? state.bodies : ""} ${pair}`;
    marks.set("contacts", key, queries.flatMap((q) => crowd.contacts(q)), { colour: colours.contact, width: 1, through: false });
    marks.set("pair", key, pair < 0 ? [] : crowd.contacts(pair), { colour: colours.contact, over: true, opacity: 0.9, width: 2 });
  }

  /** Returns the body under a point of the screen; -1: none. */
  under(x, y) {
    const box = this.canvas.getBoundingClientRect(),
      ray = new THREE.Raycaster();
    ray.setFromCamera(
      new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height),
      this.camera.camera,
    );
    const [hit] = ray.intersectObjects(this.views.filter((v) => v.group.visible).map((v) => v.mesh));
    return hit ? hit.object.userData.index : -1;
  }

  picking() {
    const { canvas, state } = this;
    onClick(canvas, (e) => {
      const body = this.under(e.clientX, e.clientY);
      if (body < 0) state.select([]);
      else if (e.shiftKey && state.bodies.length === 1 && state.bodies[0] !== body) state.select([state.bodies[0], body]);
      else state.select([body]);
    });
    canvas.addEventListener("dblclick", (e) => (this.under(e.clientX, e.clientY) < 0 ? this.frameAll() : this.frameSelection()));
  }

  extremes() {
    const bodies = super.extremes();
    if (!this.room) return bodies;
    const ends = this.room.geometry.attributes.position;
    return [...bodies, ...Array.from({ length: ends.count }, (_, i) => new THREE.Vector3().fromBufferAttribute(ends, i))];
  }

  frameSelection() {
    const { state, crowd } = this;
    if (!state.bodies.length) return this.frameAll();
    const query = state.bodies.length === 2 ? crowd.find(state.bodies, state.step) : -1,
      faces = query < 0 ? [] : crowd.contacts(query),
      points = faces.length
        ? faces.flatMap(({ side, face }) => {
            const view = this.views[side];
            return [...view.body.face(face)].map((v) => view.toWorld(view.point(v)));
          })
        : state.bodies.flatMap((i) => this.views[i].reached.map((p) => this.views[i].toWorld(p)));
    const ball = ballOf(new THREE.Box3().setFromPoints(points));
    this.camera.lookAt(ball.centre, Math.max(ball.radius * (faces.length ? 2 : 1.05), 1e-4));
    this.redraw();
  }
}

// ---- the state of the page, which all parts show
class CrowdState {
  constructor(crowd) {
    Object.assign(this, { crowd, step: 0, bodies: [], listeners: [] });
    this.look = { ghost: false, isolate: false, contacts: true, by: "kind" };
  }

  tell() {
    for (const listener of this.listeners) listener();
  }
  /** Moves to a step, by its index on the page; frames and charts follow. */
  goTo(step) {
    this.step = Math.max(0, Math.min(this.crowd.steps - 1, step));
    const number = this.crowd.numbers[this.step];
    showEvent(number, number);
    this.tell();
  }
  /** Selects bodies: none, one, or a pair. */
  select(bodies) {
    this.bodies = bodies.slice().sort((p, q) => p - q);
    this.tell();
  }
  change(look) {
    Object.assign(this.look, look);
    this.tell();
  }
}

// ---- beside the view: the selection in words and numbers, and the bodies near it
class CrowdPanel {
  constructor(crowd, state, command) {
    Object.assign(this, { crowd, state, command });
    byId("pair-copy").onclick = async () => {
      byId("pair-copied").textContent = (await copyText(byId("pair-command").textContent, byId("pair-command"))) ? "copied" : "";
    };
    byId("picked-none").onclick = () => state.select([]);
    state.listeners.push(() => this.show());
  }

  show() {
    const { crowd, state } = this,
      { bodies, step } = state;
    byId("picked").hidden = !bodies.length;
    byId("pair-run").hidden = bodies.length !== 2;
    byId("pair-copied").textContent = "";
    if (bodies.length === 1) this.showBody(bodies[0]);
    if (bodies.length === 2) this.showPair();
    this.showNear(bodies.length ? crowd.queries(step).filter((q) => bodies.some((b) => [crowd.a[q], crowd.b[q]].includes(b))) : crowd.queries(step));
  }

  showBody(body) {
    const { crowd, state } = this,
      kind = crowd.kind(body),
      all = crowd.queries(state.step).filter((q) => [crowd.a[q], crowd.b[q]].includes(body)),
      sum = (name) => all.reduce((n, q) => n + crowd[name][q], 0);
    byId("picked-title").textContent = crowd.names[body];
    fillList(byId("picked-facts"), [
      ["kind", `${kind.name}${kind.open ? ", open: it has no inside" : ""}`, "bodies of a kind share one mesh"],
      ["faces", digits(kind.realFaces), "real faces of the body"],
      ["boxes overlap", plural(all.length, "body", "bodies"), "other bodies whose boxes overlap its box in this step"],
      ["intersects", plural(all.filter((q) => crowd.meets(q)).length, "body", "bodies"), "in this step"],
      ["tests", digits(sum("tests")), "tests of boxes, planes and faces of its queries in this step"],
      ["moved", crowd.movesOf[body].steps.includes(state.step) && state.step > 0 ? "since the step before" : state.step > 0 ? "not since the step before" : "first step", ""],
    ]);
  }

  showPair() {
    const { crowd, state } = this,
      query = crowd.find(state.bodies, state.step);
    byId("picked-title").textContent = crowd.pairName(state.bodies);
    const rows =
      query < 0
        ? [["relation", "separate: their boxes are disjoint", "in this step"]]
        : [
            ["relation", crowd.relations[crowd.relation[query]], "in this step"],
            ["pairs of faces", digits(crowd.pairs[query]), "intersecting pairs of faces in this step"],
            ...crowd.measures.map(([name, values]) => [name, typeof values[query] === "number" ? digits(values[query]) : values[query] || "\u2013", "in this step"]),
            ...(crowd.kept[query]
              ? [["tests", "none: neither body has moved since the step before", "the answer is that of the step before"]]
              : [
                  ["face tests", digits(crowd.faces[query]), "exact tests of two faces"],
                  ["other tests", digits(crowd.boxes[query] + crowd.planes[query]), "of boxes, and of planes of faces"],
                ]),
          ];
    fillList(byId("picked-facts"), [...rows, ["over all steps", this.history(), "the steps on this page at which the bodies intersect"]]);
    byId("pair-command").textContent = `${this.command} "${state.bodies.map((b) => crowd.names[b]).join(",")}"`;
  }

  /** Returns the steps at which the selected pair intersects: "3–17, 20". */
  history() {
    const { crowd, state } = this,
      runs = [];
    for (let step = 0; step < crowd.steps; step++) {
      const query = crowd.find(state.bodies, step);
      if (query < 0 || !crowd.meets(query)) continue;
      const last = runs.at(-1);
      if (last && last[1] === step - 1) last[1] = step;
      else runs.push([step, step]);
    }
    const number = (step) => digits(crowd.numbers[step]);
    return runs.length ? `intersect at ${runs.map(([p, q]) => (p === q ? number(p) : `${number(p)}\u2013${number(q)}`)).join(", ")}` : "never intersect";
  }

  /** Lists queries as buttons, intersecting and costly ones first. */
  showNear(queries) {
    const { crowd, state } = this,
      most = 12,
      one = state.bodies.length === 1 ? state.bodies[0] : -1,
      sorted = queries.sort((p, q) => crowd.meets(q) - crowd.meets(p) || crowd.tests[q] - crowd.tests[p]);
    byId("near-title").textContent = one >= 0 ? "Its box overlaps" : state.bodies.length ? "Their boxes overlap" : "Pairs with most tests in this step";
    byId("near-list").replaceChildren(
      ...sorted.slice(0, most).map((q) => {
        const pair = [crowd.a[q], crowd.b[q]],
          text = one >= 0 ? crowd.names[pair[0] === one ? pair[1] : pair[0]] : `${crowd.names[pair[0]]}, ${crowd.names[pair[1]]}`,
          button = textButton(text, () => state.select(pair), `${crowd.relations[crowd.relation[q]]}, ${digits(crowd.tests[q])} tests`);
        if (crowd.meets(q)) button.classList.add("meets");
        return button;
      }),
      sorted.length > most ? `and ${digits(sorted.length - most)} more` : "",
    );
    if (!sorted.length) byId("near-list").textContent = "no other body";
  }
}

// ---- the table of the queries of the step
class CrowdTable {
  constructor(crowd, state) {
    Object.assign(this, { crowd, state });
    this.table = byId("step-table");
    this.columns = [
      { name: "A", title: "the body with the lower number", of: (q) => crowd.a[q], text: (q) => crowd.names[crowd.a[q]] },
      { name: "B", title: "the other body", of: (q) => crowd.b[q], text: (q) => crowd.names[crowd.b[q]] },
      { name: "relation", title: "of the two bodies", of: (q) => crowd.relation[q], text: (q) => crowd.relations[crowd.relation[q]] },
      ...crowd.measures.map(([name, values]) => ({ name, title: "measured for this pair", of: (q) => parseFloat(String(values[q]).replace(/[^\d.e-]/, "")) || 0, text: (q) => (typeof values[q] === "number" ? digits(values[q]) : values[q]) })),
      ...[
        ["pairs", "pairs of faces", "intersecting pairs of faces"],
        ["faces", "face tests", "exact tests of two faces"],
        ["planes", "plane tests", "tests of a face against the plane of another"],
        ["boxes", "box tests", "tests of the boxes of tree nodes"],
        ["tests", "all tests", "tests of boxes, planes and faces: the cost of the query"],
      ].map(([key, name, title]) => ({ name, title, isNumber: true, of: (q) => crowd[key][q], text: (q) => digits(crowd[key][q]) })),
    ];
    this.by = this.columns.length - 1;
    this.way = -1;
    const [head] = this.table.tHead.rows;
    this.columns.forEach((column, i) => {
      const th = document.createElement("th");
      th.append(textButton(column.name, () => this.sort(i), `${column.title}; a click sorts by it`));
      th.title = column.title;
      if (column.isNumber) th.className = "n";
      head.append(th);
    });
    this.table.tBodies[0].addEventListener("click", (e) => {
      const row = e.target.closest("[data-query]");
      if (row) this.pick(Number(row.dataset.query));
    });
    state.listeners.push(() => this.show());
  }

  sort(column) {
    this.way = this.by === column ? -this.way : this.columns[column].isNumber ? -1 : 1;
    this.by = column;
    this.key = null;
    this.show();
  }

  pick(query) {
    const { crowd, state } = this;
    state.select([crowd.a[query], crowd.b[query]]);
  }

  show() {
    const { crowd, state, columns } = this,
      most = 300;
    if (this.key !== state.step) {
      this.key = state.step;
      const { of } = columns[this.by];
      this.rows = crowd.queries(state.step).sort((p, q) => this.way * (of(p) - of(q)) || p - q);
      byId("table-step").textContent = digits(crowd.numbers[state.step]);
      byId("table-count").textContent = `${plural(this.rows.length, "pair of overlapping boxes", "pairs of overlapping boxes")}${this.rows.length > most ? `; the first ${most} are listed` : ""}`;
      this.table.tBodies[0].replaceChildren(...this.rows.slice(0, most).map((q) => this.line(q)));
      [...this.table.tHead.rows[0].cells].forEach((th, i) => th.setAttribute("aria-sort", i !== this.by ? "none" : this.way < 0 ? "descending" : "ascending"));
    }
    for (const row of this.table.tBodies[0].rows) {
      const q = Number(row.dataset.query),
        at = state.bodies.filter((b) => b === crowd.a[q] || b === crowd.b[q]).length;
      row.setAttribute("aria-selected", state.bodies.length === 2 && at === 2);
      row.classList.toggle("concerned", state.bodies.length === 1 && at === 1);
    }
  }

  line(query) {
    const row = document.createElement("tr");
    row.dataset.query = query;
    row.className = `leads${this.crowd.meets(query) ? " meets" : ""}`;
    row.tabIndex = 0;
    row.addEventListener("keydown", (e) => {
      if (e.key === "Enter") this.pick(query);
    });
    for (const column of this.columns) {
      const cell = row.insertCell();
      cell.textContent = column.text(query);
      if (column.isNumber) cell.className = "n";
    }
    return row;
  }

  /** Selects the pair above or below the selected one. */
  by1(way) {
    const at = this.rows.findIndex((q) => this.state.bodies.length === 2 && this.crowd.a[q] === this.state.bodies[0] && this.crowd.b[q] === this.state.bodies[1]),
      next = at < 0 ? 0 : Math.max(0, Math.min(this.rows.length - 1, at + way));
    if (!this.rows.length) return;
    this.pick(this.rows[next]);
    this.table.querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
  }
}

// ---- the matrix of all pairs: who meets whom
class CrowdMatrix {
  constructor(crowd, state, colours, tabs) {
    Object.assign(this, { crowd, state, colours, tabs });
    this.canvas = byId("matrix");
    this.cell = Math.max(2, Math.min(16, Math.floor(560 / crowd.count)));
    this.size = this.cell * crowd.count;
    this.margin = 90; // left of the cells, for the names of the kinds
    Object.assign(this.canvas, { width: this.margin + this.size, height: this.size });
    byId("matrix-scope").oninput = () => this.show();
    this.canvas.addEventListener("click", (e) => this.pick(e));
    this.canvas.addEventListener("pointermove", (e) => this.explain(e));
    state.listeners.push(() => this.show());
    tabs.listeners.push(() => this.show());
    const dot = (colour, text) => {
      const span = document.createElement("span"),
        i = document.createElement("i");
      i.style.background = colour;
      span.append(i, text);
      return span;
    };
    byId("matrix-legend").replaceChildren(
      dot(Legend.css(colours.contact), "intersect"),
      dot("var(--soft)", "boxes overlap"),
      dot(Legend.css(colours.selected), "selected"),
    );
  }

  /** Returns [a, b] under the pointer; null: no pair. */
  at(e) {
    const box = this.canvas.getBoundingClientRect(),
      scale = this.canvas.width / box.width, // the canvas may be narrower than its cells
      [x, y] = [(e.clientX - box.left) * scale - this.margin, (e.clientY - box.top) * scale].map((at) => Math.floor(at / this.cell)),
      pair = [Math.min(x, y), Math.max(x, y)];
    return x === y || pair[0] < 0 || pair[1] >= this.crowd.count ? null : pair;
  }
  explain(e) {
    const pair = this.at(e);
    this.canvas.title = pair ? `${this.crowd.pairName(pair)}: ${this.words(pair)}` : "";
  }
  words([a, b]) {
    const found = this.cells.get(a * this.crowd.count + b);
    return !found ? "boxes disjoint" : `${found.meets ? "intersect" : "boxes overlap"}, ${digits(found.tests)} tests`;
  }
  pick(e) {
    const pair = this.at(e);
    if (pair) this.state.select(pair);
  }

  show() {
    const { crowd, state, cell } = this;
    if (this.tabs.shown !== "Matrix") return;
    const scope = byId("matrix-scope").value,
      key = `${scope} ${scope === "step" ? state.step : ""}`;
    if (this.key !== key) {
      this.key = key;
      this.cells = new Map();
      const queries = scope === "step" ? crowd.queries(state.step) : crowd.a.keys();
      for (const q of queries) {
        const at = crowd.a[q] * crowd.count + crowd.b[q],
          found = this.cells.get(at) || { tests: 0, meets: false };
        found.tests += crowd.tests[q];
        found.meets ||= crowd.meets(q);
        this.cells.set(at, found);
      }
      byId("matrix-title").textContent = plural(this.cells.size, "pair", "pairs");
    }
    const context = this.canvas.getContext("2d"),
      { size, margin } = this,
      most = [...this.cells.values()].reduce((m, c) => Math.max(m, c.tests), 1);
    context.setTransform(1, 0, 0, 1, margin, 0);
    context.clearRect(-margin, 0, margin + size, size);
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "right";
    context.textBaseline = "middle";
    let end = 0;
    for (const kind of crowd.kinds) {
      // The pairs of one kind, its name, and lines between the kinds.
      context.fillStyle = style("--ink");
      context.fillText(kind.name, -8, cell * (end + kind.count / 2), margin - 12);
      context.fillStyle = style("--grid");
      context.fillRect(cell * end, cell * end, cell * kind.count, cell * kind.count);
      end += kind.count;
      context.fillRect(cell * end, 0, 1, size);
      context.fillRect(0, cell * end, size, 1);
    }
    const contact = Legend.css(this.colours.contact),
      near = style("--soft"),
      put = (a, b, colour, alpha) => {
        context.globalAlpha = alpha;
        context.fillStyle = colour;
        for (const [x, y] of [[a, b], [b, a]]) context.fillRect(cell * x, cell * y, Math.max(2, cell - (cell > 4 ? 1 : 0)), Math.max(2, cell - (cell > 4 ? 1 : 0)));
      };
    for (const [at, { tests, meets }] of this.cells)
      put(Math.floor(at / crowd.count), at % crowd.count, meets ? contact : near, 0.35 + 0.65 * Math.sqrt(tests / most));
    context.globalAlpha = 1;
    context.strokeStyle = Legend.css(this.colours.selected);
    context.lineWidth = 2;
    const [a, b] = state.bodies;
    if (b !== undefined) for (const [x, y] of [[a, b], [b, a]]) context.strokeRect(cell * x - 2, cell * y - 2, cell + 4, cell + 4);
    else if (a !== undefined) context.strokeRect(cell * a - 1, 0, cell + 2, size);
  }
}

// ---- the page
class CrowdPage {
  constructor(json) {
    this.json = json;
    const crowd = (this.crowd = new Crowd(json)),
      state = (this.state = new CrowdState(crowd));
    for (const part of document.querySelectorAll(json.dim === 2 ? ".of-solids" : ".of-flat")) part.remove();
    this.panel = new CrowdPanel(crowd, state, json.command);
    this.table = new CrowdTable(crowd, state);
    this.view = this.openView();
    byId("thinned").textContent = json.thinned;
    byId("thinned").hidden = !json.thinned;
    this.makeStrip();
    this.tabs = new Tabs();
    this.matrix = new CrowdMatrix(crowd, state, new Colours(json.colours), this.tabs);
    explainCells();
    const panelMark = showMore(document.querySelector(".panel"));
    state.listeners.push(() => {
      this.write();
      panelMark();
      this.later();
      if (this.view) this.view.redraw();
    });
    this.tabs.listeners.push(() => this.later());
    this.timeline();
    this.controls();
    this.links();
    this.followPage();
    if (this.view) printView(this.view);
    if (!this.read()) state.goTo(this.costliest());
    if (this.view) this.view.frameAll(this.view.camera.from);
    window.addEventListener("hashchange", () => this.read());
  }

  /** Returns the step with most tests of faces, at which the page opens. */
  costliest() {
    const faces = unpack(this.json.costs.faces);
    let best = 0;
    this.crowd.numbers.forEach((number, step) => {
      if (faces[number] > faces[this.crowd.numbers[best]]) best = step;
    });
    return best;
  }

  openView() {
    const no = (reason) => {
      byId("stage").classList.add("without-view");
      byId("no-view").textContent = reason;
      byId("no-view").hidden = false;
      const pictures = byId("frames");
      if (pictures) byId("no-view").after(pictures);
      return null;
    };
    if (this.json.tooLarge) return no(this.json.tooLarge);
    if (!webglWorks()) return no(`This browser has no WebGL, which the view needs.${data.frames.length ? " These frames show the run." : ""}`);
    return new CrowdView(this.json, this.crowd, this.state);
  }

  makeStrip() {
    const { costs } = this.json,
      { crowd, state } = this,
      columns = ["boxes", "planes", "faces"].map((name) => unpack(costs[name])),
      colours = ["--work-boxes", "--work-planes", "--work-tests"];
    const bars = Array.from(columns[0], (_, number) => ({
      step: number,
      values: columns.map((column) => column[number]),
      words: `step ${digits(number)}`,
      go: () => seek("step", number),
    }));
    this.strip = new CostStrip({
      title: "tests in each step",
      sorts: ["boxes", "planes of faces", "faces"].map((name, i) => ({ name, colour: `var(${colours[i]})` })),
      bars,
    });
    state.listeners.push(() => this.strip.mark(crowd.numbers[state.step]));
  }

  write() {
    const { crowd, state } = this,
      number = crowd.numbers[state.step],
      queries = crowd.queries(state.step),
      meet = queries.filter((q) => crowd.meets(q)).length;
    byId("step").value = state.step;
    byId("step-count").textContent = `step ${digits(number)} (${digits(crowd.numbers[0])}\u2013${digits(crowd.numbers.at(-1))})`;
    byId("view-caption").textContent =
      `step ${digits(number)}: ${plural(queries.length, "pair of overlapping boxes", "pairs of overlapping boxes")}, ${digits(meet)} intersect` +
      (number < crowd.contactSteps ? "" : "; the faces in contact of this step exceed the limit of a page");
    for (const name of ["ghost", "isolate", "contacts"]) byId(name).setAttribute("aria-pressed", String(state.look[name]));
    byId("isolate").disabled = byId("frame-it").disabled = !state.bodies.length;
    byId("colour-by").value = state.look.by;
  }

  timeline() {
    const { crowd, state } = this,
      button = byId("play-steps");
    byId("step").max = crowd.steps - 1;
    byId("step-row").parentElement.hidden = crowd.steps < 2;
    let timer = 0;
    const pause = () => {
      clearInterval(timer);
      timer = 0;
      button.classList.remove("playing");
      button.setAttribute("aria-label", "Play");
    };
    const play = () => {
      if (state.step === crowd.steps - 1) state.goTo(0);
      timer = setInterval(() => {
        state.goTo(state.step + 1);
        if (state.step === crowd.steps - 1) pause();
      }, 1000 / byId("play-speed").value);
      button.classList.add("playing");
      button.setAttribute("aria-label", "Pause");
    };
    this.go = (step) => {
      pause();
      state.goTo(step);
    };
    this.toggle = () => (timer ? pause() : play());
    byId("step").oninput = () => this.go(Number(byId("step").value));
    byId("step-back").onclick = () => this.go(state.step - 1);
    byId("step-next").onclick = () => this.go(state.step + 1);
    byId("play-speed").onchange = () => {
      if (timer) pause(), play();
    };
    button.onclick = this.toggle;
  }

  controls() {
    const { state, view, tabs, table } = this,
      flip = (name) => state.change({ [name]: !state.look[name] }),
      cycle = () => {
        const select = byId("colour-by");
        select.selectedIndex = (select.selectedIndex + 1) % select.length;
        state.change({ by: select.value });
      };
    for (const name of ["ghost", "isolate", "contacts"]) byId(name).onclick = () => flip(name);
    byId("picked-isolate").onclick = () => flip("isolate");
    byId("colour-by").oninput = () => state.change({ by: byId("colour-by").value });
    byId("help-open").onclick = toggleHelp;
    const keys = {
      ArrowLeft: (shift) => this.go(state.step - (shift ? 10 : 1)),
      ArrowRight: (shift) => this.go(state.step + (shift ? 10 : 1)),
      "[": () => this.go(state.step - 1),
      "]": () => this.go(state.step + 1),
      Home: () => this.go(0),
      End: () => this.go(this.crowd.steps - 1),
      ArrowUp: () => table.by1(-1),
      ArrowDown: () => table.by1(1),
      " ": () => this.toggle(),
      "?": toggleHelp,
      t: () => tabs.toggleHeight(),
      Escape: () => state.select([]),
      ...Object.fromEntries(tabs.names.slice(0, 9).map((name, i) => [String(i + 1), () => tabs.show(name)])),
    };
    if (view) {
      const turn = 0.09,
        frame = (all) => (all ? view.frameAll() : view.frameSelection());
      byId("frame-all").onclick = () => frame(true);
      byId("frame-it").onclick = byId("picked-frame").onclick = () => frame(false);
      Object.assign(keys, {
        f: (shift) => frame(shift),
        g: () => flip("ghost"),
        i: () => flip("isolate"),
        c: () => flip("contacts"),
        k: cycle,
        "+": () => view.camera.zoom(1.2),
        "=": () => view.camera.zoom(1.2),
        "-": () => view.camera.zoom(1 / 1.2),
      });
      if (!view.camera.plane) {
        const orthographic = () => {
          view.camera.setOrthographic(!view.camera.orthographic);
          byId("orthographic").setAttribute("aria-pressed", String(view.camera.orthographic));
          view.redraw();
        };
        byId("orthographic").onclick = orthographic;
        Object.assign(keys, {
          o: orthographic,
          a: () => view.camera.turn(-turn, 0),
          d: () => view.camera.turn(turn, 0),
          e: () => view.camera.turn(0, turn),
          q: () => view.camera.turn(0, -turn),
        });
      }
    }
    listenToKeys(keys);
  }

  /** Rows of tables about a pair: "bodies STEP A B". */
  links() {
    for (const row of document.querySelectorAll("tr[data-to^=bodies]")) {
      const [step, a, b] = row.dataset.to.split(" ").slice(1).map(Number);
      linkRow(row, () => {
        this.go(Math.max(0, lastAtMost(this.crowd.numbers, step)));
        this.state.select([a, b]);
      });
    }
  }

  /** Charts and frames lead to their step, and vice versa. */
  followPage() {
    const { crowd, state } = this,
      near = (number) => Math.max(0, lastAtMost(crowd.numbers, Math.round(number)));
    seekBy((key, value) => this.go(near(value)));
    listeners.push(() => {
      if (moment.step < 0 || near(moment.step) === state.step) return;
      state.step = near(moment.step); // set by a frame
      state.tell();
    });
  }

  // -- the state in the address: #s12&bodies=3,7&tab=Charts
  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => history.replaceState(null, "", `#${this.address()}`), 300);
  }
  address() {
    const { crowd, state, tabs } = this,
      parts = [`s${crowd.numbers[state.step]}`];
    if (state.bodies.length) parts.push(`bodies=${state.bodies.join(",")}`);
    if (tabs.shown !== tabs.names[0]) parts.push(`tab=${encodeURIComponent(tabs.shown)}`);
    const { ghost, isolate, contacts, by } = state.look,
      show = [ghost && "ghost", isolate && "isolate", !contacts && "no-contacts", by !== "kind" && by].filter(Boolean);
    if (show.length) parts.push(`show=${show.join(",")}`);
    return parts.join("&");
  }
  /** Returns true if the address has a step. */
  read() {
    const { crowd, state, tabs } = this,
      [first, ...rest] = location.hash.slice(1).split("&"),
      value = Object.fromEntries(rest.map((part) => part.split("=").map(decodeURIComponent))),
      step = /^s(\d+)$/.exec(first),
      bodies = (value.bodies || "").split(",").filter(Boolean).map(Number),
      show = (value.show || "").split(",");
    if (!step) return false;
    if (bodies.length <= 2 && bodies.every((b) => b < crowd.count)) state.bodies = bodies;
    Object.assign(state.look, { ghost: show.includes("ghost"), isolate: show.includes("isolate"), contacts: !show.includes("no-contacts"), by: show.find((s) => ["tests", "meets"].includes(s)) || "kind" });
    if (value.tab) tabs.show(value.tab);
    state.goTo(Math.max(0, lastAtMost(crowd.numbers, Number(step[1]))));
    return true;
  }
}

export const crowdPage = new CrowdPage(JSON.parse(byId("scene-data").textContent));
