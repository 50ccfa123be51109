import { NONE } from "./scene_run.js";

// ---- triangles and lines of faces, for three.js
/** Faces of a body as a mesh with a colour per face, any subset of which can be shown. `shifts`, if given,
    translates each face. */
export class FaceMesh {
  constructor(body, faces, material, shifts) {
    this.body = body;
    this.flat = body.dim === 2 ? { faces, shifts, width: 0 } : null;
    this.triangles = this.flat ? 2 * faces.length
      : faces.reduce((n, f) => n + Math.max(0, body.offsets[f + 1] - body.offsets[f] - 2), 0);
    this.faceOf = new Uint32Array(this.triangles); // of each triangle
    const positions = new Float32Array(9 * this.triangles), normals = new Float32Array(9 * this.triangles);
    if (this.flat) faces.forEach((face, k) => this.faceOf.fill(face, 2 * k, 2 * k + 2));
    else this.placeAll(faces, shifts, positions, normals);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(9 * this.triangles), 3, true));
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.userData.faces = this;
  }

  /** Writes the corners and normals of all triangles, without arrays for each: there may be 300,000. */
  placeAll(faces, shifts, positions, normals) {
    const { body } = this, { vertices: v, offsets } = body;
    let at = 0;
    for (let k = 0; k < faces.length; k++) {
      const face = faces[k], count = offsets[face + 1] - offsets[face] - 2, shift = shifts?.[k] || [0, 0, 0];
      for (let i = 0; i < count; i++, at += 9) {
        this.faceOf[at / 9] = face;
        for (let c = 0; c < 9; c++)
          positions[at + c] = v[3 * body.cornerOf(face, i, (c / 3) | 0) + (c % 3)] + shift[c % 3];
        const along = (c) => positions[at + c] - positions[at + (c % 3)],
          normal = (i, j) => along(3 + i) * along(6 + j) - along(3 + j) * along(6 + i),
          [x, y, z] = [normal(1, 2), normal(2, 0), normal(0, 1)], length = Math.hypot(x, y, z) || 1;
        for (let c = 0; c < 9; c++) normals[at + c] = (c % 3 === 0 ? x : c % 3 === 1 ? y : z) / length;
      }
    }
  }

  /** Widens the segments of a 2D body to strips of a width. */
  widen(width) {
    if (!this.flat || Math.abs(this.flat.width - width) < 0.1 * width) return;
    this.flat.width = width;
    const { position, normal } = this.mesh.geometry.attributes, v = this.body.vertices;
    this.flat.faces.forEach((face, k) => {
      const [p, q] = this.body.face(face), shift = this.flat.shifts ? this.flat.shifts[k] : [0, 0, 0],
        at = (c) => [v[3 * c] + shift[0], v[3 * c + 1] + shift[1]],
        [a, b] = [at(p), at(q)],
        length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1,
        along = [((b[0] - a[0]) / length) * (width / 2), ((b[1] - a[1]) / length) * (width / 2)],
        // Slightly longer than the segment, so that strips join at corners.
        corner = (end, s, t) =>
            [end[0] + 0.7 * s * along[0] - t * along[1], end[1] + 0.7 * s * along[1] + t * along[0], 0];
      const [w, x, y, z] = [corner(a, -1, -1), corner(b, 1, -1), corner(b, 1, 1), corner(a, -1, 1)];
      position.array.set([w, x, y, w, y, z].flat(), 18 * k);
      for (let i = 0; i < 6; i++) normal.array.set([0, 0, 1], 18 * k + 3 * i);
    });
    position.needsUpdate = normal.needsUpdate = true;
    this.mesh.geometry.computeBoundingSphere();
  }

  paint(colourOf) {
    const { color } = this.mesh.geometry.attributes, { array } = color;
    let face = NONE, bytes = null;
    for (let t = 0, k = 0; t < this.triangles; t++) {
      if (this.faceOf[t] !== face) bytes = colourOf((face = this.faceOf[t])).map((c) => Math.round(255 * c));
      for (const end = k + 9; k < end; k++) array[k] = bytes[k % 3];
    }
    color.needsUpdate = true;
    this.version = ++FaceMesh.versions;
  }

  /** Shows only the faces that pass. */
  show(passes) {
    const geometry = this.mesh.geometry;
    if (!geometry.index) geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(3 * this.triangles), 1));
    let n = 0;
    for (let t = 0; t < this.triangles; t++)
      if (passes(this.faceOf[t])) for (let c = 0; c < 3; c++) geometry.index.array[n++] = 3 * t + c;
    geometry.index.needsUpdate = true;
    geometry.setDrawRange(0, n);
    this.version = ++FaceMesh.versions;
  }

  /** Returns the face and the simplex that a ray hits. */
  at(hit) {
    const triangle = (hit.face.a / 3) | 0, face = this.faceOf[triangle];
    if (this.flat) return { face, simplex: this.body.firstSimplex[face] };
    let first = triangle;
    while (first > 0 && this.faceOf[first - 1] === face) first--;
    return { face, simplex: this.body.firstSimplex[face] + triangle - first };
  }
  dispose() {
    this.mesh.geometry.dispose();
  }
}
FaceMesh.versions = 0; // of all: each change of what one shows has its own

