// What diagnose and add show beside the common parts: ranking, next manoeuvre, what was fitted, the ladder.
function addCommand(names) {
  const f = RESULT.files || {};
  return `twin add ${[].concat(names).join(" ")} --ship ${quoted(f.ship || "SHIP.toml")} --voyage ${(f.voyages || ["VOYAGE.mcap"]).map(quoted).join(" ")} -o ${quoted(f.better || "better.toml")}`;
}

function rankingSection() {
  const undecided = RESULT.verdict === "undecided", like = undecided ? "It may be something like this" : "It resembles this";
  const forms = (RESULT.resembles || []).flatMap((c) => [el("p.note", null, `${like}, which is not in the catalogue of effects. ${c.says}`), candidate(c)]);
  const causes = (RESULT.candidates || []).map(candidate), out = undecided ? [...causes, ...forms] : [...forms, ...causes];
  if (!out.length) out.push(el("p.note", null, "No cause is likely enough to be shown."));
  if ((RESULT.weather || []).length) out.push(el("p.note", { style: { marginTop: "10px" } }, "Today's water and wind, allowed for whatever is missing: " + RESULT.weather.map((w) => `${w.effect} (${(w.stream || []).length ? streamInWords(w.stream) : w.parameters.map(readable).map((p) => withUnit(`${p.name} ${num(p.value)}`, p)).join(", ")}${w.probability < 0.5 ? ", no more than any day brings" : ""})`).join("; ")));
  for (const w of RESULT.weather || []) {
    if ((w.beyond_file || []).length) out.push(el("p.note", null, `The ship file has ${w.beyond_file.map((p) => `${p.name} ${num(p.value, 3)} +- ${num(p.sd, 2)}`).join(", ")}: today's is beyond that, and what is told as ${w.effect} may be something else that acts like it.`));
  }
  if ((RESULT.rivals || []).length > 1) out.push(el("p.note", { style: { marginTop: "10px" } }, "Rivals (log odds behind the first; error on held-out parts): " + RESULT.rivals.map((r) => `${r.effects.join(" + ") || "nothing"} (${num(r.log_bayes_factor)}${r.error_m === null ? "" : `; ${num(r.error_m)} m`})`).join(", ")));
  if (RESULT.p_value_sentence) out.push(el("p.note", { style: { marginTop: "10px" } }, RESULT.p_value_sentence));
  const missing = (RESULT.answer || {}).lasting || RESULT.missing || [];
  if (missing.length) out.push(el("p.note", { style: { marginTop: "10px" } }, "Add what is missing, and see whether the error falls on measurements that were not used:"), command(addCommand(missing)));
  const words = (x) => (typeof x === "string" ? x : [x.effect, x.why || (x.lacks || x.not_measured || []).map((n) => `no ${n}`).join(", ")].filter(Boolean).join(": "));
  for (const [key, said] of [["calibrated_on", "The ship was calibrated on this, so that a fault it had then is part of the model: "], ["not_judged", "Could not be judged: "], ["as_on_references", "No stronger than on the reference voyages, allowed for and not called missing: "], ["not_visible", "Too small to be seen in these voyages, even at a plausible size: "], ["learned_since", "Newer than the ship's calibration, and named less surely until it is calibrated again: "]]) {
    if ((RESULT[key] || []).length) out.push(el("p.note", { style: { marginTop: "8px" } }, said + RESULT[key].map(words).join("; ")));
  }
  return section("Which effect is missing", "judged together; forces are typical of these voyages", ...out);
}

