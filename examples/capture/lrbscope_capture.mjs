// Records collision queries in JavaScript, in the format of lrbscope_capture.h, for `lrbscope tree` and `lrbscope
// import`. Example with three-mesh-bvh, whose shapecast() tests one tree against a shape:
//
//   const capture = new Capture("three-mesh-bvh 0.9");
//   const tree = addMeshBVH(capture, "cow", bvh);
//   const box = addShape(capture, "box", new THREE.BoxGeometry());        // for pictures
//   capture.begin(SHAPE, tree, null, box, null);
//   const met = bvh.shapecast(watched(capture, callbacks));
//   capture.end(met ? INTERSECTING : SEPARATE, met ? 1 : 0);
//   fs.writeFileSync("run.lrbcap", capture.close());          // or a Blob to download
//
// MIT licence, as lrbscope_capture.h. docs/capture.md describes calls and format.

export const ALL_PAIRS = 1, ANY = 2, DISTANCE = 3, FIRST_CONTACT = 4, SELF = 5, SHAPE = 6;
export const SEPARATE = 0, INTERSECTING = 1, UNREPORTED = 2;
export const AABB = 1, SPHERE = 2, OBB = 3, RSS = 4, KDOP = 5;
export const NO_AXIS = 255;

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];
const ticks = () => BigInt(Math.round(performance.now() * 1e6)); // nanoseconds
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
const u32 = (...numbers) => bytesOf(new Uint32Array(numbers));
const u64 = (...numbers) => bytesOf(new BigUint64Array(numbers.map(BigInt)));
const f64 = (numbers) => bytesOf(new Float64Array(numbers));
const wallClock = () => u64(BigInt(Math.round((performance.timeOrigin + performance.now()) * 1000)) * 1000n);
const utf8 = (text) => new TextEncoder().encode(text);

export class Capture {
  #parts = [];
  #counts = { mesh: 0, tree: 0, name: 0, query: 0 };
  #query = null; // { number, begin, events: [], count, last: [a, b] of each kind }

  constructor(engine) {
    this.#parts.push(utf8("LRBCAP\r\n"), u32(1, 0x01020304));
    this.#chunk("HEAD", utf8(engine));
    this.#chunk("SYNC", wallClock());
    for (const begin = performance.now(); performance.now() - begin < 1; ) {} // two readings give the length of a tick
    this.#chunk("SYNC", wallClock());
  }

