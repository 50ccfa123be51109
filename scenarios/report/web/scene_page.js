import { byId, digits, element, oncePerFrame, svgElement, textButton } from "./dom.js";
import { seek } from "./page.js";
import { eventText, lastAtMost, NONE, SIDES } from "./scene_run.js";
import { WORK_SORTS, workSort } from "./scene_work.js";

// ---- the page of a run around its view: tabs, signs of scrolling, the picture of the cost, the address

const TAB_ORDER = "Not as expected,This step,Events,Work,Proof map,Steps,Queries,Charts".split(","),
  LAST_TABS = ["Frames", "Words", "Run"];

/** Fades the edges of a box beyond which it can be scrolled. */
export function showMore(box) {
  box.classList.add("scrolls");
  const mark = () => {
    const slack = 1;
    box.classList.toggle("more-left", box.scrollLeft > slack);
    box.classList.toggle("more-right", box.scrollLeft + box.clientWidth < box.scrollWidth - slack);
    box.classList.toggle("more-below", box.scrollTop + box.clientHeight < box.scrollHeight - slack);
  };
  box.addEventListener("scroll", mark, { passive: true });
  const watch = new ResizeObserver(oncePerFrame(mark));
  for (const part of [box, ...box.children]) watch.observe(part);
  return mark;
}

/** The parts of the page below the view, one at a time, closed until used. Without scripts, and in print,
    they follow each other. */
export class Tabs {
  constructor() {
    const groups = new Map();
    for (const part of document.querySelectorAll(".tab")) {
      const { tab } = part.dataset;
      groups.set(tab, [...(groups.get(tab) || []), part]);
    }
    const place = (name) => {
      const first = TAB_ORDER.indexOf(name), last = LAST_TABS.indexOf(name);
      return first >= 0 ? first : last >= 0 ? 1000 + last : TAB_ORDER.length;
    };
    this.names = [...groups.keys()]
      .filter((name) => groups.get(name).some((part) => [...part.children].some((child) => !child.hidden)))
      .sort((p, q) => place(p) - place(q));
    for (const [name, parts] of groups)
      if (!this.names.includes(name)) for (const part of parts) part.remove();
    this.listeners = [];
    this.bar = element("div", { class: "tab-bar", role: "tablist" });
    this.body = element("div", { class: "tab-body" });
    this.buttons = new Map();
    this.panels = new Map();
    this.names.forEach((name, i) => this.add(name, groups.get(name), i));
    this.taller = textButton("taller", () => this.toggleHeight(), "Tables and charts higher, view lower (T)");
    this.taller.classList.add("taller");
    const head = element("div", { class: "tab-head" }, this.bar, this.taller);
    byId("scene").append(element("section", { class: "tabs" }, head, this.body));
    this.panels.get("Run")?.append(document.querySelector("footer"));
    document.documentElement.classList.add("instrument");
    this.bar.addEventListener("keydown", (e) => {
      const way = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
      if (!way) return;
      e.preventDefault();
      e.stopPropagation();
      const at = this.names.indexOf(document.activeElement.textContent) + way + this.names.length;
      this.show(this.names[at % this.names.length]);
      this.buttons.get(this.shown).focus();
    });
    this.marks = [this.bar, this.body, ...this.body.querySelectorAll(".scroll, .charts, .event-rows")]
        .map(showMore);
    if (byId("frames")) byId("frames").open = true;
    this.show("");
  }

  add(name, parts, i) {
    const id = `tab-${i}`,
      button = element("button", { type: "button", id, role: "tab", title: i < 9 ? `Key ${i + 1}` : "" },
          name),
      panel = element("div", { class: "tab-panel", role: "tabpanel", "aria-labelledby": id }, ...parts);
    button.onclick = () => this.toggle(name);
    this.bar.append(button);
    this.body.append(panel);
    this.buttons.set(name, button);
    this.panels.set(name, panel);
  }

