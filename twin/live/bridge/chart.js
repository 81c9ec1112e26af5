// The ship from above, on a grid of metres, with its true length and beam; where it will be, and how surely.

import { bearing, by, drawn, fixed, say, set } from "/dom.js";
import { look } from "/look.js";

const HULL = [[0.5, 0], [0.4, 0.32], [0.3, 0.5], [-0.46, 0.5], [-0.5, 0.42], [-0.5, -0.42], [-0.46, -0.5], [0.3, -0.5], [0.4, -0.32]];
const SMALLEST = 16; // pixels: a shorter ship is a symbol
const RAD = Math.PI / 180;
let parts = null;
let range = 0; // metres from the ship to the edge
let trail = [];

export function takeTrail(points) {
  trail = points;
}

function build() {
  const svg = drawn("svg", { role: "img", "aria-labelledby": "sea-title" });
  const names = { grid: "path", trail: "path", tube: "path", way: "path", later: "g", lead: "path", hull: "path" };
  const made = { svg, title: drawn("title", { id: "sea-title" }) };
  const hatch = drawn("pattern", { id: "hatch", width: 24, height: 24, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" }, drawn("path", { d: "M0 0V24" }));
  svg.append(made.title, drawn("defs", {}, hatch));
  for (const [name, kind] of Object.entries(names)) {
    made[name] = drawn(kind, kind === "g" ? {} : { class: name });
    svg.append(made[name]);
  }
  made.ruler = drawn("path", { class: "ruler" });
  made.rulerText = drawn("text", { "text-anchor": "middle" });
  made.north = drawn("g", {}, drawn("path", { class: "north", d: "M0 -20L8 12L0 6L-8 12Z" }), drawn("text", { y: -25, "text-anchor": "middle" }, "N"));
  made.veil = drawn("rect", { class: "hatch", width: "100%", height: "100%" });
  made.stamp = drawn("text", { class: "stamp", "text-anchor": "middle" });
  svg.append(made.ruler, made.rulerText, made.north, made.veil, made.stamp);
  by("sea").replaceChildren(svg);
  return made;
}

export function draw(frame, old) {
  parts ??= build();
  const box = by("sea");
  const [width, height] = [box.clientWidth, box.clientHeight];
  set(parts.svg, { viewBox: `0 0 ${width} ${height}` });
  stamped(frame, old, width, height);
  const place = frame.place;
  const hide = !place;
  for (const name of ["grid", "trail", "tube", "way", "later", "lead", "hull", "ruler", "rulerText"]) {
    set(parts[name], { visibility: hide ? "hidden" : "visible" });
  }
  if (hide) {
    say(parts.title, "No estimate of the place yet.");
    return;
  }
  const turn = look.headUp ? place.psi * RAD : 0;
  range = fitted(frame, place);
  const half = Math.min(width, height) / 2 - 14;
  const perM = (half * look.zoom) / range;
  const [cx, cy] = [width / 2, look.headUp ? height * 0.6 : height / 2];
  const at = (n, e) => {
    const [dn, de] = [n - place.n, e - place.e];
    return [cx + (de * Math.cos(turn) - dn * Math.sin(turn)) * perM, cy - (dn * Math.cos(turn) + de * Math.sin(turn)) * perM];
  };
  grid(place, at, perM, width, height);
  set(parts.trail, { d: line([...trail, [place.n, place.e]].map(([n, e]) => at(n, e))) });
  ship(frame.ship, place, at, perM, turn);
  ahead(frame, at, perM, turn);
  set(parts.north, { transform: `translate(${width - 40} 54) rotate(${-turn / RAD})` });
  set(parts.north.lastChild, { transform: `rotate(${turn / RAD} 0 -30)` });
  say(parts.title, told(frame));
}

// The range that holds what is ahead: one of a ladder, and not a smaller one before it fits well.
function fitted(frame, place) {
  const far = (frame.ahead?.shown ?? []).map((p) => Math.hypot(p.n - place.n, p.e - place.e) + (p.tube?.drawn ? Math.max(p.tube.along, p.tube.across) : 2 * Math.max(p.sn ?? 0, p.se ?? 0)));
  const wanted = Math.max(...far, 1.6 * (frame.ship.length_m || 20), 10) * 1.12;
  const step = (m) => {
    const ten = 10 ** Math.floor(Math.log10(m));
    return [1, 1.5, 2, 3, 5, 7, 10].map((k) => k * ten).find((r) => r >= m);
  };
  return range >= wanted && range <= 1.7 * wanted ? range : step(wanted);
}

function grid(place, at, perM, width, height) {
  const spans = [1, 2, 5].flatMap((k) => [0.1, 1, 10, 100, 1000, 10000].map((ten) => k * ten)).sort((a, b) => a - b);
  const space = spans.find((m) => m * perM >= 70) ?? spans.at(-1);
  const reach = Math.hypot(width, height) / perM;
  const rows = [];
  const from = (x) => Math.ceil((x - reach) / space) * space;
  for (let n = from(place.n); n <= place.n + reach; n += space) rows.push([at(n, place.e - reach), at(n, place.e + reach)]);
  for (let e = from(place.e); e <= place.e + reach; e += space) rows.push([at(place.n - reach, e), at(place.n + reach, e)]);
  set(parts.grid, { d: rows.map(line).join("") });
  set(parts.ruler, { d: `M16 ${height - 22}v8h${(space * perM).toFixed(1)}v-8` });
  set(parts.rulerText, { x: 16 + (space * perM) / 2, y: height - 24 });
  say(parts.rulerText, space >= 1000 ? `${space / 1000} km` : `${space} m`);
}

function hull(about, perM) {
  const [L, B] = [about.length_m * perM, about.beam_m * perM];
  if (L < SMALLEST) return "M0 -9A9 9 0 1 1 0 9A9 9 0 1 1 0 -9M0 -4A4 4 0 1 1 0 4A4 4 0 1 1 0 -4";
  return `${line(HULL.map(([x, y]) => [y * B, -x * L]))}Z`;
}

function ship(about, place, at, perM, turn) {
  const [x, y] = at(place.n, place.e);
  const where = `translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${(place.psi - turn / RAD).toFixed(2)})`;
  set(parts.hull, { d: hull(about, perM), transform: where });
  const bow = Math.max((about.length_m * perM) / 2, 9);
  set(parts.lead, { d: `M0 ${-bow}v-46`, transform: where });
  const size = about.length_m ? `${fixed(about.length_m, about.length_m < 20 ? 1 : 0)} m long, ${fixed(about.beam_m, about.length_m < 20 ? 1 : 0)} m wide` : "size not known: a symbol stands for the ship (--ship gives it)";
  say(by("scale"), about.length_m * perM < SMALLEST && about.length_m ? `${size}; too small to draw here: a symbol stands for the ship` : size);
}

function ahead(frame, at, perM, turn) {
  const shown = frame.ahead && !frame.ahead.old ? frame.ahead : { way: [], shown: [] };
  const way = shown.way.map(([n, e]) => at(n, e));
  set(parts.way, { d: line(way) });
  const known = shown.way.findIndex((p) => p[2] === null); // the tube ends where no width is known any more
  const wide = known < 0 ? shown.way : shown.way.slice(0, known);
  set(parts.tube, { d: tube(way.slice(0, wide.length), wide.map((p) => p[2] * perM)) });
  while (parts.later.childNodes.length > shown.shown.length) parts.later.lastChild.remove();
  while (parts.later.childNodes.length < shown.shown.length) {
    parts.later.append(drawn("g", {}, drawn("ellipse", { class: "spread" }), drawn("path", { class: "later" }), drawn("text", { class: "ahead" })));
  }
  shown.shown.forEach((p, i) => {
    const [spread, outline, label] = parts.later.childNodes[i].childNodes;
    const [x, y] = at(p.n, p.e);
    const here = `translate(${x.toFixed(1)} ${y.toFixed(1)})`;
    const tube = p.tube?.drawn ? p.tube : null; // an ellipse along the course where one is promised, else one sigma north and east
    const [rx, ry, by] = tube ? [tube.across, tube.along, tube.course] : [p.se ?? 0, p.sn ?? 0, 0];
    set(spread, { rx: (rx * perM).toFixed(1), ry: (ry * perM).toFixed(1), transform: `${here} rotate(${(by - turn / RAD).toFixed(2)})` });
    set(outline, { d: hull(frame.ship, perM), transform: `${here} rotate(${(p.psi - turn / RAD).toFixed(2)})` });
    // beside the hull, on the side that lies to the right, or below where neither does
    const abeam = p.psi * RAD - turn;
    const side = Math.cos(abeam) < -0.05 ? -1 : 1;
    const aside = 12 + Math.max(Math.max(rx, ry) * perM, (frame.ship.beam_m * perM) / 2, 9);
    const [dx, dy] = [side * Math.cos(abeam) * aside, side * Math.sin(abeam) * aside];
    set(label, { x: (x + dx).toFixed(1), y: (y + dy + 5).toFixed(1), "text-anchor": dx > 0.4 * aside ? "start" : "middle" });
    say(label, p.tube && !tube ? `${p.horizon.toFixed(0)} s, ${p.tube.level ? `${p.tube.level} % only` : "no promise"}` : `${p.horizon.toFixed(0)} s`);
  });
}

// The way with its half widths as one closed outline.
function tube(points, widths) {
  if (points.length < 2) return "";
  const [left, right] = [[], []];
  points.forEach(([x, y], i) => {
    const [a, b] = [points[Math.max(i - 1, 0)], points[Math.min(i + 1, points.length - 1)]];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const [ux, uy] = length > 1e-6 ? [(b[0] - a[0]) / length, (b[1] - a[1]) / length] : [0, -1];
    left.push([x + uy * widths[i], y - ux * widths[i]]);
    right.unshift([x - uy * widths[i], y + ux * widths[i]]);
  });
  return `${line([...left, ...right])}Z`;
}

const line = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

function stamped(frame, old, width, height) {
  set(parts.veil, { visibility: old ? "visible" : "hidden" });
  set(parts.stamp, { x: width / 2, y: height * 0.16 });
  say(parts.stamp, old ? (frame.feed.heard ? "OLD" : "NOTHING YET") : "");
}

function told(frame) {
  const { place, ahead: next } = frame;
  const later = (next?.shown ?? []).map((p) => `in ${p.horizon.toFixed(0)} s ${p.distance.toFixed(0)} m towards ${bearing(p.bearing)}, heading ${bearing(p.psi)}`);
  return `Ship from above, ${look.headUp ? "head" : "north"} up. Heading ${bearing(place.psi)}; ${later.join("; ") || "no prediction"}.`;
}
