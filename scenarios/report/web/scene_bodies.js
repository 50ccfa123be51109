import { boxEdges, fadingLines, HOLES, holeUniforms, lineGeometry, WHITE } from "./scene_lines.js";
import { NONE } from "./scene_run.js";

// ---- counters as colours: one number for each face, on a scale common to both bodies
export const COUNTERS = ["tests", "hits", "misses"];

/** Returns tests, hits and misses of each body's faces in a step, up to an event, from the events on the
    page. */
export function countsSoFar(events, event) {
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

/** Assigns each face the sum over the faces of its group, "region" or "level". A real face belongs to the
    region that covers it, a pseudo face to the one that it hides; a face without a region keeps its own
    number. */
export function sumsOfGroups(body, per, counts) {
  const groupOf = per === "region" ? (f) => body.regionOf(f) : (f) => body.depth(body.outer[f]),
    sums = new Map();
  const groups = Uint32Array.from(counts, (_, f) => groupOf(f));
  counts.forEach((n, f) => sums.set(groups[f], (sums.get(groups[f]) || 0) + n));
  return counts.map((n, f) => (groups[f] === NONE ? n : sums.get(groups[f])));
}

// ---- colours of faces, as in the frames (render/include/lrbscope/render/style.hpp, repeated in the page's
// data)
export const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
export const mixed = (from, to, t) => from.map((c, i) => c + (to[i] - c) * t);

export class Colours {
  constructor(json) {
    this.bodies = json.bodies.map(rgb);
    this.scale = json.scale.map(rgb);
    this.categories = json.categories.map(rgb);
    for (const n of ["contact", "refining", "underTest", "selected", "ink", "wrong"]) this[n] = rgb(json[n]);
    this.stops = json.scale;
    this.edgeInk = rgb(json.edgeInk);
    this.shares = json.shares; // interpolation weights: of edges towards edgeInk, of pale faces towards white
  }

  onScale(t) {
    const at = Math.max(0, Math.min(1, t)) * (this.scale.length - 1),
      i = Math.min(Math.floor(at), this.scale.length - 2);
    return mixed(this.scale[i], this.scale[i + 1], at - i);
  }
  edge(side) {
    return mixed(this.bodies[side], this.edgeInk, this.shares.edge);
  }

  lid(side) {
    return mixed(this.bodies[side], WHITE, this.shares.lid);
  }
  /** Of the inside of a 2D body, darker than its regions. */
  solid(side) {
    return mixed(this.bodies[side], this.edgeInk, 0.28);
  }

  /** Returns the face colours of a mode: {of(side, face), key: {most, title} or null}. `newest`: regions
      of earlier layers are pale; 0: none is. */
  mode(bodies, by, counts, newest = 0) {
    const layers = 1 + bodies.reduce((most, b) => b.layer.reduce((m, l) => Math.max(m, l), most), 0);
    const pale = (side) => mixed(this.bodies[side], WHITE, this.shares.ground);
    if (by === "kind")
      return {
        of: (side, face) =>
          bodies[side].isReal(face) ? this.bodies[side] : mixed(this.bodies[side], WHITE, 0.4),
        key: null,
      };
    if (by === "layer")
      return {
        of: (side, face) => bodies[side].isReal(face) ? pale(side)
            : this.onScale(layers > 1 ? bodies[side].layer[bodies[side].inner[face]] / (layers - 1) : 1),
        key: { most: layers - 1, title: "layer" },
      };
    if (by === "region")
      return {
        of: (side, face) => bodies[side].isReal(face) ? pale(side)
            : mixed(
                this.categories[bodies[side].inner[face] % this.categories.length], WHITE,
                bodies[side].layer[bodies[side].inner[face]] < newest ? 0.68 : 0,
              ),
        key: null,
      };
    // The scale ends at what 99 of 100 counted faces do not exceed: few outliers would hide the others.
    const counted = counts.flatMap((values) => [...values.filter((v) => v > 0)]).sort((x, y) => x - y),
      most = counted.length ? counted[Math.ceil(0.99 * counted.length) - 1] : 0,
      top = counted.length ? counted[counted.length - 1] : 0;
    return {
      of: (side, face) => counts[side][face] > 0 ? this.onScale(counts[side][face] / most)
          : mixed(this.bodies[side], WHITE, this.shares.noValue),
      key: { most, top, title: "" },
    };
  }
}

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

// ---- one body in the view: its real faces, the lids of its wrapper, separate regions, and the boxes of its
// tree

// Exploded view: way of the outermost layer, as a share of the body's radius.
const SPREAD = 1.1;

export class BodyView {
  /** `lens`: see fadingLines(). */
  constructor(body, colours, lens) {
    Object.assign(this, { body, colours, lens, group: new THREE.Group(), pieces: [] });
    this.group.matrixAutoUpdate = false;
    this.materials = BodyView.materialsOf(body.dim, lens);
    const range = (from, to) => Uint32Array.from({ length: to - from }, (_, i) => from + i),
      flat = body.dim === 2;
    this.realFaces = range(0, body.realCount);
    this.real = new FaceMesh(body, this.realFaces, this.materials.real);
    // In 2D the whole wrapper is one bold line, also where it is the body itself.
    this.lidFaces = range(flat ? 0 : body.realCount, body.faceCount)
        .filter((f) => body.offsets[f] < body.offsets[f + 1]);
    this.lids = new FaceMesh(body, this.lidFaces, this.materials.lids);
    this.group.add(this.real.mesh);
    this.addGlass(this.lids);
    this.put("edges", this.lines(flat ? [] : edgesOf(body, this.realFaces), 0.5));
    this.put("lidEdges", this.lines([], 0.25, { opens: true }));
    this.measure();
    this.fills = flat ? this.makeFills() : null;
  }

  /** Lids of a 3D body are drawn with those of the other one; see Glass. */
  addGlass(faces) {
    if (this.body.dim === 2) this.group.add(faces.mesh);
    else faces.mesh.matrixWorld = this.group.matrixWorld;
  }
  get panes() {
    const glass = this.body.dim === 2 ? [] : [this.lids, ...this.pieces.slice(1)];
    return glass.filter(({ mesh }) => mesh.visible && mesh.geometry.index);
  }

  /** Replaces an object of the body, named as a member; null: removes it. */
  put(name, object) {
    if (this[name]) discard(this.group, this[name]);
    if (this[name] && object) object.visible = this[name].visible;
    this[name] = object;
    if (object) this.group.add(object);
  }

  /** Returns the coordinates of edges, pairs of corners. */
  endsOf(edges) {
    const { vertices } = this.body, ends = new Float32Array(3 * edges.length);
    for (let i = 0; i < ends.length; i++) ends[i] = vertices[3 * edges[(i / 3) | 0] + (i % 3)];
    return ends;
  }
  /** Returns thin lines along edges. */
  lines(edges, opacity, more) {
    return this.thin(this.endsOf(edges), opacity, more);
  }
  thin(ends, opacity, more) {
    const colour = new THREE.Color(...this.colours.edge(this.body.side)),
      lines = fadingLines(ends, colour, opacity, this.lens, more);
    lines.renderOrder = 2;
    return lines;
  }

  /** Returns the fills of a 2D body: of the solid, and under it, paler, of the wrapper. */
  makeFills() {
    const { side } = this.body, colour = this.colours.bodies[side],
      fill = (shade, opacity, place) =>
        new FlatFill(this.body, shade, opacity, 2 * side + place, (0.02 - 0.005 * place) * this.radius);
    const fills = { wrapper: fill(this.colours.lid(side), 0.8, 0),
        solid: fill(this.colours.solid(side), 0.85, 1) };
    fills.solid.show([...this.realFaces]);
    for (const f of [fills.wrapper, fills.solid]) this.group.add(f.fan, f.sheet);
    return fills;
  }

  /** Shows or hides the insides of a 2D body and of its wrapper. */
  lookInside(solid, wrapper) {
    if (!this.fills) return;
    this.fills.solid.look(solid);
    this.fills.wrapper.look(wrapper);
  }

  /** Draws the segments of a 2D body as strips; `pixel`: the width of a pixel. */
  widen(pixel) {
    this.real.widen(1.2 * pixel);
    this.lids.widen(4 * pixel);
    for (const piece of this.pieces) piece.widen(3 * pixel);
    if (this.counted) this.counted.widen(4 * pixel);
  }

  /** Returns the materials of faces. Lids are glass: nearly clear where they are seen from the front, visible
      where they turn away, so that the body under them keeps its colour; `rim` 0: they are lit, and as opaque
      everywhere. They are cut open in front of contacts, with a line around the hole. */
  static materialsOf(dim, lens) {
    const faces = (Material, before, more = {}) =>
        new Material({
          vertexColors: THREE.VertexColors, side: THREE.DoubleSide, polygonOffset: true,
          polygonOffsetFactor: before, polygonOffsetUnits: before, ...more,
        }),
      glass = { transparent: true, depthWrite: false };
    return {
      real: faces(THREE.MeshLambertMaterial, 2),
      lids: faces(THREE.ShaderMaterial, 1, {
        ...glass,
        uniforms: { veil: { value: 1 }, rim: { value: 0 }, isPlane: { value: dim === 2 },
            ...holeUniforms(lens) },
        vertexShader: `
          varying vec3 tint;
          varying float facing;
          varying vec3 seen;
          void main() {
            vec4 at = modelViewMatrix * vec4(position, 1.0);
            bool parallel = projectionMatrix[2][3] == 0.0;
            facing = abs(
                dot(normalize(normalMatrix * normal), parallel ? vec3(0.0, 0.0, 1.0) : normalize(at.xyz)));
            tint = color;
            seen = at.xyz;
            gl_Position = projectionMatrix * at;
          }`,
        fragmentShader: `
          uniform float veil, rim;
          uniform bool isPlane;
          varying vec3 tint;
          varying float facing;
          ${HOLES}
          void main() {
            float inside = intoHole();
            if (inside > pixel) discard;
            float clear = isPlane ? 1.0 : mix(1.0, 0.06 + 0.94 * pow(1.0 - facing, 2.5), rim);
            if (inside > -pixel) gl_FragColor = vec4(0.6 * tint, 0.35);
            else gl_FragColor = vec4(isPlane ? tint : tint * mix(0.6 + 0.45 * facing, 1.0, rim),
                veil * clear);
          }`,
      }),
      piece: faces(THREE.MeshLambertMaterial, 1),
      counted: faces(THREE.MeshBasicMaterial, 1),
    };
  }

  /** Computes the centre and the radius of the outermost wrapper. */
  measure() {
    const outermost = [];
    this.body.outer.forEach((cell, face) => {
      if (cell === NONE) outermost.push(face);
    });
    this.centroid = this.centroidOf(outermost);
    const most = outermost.length < 5e4 ? 2 : 1;
    this.extremes = this.reached = this.farthest((visit) => this.eachCorner(outermost, visit), most);
    this.radius = 0;
    this.eachCorner(outermost, (x, y, z) => {
      const far = Math.hypot(x - this.centroid[0], y - this.centroid[1], z - this.centroid[2]);
      this.radius = Math.max(this.radius, far);
    });
  }

  /** Returns the extreme points in some directions, to the points of a cube's surface with 2n + 1 points
      along an edge; `each` calls its argument with every point. */
  farthest(each, n = 1) {
    const ways = [], range = Array.from({ length: 2 * n + 1 }, (_, i) => i - n);
    for (const x of range)
      for (const y of range)
        for (const z of range)
          if (Math.max(Math.abs(x), Math.abs(y), Math.abs(z)) === n) ways.push([x, y, z]);
    const best = ways.map(() => [-Infinity, this.centroid]);
    each((x, y, z) =>
      ways.forEach((w, i) => {
        const way = w[0] * x + w[1] * y + w[2] * z;
        if (way > best[i][0]) best[i] = [way, [x, y, z]];
      }),
    );
    return best.map(([, p]) => p);
  }

  point(vertex) {
    return [0, 1, 2].map((i) => this.body.vertices[3 * vertex + i]);
  }
  eachCorner(faces, visit) {
    const { vertices, corners, offsets } = this.body;
    for (const f of faces)
      for (let i = offsets[f]; i < offsets[f + 1]; i++)
        visit(vertices[3 * corners[i]], vertices[3 * corners[i] + 1], vertices[3 * corners[i] + 2]);
  }
  centroidOf(faces) {
    const sum = [0, 0, 0];
    let count = 0;
    this.eachCorner(faces, (x, y, z) => {
      sum[0] += x;
      sum[1] += y;
      sum[2] += z;
      count++;
    });
    return sum.map((x) => x / Math.max(1, count));
  }
  toWorld(p) {
    return new THREE.Vector3(...p).applyMatrix4(this.group.matrix);
  }

  /** Takes a pose as rows of [R | t]. */
  setPose(p) {
    this.group.matrix.set(...p, 0, 0, 0, 1);
    this.group.matrixWorldNeedsUpdate = true;
  }

  /** `veil`: opacity of the lids; `rim`: see materialsOf(). */
  paint(mode, veil, rim = 0) {
    const { side, dim } = this.body,
      of = (face) => mode.of(side, face);
    for (const faces of [this.real, ...this.pieces]) faces.paint(of);
    this.lids.paint(dim === 2 ? () => this.colours.edge(side) : of);
    this.materials.lids.uniforms.veil.value = dim === 2 ? 1 : veil;
    this.materials.lids.uniforms.rim.value = rim;
  }

  /** Shows the lids of the wrapper: its pseudo faces. `isClosed`: no faces of the wrapper are discarded. */
  showLids(onBoundary, isClosed) {
    const { realCount, faceCount } = this.body, shown = this.lidFaces.filter(onBoundary);
    this.isShown = this.isShown || new Uint8Array(this.body.faceCount);
    this.isShown.fill(0);
    for (const f of shown) this.isShown[f] = 1;
    this.lids.show((f) => this.isShown[f]);
    if (this.fills) this.fills.wrapper.show([...shown]);
    else this.showLidEdges(shown, isClosed && this.lidFaces.length === faceCount - realCount);
    this.lidCount = shown.filter((f) => f >= realCount).length;
  }

  /** Shows edges of lids. On a closed surface two faces have an edge in opposite directions, and it is shown
      with the one that goes to the larger number. Where the other face is a real one, its edges are shown
      anyway. */
  showLidEdges(faces, isClosed) {
    const { corners, offsets } = this.body, edges = isClosed ? [] : edgesOf(this.body, faces);
    for (const f of isClosed ? faces : [])
      for (let i = offsets[f]; i < offsets[f + 1]; i++) {
        const a = corners[i], b = corners[i + 1 < offsets[f + 1] ? i + 1 : offsets[f]];
        if (a < b) edges.push(a, b);
      }
    this.lidEdges.geometry.dispose();
    this.lidEdges.geometry = lineGeometry(this.endsOf(edges));
  }

  ghost(on) {
    const { real } = this.materials;
    Object.assign(real, {
      transparent: on, opacity: on ? 0.13 : 1, depthWrite: !on, side: on ? THREE.FrontSide : THREE.DoubleSide,
    });
    this.edges.material.uniforms.opacity.value = on ? 0.15 : 0.5;
    real.needsUpdate = true;
    this.real.mesh.renderOrder = on ? 3 : 0;
  }

  clearPieces() {
    for (const piece of this.pieces) {
      this.group.remove(piece.mesh);
      piece.dispose();
    }
    this.put("pieceEdges", null);
    this.pieces = [];
    this.reached = this.extremes;
  }

  /** Shows regions alone, with translucent lids; `share` above 0: exploded. The lids of the outer layers then
      rise from the body, one layer after the other, and of what they leave the outermost is shown. */
  showRegions(regions, share) {
    this.clearPieces();
    const { body } = this, glass = { faces: [], shifts: [] }, solid = { faces: [], shifts: [] }, ends = [],
      kept = new Set(regions), isBare = (f) => !kept.has(body.outer[f]) || this.rise(body.outer[f], share) > 0;
    for (const r of regions) {
      const rises = this.rise(r, share) > 0, shift = rises ? this.explodeShift(r, share) : [0, 0, 0],
        lids = share > 0 && !rises ? body.lids(r).filter(isBare) : body.lids(r),
        floor = share > 0 ? [] : body.floor(r);
      for (const [list, faces] of [[glass, lids], [solid, floor]])
        for (const face of faces) {
          list.faces.push(face);
          list.shifts.push(shift);
        }
      for (const v of edgesOf(body, [...lids, ...floor]))
        ends.push(...this.point(v).map((x, i) => x + shift[i]));
    }
    this.pieces = [
      new FaceMesh(body, solid.faces, this.materials.piece, solid.shifts),
      new FaceMesh(body, glass.faces, this.materials.lids, glass.shifts),
    ];
    if (body.dim === 3) this.pieces[1].show(() => true); // to be sorted
    if (share > 0 && ends.length)
      this.reached = this.farthest((visit) => {
        for (const x of this.extremes) visit(...x);
        for (let i = 0; i < ends.length; i += 3) visit(ends[i], ends[i + 1], ends[i + 2]);
      });
    this.group.add(this.pieces[0].mesh);
    this.addGlass(this.pieces[1]);
    this.put("pieceEdges", this.thin(ends, share > 0 ? 0.35 : 0.6));
  }

  /** Returns how far a region rises in an exploded view, in layers: the outermost first. */
  rise(region, share) {
    const { layer } = this.body;
    this.layers = this.layers || 1 + layer.reduce((most, l) => Math.max(most, l), 0);
    return Math.max(0, share * this.layers - (this.layers - 1 - layer[region]));
  }

  /** Returns the way of a region: where its lids look. */
  explodeShift(region, share) {
    const lids = this.body.lids(region), out = this.outward(lids);
    if (out.length() === 0)
      out.set(...this.centroidOf(lids)).sub(new THREE.Vector3(...this.centroid));
    return out.setLength((SPREAD * this.radius * this.rise(region, share)) / this.layers).toArray();
  }

  /** Returns the sum of twice the area vectors of faces. */
  outward(faces) {
    const out = new THREE.Vector3();
    for (const f of faces) {
      const [o, ...rest] = [...this.body.face(f)].map((v) => new THREE.Vector3(...this.point(v))),
        ways = rest.map((p) => p.sub(o));
      if (this.body.dim === 2) ways.push(new THREE.Vector3(0, 0, 1));
      ways.slice(1).forEach((way, k) => out.add(ways[k].clone().cross(way)));
    }
    return out;
  }

  /** Shows faces that have a counter in the exact colour of the scale, without lighting; on a ghost, these
      faces are opaque. */
  showCounted(faces, colourOf) {
    if (this.counted) {
      this.group.remove(this.counted.mesh);
      this.counted.dispose();
      this.counted = null;
    }
    if (!faces.length) return;
    this.counted = new FaceMesh(this.body, faces, this.materials.counted);
    this.counted.paint(colourOf);
    this.group.add(this.counted.mesh);
  }

  /** Shows the tree's boxes at a depth; below 0: none. */
  showBoxes(depth) {
    const { depth: depths, places } = this.body.boxes,
      boxes = [...depths.keys()].filter((i) => depths[i] === depth);
    this.put("boxLines", boxes.length ? this.thin(boxEdges(places, boxes), 0.8, { depthWrite: true }) : null);
  }
}
