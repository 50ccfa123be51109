// ---- triangles and lines of faces, for three.js
/** Some faces of a body as a mesh that can be coloured, and shown in part, face by face. `shifts`, if any,
    moves each of them. */
class FaceMesh {
  constructor(body, faces, material, shifts) {
    this.body = body;
    this.flat = body.dim === 2 ? { faces, shifts, width: 0 } : null;
    this.triangles = this.flat
      ? 2 * faces.length
      : faces.reduce((n, f) => n + Math.max(0, body.offsets[f + 1] - body.offsets[f] - 2), 0);
    this.faceOf = new Uint32Array(this.triangles); // of each triangle
    const positions = new Float32Array(9 * this.triangles),
      normals = new Float32Array(9 * this.triangles);
    let t = 0;
    if (this.flat) faces.forEach((face, k) => this.faceOf.fill(face, 2 * k, 2 * k + 2));
    faces.forEach((face, k) => {
      if (this.flat) return;
      const corners = body.face(face);
      for (let i = 1; i + 1 < corners.length; i++, t++) {
        this.faceOf[t] = face;
        this.place(
          positions,
          normals,
          9 * t,
          [corners[0], corners[i], corners[i + 1]],
          shifts ? shifts[k] : [0, 0, 0],
        );
      }
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(new Uint8Array(9 * this.triangles), 3, true));
    this.mesh = new THREE.Mesh(geometry, material);
    this.mesh.userData.faces = this;
  }

  place(positions, normals, at, corners, shift) {
    const v = this.body.vertices,
      p = corners.map((c) => [0, 1, 2].map((i) => v[3 * c + i] + shift[i]));
    const u = [0, 1, 2].map((i) => p[1][i] - p[0][i]),
      w = [0, 1, 2].map((i) => p[2][i] - p[0][i]);
    const n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]],
      length = Math.hypot(...n) || 1;
    for (let c = 0; c < 3; c++)
      for (let i = 0; i < 3; i++) {
        positions[at + 3 * c + i] = p[c][i];
        normals[at + 3 * c + i] = n[i] / length;
      }
  }

  /** Makes the segments of a flat body strips of a width. */
  widen(width) {
    if (!this.flat || Math.abs(this.flat.width - width) < 0.1 * width) return;
    this.flat.width = width;
    const { position, normal } = this.mesh.geometry.attributes,
      v = this.body.vertices;
    this.flat.faces.forEach((face, k) => {
      const [p, q] = this.body.face(face),
        shift = this.flat.shifts ? this.flat.shifts[k] : [0, 0, 0],
        at = (c) => [v[3 * c] + shift[0], v[3 * c + 1] + shift[1]],
        [a, b] = [at(p), at(q)],
        length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1,
        along = [((b[0] - a[0]) / length) * (width / 2), ((b[1] - a[1]) / length) * (width / 2)],
        // A little longer than the segment, so that strips join at corners.
        corner = (end, s, t) => [end[0] + 0.7 * s * along[0] - t * along[1], end[1] + 0.7 * s * along[1] + t * along[0], 0];
      const [w, x, y, z] = [corner(a, -1, -1), corner(b, 1, -1), corner(b, 1, 1), corner(a, -1, 1)];
      position.array.set([w, x, y, w, y, z].flat(), 18 * k);
      for (let i = 0; i < 6; i++) normal.array.set([0, 0, 1], 18 * k + 3 * i);
    });
    position.needsUpdate = normal.needsUpdate = true;
    this.mesh.geometry.computeBoundingSphere();
  }

  paint(colourOf) {
    const colour = this.mesh.geometry.attributes.color;
    for (let t = 0; t < this.triangles; t++) {
      const c = colourOf(this.faceOf[t]);
      for (let k = 0; k < 9; k++) colour.array[9 * t + k] = Math.round(255 * c[k % 3]);
    }
    colour.needsUpdate = true;
  }

  /** Shows the faces that pass, alone. */
  show(passes) {
    const geometry = this.mesh.geometry;
    if (!geometry.index) geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(3 * this.triangles), 1));
    let n = 0;
    for (let t = 0; t < this.triangles; t++)
      if (passes(this.faceOf[t])) for (let c = 0; c < 3; c++) geometry.index.array[n++] = 3 * t + c;
    geometry.index.needsUpdate = true;
    geometry.setDrawRange(0, n);
  }

  /** Returns the face and the simplex that a hit of a ray is on. */
  at(hit) {
    const triangle = (hit.face.a / 3) | 0,
      face = this.faceOf[triangle];
    if (this.flat) return { face, simplex: this.body.firstSimplex[face] };
    let first = triangle;
    while (first > 0 && this.faceOf[first - 1] === face) first--;
    return { face, simplex: this.body.firstSimplex[face] + triangle - first };
  }
  dispose() {
    this.mesh.geometry.dispose();
  }
}

