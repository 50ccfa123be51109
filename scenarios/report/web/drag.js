import { byId, copyText, digits, element, listenToKeys, oncePerFrame, plural } from "./dom.js";
import { FIELD } from "./scene_camera.js";
import { Body, NONE, poseInPage, SIDES } from "./scene_run.js";
import { BodiesCanvas, webglWorks } from "./scene_view.js";

// ---- the live page of a run: B is dragged, and the engine in this page (wasm/engine.cpp) answers every pose

/** Two bodies in the engine's memory. */
class Engine {
  /** `files`: the bytes of both bodies' .lrb files. */
  static async open(files) {
    const engine = new Engine();
    engine.module = await lrbscopeEngine();
    engine.rows = engine.module._malloc(12 * 8);
    files.forEach((bytes, side) => {
      const at = engine.module._malloc(bytes.length);
      engine.module.HEAPU8.set(bytes, at);
      engine.module._lrb_load(side, at, bytes.length);
      engine.module._free(at);
    });
    return engine;
  }

  /** Returns the answer for two poses of 12 numbers. `seconds`: how long the query is repeated to measure its
      time; 0: it runs once. */
  query(poses, seconds = 0) {
    const { module: m, rows } = this;
    poses.forEach((pose, side) => {
      m.HEAPF64.set(pose, rows / 8);
      m._lrb_pose(side, rows);
    });
    const micros = m._lrb_query(seconds),
      word = (i) => m.UTF8ToString(m._lrb_word(i)),
      list = (i) => {
        const at = m._lrb_list(i) / 4;
        return m.HEAPU32.slice(at, at + m._lrb_list_size(i));
      };
    return {
      micros,
      relation: word(0),
      fingerprint: word(1),
      pairs: [list(0), list(1)], // simplices
      opened: [list(2), list(3)], // refined regions
      tested: [list(4), list(5)], // faces
      faceTests: m._lrb_counter(0),
      nodePairs: m._lrb_counter(1),
      boxTests: m._lrb_counter(2),
      fallbacks: m._lrb_counter(4),
    };
  }
}

/** Returns the faces of A and of B in pairs of simplices. */
const facesOf = (pairs, bodies) =>
  pairs.map((list, side) => new Set([...list].map((s) => bodies[side].faceOfSimplex(s))));

/** The pose of a body, in doubles: x' = Q (R x) + t. Q, a rotation, is the identity until the body is
    rotated, so that a given pose is kept to the last bit. */
class DraggedPose {
  constructor(rows) {
    this.set(rows);
  }

  set(rows) {
    this.base = [0, 1, 2].map((i) => rows.slice(4 * i, 4 * i + 3));
    this.t = [3, 7, 11].map((i) => rows[i]);
    this.q = new THREE.Quaternion();
  }

  /** Returns the rows of [Q R | t]. */
  rows() {
    const q = new THREE.Matrix4().makeRotationFromQuaternion(this.q).elements, // column by column
      r = [0, 1, 2].map((i) =>
        [0, 1, 2].map((j) => this.base.reduce((sum, row, k) => sum + q[4 * k + i] * row[j], 0)),
      );
    return r.flatMap((row, i) => [...row, this.t[i]]);
  }

  /** Returns the position of a point of the body. */
  apply(p) {
    const m = this.rows();
    return [0, 1, 2].map((i) => m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3]);
  }

  move(way) {
    this.t = this.t.map((x, i) => x + way[i]);
  }

  /** Rotates about an axis through a point of the body, which stays where it is. */
  turn(axis, angle, centre) {
    const before = this.apply(centre);
    this.q.premultiply(new THREE.Quaternion().setFromAxisAngle(axis, angle)).normalize();
    const after = this.apply(centre);
    this.move(before.map((x, i) => x - after[i]));
  }
}

/** Returns 12 numbers of a text, or null. */
function poseOf(text) {
  const words = text.split(/[\s,;[\]]+/).filter((word) => word),
    numbers = words.map(Number);
  return numbers.length === 12 && numbers.every(Number.isFinite) ? numbers : null;
}