// ---- glass: the lids of both bodies as one mesh, drawn from back to front also where the bodies overlap
export class Glass {
  constructor(material) {
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.renderOrder = 1;
    this.mesh.frustumCulled = false;
  }

  /** `panes`: FaceMeshes in the world. `ahead`: the direction of the view. */
  show(panes, ahead) {
    const ways = ahead.toArray().map((x) => x.toFixed(1)),
      key = [ways, ...panes.map((p) => [p.version, ...p.mesh.matrixWorld.elements])].join();
    if (key === this.key) return;
    this.key = key;
    const parts = panes.map(({ mesh }) => {
        const { index, attributes, drawRange } = mesh.geometry, { position, normal, color } = attributes;
        return { e: mesh.matrixWorld.elements, corners: index.array, count: drawRange.count / 3,
          turn: new THREE.Matrix3().getNormalMatrix(mesh.matrixWorld).elements, // poses may scale and shear
          p: position.array, n: normal.array, c: color.array };
      }),
      count = parts.reduce((n, part) => n + part.count, 0), depths = new Float32Array(count),
      of = new Uint8Array(count), first = new Uint32Array(count), { geometry } = this.mesh;
    let t = 0, least = Infinity, most = -Infinity;
    parts.forEach(({ e, corners, count: own, p }, k) => {
      const [x, y, z, w] = [0, 4, 8, 12].map((c) => e[c] * ahead.x + e[c + 1] * ahead.y + e[c + 2] * ahead.z);
      for (let i = 0; i < own; i++, t++) {
        const at = 3 * corners[3 * i];
        first[t] = at;
        of[t] = k;
        depths[t] = x * (p[at] + p[at + 3] + p[at + 6]) + y * (p[at + 1] + p[at + 4] + p[at + 7])
          + z * (p[at + 2] + p[at + 5] + p[at + 8]) + 3 * w;
        least = Math.min(least, depths[t]);
        most = Math.max(most, depths[t]);
      }
    });
    // Sorted by counting, the farthest first.
    const steps = 65535, scale = steps / (most - least || 1), next = new Uint32Array(steps + 2),
      place = (d) => Math.trunc((most - d) * scale);
    for (const d of depths) next[place(d) + 1]++;
    for (let i = 0; i <= steps; i++) next[i + 1] += next[i];
    const position = new Float32Array(9 * count), normal = new Float32Array(9 * count),
      color = new Uint8Array(9 * count);
    for (t = 0; t < count; t++) {
      const { e, turn, p, n, c } = parts[of[t]], to = 9 * next[place(depths[t])]++;
      for (let k = 0; k < 9; k += 3) {
        const at = first[t] + k, [x, y, z] = [p[at], p[at + 1], p[at + 2]],
          [u, v, w] = [n[at], n[at + 1], n[at + 2]];
        for (let r = 0; r < 3; r++) {
          position[to + k + r] = e[r] * x + e[4 + r] * y + e[8 + r] * z + e[12 + r];
          normal[to + k + r] = turn[r] * u + turn[3 + r] * v + turn[6 + r] * w;
          color[to + k + r] = c[at + r];
        }
      }
    }
    geometry.dispose();
    for (const [name, array] of Object.entries({ position, normal, color }))
      geometry.setAttribute(name, new THREE.BufferAttribute(array, 3, name === "color"));
  }
}

