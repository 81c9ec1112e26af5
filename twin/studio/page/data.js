// Data: files in, recognised, mapped, every channel seen, what the checks doubt mended by a button.

import { address, ask, files, found, over, samples, start, state } from "/app/api.js";
import { again, doing } from "/app/main.js";
import { boxes, button, card, choose, command, el, field, named, quoted, table } from "/app/dom.js";
import { asGiven, num } from "/app/number.js";
import { timePlot, timeView, zoomer } from "/app/plot.js";
import { TAGS, answerOf, go, kept, stateWord, theShip } from "/app/shared.js";
import { kept as saved } from "/app/save.js";

export async function data(r) {
  return r.item ? looked(r.item) : overview();
}

function overview() {
  const rows = state.project.files.map((f) => [
    ["voyage", "data"].includes(f.kind) ? el("a", { href: address("data", f.name) }, f.name) : f.kind === "ship" ? el("a", { href: address("ship", f.name) }, f.name) : f.name,
    f.kind === "data" ? "to be imported" : f.kind, size(f.bytes),
    f.kind === "voyage" ? tagger(f) : "", el("a", { href: `/api/files/${encodeURIComponent(f.name)}`, download: f.name, "aria-label": `Save ${f.name}` }, "save")]);
  return [el("h1", null, "Data"), dropper(),
    rows.length ? card("Files of this project", table("Plain files in the project's folder; the command line reads and writes the same", ["file", "what it is", ["size"], "kept for", "copy"], rows))
      : card("Nothing here yet", el("p", null, "Drop a log or a table above, or begin with the tanker that comes with the twin: calibrated on calm voyages, it sails badly on Monday."), button("Copy the demo voyages here", doing(async () => { await ask("/api/demo", {}); await again(); }), { class: "main", id: "demo", disabled: state.project.read_only })), rows.length ? next() : null, rows.length ? report() : null];
}

/** The step after this one, while the project is young. */
function next() {
  const done = (verb) => state.jobs.some((j) => j.verb === verb && j.state === "done"), raw = files("data").filter((f) => !files("voyage").some((v) => v.name === `${f.name.replace(/\.[^.]+$/, "")}.mcap`))[0];
  const [part, item, words] = !files("voyage").length && raw ? ["data", raw.name, `Look at ${raw.name}, mend what is doubted, and import it`] : !files("ship").length ? ["ship", "new", "Make a first model of the ship from its main particulars"]
    : !files("voyage").length ? [] : !done("compare") ? ["compare", "", "Compare the model with a voyage: how wrong is it, and where?"] : !done("diagnose") && !done("calibrate") ? ["calibrate", "", "Calibrate the model to voyages on which nothing was wrong, or go on to Diagnose"] : [];
  return part ? card("Next", el("p", null, el("a", { href: address(part, item), id: "next" }, words), ".")) : null;
}

const report = () => card("The project on one page", el("p.note", null, "Ship, voyages, error before and now, diagnosis and history as they stand, in one file that opens anywhere."), el(".tools", null, el("a.button", { href: "/api/report", download: "project.html", id: "report" }, "Save as one page")), command("twin studio . --report project.html"));

const size = (n) => (n > 1e6 ? `${(n / 1e6).toFixed(1)} MB` : `${Math.max(1, Math.round(n / 1e3))} kB`);

function tagger(f) {
  const select = choose(`tag-${f.name}`, TAGS, f.tag, doing(async (e) => { await ask("/api/tags", { file: f.name, tag: e }); await again(); }));
  select.setAttribute("aria-label", `What ${f.name} is kept for`);
  select.disabled = state.project.read_only;
  return select;
}

function dropper() {
  const input = el("input", { type: "file", multiple: true, id: "files", "aria-label": "Files to add", disabled: state.project.read_only });
  const box = el("div", { id: "drop" }, el("p", null, "Drop logs, tables, maps or ship files here, or choose them: ", input), el("p.note", null, "CSV, Excel, Parquet, NMEA 0183 and 2000, Signal K, AIS, ROS bags, ArduPilot and PX4 logs, MCAP. They are copied into the folder and nowhere else."));
  const take = doing(async (list) => {
    for (const file of list) await ask(`/api/files/${encodeURIComponent(file.name)}`, file);
    await again();
    const first = [...list].find((f) => !f.name.endsWith(".toml"));
    if (first) location.hash = address("data", first.name);
  });
  input.addEventListener("change", () => take(input.files));
  box.addEventListener("dragover", (e) => { e.preventDefault(); box.classList.add("over"); });
  box.addEventListener("dragleave", () => box.classList.remove("over"));
  box.addEventListener("drop", (e) => { e.preventDefault(); box.classList.remove("over"); if (!state.project.read_only) take(e.dataTransfer.files); });
  return el("section.card", { "aria-label": "Add files" }, box);
}

const mapOf = (file) => `${file.replace(/\.[^.]+$/, "")}-map.toml`;

