// Ship: particulars with units and sources, and the model's own sea trials beside measured turns and IMO's limits.

import { address, ask, files, state } from "/app/api.js";
import { again, doing } from "/app/main.js";
import { card, choose, command, el, field, table } from "/app/dom.js";
import { asGiven, num } from "/app/number.js";
import { chart } from "/app/draw.js";
import { diff, ladder } from "/app/add.js";
import { kept as saved } from "/app/save.js";
import { go, kept, nextName, voyages } from "/app/shared.js";

let form = null;

export async function ship(r) {
  if (r.item === "new") return fresh();
  const ships = files("ship").map((f) => f.name), list = card("Ship files", el(".tools", null, ships.map((s) => el("a.button", { href: address("ship", s), "aria-current": s === r.item ? "true" : undefined }, s)), el("a.button", { href: address("ship", "new"), id: "new-ship" }, ships.length ? "A first model of another ship" : "Make a first model")));
  if (!r.item) return [el("h1", null, "Ship"), list, ships.length ? el("p", null, "Choose a ship file above.") : el("p", null, "No ship file yet. Length, beam and draught are enough for a first model; what else is known makes it better.")];
  const s = await ask(`/api/ships/${encodeURIComponent(r.item)}`), other = r.query.get("beside");
  const lines = other ? (await ask(`/api/difference?before=${encodeURIComponent(other)}&after=${encodeURIComponent(r.item)}`)).lines : [];
  const pick = field("difference from", choose("beside", [["", "none"], ...ships.filter((x) => x !== r.item).map((x) => [x, x])], other || "", (v) => { location.hash = address("ship", r.item, { beside: v, turn: r.query.get("turn") }); }));
  return [el("h1", null, `${s.ship}: ${r.item}`), list, await trials(s, r), el(".two", null, numbers("Particulars", s.particulars), el("section.card", { "aria-label": "Effects" }, el("h2", null, "Effects of this model"), s.effects.length ? s.effects.map((e) => table(e.name, ["number", ["value"], "unit"], e.numbers.map((n) => [n.name.replaceAll("_", " "), asGiven(n.value, 4), n.unit]))) : el("p", null, "The core alone."), el("p.note", null, s.calibrated ? "Its core was calibrated to reference voyages." : "Its core was not calibrated yet."))), ladder(s.history), numbers("Derivatives", s.derivatives), Object.keys(s.sources || {}).length ? card("Sources", el("dl", null, Object.entries(s.sources).map(([k, t]) => [el("dt", null, el("b", null, k)), el("dd", null, String(t))]))) : null, card("Difference of ship files", el("form", null, pick), lines.length ? diff(lines) : other ? el("p", null, "They are the same.") : null)];
}

/** Every number with unit and source; what was estimated is marked. */
function numbers(title, list) {
  const heads = ["number", ["value"], ["standard error"], "unit", "meaning", "source"], rows = list.map((n) => [n.name, n.value, n.sd, n.unit, n.doc, n.source || ""]);
  const shown = rows.map((row, i) => [row[0], asGiven(row[1], 5), num(row[2]), row[3], row[4], el("span", { class: /^given|^calibrated/.test(row[5]) ? "good" : !row[5] || /EST|ROUGH|ALEX|prior kept|^m\/|k_zz/.test(row[5]) ? "fair" : null }, row[5] || "usual value")]);
  return card(title, saved(title, heads, rows, table(`${title} with units and sources; in green what was given or calibrated, in amber what was only estimated`, heads, shown)));
}

