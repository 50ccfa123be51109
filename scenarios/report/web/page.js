import { byId, listenToKeys, Playback, style } from "./dom.js";

export const data = JSON.parse(document.getElementById("data").textContent);

// ---- the current frame or event: a frame, or an event of the run with the frame that shows it best; and its
// listeners
let current = 0; // index of the frame
// negative: unknown; about: of the selection
export const moment = { event: -1, step: -1, about: { event: [], step: [] } };
export const listeners = [];
export function tell() { for (const listener of listeners) listener(data.frames[current], current); }
export function show(index) {
  current = Math.max(0, Math.min(data.frames.length - 1, index));
  moment.event = data.frames[current].event;
  moment.step = data.frames[current].step;
  tell();
}
/** Shows an event of a time step, by its number in the trace. */
export function showEvent(event, step) {
  moment.event = event;
  moment.step = step;
  // preferably one of the time step
  current = nearestFrame((f) => (f.step === step ? 0 : 1e12) + Math.abs(f.event - event));
  tell();
}
/** Returns the frame with the least distance; the first one if all are infinitely far. */
const nearestFrame = (far) =>
  data.frames.reduce((best, f, i) => (far(f) < far(data.frames[best]) ? i : best), 0);
/** Moves to a value on a chart's x axis. */
export const seek = (key, value) => go(key, value);
let go = (key, value) => {
  const frame = nearestFrame((f) => (f[key] >= 0 ? Math.abs(f[key] - value) : Infinity));
  if (data.frames[frame]?.[key] >= 0) show(frame);
};
/** Replaces what seek() does: on pages of runs it selects an event or a step. */
export function seekBy(action) { go = action; }

function startPlayer() {
  const image = byId("frame"), link = byId("frame-link"), scrub = byId("scrub");
  const images = data.frames.map(({ src }) => Object.assign(new Image(), { src })); // decoded ahead of use
  scrub.max = data.frames.length - 1;
  listeners.push((frame, index) => {
    image.src = images[index].src;
    image.alt = frame.caption;
    if (frame.file) link.href = frame.file; else link.removeAttribute("href");
    byId("caption").textContent = frame.caption;
    byId("count").textContent = `${index + 1} / ${data.frames.length}`;
    scrub.value = index;
    if (!byId("scene")) history.replaceState(null, "", `#${index + 1}`);
  });

  const playback = new Playback(byId("play"), byId("speed"),
      () => (current + 1 < data.frames.length ? () => show(current + 1) : null), () => show(0)),
    go = (index) => { playback.pause(); show(index); };
  byId("first").onclick = () => go(0);
  byId("back").onclick = () => go(current - 1);
  byId("next").onclick = () => go(current + 1);
  byId("last").onclick = () => go(data.frames.length - 1);
  scrub.oninput = () => go(Number(scrub.value));
  if (!byId("scene")) listenToKeys({ // there, keys move between events
    ArrowLeft: (shift) => go(current - (shift ? 10 : 1)),
    ArrowRight: (shift) => go(current + (shift ? 10 : 1)),
    Home: () => go(0), End: () => go(data.frames.length - 1), " ": () => playback.toggle(),
  });
  const requested = parseInt(location.hash.slice(1), 10);
  show(requested > 0 ? requested - 1 : 0);
}

