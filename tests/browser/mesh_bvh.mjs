// Page of mesh_bvh.sh: queries of two MeshBVH with spheres, recorded by lrbscope_capture.mjs. Sends the
// capture after each query, and at the end what the page found by itself: the extremes of the trees, and the
// tests of each query with the boxes of the nodes.
import * as THREE from "three";
import { CONTAINED, MeshBVH, getBVHExtremes } from "three-mesh-bvh";
import { Capture, INTERSECTING, SEPARATE, SHAPE } from "/lrbscope_capture.mjs";

function post(path, body) {
  const request = new XMLHttpRequest();
  request.open("POST", path, false); // the page is loaded, and Chromium ends, after the last one
  request.send(body);
  if (request.status !== 200) throw Error(`${path}: ${request.responseText}`);
}

function record() {
  const capture = new Capture("three-mesh-bvh");
  const found = { trees: [], queries: [] };
  const knots = [false, true].map((indirect) => {
    const bvh = new MeshBVH(new THREE.TorusKnotGeometry(1, 0.3, 64, 8), { indirect });
    const [{ nodeCount, leafNodeCount, depth }] = getBVHExtremes(bvh);
    found.trees.push({ nodes: nodeCount, leaves: leafNodeCount, depth: depth.max });
    return { bvh, tree: capture.meshBVH(indirect ? "indirect" : "direct", bvh) };
  });
  const spheres = [
    [9, 1, true], [1, 0.5, true], [1, 0.5, false], [1.2, 2, false]
  ];  // x of the centre, radius, stops at the first triangle
  const balls = spheres.map(
      ([, radius]) => capture.meshBVH("ball", new MeshBVH(new THREE.SphereGeometry(radius, 16, 8))));
  for (const { bvh, tree } of knots)
    for (const [i, [x, radius, first]] of spheres.entries()) {
      const sphere = new THREE.Sphere(new THREE.Vector3(x, 0, 0), radius);
      const query = { nodes: [], triangles: [], boxes: [] };
      capture.begin(SHAPE, tree, null, balls[i], [1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0]);
      const met = bvh.shapecast({
        boundsTraverseOrder: first ? undefined : (box) => box.distanceToPoint(sphere.center),
        intersectsBounds(box, isLeaf, score, depth, node) {
          const furthest = box.getCenter(new THREE.Vector3()).sub(sphere.center),
                size = box.getSize(new THREE.Vector3());
          for (const k of "xyz") furthest[k] = Math.abs(furthest[k]) + size[k] / 2;
          const result = furthest.length() <= radius ? CONTAINED : sphere.intersectsBox(box);
          capture.node(node, 0, result);
          query.nodes.push([node, Boolean(result)]);
          query.boxes.push([...box.min, ...box.max]);
          return result;
        },
        intersectsTriangle(triangle, number) {
          const result = triangle.intersectsSphere(sphere);
          capture.prim(number, 0, result);
          query.triangles.push([number, result]);
          return result && first;
        },
      });
      const pairs = query.triangles.filter(([, result]) => result).length;
      capture.end(met || pairs ? INTERSECTING : SEPARATE, pairs);
      found.queries.push(query);
      post(`/capture?queries=${found.queries.length}`, capture.take());
    }
  post("/capture", capture.close());
  post("/found", JSON.stringify(found));
}

try {
  record();
} catch (error) {
  document.body.append(`FAIL ${error.stack}`);
}