/** Turning circle and zigzag of the model, with a measured turn and the limits of IMO MSC.137(76). */
async function trials(s, r) {
  const t = s.trial, turn = r?.query.get("turn"), measured = turn ? await ask(`/api/turn?ship=${encodeURIComponent(r.item)}&voyage=${encodeURIComponent(turn)}`).catch((e) => ({ problem: e.message })) : null;
  const lines = [{ name: "model, 35 deg", x: t.circle.x, y: t.circle.y, look: "c-model" }];
  if (measured?.x) lines.push({ name: `${measured.voyage}, ${num(measured.rudder_deg)} deg`, x: measured.x, y: measured.y, look: "c-measured" });
  const pick = r ? field("a measured turn beside it", choose("turn", [["", "none"], ...voyages().map((f) => [f.name, f.name])], turn || "", (v) => { location.hash = address("ship", r.item, { turn: v, beside: r.query.get("beside") }); })) : null;
  const limits = t.limits.map((l) => [l.name, `${num(l.value)} ${l.unit}`, `${num(l.limit)} ${l.unit}`, l.value === null ? "–" : el(`span.${l.value <= l.limit ? "good" : "bad"}`, null, l.value <= l.limit ? "within" : "beyond")]);
  return card("Sea trials of the model", pick, measured?.problem ? el("p.fair", null, measured.problem) : measured ? el("p.note", null, `The largest turn of ${measured.voyage} with the rudder held over, and not from straight ahead: ${num(measured.duration_s)} s, ${num(measured.turned_deg)} deg of heading, drawn to starboard.`) : null,
    el(".two", null, chart("Turning circle", lines, { equal: true, x: "ship lengths aside", y: "ship lengths ahead", height: 330 }), chart("20/20 zigzag", [{ name: "heading", x: t.zigzag.t, y: t.zigzag.y, look: "c-model" }], { x: "seconds", y: "deg", height: 330, marks: [{ y: 45, text: "limit of the first overshoot" }, { y: -45, text: "" }] })),
    table("Figures beside the limits of IMO MSC.137(76)", ["figure", ["model"], ["limit"], "within it"], limits));
}

/** A first model from the main particulars, drawn while it is filled in. */
async function fresh() {
  form ??= await ask("/api/form");
  const said = kept("new.ship", () => ({ name: "MV Alma", values: {} })), drawn = el("div", { id: "tried", role: "status" });
  let waits = null, turn = 0;
  const show = async () => {
    const mine = ++turn;
    if (form.some((f) => f.required && !(said.values[f.option] > 0))) { drawn.replaceChildren(el("p.note", null, "Length, beam and draught are needed; the model is then drawn here as you type.")); return; }
    try {
      const s = await ask("/api/ships/try", { name: said.name || "ship", values: said.values, output: output.value });
      if (mine === turn) drawn.replaceChildren(await trials(s), ...s.warnings.map((w) => el("p.fair", null, `Careful: ${w}`)), numbers("Particulars, given and estimated", s.particulars), command(s.command));
    } catch (error) { if (mine === turn) drawn.replaceChildren(el("p.bad", { role: "alert" }, error.message)); }
  };
  const typed = () => { clearTimeout(waits); waits = setTimeout(show, 350); };
  const name = el("input", { type: "text", id: "ship-name", value: said.name, oninput: (e) => { said.name = e.target.value; typed(); } }), output = el("input", { type: "text", id: "ship-output", value: nextName("ship.toml") });
  const inputs = form.map((f) => field(`${f.name}${f.required ? " (needed)" : ""}`, el("input", { type: "number", step: "any", id: `option-${f.option}`, title: f.doc, "aria-description": `${f.doc}, ${num(f.low)} to ${num(f.high)}`, value: said.values[f.option] ?? "", oninput: (e) => { said.values[f.option] = e.target.value === "" ? null : Number(e.target.value); typed(); } }), f.unit));
  const save = async () => { const { output: made } = await ask("/api/ships", { name: said.name, values: said.values, output: output.value }); await again(); location.hash = address("ship", made); };
  show();
  return [el("h1", null, "A first model of a ship"), card("Main particulars", el("p.note", null, "What you do not give is estimated, and says so. Every number can be corrected in the ship file."), el("form", null, field("name", name), inputs, field("ship file", output), go("Write the ship file", save))), drawn];
}

export { doing, state };