// ---- the charts
/** Draws error bars, thin lines to points, and a mark at the current frame or event. */
const marksPlugin = {
  id: "marks",
  afterDatasetsDraw(chart) {
    const { left, right, top, bottom } = chart.chartArea, { x, y } = chart.scales, c = chart.ctx;
    const line = (colour, dash, x0, y0, x1, y1) => {
      c.strokeStyle = colour; c.setLineDash(dash);
      c.beginPath(); c.moveTo(x0, y0); c.lineTo(x1, y1); c.stroke();
    };
    c.save();
    const { datasets } = chart.data, seen = datasets.filter((_, i) => chart.isDatasetVisible(i));
    for (const set of seen) for (const p of set.data) {
      const px = x.getPixelForValue(p.x), py = y.getPixelForValue(p.y);
      if (p.high !== undefined)
        line(set.borderColor, [], px, y.getPixelForValue(p.low), px, y.getPixelForValue(p.high));
      if (p.from !== undefined) line(set.borderColor, [2, 3], x.getPixelForValue(p.from), py, px, py);
    }
    const at = chart.config.options.cursorAt, px = x.getPixelForValue(at), [zero, next] = x.ticks;
    if (x.type === "logarithmic" && zero?.label === "0" && next) { // the axis is broken behind 0
      const gap = (x.getPixelForValue(zero.value) + x.getPixelForValue(next.value)) / 2;
      c.fillStyle = style("--card");
      c.fillRect(gap - 2, bottom - 5, 5, 10);
      for (const side of [-3, 2]) line(style("--soft"), [], gap + side, bottom + 5, gap + side + 2, bottom - 5);
    }
    for (const about of chart.config.options.aboutAt || []) { // below the axis' line
      const ax = x.getPixelForValue(about);
      if (ax < left - 1 || ax > right + 1) continue;
      c.fillStyle = style("--selected");
      c.fillRect(ax - 1, bottom - 6, 2, 6);
    }
    if (at >= 0 && px > left - 1 && px < right + 1) line(style("--soft"), [4, 3], px, top, px, bottom);
    if (chart.config.type === "scatter" && right - left > 600) nameSeries(chart);
    c.restore();
  },
};

/** Writes the name of each series beside one of its points, where that covers no point, line or name. */
function nameSeries(chart) {
  const c = chart.ctx, { left, right, top, bottom } = chart.chartArea, half = 6, taken = [];
  const seen = chart.data.datasets.map((set, i) => ({ set, points: chart.getDatasetMeta(i).data }))
    .filter((_, i) => chart.isDatasetVisible(i)), sets = seen.filter(({ set }) => set.pointRadius);
  const take = (x, y, reach) => taken.push([x - reach, y - reach, x + reach, y + reach]);
  for (const { x, y } of sets.flatMap(({ points }) => points)) take(x, y, half);
  for (const { set, points } of seen) for (let i = 1; set.showLine && i < points.length; i++) {
    const { x: x0, y: y0 } = points[i - 1], { x: x1, y: y1 } = points[i];
    const steps = Math.ceil(Math.hypot(x1 - x0, y1 - y0) / half);
    for (let k = 1; k < steps; k++) take(x0 + (x1 - x0) * k / steps, y0 + (y1 - y0) * k / steps, 1);
  }
  const isFree = ([x0, y0, x1, y1]) => x0 > left && x1 < right && y0 > top && y1 < bottom &&
    taken.every((t) => x1 <= t[0] || x0 >= t[2] || y1 <= t[1] || y0 >= t[3]);
  c.font = `${Chart.defaults.font.size}px ${Chart.defaults.font.family}`;
  c.textBaseline = "middle";
  c.setLineDash([]);
  for (const { set, points } of sets) {
    const width = c.measureText(set.label).width;
    const places = points.flatMap(({ x, y }) => [y - half, y - 3 * half, y + half].flatMap((top) =>
      [[x + half, top], [x - half - width, top], [x - width / 2, top]]));
    const place = places.map(([x, y]) => [x, y, x + width, y + 2 * half]).find(isFree);
    if (!place) continue; // the legend has it
    taken.push(place);
    c.lineWidth = 3;
    c.strokeStyle = style("--card");
    c.strokeText(set.label, place[0], place[1] + half);
    c.fillStyle = set.borderColor;
    c.fillText(set.label, place[0], place[1] + half);
  }
}

/** Drops the ticks of a logarithmic axis beyond its ends, which would take space, and on a long axis all
    but powers of ten. */
