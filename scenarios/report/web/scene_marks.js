// ---- what the event is about, and what is selected: painted over the bodies, with rims that are seen
// through everything
class Marks {
  constructor(views, colours, size) {
    this.views = views;
    this.colours = colours;
    this.size = size; // of the picture in pixels, kept by the view
    this.shown = new Map(); // by name: {key, parts: [{group, object}]}
  }

  /** Shows faces in a colour. Nothing is made again while `key` stays the same. `through`: rims are seen through
      everything. */
  set(name, key, faces, { colour, opacity = 1, width = 1.5, over = false, through = true }) {
    const before = this.shown.get(name);
    if (before && before.key === key) return;
    this.clear(name);
    const parts = [];
    this.views.forEach((view, side) => {
      const own = faces.filter((f) => f.side === side).map((f) => f.face);
      if (!own.length) return;
      const material = new THREE.MeshLambertMaterial({
        color: new THREE.Color(...colour),
        side: THREE.DoubleSide,
        transparent: opacity < 1 || over,
        opacity,
        depthWrite: opacity === 1 && !over,
        depthTest: !over,
        polygonOffset: true,
        polygonOffsetFactor: 0,
        polygonOffsetUnits: -2,
      });
      const strips = new FaceMesh(view.body, own, material),
        mesh = strips.mesh;
      mesh.renderOrder = over ? 5 : opacity < 1 ? 3 : 0;
      const rim = thickLines(
        edgesOf(view.body, own, true).flatMap((v) => view.point(v)),
        thickMaterial(mixed(colour, this.colours.ink, 0.35), width, this.size),
      );
      rim.renderOrder = 6;
      if (!through)
        Object.assign(rim.material, { depthTest: true, polygonOffset: true, polygonOffsetFactor: 0, polygonOffsetUnits: -40 });
      view.group.add(mesh, rim);
      parts.push({ group: view.group, object: mesh }, { group: view.group, object: rim });
    });
    this.shown.set(name, { key, parts });
  }

  /** As BodyView's, a little wider. */
  widen(pixel) {
    for (const { parts } of this.shown.values())
      for (const { object } of parts) if (object.userData.faces) object.userData.faces.widen(6 * pixel);
  }

  /** Shows boxes of tree nodes. */
  setBoxes(name, key, nodes, colour) {
    const before = this.shown.get(name);
    if (before && before.key === key) return;
    this.clear(name);
    const parts = [];
    this.views.forEach((view, side) => {
      const { node, places } = view.body.boxes,
        own = nodes
          .filter((n) => n.side === side)
          .map((n) => node.indexOf(n.number))
          .filter((i) => i >= 0);
      if (!own.length) return;
      const lines = thickLines(
        boxEdges(places, own),
        thickMaterial(mixed(colour, this.colours.ink, 0.35), 1.5, this.size),
      );
      lines.renderOrder = 6;
      view.group.add(lines);
      parts.push({ group: view.group, object: lines });
    });
    this.shown.set(name, { key, parts });
  }

  clear(name) {
    for (const { group, object } of (this.shown.get(name) || { parts: [] }).parts) discard(group, object);
    this.shown.delete(name);
  }
}
