// ---- what all pages use: elements, styles, and numbers as text
export const byId = (id) => document.getElementById(id);
export const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
export const digits = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
/** Returns a number with few digits. */
export const rounded = (x, few) => {
  const text = Math.abs(x) >= 1e6 ? x.toExponential(2) : String(Number(x.toPrecision(few)));
  return text.replace("e+", "e").replace("-", "\u2212");
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

/** Makes a row of a table lead somewhere: by a click, or by Enter. */
export function linkRow(row, follow) {
  row.className = "leads";
  row.tabIndex = 0;
  row.addEventListener("click", follow);
  row.addEventListener("keydown", (e) => {
    if (e.key !== "Enter") return;
    e.preventDefault();
    follow();
  });
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