  has(name) {
    return this.panels.has(name);
  }
  /** Opens a tab, or closes it. */
  toggle(name) {
    this.show(this.shown === name ? "" : name);
  }
  /** Opens a tab; "": closes the open one. */
  show(name) {
    if (name && !this.has(name)) return;
    this.shown = name;
    byId("scene").classList.toggle("open", name !== "");
    this.taller.hidden = this.body.hidden = name === "";
    for (const [other, button] of this.buttons) {
      const is = other === name;
      button.setAttribute("aria-selected", is);
      button.tabIndex = is || (!name && other === this.names[0]) ? 0 : -1;
      this.panels.get(other).hidden = !is;
    }
    this.body.scrollTop = this.body.scrollLeft = 0;
    const { bar } = this, button = this.buttons.get(name || this.names[0]);
    const right = button.offsetLeft + button.offsetWidth;
    if (button.offsetLeft < bar.scrollLeft || right > bar.scrollLeft + bar.clientWidth)
      bar.scrollLeft = button.offsetLeft - 24;
    for (const mark of this.marks || []) mark();
    for (const listener of this.listeners) listener();
  }

  get tall() {
    return byId("scene").classList.contains("tall");
  }
  toggleHeight() {
    if (!this.shown) this.show(this.names[0]);
    byId("scene").classList.toggle("tall");
    this.taller.textContent = this.tall ? "lower" : "taller";
    for (const listener of this.listeners) listener();
  }
}

/** The tooltip of a number in a table: its row and column, and the meaning of the column. */
export function explainCells() {
  document.addEventListener("pointerover", (e) => {
    const cell = e.target.closest && e.target.closest("td");
    if (!cell || cell.title || cell.closest(".why")) return;
    const row = cell.parentElement, head = row.closest("table").tHead?.rows[0].cells[cell.cellIndex];
    if (!head) return;
    const meaning = head.title ? `: ${head.title}` : "",
      first = cell.cellIndex > 0
          ? `, ${row.closest("table").tHead.rows[0].cells[0].textContent} ${row.cells[0].textContent}` : "";
    cell.title = `${head.textContent}${first}${meaning}`;
  });
}

/** Puts the view into print as it is on the screen. */
export function printView(view) {
  const picture = new Image();
  picture.className = "printed";
  picture.alt = "";
  byId("view-canvas").after(picture);
  window.addEventListener("beforeprint", () => {
    view.draw(); // the drawing buffer keeps its content until this task ends
    picture.src = view.canvas.toDataURL();
  });
}

// ---- at the top: what each step cost, and when the bodies meet; of a single body, how many faces it shows
export class CostStrip {
  /** `unit`: counted in the bars. `bars`: [{values, words, go}] with a value for each of `sorts`, [{name,
      colour}]; `contactStep`: index of the bar of the first contact; -1: none. */
  constructor({ title, unit, sorts, bars, contactStep = -1 }) {
    Object.assign(this, { title, unit, sorts, bars, contactStep, at: 0 });
    if (bars.length < 2) return;
    this.box = element("div", { class: "strip" });
    document.querySelector("header").append(this.box);
    this.draw();
  }

  draw() {
    const { bars, sorts, box } = this,
      [width, height] = [1000, 100], // stretched to the place
      sum = (b) => b.values.reduce((n, v) => n + v, 0),
      most = Math.max(1, ...bars.map(sum)),
      label = `${this.title}; a click selects one`,
      viewBox = `0 0 ${width} ${height}`,
      svg = svgElement("svg", { viewBox, preserveAspectRatio: "none", role: "img", "aria-label": label }),
      step = width / bars.length,
      contact = this.contactStep * step;
    bars.forEach((bar, i) => {
      let top = height;
      const shown = sorts.map((s, k) => ({ ...s, value: bar.values[k] })).filter(({ value }) => value > 0),
        parts = shown.map(({ colour, value }) => {
          const h = (value / most) * 0.92 * height;
          top -= h;
          const place = { x: i * step, y: top, width: 0.88 * step, height: h };
          return svgElement("rect", { ...place, style: `fill: ${colour}` });
        }),
        words = `${bar.words}: ${shown.map((s) => `${digits(s.value)} ${s.name}`).join(", ")}`,
        hit = svgElement("rect", { x: i * step, y: 0, width: step, height, class: "hit" });
      const group = svgElement("g", { class: "bar" }, svgElement("title", {}, words), hit, ...parts);
      group.addEventListener("click", bar.go);
      svg.append(group);
    });
    if (this.contactStep > 0)
      svg.append(svgElement("line", { x1: contact, x2: contact, y2: height, class: "contact" }));
    this.cursor = svgElement("rect", { y: 2, height: height - 4, width: Math.max(3, step), class: "cursor" });
    svg.append(this.cursor);
    const words = element("p", { title: `${this.title}; a click on a bar selects it` },
        `up to ${digits(most)} ${this.unit}`);
    const addKey = (name) => {
      const dot = element("i");
      words.append(element("span", {}, dot, name));
      return dot;
    };
    sorts.forEach((s, k) => {
      if (sorts.length > 1 && bars.some((b) => b.values[k] > 0)) addKey(s.name).style.background = s.colour;
    });
    if (this.contactStep > 0) addKey("first contact").className = "contact";
    box.replaceChildren(svg, words);
    this.mark(this.at);
  }

