// Comparisons: each has its own way of being looked at; dragging over a swiped picture moves the edge.
for (const section of document.querySelectorAll(".comparison")) {
  const pictures = section.querySelector(".pictures"), slider = section.querySelector(".modes input");
  if (!slider) continue;
  const buttons = [...section.querySelectorAll(".modes button")];
  const swipe = (percent) => {
    slider.value = percent;
    pictures.style.setProperty("--at", `${Math.max(0, Math.min(100, percent))}%`);
  };
  const look = (mode) => {
    pictures.dataset.mode = mode;
    section.classList.toggle("swiping", mode === "swipe");
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
  const asked = new URLSearchParams(location.search).get("compare"); // ?compare=swipe opens all that way
  if (asked && buttons.some((b) => b.dataset.mode === asked)) look(asked);
}
