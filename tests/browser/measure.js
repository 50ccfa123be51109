// Measures a page in its window: boxes of text that are cut off, stick out, lie on each other or under
// something, text that hardly differs from its background, invisible drawings. Posts "ok ...", "FAIL ..." and
// "done" to the top.
(async function () {
  const { byId } = dom_js,
    run = typeof scene_js === "undefined" ? null : scene_js.run;
  const found = new Map(), figures = []; // fault: [example, number]
  const fail = (what, where) => {
    const known = found.get(what);
    if (known) known[1]++;
    else found.set(what, [where, 1]);
  };
  const wait = (ms) => new Promise((then) => setTimeout(then, ms));

  // -- colours: [r, g, b, alpha], 0 to 1
  function colour(css) {
    if (!css || css === "none" || css === "transparent") return [0, 0, 0, 0];
    const numbers = (css.match(/-?[\d.]+(e-?\d+)?%?/g) || []).map((n) => parseFloat(n));
    if (css.startsWith("color(srgb")) return [...numbers.slice(0, 3), numbers[3] ?? 1];
    if (css.startsWith("rgb")) return [...numbers.slice(0, 3).map((x) => x / 255), numbers[3] ?? 1];
    if (css.startsWith("#"))
      return [1, 3, 5].map((i) => parseInt(css.slice(i, i + 2), 16) / 255).concat(1);
    throw new Error(`unknown colour ${css}`);
  }
  const over = (top, below) =>
    [0, 1, 2].map((i) => top[i] * top[3] + below[i] * (1 - top[3])).concat(1);
  function luminance(c) {
    const [r, g, b] = c.slice(0, 3).map((x) => (x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  }
  const contrast = (a, b) => {
    const [x, y] = [luminance(a), luminance(b)].sort((p, q) => q - p);
    return (x + 0.05) / (y + 0.05);
  };
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const canvas = dark ? [0.07, 0.07, 0.07, 1] : [1, 1, 1, 1];
  const isShape = (e) => e instanceof SVGGeometryElement;
  let styles = new Map(); // of elements, as long as nothing changes
  const styleOf = (e) => {
    if (!styles.has(e)) styles.set(e, getComputedStyle(e));
    return styles.get(e);
  };
  /** The product of an element's own opacity and those around it. */
  function opacityOf(element) {
    let opacity = 1;
    for (let e = element; e; e = e.parentElement) opacity *= Number(styleOf(e).opacity);
    return opacity;
  }

  /** What an element itself paints behind its text. */
  function paintOf(element) {
    const style = styleOf(element);
    if (element instanceof SVGElement && !(element instanceof SVGSVGElement)) {
      const c = isShape(element) ? colour(style.fill) : [0, 0, 0, 0];
      return [c[0], c[1], c[2], c[3] * Number(style.fillOpacity) * opacityOf(element)];
    }
    return colour(style.backgroundColor);
  }
  /** What is painted behind an element, where it is in the window: all that is under a point of it. */
  function behind(element, x, y) {
    const layers = [];
    const stack = document.elementsFromPoint(x, y);
    const start = stack.findIndex((e) => e === element || e.contains(element));
    for (const e of start < 0 ? [element] : stack.slice(start)) layers.push(paintOf(e));
    if (start < 0) for (let e = element.parentElement; e; e = e.parentElement) layers.push(paintOf(e));
    // Shapes of an SVG do not contain its text: those painted before it are under it.
    if (element instanceof SVGElement)
      for (const e of stack.slice(0, Math.max(0, start)))
        if (isShape(e) && e.compareDocumentPosition(element) & Node.DOCUMENT_POSITION_FOLLOWING)
          layers.unshift(paintOf(e));
    return layers.reverse().reduce((below, c) => over(c, below), canvas);
  }

  // -- boxes of text
  const path = (e) => {
    const name = (n) => n.localName +
        (n.id ? `#${n.id}` :
             n.classList.length ? `.${[...n.classList].join(".")}` :
                                  "");
    return [e.parentElement, e].filter(Boolean).map(name).join(" > ");
  };
  const clips = (value) => value === "hidden" || value === "clip";
  const scrolls = (value) => value === "auto" || value === "scroll";
  const isShown = (e) =>
      e.checkVisibility({opacityProperty: true, visibilityProperty: true, contentVisibilityAuto: true});

  /** Follows a box through all that clips it: {box, cut: who cuts it off, sticky: it may lie over others}. */
  function clipped(element, rect) {
    const box = { left: rect.left, right: rect.right, top: rect.top, bottom: rect.bottom };
    let cut = null, shortened = false, titled = false, sticky = false, free = false;
    for (let e = element; e && e !== document.body; e = e.parentElement) {
      const style = styleOf(e);
      if (style.position === "sticky" || style.position === "fixed") sticky = true;
      shortened ||= style.textOverflow === "ellipsis" || style.webkitLineClamp !== "none";
      titled ||= shortened && Boolean(e.title); // the title has the full text of a shortened one
      if (style.position === "fixed") free = true;
      const holds = e !== element || style.display !== "inline";
      if (free || !holds || (e instanceof SVGElement && !(e instanceof SVGSVGElement))) continue;
      const area = e.getBoundingClientRect();
      const slack = 1.5;
      for (const [low, high, overflow] of [
               ["left", "right", style.overflowX], ["top", "bottom", style.overflowY]]) {
        if (!clips(overflow) && !scrolls(overflow)) continue;
        if (clips(overflow) && (box[low] < area[low] - slack || box[high] > area[high] + slack)) cut ||= e;
        box[low] = Math.max(box[low], area[low]);
        box[high] = Math.min(box[high], area[high]);
      }
    }
    return { box, cut: titled ? null : cut, sticky };
  }

  function textsIn(root) {
    const out = [], walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const element = walker.currentNode.parentElement, text = walker.currentNode.data.trim();
      if (!text || element.closest("script, style, noscript, template, option, title, desc") ||
          !isShown(element))
        continue;
      if (element.closest("[inert], .visually-hidden") || styleOf(element).clipPath === "inset(50%)")
        continue;
      const range = document.createRange();
      range.selectNodeContents(walker.currentNode);
      for (const rect of range.getClientRects())
        if (rect.width > 0.5 && rect.height > 0.5)
          out.push({element, text: text.slice(0, 40), rect, range, node: walker.currentNode});
    }
    return out;
  }

  // -- what is measured
  function measureBoxes(texts) {
    const width = document.documentElement.clientWidth, shown = [];
    for (const t of texts) {
      const { box, cut, sticky } = clipped(t.element, t.rect);
      if (cut) fail(`cut off by ${path(cut)}`, `"${t.text}"`);
      const seen = box.right - box.left > 1 && box.bottom - box.top > 1;
      const inDialog = t.element.closest("dialog");
      if (seen && !inDialog && (box.left < -1 || box.right > width + 1))
        fail(`outside the window: ${path(t.element)}`, `"${t.text}"`);
      const size = parseFloat(getComputedStyle(t.element).fontSize) * scaleOf(t.element);
      if (seen && size < 9) fail(`letters of ${size.toFixed(1)} pixels: ${path(t.element)}`, `"${t.text}"`);
      if (seen && !sticky) shown.push({ ...t, box });
    }
    shown.sort((p, q) => p.box.top - q.box.top);
    shown.forEach((p, i) => {
      for (let k = i + 1; k < shown.length && shown[k].box.top < p.box.bottom - 2; k++) {
        const q = shown[k];
        if (p.node === q.node ||
            Boolean(p.element.closest("dialog")) !== Boolean(q.element.closest("dialog")))
          continue;
        const x = Math.min(p.box.right, q.box.right) - Math.max(p.box.left, q.box.left);
        const y = Math.min(p.box.bottom, q.box.bottom) - q.box.top;
        if (x > 2 && y > 3)
          fail(`${path(p.element)} and ${path(q.element)} overlap`, `"${p.text}" and "${q.text}"`);
      }
    });
  }
  /** Text in an SVG is as large as its picture is scaled. */
  function scaleOf(element) {
    const matrix = element.getScreenCTM ? element.getScreenCTM() : null;
    return matrix ? Math.hypot(matrix.a, matrix.b) : 1;
  }

  /**
     Scrolls through the page; of each text that comes into the window: contrast, and whether it is on top.
     Of texts that are styled alike the first few say it.
   */
  function measureContrast(texts) {
    const step = Math.max(300, innerHeight - 240),
          left = new Set(texts.filter((t) => !t.element.closest("dialog"))), alike = new Map();
    const tall = document.documentElement.scrollHeight;
    for (let top = 0; top < tall && left.size; top += step) {
      scrollTo(0, top);
      for (const t of left) {
        if (t.rect.top - scrollY > innerHeight) continue;
        const { box, sticky } = clipped(t.element, t.range.getBoundingClientRect());
        const x = (box.left + Math.min(box.right, box.left + 8)) / 2, y = (box.top + box.bottom) / 2;
        if (box.right - box.left < 1 || box.bottom - box.top < 1 || y < 1 || y > innerHeight - 1 || x < 0 ||
            x > innerWidth)
          continue;
        const key = `${path(t.element)} ${t.element.parentElement.parentElement?.className} ${
            styleOf(t.element).color}`;
        const known = alike.get(key) || 0;
        if (known > 8) left.delete(t);
        if (known > 8) continue;
        const front = document.elementFromPoint(x, y);
        if (!sticky && coveredBySticky(front, t.element)) continue; // it is seen from another place
        left.delete(t);
        alike.set(key, known + 1);
        measureText(t, front, x, y);
      }
    }
    scrollTo(0, 0);
  }
  function coveredBySticky(front, element) {
    for (let e = front; e && !e.contains(element); e = e.parentElement)
      if (styleOf(e).position === "sticky") return true;
    return false;
  }
  function measureText(t, front, x, y) {
    const { element } = t, style = styleOf(element);
    const related = front &&
        (front.contains(element) || element.contains(front) || front instanceof SVGElement ||
         t.element.closest("svg"));
    if (!related) fail(`${path(element)} is covered by ${front ? path(front) : "nothing"}`, `"${t.text}"`);
    if (element.closest(":disabled, [aria-disabled=true]")) return;
    const ink = colour(element instanceof SVGElement ? style.fill : style.color);
    const opacity = opacityOf(element);
    const ground = behind(element, x, y);
    const ratio = contrast(over([ink[0], ink[1], ink[2], ink[3] * opacity], ground), ground);
    const size = parseFloat(style.fontSize) * scaleOf(element), bold = Number(style.fontWeight) >= 700;
    const least = size >= 24 || (bold && size >= 18.66) ? 3 : 4.5;
    if (ratio < least - 0.01) fail(`contrast ${ratio.toFixed(2)} of ${path(element)}`, `"${t.text}"`);
  }

  /** Fields: their content must fit. */
  function measureFields() {
    const pen = document.createElement("canvas").getContext("2d");
    for (const field of document.querySelectorAll("select, input:not([type=range])")) {
      if (!isShown(field)) continue;
      const style = getComputedStyle(field), select = field.localName === "select";
      const text = select ? (field.selectedOptions[0] || {text: ""}).text : field.value || field.placeholder;
      pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
      const room = field.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight) -
          (select ? 14 : 0);
      if (pen.measureText(text).width > room + 1)
        fail(`a field cuts off what it holds: ${path(field)}`, `"${text}"`);
      const ground = behind(field, -1, -1);
      const ink = select || field.value ? style.color : getComputedStyle(field, "::placeholder").color;
      const ratio = contrast(over(colour(ink), ground), ground);
      if (ratio < 4.49) fail(`contrast ${ratio.toFixed(2)} of ${path(field)}`, `"${text}"`);
    }
  }

  /** Pictures, curves and keys to colours must be seen. */
  function measureDrawings() {
    for (const image of document.images)
      if (isShown(image) && (!image.complete || image.naturalWidth === 0 || image.clientWidth < 2))
        fail(`a picture is not there: ${path(image)}`, image.alt);
    for (const key of document.querySelectorAll(".legend i, .swatch, .row span:nth-child(3)")) {
      if (!isShown(key)) continue;
      const style = getComputedStyle(key), ground = behind(key.parentElement, -1, -1);
      const inks = [
        style.backgroundColor, style.outlineStyle !== "none" ? style.outlineColor : "",
        style.borderTopStyle !== "none" ? style.borderTopColor : ""
      ];
      if (key.localName === "svg") inks.push(getComputedStyle(key.firstElementChild).fill);
      if (style.backgroundImage !== "none" || key.localName === "span") continue;
      const best = Math.max(...inks.map((ink) => contrast(over(colour(ink), ground), ground)));
      if (best < 1.25)
        fail(`a key to a colour is not seen: ${path(key)}`, key.parentElement.textContent.slice(0, 40));
    }
    if (typeof Chart === "undefined") return;
    for (const chart of Object.values(Chart.instances)) {
      if (!isShown(chart.canvas)) continue; // in another tab
      const ground = behind(chart.canvas, -1, -1);
      if (chart.canvas.clientHeight < 80) fail("a chart without height", path(chart.canvas));
      for (const set of chart.data.datasets) {
        const ratio = contrast(over(colour(set.borderColor), ground), ground);
        if (ratio < 2) fail(`a curve of contrast ${ratio.toFixed(2)}`, set.label);
      }
      if (chart.chartArea.width < 0.5 * chart.width) fail("a chart squeezed to the side", path(chart.canvas));
      const { legend } = chart;
      for (const item of legend && legend.legendHitBoxes && legend.options.display ? legend.legendHitBoxes :
                                                                                     [])
        if (item.left < -1 || item.left + item.width > chart.width + 1 ||
            item.top + item.height > chart.height + 1)
          fail("a chart's legend is cut off", path(chart.canvas));
    }
  }

  function measureAll(root) {
    styles = new Map();
    const texts = textsIn(root);
    measureBoxes(texts);
    measureContrast(texts);
    measureFields();
    measureDrawings();
    const page = document.documentElement;
    if (page.scrollWidth > page.clientWidth)
      fail("the page scrolls sideways", `${page.scrollWidth} of ${page.clientWidth} pixels`);
  }

  /**
   * The pictures of any page as it opens: their share of the first screen at 1280 pixels. `least`: per cent.
   */
  function measureShare(least) {
    if (innerWidth !== 1280) return;
    const share = [...document.querySelectorAll("canvas, img, iframe, section svg")].filter(isShown).reduce(
                      (sum, e) => {
                        const {left, right, top, bottom} = e.getBoundingClientRect();
                        return sum +
                            Math.max(0, Math.min(right, innerWidth) - left) *
                            Math.max(0, Math.min(bottom, innerHeight) - top);
                      },
                      0) *
        100 / (innerWidth * innerHeight);
    figures.push(`pictures have ${share.toFixed(0)} % of the first screen`);
    if (share < least)
      fail(`pictures have less than ${least} % of the first screen`, `${share.toFixed(1)} %`);
  }
  /** Nothing is over the view as a page opens; a run's follows the title. */
  function measureView(isRun) {
    const rect = (e) => e.getBoundingClientRect(), canvas = rect(byId("view-canvas"));
    if (isRun && innerWidth < 640 && canvas.top > 0.15 * innerHeight)
      fail("the view is not first", `at ${canvas.top} of ${innerHeight} pixels`);
    if (isRun && innerWidth < 640 && rect(byId("tools")).height > 50)
      fail("the tools have more than one row", `${rect(byId("tools")).height} pixels`);
    for (const part of document.querySelectorAll("header > *, .tools, .keys, .timeline, .panel, .tabs")) {
      const { left, right, top, bottom } = rect(part);
      const isOver = Math.min(right, canvas.right) - Math.max(left, canvas.left) > 1 &&
          Math.min(bottom, canvas.bottom) - Math.max(top, canvas.top) > 1;
      if (isOver)
        fail(`${path(part)} lies over the view`, `${Math.round(top)} to ${Math.round(bottom)} pixels`);
    }
  }

  /** Dialogs, one after the other, as they are when they are open. */
  function measureDialogs() {
    for (const dialog of [...document.querySelectorAll("dialog")].slice(0, 2)) {
      if (dialog.open) continue;
      dialog.showModal();
      styles = new Map();
      const texts = textsIn(dialog), area = dialog.getBoundingClientRect();
      if (area.left < -1 || area.right > innerWidth + 1)
        fail("a dialog is wider than the window", path(dialog));
      measureBoxes(texts);
      for (const t of texts) {
        const ground = behind(t.element, -1, -1),
              ratio = contrast(over(colour(getComputedStyle(t.element).color), ground), ground);
        if (ratio < 4.49) fail(`contrast ${ratio.toFixed(2)} of ${path(t.element)}`, `"${t.text}"`);
      }
      dialog.close();
    }
  }

  /** A run's page in the states in which most is to be read. */
  const states = {
    "as it opens": () => {},
    "with a region selected": () => {
      const side = run.events.bodies.findIndex((b) => b.regionCount > 0); // an open body has none
      if (side >= 0) run.selection.pickRegion(side, run.events.bodies[side].regionCount - 1);
    },
    "at a pair that is explained": () =>
        run.selection.goTo(Math.max(0, run.events.kind.indexOf(run.events.FACE_TEST))),
    "coloured by tests": () => run.controls && run.controls.colourBy("tests"),
    "filtered to nothing": () => {
      byId("filter-region").value = "999999";
      run.form.read();
    },
  };

  try {
    document.documentElement.style.scrollBehavior = "auto";
    for (const details of document.querySelectorAll("details")) details.open = true;
    await wait(120);
    const isRun = run && run.events.bodies.every((b) => b.complete);
    for (const [name, enter] of Object.entries(isRun ? states : { "as it opens": () => {} })) {
      enter();
      await wait(60);
      if (isRun && run.view) run.view.draw();
      measureAll(name === "as it opens" ? document.body : byId("scene"));
      const canvas = byId("view-canvas");
      if (name !== "as it opens") continue;
      measureShare(isRun ? 60 : canvas || document.querySelector("iframe") ? 33 : 1);
      if (canvas && isShown(canvas)) measureView(isRun);
    }
    for (const name of isRun ? run.tabs.names : []) {
      run.tabs.show(name);
      await wait(120); // charts take the size of their tab
      measureAll(document.querySelector(".tabs"));
    }
    measureDialogs();
  } catch (e) {
    fail("measure.js", e.stack || e);
  }
  if (complaints.length) fail("the console is not empty", complaints.join("; "));
  const lines =
      [...found].map(([what, [where, n]]) => `FAIL ${what}${n > 1 ? `, ${n} times` : ""}: ${where}`);
  top.postMessage({ measured: [...figures, ...lines].join("\n") }, "*");
})();
