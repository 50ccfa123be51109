import { copyText, textButton } from "./dom.js";

// Sheets of the grid: opened by the address, so that they can be linked to; the arrow keys step through them.
const sheets = [...document.querySelectorAll("dialog.detail")];
const opened = () => sheets.find((s) => s.open);
const leave = () => history.pushState(null, "", location.pathname + location.search);
function follow() {
  const wanted = sheets.find((s) => "#" + s.id === location.hash);
  for (const s of sheets) if (s !== wanted && s.open) s.close();
  if (wanted && !wanted.open) { wanted.showModal(); wanted.scrollTop = 0; }
}
for (const s of sheets) {
  s.addEventListener("cancel", leave); // Escape
  s.addEventListener("click", (e) => { if (e.target === s) { s.close(); leave(); } }); // beside the sheet
  s.querySelector(".close").addEventListener("click", (e) => { e.preventDefault(); s.close(); leave(); });
}
document.addEventListener("keydown", (e) => {
  const at = sheets.indexOf(opened()), step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
  if (at < 0 || !step || e.ctrlKey || e.metaKey || e.altKey) return;
  location.replace("#" + sheets[(at + step + sheets.length) % sheets.length].id);
});
addEventListener("hashchange", follow);
addEventListener("popstate", follow);
follow();

for (const block of document.querySelectorAll("pre.command")) {
  const code = block.querySelector("code"), button = textButton("Copy", async () => {
    if (!(await copyText(code.textContent, code))) return;
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = "Copy"; }, 1500);
  });
  button.classList.add("copy");
  block.prepend(button);
}
