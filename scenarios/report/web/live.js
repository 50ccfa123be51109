// Follows a program: draws the queries that the server sends (tools/live.cpp).
import { byId } from "./dom.js";

const kLast = 200, kRemarkable = 200;
const queries = new Map(); // by number
let state = {}, held = false, drawn = false;
let current = Number(location.hash.slice(1)) || null; // the selected query, which is in the address

const isRemarkable = (q) => q.verdict === "wrong" || q.slow;
const digits = (x) => Math.round(x).toLocaleString("en").replaceAll(",", "\u202f");
const short = (x) => (x >= 100 ? digits(x) : x.toPrecision(3));

function element(name, text, className) {
  const out = document.createElement(name);
  if (text !== undefined) out.textContent = text;
  if (className) out.className = className;
  return out;
}

/** Keeps what the server keeps: the last queries, and the newest remarkable ones. */
function forget() {
  const numbers = [...queries.keys()].sort((x, y) => x - y);
  const old = numbers.slice(0, Math.max(0, numbers.length - kLast));
  const remarkable = old.filter((n) => isRemarkable(queries.get(n)));
  const kept = new Set(remarkable.slice(-kRemarkable));
  for (const n of old) if (!kept.has(n) && n !== current) queries.delete(n);
}

function drawNumbers() {
  byId("engine").textContent = state.engine || "Waiting for the program";
  byId("program").textContent = state.program;
  document.title = (state.wrong ? state.wrong + " wrong · " : "") + (state.engine || "Live") + " · lrbscope";
  const status = byId("status");
  status.textContent = !state.running ? "the program has ended" : state.queries ? "recording" : "not recording yet";
  status.classList.toggle("bad", state.wrong > 0);
  if (state.wrong > 0) status.textContent += ", wrong answers";
  const tiles = [
    ["Queries", digits(state.queries), ""],
    ["Right", digits(state.right), state.undecidable ? digits(state.undecidable) + " undecidable in floats" : ""],
    ["Wrong", digits(state.wrong), ""],
    ["Not checked", digits(state.not_checked + state.unchecked), state.not_checked ? "the program was faster than the check" : ""],
    ["Median", state.median_us ? short(state.median_us) + " µs" : "–", ""],
    ["99 %", state.p99_us ? short(state.p99_us) + " µs" : "–", "of the queries are faster"],
  ];
  byId("numbers").replaceChildren(...tiles.map(([label, value, note]) => {
    const tile = element("div");
    tile.append(element("dt", label), element("dd", value));
    if (note) tile.lastChild.append(element("small", note));
    return tile;
  }));
  byId("advice").textContent = state.advice || "";
}

function shown() {
  const only = byId("remarkable").checked;
  return [...queries.values()].filter((q) => !only || isRemarkable(q)).sort((x, y) => y.number - x.number);
}

function drawRows() {
  byId("rows").replaceChildren(...shown().map((q) => {
    const row = element("tr", undefined, "leads");
    row.tabIndex = 0;
    row.dataset.number = q.number;
    if (q.number === current) row.setAttribute("aria-current", "true");
    const answer = { intersecting: "intersecting", separate: "separate", unreported: "–" }[q.answer] || q.answer;
    const cells = [[digits(q.number), "n"], [q.verdict, q.verdict === "wrong" ? "bad" : ""], [short(q.us) + (q.slow ? " slow" : ""), "n"],
      [digits(q.tests), "n"], [digits(q.pairs), "n"], [answer], [q.kind.replaceAll("_", " ")]];
    row.append(...cells.map(([text, name]) => element("td", text, name)));
    return row;
  }));
}

function drawPlot() {
  const plot = byId("plot"), width = plot.clientWidth, height = plot.clientHeight;
  const left = 52, bottom = 22, all = shown().filter((q) => q.us > 0);
  plot.setAttribute("viewBox", `0 0 ${width} ${height}`);
  plot.replaceChildren();
  if (all.length === 0) return;
  const add = (name, attributes, text) => {
    const e = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
    if (text !== undefined) e.textContent = text;
    plot.append(e);
    return e;
  };
  const logs = all.map((q) => Math.log10(q.us));
  const low = Math.floor(Math.min(...logs)), high = Math.max(low + 1, Math.ceil(Math.max(...logs)));
  const first = Math.min(...all.map((q) => q.number)), last = Math.max(first + 1, ...all.map((q) => q.number));
  const x = (n) => left + ((n - first) / (last - first)) * (width - left - 14);
  const y = (log) => 8 + (1 - (log - low) / (high - low)) * (height - bottom - 8);
  for (let p = low; p <= high; ++p) {
    add("line", { x1: left, x2: width, y1: y(p), y2: y(p) });
    add("text", { x: left - 6, y: y(p) + 4, "text-anchor": "end" }, p > 5 || p < -3 ? "1e" + p : p >= 0 ? digits(10 ** p) : (10 ** p).toFixed(-p));
  }
  add("text", { x: left, y: height - 4 }, digits(first));
  add("text", { x: width - 4, y: height - 4, "text-anchor": "end" }, digits(last));
  for (const q of all) {
    const at = [x(q.number), y(Math.log10(q.us))], name = (q.number === current ? " current" : "");
    const mark = q.verdict === "wrong"
      ? add("path", { d: `M${at[0] - 5} ${at[1] - 5}l10 10m0 -10l-10 10`, class: "mark wrong" + name })
      : add("circle", { cx: at[0], cy: at[1], r: q.slow ? 5 : 3, class: "mark" + (q.slow ? " slow" : "") + name });
    mark.dataset.number = q.number;
  }
}

