// A replay: how far the predictions were off and what was promised of them, health over time, estimate against measurement.

function head() {
  const [mood, word] = badge();
  return el("header", null, el("div", null, el(".eyebrow", null, `${DATA.title} · ${RESULT.kind}`), el("h1", null, DATA.verdict), el(`span.badge.${mood}`, null, word)), themeButton());
}

/** Whether what was promised of the predictions was kept. */
function badge() {
  if (!RESULT.tube.length) return ["fair", "no tube: predictions without a promise"];
  const short = RESULT.tube.filter((c) => Math.min(c.place_inside, c.heading_inside) < c.level);
  return short.length ? ["fair", `fewer inside the tube than promised at ${short.map((c) => `${asGiven(c.horizon_s)} s`).join(", ")}`] : ["good", "the tube was kept"];
}

function predictionsSection() {
  const tube = RESULT.tube.map((c) => el("tr", null, el("td", null, `${asGiven(c.horizon_s)} s`), share(c.place_inside, c.level), share(c.heading_inside, c.level), el("td.n", null, percent(c.level)), el("td.n", null, num(c.place_radius_m)), el("td.n", null, num(c.heading_deg, 2)), el("td.n", null, num(c.place_score_m)), el("td.n", null, num(c.heading_score_deg, 2)), el("td.n", null, String(c.judged))));
  const sight = RESULT.foresight.map((f) => el("tr", null, el("td", null, `${asGiven(f.horizon_s)} s`), el("td.n", null, num(f.position_m)), el("td.n", null, num(f.heading_deg, 2)), el("td.n", null, String(f.windows))));
  const kept = tube.length ? [table(["ahead", ">places inside", ">headings inside", ">promised", ">tube [m]", ">[deg]", ">interval score [m]", ">[deg]", ">predictions"], tube), el("p.note", null, "Helm and engine held meanwhile; in the plots below the grey parts are predictions during which they moved, for which nothing is promised. Interval score: the tube's half width, and ten times or more what an error exceeds it by; smaller is better.")] : [el("p.note", null, "This ship file has no [tube], so predictions carry no promise. Made from voyages that the model has not seen:"), command(`twin tube VOYAGE.mcap --ship ${quoted(RESULT.files.ship)} -o SHIP2.toml`)];
  const ahead = sight.length ? [el("p.note", { style: { marginTop: "12px" } }, "Open loop from the estimate, under the recorded helm, engine and weather (mean absolute error):"), table(["ahead", ">place [m]", ">heading [deg]", ">starts"], sight)] : [];
  return section("Predictions against what came", null, ...kept, ...ahead);
}

const percent = (x) => `${Math.round(100 * x)} %`;

function share(x, level) {
  return el(`td.n.${x >= level ? "good" : "fair"}`, null, percent(x));
}

/** Modes and alarms: a bar for each stretch of time. */
function healthSection() {
  const v = DATA.voyages[0], rows = [];
  for (const { mode, level, spans } of DATA.modes) rows.push(...lane(mode, spans, RESULT.modes[mode] || 0, level, v));
  for (const { reason, spans } of DATA.reasons) rows.push(...lane(reason, spans, RESULT.reasons[reason], "residual", v));
  const marks = [v.start_s, (v.start_s + v.end_s) / 2, v.end_s].map((t, i) => el("span", { style: { left: `${50 * i}%`, transform: `translateX(-${50 * i}%)` } }, clock(t)));
  return section("Modes and alarms", "over the whole voyage; a bar where it stood", el(".lanes", null, rows, el("div"), el(".ticks", null, marks)));
}

function lane(word, spans, ticks, colour, v) {
  const long = v.end_s - v.start_s || 1, part = `${num(100 * (ticks || 0) / RESULT.ticks, 2)} %`, P = (t) => `${(100 * (t - v.start_s)) / long}%`;
  const said = `${word}: ${part} of the time, ${spans.length > 3 ? `${spans.length} times from ${clock(spans[0][0])} to ${clock(spans[spans.length - 1][1])}` : spans.map(([a, b]) => `${clock(a)} to ${clock(b)}`).join(", ")}`;
  const bars = spans.map(([a, b]) => el("i", { style: { left: P(a), width: `max(2px, calc(${P(b)} - ${P(a)}))`, background: `var(--${colour})` } }));
  return [el(".word", null, word, el("small", null, ticks === undefined ? "" : part)), el(".lane", { role: "img", "aria-label": said, title: said }, bars)];
}

function provenance() {
  const p = DATA.provenance, rows = [["log", RESULT.log], ["sha256 of the log", DATA.log_sha256], ["ship", `${p.ship} (${p.ship_file}), model ${p.ship_hash}`], ["version", `shiptwin ${p.version}`], ["ticks", `${RESULT.ticks}, ${RESULT.rejected} samples refused, ${RESULT.withheld} numbers withheld`], ["sha256 of all that was said", DATA.sha256]];
  const notes = RESULT.notes.map((n) => el("p.note", null, n)), settings = el("details", null, el("summary", null, "settings"), el("pre", null, JSON.stringify(JSON.parse(p.settings), null, 1)));
  return section("Provenance", "the same log, ship, settings and version give the same sum", table(["", ""], rows.map(([k, x]) => el("tr", null, el("td", null, k), el("td", null, el("code", null, x))))), notes, settings, command(RESULT.command));
}

const v = DATA.voyages[0];
document.documentElement.dataset.theme = wishedTheme();
document.title = DATA.title;
decode(v);
[view.from, view.to] = [v.start_s, v.end_s];
const plots = plotsSection(v), map = v.track ? section("Track", null, trackPlot(v, LINES.filter((l) => v.track.lines[l.key]))) : null;
if (map) map.querySelector(".head").append(legend());
const further = section("Next", "the model against the same measurements, open loop", command(`twin compare ${quoted(RESULT.log)} --ship ${quoted(RESULT.files.ship)} --report compare.html`));
document.getElementById("page").append(...[head(), predictionsSection(), healthSection(), plots, map, further, provenance()].filter(Boolean), el("footer", null, "shiptwin · this page is whole: it asks nothing of any network"));
live();
document.documentElement.dataset.readyMs = "0";
