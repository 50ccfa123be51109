#!/usr/bin/env bash
# capture_js.sh TREE LRBSCOPE: the same recording by lrbscope_capture.h and by examples/capture/lrbscope_capture.mjs has the same bytes, but for
# times. A program that writes it piece by piece is followed by `lrbscope live`. The tree of a bounding volume hierarchy with the interface of three-mesh-bvh is among them. Skipped (77) without node or gcc.
set -euo pipefail
tree=$(cd "$1" && pwd)
for program in node gcc; do command -v $program >/dev/null || { echo "skipped: needs $program" && exit 77; }; done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >record.c <<'END'
#define LRBCAP_ENABLE
#define LRBCAP_IMPLEMENTATION
#include <lrbscope_capture.h>
int main(void) {
  const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.1, 0.2, 1}, turned[] = {0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6};
  const uint32_t corners[] = {0, 2, 1, 0, 1, 3}, first_child[] = {0, 2, 2, 2}, child[] = {1, 2};
  const uint32_t first_prim[] = {0, 0, 1, 2}, prim[] = {1, 0}, ids[] = {7, 300, 5};
  const float boxes[] = {0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 0.5f, 0, 0.25f, 0, 1, 1, 1};
  const double kdops[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, directions[] = {1, 0, 0, 0, 1, 1};
  lrbcap_tree shape = {0};
  uint32_t a, b, name;
  LRBCAP_OPEN("engine \xc3\xa9", "c.lrbcap");
  shape.mesh = LRBCAP_MESH("kn\xc3\xb6t", 4, xyz, 2, corners);
  shape.nodes = 3, shape.volume = LRBCAP_AABB, shape.float_volumes = boxes;
  shape.first_child = first_child, shape.child = child, shape.first_prim = first_prim, shape.prim = prim;
  a = LRBCAP_TREE(&shape);
  shape.replaces = a, shape.ids = ids, shape.volume = LRBCAP_KDOP, shape.volumes = kdops;
  shape.directions = 2, shape.direction = directions;
  b = LRBCAP_TREE(&shape);
  name = LRBCAP_NAME("counter");
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a, turned, b, NULL);
  LRBCAP_PHASE(name);
  LRBCAP_NODE(0, 7, 1, LRBCAP_NO_AXIS);
  LRBCAP_NODE(2, 300, 0, 14);
  LRBCAP_NODE(1, 5, 1, LRBCAP_NO_AXIS);
  LRBCAP_PRIM(1, 0, 1);
  LRBCAP_COUNT(name, 4000000000u);
  LRBCAP_COUNT(name, 1);
  LRBCAP_END(LRBCAP_INTERSECTING, 1);
  LRBCAP_BEGIN(LRBCAP_SHAPE, a, NULL, a, NULL);
  LRBCAP_NODE(1, 0, 0, LRBCAP_NO_AXIS);
  LRBCAP_NODE(2, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_PRIM(0, 0, 0);
  LRBCAP_END(LRBCAP_SEPARATE, 0);
  LRBCAP_CLOSE();
  return 0;
}
END
cat >record.mjs <<'END'
import fs from "fs";
const { Capture, addMeshBVH, watched, ...k } = await import(process.argv[2]);
// A hierarchy with the interface of three-mesh-bvh. Its shapecast() visits node 1, which is apart, and leaf 2.
const xyz = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0.1, 0.2, 1];
const bvh = {
  geometry: {
    attributes: { position: { count: 4, getX: (i) => xyz[3 * i], getY: (i) => xyz[3 * i + 1], getZ: (i) => xyz[3 * i + 2] } },
    index: { array: Uint16Array.from([0, 2, 1, 0, 1, 3]) },
  },
  resolveTriangleIndex: (i) => 1 - i,
  traverse(visit) {
    visit(0, false, Float32Array.from([0, 0, 0, 1, 1, 1]), 2);
    visit(1, true, Float32Array.from([0, 0, 0, 1, 1, 0.5]), 0, 1);
    visit(1, true, Float32Array.from([0, 0.25, 0, 1, 1, 1]), 1, 1);
  },
  shapecast(c) {
    c.intersectsBounds({}, true, undefined, 1, 1);
    return c.intersectsBounds({}, true, undefined, 1, 2) && c.intersectsTriangle({}, 0, false, 1);
  },
};
const capture = new Capture("engine é");
const a = addMeshBVH(capture, "knöt", bvh);
const b = capture.tree({
  mesh: 1, replaces: a, ids: [7, 300, 5], volume: k.KDOP, volumes: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12],
  firstChild: [0, 2, 2, 2], child: [1, 2], firstPrim: [0, 0, 1, 2], prim: [1, 0], directions: [1, 0, 0, 0, 1, 1],
});
const name = capture.name("counter");
capture.begin(k.ALL_PAIRS, a, [0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6], b, null);
capture.phase(name);
capture.node(0, 7, true);
capture.node(2, 300, false, 14);
capture.node(1, 5, true);
capture.prim(1, 0, true);
capture.count(name, 4000000000);
capture.count(name, 1);
capture.end(k.INTERSECTING, 1);
capture.begin(k.SHAPE, a, null, a, null);
const met = bvh.shapecast(watched(capture, { intersectsBounds: (box, leaf, score, depth, node) => node === 2, intersectsTriangle: () => false }));
capture.end(met ? k.INTERSECTING : k.SEPARATE, 0);
fs.writeFileSync("js.lrbcap", capture.close());