function drawSelected() {
  const panel = byId("selected"), q = queries.get(current);
  if (!q) return;
  const parts = [element("h2", "Query " + digits(q.number))];
  const facts = element("dl", undefined, "facts");
  const fact = (name, value) => facts.append(element("dt", name), element("dd", value));
  fact("bodies", q.a + " and " + q.b);
  fact("answer", q.answer + ", " + digits(q.pairs) + " pairs");
  if (q.exact_pairs !== undefined) fact("exact", digits(q.exact_pairs) + " pairs");
  fact("verdict", q.verdict + (q.remark && !q.explanation ? ": " + q.remark : ""));
  fact("time", short(q.us) + " µs" + (q.slow ? ", slower than 99 % of the queries before" : ""));
  fact("tests", digits(q.tests) + (q.triangle_tests ? ", " + digits(q.for_nothing) + " of " + digits(q.triangle_tests) + " triangle tests for nothing" : ""));
  parts.push(facts);
  if (q.explanation) parts.push(element("p", q.explanation, "explanation"));
  const prices = Object.entries(q.prices || {}).filter(([, n]) => n > 0), sum = prices.reduce((s, [, n]) => s + n, 0);
  if (sum > 0) {
    const bar = element("div", undefined, "bar");
    for (const [name, n] of prices) {
      const part = element("span");
      part.style.width = (100 * n) / sum + "%";
      part.title = name;
      bar.append(part);
    }
    parts.push(element("h2", digits(sum) + " visits of nodes"), bar,
      element("p", prices.map(([name, n]) => Math.round((100 * n) / sum) + " % " + name).join(", "), "note"));
  }
  if (q.run) {
    const link = element("a", "Bodies, tests and trees of this query");
    link.href = "queries/" + q.number + "/";
    link.target = "_blank";
    link.rel = "noopener";
    const line = element("p");
    line.append(link);
    parts.push(line);
  }
  panel.replaceChildren(...parts);
}

function draw() {
  if (drawn) return;
  drawn = true;
  requestAnimationFrame(() => {
    drawn = false;
    drawNumbers();
    if (!held) { drawRows(); drawPlot(); }
    drawSelected();
  });
}

function select(number) {
  current = number;
  history.replaceState(null, "", "#" + number);
  drawRows();
  drawPlot();
  drawSelected();
}

addEventListener("click", (e) => {
  const at = e.target.closest("[data-number]");
  if (at) select(Number(at.dataset.number));
});
addEventListener("keydown", (e) => {
  const step = { ArrowDown: 1, ArrowUp: -1 }[e.key], all = shown().map((q) => q.number);
  if (e.key === "Enter" && e.target.dataset.number) select(Number(e.target.dataset.number));
  if (!step || all.length === 0 || e.ctrlKey || e.metaKey || e.altKey) return;
  e.preventDefault();
  const at = all.indexOf(current);
  select(all[Math.min(all.length - 1, Math.max(0, at < 0 ? 0 : at + step))]);
  document.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest" });
});
byId("remarkable").addEventListener("change", () => { drawRows(); drawPlot(); });
byId("hold").addEventListener("click", () => {
  held = !held;
  byId("hold").setAttribute("aria-pressed", held);
  byId("hold").textContent = held ? "Follow" : "Hold";
  draw();
});
addEventListener("resize", draw);

const source = new EventSource("events");
source.onmessage = (e) => {
  const update = JSON.parse(e.data);
  state = update.state;
  for (const q of update.queries) queries.set(q.number, q);
  forget();
  draw();
};
source.onerror = () => {
  byId("status").textContent = "lrbscope has ended";
  if (!state.running) source.close();
};