/** One file: looked at by a worker, once for each of its versions. */
async function looked(name) {
  const file = state.project.files.find((f) => f.name === name), title = el("h1", null, name);
  if (!file) return [title, el("p", null, "This file is not in the project (any more).")];
  const map = files("map").find((f) => f.name === mapOf(name)), since = Math.max(file.changed_s, map?.changed_s || 0), ship = theShip("data", again);
  const fresh = state.jobs.filter((j) => j.verb === "look" && j.asked.file === name && (state.project.read_only || (j.asked.ship || "") === ship.name) && (j.asked.map || "") === (map?.name || "") && j.created_s >= since - 0.05).at(-1);
  if (!fresh) {
    if (state.project.read_only) return [title, el("p", null, "It was not looked at before, and this project is open for reading only.")];
    await ask("/api/jobs", { verb: "look", file: name, map: map?.name, ship: ship.name });
    await again();
    return [title, el("p", { role: "status" }, "Looking at it ...")];
  }
  const { job, waiting, result } = await answerOf(fresh.name);
  if (waiting) return [title, waiting];
  const view = timeView(), x = result.samples ? await samples(job.name, result) : null;
  return [title, head(file, result), ship.name && !state.project.read_only ? card("The ship that the checks know", el("form", null, ship.select)) : null, result.problem ? problem(result) : null, x ? checks(result, x, view, name) : null, mapCard(result, x, name), x ? channels(result, x, view) : null, file.kind === "voyage" || (result.problem && !result.map_text) ? null : importer(name, result, map, ship.name)];
}

function head(file, k) {
  return el("section.card", { "aria-label": "What it is" }, el("p.big", null, `Recognised as ${k.format}. `, k.samples ? `${k.rows} rows, ${asGiven(k.duration_s, 5)} s, a sample every ${asGiven(k.step_s)} s, ${k.columns.length} channels.` : ""),
    k.every > 1 ? el("p.note", null, `Every ${k.every}th sample is drawn.`) : null, (k.notes || []).map((n) => el("p.note", null, n)),
    k.absent?.length ? el("details", null, el("summary", null, `${k.absent.length} channels are absent`), el("p.note", null, k.absent.map((c) => named(c)[0]).join(", "))) : null);
}

/** Why it cannot be read: by the map that stands below, or as a file, which is then to be corrected where it is from and dropped again. */
const problem = (k) => [card(k.map_text ? "It cannot be read by this map yet" : "It cannot be read yet", el("p.big.bad", null, k.problem), el("p.note", null, k.map_text ? "Correct the map below and save it; the file is then read again." : "Correct the file in the program that it is from, in an editor or in a spreadsheet, and drop it here again under the same name.")), k.map_text ? null : dropper()];

/** What the checks doubt, beside the channels it is about, with the remedies. */
function checks(k, x, view, name) {
  const bad = k.checks.filter((c) => !c.ok).sort((a, b) => b.proved - a.proved), good = k.checks.filter((c) => c.ok);
  const one = (c) => el("article.card", { "aria-label": c.check }, el(".head", null, el("h3", null, c.check.replaceAll("_", " ")), el(`span.badge.${c.proved ? "bad" : "fair"}`, null, c.proved ? "wrong" : "look")), el("p", null, c.text),
    el(".tools", null, c.remedies.map((m, i) => button(`Write into the map: ${m.says}`, doing(async () => { await ask("/api/remedy", { name: mapOf(name), text: k.map_text, edit: m.edit }); await again(); }), { class: i ? "" : "main", id: `remedy-${c.check}-${i}`, disabled: state.project.read_only || !k.map_text }))),
    el(".two", null, c.channels.slice(0, 2).map((channel) => channelPlot(channel, x, view))));
  return el("section.card", { "aria-label": "Checks" }, el(".head", null, el("h2", null, "Checks"), el(`span.badge.${bad.length ? "bad" : "good"}`, null, bad.length ? `${bad.length} of ${k.checks.length} speak against it` : `${k.checks.length} have nothing against it`)), bad.map(one),
    el("details", null, el("summary", null, "What the other checks saw"), table("Checks that have nothing against it", ["check", "what it saw"], good.map((c) => [c.check.replaceAll("_", " "), c.text]))));
}

const channelPlot = (name, x, view, height) => { const [title, unit] = named(name); return timePlot(title, [{ name: "recorded", t: x.time_s, y: x[name], look: "c-model" }], { unit, view, height }); };

function channels(k, x, view) {
  const rows = k.columns.map((c) => [named(c.name)[0], named(c.name)[1], asGiven(c.low, 5), asGiven(c.high, 5), `${num(100 * c.there)} %`, c.derived || ""]);
  const heads = ["channel", "unit", ["least"], ["most"], ["there"], "derived"];
  return el("section.card", { "aria-label": "Channels" }, el("h2", null, "Channels"), zoomer(view), el(".three", null, k.columns.map((c) => channelPlot(c.name, x, view, 120))), el("details", null, el("summary", null, "As numbers"), saved("Channels", heads, rows, table("Channels", heads, rows))));
}

