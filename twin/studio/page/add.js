// Add: an effect put into the model, proved on voyages that were not used, and taken out again.

import { address, ask, files, start, state } from "/app/api.js";
import { again, doing } from "/app/main.js";
import { boxes, button, card, command, el, field, quoted, table } from "/app/dom.js";
import { asGiven, num, readable } from "/app/number.js";
import { chart } from "/app/draw.js";
import { seriesCard } from "/app/compare.js";
import { timeView } from "/app/plot.js";
import { kept as saved } from "/app/save.js";
import { answerOf, earlier, foot, go, kept, lacks, nextName, pickVoyages, theShip } from "/app/shared.js";

let effects = [], of = null;

/** What may be wrong with the ship; what was chosen for another is left out. */
async function offered(ship) {
  if (of !== ship) [effects, of] = [await ask(`/api/effects?ship=${encodeURIComponent(ship)}`), ship];
  const chosen = kept("add.effects", () => new Set());
  for (const name of chosen) if (!effects.some((e) => e.name === name)) chosen.delete(name);
}

export async function add(r) {
  prefill(r);
  await offered(theShip("add").name);
  const out = [el("h1", null, "Add an effect, and watch the error fall"), lacks(), asker(r.item)];
  if (!r.item) return out;
  const a = await answerOf(r.item);
  return a.waiting ? [...out, a.waiting] : [...out, ...answer(a)];
}

/** What a diagnosis named comes with the address. */
function prefill(r) {
  const said = r.query.get("effects");
  if (!said || state.kept["add.said"] === location.hash) return;
  state.kept["add.said"] = location.hash;
  state.kept["add.effects"] = new Set(said.split(","));
  if (r.query.get("ship")) state.kept["add.ship"] = r.query.get("ship");
  if (r.query.get("voyages")) state.kept["add.voyages"] = new Set(r.query.get("voyages").split(","));
  delete state.kept["add.output"];
}

function asker(item) {
  const ship = theShip("add", again), chosen = kept("add.effects", () => new Set()), v = pickVoyages("fitted on", "add.voyages", ["voyage"]), held = pickVoyages("proved on (none: the last third of each)", "add.held", ["held_out"]);
  if (!state.kept["add.output"] || files("ship").some((f) => f.name === state.kept["add.output"])) state.kept["add.output"] = nextName(ship.name || "ship.toml", [...chosen].length ? `-${[...chosen][0].toLowerCase()}` : "-better");
  const output = el("input", { type: "text", id: "add-output", value: state.kept["add.output"], oninput: (e) => { state.kept["add.output"] = e.target.value; } });
  const first = effects.filter((e) => chosen.has(e.name)), rest = effects.filter((e) => !chosen.has(e.name));
  const run = () => start({ verb: "add", ship: state.kept["add.ship"], effects: [...chosen], voyages: [...v.set], held_outs: [...held.set].filter((n) => !v.set.has(n)), output: output.value });
  return el("section.card", { "aria-label": "What to add" }, first.length ? boxes("effects to add", "effect", first.map((e) => [e.name, `${e.name}: ${e.doc}`]), chosen) : null,
    el("details", { open: !first.length }, el("summary", null, first.length ? "Other effects" : "Choose effects"), boxes("the catalogue", "other", rest.map((e) => [e.name, e.name]), chosen, () => again())),
    el("form", null, ship.select, v.box, held.box, field("new ship file", output), go("Add and prove", run, !ship.name)), earlier("add", "add", item));
}

