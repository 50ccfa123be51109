// ---- in the view: how far apart the bodies are in the step on show, and how B leaves A where they overlap
class MeasuredMarks {
  /** `measured`: as the page has it; null: the run did not ask. */
  constructor(view, measured) {
    Object.assign(this, { view, group: new THREE.Group(), shown: null });
    this.ofStep = new Map(); // by number: {wayOut, from, to, words}
    if (measured) {
      const ends = unpack(measured.ends),
        wayOut = unpack(measured.wayOut),
        at = (i) => new THREE.Vector3(...ends.subarray(i, i + 3));
      unpack(measured.step).forEach((step, i) =>
        this.ofStep.set(step, { wayOut: wayOut[i] === 1, from: at(6 * i), to: at(6 * i + 3), words: measured.words[i] }),
      );
    }
    view.stage.add(this.group);
  }

  /** Makes the lines anew where the step has changed. */
  draw() {
    const { events, selection, legend, colours } = this.view,
      now = this.ofStep.get(events.stepNumber(selection.event)) || null;
    if (now === this.shown) return;
    this.shown = now;
    for (const object of this.group.children.slice()) discard(this.group, object);
    if (now) {
      const colour = now.wayOut ? colours.wayOut : colours.ink;
      this.addLines(now.wayOut ? arrowOf(now.from, now.to, events.dim) : [now.from, now.to], colour);
    }
    const wayOut = [colours.wayOut, "B leaves A this way"],
      gap = [colours.ink, "between the nearest points of the bodies", WHITE];
    legend.also(now ? [now.wayOut ? wayOut : gap] : [], "measured");
  }

  /** A pale line under each, so that they are seen on bodies of any colour. */
  addLines(points, colour) {
    const ends = points.flatMap((p) => p.toArray());
    for (const [c, width, order] of [
      [WHITE, 7, 8],
      [colour, 3.5, 9],
    ]) {
      const lines = thickLines(ends, thickMaterial(c, width, this.view.size));
      lines.renderOrder = order;
      this.group.add(lines);
    }
  }

  /** Writes the length over the middle of the way, or under it where there is no room. */
  write() {
    const label = byId("measured"),
      { shown, view } = this;
    label.hidden = !shown;
    if (!shown) return;
    const at = shown.from.clone().add(shown.to).multiplyScalar(0.5).project(view.camera.camera);
    label.hidden = Math.abs(at.x) > 1 || Math.abs(at.y) > 1 || at.z > 1;
    if (label.hidden) return;
    label.textContent = shown.words;
    const { x: width, y: height } = view.size,
      half = label.offsetWidth / 2 + 4,
      y = (height * (1 - at.y)) / 2,
      off = 14;
    label.style.left = `${Math.max(half, Math.min(width - half, (width * (1 + at.x)) / 2))}px`;
    label.style.top = `${y > label.offsetHeight + off ? y - label.offsetHeight - off : y + off}px`;
  }
}

/** Returns the ends of an arrow's lines. */
function arrowOf(from, to, dim) {
  const along = to.clone().sub(from),
    length = along.length(),
    n = along.clone().normalize(),
    across = dim === 2 ? new THREE.Vector3(0, 0, 1).cross(n) : new THREE.Vector3(Math.abs(n.x) < 0.6 ? 1 : 0, Math.abs(n.x) < 0.6 ? 0 : 1, 0).cross(n);
  across.setLength(0.11 * length);
  const sides = [across, across.clone().negate()];
  if (dim === 3) for (const s of sides.slice()) sides.push(n.clone().cross(s));
  const back = to.clone().addScaledVector(along, -0.24);
  return [from, to, ...sides.flatMap((side) => [back.clone().add(side), to])];
}
