// ---- the inside of a flat body, filled: what lies within an odd number of its loops
class FlatFill {
  /** `place`: fills of a higher one lie over those of lower ones; `depth`: how far below the segments. */
  constructor(body, colour, opacity, place, depth) {
    this.body = body;
    const material = (stencil, more) =>
      new THREE.MeshBasicMaterial({
        transparent: true,
        depthWrite: false,
        side: THREE.DoubleSide,
        stencilWrite: true,
        stencilFail: stencil,
        stencilZFail: stencil,
        stencilZPass: stencil,
        ...more,
      });
    // Each triangle from one point to a segment turns over what it covers; what stays turned is inside. Then a sheet over
    // all of it takes the colour there, and leaves nothing turned for the next fill.
    this.fan = new THREE.Mesh(
      new THREE.BufferGeometry(),
      material(THREE.InvertStencilOp, { colorWrite: false, stencilFunc: THREE.AlwaysStencilFunc }),
    );
    this.sheet = new THREE.Mesh(
      new THREE.BufferGeometry(),
      material(THREE.ZeroStencilOp, {
        color: new THREE.Color(...colour),
        opacity,
        stencilFunc: THREE.NotEqualStencilFunc,
        stencilRef: 0,
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

  /** Fills what these faces bound; nothing if they bound nothing, because a loop is open. */
  show(faces) {
    const { vertices } = this.body,
      closed = this.areLoops(faces),
      segments = closed ? faces.map((f) => this.body.face(f)) : [],
      ends = segments.flatMap(([p, q]) => [p, q]),
      xs = ends.map((v) => vertices[3 * v]),
      ys = ends.map((v) => vertices[3 * v + 1]);
    const least = (all) => all.reduce((m, x) => Math.min(m, x), Infinity),
      most = (all) => all.reduce((m, x) => Math.max(m, x), -Infinity),
      [left, right, low, high] = [least(xs), most(xs), least(ys), most(ys)];
    const fan = segments.flatMap((_, k) => [
      left,
      low,
      0,
      ...[2 * k, 2 * k + 1].flatMap((end) => [xs[end], ys[end], 0]),
    ]);
    const sheet = segments.length
      ? [left, low, 0, right, low, 0, right, high, 0, left, low, 0, right, high, 0, left, high, 0]
      : [];
    this.fan.geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(fan), 3));
    this.sheet.geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(sheet), 3));
    this.filled = segments.length > 0;
    this.look(this.visible);
  }

  /** Returns whether the faces are closed loops: an even number of them ends at each corner. */
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
