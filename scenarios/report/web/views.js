import { linkRow } from "./dom.js";

// Views of runs side by side: camera and step of one are forwarded to the others.

export const views = [...document.querySelectorAll(".views iframe")];
window.addEventListener("message", (e) => {
  if (!e.data.lrbscope) return;
  for (const view of views) if (view.contentWindow !== e.source) view.contentWindow.postMessage(e.data, "*");
});
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
