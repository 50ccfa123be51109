// Records collision queries in JavaScript, in the format of lrbscope_capture.h. With shapecast() of
// three-mesh-bvh:
//
//   const capture = new Capture("three-mesh-bvh 0.9"), cow = capture.meshBVH("cow", bvh);
//   const box = capture.meshBVH("box", new MeshBVH(new THREE.BoxGeometry())); // for pictures; tested as a
//   whole capture.begin(SHAPE, cow, null, box, null); const met = bvh.shapecast({
//     intersectsBounds(box, isLeaf, score, depth, node) { const is = ...; capture.node(node, 0, is); return
//     is; }, intersectsTriangle(triangle, number) { const is = ...; capture.prim(number, 0, is); return is;
//     },
//   });
//   capture.end(met ? INTERSECTING : SEPARATE, met ? 1 : 0);
//   fs.writeFileSync("run.lrbcap", capture.close()); // or a Blob to download
//
// MIT licence, as lrbscope_capture.h. docs/capture.md describes calls and format.

export const ALL_PAIRS = 1, ANY = 2, DISTANCE = 3, FIRST_CONTACT = 4, SELF = 5, SHAPE = 6;
export const SEPARATE = 0, INTERSECTING = 1, UNREPORTED = 2;
export const RAY = 1, POINT = 2, BOX = 3;

const AABB = 1, IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];
const utf8 = (text) => new TextEncoder().encode(text), f64 = (numbers) => Float64Array.from(numbers);
const u32 = (numbers) => Uint32Array.from(numbers), u64 = (numbers) => BigUint64Array.from(numbers, BigInt);
const sizeOf = (parts) => parts.reduce((size, part) => size + part.byteLength, 0);
const ticks = () => Math.round(performance.now() * 1e6); // nanoseconds
const wallClock = () => u64([Math.round((performance.timeOrigin + performance.now()) * 1e6)]);
const upTo = (n) => Array.from({ length: n }, (_, i) => i);
const positions = ({ attributes: { position: p } }) => // of a BufferGeometry, 3 numbers per vertex
  upTo(p.count).flatMap((i) => [p.getX(i), p.getY(i), p.getZ(i)]);
const corners = ({ attributes: { position }, index }) => index?.array ?? upTo(position.count);

export class Capture {
  #parts = [utf8("LRBCAP\r\n"), u32([1, 0x01020304])];
  #trees = 0;
  #queries = 0;
  #query = null;

  constructor(engine) {
    this.#chunk("HEAD", utf8(engine));
    this.#chunk("SYNC", wallClock());
    for (const begin = performance.now(); performance.now() - begin < 1;) {
    }  // two readings give the length of a tick
    this.#chunk("SYNC", wallClock());
  }

  // Describe a body; they return the number of its tree. nodes: the root first, each { box: least and
  // greatest x, y, z, children: indices of nodes, prims: triangles }.
  tree(name, vertices, triangles, nodes) {
    const id = ++this.#trees, text = utf8(name),
          sizes = [vertices.length / 3, triangles.length / 3, text.length];
    const ranges =
        (lists, end = 0) => [u32([0, ...lists.map((list) => (end += list.length))]), u32(lists.flat())];
    this.#chunk("MESH", u32([id, ...sizes]), text, f64(vertices), u32(triangles));
    this.#chunk(
        "TREE", u32([id, id, 0, nodes.length, AABB, 0, 0, 0]), ...ranges(nodes.map((node) => node.children)),
        ...ranges(nodes.map((node) => node.prims)), f64(nodes.flatMap((node) => Array.from(node.box))));
    return id;
  }
  meshBVH(name, bvh) {
    if (bvh._roots?.length > 1) throw Error(`${name}: a tree for each group; use a geometry without groups`);
    const nodes = [], path = []; // path: the node of each depth
    bvh.traverse((depth, isLeaf, box, offset, count) => { // in the order of nodeIndex: parent, left, right
      const prims = isLeaf ? upTo(count).map((i) => bvh.resolveTriangleIndex(offset + i)) : [];
      if (depth > 0) path[depth - 1].children.push(nodes.length);
      nodes.push((path[depth] = { box, children: [], prims }));
    });
    return this.tree(name, positions(bvh.geometry), corners(bvh.geometry), nodes);
  }

  // Record a query, its tests and its answer. Poses: 3x4 numbers, row by row; null: the identity. Tree 0: any
  // shape, or a probe, which is a RAY, POINT or BOX with the numbers of LRBCAP_RAY, _POINT or _BOX in place
  // of its pose.
  begin(kind, treeA, poseA, treeB, poseB, probe = 0) {
    const head = u32([0, 0, ++this.#queries, kind, treeA, treeB, 0, 0, 1, probe]);
    this.#chunk("QRYB", head, f64(poseA ?? IDENTITY), f64(upTo(12).map((i) => (poseB ?? IDENTITY)[i] ?? 0)));
    this.#query = { begin: ticks(), bytes: [], events: 0, last: [[0, 0], [0, 0]] };
  }
  node(a, b, met) { this.#event(0, a, b, met); }
  prim(a, b, met) { this.#event(1, a, b, met); }
  value(lower, upper) { this.#chunk("VALU", u64([this.#queries]), f64([lower, upper])); } // of a distance
  end(verdict, pairs) {
    const { begin, bytes, events } = this.#query, took = ticks() - begin;
    this.#query = null;
    if (events) this.#chunk("EVTS", u32([this.#queries, 1, 0, 0, events, 0]), Uint8Array.from(bytes));
    this.#chunk("QRYE", u64([took]), u32([this.#queries, verdict]), u64([pairs, events, 0]));
  }

  // Return the bytes since the last call: take() to write them while the program runs, close() at the end.
  take() {
    const out = new Uint8Array(sizeOf(this.#parts));
    let at = 0;
    for (const { buffer, byteOffset, byteLength } of this.#parts.splice(0)) {
      out.set(new Uint8Array(buffer, byteOffset, byteLength), at);
      at += byteLength;
    }
    return out;
  }
  close() {
    this.#chunk("STOP", wallClock());
    return this.take();
  }

  #chunk(letters, ...content) {
    const version = letters === "QRYB" && content[0][9] ? 2 : 1; // of a probe
    this.#parts.push(utf8(letters), u32([version]), u64([sizeOf(content), ticks()]), ...content);
  }
  #event(kind, a, b, met) {
    const q = this.#query, last = q.last[kind];
    q.bytes.push(kind | (met ? 4 : 0));
    for (const step of [a - last[0], b - last[1]]) {
      let z = ((step << 1) ^ (step >> 31)) >>> 0; // small for small steps up or down
      for (; z >= 128; z >>>= 7) q.bytes.push((z & 127) | 128);
      q.bytes.push(z);
    }
    q.last[kind] = [a, b];
    ++q.events;
  }
}
