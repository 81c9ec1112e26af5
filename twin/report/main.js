// The page, from the verdict down.
const LINES = DATA.voyages.length && DATA.voyages[0].track.lines.before ? [{ key: "before", colour: "before", word: "model before" }, { key: "after", colour: "model", word: "model after" }] : [{ key: "model", colour: "model", word: "model" }];

function decode(v) {
  if (v.decoded) return;
  v.times = v.times.map(unpack);
  const open = (s) => ({ t: v.times[s.t], y: unpack(s.y) });
  for (const c of [...v.channels, ...v.inputs]) {
    c.measured = open(c.measured);
    for (const group of [c.lines || {}, c.residuals || {}]) for (const key of Object.keys(group)) group[key] = open(group[key]);
  }
  for (const part of [v.track, ...Object.values(v.track.lines)]) for (const key of ["t", "x", "y"]) if (part[key]) part[key] = unpack(part[key]);
  v.heat.t = unpack(v.heat.t);
  for (const r of v.heat.rows) r.y = unpack(r.y);
  v.decoded = true;
}

function tone() {
  if (DATA.kind === "add") return RESULT.forced ? ["fair", "forced"] : RESULT.accepted ? ["good", "the error falls"] : ["bad", "not written"];
  if (DATA.kind === "diagnose") return { missing: ["bad", "missing"], nothing_missing: ["good", "nothing missing"], unknown: ["fair", "unknown cause"], undecided: ["fair", "undecided"] }[RESULT.verdict] || ["fair", RESULT.verdict];
  if (!RESULT.horizons.length) return ["fair", "not judged"];
  const times = RESULT.horizons.map((h) => Math.max(h.position_mae_m / h.noise_floor.position_mae_m, h.heading_mae_deg / h.noise_floor.heading_mae_deg));
  const last = times[times.length - 1], x = last < 1.5 ? Math.max(...times) : last; // as the verdict (open_loop_comparison.py)
  return x < 1.5 ? ["good", "as expected"] : x < 4 ? ["fair", `${num(x, 2)} times the expected error`] : ["bad", `${num(x, 2)} times the expected error`];
}

