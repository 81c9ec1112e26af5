// Diagnose: what is missing, how surely, how large in the words of the bridge, and what it would change.

import { address, change, start, state } from "/app/api.js";
import { button, card, choose, el, field, svg, table } from "/app/dom.js";
import { asGiven, num } from "/app/number.js";
import { unpack } from "/app/api.js";
import { forcesCard, heatOf, seriesCard } from "/app/compare.js";
import { timeView } from "/app/plot.js";
import { kept as saved } from "/app/save.js";
import { answerOf, earlier, foot, go, lacks, pickVoyages, theShip } from "/app/shared.js";

const VERDICTS = { weather_only: ["fair", "water and weather are missing"], missing: ["bad", "something is missing"], nothing_missing: ["good", "nothing is missing"], unknown: ["fair", "something unknown"], undecided: ["fair", "these voyages cannot decide"] };
const READING = { north_m: "x", east_m: "y", heading_true_north_deg: "psi", surge_velocity_mps: "u", sway_velocity_mps: "v", yaw_rate_degps: "r", surge_velocity_through_water_mps: "u_r", sway_velocity_through_water_mps: "v_r" };

export async function diagnose(r) {
  const out = [el("h1", null, "Which physical effect is missing?"), lacks(), asker(r.item)];
  if (!r.item) return out;
  const a = await answerOf(r.item);
  if (a.waiting) return [...out, a.waiting];
  return [...out, ...answer(a, r)];
}

function asker(item) {
  const ship = theShip("diagnose"), v = pickVoyages("voyages", "diagnose.voyages", ["voyage"]), ref = pickVoyages("reference voyages (nothing was wrong)", "diagnose.references", ["reference"]);
  const asked = () => start({ verb: "diagnose", ship: state.kept["diagnose.ship"], voyages: [...v.set], references: [...ref.set].filter((n) => !v.set.has(n)) });
  return el("section.card", { "aria-label": "What to diagnose" }, el("form", null, ship.select, v.box, ref.box, go("Diagnose", asked, !ship.name)), earlier("diagnose", "diagnose", item));
}

function answer(a, r) {
  const d = a.result, view = timeView(), [look, words] = VERDICTS[d.reason] || VERDICTS[d.verdict] || ["", d.verdict], voyages = a.view.voyages, name = r.query.get("voyage") || voyages[0].name, v = voyages.find((x) => x.name === name) || voyages[0];
  const chosen = r.query.get("with") ?? d.candidates[0]?.effect ?? d.weather[0]?.effect ?? "";
  const with_ = a.view.causes.find((c) => c.effect === chosen && c.lines), k = voyages.indexOf(v);
  const extra = { name: () => "model without it", look: () => "c-second", lines: (channel) => (with_ && READING[channel] in with_.lines[k] ? [{ name: `with ${with_.effect}`, y: unpack(with_.lines[k][READING[channel]]), look: "c-model" }] : []) };
  return [el("section.card", { "aria-label": "Verdict" }, el(".head", null, el(`span.badge.${look}`, null, words), el("span.note", null, `rule: ${d.reason}`)), el("p.big", null, d.sentence), next(a),
      el("p.note", null, `Nothing missing: ${num(100 * d.probabilities.nothing_missing, 2)} %. Something without a name: ${num(100 * d.probabilities.unknown, 2)} %.`),
      d.p_value_sentence ? el("p.note", null, d.p_value_sentence) : null, sail(d.next_manoeuvre)),
    card("Causes, likeliest first", d.candidates.length ? d.candidates.map((c) => cause(c, a, chosen)) : el("p", null, "No cause is likely."), d.resembles.length ? [el("h3", null, "Known by their form alone: what it looks like"), d.resembles.map((c) => cause(c, a, chosen))] : null),
    el(".two", null, rivals(d), card("Water and wind of these voyages", el("p.note", null, "They belong to the day, not to the ship."), d.weather.length ? d.weather.map((c) => cause(c, a, chosen)) : el("p", null, "Nothing of the water or the weather had to be taken into account."))),
    el("section.card", { "aria-label": "When" }, el("h2", null, `When: ${v.name}`), voyages.length > 1 ? field("voyage", choose("voyage", voyages.map((x) => [x.name, x.name]), v.name, (x) => change({ voyage: x }))) : null, heatOf(v, view)),
    seriesCard([a], v, view, extra), forcesCard(a, v.name, view, r), more(d), foot(a.job)];
}

/** What to sail next, and what it is for. */
function sail(m) {
  if (!m) return null;
  const apart = (m.separates || []).join(" from "), shown = (m.shows || []).join(" and ");
  return el("p", { id: "sail-next" }, apart ? `To tell ${apart}, sail: ` : `To see ${shown}, should they be there, sail: `, el("b", null, m.manoeuvre), ` (${m.why}).`);
}

const bar = (p, words) => el("span.chance", null, svg("svg", { viewBox: "0 0 100 7", preserveAspectRatio: "none", role: "img", "aria-label": words }, svg("rect", { class: "c-model fill", width: 100 * p, height: 7 })));

const known = (x) => x !== undefined && x !== null;

