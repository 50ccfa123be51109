import { byId, digits, linkRow, listenToKeys, percent, plural, rounded, textButton } from "./dom.js";
import { mixed } from "./scene_colours.js";
import { boxEdges, WHITE } from "./scene_lines.js";
import { Body, grouped, NONE, unpack } from "./scene_run.js";
import { BodiesCanvas, onClick, webglWorks } from "./scene_view.js";

// ---- the page of a tree: volume and triangles of a node, selected in the view, the icicle or a table

/** The nodes of a tree. A node is an index into these arrays, unless it is called an id: the engine's own
    number. */
class TreeNodes {
  constructor(json) {
    this.ids = json.id;
    this.all = json.all; // false: only the nodes nearest to the root and the worst ones are here
    for (const name of ["parent", "depth", "first", "last", "area", "epo"]) this[name] = unpack(json[name]);
    this.indexOf = new Map(this.ids.map((id, node) => [String(id), node]));
    this.childrenOf = grouped(this.parent, this.ids.length);
  }

  children(node) {
    return this.childrenOf.of(node);
  }

  /** Returns the deepest node with a face, or -1: the face is in no leaf. */
  leafOf(face) {
    const has = (node) => this.first[node] <= face && face < this.last[node];
    let node = has(0) ? 0 : -1;
    for (let next = node; next >= 0; ) {
      node = next;
      const inside = [...this.children(node)].find(has);
      next = inside === undefined ? -1 : inside;
    }
    return node;
  }
}

/** Returns true if a part of a face lies in a box, `at`: its centre and three half axes: if no axis of their
    faces and edges separates them. */
function reachesInto(body, face, at) {
  const most = 1 - 1e-5, // of the box: faces that touch it do not count, and positions are floats
    part = (array, first) => new THREE.Vector3(...array.subarray(first, first + 3)),
    corners = [...body.face(face)].map((v) => part(body.vertices, 3 * v).sub(part(at, 0))),
    half = [3, 6, 9].map((first) => part(at, first)),
    isApart = (axis) => {
      const reach = most * half.reduce((sum, h) => sum + Math.abs(h.dot(axis)), 0),
        along = corners.map((p) => p.dot(axis));
      return Math.min(...along) > reach || Math.max(...along) < -reach;
    };
  if (half.some(isApart)) return false;
  const edges = corners.map((p, i) => corners[(i + 1) % corners.length].clone().sub(p)),
    crosses = [edges[1], ...half, new THREE.Vector3(0, 0, 1)]; // the last: for segments
  return !crosses.some((way, i) =>
      (i ? edges : edges.slice(0, 1)).some((edge) => isApart(edge.clone().cross(way))));
}

class TreeView extends BodiesCanvas {
  constructor(json, body) {
    super(json, [body]);
    this.node = 0;
    this.views[0].paint({ of: () => this.colours.bodies[0] }, 0);
    this.views[0].lookInside(true, false);
    this.start();
  }

  /** Shows a node. `kinds`: by face, 2 if it is below the node, 1 if it is another one in its volume, else 0.
      `others`: the nodes whose volumes are shown, too. */
  show(node, kinds, others, alone) {
    this.node = node;
    const { colours } = this, [view] = this.views,
      shades = [mixed(colours.bodies[0], WHITE, colours.shares.ground), colours.bodies[1], colours.bodies[0]];
    view.paint({ of: (_, face) => shades[kinds[face]] }, 0);
    view.real.show((face) => !alone || kinds[face] > 0);
    view.edges.visible = !alone;
    this.marks.setBoxes("node", String(node), [{ side: 0, number: node }], colours.selected);
    this.marks.setBoxes("others", others.join(), others.map((number) => ({ side: 0, number })), colours.ink);
    this.redraw();
  }

