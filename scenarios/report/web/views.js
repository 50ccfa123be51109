// Views of runs side by side: camera and step of one are forwarded to the others.
const views = [...document.querySelectorAll(".views iframe")];
window.addEventListener("message", (e) => {
  if (!e.data.lrbscope) return;
  for (const view of views) if (view.contentWindow !== e.source) view.contentWindow.postMessage(e.data, "*");
});
