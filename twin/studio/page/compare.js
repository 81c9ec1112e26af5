// Compare: error against horizon, where it is large, the missing force; several answers on top of each other.

import { address, change, found, start, state, unpack } from "/app/api.js";
import { button, card, choose, clock, el, field, named, table } from "/app/dom.js";
import { asGiven, num } from "/app/number.js";
import { chart, heatStrip, ways } from "/app/draw.js";
import { there } from "/app/lines.js";
import { timePlot, timeView, zoomer } from "/app/plot.js";
import { kept as saved } from "/app/save.js";
import { answerOf, earlier, foot, go, kept, lacks, pickVoyages, theShip } from "/app/shared.js";

export const LOOKS = ["c-model", "c-second", "c-third", "c-wrong"];
const CAUSE = "speed squared [kn2]";

export async function compare(r) {
  const out = [el("h1", null, "Compare the model with measurements"), lacks(), asker(r.item)];
  if (!r.item) return out;
  const names = r.item.split("+"), all = await Promise.all(names.map(answerOf)), done = all.filter((a) => a.result);
  out.push(all.filter((a) => a.waiting).map((a) => a.waiting));
  if (done.length) out.push(answers(done, r));
  return out;
}

function asker(item) {
  const ship = theShip("compare"), v = pickVoyages("voyages", "compare.voyages", ["voyage"]), jobs = state.jobs.filter((j) => j.verb === "compare" && j.state === "done");
  const asked = () => start({ verb: "compare", ship: state.kept["compare.ship"], voyages: [...v.set] });
  const open = new Set(item ? item.split("+") : []);
  const stack = jobs.length > 1 ? el("fieldset", null, el("legend", null, "on top of each other"), jobs.map((j) => el("label", null, el("input", { type: "checkbox", id: `on-${j.name}`, checked: open.has(j.name), onchange: (e) => { e.target.checked ? open.add(j.name) : open.delete(j.name); location.hash = address("compare", [...open].join("+")); } }), label(j)))) : null;
  return el("section.card", { "aria-label": "What to compare" }, el("form", null, ship.select, v.box, go("Compare", asked, !ship.name)), stack, earlier("compare", "compare", item));
}

export const label = (job) => `${job.asked.ship.replace(/\.toml$/, "")} on ${(job.asked.voyages || []).map((v) => v.replace(/\.mcap$/, "")).join(", ")}`;

function answers(done, r) {
  const view = timeView(), first = done[0], voyages = first.view.voyages, name = r.query.get("voyage") || voyages[0].name, k = Math.max(0, voyages.findIndex((v) => v.name === name));
  const several = voyages.length > 1 ? field("voyage", choose("voyage", voyages.map((v) => [v.name, v.name]), voyages[k].name, (v) => change({ voyage: v, from: "", to: "" }))) : null;
  return [el("section.card", { "aria-label": "In a sentence" }, done.map((a) => el("p.big", null, done.length > 1 ? el("b", null, `${label(a.job)}: `) : null, a.result.verdict)), done.map((a) => (a.result.water_sentence ? el("p", null, a.result.water_sentence) : null))),
    el(".two", null, horizonCard(done), whereCard(first, view, voyages[k].name)),
    el("section.card", { "aria-label": "When" }, el("h2", null, `When: ${voyages[k].name}`), several, heatOf(voyages[k], view)),
    forcesCard(first, voyages[k].name, view, r),
    seriesCard(done, voyages[k], view), foot(first.job)];
}

/** Times the expected error from which it is more than it may be (the verdict's). */
const limitOf = (done) => Math.min(...done.map((a) => a.result.horizons.at(-1)?.noise_floor.limit95 ?? 1.5));

/** The error in the stream that the voyage itself shows; of one answer alone, and where it has it. */
function ownWater(rows, x, several) {
  return several || !rows.every((h) => h.own_water) ? [] : [{ name: "in its own stream", x, y: rows.map((h) => h.own_water.position_mae_m), look: "c-second" }];
}