function mapCard(k, x, name) {
  if (!k.map_text) return null;
  const text = el("textarea", { id: "map-text", rows: Math.min(24, k.map_text.split("\n").length + 1), "aria-label": "The map as text", spellcheck: "false" });
  text.value = k.map_text;
  const seen = (c) => { const s = k.columns.find((o) => o.name === c); return s ? `${asGiven(s.low, 4)} to ${asGiven(s.high, 4)} ${named(c)[1]}` : ""; };
  const rows = (k.entries || []).map((e) => [named(e.channel)[0], e.column, [unitOf(k, e, name),  e.sign < 0 ? "other sign" : "", e.offset ? `offset ${num(e.offset)}` : "", e.frame].filter(Boolean).map((part, i) => (i ? [" ", part] : part)), seen(e.channel)]);
  return card("The map: which column is what", rows.length ? table(k.map ? `As ${k.map} says` : "Proposed from names, units, ranges and motion; nothing is written yet", ["channel", "column of the file", "read as", "values"], rows) : null, taker(k, name),
    el("details", { open: !!k.problem }, el("summary", null, "The map as text"), text, el(".tools", null, button(`Save as ${mapOf(name)}`, doing(async () => { await ask("/api/maps", { name: mapOf(name), text: text.value, base: k.map ? k.map_text : undefined }); await again(); }), { id: "save-map", disabled: state.project.read_only }))));
}

const write = (k, name, edit) => doing(async () => { await ask("/api/remedy", { name: mapOf(name), text: k.map_text, edit: edit() }); await again(); });

/** The unit that a column is in, to be chosen anew. */
function unitOf(k, e, name) {
  const units = k.channels?.[e.channel] || [], own = e.unit || units[0];
  if (state.project.read_only || units.length < 2 || !units.includes(own)) return e.unit || "as it is";
  const select = choose(`unit-${e.channel}`, units.map((u) => [u, u]), own, (u) => write(k, name, () => ({ [e.channel]: { unit: u } }))());
  select.setAttribute("aria-label", `Unit of ${named(e.channel)[0]} in the file`);
  return select;
}

/** Columns that no channel takes: what each is can be said here. */
function taker(k, name) {
  const free = k.unused || [], left = Object.keys(k.channels || {}).filter((c) => !k.entries.some((e) => e.channel === c));
  if (!free.length || state.project.read_only) return null;
  const row = (column, i) => {
    const unit = choose(`take-unit-${i}`, [["", "unit"]], ""), what = choose(`take-${i}`, [["", "not used"], ...left.map((c) => [c, named(c)[0]])], "", (c) => { unit.replaceChildren(...(k.channels[c] || []).map((u) => el("option", { value: u }, u))); });
    what.setAttribute("aria-label", `What ${column.column} is`);
    unit.setAttribute("aria-label", `Unit of ${column.column}`);
    const take = write(k, name, () => ({ [what.value]: { column: column.column, ...(unit.value ? { unit: unit.value } : {}) } }));
    return [column.column, `${asGiven(column.low, 4)} to ${asGiven(column.high, 4)}`, what, unit, button("Take it", (e) => { if (what.value) take(e); else what.focus(); }, { class: "small", "aria-label": `Take ${column.column}` })];
  };
  return el("details", { open: !!k.problem }, el("summary", null, `${free.length} columns are not used`), table("What else the file holds: say what a column is, and it is read", ["column of the file", "values", "it is", "in", ""], free.map(row)));
}

function importer(name, k, map, ship) {
  const key = `import.${name}`, output = el("input", { type: "text", id: "import-output", value: kept(key, () => `${name.replace(/\.[^.]+$/, "")}.mcap`), oninput: (e) => { state.kept[key] = e.target.value; say(); } });
  const accept = kept(`accept.${name}`, () => new Set()), refused = k.refused || [];
  const asked = () => ({ verb: "import", file: name, map: mapOf(name), output: output.value, ship, accept: [...accept] });
  const line = el("div"), words = () => ["twin import", quoted(name), "--map", quoted(mapOf(name)), ...(ship ? ["--ship", quoted(ship)] : []), ...[...accept].flatMap((c) => ["--accept", c]), "-o", quoted(output.value)];
  const say = () => line.replaceChildren(command(words().join(" ")));
  say();
  const run = async () => {
    if (!map) await ask("/api/maps", { name: mapOf(name), text: k.map_text });
    await start(asked(), "data");
    location.hash = address("data");
  };
  return card("Import", refused.length ? el("p.bad", null, `Refused while ${refused.join(", ")} ${refused.length > 1 ? "prove" : "proves"} a mistake: apply the remedy, or accept it.`) : el("p", null, "Checked and written as a voyage that every verb reads."),
    el("form", null, field("voyage file", output), refused.length ? boxes("import although it says otherwise", "accept", refused.map((c) => [c, c.replaceAll("_", " ")]), accept, () => { button_.disabled = refused.some((c) => !accept.has(c)); say(); }) : null, (button_ = go("Import", run, !!k.problem || refused.some((c) => !accept.has(c))))),
    line, imports(name));
}

let button_ = null;

function imports(name) {
  const jobs = state.jobs.filter((j) => j.verb === "import" && j.asked.file === name);
  return jobs.length ? el("p.note", null, "Done before: ", jobs.map((j) => [`${j.name} `, stateWord(j), j.said ? ` ${j.said} ` : " "])) : null;
}

export { found, over };