// Without times: those of chunks, the wall clock, and how long queries took.
function timeless(file) {
  const bytes = fs.readFileSync(file);
  for (let at = 16; at < bytes.length;) {
    const kind = bytes.toString("latin1", at, at + 4), size = Number(bytes.readBigUInt64LE(at + 8));
    bytes.fill(0, at + 16, at + (["SYNC", "STOP", "QRYE"].includes(kind) ? 32 : 24));
    at += 24 + size;
  }
  return bytes;
}
const [c, js] = [timeless("c.lrbcap"), timeless("js.lrbcap")];
const at = c.findIndex((byte, i) => byte !== js[i]);
if (at >= 0 || c.length !== js.length) {
  console.log(`capture_js: ${c.length} bytes of C, ${js.length} of JavaScript; the first difference is at ${at}`);
  process.exit(1);
}
console.log(`capture_js: ${c.length} equal bytes`);
END
gcc -std=c99 -I "$tree/trace/include" record.c -o record
env -u LRBCAP_EVENTS -u LRBCAP_QUERIES -u LRBCAP_SLOWER_US -u LRBCAP_MAX_MB ./record
node record.mjs "$tree/examples/capture/lrbscope_capture.mjs"

cat >pieces.mjs <<'END'
import fs from "fs";
const { Capture, ALL_PAIRS, ANY, INTERSECTING, SEPARATE, AABB } = await import(process.argv[2]);
const file = fs.openSync(process.env.LRBCAP_OUT, "w"), capture = new Capture("pieces");
const mesh = capture.mesh("a", [0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2]);
const tree = capture.tree({ mesh, volume: AABB, firstChild: [0, 0], child: [], firstPrim: [0, 1], prim: [0], volumes: Float32Array.from([0, 0, 0, 1, 1, 0]) });
for (let i = 0; i < 3; ++i) {
  capture.begin(ALL_PAIRS, tree, null, tree, [1, 0, 0, i, 0, 1, 0, 0, 0, 0, 1, 0]);
  capture.node(0, 0, i < 2);
  if (i < 2) capture.prim(0, 0, true);
  capture.end(i < 2 ? INTERSECTING : SEPARATE, i < 2 ? 1 : 0);
  fs.writeSync(file, capture.take());
}
capture.begin(ANY, tree, null, 0, null); // with a shape: listed, but not checked
capture.node(0, 0, false);
capture.end(SEPARATE, 0);
fs.writeSync(file, capture.close());
END
"$2" --quiet live --exit -- node pieces.mjs "$tree/examples/capture/lrbscope_capture.mjs" >said
grep -q '^pieces: 4 queries: 3 right, 1 not checked' said || { echo "capture_js: live: $(cat said)" && exit 1; }
