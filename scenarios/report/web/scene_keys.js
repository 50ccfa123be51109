// ---- keys. They work anywhere on the page but where one types.
/** `actions`: by key as KeyboardEvent.key has it; those of letters take small ones, shift is passed on. */
function listenToKeys(actions) {
  document.addEventListener("keydown", (e) => {
    const key = e.key.length === 1 ? e.key.toLowerCase() : e.key,
      target = e.target;
    if (!actions[key] || e.ctrlKey || e.metaKey || e.altKey) return;
    if (target.tagName === "SELECT" || target.tagName === "TEXTAREA" || target.isContentEditable) return;
    if (
      target.tagName === "INPUT" &&
      (target.type !== "range" || key.startsWith("Arrow") || key === "Home" || key === "End")
    )
      return;
    if (target.closest && target.closest("dialog[open]") && key !== "?") return;
    if (
      (key === " " || key === "Enter") &&
      (target.tagName === "BUTTON" || target.tagName === "SUMMARY" || target.tagName === "A")
    )
      return; // presses what has the focus
    e.preventDefault();
    actions[key](e.shiftKey, target);
  });
}
