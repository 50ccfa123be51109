// ---- the camera. The same as a scenario's: perspective over 0.6 radians, or orthographic.
export const FIELD = 0.6; // radians from bottom to top, as in render/include/lrbscope/render/camera.hpp
const VIEW_FROM = [0.62, -0.68, 0.42]; // and the default view direction of frames

export class SceneCamera {
  /** `scene` gives the page's frame (origin and unit: x_world = origin + unit * x), and the frames'
      viewpoint (view: from, up, orthographic; null: not given). */
  constructor(canvas, scene, changed) {
    this.frame = scene;
    this.perspective = new THREE.PerspectiveCamera((FIELD * 180) / Math.PI, 1, 0.01, 100);
    this.flat = new THREE.OrthographicCamera(-1, 1, 1, -1, -100, 100);
    this.camera = this.perspective;
    this.plane = scene.dim === 2; // seen from above, without rotation
    const { from, up, orthographic } = scene.view || { from: VIEW_FROM, up: [0, 0, 1], orthographic: false };
    this.from = this.plane ? [0, 0, 1] : from;
    this.up = this.plane ? new THREE.Vector3(0, 1, 0) : new THREE.Vector3(...up).normalize();
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.5);
    this.lamp.position.set(-0.4, 0.7, 1);
    for (const camera of [this.perspective, this.flat]) camera.up.copy(this.up);
    this.camera.add(this.lamp);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    if (this.plane) {
      this.controls.enableRotate = false;
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
      this.perspective.position.set(0, 0, 1);
      this.setOrthographic(true);
    }
    if (orthographic && !this.plane) {
      this.perspective.position.set(...this.from);
      this.setOrthographic(true);
    }
    this.controls.enableZoom = false; // until the view has the focus: the wheel scrolls the page
    canvas.addEventListener("focus", () => { this.controls.enableZoom = true; });
    canvas.addEventListener("blur", () => { this.controls.enableZoom = false; });
    canvas.addEventListener(
      "touchstart",
      () => { this.controls.enableZoom = true; },
      { passive: true, capture: true },
    );
    this.controls.addEventListener("change", changed);
    this.fitted = false; // true after fit(): the view is refitted to a resized window
    this.controls.addEventListener("start", () => { this.fitted = false; });
  }

  get orthographic() {
    return this.camera === this.flat;
  }
  get distance() {
    return this.camera.position.distanceTo(this.controls.target);
  }

  resize(width, height) {
    this.aspect = width / height;
    this.perspective.aspect = this.aspect;
    this.flat.left = -this.aspect;
    this.flat.right = this.aspect;
    this.perspective.updateProjectionMatrix();
  }

  /** Called before drawing: updates the range of depths to the distance. `slice`: the share of the bodies'
      depth, a ball of this centre and radius, that is cut away in front. */
  prepare({ centre, radius }, slice) {
    const d = this.distance;
    this.camera.updateMatrixWorld();
    const ahead = -centre.clone().applyMatrix4(this.camera.matrixWorldInverse).z,
      cut = slice > 0 ? ahead + (2 * slice - 1) * radius : -Infinity;
    this.perspective.near = Math.max(d / 500, d - 4 * radius, cut);
    this.perspective.far = d + 6 * radius;
    this.flat.near = Math.max(-6 * radius, cut);
    this.flat.far = d + 6 * radius;
    this.camera.updateProjectionMatrix();
  }

  /** Looks at a ball from the current direction. */
  lookAt(centre, radius) {
    this.fitted = false;
    const way = this.camera.position.clone().sub(this.controls.target);
    const least = Math.min(1, this.aspect), half = FIELD / 2;
    const d = radius / Math.sin(Math.atan(Math.tan(half) * least));
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(way.normalize(), d);
    this.flat.zoom = 1 / (d * Math.tan(half));
    this.controls.update();
  }

  /** Shows all points as large as possible, from the current or a given direction; as in
      render/include/lrbscope/render/camera.hpp. */
  fit(points, from) {
    this.fitted = true;
    const out = (
      from ? new THREE.Vector3(...from) : this.camera.position.clone().sub(this.controls.target)
    ).normalize();
    const right = this.up.clone().cross(out).normalize(), up = out.clone().cross(right),
      slopeY = 0.94 * Math.tan(FIELD / 2),
      slopeX = slopeY * this.aspect, // the other axis is free
      most = { right: -Infinity, left: -Infinity, top: -Infinity, bottom: -Infinity, near: -Infinity,
          far: Infinity };
    for (const p of points) {
      const [x, y, z] = [p.dot(right), p.dot(up), p.dot(out)];
      // moving towards the eye moves a point away from the centre
      most.right = Math.max(most.right, x + slopeX * z);
      most.left = Math.max(most.left, -x + slopeX * z);
      most.top = Math.max(most.top, y + slopeY * z);
      most.bottom = Math.max(most.bottom, -y + slopeY * z);
      most.near = Math.max(most.near, z);
      most.far = Math.min(most.far, z);
    }
    const centre = right.multiplyScalar((most.right - most.left) / 2)
        .addScaledVector(up, (most.top - most.bottom) / 2),
      depth = Math.max((most.right + most.left) / 2 / slopeX, (most.top + most.bottom) / 2 / slopeY,
          most.near + 1e-6);
    this.controls.target.copy(centre).addScaledVector(out, (most.near + most.far) / 2);
    this.camera.position.copy(centre).addScaledVector(out, depth);
    this.flat.zoom = 1 / (this.distance * Math.tan(FIELD / 2));
    this.controls.update();
  }

  /** Zooms by a factor; above 1: closer. */
  zoom(factor) {
    this.fitted = false;
    this.camera.position.sub(this.controls.target).divideScalar(factor).add(this.controls.target);
    this.flat.zoom *= factor;
    this.controls.update();
  }

  /** Rotates about the target, in radians. */
  turn(azimuth, elevation) {
    if (this.plane) return;
    this.fitted = false;
    const upright = new THREE.Quaternion().setFromUnitVectors(this.up, new THREE.Vector3(0, 1, 0));
    const s = new THREE.Spherical().setFromVector3(
      this.camera.position.clone().sub(this.controls.target).applyQuaternion(upright),
    );
    s.theta += azimuth;
    s.phi = Math.max(0.01, Math.min(Math.PI - 0.01, s.phi - elevation));
    this.camera.position
      .setFromSpherical(s)
      .applyQuaternion(upright.inverse())
      .add(this.controls.target);
    this.controls.update();
  }

  /** Returns half the height of an orthographic camera's view. */
  get halfHeight() {
    return this.orthographic ? 1 / this.flat.zoom : this.distance * Math.tan(FIELD / 2);
  }

  setOrthographic(on) {
    const half = this.halfHeight, next = on ? this.flat : this.perspective;
    next.position.copy(this.camera.position);
    if (!on)
      next.position
        .sub(this.controls.target)
        .setLength(half / Math.tan(FIELD / 2))
        .add(this.controls.target);
    this.flat.zoom = 1 / half;
    next.add(this.lamp);
    this.camera = this.controls.object = next;
    this.controls.update();
    this.controls.dispatchEvent({ type: "change" }); // update() only does so if the camera has moved
  }

  /** Sets the camera from json() of another view. */
  set({ projection, eye, target }) {
    this.fitted = false;
    const { origin, unit } = this.frame,
      local = (x) => new THREE.Vector3(...x.map((v, i) => (v - origin[i]) / unit));
    if ((projection === "orthographic") !== this.orthographic) this.setOrthographic(!this.orthographic);
    this.controls.target.copy(local(target));
    this.camera.position.copy(local(eye));
    this.flat.zoom = 1 / (this.distance * Math.tan(FIELD / 2));
    this.controls.update();
  }

  /** Returns the camera as a view of a scenario's frames ("views", scenario.schema.json). */
  json() {
    const { origin, unit } = this.frame, target = this.controls.target;
    // An orthographic camera of a scenario shows as much as a perspective one would at its target.
    const eye = target.clone().add(
      this.camera.position
        .clone()
        .sub(target)
        .setLength(this.halfHeight / Math.tan(FIELD / 2)),
    );
    const world = (v) => v.toArray().map((x, i) => Number((origin[i] + unit * x).toPrecision(9)));
    return {
      camera: "fixed", projection: this.orthographic ? "orthographic" : "perspective", eye: world(eye),
      target: world(target), up: this.up.toArray(),
    };
  }
}