function ticksWithin(axis) {
  const many = 80, isPower = (t) => Math.abs(Math.log10(t.value) - Math.round(Math.log10(t.value))) < 1e-6;
  const { min, max } = axis, slack = 1 + 1e-9,
    within = axis.ticks.filter(({ value }) => value * slack >= min && value <= max * slack);
  axis.ticks = within.length ? within.filter((t) => within.length < many || isPower(t))
      : [{ value: axis.min }, { value: axis.max }];
}

const tenTo = (n) => `10${String(n).replace(/./g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)])}`;
/** Returns the label of a logarithmic axis: 0.01, 100, 10⁵; on a long axis of powers of ten only */
function logLabel(value, { min, max }) {
  const power = Math.round(Math.log10(value)), isPower = Math.abs(Math.log10(value) - power) <= 1e-6;
  if (isPower ? power < -2 || power > 3 : max >= 30 * min) return isPower ? tenTo(power) : "";
  return String(Number(value.toPrecision(2)));
}

function axis({ label, log, min, max, ticks }, isWhole = true) {
  const given = new Map(ticks.map((t) => [t.at, t.label]));
  return {
    ...(given.size ? { afterBuildTicks: (a) => { a.ticks = ticks.map((t) => ({ value: t.at })); } }
      : log ? { afterBuildTicks: ticksWithin } : {}),
    ...(max > min ? { min, max } : {}),
    type: log ? "logarithmic" : "linear", bounds: "data",
    title: { display: true, text: label, color: style("--soft") },
    grid: { color: style("--grid"), borderColor: style("--line") },
    ticks: {
      color: style("--soft"), maxRotation: 0, precision: log || !isWhole ? undefined : 0,
      ...(given.size
        ? { callback: (value) => given.get(value) }
        : log ? { callback(value) { return logLabel(value, this); } } : {}),
    },
  };
}

/** Returns a colour, #rrggbb, moved towards that of text until its contrast on a card is three to one. */
function seen(colour) {
  const parts = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  const light = (rgb) => {
    const linear = (x) => (x <= 0.03928 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4),
      [r, g, b] = rgb.map((x) => linear(x / 255));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
  };
  const from = parts(colour), ink = parts(style("--ink")), card = light(parts(style("--card")));
  for (let t = 0; ; t += 0.1) {
    const mixed = from.map((x, i) => Math.round(x + (ink[i] - x) * Math.min(1, t))), l = light(mixed);
    if (t >= 1 || Math.max(l, card) / Math.min(l, card) >= 3) return `rgb(${mixed.join(", ")})`;
  }
}

const hasLegend = (spec) => spec.has_key && spec.series.filter((s) => s.label).length > 1;

/** Returns the height of a chart's legend at this width, in pixels, as Chart.js lays it out. */
function legendHeight(spec, canvas, width) {
  const { font } = Chart.defaults, gap = 10, context = canvas.getContext("2d");
  if (!hasLegend(spec)) return 0;
  context.font = `${font.size}px ${font.family}`;
  let rows = 1, used = gap;
  for (const s of spec.series.filter((s) => s.label)) {
    const item = 14 + font.size / 2 + context.measureText(s.label).width + gap;
    if (used > gap && used + item > width - gap) {
      rows++;
      used = gap;
    }
    used += item;
  }
  return Math.ceil(rows * (font.size + gap) + gap);
}

/** Increases the height of a narrow chart to make room for its legend. */
function makeRoom(spec, canvas, width) {
  const height = legendHeight(spec, canvas, width), few = 80;
  canvas.parentElement.style.minHeight = height > few ? `calc(14rem + ${height}px)` : "";
  return height;
}

