// ---- what all views show: one event, and perhaps a face or a region. Views change it here and are told
// by their listeners.
class Selection {
  constructor(events) {
    this.events = events;
    this.event = 0;
    // {side, face, region}: face NONE: a region as a whole; region NONE: a face that no region hides.
    this.picked = null;
    this.chosen = [NONE, NONE]; // simplices of A and B that were picked one after the other
    this.listeners = [];
  }

  tell(what) {
    for (const listener of this.listeners) listener(what);
  }

  /** Moves to an event, by its index, where frames and charts stand already. */
  standAt(event) {
    this.event = Math.max(0, Math.min(this.events.count - 1, event));
    this.chosen = [NONE, NONE];
    this.tell("event");
  }
  /** Moves to an event; frames and charts follow. */
  goTo(event) {
    this.standAt(event);
    showEvent(this.events.id(this.event), this.events.stepNumber(this.event));
  }

  /** `simplex`: the one of the face that is meant; without it the first. */
  pickFace(side, face, simplex) {
    const body = this.events.bodies[side],
      meant = simplex === undefined ? body.firstSimplex[face] : simplex;
    this.chosen = this.chosen.map((s, i) => (i !== side ? s : body.isReal(face) ? meant : NONE));
    this.pickOnly({ side, face, region: body.regionOf(face) });
  }
  pickRegion(side, region) {
    this.pick({ side, face: NONE, region });
  }
  /** Picks a simplex of A and one of B. */
  choose(simplices) {
    this.chosen = simplices.slice();
    this.pickOnly(null);
  }
  pick(picked) {
    this.chosen = [NONE, NONE];
    this.pickOnly(picked);
  }
  pickOnly(picked) {
    this.picked = picked;
    this.tell("pick");
  }
}
