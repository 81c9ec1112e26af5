// A project as it stands: its ship, its voyages, the error before and now, the diagnosis, the history.
const when = (s) => `${new Date(1000 * s).toISOString().slice(0, 16).replace("T", " ")} UTC`;
const TAG = { reference: "reference", voyage: "voyage", held_out: "held out" };

function head() {
  const theme = el("button", { onclick: () => { const d = document.documentElement.dataset; d.theme = d.theme === "dark" ? "light" : "dark"; } }, "light / dark");
  return el("header", null, el("div", null, el(".eyebrow", null, `${DATA.title} · as it stood on ${when(DATA.made_s)}`), el("h1", null, DATA.verdict)), theme);
}

/** Of what an answer is, when it was found, and whether its files are still those. */
function from(said) {
  const changed = said.changed.length ? el("p.note.fair", null, `Changed or gone since: ${said.changed.join(", ")}. Ask again.`) : null;
  return [el("p.note", null, `${said.ship}, ${said.judged.join(", ")}; found on ${when(said.ended_s)}`), changed, command(said.command)];
}

function shipSection() {
  const s = DATA.about;
  if (!DATA.file) return section("Ship", null, el("p.note", null, "No ship file yet. A first model of the main particulars:"), command("twin init NAME --length-pp-m 180 --beam-m 30 --draught-m 10.5 -o ship.toml"));
  const rows = s.particulars.map((p) => el("tr", null, el("td", null, p.name), el("td.n", null, `${asGiven(p.value, 5)}${p.unit === "-" ? "" : ` ${p.unit}`}`), el("td", null, p.doc), el("td", null, p.source || "usual value")));
  const effects = s.effects.length ? s.effects.map((e) => el("p.note", null, `${e.name}: ${e.numbers.map((n) => `${n.name.replaceAll("_", " ")} ${withUnit(asGiven(n.value, 4), n)}`).join(", ")}`)) : el("p.note", null, "The core alone: no effect was added.");
  return section(`Ship: ${s.ship}`, `${DATA.file}, ${s.calibrated ? "calibrated to reference voyages" : "not calibrated yet"}`, effects, el("details", null, el("summary", null, `${rows.length} particulars`), table(["number", ">value", "meaning", "source"], rows)));
}

function voyagesSection() {
  const list = DATA.files.filter((f) => f.kind === "voyage");
  if (!list.length) return section("Voyages", null, el("p.note", null, "No voyage yet. Import a log:"), command("twin import LOG -o voyage.mcap"));
  const began = (f) => DATA.began[f.name.replace(/\.mcap$/i, "")] || "", dated = list.some(began);
  const rows = list.map((f) => el("tr", null, el("td", null, f.name), el("td", null, TAG[f.tag]), dated ? el("td", null, began(f)) : null, el("td.n", null, `${num(f.bytes / 1e6)} MB`)));
  return section("Voyages", "and what each is kept for", table(["file", "kept for", ...(dated ? ["began"] : []), ">size"], rows));
}

function errorSections() {
  if (!RESULT.horizons.length) return [section("Error before and now", null, el("p.note", null, "Nothing was compared with measurements yet."), DATA.file ? command(`twin compare VOYAGE.mcap --ship ${quoted(DATA.file)}`) : null)];
  const error = errorsSection();
  error.append(...from(DATA.now).filter(Boolean));
  return [error, whereSection()];
}

function comparisonsSection() {
  if (!DATA.comparisons.length) return null;
  const rows = DATA.comparisons.map((c) => el("tr", null, el("td", null, c.voyages.join(", ")), el("td", null, c.ship, c.changed.length ? el("span.fair", null, " (changed since)") : null), el("td.n", null, `${asGiven(c.horizon_s)} s`), el("td.n", null, num(c.position_mae_m, 3)), el("td.n", null, c.expected_m === null ? "–" : num(c.expected_m, 3)), el("td.n", null, num(c.heading_mae_deg, 2))));
  return section("Every comparison", "the oldest first, at the longest horizon", table(["voyages", "ship file", ">ahead", ">error [m]", ">expected [m]", ">heading [deg]"], rows));
}

function calibrationSection() {
  const c = DATA.calibrated;
  if (!c) return null;
  const rows = DATA.held_out.filter((h) => h.position_m !== null).map((h) => el("tr", null, el("td", null, `${asGiven(h.horizon_s)} s`), el("td.n", null, num(h.before_m, 3)), el("td.n", null, num(h.position_m, 3)), el("td.n", null, num(h.before_deg, 2)), el("td.n", null, num(h.heading_deg, 2))));
  return section("Calibration", "error on what was not used for the fit, before and after", table(["ahead", ">before [m]", ">after [m]", ">before [deg]", ">after [deg]"], rows), from(c));
}

function diagnosisSections() {
  if (!DATA.diagnosed) return [section("Which effect is missing", null, el("p.note", null, "Nothing was diagnosed yet."), DATA.file ? command(`twin diagnose VOYAGE.mcap --ship ${quoted(DATA.file)}`) : null)];
  const ranking = rankingSection();
  const added = DATA.added.length ? el("p.good", null, `Added to the model since: ${DATA.added.join(", ")}.`) : null;
  ranking.querySelector(".head").after(el("p", null, DATA.diagnosed.sentence), added || "", ...from(DATA.diagnosed).filter(Boolean));
  return [ranking, manoeuvreSection()];
}

document.documentElement.dataset.theme = (location.hash.match(/theme=(dark|light)/) || [])[1] || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
document.title = DATA.title;
const parts = [head(), ...errorSections(), comparisonsSection(), ...diagnosisSections(), ladderSection(), calibrationSection(), shipSection(), voyagesSection()];
document.getElementById("page").append(...parts.filter(Boolean), el("footer", null, `shiptwin ${DATA.version} · this page is whole: it asks nothing of any network`));
printedLight(() => {});
document.documentElement.dataset.readyMs = "0";
