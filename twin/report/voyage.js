// A voyage's plots: every channel over time on one zoom, the heat strip and the track; for all pages that have some.
const LINES = DATA.lines || (DATA.voyages.length && DATA.voyages[0].track.lines.before ? [{ key: "before", colour: "before", word: "model before" }, { key: "after", colour: "model", word: "model after" }] : [{ key: "model", colour: "model", word: "model" }]);

function decode(v) {
  if (v.decoded) return;
  v.times = v.times.map(unpack);
  const open = (s) => ({ t: v.times[s.t], y: unpack(s.y) });
  for (const c of [...v.channels, ...v.inputs]) {
    c.measured = open(c.measured);
    for (const key of Object.keys(c.lines || {})) c.lines[key] = open(c.lines[key]);
    for (const key of Object.keys(c.residuals || {})) c.residuals[key] = there(open(c.residuals[key]));
  }
  for (const part of v.track ? [v.track, ...Object.values(v.track.lines)] : []) for (const key of ["t", "x", "y"]) if (part[key]) part[key] = unpack(part[key]);
  for (const c of v.foretold || []) for (const s of [c.error, c.moved, c.tube]) for (const key of Object.keys(s)) s[key] = key === "t" ? v.times[s.t] : unpack(s[key]);
  if (v.heat) {
    v.heat.t = unpack(v.heat.t);
    for (const r of v.heat.rows) r.y = unpack(r.y);
  }
  v.decoded = true;
}

/** Only the samples that are there. */
function there({ t, y }) {
  const seen = (_, i) => y[i] === y[i];
  return y.every((v) => v === v) ? { t, y } : { t: t.filter(seen), y: y.filter(seen) };
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
  const out = section(DATA.plots || "Measured, modelled, left over", null, top, (v.foretold || []).map((c) => tubePanel(c)), v.channels.map((c) => channelPanel(v, c)), v.inputs.map((c) => inputPanel(c)));
  out.id = "plots";
  return out;
}

function channelPanel(v, c) {
  const [word, unit] = named(c.name), value = el(".value");
  const lines = LINES.map((l) => ({ data: c.lines[l.key], colour: l.colour, width: 1.6, breaks: v.restarts, gap: 1e9 }));
  const main = plot(96, [{ data: c.measured, colour: "measured", width: 1.6, alpha: 0.9 }, ...lines], { label: `${word}, measured and modelled, over time` });
  const panel = view.panels[view.panels.length - 1];
  const rest = plot(50, LINES.map((l) => ({ data: c.residuals[l.key], colour: LINES.length > 1 ? l.colour : "residual", width: 1.3, breaks: v.restarts })), { band: c.noise || 1e-6, label: `${word}, measured − model, over time` });
  panel.say = (t) => { value.textContent = t === null ? "" : `${clock(t)}  ${asGiven(valueAt(c.measured, t), 5)}\n${LINES.map((l) => `${l.word} ${asGiven(valueAt(c.lines[l.key], t), 5)}\nmeasured − it ${asGiven(valueAt(c.residuals[l.key], t), 5)}`).join("\n")}`; };
  return el(".panel", null, el(".name", null, el("b", null, word), el("small", null, `${unit}; below: measured − ${LINES.length > 1 ? "each" : "model"}, ${c.noise_word || "noise"} ±${num(c.noise, 2)}`), value), el("div", null, main, rest));
}

/** How far a prediction was off when its time came, and the tube that was promised for it. */
function tubePanel(c) {
  const value = el(".value"), promised = c.tube.t.length ? { tube: c.tube } : {};
  const box = plot(84, [{ data: c.moved, colour: "measured", width: 1.1, alpha: 0.75, gap: 10 }, { data: c.error, colour: "residual", width: 1.6, gap: 10 }], { ...promised, label: `${c.word}, error of the prediction over time` });
  view.panels[view.panels.length - 1].say = (t) => {
    const tube = c.tube.t.length ? `\ntube ±${asGiven(valueAt({ t: c.tube.t, y: c.tube.high }, t), 4)}` : "";
    value.textContent = t === null ? "" : `${clock(t)}  ${asGiven(valueAt(c.error, t), 4)}${tube}\nhelm moved ${asGiven(valueAt(c.moved, t), 4)}`;
  };
  return el(".panel", null, el(".name", null, el("b", null, c.word), el("small", null, c.unit), value), box);
}

function inputPanel(c) {
  const [word, unit] = named(c.name), value = el(".value");
  const box = plot(58, [{ data: c.measured, colour: "measured", width: 1.3, gap: 90 }], { label: `${word}, recorded, over time` });
  view.panels[view.panels.length - 1].say = (t) => { value.textContent = t === null ? "" : `${clock(t)}  ${asGiven(valueAt(c.measured, t, 90), 5)}`; };
  return el(".panel", null, el(".name", null, el("b", null, word), el("small", null, unit), value), box);
}

/** What every page with plots hears: a stretch in its address, another width, paper, Escape, the screen's own dark. */
function live() {
  const zoomed = location.hash.match(/t=([\d.]+),([\d.]+)/);
  zoomed ? setZoom(+zoomed[1], +zoomed[2]) : redraw();
  addEventListener("resize", () => { redraw(); point(null); stretch(null, null); });
  printedLight(drawAll);
  addEventListener("keydown", (e) => e.key === "Escape" && whole());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (e) => setTheme(e.matches ? "dark" : "light"));
}

function wishedTheme() {
  return (location.hash.match(/theme=(dark|light)/) || [])[1] || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
}

function themeButton() {
  return el("button", { onclick: () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark") }, "light / dark");
}
