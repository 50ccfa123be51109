import { element, linkRow, percent, textButton } from "./dom.js";

// Views of runs side by side: camera and step of one are forwarded to the others.

export const views = [...document.querySelectorAll(".views iframe")];
window.addEventListener("message", (e) => {
  const what = e.data?.lrbscope, from = views.findIndex((view) => view.contentWindow === e.source);
  if (!what || from < 0) return;
  if ("map" in what) maps[from] = what.map;
  if ("map" in what) drawDifference();
  else if (!what.hasMap) tell(what, from);
  else if (withMap.add(from).size === views.length) addMaps();
});
function tell(what, from) {
  views.forEach((view, i) => i !== from && view.contentWindow.postMessage({ lrbscope: what }, "*"));
}

// Proof maps of two runs instead of their bodies, and under them where the two squares differ.
const withMap = new Set(), maps = [], title = "Where the maps differ",
  canvas = element("canvas", { role: "img", "aria-label": title }), share = element("p", { class: "note" }),
  box = element("div", { class: "maps", hidden: "" }, element("h3", {}, title), canvas, share);
function addMaps() {
  if (box.isConnected) return tell({ mapping: !box.hidden }); // a frame was loaded again
  const section = document.querySelector(".views"),
    button = textButton("proof maps", () => {
      box.hidden = !box.hidden;
      button.setAttribute("aria-pressed", !box.hidden);
      tell({ mapping: !box.hidden });
    }, "Show which test rejected which pairs of faces, of both");
  button.setAttribute("aria-pressed", false);
  section.querySelector("h2").after(button);
  section.append(box);
}
/** Draws the second map where it differs from the first, and the rest pale; without two, nothing. */
function drawDifference() {
  canvas.width = canvas.width; // clears it
  share.textContent = "";
  if (!maps[0] || maps[0].length !== maps[1]?.length) return;
  const size = Math.sqrt(maps[0].length), image = new ImageData(size, size),
    out = new Uint32Array(image.data.buffer);
  let differ = 0;
  maps[1].forEach((colour, i) => {
    const same = colour === maps[0][i];
    out[i] = same ? (colour & 0xffffff) | 0x20000000 : colour;
    differ += !same;
  });
  canvas.width = canvas.height = size;
  canvas.getContext("2d").putImageData(image, 0, 0);
  share.textContent = `${percent(differ, out.length)} of the shown part, in the colours of the second run.`;
}
// A row "regions 3 5" of a table selects region 3 in the first view and 5 in the second; "-": none.
for (const row of document.querySelectorAll('tr[data-to^="regions "]')) {
  const numbers = row.dataset.to.split(" ").slice(1);
  const follow = () => {
    for (const other of document.querySelectorAll("tr[aria-current]")) other.removeAttribute("aria-current");
    row.setAttribute("aria-current", "true");
    numbers.forEach((n, i) =>
        views[i].contentWindow.postMessage({ lrbscope: { region: n === "-" ? null : Number(n) } }, "*"));
    views[0].scrollIntoView({ block: "nearest" });
  };
  linkRow(row, follow);
}
