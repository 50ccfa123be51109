// ---- clicks in the view: which face is meant
class Picker {
  constructor(view) {
    this.view = view;
    const { canvas, selection } = view;
    let down = null;
    canvas.addEventListener("pointerdown", (e) => {
      down = [e.clientX, e.clientY];
    });
    canvas.addEventListener("click", (e) => {
      if (down && Math.hypot(e.clientX - down[0], e.clientY - down[1]) > 4) return; // the view was turned
      const hit = this.under(e.clientX, e.clientY, e.altKey);
      if (hit) selection.pickFace(hit.side, hit.face, hit.simplex);
      else selection.pick(null);
    });
    canvas.addEventListener("dblclick", (e) => {
      if (this.under(e.clientX, e.clientY, e.altKey)) view.frameSelection();
      else view.frameAll();
    });
  }

  /** Returns the face under a point of the screen, {side, face, simplex}; `through`: lids are looked through. */
  under(x, y, through = false) {
    const { views, now } = this.view;
    const pieces = views.flatMap((v) => v.pieces);
    const lids = through ? [] : views.filter((v) => v.lids.mesh.visible).map((v) => v.lids);
    const real = views.map((v) => v.real);
    if (now.isolate) return this.nearest(x, y, pieces) || this.nearest(x, y, real);
    // What is seen through is not what is clicked, unless there is nothing else.
    return now.ghost && lids.length
      ? this.nearest(x, y, lids)
      : this.nearest(x, y, [...pieces, ...lids, ...real]);
  }

  /** Returns the nearest face of some FaceMesh. */
  nearest(x, y, among) {
    const { canvas, camera } = this.view;
    const box = canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
    const ray = new THREE.Raycaster();
    ray.setFromCamera(at, camera.camera);
    const [hit] = ray.intersectObjects(
      among.filter((faces) => faces.triangles > 0).map((faces) => faces.mesh),
    );
    if (!hit) return null;
    const faces = hit.object.userData.faces;
    return { side: faces.body.side, ...faces.at(hit) };
  }
}