/** Returns the pose of B in the page's address, or null. */
function poseOfAddress() {
  return poseOf(decodeURIComponent(location.hash.replace(/^#pose=/, "")));
}

// ---- the view: bodies, wrappers, tested faces and faces in contact
class DragView extends BodiesCanvas {
  constructor(json, bodies) {
    super(json, bodies);
    this.json = json;
    const mode = this.colours.mode(bodies, "kind", null);
    this.views.forEach((v) => v.paint(mode, 0.4));
    this.lidKeys = ["", ""];
    this.shown = { lids: true, tested: true };
    this.start();
  }

  /** Places a body at a pose of the world; its vertices are relative to its centre. */
  place(side, rows) {
    this.views[side].setPose(poseInPage(rows, side, this.json));
    this.views[side].group.updateMatrixWorld(true);
  }

  /** Shows an answer. `picked`: index of a pair, or -1. */
  show(answer, picked) {
    const { bodies, colours, shown } = this;
    const faces = (lists) => lists.flatMap((list, side) => bodies[side].sided(list));
    const hit = facesOf(answer.pairs, bodies);
    const missed = answer.tested.map((list, side) => [...list].filter((face) => !hit[side].has(face)));
    this.views.forEach((view, side) => this.showWrapper(view, side, answer.opened[side]));
    const set = (name, list, look) => this.marks.set(name, list.map(Object.values).join(" "), list, look);
    set("tested", shown.tested ? faces(missed) : [],
        { colour: colours.underTest, opacity: 0.55, width: 0.8, through: false });
    set("contacts", faces(hit), { colour: colours.contact, opacity: 0.95, width: 1.5 });
    set(
      "picked",
      picked < 0 ? []
          : answer.pairs.map((list, side) => ({ side, face: bodies[side].faceOfSimplex(list[picked]) })),
      { colour: colours.selected, opacity: 0.9, width: 3, over: true },
    );
    this.legend.also(
      [
        [colours.bodies[0], `A, ${bodies[0].name}`],
        [colours.bodies[1], `B, ${bodies[1].name}`],
        ...(hit[0].size ? [[colours.contact, "in contact"]] : []),
        ...(shown.tested && missed.flat().length ? [[colours.underTest, "tested, not in contact"]] : []),
        ...(shown.lids && bodies.some((b) => b.regionCount)
          ? SIDES.map((s, side) => [colours.lid(side), `wrapper of ${s}`, colours.edge(side)]) : []),
        ...(picked < 0 ? [] : [[colours.selected, "selected pair"]]),
      ],
      "answer",
    );
    this.redraw();
    return hit;
  }

  /** Shows the lids of a body's wrapper without the refined regions. */
  showWrapper(view, side, opened) {
    const body = this.bodies[side],
      visible = this.shown.lids && body.regionCount > 0;
    view.lids.mesh.visible = view.lidEdges.visible = visible;
    view.lookInside(true, visible);
    const key = opened.join(" ");
    if (!visible || this.lidKeys[side] === `=${key}`) return;
    this.lidKeys[side] = `=${key}`;
    const refined = new Set(opened);
    const included = (region, without) => (region === NONE ? without : !refined.has(region));
    view.showLids((f) => included(body.inner[f], true) && !included(body.outer[f], false));
  }

  /** Returns true if B is the nearest body under a point of the screen. */
  isOverB(x, y) {
    const hit = this.nearest(
      x,
      y,
      this.views.flatMap((v) => [v.real, ...(v.lids.mesh.visible ? [v.lids] : [])]),
    );
    return hit !== null && hit.side === 1;
  }

  /** Returns the directions of the screen: right, up, and out of it. */
  axes() {
    const out = this.camera.camera.position.clone().sub(this.camera.controls.target).normalize(),
      right = new THREE.Vector3().setFromMatrixColumn(this.camera.camera.matrixWorld, 0);
    return { right, up: out.clone().cross(right), out };
  }

  /** Returns the length in the world of a pixel at the centre of B. */
  pixelAtB() {
    const { camera } = this.camera,
      centre = this.views[1].toWorld([0, 0, 0]),
      depth = centre.clone().sub(camera.position).dot(this.axes().out.negate());
    const { halfHeight, orthographic } = this.camera,
      half = orthographic ? halfHeight : Math.max(depth, 1e-6) * Math.tan(FIELD / 2);
    return (2 * half * this.json.unit) / this.size.y;
  }
}

// ---- the page: pose, answer, mouse and keys
class LivePage {
  constructor(json, engine) {
    this.json = json;
    this.engine = engine;
    this.bodies = json.bodies.map((b, side) => new Body(b, side, json.dim));
    this.simplices = json.bodies.map((b) => b.simplices);
    this.picked = -1;
    const [poseA, poseB] = json.steps[json.steps.length - 1].poses;
    this.poseA = poseA;
    this.pose = new DraggedPose(poseOfAddress() || poseB);
    this.view = webglWorks() ? new DragView(json, this.bodies) : null;
    if (!this.view)
      fail("This browser has no WebGL, so nothing is drawn. The engine still answers the pose below.");
    this.connect();
    this.changed();
    if (this.view) this.view.frameAll(this.view.camera.from);
  }

  /** Queries the current pose and shows the answer. */
  changed() {
    const rows = this.pose.rows();
    this.picked = -1;
    try {
      this.answer = this.engine.query([this.poseA, rows], 0.003);
    } catch (e) {
      fail(`The engine stopped at this pose (${e.message || e}); reload the page.`);
      return;
    }
    // `lrbscope query` leaves A at the identity.
    byId("pose-query").hidden = this.poseA.some((x, i) => x !== (i % 5 === 0 ? 1 : 0));
    if (this.view) {
      this.view.place(0, this.poseA);
      this.view.place(1, rows);
    }
    this.write(rows);
    this.draw();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.rested(rows), 250);
  }

  /** Called once B stays where it is: measures the time again, for longer, and puts the pose into the
      address, which browsers let change only now and then. */
  rested(rows) {
    this.answer.micros = this.engine.query([this.poseA, rows], 0.05).micros;
    this.writeTime();
    history.replaceState(null, "", `#pose=${rows.join(",")}`);
  }

  /** Queries once per picture, however often the mouse moves. */
  soon = oncePerFrame(() => this.changed());

  draw() {
    if (this.view) this.view.show(this.answer, this.picked);
  }

  write(rows) {
    const { answer, bodies } = this,
      count = answer.pairs[0].length,
      put = (id, text) => (byId(id).textContent = text),
      faces = facesOf(answer.pairs, bodies).map((set) => set.size);
    put("relation", answer.relation.replace(/_/g, " "));
    put("relation-cell", answer.relation.replace(/_/g, " "));
    put("pairs", digits(count));
    put("faces", `${digits(faces[0])} of A, ${digits(faces[1])} of B`);
    put("fingerprint", answer.fingerprint);
    put("tests", `${digits(answer.faceTests)} of ${digits(this.simplices[0] * this.simplices[1])} pairs`);
    put("box-tests", digits(answer.boxTests));
    put("node-pairs", digits(answer.nodePairs));
    put("fallbacks", digits(answer.fallbacks));
    ["a", "b"].forEach((name, side) =>
      put(`refined-${name}`,
          `${digits(answer.opened[side].length)} of ${plural(bodies[side].regionCount, "region")}`),
    );
    byId("pose").value = rows.join(" ");
    byId("pose").removeAttribute("aria-invalid");
    put("pose-state", "");
    this.writeTime();
    this.writePairs();
  }

  writeTime() {
    const { micros, relation, pairs, faceTests } = this.answer,
      time = `${micros < 10 ? micros.toFixed(1) : digits(Math.round(micros))} \u00b5s`;
    byId("time").textContent = time;
    byId("view-caption").textContent =
      `${relation.replace(/_/g, " ")}: ${plural(pairs[0].length, "pair")}, ` +
      `${plural(faceTests, "face test")}, ${time}`;
  }

  writePairs() {
    const most = 200, rows = byId("pair-rows"), { pairs } = this.answer,
      count = Math.min(most, pairs[0].length);
    byId("pairs-shown").textContent = pairs[0].length > most ? `the first ${most}` : "";
    rows.replaceChildren(
      ...Array.from({ length: count }, (_, i) => {
        const [a, b] = pairs.map((list, side) => this.bodies[side].faceOfSimplex(list[i])),
          words = `face ${digits(a)} of A, face ${digits(b)} of B`,
          row = element("button", { type: "button", title: "Show this pair" }, words);
        row.onclick = () => {
          this.picked = this.picked === i ? -1 : i;
          [...rows.children].forEach((r, k) => r.setAttribute("aria-pressed", k === this.picked));
          this.draw();
        };
        return row;
      }),
    );
  }

  // -- changes of the pose
  get radius() {
    return this.view ? this.view.views[1].radius * this.json.unit : 1;
  }

  /** Moves B along the axes of the screen, in units of the world. */
  move(right, up, out) {
    const axes = this.view.axes(),
      way = axes.right.multiplyScalar(right).addScaledVector(axes.up, up).addScaledVector(axes.out, out);
    this.pose.move(this.json.dim === 2 ? [way.x, way.y, 0] : way.toArray());
    this.soon();
  }

  /** Rotates B about the axes of the screen, in radians. */
  turn(aboutUp, aboutRight, aboutOut) {
    const axes = this.view.axes(),
      centre = this.json.bodies[1].centre;
    if (this.json.dim === 2) {
      this.pose.turn(new THREE.Vector3(0, 0, 1), aboutOut || aboutUp, centre);
    } else {
      const axis = axes.up.multiplyScalar(aboutUp).addScaledVector(axes.right, aboutRight)
          .addScaledVector(axes.out, aboutOut),
        angle = axis.length();
      if (angle > 0) this.pose.turn(axis.divideScalar(angle), angle, centre);
    }
    this.soon();
  }

  reset() {
    this.goToStep(this.json.steps.length - 1);
  }

  goToStep(i) {
    const at = Math.max(0, Math.min(this.json.steps.length - 1, i));
    this.poseA = this.json.steps[at].poses[0];
    this.pose.set(this.json.steps[at].poses[1]);
    this.nameStep(at);
    this.changed();
  }
  nameStep(i) {
    byId("run-step").value = i;
    byId("run-out").textContent = String(this.json.steps[i].index);
  }

  apply(text) {
    const rows = poseOf(text);
    if (!rows) {
      byId("pose").setAttribute("aria-invalid", "true");
      byId("pose-state").textContent = "expected 12 finite numbers";
      return;
    }
    this.pose.set(rows);
    this.changed();
  }

  setMode(turning) {
    this.turning = turning;
    byId("move").setAttribute("aria-pressed", String(!turning));
    byId("turn").setAttribute("aria-pressed", String(turning));
  }

  connect() {
    const { steps } = this.json;
    byId("copy").onclick = async () => {
      if (await copyText(byId("pose").value, byId("pose"))) byId("pose-state").textContent = "copied";
    };
    byId("apply").onclick = () => this.apply(byId("pose").value);
    byId("reset").onclick = () => this.reset();
    window.addEventListener("hashchange", () => {
      const rows = poseOfAddress();
      if (rows && rows.join() !== this.pose.rows().join()) this.apply(rows.join(" "));
    });
    if (steps.length > 1) {
      byId("run-label").hidden = false;
      byId("run-step").max = steps.length - 1;
      this.nameStep(steps.length - 1);
      byId("run-step").oninput = () => this.goToStep(Number(byId("run-step").value));
    }
    if (!this.view) return;
    this.setMode(false);
    byId("move").onclick = () => this.setMode(false);
    byId("turn").onclick = () => this.setMode(true);
    byId("fit").onclick = () => this.view.frameAll();
    for (const name of ["lids", "tested"])
      byId(name).onclick = () => {
        this.view.shown[name] = !this.view.shown[name];
        byId(name).setAttribute("aria-pressed", String(this.view.shown[name]));
        this.draw();
      };
    this.listenToMouse();
    listenToKeys(this.keys());
  }

  listenToMouse() {
    const { canvas } = this.view,
      { controls } = this.view.camera;
    let grabbed = null;
    // Pointer events precede the mouse and touch events that turn the camera.
    canvas.addEventListener("pointerdown", (e) => {
      if (grabbed || !this.view.isOverB(e.clientX, e.clientY)) return;
      grabbed = { id: e.pointerId, x: e.clientX, y: e.clientY, turns: this.turning };
      grabbed.turns ||= e.button === 2 || e.shiftKey;
      controls.enabled = false;
      try {
        canvas.setPointerCapture(e.pointerId);
      } catch {
        // The pointer has gone already.
      }
    });
    canvas.addEventListener("pointermove", (e) => {
      if (!grabbed) {
        if (e.buttons === 0) canvas.classList.toggle("over-b", this.view.isOverB(e.clientX, e.clientY));
        return;
      }
      if (e.pointerId !== grabbed.id) return;
      const x = e.clientX - grabbed.x,
        y = e.clientY - grabbed.y,
        perRadian = 0.35 * this.view.size.y;
      Object.assign(grabbed, { x: e.clientX, y: e.clientY });
      if (grabbed.turns) {
        this.turn(x / perRadian, y / perRadian, 0);
      } else {
        const pixel = this.view.pixelAtB();
        this.move(x * pixel, -y * pixel, 0);
      }
    });
    for (const type of ["pointerup", "pointercancel"])
      canvas.addEventListener(type, (e) => {
        if (!grabbed || e.pointerId !== grabbed.id) return;
        grabbed = null;
        setTimeout(() => (controls.enabled = true), 0); // after the mouse event of this pointer
      });
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  }

  keys() {
    const toggle = (id) => byId(id).click(),
      arrow = (...axis) => (turns) => {
        const step = Number(byId("step").value);
        if (turns) this.turn(step * axis[0], -step * axis[1], step * axis[2]);
        else this.move(...axis.map((x) => x * step * this.radius));
      };
    return {
      ArrowLeft: arrow(-1, 0, 0), ArrowRight: arrow(1, 0, 0), ArrowUp: arrow(0, 1, 0),
      ArrowDown: arrow(0, -1, 0), PageUp: arrow(0, 0, -1), PageDown: arrow(0, 0, 1),
      r: () => this.reset(),
      m: () => this.setMode(!this.turning),
      f: () => this.view.frameAll(),
      w: () => toggle("lids"),
      t: () => toggle("tested"),
      "[": () => this.goToStep(Number(byId("run-step").value) - 1),
      "]": () => this.goToStep(Number(byId("run-step").value) + 1),
      "+": () => this.view.camera.zoom(1.2),
      "-": () => this.view.camera.zoom(1 / 1.2),
      ",": () => this.changeStep(1),
      ".": () => this.changeStep(-1),
    };
  }

  changeStep(by) {
    const { length } = byId("step").options;
    byId("step").selectedIndex = Math.max(0, Math.min(length - 1, byId("step").selectedIndex + by));
  }
}

function fail(text) {
  byId("failed").textContent = text;
  byId("failed").hidden = false;
}

/** Returns bytes packed by live_page(). */
async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0)),
    stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function startLive() {
  const json = JSON.parse(byId("live-data").textContent),
    a = await inflated(json.files[0]),
    b = json.files[1] ? await inflated(json.files[1]) : a;
  return new LivePage(json, await Engine.open([a, b]));
}

export const live = startLive().catch((e) => {
  byId("relation").textContent = "not started";
  fail(`The engine did not start: ${e.message || e}. ` +
      "It needs a browser with WebAssembly SIMD (since 2021; Safari since 2023).");
});
