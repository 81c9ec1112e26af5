// Plots over time by uPlot: one zoom for all of a page, kept in its address; measured, models, and the difference.

import { change, route } from "/app/api.js";
import { button, el, svg } from "/app/dom.js";
import { asGiven, num, onAxis } from "/app/number.js";
import { marked } from "/app/draw.js";
import { joined, spread, torn } from "/app/lines.js";
import { keepers } from "/app/save.js";

/* global uPlot */
const plots = new Set(), DENSE = 4; // samples to a pixel from which a line is drawn thin
const look = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name.split(" ")[0].replace("c-", "")}`).trim();

/** The zoom of this page: from and to [s], null when everything is shown. */
export function timeView() {
  const q = route().query, at = (k) => (q.get(k) === null || Number.isNaN(Number(q.get(k))) ? null : Number(q.get(k)));
  const view = { from: at("from"), to: at("to"), ends: [Infinity, -Infinity], watchers: [] };
  if (view.from === null || view.to === null || view.to <= view.from) view.from = view.to = null;
  let waiting = 0, address = 0;
  const resting = [];
  view.watch = (f) => view.watchers.push(f);
  view.rested = (f) => resting.push(f);
  view.set = (from, to) => {
    [view.from, view.to] = from === null || to - from < 0.5 ? [null, null] : [Math.max(from, view.ends[0]), Math.min(to, view.ends[1])];
    if (!waiting) waiting = requestAnimationFrame(() => { waiting = 0; for (const f of view.watchers) f(); }); // one redraw a frame
    clearTimeout(address);
    const here = location.hash.split("?")[0];
    address = setTimeout(() => { // when it rests: its address, and the plots that are near the screen
      if (location.hash.split("?")[0] !== here) return;
      change({ from: view.from === null ? "" : view.from.toFixed(2), to: view.to === null ? "" : view.to.toFixed(2) }, true);
      for (const f of resting) f();
    }, 120);
  };
  view.range = () => (view.from === null ? view.ends : [view.from, view.to]);
  return view;
}

/** Buttons for the zoom, for hands without a mouse. */
export function zoomer(view) {
  const by = (shift, size) => () => { const [a, b] = view.range(), m = (a + b) / 2 + shift * (b - a), h = ((b - a) / 2) * size; view.set(m - h, m + h); };
  const said = el("span.note", { role: "status" }), tell = () => { const [a, b] = view.range(); said.textContent = b > a ? `${asGiven(a, 5)} to ${asGiven(b, 5)} s` : ""; };
  view.watch(tell);
  setTimeout(tell, 50);
  return el(".tools.sticky", { role: "group", "aria-label": "Time shown" }, button("−", by(0, 2), { "aria-label": "Show more time" }), button("+", by(0, 0.5), { "aria-label": "Show less time" }), button("◀", by(-0.5, 1), { "aria-label": "Earlier" }), button("▶", by(0.5, 1), { "aria-label": "Later" }), button("All", () => view.set(null, null), { "aria-label": "Show all time" }), said);
}

/** lines: [{ name, t, y, look, width, gaps: seconds at which the line begins anew }]; options: unit, height, band, view. */
export function timePlot(title, lines, options) {
  const view = options.view, box = el(".draw"), readout = el(".readout", { "aria-hidden": "true" });
  const data = joined(lines), legend = el("span.legend", null, lines.map((l) => el("span", null, el(`i.${l.look.replaceAll(" ", ".")}`), l.name)));
  if (data[0].length) { view.ends[0] = Math.min(view.ends[0], data[0][0]); view.ends[1] = Math.max(view.ends[1], data[0].at(-1)); }
  const words = `${title}${options.unit ? ` [${options.unit}]` : ""}`;
  box.setAttribute("role", "img");
  box.setAttribute("aria-label", `${words} over time. ${lines.map((l) => `${l.name} ${spread(l)}`).join("; ")}`);
  const self = { plot: null, near: false, seen: false, width: 0, stale: true, paint(always) { if (always || (self.near && (self.stale || self.width !== Math.floor(box.clientWidth)))) paint(self, box, data, lines, options, view, readout); } };
  box.style.minHeight = `${options.height || 170}px`;
  plots.add(self);
  new ResizeObserver(() => { if (!box.isConnected) { self.plot?.destroy(); plots.delete(self); } else self.paint(); }).observe(box);
  new IntersectionObserver((seen) => { self.near = seen.at(-1).isIntersecting; self.paint(); }, { rootMargin: "400px" }).observe(box); // far below it waits
  new IntersectionObserver((seen) => { self.seen = seen.at(-1).isIntersecting; if (self.stale) self.paint(); }).observe(box);
  view.watch(() => { if (self.seen && self.plot) self.plot.setScale("x", { min: view.range()[0], max: view.range()[1] }); else self.stale = true; });
  view.rested(() => { if (self.stale) self.paint(); });
  const rows = () => [["time_s", ...lines.map((l) => l.name)], ...Array.from(data[0], (t, i) => [t, ...data.slice(1).map((y) => y[i])])];
  return el("figure", null, el("figcaption", null, el("b", null, words), legend, keepers(title, () => drawn(title, data, lines, options, view), rows)), box, readout);
}

function paint(self, box, data, lines, options, view, readout) {
  const width = Math.floor(box.clientWidth);
  if (!width) return;
  self.plot?.destroy();
  self.width = width;
  self.stale = false;
  const axis = { stroke: look("soft"), grid: { stroke: look("grid"), width: 1 }, ticks: { stroke: look("line"), width: 1 }, font: "12px system-ui, sans-serif" };
  const [from, to] = view.range();
  self.plot = new uPlot({
    width, height: options.height || 170, legend: { show: false }, pxAlign: false, cursor: { sync: { key: "time" }, drag: { x: true, y: false }, y: false },
    scales: { x: { time: false, min: from, max: to }, y: { range: options.band ? (u, low, high) => { const m = Math.max(Math.abs(low), Math.abs(high), 2.5 * options.band); return [-m, m]; } : (u, low, high) => uPlot.rangeNum(low ?? 0, high ?? 1, 0.08, true) } },
    axes: [{ ...axis, size: 30, space: 70, values: (u, v) => onAxis(v) }, { ...axis, size: 56, space: 26, values: (u, v) => onAxis(v) }],
    series: [{}, ...lines.map((l) => ({ stroke: look(l.look), width: l.width || (data[0].length > DENSE * width ? 1 : 1.6), dash: l.look.includes("dashed") ? [7, 5] : l.look.includes("dots") ? [2, 4] : undefined, points: { show: false }, spanGaps: false, ...(data.holes?.length ? { gaps: torn(data.holes) } : {}) }))],
    hooks: {
      setSelect: [(u) => { if (u.select.width > 4) { view.set(u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x")); u.setSelect({ width: 0, height: 0 }, false); } }],
      setCursor: [(u) => { readout.textContent = told(u, data, lines, options); }],
      drawClear: options.band ? [(u) => { const a = u.valToPos(options.band, "y", true), b = u.valToPos(-options.band, "y", true); u.ctx.fillStyle = look("band"); u.ctx.fillRect(u.bbox.left, a, u.bbox.width, b - a); }] : [],
    },
  }, data, box);
}

/** What stands under the cursor, and how far each line is from the first. */
function told(u, data, lines, options) {
  const i = u.cursor.idx;
  if (i === null || i === undefined) return "";
  const at = (k) => { for (let d = 0; d < 40; d++) for (const j of [i - d, i + d]) { const v = data[k + 1][j]; if (v === v && v !== null && v !== undefined) return v; } return null; };
  const first = at(0);
  return `${asGiven(data[0][i], 6)} s: ${lines.map((l, k) => { const v = at(k); return `${l.name} ${asGiven(v, 5)}${k && first !== null && v !== null && options.compared ? ` (${v - first >= 0 ? "+" : "−"}${num(Math.abs(v - first), 3)})` : ""}`; }).join(" · ")} ${options.unit || ""}`;
}

/** The same as a drawing, to be saved. */
function drawn(title, data, lines, options, view) {
  const width = 900, height = 300, left = 60, [a, b] = view.range(), ys = data.slice(1).flatMap((y) => Array.from(y).filter((v, i) => v === v && v !== null && v !== undefined && data[0][i] >= a && data[0][i] <= b));
  let low = Infinity, high = -Infinity;
  for (const v of ys) { if (v < low) low = v; if (v > high) high = v; }
  if (!(low < high)) { low -= 1; high += 1; }
  const X = (t) => left + ((t - a) / (b - a)) * (width - left - 12), Y = (v) => height - 30 - ((v - low) / (high - low)) * (height - 60), out = svg("svg", { viewBox: `0 0 ${width} ${height}` });
  for (const [v, said] of marked(low, high, 5)) out.append(svg("path", { class: "grid", d: `M${left} ${Y(v)}H${width - 12}` }), svg("text", { x: left - 6, y: Y(v) + 4, "text-anchor": "end" }, said));
  for (const [t, said] of marked(a, b, 8)) out.append(svg("text", { x: X(t), y: height - 12, "text-anchor": "middle" }, `${said} s`));
  out.append(svg("text", { class: "strong", x: left, y: 16 }, `${title}${options.unit ? ` [${options.unit}]` : ""}: ${lines.map((l) => l.name).join(", ")}`));
  lines.forEach((l, k) => {
    let d = "", up = true;
    data[0].forEach?.((t, i) => { const v = data[k + 1][i]; if (v === undefined || t < a || t > b) return; if (v === null || v !== v) { up = true; return; } d += `${up ? "M" : "L"}${X(t).toFixed(1)} ${Y(v).toFixed(1)}`; up = false; });
    out.append(svg("path", { class: `l ${l.look}`, d }));
  });
  out.classList.add("skip");
  document.body.append(out); // so that its colours are known while it is copied
  setTimeout(() => out.remove(), 0);
  return out;
}

/** All plots in new colours. */
export function repaint() { for (const p of plots) { p.stale = true; p.paint(); } }

const paper = document.documentElement.classList; // the page is as wide as paper is while it is drawn for it
window.addEventListener("beforeprint", () => { paper.add("paper"); for (const p of plots) p.paint(true); });
window.addEventListener("afterprint", () => { paper.remove("paper"); repaint(); });