  // Describe a mesh (3 numbers per vertex, 3 indices per triangle), a tree (members as of lrbcap_tree) and the name of
  // a counter or phase. Return its number.
  mesh(name, vertices, triangles) {
    const text = utf8(name), id = ++this.#counts.mesh;
    const head = u32(id, vertices.length / 3, triangles.length / 3, text.length);
    this.#chunk("MESH", head, text, f64(vertices), bytesOf(Uint32Array.from(triangles)));
    return id;
  }
  tree({ mesh, replaces = 0, volume, firstChild, child, firstPrim, prim, volumes, directions = [], ids = [] }) {
    const id = ++this.#counts.tree, nodes = firstChild.length - 1, list = (a) => bytesOf(Uint32Array.from(a));
    const floats = volumes instanceof Float32Array;
    const options = (ids.length ? 1 : 0) | (floats ? 2 : 0);
    this.#chunk("TREE", u32(id, mesh, replaces, nodes, volume, directions.length / 3, options, 0), list(ids),
      list(firstChild), list(child), list(firstPrim), list(prim), floats ? bytesOf(volumes) : f64(volumes),
      f64(directions));
    return id;
  }
  name(text) {
    this.#chunk("NAME", u32(++this.#counts.name), utf8(text));
    return this.#counts.name;
  }

  // Poses: 12 numbers, 3x4, row by row; null: the identity. Tree 0: a single shape.
  begin(kind, treeA, poseA, treeB, poseB) {
    const number = ++this.#counts.query;
    this.#chunk("QRYB", u64(0), u32(number, kind, treeA, treeB), u64(0), u32(1, 0), f64(poseA ?? IDENTITY),
      f64(poseB ?? IDENTITY));
    const last = Array.from({ length: 4 }, () => [0, 0]);
    this.#query = { number, events: [], count: 0, last, begin: ticks() };
    return number;
  }
  node(a, b, met, axis = NO_AXIS) { this.#event(0, a, b, met ? 1 : 0, axis); }
  prim(a, b, met) { this.#event(1, a, b, met ? 1 : 0, NO_AXIS); }
  count(name, value) { this.#event(2, name, value, 0, NO_AXIS); }
  phase(name) { this.#event(3, name, 0, 0, NO_AXIS); }
  end(verdict, pairs) {
    const q = this.#query, took = ticks() - q.begin;
    this.#query = null;
    if (q.count) this.#chunk("EVTS", u32(q.number, 1), u64(0), u32(q.count, 0), Uint8Array.from(q.events));
    this.#chunk("QRYE", u64(took), u32(q.number, verdict), u64(pairs, q.count, 0));
  }

  // Return the bytes since the last call: take() to write them while the program runs, close() at the end.
  take() {
    const out = new Uint8Array(this.#parts.reduce((size, part) => size + part.length, 0));
    let at = 0;
    for (const part of this.#parts) out.set(part, at), (at += part.length);
    this.#parts = [];
    return out;
  }
  close() {
    this.#chunk("STOP", wallClock());
    return this.take();
  }

  #chunk(letters, ...content) {
    const size = content.reduce((sum, part) => sum + part.length, 0);
    this.#parts.push(utf8(letters), u32(1), u64(size, ticks()), ...content);
  }
  #event(kind, a, b, met, axis) {
    const q = this.#query;
    if (!q) return;
    q.events.push(kind | (met << 2) | (axis === NO_AXIS ? 0 : 16));
    if (axis !== NO_AXIS) q.events.push(axis);
    [a, b].forEach((now, side) => {
      const d = (now - q.last[kind][side]) | 0;
      let z = ((d << 1) ^ (d >> 31)) >>> 0; // small for small steps up or down
      for (; z >= 128; z >>>= 7) q.events.push((z & 127) | 128);
      q.events.push(z);
      q.last[kind][side] = now;
    });
    ++q.count;
  }
}

// Describes the mesh of a BufferGeometry.
function addGeometry(capture, name, { attributes: { position }, index }) {
  const vertices = [];
  for (let i = 0; i < position.count; ++i) vertices.push(position.getX(i), position.getY(i), position.getZ(i));
  const triangles = index ? index.array : Array.from({ length: position.count }, (_, i) => i);
  return { mesh: capture.mesh(name, vertices, triangles), vertices, count: triangles.length / 3 };
}

// Describes a shape by a BufferGeometry, for pictures of queries of kind SHAPE. Returns the number of its tree.
export function addShape(capture, name, geometry) {
  const { mesh, vertices, count } = addGeometry(capture, name, geometry);
  const bounds = [0, 1, 2].map((k) => vertices.filter((_, i) => i % 3 === k));
  const volumes = [...bounds.map((x) => Math.min(...x)), ...bounds.map((x) => Math.max(...x))];
  return capture.tree({ mesh, volume: AABB, volumes, firstChild: [0, 0], child: [], firstPrim: [0, count],
    prim: Array.from({ length: count }, (_, i) => i) });
}

// Describes a MeshBVH of three-mesh-bvh and the mesh of its geometry. Returns the number of the tree.
export function addMeshBVH(capture, name, bvh) {
  const nodes = [], path = []; // path: the node of each depth
  bvh.traverse((depth, isLeaf, box, offset, count) => { // in the order of nodeIndex: parent, left, right
    const node = { box: Array.from(box), children: [], prims: [] };
    for (let i = 0; isLeaf && i < count; ++i) node.prims.push(bvh.resolveTriangleIndex(offset + i));
    if (depth > 0) path[depth - 1].children.push(nodes.length);
    path[depth] = node;
    nodes.push(node);
  });
  const offsets = (key) => nodes.reduce((out, node) => (out.push(out.at(-1) + node[key].length), out), [0]);
  return capture.tree({
    mesh: addGeometry(capture, name, bvh.geometry).mesh, volume: AABB,
    firstChild: offsets("children"), child: nodes.flatMap((node) => node.children),
    firstPrim: offsets("prims"), prim: nodes.flatMap((node) => node.prims),
    volumes: Float32Array.from(nodes.flatMap((node) => node.box)),
  });
}

// Returns callbacks of shapecast() that also record their tests.
export function watched(capture, { intersectsBounds, intersectsTriangle, ...others }) {
  return {
    ...others,
    intersectsBounds(box, isLeaf, score, depth, node) {
      const result = intersectsBounds(box, isLeaf, score, depth, node);
      capture.node(node, 0, result);
      return result;
    },
    intersectsTriangle(triangle, number, contained, depth) {
      const met = intersectsTriangle(triangle, number, contained, depth);
      capture.prim(number, 0, met);
      return met;
    },
  };
}
