// Comparisons: each has its own display mode; dragging over a swiped picture moves the edge.
for (const section of document.querySelectorAll(".comparison")) {
  const pictures = section.querySelector(".pictures"), slider = section.querySelector(".modes input");
  if (!slider) continue; // there is one picture only
  const buttons = [...section.querySelectorAll(".modes button")];
  const swipe = (percent) => {
    slider.value = percent;
    pictures.style.setProperty("--at", `${Math.max(0, Math.min(100, percent))}%`);
  };
  const look = (mode) => {
    pictures.dataset.mode = mode;
    section.classList.toggle("swiping", mode === "swipe");
    if (mode === "swipe") pictures.classList.remove("full");
    for (const b of buttons) b.setAttribute("aria-pressed", String(b.dataset.mode === mode));
  };
  for (const b of buttons) b.onclick = () => look(b.dataset.mode);
  slider.oninput = () => swipe(Number(slider.value));
  const drag = (e) => {
    if (pictures.dataset.mode !== "swipe" || !(e.buttons & 1)) return;
    const box = pictures.querySelector(".expected").getBoundingClientRect();
    swipe((100 * (e.clientX - box.left)) / box.width);
  };
  pictures.addEventListener("pointerdown", drag);
  pictures.addEventListener("pointermove", drag);
  // A click or Enter shows the pictures at full size, two screen pixels per picture pixel, and toggles back.
  for (const image of pictures.querySelectorAll("img")) {
    image.tabIndex = 0;
    const measure = () => image.style.setProperty("--pixels", `${image.naturalWidth}px`);
    image.complete ? measure() : (image.onload = measure);
    const toggle = () => pictures.dataset.mode !== "swipe" && pictures.classList.toggle("full");
    image.addEventListener("click", toggle);
    image.addEventListener("keydown", (e) => e.key === "Enter" && toggle());
  }
  section.addEventListener("keydown", (e) => {
    const mode = { s: "side", w: "swipe", d: "difference" }[e.key];
    if (mode && !e.ctrlKey && !e.metaKey && !e.altKey) look(mode);
  });
  // ?compare=swipe opens all in that mode
  const requested = new URLSearchParams(location.search).get("compare");
  if (requested && buttons.some((b) => b.dataset.mode === requested)) look(requested);
}