  /** Marks a bar; -1: none. */
  mark(at) {
    this.at = at;
    if (!this.cursor) return;
    this.cursor.style.visibility = at < 0 ? "hidden" : "";
    this.cursor.setAttribute("x", at < 0 ? 0 : (1000 * at) / this.bars.length);
  }
}

/** Returns the picture of the cost of a run of two bodies, or of one. */
export function stripOfRun(scene, events, selection, ofStep) {
  const parts = scene.work && !events.passes ? barsOfSteps(ofStep) : barsOfFaces(events, selection),
    { bars } = parts,
    at = () => bars[0].step === undefined ? lastAtMost(bars.map((b) => b.event), selection.event)
        : bars.findIndex((b) => b.step === events.stepNumber(selection.event));
  const strip = new CostStrip({
    ...parts,
    contactStep: scene.firstContact >= 0
        ? bars.findIndex((b) => b.step === events.stepNumber(events.at(scene.firstContact))) : -1,
  });
  if (bars.length) selection.on("event", () => strip.mark(at()));
  return strip;
}

/** A bar for each step, divided by sorts of work. */
function barsOfSteps(ofStep) {
  const bars = [...ofStep].map(([step, outcomes]) => {
    const values = WORK_SORTS
        .map((sort) => outcomes.reduce((n, o) => n + (workSort(o) === sort ? o.operations : 0), 0));
    return { step, values, words: `step ${digits(step)}`, go: () => seek("step", step) };
  });
  return { title: "operations in each step", unit: "operations", sorts: WORK_SORTS, bars };
}

/** A bar for each pass of a construction, or each refinement. */
function barsOfFaces(events, selection) {
  const ends = [...events.kind.keys()]
      .filter((i) => (events.passes ? events.kind[i] === events.PASS_END : events.changesWrapper(i)));
  const bars = ends.map((i) => ({
    event: i,
    values: [events.boundary[i]],
    words: eventText(events, i),
    go: () => selection.goTo(i),
  }));
  return {
    title: events.passes ? "faces of the front after each pass"
        : "faces of the wrapper after each refinement",
    unit: "faces",
    sorts: [{ name: "faces", colour: "var(--work-boxes)" }],
    bars: events.bodies.length > 1 ? [] : bars,
  };
}

// ---- the state of the page in its address, so that a view can be linked:
// #e59&tab=Charts&pick=A.face.12&camera=perspective,EYE,TARGET&show=ghost,boxes:3
export class PageAddress {
  constructor({ events, selection, view, controls, tabs }) {
    Object.assign(this, { events, selection, view, controls, tabs });
    this.timer = 0;
    selection.listeners.push(() => this.later());
    tabs.listeners.push(() => this.later());
    if (view) view.camera.controls.addEventListener("change", () => this.later());
    window.addEventListener("hashchange", () => this.read());
  }