/** One cause: how sure, how large, which way, what it changes. */
function cause(c, a, chosen) {
  const told = a.view.causes.find((x) => x.effect === c.effect) || { numbers: [] }, on = chosen === c.effect, p = c.probability;
  const curve = told.numbers.length > 4;
  const sizes = curve && told.stream ? el("p", null, told.stream) : curve ? el("p.note", null, `${told.numbers.length} numbers that make a curve over time, ${span(told.numbers)}.`) : el("ul", null, told.numbers.map((n) => el("li", null, `${n.name.replaceAll("_", " ")}: `, el("b", null, `${num(n.value)} ${n.unit}`), n.low95 === null ? "" : ` (95 %: ${num(n.low95)} to ${num(n.high95)} ${n.unit})`)));
  const ways = told.ways?.length ? `It acts ${told.ways.join(", ")}. ` : "", f = c.typical_force || {};
  const force = [["X", f.X_N, 1e-3, "kN"], ["Y", f.Y_N, 1e-3, "kN"], ["N", f.N_Nm, 1e-6, "MN m"]].filter(([, x]) => x).map(([n, x, k, u]) => `${n} ${num(k * x)} ${u}`).join(", ");
  return el("article.card", { "aria-label": c.effect }, el(".head", null, el("h3", null, c.effect), p === undefined ? null : el("b", null, `${num(100 * p, 2)} %`), button(on ? "Shown below" : "Show the prediction with it", () => change({ with: c.effect }), { class: "small", id: `with-${c.effect}`, "aria-pressed": String(on), disabled: !told.lines })),
    p === undefined ? null : bar(p, `probability ${num(100 * p, 2)} %`), el("p", null, c.says || ""), el("p", null, ways, force ? `Typical size ${force} (root mean square).` : ""), sizes, changes(told),
    known(c.error_without) && known(c.error_with) ? el("p.note", null, `On parts that were not used to fit it, the ${asGiven(c.error_horizon_s)} s error is ${num(c.error_without)} m without it, ${num(c.error_with)} m with it${known(c.error_floor) ? `; ${num(c.error_floor)} m is expected even with the right cause` : ""}.`) : null,
    c.cannot_be_told_from?.length ? el("p.fair", null, `Cannot be told from ${c.cannot_be_told_from.join(", ")}.`) : null,
    c.over_time?.length ? el("details", null, el("summary", null, "Part by part"), table("Size in each part of a voyage, over its estimate", ["part", ["share"], ["standard error"]], c.over_time.map((o) => [`${o.voyage}, ${asGiven(o.start_s, 5)} to ${asGiven(o.end_s, 5)} s`, num(o.share), num(o.sd)]))) : null);
}

const span = (numbers) => { const v = numbers.map((n) => n.value); return `${num(Math.min(...v))} to ${num(Math.max(...v))} ${numbers[0].unit}`; };

function changes(told) {
  if (!told.changes) return null;
  const words = { speed: (x) => `${num(Math.abs(x), 2)} kn ${x < 0 ? "slower" : "faster"}`, heading: (x) => `${num(x, 2)} deg of heading`, place: (x) => `${num(x, 2)} m of place` };
  const said = told.changes.filter((c) => c.value !== null).map((c) => { const low = c.low95 ?? null, high = c.high95 ?? null; return `${words[c.what](c.value)}${low === null || high === null ? "" : ` (${[low, high].map(Math.abs).sort((x, y) => x - y).map((x) => num(x, 2)).join(" to ")})`}`; });
  return el("p", null, `On the bridge, on average over a prediction from the measured state: ${said.join(", ")}.`);
}

function rivals(d) {
  const heads = ["explanation", ["log odds"], "in words", ["error [m]"]], rows = d.rivals.map((x) => [x.effects.join(" + ") || "nothing", x.log_bayes_factor, odds(x.log_bayes_factor), x.error_m]);
  return card("Rivals", el("p.note", null, "The likeliest explanations beside each other; log odds of −4.6 are a hundred times less likely."), saved("Rivals", heads, rows, table("Hypotheses that were weighed", heads, rows.map((row) => [row[0], num(row[1]), row[2], num(row[3])]))));
}

const odds = (x) => (x > -0.01 ? "the likeliest" : x > -1 ? "nearly as likely" : `${x < -13 ? "more than a million" : num(Math.exp(-x), 2)} times less likely`);

function next(a) {
  const d = a.result, names = d.answer?.lasting || [];
  const open = !names.length && ["undecided", "unknown"].includes(d.verdict);
  const other = open ? el("p.note", null, "A voyage of another day and on other courses, asked together with this, tells more.") : null;
  return [other, names.length ? el(".tools", null, el("a.button", { href: address("add", "", { effects: names.join(","), ship: a.job.asked.ship, voyages: a.job.asked.voyages.join(",") }), id: "to-add" }, `Add ${names.join(" and ")} to the model`)) : null];
}

function more(d) {
  const list = (words, names) => (names?.length ? el("p.note", null, `${words}: ${names.join(", ")}.`) : null);
  return card("What was not decided by these voyages", list("Too small to be seen here at a plausible size", d.not_visible), list("Could not be judged, for want of a recording", d.not_judged?.map((n) => `${n.effect} (${n.lacks.join(", ")})`)), Object.entries(d.answer?.not_named || {}).map(([n, why]) => el("p.note", null, `${n} is likely and not named: ${typeof why === "string" ? why : JSON.stringify(why)}`)),
    d.moments?.length ? table("Transient disturbances", ["voyage", ["from [s]"], ["to [s]"], ["X [kN]"], ["Y [kN]"], ["N [MN m]"]], d.moments.map((m) => [m.voyage, asGiven(m.start_s, 5), asGiven(m.end_s, 5), num(m.X_N / 1e3), num(m.Y_N / 1e3), num(m.N_Nm / 1e6)])) : null);
}
