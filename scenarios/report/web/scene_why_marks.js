// ---- in the view: where two faces meet, or what keeps them apart; and what parts the bodies
class WhyMarks {
  /** `why`: the panel that says the same in words. */
  constructor(view, why) {
    Object.assign(this, { view, why, group: new THREE.Group(), key: null });
    view.stage.add(this.group);
    why.listeners.push(() => view.redraw());
  }

  draw() {
    const { view, why } = this,
      nodes = why.nodes();
    view.marks.setBoxes("way", nodes.map((n) => n.number).join(" "), nodes, view.colours.selected);
    const key = why.now && view.now.why ? why.now.key : "";
    if (key === this.key) return;
    this.key = key;
    this.clear();
    if (!key) return;
    if (why.now.kind === "pair") this.addPair(why.now.found);
    else this.addParting(why.now.found);
  }

  addPair({ meet, points }) {
    const { colours } = this.view;
    this.addPath(points, points.length > 2, meet === 0 ? colours.selected : colours.underTest, 3);
    const { radius } = this.view.ballOfFaces(this.view.comparedFaces());
    if (meet === 0 && this.view.events.dim === 3) this.addSquare(squareBetween(...points, radius));
    this.view.legend.also(
      meet === 0
        ? [
            [colours.selected, "between the nearest points"],
            [colours.refining, "plane that parts the faces"],
          ]
        : [[colours.underTest, "where they meet"]],
      "why",
    );
  }

  addParting({ plane, boxes }) {
    const { colours } = this.view;
    if (boxes) {
      const places = unpack(boxes.places);
      this.view.bodies.forEach((_, side) =>
        this.addLines(boxEdges(places, [side]), mixed(colours.bodies[side], colours.ink, 0.3), 1.8),
      );
    }
    const square = unpack((plane || boxes || { square: "f4:" }).square);
    if (square.length) this.addSquare([0, 3, 6, 9].map((i) => [...square.subarray(i, i + 3)]));
    this.view.legend.also(
      [
        ...(boxes ? [[mixed(colours.bodies[0], colours.ink, 0.3), "nearest of the boxes found apart"]] : []),
        ...(square.length
          ? [[colours.refining, plane ? "plane that parts the bodies" : "plane that parts these boxes"]]
          : []),
      ],
      "why",
    );
  }

  /** Joins points in their order. */
  addPath(points, closed, colour, width) {
    const ends = [];
    for (let i = 0; i + 1 < points.length + (closed ? 1 : 0); i++)
      ends.push(...points[i], ...points[(i + 1) % points.length]);
    if (ends.length) this.addLines(ends, colour, width);
  }

  addLines(ends, colour, width) {
    const lines = thickLines(ends, thickMaterial(colour, width, this.view.size));
    lines.renderOrder = 7;
    this.group.add(lines);
  }

  addSquare(corners) {
    const colour = this.view.colours.refining,
      geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(corners.flat()), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const square = new THREE.Mesh(
      geometry,
      new THREE.MeshBasicMaterial({
        color: new THREE.Color(...colour),
        transparent: true,
        opacity: 0.35,
        depthWrite: false,
        side: THREE.DoubleSide,
      }),
    );
    square.renderOrder = 4;
    square.frustumCulled = false;
    this.group.add(square);
    this.addPath(corners, true, colour, 1.2);
  }

  clear() {
    this.view.legend.also([], "why");
    for (const object of this.group.children.slice()) discard(this.group, object);
  }
}

/** Returns a square across the line between two points, at its middle. `half`: from there to its corners. */
function squareBetween(p, q, half) {
  const a = new THREE.Vector3(...p),
    b = new THREE.Vector3(...q),
    n = b.clone().sub(a);
  if (n.length() === 0) return [p, p, p, p];
  n.normalize();
  const u = new THREE.Vector3(Math.abs(n.x) < 0.6 ? 1 : 0, Math.abs(n.x) < 0.6 ? 0 : 1, 0)
      .cross(n)
      .setLength(half),
    v = n.clone().cross(u),
    middle = a.add(b).multiplyScalar(0.5);
  return [u, v, u.clone().negate(), v.clone().negate()].map((way) => middle.clone().add(way).toArray());
}