  /** Returns the corners of the volume of the selected node. */
  corners() {
    const ends = boxEdges(this.bodies[0].boxes.places, [this.node]);
    return Array.from({ length: ends.length / 3 },
        (_, i) => new THREE.Vector3(...ends.slice(3 * i, 3 * i + 3)));
  }

  extremes() {
    return [...super.extremes(), ...this.corners()];
  }

  frameNode() {
    this.camera.fit(this.corners());
    this.camera.fitted = false; // a resized window keeps it
    this.redraw();
  }
}

/** Returns the id of the node that the address names, as "5 of instance 2"; null: none. */
const requested = () => new URLSearchParams(location.hash.slice(1)).get("node");

class TreePage {
  constructor(json) {
    this.json = json;
    this.nodes = new TreeNodes(json.nodes);
    this.body = new Body(json.body, 0, json.dim);
    this.body.boxes.node = Array.from(this.nodes.ids, (_, node) => node);
    this.faces = unpack(json.faces); // their numbers in the mesh
    this.look = { alone: false, children: false };
    this.view = webglWorks() ? new TreeView(json, this.body) : null;
    if (!this.view) {
      document.body.classList.add("without-view");
      byId("no-view").textContent = "This browser has no WebGL, so the body is not drawn.";
      byId("no-view").hidden = false;
    }
    this.connect();
    this.select(this.nodes.indexOf.get(requested()) ?? this.first());
    if (this.view) this.view.frameAll(this.telling());
  }

  /** Returns the node that the page opens with: the first one of a table, or the root. */
  first() {
    const row = document.querySelector("tr[data-to^=node]"),
      node = row && this.nodes.indexOf.get(row.dataset.to.slice(5));
    return node === undefined || node === null ? 0 : node;
  }

  /** Returns a direction in which the triangles below the node are seen. */
  telling() {
    const { view, kinds } = this, [body] = view.views, own = body.realFaces.filter((f) => kinds[f] === 2),
      out = body.outward(own).normalize();
    return view.camera.plane ? view.camera.from
        : out.multiplyScalar(2).add(new THREE.Vector3(...view.camera.from).normalize()).toArray();
  }

  select(node) {
    const { nodes } = this;
    this.node = node;
    const [from, to] = [nodes.first[node], nodes.last[node]],
      at = this.body.boxes.places.subarray(12 * node, 12 * node + 12);
    this.kinds = new Uint8Array(this.faces.length);
    this.others = 0;
    for (let face = 0; face < this.kinds.length; face++) {
      const own = from <= face && face < to;
      this.kinds[face] = own ? 2 : reachesInto(this.body, face, at) ? 1 : 0;
      this.others += this.kinds[face] === 1;
    }
    this.write();
    this.draw();
    history.replaceState(null, "", `#node=${nodes.ids[node]}`);
  }

  selectId(id) {
    const node = this.nodes.indexOf.get(String(id).trim()), known = node !== undefined;
    byId("node-state").textContent = known ? "" : this.nodes.all ? "no such node below the root"
        : "not on this page, which has the nodes nearest to the root";
    if (known) this.select(node);
  }

  draw() {
    if (!this.view) return;
    const { alone, children } = this.look;
    this.view.show(this.node, this.kinds, children ? [...this.nodes.children(this.node)] : [], alone);
  }