function head() {
  const [mood, word] = tone();
  const theme = el("button", { onclick: () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark") }, "light / dark");
  const names = DATA.voyages.map((v) => v.name).join(", ");
  return el("header", null, el("div", null, el(".eyebrow", null, `${DATA.title} · ${names}`), el("h1", null, DATA.verdict), el(`span.badge.${mood}`, null, word)), theme);
}

function setTheme(name) {
  document.documentElement.dataset.theme = name;
  redraw();
}

function pickVoyage(i) {
  if (i === view.voyage && view.panels.length) return;
  view.voyage = i;
  const old = document.getElementById("voyage"), inside = old.contains(document.activeElement), fresh = voyageParts();
  old.replaceWith(fresh);
  if (inside) fresh.querySelector("[aria-pressed=true]").focus(); // whoever chose it by keyboard goes on from there
  whole();
}

/** Heat strip, plots and track of the chosen voyage. */
function voyageParts() {
  const v = DATA.voyages[view.voyage];
  decode(v);
  view.panels = []; view.watchers = [];
  [view.from, view.to] = [v.start_s, v.end_s];
  const tabs = DATA.voyages.length > 1 ? el(".bar", null, DATA.voyages.map((w, i) => el("button", { "aria-pressed": String(i === view.voyage), onclick: () => pickVoyage(i) }, w.name))) : null;
  const heat = section("Channel by time", `errors up to ${v.heat.ahead_s} s ahead, by when they begin; click, or arrows and Enter, to see`, tabs, heatStrip(v));
  heat.querySelector(".head").append(heatLegend());
  const map = section("Track", `the model starts anew every ${DATA.longest_s} s`, trackPlot(v, LINES));
  map.querySelector(".head").append(legend());
  return el("div", { id: "voyage" }, heat, map, plotsSection(v));
}

function legend() {
  const item = (name, word) => el("span", null, el("i", { style: { borderColor: `var(--${name})` } }), word);
  return el(".legend", null, item("measured", "measured"), LINES.map((l) => item(l.colour, l.word)));
}

function plotsSection(v) {
  const top = el(".sticky", null, el(".bar", null, el("button", { onclick: whole }, "whole voyage"), el("button", { onclick: () => setZoom(view.from - (view.to - view.from) / 2, view.to + (view.to - view.from) / 2) }, "wider"), el("button", { onclick: () => setZoom(view.from + (view.to - view.from) / 4, view.to - (view.to - view.from) / 4) }, "nearer"), el("span.note", null, "drag to choose a stretch, click to go nearer, double-click for all; by keyboard on the axis below: arrows, Enter, + and −"), legend()), el(".panel", { style: { border: 0, padding: 0 } }, el("div"), timeAxis()));
  const out = section("Measured, modelled, left over", null, top, v.channels.map((c) => channelPanel(v, c)), v.inputs.map((c) => inputPanel(c)));
  out.id = "plots";
  return out;
}

function channelPanel(v, c) {
  const [word, unit] = named(c.name), value = el(".value");
  const lines = LINES.map((l) => ({ data: c.lines[l.key], colour: l.colour, width: 1.6, breaks: v.restarts, gap: 1e9 }));
  const main = plot(96, [{ data: c.measured, colour: "measured", width: 1.6, alpha: 0.9 }, ...lines], { label: `${word}, measured and modelled, over time` });
  const panel = view.panels[view.panels.length - 1];
  const rest = plot(50, LINES.map((l) => ({ data: c.residuals[l.key], colour: LINES.length > 1 ? l.colour : "residual", width: 1.3, breaks: v.restarts, gap: 1e9 })), { band: c.noise || 1e-6, label: `${word}, measured − model, over time` });
  panel.say = (t) => { value.textContent = t === null ? "" : `${clock(t)}  ${asGiven(valueAt(c.measured, t), 5)}\n${LINES.map((l) => `${l.word} ${asGiven(valueAt(c.lines[l.key], t), 5)}\nmeasured − it ${asGiven(valueAt(c.residuals[l.key], t), 5)}`).join("\n")}`; };
  return el(".panel", null, el(".name", null, el("b", null, word), el("small", null, `${unit}; below: measured − model, noise ±${num(c.noise, 2)}`), value), el("div", null, main, rest));
}

function inputPanel(c) {
  const [word, unit] = named(c.name), value = el(".value");
  const box = plot(58, [{ data: c.measured, colour: "measured", width: 1.3, gap: 90 }], { label: `${word}, recorded, over time` });
  view.panels[view.panels.length - 1].say = (t) => { value.textContent = t === null ? "" : `${clock(t)}  ${asGiven(valueAt(c.measured, t), 5)}`; };
  return el(".panel", null, el(".name", null, el("b", null, word), el("small", null, unit), value), box);
}

function next() {
  const f = RESULT.files || {}, rest = `${(f.voyages || ["VOYAGE.mcap"]).join(" ")} --ship ${f.ship || "SHIP.toml"}`;
  if (DATA.kind === "compare") return section("Next", "which physical effect is missing?", command(`twin diagnose ${rest} --report diagnose.html`));
  if (DATA.kind === "add" && RESULT.output) return section("Next", "the better model against the same measurements", command(`twin compare ${(f.judged || f.voyages || ["VOYAGE.mcap"]).join(" ")} --ship ${RESULT.output}`));
  return null;
}

function build() {
  const start = performance.now();
  const wish = (location.hash.match(/theme=(dark|light)/) || [])[1];
  document.documentElement.dataset.theme = wish || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  document.title = DATA.title;
  const own = { compare: [], diagnose: [rankingSection(), momentsSection(), manoeuvreSection()], add: [fittedSection(), ladderSection()] }[DATA.kind] || [];
  const parts = [head(), ...own.filter(Boolean), errorsSection(), next(), el(".two", null, whereSection(), worstSection()), DATA.voyages.length ? voyageParts() : null, channelsSection(), checksSection(), provenanceSection()];
  document.getElementById("page").append(...parts.filter(Boolean), el("footer", null, "shiptwin · this page is whole: it asks nothing of any network"));
  const stretch = location.hash.match(/t=([\d.]+),([\d.]+)/);
  stretch ? setZoom(+stretch[1], +stretch[2]) : redraw();
  addEventListener("resize", () => { redraw(); point(null); stretch(null, null); });
  printedLight(redraw);
  addEventListener("keydown", (e) => e.key === "Escape" && whole());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (e) => setTheme(e.matches ? "dark" : "light"));
  document.documentElement.dataset.readyMs = String(Math.round(performance.now() - start));
}
build();
