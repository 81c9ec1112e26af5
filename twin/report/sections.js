// The parts of the page that every verb has.
const EXPECTED = { sensors: "what a perfect model would show through these instruments", "reference voyages": "what predictions of this ship's reference voyages were off by, each left out of the fit" };
const MEASURES = [["position", "position_mae_m", "m"], ["across", "lateral_mae_m", "m"], ["heading", "heading_mae_deg", "deg"]];

/** Times the expected error from which it is more than it may be; as the verdict has it (open_loop_comparison.py). */
function limit() {
  const last = RESULT.horizons[RESULT.horizons.length - 1];
  return (last && last.noise_floor.limit95) || 1.5;
}

/** Errors by horizon over the expected ones, on one logarithmic scale. */
function errorsSection() {
  const rows = [], all = [];
  for (const h of RESULT.horizons) for (const [word, key, unit] of MEASURES) {
    const floor = h.noise_floor[key], now = (h.after || h)[key], then = h.before ? h.before[key] : null;
    rows.push({ horizon: h.horizon_s, word, unit, floor, now, then, x: now / floor, x0: then === null ? null : then / floor });
    all.push(now / floor, then === null ? 1 : then / floor);
  }
  const top = Math.max(4, ...all.filter(isFinite)) * 1.25, low = Math.min(0.5, ...all.filter((x) => isFinite(x) && x > 0)) / 1.25, P = (x) => `${(100 * Math.log(Math.max(x, low) / low)) / Math.log(top / low)}%`;
  const box = el(".errors");
  let last = null;
  for (const r of rows) {
    box.append(el(".what", null, r.horizon === last ? "" : el("b", null, `${r.horizon} s ahead`)), scale(r, P), said(r));
    last = r.horizon;
  }
  const marks = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500].filter((x) => x <= top && x >= low);
  const ticks = el(".ticks", null, marks.map((x) => el("span", { style: { left: P(x) } }, x === 1 ? "expected" : `×${x}`)));
  box.append(el("div"), ticks, el("div"));
  const about = `open loop from the measured state, ${RESULT.horizons.map((h) => h.windows).slice(-1)[0]} windows; expected: ${EXPECTED[RESULT.horizons.length ? RESULT.horizons[0].noise_floor.of : "sensors"] || "what instruments and the calibrated model's own limits leave"}`;
  const key = rows.some((r) => r.then !== null) ? [["var(--before)", "before"], ["var(--model)", "after"]] : [["var(--good)", `below ${num(limit(), 3)} times the expected`], ["var(--model)", "more"]];
  const legend = el(".legend", null, key.map(([colour, word]) => el("span", null, el("i.box", { style: { background: colour } }), word)));
  return section("Error over the expected error", about, legend, box, forces());
}

function scale(r, P) {
  const out = el(".scale", null, el(".axis"), el(".one", { style: { left: P(1) } }));
  if (r.then === null) out.append(el(".bar", { style: { left: "0", width: P(r.x), background: r.x < limit() ? "var(--good)" : "" } }));
  else {
    const [a, b] = [Math.min(r.x, r.x0), Math.max(r.x, r.x0)];
    out.append(el(".fall", { style: { left: P(a), width: `calc(${P(b)} - ${P(a)})`, background: r.x < r.x0 ? "" : "var(--bad)" } }));
    out.append(el(".dot", { style: { left: P(r.x0) }, title: "before" }), el(".dot.after", { style: { left: P(r.x) }, title: "after" }));
  }
  return out;
}

function said(r) {
  const now = `${num(r.now)} ${r.unit}`, value = r.then === null ? now : `${num(r.then)} → ${now}`;
  return el(".say", null, `${r.word} `, el("b", null, value), ` · ×${num(r.x, 2)} · expected ${num(r.floor, 2)}`);
}

function forces() {
  const out = el(".forces"), share = RESULT.unexplained_force || {};
  const parts = Object.entries(share).map(([axis, x]) => el("span", null, `${axis} `, el("b", null, `${num(100 * x, 2)} %`)));
  if (parts.length) out.append("Force the model misses, beyond noise:", ...parts);
  if (RESULT.learned_share) out.append(el("span", null, "learned share of all force ", el("b", null, `${num(100 * RESULT.learned_share, 2)} %`)));
  return out;
}

function whereSection() {
  const list = RESULT.where || [];
  const about = "conditions that stand out beyond chance";
  if (list.length && "before_m" in list[0]) {
    const rows = list.map((w) => el("tr", null, el("td", null, w.condition), el("td.n", null, `${num(100 * w.time_share, 2)} %`), el("td.n", null, num(w.before_m)), el("td.n", null, num(w.after_m)), el("td.n", null, `×${num(w.after_m / w.before_m, 2)}`)));
    return section("Where the error fell", "held-out position error [m]", table(["condition", ">time", ">before", ">after", ">ratio"], rows));
  }
  if (!list.length) return section("Where it fails", null, el("p.note", null, "No condition of wind, speed, rudder, turning, depth, time or place stands out beyond chance: the error is spread over the voyage."));
  const most = Math.max(...list.map((w) => w.error_ratio));
  const rows = list.map((w) => el("tr", null, el("td", null, w.condition), el("td.n", null, `${num(100 * w.time_share, 2)} %`), el("td", null, bar(w.error_ratio / most), `×${num(w.error_ratio, 2)}`)));
  return section("Where it fails", about, table(["condition", ">time", "error against elsewhere"], rows));
}

