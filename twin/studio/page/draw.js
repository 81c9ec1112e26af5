// Drawings as SVG: lines over any axis, ways over ground, heat strips. Colours are classes, so that each light has its own.

import { el, named, svg } from "/app/dom.js";
import { asGiven, num, onAxis } from "/app/number.js";
import { keepers } from "/app/save.js";

/** The marks of an axis: [where, what is said there]. */
export function marked(low, high, count) {
  const raw = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw * 0.999), out = [];
  for (let v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) out.push(Math.abs(v) < step * 1e-6 ? 0 : v);
  return onAxis(out).map((said, i) => [out[i], said]);
}

const finite = (list) => [...list].filter((v) => v === v && v !== null);

/** Lines: [{ name, x, y, look ("c-model dashed"), points }]; options: x, y (axis words), zero, equal, same, height, marks [{y, text}]. */
export function chart(title, lines, options = {}) {
  const box = el(".draw"), legend = el("span.legend", null, lines.filter((l) => l.name).map((l) => el("span", null, el(`i.${l.look.replaceAll(" ", ".")}`), l.name)));
  let drawing = null;
  const paint = () => { drawing = lined(title, lines, options, Math.max(Math.round(box.clientWidth) || 480, 240)); box.replaceChildren(drawing); };
  new ResizeObserver(paint).observe(box);
  const rows = () => [["line", options.x || "x", options.y || "y"], ...lines.flatMap((l) => Array.from(l.x, (x, i) => [l.name, x, l.y[i]]))];
  return el("figure", null, el("figcaption", null, el("b", null, title), legend, keepers(title, () => drawing, rows)), box);
}

