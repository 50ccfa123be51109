// Views of runs side by side: what one is told of camera and step, the others are told, too.
const views = [...document.querySelectorAll(".views iframe")];
window.addEventListener("message", (e) => {
  if (!e.data.lrbscope) return;
  for (const view of views) if (view.contentWindow !== e.source) view.contentWindow.postMessage(e.data, "*");
});
