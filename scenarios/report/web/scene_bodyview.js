// ---- one body in the view: its real faces, the lids of its wrapper, regions on their own, and the boxes
// of its tree
// Exploded: extra way for each layer, as a share of the body's radius; as in the frames.
const LAYER_STEP = 0.12;

class BodyView {
  constructor(body, colours) {
    this.body = body;
    this.group = new THREE.Group();
    this.group.matrixAutoUpdate = false;
    this.materials = BodyView.materialsOf(new THREE.Color(...colours.edge(body.side)));
    const range = (from, to) => Uint32Array.from({ length: to - from }, (_, i) => from + i);
    this.real = new FaceMesh(body, range(0, body.realCount), this.materials.real);
    this.lids = new FaceMesh(body, range(body.realCount, body.faceCount), this.materials.lids);
    this.edges = thinLines(body, edgesOf(body, range(0, body.realCount)), this.materials.edges);
    this.lidEdges = thinLines(
      body,
      new Uint32Array(2 * (body.corners.length - body.offsets[body.realCount])),
      this.materials.lidEdges,
    );
    this.lids.mesh.renderOrder = 1;
    this.lidEdges.renderOrder = 2;
    this.edges.frustumCulled = this.lidEdges.frustumCulled = this.lids.mesh.frustumCulled = false;
    this.group.add(this.real.mesh, this.edges, this.lids.mesh, this.lidEdges);
    this.pieces = [];
    this.boxLines = null;
    this.measure();
    this.fills = body.dim === 2 ? this.makeFills(colours.bodies[body.side]) : null;
  }

  /** Returns fills of a flat body: of the solid, and under it, paler, of the wrapper. */
  makeFills(colour) {
    const { realCount, side } = this.body,
      fill = (shade, opacity, place) =>
        new FlatFill(this.body, shade, opacity, 2 * side + place, (0.02 - 0.005 * place) * this.radius);
    const fills = { wrapper: fill(mixed(colour, WHITE, 0.5), 0.45, 0), solid: fill(colour, 0.6, 1) };
    fills.solid.show(Array.from({ length: realCount }, (_, face) => face));
    for (const f of [fills.wrapper, fills.solid]) this.group.add(f.fan, f.sheet);
    return fills;
  }

  /** Shows or hides the insides of a flat body and of its wrapper. */
  lookInside(solid, wrapper) {
    if (!this.fills) return;
    this.fills.solid.look(solid);
    this.fills.wrapper.look(wrapper);
  }

  /** Draws the segments of a flat body as strips; `pixel`: how wide a pixel is. */
  widen(pixel) {
    this.real.widen(3 * pixel);
    this.lids.widen(3 * pixel);
    for (const piece of this.pieces) piece.widen(3 * pixel);
    if (this.counted) this.counted.widen(4 * pixel);
  }

  /** Returns what faces and lines are made of; `edge`: the colour of lines. */
  static materialsOf(edge) {
    const faces = (Material, before, more = {}) =>
        new Material({
          vertexColors: THREE.VertexColors,
          side: THREE.DoubleSide,
          polygonOffset: true,
          polygonOffsetFactor: before,
          polygonOffsetUnits: before,
          ...more,
        }),
      lines = (opacity, depthWrite = false) =>
        new THREE.LineBasicMaterial({ color: edge, transparent: true, opacity, depthWrite }),
      glass = { transparent: true, depthWrite: false };
    return {
      real: faces(THREE.MeshLambertMaterial, 2),
      lids: faces(THREE.MeshLambertMaterial, 1, glass),
      piece: faces(THREE.MeshLambertMaterial, 1),
      counted: faces(THREE.MeshBasicMaterial, 1),
      openLids: faces(THREE.MeshLambertMaterial, 0, { ...glass, opacity: 0.6 }),
      edges: lines(0.35),
      lidEdges: lines(0.6),
      boxes: lines(0.8, true),
    };
  }

  /** Finds the middle of the outermost wrapper and how far it reaches. */
  measure() {
    const outermost = [];
    this.body.outer.forEach((cell, face) => {
      if (cell === NONE) outermost.push(face);
    });
    this.middle = this.middleOf(outermost);
    this.extremes = this.reached = this.farthest((visit) => this.eachCorner(outermost, visit));
    this.radius = 0;
    this.eachCorner(outermost, (x, y, z) => {
      this.radius = Math.max(
        this.radius,
        Math.hypot(x - this.middle[0], y - this.middle[1], z - this.middle[2]),
      );
    });
  }

