// ---- what all pages use: elements, styles, and numbers as text
export const byId = (id) => document.getElementById(id);
export const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
export const digits = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
/** Returns a number with few digits. */
export const rounded = (x, few) => {
  const size = Math.abs(x), isFar = size >= 1e6 || (size > 0 && size < 1e-4),
    text = isFar ? x.toExponential(size < 1 ? few - 1 : 2).replace(/\.?0*e\+?/, "e")
      : String(Number(x.toPrecision(few)));
  return text.replaceAll("-", "\u2212");
};
export const short = (x) => rounded(x, 4);
/** Returns a share in percent, with two digits. */
export const percent = (part, whole) => `${rounded((100 * part) / whole, part === whole ? 3 : 2)} %`;
export const plural = (n, one, many = one + "s") => `${digits(n)} ${n === 1 ? one : many}`;

// The parser names the namespace of pictures, so that pages contain no address.
const SVG = Object.assign(document.createElement("template"),
    { innerHTML: "<svg>" }).content.firstChild.namespaceURI;
const fill = (node, attributes, content) => {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...content);
  return node;
};
/** Makes an element with attributes and content: texts and elements. */
export const element = (tag, attributes = {}, ...content) =>
    fill(document.createElement(tag), attributes, content);
/** As above, of a picture. */
export const svgElement = (tag, attributes = {}, ...content) =>
  fill(document.createElementNS(SVG, tag), attributes, content);

export function textButton(text, action, title = "") {
  const button = element("button", { type: "button", class: "text", title }, text);
  button.onclick = action;
  return button;
}

/** Copies text; returns true on success. `element` contains the text, and is selected if there is no
    clipboard, as on pages from disk. */
export async function copyText(text, element) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    if (element.select) element.select();
    else getSelection().selectAllChildren(element);
    return document.execCommand("copy");
  }
}

/** Takes keys anywhere on the page, except in fields where they have another meaning. `actions`: by
    KeyboardEvent.key; letters are in lower case, shift is passed on. */
export function listenToKeys(actions) {
  document.addEventListener("keydown", (e) => {
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key, { target } = e;
    if (!actions[key] || e.ctrlKey || e.metaKey || e.altKey) return;
    const moves = key.startsWith("Arrow") || /^(Home|End|Page)/.test(key);
    if (target.isContentEditable || target.matches?.("select, textarea")) return;
    if (target.matches?.(moves ? "input" : "input:not([type=range])")) return;
    if (target.closest?.("dialog[open]") && key !== "?") return;
    if ((key === " " || key === "Enter") && target.matches?.("button, summary, a")) return; // it is pressed
    e.preventDefault();
    actions[key](e.shiftKey);
  });
}

/** Playback with a button. `speed`: the field with the moves a second. `next`: returns the function that
    moves on by one; null at the end, where playback begins with `restart`. */
export class Playback {
  constructor(button, speed, next, restart) {
    Object.assign(this, { button, speed, next, restart, timer: 0 });
    button.onclick = () => this.toggle();
  }

  toggle() {
    if (this.timer) return this.pause();
    if (!this.next()) this.restart();
    this.look("Pause");
    this.tick();
  }
  pause() {
    clearTimeout(this.timer);
    this.timer = 0;
    this.look("Play");
  }
  tick() {
    this.timer = setTimeout(() => {
      const next = this.next();
      if (!next) return this.pause();
      next();
      this.tick();
    }, 1000 / this.speed.value);
  }
  look(action) {
    this.button.classList.toggle("playing", action === "Pause");
    this.button.setAttribute("aria-label", action);
  }
}

/** Makes an element act as a button: by a click, Enter or space. */
export function asButton(node, action) {
  node.setAttribute("tabindex", 0);
  node.addEventListener("click", action);
  node.addEventListener("keydown", (e) => {
    if (e.key !== "Enter" && e.key !== " ") return;
    e.preventDefault();
    e.stopPropagation();
    action();
  });
}

/** Makes a row of a table lead somewhere. */
export function linkRow(row, follow) {
  row.className = "leads";
  asButton(row, follow);
}

/** Returns a function that runs `action` at the next frame, once however often it is called until then. */
export function oncePerFrame(action) {
  const soon = () => {
    if (soon.waiting) return;
    soon.waiting = true;
    requestAnimationFrame(() => {
      soon.waiting = false;
      action();
    });
  };
  return soon;
}
