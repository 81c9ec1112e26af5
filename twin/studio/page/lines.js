// Lines over time as uPlot wants them: one table of all times, and where a line is broken.

import { num } from "/app/number.js";

/* global uPlot */
const known = new WeakMap(); // samples -> what was worked out of them, once

/** Only the samples that are there: { t, y }. What an instrument reads seldom is a line through its readings. */
export function there(t, y) {
  const seen = (_, i) => y[i] === y[i];
  return y.every((v) => v === v) ? { t, y } : { t: t.filter(seen), y: y.filter(seen) };
}

/** The line without samples that are not there, as typed arrays: { t, y, holes: before which sample it is broken, words }. */
function whole(t, y) {
  if (known.has(y)) return known.get(y);
  let there = 0, low = Infinity, high = -Infinity;
  for (let i = 0; i < y.length; i++) { const v = y[i]; if (v === v) { there++; if (v < low) low = v; if (v > high) high = v; } }
  const out = { t, y, holes: [], words: low <= high ? `${num(low)} to ${num(high)}` : "nothing" };
  if (there < y.length) {
    out.t = new Float64Array(there);
    out.y = new Float32Array(there);
    for (let i = 0, k = 0, torn = false; i < y.length; i++) {
      if (y[i] !== y[i]) { torn = true; continue; }
      if (torn && k) out.holes.push(k);
      torn = false;
      out.t[k] = t[i]; out.y[k++] = y[i];
    }
  }
  known.set(y, out);
  return out;
}

export const spread = (l) => whole(l.t, l.y).words;

/** The breaks of a drawing, in pixels: between the samples around each hole. */
export function torn(holes) {
  return (u, k, from, to, others) => {
    const out = [...others], t = u.data[0];
    for (const i of holes) {
      if (i <= from || i > to) continue;
      const a = Math.round(u.valToPos(t[i - 1], "x", true)), b = Math.round(u.valToPos(t[i], "x", true));
      if (b > a) out.push([a, b]);
    }
    return out;
  };
}

/** One table of all times: [t, y of each line], and nothing where a line has no sample. A single line is not copied: `holes`. */
export function joined(lines) {
  const own = lines.map((l) => cut(l));
  if (own.length === 1) {
    const line = whole(own[0].t, own[0].y), data = [line.t, line.y];
    data.holes = line.holes;
    return data;
  }
  if (own.every((l) => l.t === own[0].t)) return [own[0].t, ...own.map((l) => (l.y.some?.((v) => v !== v) ? nulls(l.y) : l.y))];
  const part = own.map((l) => [l.t, nulls(l.y)]);
  return uPlot.join(part, part.map(() => [0, 2]));
}

/** NaN is shown as a gap. */
function nulls(y) {
  const out = new Array(y.length);
  for (let i = 0; i < y.length; i++) out[i] = y[i] === y[i] ? y[i] : null;
  return out;
}

/** A line that begins anew at some moments: a gap is put before each. */
function cut(l) {
  if (!l.gaps?.length) return l;
  const t = [], y = [];
  let k = 0;
  for (let i = 0; i < l.t.length; i++) {
    while (k < l.gaps.length && l.gaps[k] < l.t[i] - 1e-3) { if (t.length) { t.push(t.at(-1) + 1e-4 * (k + 1)); y.push(NaN); } k++; }
    if (t.length && l.t[i] <= t.at(-1)) continue;
    t.push(l.t[i]); y.push(l.y[i]);
  }
  return { ...l, t, y };
}
