// ---- counters as colours: one number for each face, on a scale that both bodies share
const COUNTERS = ["tests", "hits", "misses"];

/** Returns tests, hits and misses of each body's faces in a step, up to an event: those that the page has. */
function countsSoFar(events, event) {
  const out = events.bodies.map((b) =>
    Object.fromEntries(COUNTERS.map((name) => [name, new Uint32Array(b.faceCount)])),
  );
  for (let i = events.firstOfStep[events.step(event)]; i <= event; i++) {
    if (events.kind[i] !== events.FACE_TEST) continue;
    for (const f of events.faces(i)) {
      out[f.side].tests[f.face]++;
      out[f.side][events.isHit(i) ? "hits" : "misses"][f.face]++;
    }
  }
  return out;
}

/** Gives each face the sum over the faces of its group, "region" or "level". A real face belongs to the region that covers
    it, a pseudo face to the one that it hides; a face without one keeps its own number. */
function sumsOfGroups(body, per, counts) {
  const groupOf = per === "region" ? (f) => body.regionOf(f) : (f) => body.depth(body.outer[f]),
    sums = new Map();
  const groups = Uint32Array.from(counts, (_, f) => groupOf(f));
  counts.forEach((n, f) => sums.set(groups[f], (sums.get(groups[f]) || 0) + n));
  return counts.map((n, f) => (groups[f] === NONE ? n : sums.get(groups[f])));
}