function answer(a) {
  const d = a.result, view = timeView(), x = d.horizons.map((h) => h.horizon_s), line = (key, name, look) => ({ name, x, y: d.horizons.map((h) => h[key].position_mae_m), look, points: true });
  const heads = ["after", ["before [m]"], ["after [m]"], ["expected [m]"], ["before [deg]"], ["after [deg]"]], rows = d.horizons.map((h) => [`${asGiven(h.horizon_s)} s`, h.before.position_mae_m, h.after.position_mae_m, h.noise_floor?.position_mae_m, h.before.heading_mae_deg, h.after.heading_mae_deg]);
  const numbers = Object.entries(d.parameters).flatMap(([e, list]) => Object.entries(list).map(([n, p]) => [n, readable(p)]).map(([n, p]) => [e, n.replaceAll("_", " "), p.value, p.low95, p.high95, p.unit]));
  const extra = { name: (key) => (key === "before" ? "before" : key === "after" ? "after" : "model"), look: (key) => (key === "before" ? "c-second" : "c-model") };
  return [el("section.card", { "aria-label": "In a sentence" }, el(".head", null, el(`span.badge.${d.accepted ? "good" : "fair"}`, null, d.accepted ? `proved, and written to ${d.output}` : "not proved, nothing was written")), el("p.big", null, d.verdict), a.job.said ? el("p", null, a.job.said) : null, undo(a)),
    el(".two", null, card("Held-out error, before and after", chart("Held-out position error", [line("before", "before", "c-second"), line("after", "after", "c-model"), { name: "expected", x, y: d.horizons.map((h) => h.noise_floor?.position_mae_m ?? NaN), look: "c-expected dashed" }], { zero: "both", x: "seconds ahead", y: "m" }), saved("Held-out error", heads, rows, table("Open loop, on voyages that were not used to fit it", heads, rows.map((row) => row.map((c, i) => (i ? el("span", { title: String(c) }, num(c)) : c)))))),
      card("By condition of sailing", d.where.length ? table("Held-out position error", ["condition", ["share of the time"], ["before [m]"], ["after [m]"]], d.where.map((w) => [w.condition, `${num(100 * w.time_share)} %`, num(w.before_m), num(w.after_m)])) : el("p", null, "No condition was sailed often enough."), table("Numbers of the effect", ["effect", "number", ["value"], ["low 95 %"], ["high 95 %"], "unit"], numbers.map((n) => n.map((c) => (typeof c === "number" ? num(c) : c)))), (d.notes || []).map((n) => el("p.note", null, String(n))))),
    ladder(a.view.history), a.view.difference.length ? card("What changed in the ship file", diff(a.view.difference)) : null,
    a.view.voyages.length ? seriesCard([a], a.view.voyages[0], view, extra) : null, foot(a.job)];
}

/** Taken out again, into a file of its own; the history remembers both. */
function undo(a) {
  if (!a.result.output) return null;
  const there = files("ship").some((f) => f.name === a.result.output), output = nextName(a.result.output, "-undone"), text = `twin remove ${a.result.added.join(" ")} --ship ${quoted(a.result.output)} -o ${quoted(output)}`;
  if (!there) return el("p.note", null, `${a.result.output} is not in the folder any more.`);
  return [el(".tools", null, el("a.button", { href: address("compare"), onclick: () => { state.kept["compare.ship"] = a.result.output; state.kept["compare.voyages"] = new Set(a.job.asked.held_outs || a.job.asked.voyages); }, id: "to-compare" }, "Compare with the better model"),
    button("Undo", doing(async () => { await ask("/api/remove", { ship: a.result.output, effects: a.result.added, output }); await again(); location.hash = address("ship", output); }), { id: "undo", disabled: state.project.read_only })), el("details", null, el("summary", null, "The command that undoes it"), command(text))];
}

/** The error after every step of the ship's history. */
export function ladder(history) {
  const steps = (history || []).filter((s) => s.added || s.removed);
  if (!steps.length) return null;
  const name = (s) => [s.added && `+ ${s.added.join(", ")}`, s.removed && `− ${s.removed.join(", ")}`].filter(Boolean).join(" ");
  const told = steps.map((s) => ({ s, e: (s.errors || []).at(-1) })), x = told.flatMap((_, i) => [i, i + 1]), y = told.flatMap(({ e }) => [e?.before_m ?? NaN, e?.after_m ?? NaN]);
  return card("The ladder", told.some(({ e }) => e) ? chart("Held-out error at the longest horizon, step by step", [{ name: "before → after", x, y, look: "c-model", points: true }], { zero: true, x: "step", y: "m", height: 200 }) : null,
    table("What was added and removed", ["step", "when", ["before [m]"], ["after [m]"], "proof"], told.map(({ s, e }, i) => [`${i + 1}: ${name(s)}`, s.date || "", num(e?.before_m), num(e?.after_m), s.proof || ""])));
}

export const diff = (lines) => el("pre", { tabindex: 0, "aria-label": "Difference of the ship files" }, lines.map((l) => el(`span${l.startsWith("+") ? ".plus" : l.startsWith("-") ? ".minus" : ""}`, null, l || " ")));