function lined(title, lines, o, width) {
  const height = o.height || 260, left = 52, right = 14, top = 12, bottom = 36, xs = finite(lines.flatMap((l) => [...l.x])), ys = finite(lines.flatMap((l) => [...l.y]).concat((o.marks || []).map((m) => m.y)));
  let [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  if (!xs.length || !ys.length) [x0, x1, y0, y1] = [0, 1, 0, 1];
  if (o.zero) { y0 = Math.min(y0, 0); if (o.zero === "both") x0 = Math.min(x0, 0); }
  const room = 0.06 * (y1 - y0) || 0.5;
  y1 += room; if (!o.zero || y0 < 0) y0 -= room;
  if (x1 === x0) { x0 -= 0.5; x1 += 0.5; }
  let kx = (width - left - right) / (x1 - x0), ky = (height - top - bottom) / (y1 - y0);
  if (o.equal) {
    const k = Math.min(kx, ky), mx = (x0 + x1) / 2, my = (y0 + y1) / 2;
    x0 = mx - (width - left - right) / k / 2; x1 = mx + (width - left - right) / k / 2; y0 = my - (height - top - bottom) / k / 2; y1 = my + (height - top - bottom) / k / 2;
    kx = ky = k;
  }
  const X = (x) => left + (x - x0) * kx, Y = (y) => height - bottom - (y - y0) * ky;
  const words = `${title}. ${lines.filter((l) => l.name).map((l) => `${l.name}: ${summary(l)}`).join("; ")}`;
  const out = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": words });
  for (const [t, said] of marked(y0, y1, Math.max(2, height / 55))) out.append(svg("path", { class: "grid", d: `M${left} ${Y(t).toFixed(1)}H${width - right}` }), svg("text", { x: left - 6, y: Y(t) + 4, "text-anchor": "end" }, said));
  for (const [t, said] of marked(x0, x1, Math.max(2, (width - left) / 85))) out.append(svg("path", { class: "grid", d: `M${X(t).toFixed(1)} ${top}V${height - bottom}` }), svg("text", { x: X(t), y: height - bottom + 15, "text-anchor": "middle" }, said));
  out.append(svg("text", { class: "strong", x: (left + width - right) / 2, y: height - 4, "text-anchor": "middle" }, o.x || ""), svg("text", { class: "strong", x: 2, y: 10 }, o.y || ""));
  for (const m of o.marks || []) out.append(svg("path", { class: "l c-wrong dashed", d: `M${left} ${Y(m.y)}H${width - right}` }), svg("text", { class: "strong", x: width - right, y: Y(m.y) - 5, "text-anchor": "end" }, m.text));
  for (const l of lines) {
    const points = Array.from(l.x, (x, i) => [X(x), Y(l.y[i])]);
    if (!l.only) out.append(svg("path", { class: `l ${l.look}`, d: way(points) }));
    if (l.points || l.only) for (const [x, y] of points) if (y === y) out.append(svg("circle", { class: `${l.look} fill`, cx: x.toFixed(1), cy: y.toFixed(1), r: l.only ? 2 : 4 }));
  }
  return out;
}

function way(points) {
  let d = "", up = true;
  for (const [x, y] of points) {
    if (x !== x || y !== y) { up = true; continue; }
    d += `${up ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`;
    up = false;
  }
  return d;
}

function summary(l) {
  const y = finite(l.y);
  return y.length ? `${y.length} points, ${num(Math.min(...y))} to ${num(Math.max(...y))}, last ${num(y.at(-1))}` : "nothing";
}

export const HEAT_TOP = 16;
const STEPS = [1.5, 4, 9]; // times the noise, where a colour begins

/** Channel over time: how many times its noise each channel is off. */
export function heatStrip(voyage, heat, view) {
  if (!heat.rows.length) return el("p.note", null, `On ${voyage} no prediction ends where the position was read: there is nothing to colour.`);
  const title = `Error over noise, ${voyage}`, box = el(".draw");
  let drawing = null;
  const paint = () => {
    const width = Math.max(Math.round(box.clientWidth) || 480, 240), names = width < 520 ? 112 : 190, row = 21, end = heat.t.length > 1 ? heat.t.at(-1) + heat.t[1] - heat.t[0] : heat.end_s, X = (t) => names + ((t - heat.t[0]) / (end - heat.t[0])) * (width - names), height = row * heat.rows.length + 22;
    const worst = heat.rows.map((r) => [named(r.name)[0], Math.max(...finite(r.y))]).sort((a, b) => b[1] - a[1])[0];
    drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${title}: largest in ${worst[0]}, ${num(worst[1])} times its noise` });
    heat.rows.forEach((r, k) => {
      drawing.append(svg("text", { x: 0, y: k * row + 15 }, short(named(r.name)[0], names)));
      for (let i = 0; i < heat.t.length; i++) {
        if (r.y[i] !== r.y[i]) continue;
        const x = X(heat.t[i]), next = i + 1 < heat.t.length ? X(heat.t[i + 1]) : width, look = STEPS.filter((s) => r.y[i] >= s).length;
        drawing.append(svg("rect", { class: `heat${look}`, x: x.toFixed(1), y: k * row + 1, width: (next - x + 0.6).toFixed(1), height: row - 2 }));
      }
    });
    for (const [t, said] of marked(heat.t[0], end, Math.max(2, (width - names) / 90))) if (X(t) < width - 20) drawing.append(svg("text", { x: X(t), y: height - 5, "text-anchor": "middle" }, `${said} s`));
    if (view.from !== null) drawing.append(svg("rect", { class: "heatbox", x: X(Math.max(view.from, heat.t[0])), y: 0.8, width: Math.max(X(Math.min(view.to, end)) - X(Math.max(view.from, heat.t[0])), 2), height: height - 22 }));
    box.replaceChildren(drawing);
  };
  new ResizeObserver(paint).observe(box);
  view.watch(paint);
  const words = ["below 1.5", "1.5 to 4", "4 to 9", "9 and more"], key = words.map((w, i) => el("span", null, svg("svg", { width: 15, height: 11, "aria-hidden": "true" }, svg("rect", { class: `heat${i}`, width: 15, height: 11 })), ` ${w}`));
  const rows = () => [["time_s", ...heat.rows.map((r) => r.name)], ...Array.from(heat.t, (t, i) => [t, ...heat.rows.map((r) => r.y[i])])];
  return el("figure", null, el("figcaption", null, el("b", null, title), el("span.legend", null, "times the noise: ", key), keepers(title, () => drawing, rows)), box);
}

const short = (text, width) => (text.length > width / 6.4 ? text.replace("through water", "water").replace("velocity", "vel.") : text);

/** The way over ground, north up. */
export function ways(title, lines) { return chart(title, lines, { equal: true, x: "east [m]", y: "north [m]", height: 380 }); }

/** Whiskers: rows of { name, before: [value, sd], after: [value, sd] } each on its own scale of prior widths. */
export function whiskers(title, rows) {
  const row = 26, width = 560, left = 120, height = row * rows.length + 30, X = (z) => left + ((z + 3) / 6) * (width - left - 90);
  const out = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${title}: ${rows.length} numbers, the table below says them` });
  for (const z of [-2, 0, 2]) out.append(svg("path", { class: "grid", d: `M${X(z)} 4V${height - 24}` }), svg("text", { x: X(z), y: height - 8, "text-anchor": "middle" }, z ? `${z} sd` : "prior"));
  rows.forEach((r, i) => {
    const y = i * row + 16, z = (v) => Math.max(-3, Math.min(3, (v - r.prior) / r.prior_sd));
    out.append(svg("text", { class: "strong", x: 0, y: y + 4 }, r.name), svg("path", { class: "l c-measured", d: `M${X(-1.96)} ${y - 4}H${X(1.96)}` }), svg("path", { class: "l c-model", d: `M${X(z(r.value - 1.96 * r.sd))} ${y + 3}H${X(z(r.value + 1.96 * r.sd))}` }), svg("circle", { class: "c-model fill", cx: X(z(r.value)), cy: y + 3, r: 4 }), svg("text", { x: width - 80, y: y + 5 }, asGiven(r.value, 4)));
  });
  return el("figure", null, el("figcaption", null, el("b", null, title), el("span.legend", null, el("span", null, el("i.c-measured"), "prior, 95 %"), el("span", null, el("i.c-model"), "after, 95 %")), keepers(title, () => out, () => [["name", "prior", "prior_sd", "value", "sd"], ...rows.map((r) => [r.name, r.prior, r.prior_sd, r.value, r.sd])])), el(".draw", null, out));
}