  /** Writes the state once nothing has changed for a moment. */
  later() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => history.replaceState(null, "", `#${this.text()}`), 300);
  }

  text() {
    const { events, selection, view, tabs } = this, parts = [`e${events.id(selection.event)}`],
      { picked, chosen } = selection;
    if (tabs.shown) parts.push(`tab=${encodeURIComponent(tabs.shown)}`);
    const sort = picked && ["vertex", "face", "region"].find((s) => picked[s] !== NONE);
    if (picked) parts.push(`pick=${SIDES[picked.side]}.${sort}.${picked[sort]}`);
    if (chosen.every((s) => s !== NONE)) parts.push(`pair=${chosen.join(",")}`);
    if (view && !view.camera.fitted) {
      const { projection, eye, target } = view.camera.json();
      const numbers = [...eye, ...target].map((x) => Number(x.toPrecision(6)));
      parts.push(`camera=${[projection, ...numbers].join(",")}`);
    }
    const show = view ? this.layers() : [];
    if (tabs.tall) show.push("tall");
    if (show.length) parts.push(`show=${show.join(",")}`);
    return parts.join("&");
  }

  /** Returns what differs from the view as it opens. */
  layers() {
    const { now, opened, camera } = this.view, out = [];
    for (const name of Object.keys(opened)) {
      if (now[name] === opened[name]) continue;
      if (name === "isolate") out.push(`isolate:${SIDES[now.isolate.side]}.${now.isolate.region}`);
      else out.push(now[name] === true ? name : now[name] === false ? `no-${name}` : `${name}:${now[name]}`);
    }
    if (camera.fitted && camera.orthographic && !camera.plane) out.push("orthographic");
    return out;
  }

  /** Takes the state from the address. Unknown parts are ignored. Returns true if it has an event. */
  read() {
    const { events, selection, view, controls, tabs } = this,
      [first, ...rest] = location.hash.slice(1).split("&"),
      value = Object.fromEntries(rest.map((part) => part.split("=").map(decodeURIComponent))),
      event = /^e(\d+)$/.exec(first);
    if (event) selection.goTo(events.at(Number(event[1])));
    if (value.tab) tabs.show(value.tab);
    const pick = /^([AB])\.(face|region|vertex)\.(\d+)$/.exec(value.pick || "");
    if (pick) this.pick(SIDES.indexOf(pick[1]), pick[2], Number(pick[3]));
    const pair = (value.pair || "").split(",").map(Number);
    if (pair.length === 2 && this.exist(pair)) selection.choose(pair);
    const show = (value.show || "").split(",").filter(Boolean);
    if (show.includes("tall") !== tabs.tall) tabs.toggleHeight();
    if (view) this.show(show, controls);
    if (view && value.camera) this.look(value.camera.split(","));
    return Boolean(event);
  }

  exist(pair) {
    return pair.every((s, side) => {
      const body = this.events.bodies[side];
      return body && body.complete && s < body.firstSimplex.at(-1);
    });
  }

  pick(side, sort, number) {
    const body = this.events.bodies[side];
    if (!body || !body.complete) return;
    if (sort === "face" && number < body.faceCount) this.selection.pickFace(side, number);
    if (sort === "region" && number < body.regionCount) this.selection.pickRegion(side, number);
    if (sort === "vertex" && this.events.attempts && number < body.vertices.length / 3)
      this.selection.pickVertex(side, number);
  }

  show(words, controls) {
    const change = { ...this.view.opened };
    for (const word of words) {
      const [name, text] = word.split(":"), plain = name.replace(/^no-/, "");
      const isolate = /^([AB])\.(\d+)$/.exec(text || "");
      if (name === "isolate" && isolate)
        change.isolate = { side: SIDES.indexOf(isolate[1]), region: Number(isolate[2]) };
      else if (typeof change[plain] === "boolean") change[plain] = plain === name;
      else if (typeof change[name] === "number" && Number.isFinite(Number(text))) change[name] = Number(text);
      else if (typeof change[name] === "string" && text) change[name] = text;
    }
    const body = change.isolate && this.events.bodies[change.isolate.side];
    if (change.isolate && !(body && change.isolate.region < body.regionCount
        && body.hasLids(change.isolate.region))) change.isolate = null;
    controls.change(change);
    if (words.includes("orthographic") && !this.view.camera.orthographic) controls.orthographic();
  }

  look([projection, ...numbers]) {
    const values = numbers.map(Number);
    if (values.length !== 6 || !values.every(Number.isFinite)) return;
    this.view.camera.set({ projection, eye: values.slice(0, 3), target: values.slice(3) });
    this.view.redraw();
  }
}
