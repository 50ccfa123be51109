#!/usr/bin/env bash
# capture_js.sh TREE LRBSCOPE: the same recording by lrbscope_capture.h and by examples/capture/lrbscope_capture.mjs has the same bytes, but for
# times. A program that writes it piece by piece is followed by `lrbscope live`. Skipped (77) without node or gcc. browser/mesh_bvh.sh records the
# real three-mesh-bvh.
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
  const uint32_t first_prim[] = {0, 0, 1, 2}, prim[] = {1, 0}, none[] = {0, 0}, all[] = {0, 2}, both[] = {0, 1};
  const double boxes[] = {0, 0, 0, 1, 1, 1, 0, 0, 0, 1, 1, 0.5, 0, 0.25, 0, 1, 1, 1};
  lrbcap_tree t = {0};
  uint32_t a, b;
  LRBCAP_OPEN("engine \xc3\xa9", "c.lrbcap");
  t.mesh = LRBCAP_MESH("kn\xc3\xb6t", 4, xyz, 2, corners);
  t.nodes = 3, t.volume = LRBCAP_AABB, t.volumes = boxes;
  t.first_child = first_child, t.child = child, t.first_prim = first_prim, t.prim = prim;
  a = LRBCAP_TREE(&t);
  t.mesh = LRBCAP_MESH("shape", 4, xyz, 2, corners);
  t.nodes = 1, t.first_child = none, t.child = none, t.first_prim = all, t.prim = both;
  b = LRBCAP_TREE(&t);
  LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, a, turned, b, NULL);
  LRBCAP_NODE(0, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_NODE(2, 0, 0, LRBCAP_NO_AXIS);
  LRBCAP_NODE(1, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_PRIM(1, 0, 1);
  LRBCAP_END(LRBCAP_INTERSECTING, 1);
  LRBCAP_BEGIN(LRBCAP_SHAPE, a, NULL, 0, NULL);
  LRBCAP_NODE(4000000000u, 300, 0, LRBCAP_NO_AXIS);
  LRBCAP_NODE(1, 0, 1, LRBCAP_NO_AXIS);
  LRBCAP_END(LRBCAP_SEPARATE, 0);
  LRBCAP_CLOSE();
  return 0;
}
END
cat >record.mjs <<'END'
import fs from "fs";
const { Capture, ...k } = await import(process.argv[2]);
const xyz = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0.1, 0.2, 1], corners = Uint16Array.from([0, 2, 1, 0, 1, 3]);
const capture = new Capture("engine é");
const a = capture.tree("knöt", xyz, corners, [
  { box: [0, 0, 0, 1, 1, 1], children: [1, 2], prims: [] },
  { box: Float32Array.from([0, 0, 0, 1, 1, 0.5]), children: [], prims: [1] },
  { box: [0, 0.25, 0, 1, 1, 1], children: [], prims: [0] },
]);
const b = capture.tree("shape", Float64Array.from(xyz), corners, [{ box: [0, 0, 0, 1, 1, 1], children: [], prims: [0, 1] }]);
capture.begin(k.ALL_PAIRS, a, [0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6], b, null);
capture.node(0, 0, true);
capture.node(2, 0, false);
capture.node(1, 0, true);
capture.prim(1, 0, true);
capture.end(k.INTERSECTING, 1);
capture.begin(k.SHAPE, a, null, 0, null);
capture.node(4000000000, 300, false);
capture.node(1, 0, true);
capture.end(k.SEPARATE, 0);
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
const { Capture, ALL_PAIRS, ANY, INTERSECTING, SEPARATE } = await import(process.argv[2]);
const file = fs.openSync(process.env.LRBCAP_OUT, "w"), capture = new Capture("pieces");
const tree = capture.tree("a", [0, 0, 0, 1, 0, 0, 0, 1, 0], [0, 1, 2], [{ box: [0, 0, 0, 1, 1, 0], children: [], prims: [0] }]);
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
