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
capture.begin(k.DISTANCE, a, [0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6], 0, [4, 5, 6, 0, 0, 1, 0, Infinity], k.RAY);
capture.node(0, 0, true);
capture.value(0.5, 0.75);
capture.end(k.INTERSECTING, 0);
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
gcc -std=c99 -I "$tree/trace/include" "$tree/tests/examples/record.c" -o record
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
