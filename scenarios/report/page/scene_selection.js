// ---- what all views show: one event, and perhaps a face or a region. Views change it here and are told
// by their listeners.
class Selection {
  constructor(events) {
    this.events = events;
    this.event = 0;
    // {side, face, region}: face NONE: a region as a whole; region NONE: a face that no region hides.
    this.picked = null;
    this.listeners = [];
  }

  tell(what) {
    for (const listener of this.listeners) listener(what);
  }

  /** Moves to an event, by its index, where frames and charts stand already. */
  standAt(event) {
    this.event = Math.max(0, Math.min(this.events.count - 1, event));
    this.tell("event");
  }
  /** Moves to an event; frames and charts follow. */
  goTo(event) {
    this.standAt(event);
    showEvent(this.events.id(this.event), this.events.stepNumber(this.event));
  }

  pickFace(side, face) {
    this.pick({ side, face, region: this.events.bodies[side].regionOf(face) });
  }
  pickRegion(side, region) {
    this.pick({ side, face: NONE, region });
  }
  pick(picked) {
    this.picked = picked;
    this.tell("pick");
  }
}