  /** Returns the points that reach farthest in some directions; `each` calls its argument with every
      point. */
  farthest(each) {
    const ways = [];
    for (const x of [-1, 0, 1])
      for (const y of [-1, 0, 1]) for (const z of [-1, 0, 1]) if (x || y || z) ways.push([x, y, z]);
    const best = ways.map(() => [-Infinity, this.middle]);
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
  middleOf(faces) {
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
    this.group.matrix.set(
      p[0],
      p[1],
      p[2],
      p[3],
      p[4],
      p[5],
      p[6],
      p[7],
      p[8],
      p[9],
      p[10],
      p[11],
      0,
      0,
      0,
      1,
    );
    this.group.matrixWorldNeedsUpdate = true;
  }

  /** `veil`: how much lids cover. */
  paint(mode, veil) {
    const of = (face) => mode.of(this.body.side, face);
    for (const faces of [this.real, this.lids, ...this.pieces]) faces.paint(of);
    this.materials.lids.opacity = veil;
    this.materials.lidEdges.opacity = Math.min(0.6, 1.2 * veil);
  }

  /** Shows the lids of the wrapper: its pseudo faces. */
  showLids(onBoundary) {
    this.lids.show(onBoundary);
    if (this.fills)
      this.fills.wrapper.show([...Array(this.body.faceCount).keys()].filter((face) => onBoundary(face)));
    const shown = [];
    for (let f = this.body.realCount; f < this.body.faceCount; f++) if (onBoundary(f)) shown.push(f);
    const edges = edgesOf(this.body, shown),
      { geometry } = this.lidEdges;
    geometry.index.array.set(edges);
    geometry.index.needsUpdate = true;
    geometry.setDrawRange(0, edges.length);
  }

  ghost(on) {
    const { real, edges } = this.materials;
    Object.assign(real, {
      transparent: on,
      opacity: on ? 0.13 : 1,
      depthWrite: !on,
      side: on ? THREE.FrontSide : THREE.DoubleSide,
    });
    edges.opacity = on ? 0.1 : 0.35;
    real.needsUpdate = true;
    this.real.mesh.renderOrder = on ? 3 : 0;
  }

  clearPieces() {
    for (const piece of this.pieces) {
      this.group.remove(piece.mesh);
      piece.dispose();
    }
    if (this.pieceEdges) {
      this.group.remove(this.pieceEdges);
      this.pieceEdges.geometry.dispose();
      this.pieceEdges = null;
    }
    this.pieces = [];
    this.reached = this.extremes;
  }

  /** Shows regions on their own, moved outward by a share of their way; `open`: lids are translucent. */
  showRegions(regions, share, open) {
    this.clearPieces();
    const solid = { faces: [], shifts: [] },
      glass = { faces: [], shifts: [] },
      ends = [];
    for (const r of regions) {
      const shift = share > 0 ? this.wayOut(r, share) : [0, 0, 0];
      for (const [list, faces] of [
        [open ? glass : solid, this.body.lids(r)],
        [solid, this.body.floor(r)],
      ])
        for (const face of faces) {
          list.faces.push(face);
          list.shifts.push(shift);
        }
      const edges = edgesOf(this.body, [...this.body.lids(r), ...this.body.floor(r)]);
      for (const v of edges) ends.push(...this.point(v).map((x, i) => x + shift[i]));
    }
    this.pieces = [
      new FaceMesh(this.body, solid.faces, this.materials.piece, solid.shifts),
      new FaceMesh(this.body, glass.faces, this.materials.openLids, glass.shifts),
    ];
    this.pieces[1].mesh.renderOrder = 2;
    if (share > 0 && ends.length)
      this.reached = this.farthest((visit) => {
        for (let i = 0; i < ends.length; i += 3) visit(ends[i], ends[i + 1], ends[i + 2]);
      });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(ends), 3));
    this.pieceEdges = new THREE.LineSegments(geometry, this.materials.lidEdges);
    this.group.add(...this.pieces.map((p) => p.mesh), this.pieceEdges);
  }

  wayOut(region, share) {
    const middle = this.middleOf([...this.body.lids(region), ...this.body.floor(region)]);
    const out = middle.map((x, i) => x - this.middle[i]),
      length = Math.hypot(...out);
    if (length === 0) return out;
    const way = length + LAYER_STEP * this.radius * (1 + this.body.layer[region]);
    return out.map((x) => (x * share * way) / length);
  }

  /** Shows faces that have a counter in exactly the colour that the scale has, without light; of a ghost,
      these are solid. */
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
    if (this.boxLines) {
      this.group.remove(this.boxLines);
      this.boxLines.geometry.dispose();
      this.boxLines = null;
    }
    const boxes = [];
    this.body.boxes.depth.forEach((d, i) => {
      if (d === depth) boxes.push(i);
    });
    if (!boxes.length) return;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute(
      "position",
      new THREE.BufferAttribute(Float32Array.from(boxEdges(this.body.boxes.places, boxes)), 3),
    );
    this.boxLines = new THREE.LineSegments(geometry, this.materials.boxes);
    this.boxLines.renderOrder = 2;
    this.group.add(this.boxLines);
  }
}
