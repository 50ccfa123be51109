// ---- the same view beside another run's, in a page that compares them (index.html?alone in a frame): one camera, one step
class Together {
  constructor(view, selection, events) {
    this.view = view;
    this.selection = selection;
    this.events = events;
    this.listening = false; // to what the other view does: not to be told back
    document.documentElement.classList.add("alone");
    view.camera.controls.addEventListener("change", () => this.tell({ camera: view.camera.json() }));
    selection.listeners.push((what) => what === "event" && this.tell({ step: this.step }));
    window.addEventListener("message", (e) => e.source === parent && e.data.lrbscope && this.hear(e.data.lrbscope));
    this.tell({ camera: view.camera.json(), step: this.step }); // the view that comes last sets both
  }

  get step() {
    return this.events.stepNumber(this.selection.event);
  }

  tell(what) {
    if (!this.listening) parent.postMessage({ lrbscope: what }, "*");
  }

  hear({ camera, step }) {
    this.listening = true;
    if (camera) this.view.camera.set(camera);
    if (step !== undefined && step !== this.step) seek("step", step);
    this.listening = false;
  }
}