function makeChart(spec, canvas) {
  const colours = spec.series.map((s, i) => seen(s.colour || style(`--s${i % 7}`)));
  const scatter = spec.series.some((s) => s.line === "none"),
    shaped = spec.series.some((s) => s.shape && s.shape !== "none");
  const radius = (s) => (s.shape === "none" ? 0 : scatter ? 4 : s.data.length > 80 ? 0 : 2.2);
  const stacked = spec.series.some((s) => s.line === "bars");
  const datasets = spec.series.map((s, i) => ({
    ...(s.line === "bars"
      ? { type: "bar", stack: "bars", grouped: false, barPercentage: 1, categoryPercentage: 0.9 } : {}),
    label: s.label, data: s.data, borderColor: colours[i],
    backgroundColor: s.shape.endsWith("Open") ? style("--card") : colours[i],
    borderWidth: s.line === "bars" ? 0 : 1.8,
    stepped: s.line === "steps" ? "before" : false, showLine: s.line !== "none",
    borderDash: s.line === "dashed" ? [5, 4] : [],
    pointRadius: radius(s), pointHitRadius: radius(s) || !scatter ? 8 : 0, pointStyle: s.shape === "none"
        ? "line" : s.shape.replace("Open", "") || "circle", clip: 12,
  }));
  const ends = spec.series.flatMap((s) => s.data.flatMap((p) => p.high ?? [])), // of error bars
    whole = spec.series.every((s) => s.data.every((p) => Number.isInteger(p.y)));
  const room = makeRoom(spec, canvas, canvas.parentElement.clientWidth);
  const chart = new Chart(canvas, {
    type: scatter ? "scatter" : "line", data: { datasets }, plugins: [marksPlugin],
    options: {
      animation: false, parsing: false, normalized: true, maintainAspectRatio: false,
      interaction: { mode: scatter ? "nearest" : "index", intersect: false },
      scales: { x: { ...axis(spec.x), ...(stacked ? { offset: true } : {}) },
          y: { ...axis(spec.y, whole), stacked, bounds: "ticks", beginAtZero: !spec.y.log,
              ...(ends.length ? { suggestedMax: Math.max(...ends) } : {}) } },
      plugins: {
        legend: {
          display: hasLegend(spec), position: "bottom", maxHeight: room,
          labels: { color: style("--ink"), boxWidth: 14, boxHeight: shaped ? 6 : 2, usePointStyle: shaped,
              filter: (item) => item.text },
        },
        decimation: { enabled: !scatter, algorithm: "min-max" },
        tooltip: { callbacks: {
          title: ([item]) => (!item ? "" : item.raw.note ? item.dataset.label
              : `${spec.x.label} ${item.parsed.x.toLocaleString()}`),
          label: ({ raw, dataset, formattedValue }) =>
            raw.note ? raw.note.split("\n") : `${dataset.label}: ${formattedValue}` +
                (raw.high === undefined ? "" : `, ${raw.low} to ${raw.high}`),
        } },
      },
      onResize(chart, size) {
        chart.options.plugins.legend.maxHeight = makeRoom(spec, canvas, size.width);
      },
      onClick(e) {
        const hit = chart.getElementsAtEventForMode(e, "nearest", { intersect: true }, false);
        const point = hit.map((p) => datasets[p.datasetIndex].data[p.index]).find((p) => p.target);
        if (point) location.href = point.target;
        if (!spec.cursor) return;
        seek(spec.cursor, chart.scales.x.getValueForPixel(e.x));
      },
    },
  });
  return chart;
}

function startCharts() {
  if (!data.charts.length) return;
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  let charts = [], waiting = false;
  const mark = () => {
    waiting = false;
    charts.forEach((c, i) => {
      if (!data.charts[i].cursor) return;
      c.options.cursorAt = moment[data.charts[i].cursor];
      c.options.aboutAt = moment.about[data.charts[i].cursor];
      c.draw();
    });
  };
  const draw = () => {
    charts.forEach((c) => c.destroy());
    charts = data.charts.map((spec, i) => makeChart(spec, byId(`chart-${i}`)));
    mark();
  };
  listeners.push(() => { // events can change faster than charts are drawn
    if (!waiting) requestAnimationFrame(mark);
    waiting = true;
  });
  draw();
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw); // colours are read on drawing
}

if (data.frames.length) startPlayer();
startCharts();
