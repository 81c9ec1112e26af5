// Everything beside the chart: mode, tiles, tables, alarms, wind and stream.

import { bearing, by, clock, drawn, fixed, made, say, set, table } from "/dom.js";

const TILES = ["heading", "speed ahead", "rate of turn", "speed to starboard"];
const ORIGINS = { live: "", replay: "RECORDED VOYAGE, replayed", log: "RECORDED VOYAGE, from a log" };
let announced = null;

export function header(frame, old) {
  const name = frame.ship.ship || "Unnamed ship";
  say(by("ship"), name);
  document.title = `${old ? "OLD: " : ""}${name}`;
  const recorded = ORIGINS[frame.ship.origin] ?? frame.ship.origin;
  set(by("origin"), { class: recorded ? "recorded" : "" });
  say(by("origin"), recorded ? `${recorded}: ${frame.feed.name}` : frame.feed.name);
  say(by("clock").querySelector("time"), frame.wall_s === undefined ? "--:--:--" : clock(frame.wall_s));
}

export function silence(text) {
  const bar = by("silence");
  bar.hidden = !text;
  // the count of seconds is for the eye; a screen reader hears the first of them
  if (text) say(bar, text);
  set(bar, { "aria-atomic": "false" });
}

export function panels(frame) {
  mode(frame.mode);
  tiles(frame.states);
  motion(frame.states);
  actuators(frame.actuators);
  ahead(frame.ahead);
  forces(frame.forces);
  water(frame);
  ages(frame.instruments);
  pace(frame.pace);
}

function mode({ name, level, words }) {
  const box = by("mode");
  set(box, { class: level });
  say(box.querySelector(".big"), name);
  say(box.querySelector(".words"), words);
}

function tiles(states) {
  const box = by("tiles");
  if (!box.childNodes.length) {
    box.append(...TILES.map((name) => made("div", { class: "tile" }, made("span", { class: "name" }, name), made("span", { class: "value" }, made("span"), made("span", { class: "unit" })), made("span", { class: "from" }))));
  }
  TILES.forEach((name, i) => {
    const state = states.find((s) => s.name === name);
    const tile = box.childNodes[i];
    const [number, unit] = tile.querySelector(".value").childNodes;
    say(number, name === "heading" ? heading(state.estimate) : fixed(state.estimate, 1));
    say(unit, state.unit);
    const lost = state.lost || state.measured === null;
    set(tile, { class: lost ? "tile lost" : "tile" });
    const measured = name === "heading" ? heading(state.measured) : fixed(state.measured, 1);
    say(tile.querySelector(".from"), lost ? "not measured now" : `measured ${measured}${state.unit.startsWith("°") ? "" : " "}${state.unit}`);
  });
}

const heading = (value) => (value === null ? "–" : (value % 360).toFixed(1).padStart(5, "0"));

function motion(states) {
  const rows = states.map((s) => {
    const age = s.lost ? "lost" : s.age === null ? "–" : `${s.age.toFixed(1)} s`;
    const sigma = s.sigma === null ? "" : ` ± ${fixed(s.sigma, s.decimals)}`;
    return ["", `${s.name} [${s.unit}]`, [fixed(s.measured, s.decimals), s.lost ? "lost" : "measured"], [fixed(s.estimate, s.decimals) + sigma], [age, s.lost ? "lost" : ""]];
  });
  table(by("motion"), "Motion, measured and estimated", ["motion", "measured", "estimated ± 1 sigma", "age"], rows);
}

// What each actuator is told or says of itself; a ship with one propeller and one rudder has none.
function actuators(channels) {
  by("actuators-box").hidden = !channels.length;
  const rows = channels.map((c) => {
    const lost = c.level === "bad" ? "lost" : "";
    const said = c.value === null ? c.words : `${fixed(c.value, 1)}${c.unit === "-" ? "" : ` ${c.unit}`}`;
    return ["", c.name, [said, lost], [c.age === null ? "–" : `${c.age.toFixed(1)} s`, lost]];
  });
  table(by("actuators"), "What each actuator does", ["actuator", "says", "age"], rows);
}

function ahead(next) {
  const shown = next?.shown ?? [];
  const rows = shown.map((p) => [
    next.old ? "old-row" : "", `${p.horizon.toFixed(0)} s`,
    [`${p.distance.toFixed(0)} m, ${bearing(p.bearing)}`], [bearing(p.psi)], [spread(p)], [surely(p)],
  ]);
  table(by("ahead"), "Where the ship will be", ["after", "from here", "heading", "within", "how sure"], rows);
  const note = by("ahead-note");
  set(note, { class: next?.old ? "note old" : "note" });
  say(note, !next ? "No prediction yet." : !shown.length ? "No prediction for 60 or 120 s (prediction.horizons_s of the settings)." : next.old ? `OLD: said ${next.age.toFixed(0)} s ago.` : promised(shown) ? "If helm and engine are held. Along / across the course, and heading." : "± north / east: 68 % of the errors are smaller; prior: assumed, learned: from this voyage.");
}

const promised = (shown) => shown.some((p) => p.tube?.level);

// What is promised where reference voyages do, else one sigma.
function spread(p) {
  if (!p.tube?.level && p.sn === null) return "no promise";
  if (!p.tube?.level) return `± ${fixed(p.sn, 0)} / ${fixed(p.se, 0)} m`;
  return `± ${fixed(p.tube.along, 0)} / ${fixed(p.tube.across, 0)} m, ± ${fixed(p.tube.heading, 1)}°`;
}