function bar(share) {
  return el("span.bar100", null, el("i", { style: { width: `${100 * Math.min(share, 1)}%` } }));
}

/** A row about a stretch of a voyage: a click shows it in the plots. */
function stretchRow(w, ...cells) {
  const go = () => { pickVoyage(Math.max(DATA.voyages.findIndex((v) => v.name === w.voyage), 0)); const pad = 0.25 * (w.end_s - w.start_s); setZoom(w.start_s - pad, w.end_s + pad); document.getElementById("plots").scrollIntoView({ behavior: "smooth" }); };
  return el("tr.go", { onclick: go, tabIndex: 0, onkeydown: (e) => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); go(); } }, "aria-label": `Show ${clock(w.start_s)} to ${clock(w.end_s)} in the plots` }, DATA.voyages.length > 1 ? el("td", null, w.voyage || "") : null, el("td", null, `${clock(w.start_s)} to ${clock(w.end_s)}`), ...cells);
}

function worstSection() {
  const many = DATA.voyages.length > 1;
  const rows = (RESULT.worst_windows || []).map((w) => stretchRow(w, el("td.n", null, w.position_m === undefined ? "" : num(w.position_m)), el("td.n", null, w.heading_deg === undefined ? "" : num(w.heading_deg, 2)), el("td.n", null, `×${num(w.error_ratio, 2)}`)));
  return section("Worst windows", "choose one to see it in the plots", table([...(many ? ["voyage"] : []), "when", ">off [m]", ">[deg]", ">of the mean"], rows));
}

function channelsSection() {
  const rows = Object.entries(RESULT.channels || {}).map(([name, c]) => { const [word, unit] = named(name); return el("tr", null, el("td", null, word), el("td.n", null, `${num(c.mae)} ${unit}`), el("td.n", null, num(c.noise, 2)), el("td.n", null, `×${num(c.mae / c.noise, 2)}`), el("td.n", null, c.r2 === null || c.r2 === undefined ? "–" : c.r2.toFixed(3)), el("td.n", null, c.skill === null || c.skill === undefined ? "–" : c.skill.toFixed(3))); });
  const note = el("p.note", null, `Mean over every moment up to ${DATA.longest_s} s ahead. Skill: share of the squared error of dead reckoning (speeds of the start held) that the model removes; below 0 it is worse than that.`);
  return section("Channels", null, table(["channel", ">error", ">expected", ">ratio", ">R²", ">skill"], rows), note);
}

function checksSection() {
  const list = RESULT.data_checks;
  if (!list || !list.length) return null;
  const bad = list.filter((c) => !c.ok), many = new Set(list.map((c) => c.voyage)).size > 1;
  const row = (c) => el("tr", null, el("td", null, el(`span.${c.ok ? "good" : "fair"}`, null, !c.ok ? "look" : c.text.startsWith("cannot tell") ? "?" : "ok")), many ? el("td", null, c.voyage || "") : null, el("td", null, c.check.replaceAll("_", " ")), el("td", null, c.text));
  const heads = ["", ...(many ? ["voyage"] : []), "check", "what it saw"];
  const rest = el("details", null, el("summary", { style: { cursor: "pointer", color: "var(--soft)", fontSize: "13px", marginTop: "8px" } }, `${list.length - bad.length} checks passed`), table(heads, list.filter((c) => c.ok).map(row)));
  return section("Data checks", bad.length ? `${bad.length} to look at` : "nothing speaks against the data", bad.length ? table(heads, bad.map(row)) : null, rest);
}

function provenanceSection() {
  const files = (list) => (list || []).map((v) => el("tr", null, el("td", null, (v.name || String(v)) + (v.part ? ` (${v.part})` : "")), el("td", null, v.start_time_utc || ""), el("td", null, el("code", null, (v.sha256 || "").slice(0, 16)))));
  const out = [];
  const model = RESULT.model ? ["core", ...RESULT.model.effects, ...(RESULT.model.residual ? ["residual"] : [])].join(" + ") + (RESULT.model.hash ? `, hash ${RESULT.model.hash}` : "") : null;
  if (model) out.push(el("p.note", null, `Model: ${RESULT.ship}, ${model}`));
  for (const said of RESULT.told_of_waves || []) out.push(el("p.note", null, said));
  for (const s of RESULT.switched_off || []) out.push(el("p.note", null, `Switched off on ${s.voyage}: ${s.effect}, because ${s.not_measured.join(", ")} was not recorded.`));
  for (const n of RESULT.notes || []) out.push(el("p.note", null, typeof n === "string" ? n : JSON.stringify(n)));
  const rows = [...files(RESULT.voyages), ...(RESULT.held_out ? files(RESULT.held_out).map((r) => (r.firstChild.append(" · held out"), r)) : [])];
  if (rows.length) out.push(table(["voyage", "began", "sha256"], rows));
  if (RESULT.command) out.push(command(RESULT.command));
  return out.length ? section("Provenance", null, ...out) : null;
}
