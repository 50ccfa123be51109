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

/** Gives each face the sum over the faces of its region: its lids and its floor. */
function sumsOfRegions(body, counts) {
  const sums = new Uint32Array(body.regionCount);
  for (let r = 0; r < body.regionCount; r++) {
    for (const f of body.lids(r)) sums[r] += counts[f];
    for (const f of body.floor(r)) sums[r] += counts[f];
  }
  return counts.map((n, f) => (body.regionOf(f) === NONE ? n : sums[body.regionOf(f)]));
}
