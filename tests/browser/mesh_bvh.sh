#!/usr/bin/env bash
# mesh_bvh.sh LRBSCOPE: records shapecast() of three-mesh-bvh in headless Chromium with examples/capture/lrbscope_capture.mjs. `lrbscope live`
# follows the page while it runs. Trees and tests of the capture must be those that the page found by itself (mesh_bvh.mjs).
# Skipped (77) without Chromium, node, or three and three-mesh-bvh. LRB_NODE_MODULES: folder of npm's packages, if not the global one.
set -euo pipefail
lrbscope=$(realpath "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modules=${LRB_NODE_MODULES:-$(npm root -g 2>/dev/null || true)}
if ! command -v node >/dev/null || [ ! -d "$modules/three" ] || [ ! -f "$modules/three-mesh-bvh/build/index.module.js" ]; then
  echo "mesh_bvh.sh: skipped: needs node and npm's packages three and three-mesh-bvh, in the folder LRB_NODE_MODULES"
  exit 77
fi
source "$here/chromium.sh"

export -f browse
export browser work
ln -s "$modules" "$work/modules"
cp "$here/../../examples/capture/lrbscope_capture.mjs" "$here/mesh_bvh.mjs" "$work"
cat >"$work/index.html" <<'END'
<!DOCTYPE html><html><head><link rel="icon" href="data:,"><script type="importmap">
{ "imports": { "three": "/modules/three/build/three.module.js", "three-mesh-bvh": "/modules/three-mesh-bvh/build/index.module.js" } }
</script></head><body><script type="module" src="/mesh_bvh.mjs"></script></body></html>
END
code=0
"$lrbscope" live --exit -o "$work/run.lrbcap" -- node "$here/mesh_bvh_server.mjs" "$work" >"$work/said" 2>"$work/live.log" || code=$?
if [ $code != 0 ] || [ ! -f "$work/found.json" ]; then
  cat "$work/live.log" "$work/said" "$work/dom" >&2
  exit 1
fi
grep -q '^three-mesh-bvh: 8 queries: 8 not checked' "$work/said" || { echo "mesh_bvh.sh: live: $(cat "$work/said")" >&2 && exit 1; }
"$lrbscope" --quiet tree "$work/run.lrbcap" --json >"$work/trees.json" # exit code 1 for a fault
"$lrbscope" --quiet import "$work/run.lrbcap" -o "$work/import" --trace >/dev/null
cat >"$work/compare.mjs" <<'END'
import assert from "assert";
import fs from "fs";
import zlib from "zlib";
const read = (file) => JSON.parse(fs.readFileSync(file, "utf8")), found = read("found.json"), trees = read("trees.json").trees;
found.trees.forEach(({ nodes, leaves, depth }, i) =>
  assert.deepEqual([trees[i].triangles, trees[i].nodes, trees[i].leaves, trees[i].depth], [1024, nodes, leaves, depth]));
let tests = 0;
found.queries.forEach((query, i) => {
  const trace = zlib.gunzipSync(fs.readFileSync(`import/pair_${i + 1}/trace.json.gz`));
  const events = JSON.parse(trace).traceEvents, boxes = read(`import/pair_${i + 1}/trees.json`).trees[0].boxes;
  const named = (name) => events.filter((e) => e.name === name).map((e) => e.args);
  const nodes = named("node pair").map((e) => [e["node of A"], e["boxes that meet"] > 0]);
  assert.deepEqual(nodes, query.nodes, `nodes of query ${i + 1}`);
  assert.deepEqual(named("face test").map((e) => [e["simplex of A"], e.meet === "cross"]), query.triangles, `triangles of query ${i + 1}`);
  nodes.forEach(([node], n) => {
    const [x, y, z, u, , , , v, , , , w] = boxes[node], box = [x - u, y - v, z - w, x + u, y + v, z + w];
    box.forEach((number, k) => assert(Math.abs(number - query.boxes[n][k]) < 1e-12, `box of node ${node}: ${box}, found ${query.boxes[n]}`));
  });
  tests += nodes.length + query.triangles.length;
});
console.log(`mesh_bvh: ${found.queries.length} queries of ${found.trees.length} trees: ${tests} equal tests`);
END
(cd "$work" && node compare.mjs)
