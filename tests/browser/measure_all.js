// Opens `pages` one after the other in frames of each of the `sizes`, which measure.js measures; writes down
// its report.
(async function () {
  const lines = document.getElementById("measured");
  const opened = (page, width, height) =>
    new Promise((then) => {
      const frame = document.createElement("iframe"), started = Date.now();
      Object.assign(
          frame.style,
          {border: 0, width: `${width}px`, height: `${height}px`, position: "absolute", top: 0, left: 0});
      const end = (text) => {
        clearTimeout(late);
        removeEventListener("message", hear);
        frame.remove();
        then(text);
      };
      const hear = (e) =>
          e.data && e.data.measured !== undefined && e.source === frame.contentWindow && end(e.data.measured);
      const late = setTimeout(() => end(`FAIL not measured after ${Date.now() - started} ms`), 120000);
      addEventListener("message", hear);
      frame.src = page;
      document.body.append(frame);
    });
  const shown = [];
  for (const page of pages)
    for (const [width, height] of sizes) {
      const text = await opened(page, width, height),
            name = page.split("/").slice(-2).join("/").replace(".measured", "");
      for (const line of text ? text.split("\n") : ["ok"]) shown.push(`${name} at ${width}: ${line}`);
    }
  lines.textContent = `${shown.join("\n")}\ndone\n`;
})();
