// Calibrate: the core fitted to reference voyages; what was known before, what is known now, what could not be told.

import { address, start, state } from "/app/api.js";
import { card, el, field, table } from "/app/dom.js";
import { asGiven, num } from "/app/number.js";
import { chart, whiskers } from "/app/draw.js";
import { diff } from "/app/add.js";
import { ask } from "/app/api.js";
import { kept as saved } from "/app/save.js";
import { answerOf, earlier, foot, go, lacks, nextName, pickVoyages, theShip } from "/app/shared.js";

export async function calibrate(r) {
  const out = [el("h1", null, "Calibrate the core to reference voyages"), lacks(), asker(r.item)];
  if (!r.item) return out;
  const a = await answerOf(r.item);
  return a.waiting ? [...out, a.waiting] : [...out, ...(await answer(a))];
}

function asker(item) {
  const ship = theShip("calibrate"), v = pickVoyages("reference voyages: nothing wrong, manoeuvring, calm or with the wind recorded", "calibrate.voyages", ["reference"]), held = pickVoyages("measured on (none: the last third of each)", "calibrate.held", ["nothing"]);
  const output = el("input", { type: "text", id: "calibrate-output", value: nextName(ship.name || "ship.toml", "-calibrated") });
  const run = () => start({ verb: "calibrate", ship: state.kept["calibrate.ship"], voyages: [...v.set], held_outs: [...held.set].filter((n) => !v.set.has(n)), output: output.value });
  return el("section.card", { "aria-label": "What to calibrate" }, el("p.note", null, "Three reference voyages at least, six are better: zigzags, circles, changes of speed."), el("form", null, ship.select, v.box, held.box, field("calibrated ship file", output), go("Calibrate", run, !ship.name)), earlier("calibrate", "calibrate", item));
}

async function answer(a) {
  const d = a.result, h = d.held_out.filter((e) => e.position_m !== null), x = h.map((e) => e.horizon_s), last = h.at(-1);
  const ship = d.output ? await ask(`/api/ships/${encodeURIComponent(d.output)}`).catch(() => null) : null, prior = new Map((ship?.derivatives || []).map((n) => [n.name, n]));
  const told = d.derivatives.map((n) => ({ name: n.name, value: n.value, sd: n.sd, excited: n.excited, before: n.before, prior: prior.get(n.name)?.prior_value, prior_sd: prior.get(n.name)?.prior_sd })), drawn = told.filter((n) => n.prior_sd);
  const heads = ["derivative", ["before"], ["now"], ["standard error"], "told by these voyages"], rows = told.map((n) => [n.name, n.before, n.value, n.sd, n.excited ? "yes" : "no, its prior is kept"]);
  return [el("section.card", { "aria-label": "In a sentence" }, el("p.big", null, last ? `On what was not used for the fit (${d.held_out_is}), the ${asGiven(last.horizon_s)} s error goes from ${num(last.before_m)} to ${num(last.position_m)} m.` : "Too little was held back to measure an error."), d.refused ? el("p.fair", null, `Not written: ${d.refused}`) : el("p.note", null, `Written to ${d.output}.`), d.doubts.map((t) => el("p.fair", null, t))),
    el(".two", null, card("Held-out error, before and after", chart("Held-out position error", [{ name: "before", x, y: h.map((e) => e.before_m), look: "c-second", points: true }, { name: "after", x, y: h.map((e) => e.position_m), look: "c-model", points: true }], { zero: "both", x: "seconds ahead", y: "m" }), table("Open loop", ["after", ["before [m]"], ["now [m]"], ["before [deg]"], ["now [deg]"]], h.map((e) => [`${asGiven(e.horizon_s)} s`, ...[e.before_m, e.position_m, e.before_deg, e.heading_deg].map(digits)]))),
      card("What the data could not tell", d.unexcited.length ? el("p", null, `Not moved by these voyages, their priors are kept: ${d.unexcited.join(", ")}.`) : el("p", null, "Every number was moved by these voyages."), d.by_regime.length ? table("Error while", ["how", ["seconds ahead"], ["position [m]"]], d.by_regime.map((g) => [g.regime, asGiven(g.horizon_s), num(g.position_m)])) : null, d.unexcited.length ? el("p.note", null, manoeuvre(d.unexcited)) : null)),
    card("Prior and posterior of each number", drawn.length ? el(".two", null, [drawn.slice(0, Math.ceil(drawn.length / 2)), drawn.slice(Math.ceil(drawn.length / 2))].map((part, i) => whiskers(`Derivatives, ${i ? "second" : "first"} half`, part))) : null, el("details", null, el("summary", null, "As numbers"), saved("Derivatives", heads, rows, table("Derivatives in prime form", heads, rows.map((row) => row.map((c) => (typeof c === "number" ? asGiven(c, 4) : c))))))),
    a.view?.difference?.length ? card("What changed in the ship file", el("details", null, el("summary", null, `${a.view.difference.length} lines`), diff(a.view.difference))) : null, foot(a.job)];
}

const TELLS = [[/^(X_u|X_uu|K_T)/, "runs at three speeds, straight, with the wind recorded (resistance and thrust)"], [/^(X_v|X_r)/, "turning circles at full rudder (resistance of drift and turning)"], [/^(Y_|N_)/, "a 20/20 zigzag and circles to both sides (side force and yaw moment)"], [/^(C_L|t_R|a_H|x_H|gamma|kappa|epsilon)/, "zigzags at two shaft speeds (the rudder's own numbers)"]];

/** A number of the answer with all its digits in its title. */
const digits = (x) => el("span", { title: x === null ? null : String(x) }, num(x));

/** What to sail next, from what was not moved. */
function manoeuvre(names) {
  const told = TELLS.filter(([of]) => names.some((n) => of.test(n))).map(([, what]) => what);
  return told.length ? `Sail next: ${told.join("; ")}.` : "";
}
