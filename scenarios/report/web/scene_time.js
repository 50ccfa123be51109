// ---- the moment: sliders over steps and over the events of a step, buttons, and playing
class Timeline {
  constructor(events, selection) {
    Object.assign(this, { events, selection });
    this.stepSlider = byId("step");
    this.eventSlider = byId("event");
    this.button = byId("play-events");
    this.playing = 0; // handle of the next tick
    this.measure();
    this.stepSlider.oninput = () => this.go(() => this.toStep(Number(this.stepSlider.value)));
    this.eventSlider.oninput = () =>
      this.go(() => selection.goTo(this.firstHere + Number(this.eventSlider.value)));
    this.button.onclick = () => this.toggle();
    const buttons = {
      "step-back": () => this.byStep(-1),
      "step-next": () => this.byStep(1),
      "event-back": () => this.by(-1),
      "event-next": () => this.by(1),
    };
    for (const [id, action] of Object.entries(buttons)) byId(id).onclick = () => this.go(action);
    selection.listeners.push((what) => {
      if (what === "event") this.show();
    });
  }

  /** Makes the slider as long as there are steps. */
  measure() {
    this.stepSlider.max = this.events.firstOfStep.length - 1;
    byId("step-row").hidden = this.events.firstOfStep.length < 2;
  }

  get step() {
    return this.events.step(this.selection.event);
  }
  get firstHere() {
    return this.events.firstOfStep[this.step];
  }
  get lastHere() {
    return this.events.endOfStep(this.step) - 1;
  }

  /** Does something that a person asked for: playing ends. */
  go(action) {
    this.pause();
    action();
  }
  by(n) {
    this.selection.goTo(this.selection.event + n);
  }
  /** Moves to the end of a step, where its answer is. */
  toStep(step) {
    this.selection.goTo(
      this.events.endOfStep(Math.max(0, Math.min(this.events.firstOfStep.length - 1, step))) - 1,
    );
  }
  byStep(n) {
    this.toStep(this.step + n);
  }
  /** Moves to the next event, or the one before, that passes; stays if there is none. */
  find(passes, way = 1) {
    for (let i = this.selection.event + way; i >= 0 && i < this.events.count; i += way)
      if (passes(i)) return this.selection.goTo(i);
  }
  toChange(way) {
    this.find((i) => this.events.changesWrapper(i) || this.events.kind[i] === this.events.STEP, way);
  }
  toContact(way) {
    this.find((i) => this.events.kind[i] === this.events.CONTACT, way);
  }

  show() {
    const { events, selection } = this;
    this.stepSlider.value = this.step;
    this.eventSlider.max = this.lastHere - this.firstHere;
    this.eventSlider.value = selection.event - this.firstHere;
    const [first, last] = [0, -1].map((at) => digits(events.stepNumbers.at(at)));
    byId("step-count").textContent = `step ${digits(events.stepNumber(selection.event))} (${first}–${last})`;
    const here = digits(selection.event - this.firstHere + 1);
    const all = digits(this.lastHere - this.firstHere + 1);
    const where = events.firstOfStep.length > 1 ? " in this step" : "";
    byId("event-place").textContent = `event ${here} of ${all}${where}`;
  }

  // -- playing: the wrappers of this step are refined, one region after the other; or all events; or the
  // steps
  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }
  pause() {
    clearTimeout(this.playing);
    this.playing = 0;
    this.button.classList.remove("playing");
    this.button.setAttribute("aria-label", "Play");
  }
  play() {
    if (!this.next()) {
      // at the end: from the beginning
      if (byId("play-what").value === "step") this.toStep(0);
      else this.selection.goTo(this.firstHere);
    }
    this.button.classList.add("playing");
    this.button.setAttribute("aria-label", "Pause");
    this.tick();
  }
  tick() {
    this.playing = setTimeout(
      () => {
        const next = this.next();
        if (!next) return this.pause();
        next();
        this.tick();
      },
      1000 / byId("play-speed").value,
    );
  }
  /** Returns what moves on by one; null at the end. */
  next() {
    const what = byId("play-what").value,
      end = this.lastHere;
    if (what === "step") return this.step + 1 < this.events.firstOfStep.length ? () => this.byStep(1) : null;
    const stops = (i) =>
      what === "pass" ? this.events.kind[i] === this.events.PASS_END : this.events.changesWrapper(i);
    for (let i = this.selection.event + 1; i <= end; i++)
      if (what === "event" || i === end || stops(i)) return () => this.selection.goTo(i);
    return null;
  }
}