function candidate(c) {
  const force = c.typical_force || {}, weak = (c.probability || 0) < 0.1 && !(RESULT.missing || []).includes(c.effect);
  const left = el("div", null, el("h3", null, c.effect), el("div", null, bar(c.probability || 0), `${num(100 * (c.probability || 0), 2)} %`));
  const said = [["X_N", "along the ship", "N"], ["Y_N", "across it", "N"], ["N_Nm", "of turning", "N m"]].filter(([k]) => force[k]).map(([k, w, u]) => `${si(Math.abs(force[k]), u)} ${w}`);
  const right = el("div", null, said.length && !(c.stream || []).length ? el("div", { title: "root mean square over these voyages; the sign is in its numbers" }, `${said.join(", ")} (root mean square)`) : null, (c.stream || []).length > DATA.voyages.length ? el("div", null, streamInWords(c.stream)) : (c.parameters || []).length > 6 ? curve(c.parameters) : (c.parameters || []).map(parameter));
  if ((c.error_without ?? null) !== null && (c.error_with ?? null) !== null) right.append(el("p.note", null, `error ${num(c.error_without)} m without it, ${num(c.error_with)} m with it${c.error_floor ? `; ${num(c.error_floor)} m is expected even with the right cause` : ""}`));
  if (c.together_sd) right.append(el("p.note", null, `Each number alone may be ${c.parameters.some((p) => p.in_ship_file !== undefined) ? "what the ship file has" : "none"}, for its 95 % interval holds that; all together are ${num(c.together_sd)} standard deviations from it, so that it is named.`));
  if ((c.cannot_be_told_from || []).length) right.append(el("div", null, el("span.note", null, "cannot be told from "), c.cannot_be_told_from.map((n) => el("span.chip", null, n))));
  if ((c.over_time || []).length > 1) right.append(el("div", null, el("span.note", null, "part by part (1 is the size above) "), c.over_time.map((p) => el("span.chip", null, `${DATA.voyages.length > 1 && p.voyage ? `${p.voyage} ` : ""}${clock(p.start_s)} to ${clock(p.end_s)}: ${num(p.share, 2)} ± ${num(p.sd, 2)}`))));
  if (!weak && worthTrying(c.effect)) right.append(command(addCommand(c.effect)));
  return el(weak ? ".candidate.weak" : ".candidate", null, left, right);
}

/** A stream as a navigator says it, moment by moment where it changes. */
function streamInWords(rows) {
  const voyages = new Set(rows.map((r) => r.voyage)).size;
  return rows.map((r) => `${num(r.speed_mps, 2)} m/s toward ${Math.round(r.toward_deg)}°${rows.length > voyages ? ` at ${clock(r.time_s)}` : ""}${voyages > 1 ? ` on ${r.voyage}` : ""}`).join(", ");
}

/** Whether an effect that is not named may be added all the same: one of several when the voyages could not tell, or a rival of what is named. */
function worthTrying(effect) {
  const causes = RESULT.candidates || [], named = causes.filter((c) => (RESULT.missing || []).includes(c.effect));
  if (!causes.some((c) => c.effect === effect)) return false; // known by its form alone: no ship file holds it
  return RESULT.verdict === "undecided" || named.some((c) => (c.cannot_be_told_from || []).includes(effect));
}

/** Stretches on which a force pushed the ship that was not there before or after. */
function momentsSection() {
  const list = RESULT.moments || [];
  if (!list.length) return null;
  const rows = list.map((m) => stretchRow(m, el("td.n", null, si(m.X_N, "N")), el("td.n", null, si(m.Y_N, "N")), el("td.n", null, si(m.N_Nm, "N m"))));
  return section("Transient disturbances", "a force pushed the ship then, and not before or after; choose one to see it in the plots", table([...(DATA.voyages.length > 1 ? ["voyage"] : []), "when", ">ahead", ">to starboard", ">turning to starboard"], rows));
}

/** Many numbers that follow each other in time: a curve, with its 95 % band. */
function curve(numbers) {
  const list = numbers.map(readable), stems = [...new Set(list.map((p) => p.name.replace(/_?\d+$/, "")))];
  return el("div", null, stems.map((stem) => {
    const part = list.filter((p) => p.name.replace(/_?\d+$/, "") === stem), all = part.flatMap((p) => [p.low95, p.high95, 0]), low = Math.min(...all), high = Math.max(...all), wide = 320, tall = 70;
    const X = (i) => (wide * i) / Math.max(part.length - 1, 1), Y = (v) => 4 + ((tall - 8) * (high - v)) / (high - low || 1), at = (key) => part.map((p, i) => `${X(i).toFixed(1)},${Y(p[key]).toFixed(1)}`);
    const drawing = shape("svg", { viewBox: `0 0 ${wide} ${tall}`, width: wide, height: tall, role: "img", "aria-label": `${stem} over time, ${num(Math.min(...part.map((p) => p.value)))} to ${num(Math.max(...part.map((p) => p.value)))} ${part[0].unit}` });
    drawing.style.maxWidth = "100%";
    drawing.append(shape("polygon", { points: [...at("low95"), ...at("high95").reverse()].join(" "), class: "tube" }), shape("path", { d: `M0 ${Y(0)}H${wide}`, class: "nought" }), shape("polyline", { points: at("value").join(" "), class: "middle" }));
    return el("div", null, el("code", null, `${stem}, ${part.length} numbers over the voyage`), el("div", null, drawing), el("span.note", null, `${num(low)} to ${num(high)} ${part[0].unit}; shaded: 95 %`));
  }));
}