/** Error against horizon, with what is expected of this ship. */
export function horizonCard(done) {
  const lines = done.flatMap((a, i) => {
    const rows = a.result.horizons, x = rows.map((h) => h.horizon_s), name = done.length > 1 ? label(a.job) : "model";
    return [{ name, x, y: rows.map((h) => h.position_mae_m), look: LOOKS[i % 4], points: true }, { name: i ? "" : "expected", x, y: rows.map((h) => h.noise_floor.position_mae_m), look: i ? `${LOOKS[i % 4]} dots` : "c-expected dashed" }, ...ownWater(rows, x, done.length > 1)];
  });
  const heads = ["after", ["position [m]"], ["expected [m]"], ["ratio"], ["across [m]"], ["heading [deg]"], ["expected [deg]"]];
  const rows = done.flatMap((a) => a.result.horizons.map((h) => [`${asGiven(h.horizon_s)} s${done.length > 1 ? `, ${label(a.job)}` : ""}`, h.position_mae_m, h.noise_floor.position_mae_m, h.position_mae_m / h.noise_floor.position_mae_m, h.lateral_mae_m, h.heading_mae_deg, h.noise_floor.heading_mae_deg]));
  const shown = rows.map((row) => row.map((c, i) => (i ? el("span", { class: i === 3 ? (c > limitOf(done) ? "bad" : c > 1.15 ? "fair" : "good") : null, title: String(c) }, num(c)) : c)));
  return card("How wrong, by how far ahead", chart("Position error, open loop", lines, { zero: "both", x: "seconds ahead", y: "m" }), saved("Errors by horizon", heads, rows, table("Mean absolute errors, open loop from the measured state", heads, shown)));
}

function whereCard(a, view, voyage) {
  const { where, worst_windows: worst } = a.result;
  const rows = worst.map((w) => [el("span", null, button(`${clock(w.start_s)} to ${clock(w.end_s)}`, () => { if (w.voyage !== voyage) change({ voyage: w.voyage, from: w.start_s.toFixed(2), to: w.end_s.toFixed(2) }); else view.set(w.start_s, w.end_s); document.getElementById("series")?.scrollIntoView(); }, { class: "small", "aria-label": `${clock(w.start_s)} to ${clock(w.end_s)} of ${w.voyage}, show it` })), w.voyage, num(w.position_m), num(w.heading_deg), num(w.error_ratio)]);
  const force = a.result.unexplained_force;
  return card("Where it is wrong", where.length ? table("Conditions in which the error is larger than elsewhere", ["condition", ["times elsewhere"], ["share of the time"]], where.map((w) => [w.condition, num(w.error_ratio), `${num(100 * w.time_share)} %`])) : el("p", null, "No condition of sailing stands out beyond chance."),
    table("Worst predictions", ["when", "voyage", ["position [m]"], ["heading [deg]"], ["times the mean"]], rows),
    el("p.note", null, `Of the forces at work the model misses, beyond noise: surge ${num(100 * force.surge)} %, sway ${num(100 * force.sway)} %, yaw ${num(100 * force.yaw)} %.`),
    a.result.switched_off.map((s) => el("p.note", null, `Switched off on ${s.voyage}: ${s.effect}, because ${s.not_measured.join(", ")} was not recorded.`)));
}

export function heatOf(v, view) {
  return heatStrip(v.name, { t: unpack(v.heat.t), end_s: v.end_s, rows: v.heat.rows.map((row) => ({ name: row.name, y: unpack(row.y) })) }, view);
}

const AXES = { X_N: ["X, ahead", "kN", 1e-3], Y_N: ["Y, to starboard", "kN", 1e-3], N_Nm: ["N, turning to starboard", "MN m", 1e-6] };

/** The force that the model misses: over time, against a cause, and whether it is random. */
export function forcesCard(a, voyage, view, r) {
  const f = a.view.forces.find((x) => x.name === voyage);
  if (!f) return null;
  const t = unpack(f.t), cause = f.causes[r.query.get("cause")] ? r.query.get("cause") : CAUSE in f.causes ? CAUSE : Object.keys(f.causes)[0], x = unpack(f.causes[cause]);
  const over = Object.entries(AXES).map(([axis, [title, unit, k]]) => timePlot(title, [{ name: "missing force", t, y: unpack(f.force[axis]).map((v) => k * v), look: "c-wrong" }], { unit, view, height: 140, band: k * f.noise[axis] || undefined }));
  const against = Object.entries(AXES).map(([axis, [title, unit, k]]) => chart(`${title} over ${cause}`, [{ name: "", x, y: unpack(f.force[axis]).map((v) => k * v), look: "c-wrong", only: true }], { x: cause, y: unit, height: 220 }));
  const pick = field("against", choose("cause", Object.keys(f.causes).map((c) => [c, c]), cause, (v) => change({ cause: v })));
  const heads = ["axis", ["mean"], "random?", "goes with"], rows = f.tests.map((test) => [AXES[test.axis][0], `${num(AXES[test.axis][2] * f.mean[test.axis])} ${AXES[test.axis][1]}`, random(test), strongest(test)]);
  return card("The missing force", el("p.note", null, "What would have to act on the ship, beside all that the model knows, for it to move as it was measured; means over half a ship length. Shaded: what the noise of the instruments alone gives (one standard deviation)."),
    el(".three", null, over), pick, el(".three", null, against), saved("Tests of the missing force", heads, rows, table("Tests of what is left: independent of itself (Ljung-Box) and of each cause (correlation, its own persistence counted)", heads, rows)));
}

