// ---- pieces of the page that several of its parts make
function textButton(text, action, title = "") {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "text";
  button.textContent = text;
  button.title = title;
  button.onclick = action;
  return button;
}

/** Fills a list of terms: [[term, value or element, title of the term]]. */
function fillList(list, rows) {
  list.replaceChildren(
    ...rows.flatMap(([term, value, title]) => {
      const dt = document.createElement("dt"),
        dd = document.createElement("dd");
      dt.textContent = term;
      if (title) dt.title = title;
      dd.append(value);
      return [dt, dd];
    }),
  );
}

/** Copies text; returns whether that worked. `element` holds the text, and is selected where there is no
    clipboard, as on pages from disk. */
async function copyText(text, element) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    getSelection().selectAllChildren(element);
    return document.execCommand("copy");
  }
}