/** Returns the edges of faces, each once, as pairs of corners; `rim`: only those with a single face. */
export function edgesOf(body, faces, rim = false) {
  const vertices = body.vertices.length / 3, keys = [];
  for (const face of faces) {
    const corners = body.face(face);
    for (let i = 0; i < corners.length; i++) {
      const a = corners[i], b = corners[(i + 1) % corners.length];
      keys.push(Math.min(a, b) * vertices + Math.max(a, b));
    }
  }
  const sorted = Float64Array.from(keys).sort(), out = [];
  for (let first = 0, end = 0; first < sorted.length; first = end) {
    while (end < sorted.length && sorted[end] === sorted[first]) end++;
    if (!rim || end - first === 1 || body.dim === 2)
      out.push(Math.floor(sorted[first] / vertices), sorted[first] % vertices);
  }
  return out;
}

/** Removes an object from its group, and frees its resources on the graphics card. */
export function discard(group, object) {
  group.remove(object);
  object.geometry.dispose();
  object.material.dispose();
}

// ---- the filled inside of a 2D body: points with an odd crossing number
export class FlatFill {
  /** `place`: drawing order, higher on top; `depth`: how far below the segments. */
  constructor(body, colour, opacity, place, depth) {
    this.body = body;
    const material = (stencil, more) =>
      new THREE.MeshBasicMaterial({
        transparent: true, depthWrite: false, side: THREE.DoubleSide, stencilWrite: true,
        stencilFail: stencil, stencilZFail: stencil, stencilZPass: stencil, ...more,
      });
    // Each triangle from one point to a segment toggles the stencil of the pixels that it covers; those left
    // set are inside. A quad over all of it then colours them, and clears the stencil for the next fill.
    this.fan = new THREE.Mesh(
      new THREE.BufferGeometry(),
      material(THREE.InvertStencilOp, { colorWrite: false, stencilFunc: THREE.AlwaysStencilFunc }),
    );
    this.sheet = new THREE.Mesh(
      new THREE.BufferGeometry(),
      material(THREE.ZeroStencilOp, {
        color: new THREE.Color(...colour), opacity, stencilFunc: THREE.NotEqualStencilFunc, stencilRef: 0,
      }),
    );
    this.fan.renderOrder = 2 * place - 100;
    this.sheet.renderOrder = 2 * place - 99;
    for (const mesh of [this.fan, this.sheet]) {
      mesh.position.z = -depth;
      mesh.frustumCulled = false;
    }
    this.show([]);
  }

  /** Fills the area that these faces bound, provided that they form closed loops. */
  show(faces) {
    const { vertices } = this.body, closed = this.areLoops(faces) ? faces : [],
      segments = closed.map((f) => this.body.face(f)),
      point = (v) => new THREE.Vector3(vertices[3 * v], vertices[3 * v + 1], 0),
      fan = segments.map(([p, q]) => [point(p), point(q)]),
      { min, max } = new THREE.Box3().setFromPoints(fan.flat()),
      [right, left] = [new THREE.Vector3(max.x, min.y, 0), new THREE.Vector3(min.x, max.y, 0)];
    this.fan.geometry.setFromPoints(fan.flatMap(([p, q]) => [min, p, q]));
    this.sheet.geometry.setFromPoints(segments.length ? [min, right, max, min, max, left] : []);
    this.filled = segments.length > 0;
    this.look(this.visible);
  }

  /** Returns true if the faces form closed loops: an even number of them ends at each corner. */
  areLoops(faces) {
    const odd = new Set();
    for (const face of faces)
      for (const v of this.body.face(face)) if (!odd.delete(v)) odd.add(v);
    return odd.size === 0;
  }

  look(visible = true) {
    this.visible = visible;
    this.fan.visible = this.sheet.visible = visible && this.filled;
  }
}