function surely(p) {
  if (!p.tube) return p.status;
  return p.tube.level ? `${p.tube.level} %, on ${p.tube.voyages} voyages` : (p.sn === null ? p.tube.words : `${p.status}: no promise, ${p.tube.words}`);
}

function forces({ unit, moment_unit, rows, parts, share }) {
  const heads = ["force", `ahead [${unit}]`, `starboard [${unit}]`, `turning [${moment_unit}]`];
  const cells = (row) => ["", row.name, [fixed(row.X, 1)], [fixed(row.Y, 1)], [fixed(row.N, 1)]];
  table(by("forces"), "Known and learned force", heads, rows.map(cells));
  table(by("parts"), "Known force by effect", heads, parts.map(cells));
  say(by("share"), `The learned force is ${share} % of all force.`);
}

function water(frame) {
  const box = by("water");
  if (!box.childNodes.length) {
    const one = (name, arrow, kind) => made("div", { class: "one" },
      drawn("svg", { viewBox: "-26 -26 52 52", "aria-hidden": "true" }, drawn("circle", { r: 24, class: "grid" }), drawn("path", { d: arrow, class: kind })),
      made("div", {}, made("div", { class: "note" }, name), made("div", { class: "value" }), made("div", { class: "note" })));
    const arrow = "M0 17V-17M-7 -9L0 -17L7 -9";
    box.append(one("wind", arrow, "blow"), one("stream", arrow, "flow"));
  }
  const { wind, stream } = frame;
  filled(box.childNodes[0], wind && [wind.from + 180, `${fixed(wind.speed, 1)} m/s`, `from ${bearing(wind.from)}, ${fixed(wind.age, 0)} s old`], "not measured");
  filled(box.childNodes[1], stream && [stream.speed < 0.05 ? null : stream.to, `${fixed(stream.speed, 2)} kn`, stream.speed < 0.05 ? "estimated: hardly any" : `towards ${bearing(stream.to)}, estimated`], "not known");
}

function filled(one, said, otherwise) {
  const [svg, words] = one.childNodes;
  const turned = said ? said[0] : null;
  set(svg.lastChild, { visibility: turned === null ? "hidden" : "visible", transform: `rotate(${turned ?? 0})` });
  say(words.childNodes[1], said ? said[1] : "–");
  say(words.childNodes[2], said ? said[2] : otherwise);
}

function ages(instruments) {
  const box = by("ages");
  while (box.children.length > instruments.length) box.lastChild.remove();
  while (box.children.length < instruments.length) box.append(made("li", {}, made("span"), made("span"), made("span")));
  instruments.forEach((i, k) => {
    const [name, age, why] = box.children[k].children;
    say(name, i.name);
    say(age, i.age === null ? "–" : `${i.age.toFixed(1)} s`);
    set(age, { class: `age ${i.level}` });
    why.hidden = i.level === "good";
    set(why, { class: `why ${i.level}` });
    say(why, i.words);
  });
}

function pace(p) {
  const said = {
    "left of each period": p.slack_ms === null ? "no deadline: recorded" : `${fixed(p.slack_ms, 0)} of ${fixed(1000 / p.rate, 0)} ms`,
    "one tick takes": p.step_ms === null ? "–" : `${fixed(p.step_ms, 1)} ms`,
    "ticks": `${fixed(p.rate, 0)} a second, ${p.overruns} skipped`,
    "samples refused": String(p.rejected),
    "log messages lost": String(p.log_dropped),
  };
  const box = by("pace");
  if (!box.childNodes.length) box.append(...Object.keys(said).flatMap((name) => [made("dt", {}, name), made("dd")]));
  Object.values(said).forEach((text, i) => say(box.childNodes[2 * i + 1], text));
}

// The alarms, one item each, kept by its key so that a button keeps the focus.
export function alarms(list, acknowledge) {
  const box = by("alarms").querySelector("ul");
  const items = new Map([...box.children].map((item) => [item.dataset.key, item]));
  list.forEach((alarm, i) => {
    const item = items.get(alarm.key) ?? born(alarm.key, acknowledge);
    items.delete(alarm.key);
    if (box.children[i] !== item) box.insertBefore(item, box.children[i] ?? null);
    const [when, text, button, state] = item.childNodes;
    set(item, { class: alarm.acknowledged ? "seen" : "new" });
    say(when, clock(alarm.since_s));
    say(text, alarm.text);
    set(button, { "aria-label": `Acknowledge: ${alarm.text}` });
    button.hidden = alarm.acknowledged;
    say(state, `${alarm.over ? "over" : "stands"}, ${alarm.acknowledged ? "acknowledged" : "not acknowledged"}`);
  });
  for (const item of items.values()) item.remove();
  by("none").hidden = list.length > 0;
  by("all").hidden = !list.some((alarm) => !alarm.acknowledged);
  const fresh = list.filter((alarm) => !alarm.acknowledged && !(announced?.has(alarm.key)));
  if (fresh.length) say(by("news"), `New alarm: ${fresh.map((alarm) => alarm.text).join("; ")}`);
  announced = new Set(list.map((alarm) => alarm.key));
}

function born(key, acknowledge) {
  const button = made("button", { type: "button" }, "Acknowledge");
  button.addEventListener("click", () => acknowledge(key));
  const item = made("li", {}, made("span", { class: "when" }), made("span", { class: "text" }), button, made("span", { class: "state" }));
  item.dataset.key = key;
  return item;
}
