import { discard, edgesOf, FaceMesh, FlatFill, Glass } from "./scene_faces.js";
import { boxEdges, fadingLines, HOLES, holeUniforms, lineGeometry } from "./scene_lines.js";
import { NONE } from "./scene_run.js";

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
      kept = new Set(regions),
      isBare = (f) => !kept.has(body.outer[f]) || this.rise(body.outer[f], share) > 0;
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