/** A number with its 95 % interval; the dashed mark is zero. */
function parameter(number) {
  const p = readable(number), lo = Math.min(p.low95, 0), hi = Math.max(p.high95, 0), P = (x) => `${(100 * (x - lo)) / (hi - lo || 1)}%`;
  const draw = el("span.whisker", null, el(".z", { style: { left: P(0) } }), el(".w", { style: { left: P(p.low95), width: `calc(${P(p.high95)} - ${P(p.low95)})` } }), el(".p", { style: { left: P(p.value) } }));
  return el(".parameter", null, el("code", null, p.name), draw, el("span", null, withUnit(num(p.value), p)), el("span.note", null, `95 %: ${num(p.low95)} to ${withUnit(num(p.high95), p)}${p.in_ship_file === undefined ? "" : `; ship file ${num(p.in_ship_file)}`}`), p.meaning ? el("span.note", { style: { gridColumn: "1 / -1" } }, p.meaning) : null);
}

function manoeuvreSection() {
  const m = RESULT.next_manoeuvre;
  if (!m) return null;
  const apart = (m.separates || []).join(" and "), shown = (m.shows || []).join(" and ");
  return section("Sail this next", apart ? `it tells ${apart} apart` : shown ? `it would show ${shown}` : null, el("p", { style: { margin: 0 } }, m.manoeuvre), el("p.note", null, m.why || ""));
}

function fittedSection() {
  const out = [];
  for (const [effect, numbers] of Object.entries(RESULT.parameters || {})) out.push(el(".candidate", null, el("h3", null, effect), el("div", null, Object.entries(numbers).map(([name, p]) => parameter({ name, ...p })))));
  const j = RESULT.judged_by || {};
  const p = RESULT.proof || {};
  if (p.kind) out.push(el("p.note", null, `Proof (${p.kind}): log likelihood ratio ${num(p.log_likelihood_ratio)}, 95 % ${num(p.low95)} to ${num(p.high95)}; needed ${num(p.needed)} and an interval above zero.`));
  if (j.measure) out.push(el("p.note", null, `That is ${j.measure}: ${num(j.before)} → ${num(j.after)} ${j.unit}; 95 % of the change ${num(j.low95, 2)} to ${num(j.high95, 2)} (windows resampled in blocks).`));
  return section("What was fitted", "95 % intervals, the uncertainty of the core included", ...out);
}

/** Every step of the ship's history: position error before and after, at the longest horizon. */
function ladderSection() {
  const list = (RESULT.history || []).filter((h) => h.errors && h.errors.length);
  if (!list.length) return null;
  const longest = (h) => h.errors[h.errors.length - 1], top = Math.max(...list.map((h) => longest(h).before_m));
  const rows = list.map((h) => { const e = longest(h); return el("tr", null, el("td", null, h.date || ""), el("td", null, `+ ${(h.added || []).join(", ")}${h.forced ? " (forced)" : ""}`), el("td", null, bar(e.before_m / top), `${num(e.before_m)} m`), el("td", null, bar(e.after_m / top), `${num(e.after_m)} m`), el("td.n", null, `${num(e.noise_floor_m, 2)} m`)); });
  return section("The ladder", "held-out position error at the longest horizon, each step on its own held-out voyages", table(["date", "step", "before", "after", ">expected"], rows));
}
