// ---- a body: its LRB-rep as arrays, and what happened to its faces
const SIDES = ["A", "B"];

class Body {
  constructor(json, side, dim) {
    this.side = side;
    this.dim = dim; // 2: faces are segments
    this.name = json.name;
    this.faceCount = json.faces;
    this.realCount = json.realFaces;
    this.regionCount = json.regions;
    this.complete = Boolean(json.geometry); // false: too large for a page
    if (!this.complete) return;
    const g = json.geometry;
    this.vertices = unpack(g.vertices);
    this.corners = unpack(g.corners);
    this.inner = unpack(g.inner); // region behind each face; NONE: the solid
    this.outer = unpack(g.outer); // region in front of it; NONE: the outside
    this.parent = unpack(g.parent);
    this.layer = unpack(g.layer);
    this.countCorners(unpack(g.sizes));
    this.lidsOf = grouped(this.inner, this.regionCount);
    this.floorOf = grouped(this.outer, this.regionCount);
    this.boxes = {
      node: unpack(json.boxes.node),
      depth: unpack(json.boxes.depth),
      places: unpack(json.boxes.places),
      whole: json.boxes.whole, // down to this depth the page has all of them
      atDepth: unpack(json.boxes.atDepth), // how many there are
    };
    this.counts = Object.fromEntries(Object.entries(json.counts).map(([name, text]) => [name, unpack(text)]));
    this.counts.misses = this.counts.tests.map((n, f) => n - this.counts.hits[f]);
  }

  /** Numbers the triangles of all faces' fans (2D: segments), as LrbRep does. */
  countCorners(sizes) {
    this.offsets = new Uint32Array(sizes.length + 1);
    this.firstSimplex = new Uint32Array(sizes.length + 1);
    for (let f = 0; f < sizes.length; f++) {
      this.offsets[f + 1] = this.offsets[f] + sizes[f];
      this.firstSimplex[f + 1] = this.firstSimplex[f] + Math.max(1, sizes[f] - 2);
    }
  }

  isReal(face) {
    return face < this.realCount;
  }
  face(face) {
    return this.corners.subarray(this.offsets[face], this.offsets[face + 1]);
  }
  faceOfSimplex(simplex) {
    return lastAtMost(this.firstSimplex, simplex);
  }
  /** Returns the region that a face belongs to: the one that a pseudo face hides, or that covers a real
      face; NONE: none. */
  regionOf(face) {
    return this.isReal(face) ? this.outer[face] : this.inner[face];
  }
  lids(region) {
    return this.lidsOf.of(region);
  }
  floor(region) {
    return this.floorOf.of(region);
  }
  /** Returns the number of steps from the outside along parents. */
  depth(region) {
    let depth = 0;
    for (let r = region; r !== NONE; r = this.parent[r]) depth++;
    return depth;
  }
  faceWords(face) {
    return `${this.isReal(face) ? "face" : "pseudo face"} ${digits(face)}`;
  }
}

/** Returns the indices that have each value below `groups`. */
function grouped(values, groups) {
  const offsets = new Uint32Array(groups + 1);
  for (const v of values) if (v !== NONE) offsets[v + 1]++;
  for (let g = 0; g < groups; g++) offsets[g + 1] += offsets[g];
  const members = new Uint32Array(offsets[groups]),
    next = offsets.slice();
  values.forEach((v, i) => {
    if (v !== NONE) members[next[v]++] = i;
  });
  return { of: (g) => members.subarray(offsets[g], offsets[g + 1]) };
}