const p_ = (p) => (p === null || p === undefined ? "–" : p < 0.001 ? "p < 0.001" : `p = ${num(p, 2)}`);
const random = (t) => (t.independent_p === null ? "too short to be told" : t.independent_p < 0.01 ? `no: it lasts (${p_(t.independent_p)})` : `nothing speaks against it (${p_(t.independent_p)})`);
function strongest(t) {
  const found_ = t.causes.filter((c) => c.p !== null && c.p < 0.01 / Math.max(t.causes.length, 1)).sort((a, b) => a.p - b.p);
  return found_.length ? found_.map((c) => `${c.cause} (r = ${num(c.correlation, 2)}, ${p_(c.p)})`).join("; ") : "none of them clearly";
}

/** Every channel: measured, and predicted by each model; the difference below. */
export function seriesCard(done, v, view, extra) {
  const others = done.map((a) => ({ a, voyage: a.view.voyages.find((o) => o.name === v.name) })).filter((o) => o.voyage);
  const plots = v.channels.map((c) => {
    const [title, unit] = named(c.name), T = (voyage, i) => unpackOnce(voyage, i), lines = [{ name: "measured", t: T(v, c.measured.t), y: unpack(c.measured.y), look: "c-measured", width: 2.2 }], off = [];
    others.forEach(({ a, voyage }, i) => {
      const o = voyage.channels.find((x) => x.name === c.name);
      for (const [key, line] of Object.entries(o?.lines || {})) {
        const name = extra?.name(key, a) ?? (done.length > 1 ? label(a.job) : "predicted"), look = extra?.look(key, i) ?? LOOKS[i % 4];
        lines.push({ name, t: T(voyage, line.t), y: unpack(line.y), look, gaps: voyage.restarts });
        const residual = o.residuals[key];
        off.push({ name: `measured − ${name}`, ...there(T(voyage, residual.t), unpack(residual.y)), look, gaps: voyage.restarts });
      }
    });
    for (const more of extra?.lines?.(c.name) || []) {
      const first = v.channels.find((x) => x.name === c.name), key = Object.keys(first.lines)[0], without = unpack(first.lines[key].y), residual = unpack(first.residuals[key].y);
      lines.push({ ...more, t: T(v, v.grid), gaps: v.restarts });
      off.push({ ...more, name: `measured − ${more.name}`, ...there(T(v, v.grid), residual.map((x, i) => x + without[i] - more.y[i])), gaps: v.restarts });
    }
    return [timePlot(title, lines, { unit, view, compared: true }), timePlot(`${title}, difference`, off, { unit, view, height: 100, band: c.noise || undefined })];
  });
  const inputs = v.inputs.map((c) => { const [title, unit] = named(c.name); return timePlot(title, [{ name: "recorded", t: unpackOnce(v, c.measured.t), y: unpack(c.measured.y), look: "c-measured" }], { unit, view, height: 110 }); });
  const way = [{ name: "measured", x: unpack(v.track.y), y: unpack(v.track.x), look: "c-measured" }, ...others.flatMap(({ a, voyage }, i) => Object.entries(voyage.track.lines).map(([key, l]) => ({ name: extra?.name(key, a) ?? "predicted", x: unpack(l.y), y: unpack(l.x), look: extra?.look(key, i) ?? LOOKS[i % 4] })))];
  const s = card(`Measured and predicted: ${v.name}`, el("p.note", null, `The prediction starts anew from the measured state every ${asGiven(done[0].view.longest_s)} s; it is never fitted to the voyage. Drag across a plot to see less time.`), zoomer(view), el(".two", null, plots.flat()), el("details", null, el("summary", null, `Controls and weather (${inputs.length})`), el(".three", null, inputs)), el("details", null, el("summary", null, "The way over ground"), ways(`Way over ground, ${v.name}`, way)));
  s.id = "series";
  return s;
}

const known = new WeakMap();
function unpackOnce(voyage, i) {
  if (!known.has(voyage)) known.set(voyage, []);
  const have = known.get(voyage);
  have[i] ??= unpack(voyage.times[i]);
  return have[i];
}

export { found, kept };