  write() {
    const { nodes, node, json, view } = this,
      put = (id, text) => (byId(id).textContent = text),
      triangles = nodes.last[node] - nodes.first[node],
      faces = (n) => (json.dim === 2 ? plural(n, "segment") : plural(n, "triangle")),
      share = json.epo > 0 ? ` (${percent(nodes.epo[node], json.epo)} of the tree's)` : "";
    byId("node").value = nodes.ids[node];
    put("node-state", "");
    put("node-depth", digits(nodes.depth[node]));
    put("node-triangles", faces(triangles));
    put("node-others", faces(this.others));
    put("node-area", rounded(nodes.area[node], 3));
    put("node-epo", rounded(nodes.epo[node], 3) + share);
    const link = (other, text) => {
      const title = `Depth ${nodes.depth[other]}, ${faces(nodes.last[other] - nodes.first[other])}`;
      return textButton(text, () => this.select(other), title);
    };
    const parent = nodes.parent[node], children = [...nodes.children(node)], most = 12;
    byId("node-near").replaceChildren(
      ...(parent === NONE ? [] : [link(parent, `↑ ${nodes.ids[parent]}`)]),
      ...children.slice(0, most).map((child) => link(child, `↓ ${nodes.ids[child]}`)),
      ...(children.length > most ? [`and ${children.length - most} more`] : []),
    );
    for (const marked of document.querySelectorAll("[data-node], tr[data-to^=node]")) {
      const id = marked.dataset.node || marked.dataset.to.slice(5);
      if (id === String(nodes.ids[node])) marked.setAttribute("aria-current", "true");
      else marked.removeAttribute("aria-current");
    }
    if (!view) return;
    const volume = ["AABB", "OBB"].includes(json.volume) ? json.volume : `box around the ${json.volume}`;
    view.legend.also(
      [
        [view.colours.bodies[0], "below the node"],
        [view.colours.bodies[1], `of other nodes, in its ${volume}`],
        [view.colours.selected, volume],
        ...(this.look.children ? [[view.colours.ink, "of its children"]] : []),
      ],
      "node",
    );
  }

  /** Goes to the parent, the first child, or a sibling. */
  go(way) {
    const { nodes, node } = this, parent = nodes.parent[node],
      siblings = parent === NONE ? [node] : [...nodes.children(parent)],
      at = siblings.indexOf(node);
    const next = {
      Up: parent === NONE ? undefined : parent, Down: nodes.children(node)[0],
      Left: siblings[at - 1], Right: siblings[at + 1],
    }[way];
    if (next !== undefined) this.select(next);
  }

  toggle(name) {
    this.look[name] = !this.look[name];
    byId(name).setAttribute("aria-pressed", String(this.look[name]));
    this.write();
    this.draw();
  }

  connect() {
    const follow = (id) => () => {
      this.selectId(id);
      byId("stage").scrollIntoView({ block: "nearest" });
    };
    for (const box of document.querySelectorAll("[data-node]"))
      box.addEventListener("click", follow(box.dataset.node));
    for (const row of document.querySelectorAll("tr[data-to^=node]"))
      linkRow(row, follow(row.dataset.to.slice(5)));
    byId("node").onchange = () => this.selectId(byId("node").value);
    window.addEventListener("hashchange", () => this.selectId(requested()));
    if (!this.view) return;
    byId("fit-body").onclick = () => this.view.frameAll();
    byId("fit-node").onclick = () => this.view.frameNode();
    for (const name of ["alone", "children"]) byId(name).onclick = () => this.toggle(name);
    byId("orthographic").onclick = () => {
      this.view.camera.setOrthographic(!this.view.camera.orthographic);
      byId("orthographic").setAttribute("aria-pressed", String(this.view.camera.orthographic));
    };
    const press = (id) => () => byId(id).click();
    listenToKeys({
      ArrowUp: () => this.go("Up"), ArrowDown: () => this.go("Down"),
      ArrowLeft: () => this.go("Left"), ArrowRight: () => this.go("Right"),
      f: (shift) => press(shift ? "fit-body" : "fit-node")(),
      i: press("alone"), c: press("children"), o: press("orthographic"),
    });
    onClick(this.view.canvas, (e) => {
      const hit = this.view.nearest(e.clientX, e.clientY, [this.view.views[0].real]),
        leaf = hit ? this.nodes.leafOf(hit.face) : -1;
      if (leaf >= 0) this.select(leaf);
      else if (hit) byId("node-state").textContent = `triangle ${digits(this.faces[hit.face])} is in no leaf`;
    });
  }
}

export const treePage = new TreePage(JSON.parse(byId("scene-data").textContent));