/** Returns the edges of faces, each once, as pairs of corners; `rim`: those of one face alone. */
function edgesOf(body, faces, rim = false) {
  const vertices = body.vertices.length / 3,
    keys = [];
  for (const face of faces) {
    const corners = body.face(face);
    for (let i = 0; i < corners.length; i++) {
      const a = corners[i],
        b = corners[(i + 1) % corners.length];
      keys.push(Math.min(a, b) * vertices + Math.max(a, b));
    }
  }
  const sorted = Float64Array.from(keys).sort(),
    out = [];
  for (let first = 0, end = 0; first < sorted.length; first = end) {
    while (end < sorted.length && sorted[end] === sorted[first]) end++;
    if (!rim || end - first === 1 || body.dim === 2) out.push(Math.floor(sorted[first] / vertices), sorted[first] % vertices);
  }
  return out;
}

/** Takes an object out of its group, and frees what the graphics card holds of it. */
function discard(group, object) {
  group.remove(object);
  object.geometry.dispose();
  object.material.dispose();
}

/** Returns lines one pixel wide along edges. */
function thinLines(body, edges, material) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(body.vertices, 3));
  geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(edges), 1));
  return new THREE.LineSegments(geometry, material);
}

/** Returns lines of any width, in pixels: browsers draw those of WebGL one pixel wide. `ends`: six numbers
    for each line. */
function thickLines(ends, material) {
  const count = ends.length / 6,
    at = new Float32Array(12 * count),
    other = new Float32Array(12 * count),
    side = new Float32Array(4 * count),
    index = new Uint32Array(6 * count);
  for (let l = 0; l < count; l++) {
    const a = ends.slice(6 * l, 6 * l + 3),
      b = ends.slice(6 * l + 3, 6 * l + 6);
    [
      [a, b, 1],
      [a, b, -1],
      [b, a, -1],
      [b, a, 1],
    ].forEach(([here, there, s], k) => {
      at.set(here, 12 * l + 3 * k);
      other.set(there, 12 * l + 3 * k);
      side[4 * l + k] = s;
    });
    index.set(
      [0, 1, 2, 2, 1, 3].map((i) => 4 * l + i),
      6 * l,
    );
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(at, 3));
  geometry.setAttribute("other", new THREE.BufferAttribute(other, 3));
  geometry.setAttribute("side", new THREE.BufferAttribute(side, 1));
  geometry.setIndex(new THREE.BufferAttribute(index, 1));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

function thickMaterial(colour, width, size, opacity = 1) {
  return new THREE.ShaderMaterial({
    uniforms: {
      colour: { value: new THREE.Color(...colour) },
      opacity: { value: opacity },
      width: { value: width },
      size: { value: size },
    },
    vertexShader: `
      attribute vec3 other;
      attribute float side;
      uniform vec2 size;
      uniform float width;
      void main() {
        vec4 a = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        vec4 b = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
        vec2 way = (b.xy / b.w - a.xy / a.w) * size;
        way = length(way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
        a.xy += vec2(-way.y, way.x) * side * width / size * a.w;
        gl_Position = a;
      }`,
    fragmentShader:
      "uniform vec3 colour; uniform float opacity; void main() { gl_FragColor = vec4(colour, opacity); }",
    side: THREE.DoubleSide,
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
}

/** Returns the twelve edges of boxes, six numbers each. `places`: centre and three half axes of each box. */
function boxEdges(places, boxes) {
  const out = [],
    corner = (at, signs, i) =>
      places[at + i] + signs.reduce((x, s, axis) => x + s * places[at + 3 + 3 * axis + i], 0);
  for (const box of boxes)
    for (let axis = 0; axis < 3; axis++)
      for (const s of [-1, 1])
        for (const t of [-1, 1])
          for (const end of [-1, 1]) {
            const signs = [0, 0, 0];
            signs[axis] = end;
            signs[(axis + 1) % 3] = s;
            signs[(axis + 2) % 3] = t;
            for (let i = 0; i < 3; i++) out.push(corner(12 * box, signs, i));
          }
  return out;
}
