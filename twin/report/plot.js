// Plots over time: one zoom for all of them; a pixel column shows the least and the greatest of its samples.
const view = { voyage: 0, from: 0, to: 1, panels: [], watchers: [], frame: 0 };

function setZoom(from, to) {
  const v = DATA.voyages[view.voyage], least = 2;
  if (to - from < least) { const mid = (from + to) / 2; from = mid - least / 2; to = mid + least / 2; }
  view.from = Math.max(v.start_s, from);
  view.to = Math.min(v.end_s, to);
  const all = view.from <= v.start_s && view.to >= v.end_s, theme = (location.hash.match(/theme=(dark|light)/) || [""])[0];
  const said = [theme, all ? "" : `t=${view.from.toFixed(1)},${view.to.toFixed(1)}`].filter(Boolean).join("&");
  if (location.hash.replace("#", "") !== said) try { history.replaceState(null, "", said ? `#${said}` : location.pathname); } catch { /* a page in a frame has no address of its own */ }
  redraw();
}

/** What is on the screen is drawn with the next frame, once however often it was asked for; the rest when it comes near. */
function redraw() {
  if (!view.frame) view.frame = requestAnimationFrame(() => {
    view.frame = 0;
    for (const panel of view.panels) if (panel.near === false) panel.stale = true; else panel.draw();
    for (const watcher of view.watchers) watcher();
  });
}

/** Everything, now: for paper. */
function drawAll() {
  for (const panel of view.panels) { panel.draw(); panel.stale = false; }
  for (const watcher of view.watchers) watcher();
}

const nearby = new IntersectionObserver((seen) => {
  for (const one of seen) {
    const panel = view.panels.find((p) => p.box === one.target);
    if (!panel) { nearby.unobserve(one.target); continue; }
    panel.near = one.isIntersecting;
    if (panel.near && panel.stale) { panel.draw(); panel.stale = false; }
  }
}, { rootMargin: "150px" });

/** First index with t[i] >= x. */
function lower(t, x) {
  let a = 0, b = t.length;
  while (a < b) { const m = (a + b) >> 1; if (t[m] < x) a = m + 1; else b = m; }
  return a;
}

/** A canvas of this height that knows its size in pixels. */
function sheet(height, label) {
  const canvas = el("canvas", { role: "img", "aria-label": label, style: { height: `${height}px` } });
  const start = () => {
    const ratio = document.documentElement.classList.contains("paper") ? 2 : window.devicePixelRatio || 1, width = canvas.clientWidth;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    return [pen, width, height];
  };
  return [canvas, start];
}

/** Least and greatest value within [from, to]. */
function extent(list, from, to) {
  let low = Infinity, high = -Infinity;
  for (const { t, y } of list) {
    const b = Math.min(lower(t, to) + 1, t.length);
    for (let i = Math.max(lower(t, from) - 1, 0); i < b; i++) { const v = y[i]; if (v < low) low = v; if (v > high) high = v; }
  }
  return [low, high];
}

const waits = new WeakMap(); // times of samples -> the usual wait between them, once

/** Seconds without a sample from which a line is torn: three of the usual waits, and no less than this. */
function gapOf(t, least = 15) {
  if (!waits.has(t)) waits.set(t, t.length > 1 ? t.slice(1).map((x, i) => x - t[i]).sort()[(t.length - 1) >> 1] : 0);
  return Math.max(least, 3 * waits.get(t));
}

/** A line through the samples in view, and a dot where one is alone; thick data is drawn as the span of each pixel column. */
function line(pen, { t, y }, X, Y, from, to, gap, breaks) {
  const a = Math.max(lower(t, from) - 1, 0), b = Math.min(lower(t, to) + 1, t.length);
  pen.beginPath();
  let up = true, count = 0, last = -Infinity, value = 0, column = null, low = 0, high = 0, first = 0, end = 0, cut = breaks ? lower(breaks, t[a] || 0) : 0;
  const dense = b - a > 3 * pen.canvas.clientWidth;
  const flush = () => {
    if (column === null) return;
    up ? pen.moveTo(column, Y(first)) : pen.lineTo(column, Y(first));
    pen.lineTo(column, Y(low)); pen.lineTo(column, Y(high)); pen.lineTo(column, Y(end));
    up = false; column = null;
  };
  const tear = () => {
    flush();
    if (count === 1) { const px = X(last), py = Y(value); pen.moveTo(px - 1.5, py); pen.lineTo(px + 1.5, py); }
    up = true; count = 0;
  };
  for (let i = a; i < b; i++) {
    const v = y[i], x = t[i];
    if (v !== v) { tear(); continue; }
    let torn = x - last > gap;
    if (breaks) while (cut < breaks.length && breaks[cut] < x - 1e-3) { torn = true; cut++; }
    if (torn) tear();
    last = x; value = v; count++;
    const px = X(x);
    if (!dense) { up ? pen.moveTo(px, Y(v)) : pen.lineTo(px, Y(v)); up = false; continue; }
    const c = Math.round(px);
    if (c !== column) { flush(); column = c; low = high = first = end = v; } else { if (v < low) low = v; if (v > high) high = v; end = v; }
  }
  tear();
  pen.stroke();
}

/** A band between two lines; what changes within a pixel is thinned. */
function ribbon(pen, { t, low, high }, X, Y, from, to) {
  const a = Math.max(lower(t, from) - 1, 0), b = Math.min(lower(t, to) + 1, t.length), every = Math.max(1, Math.floor((b - a) / (2 * pen.canvas.clientWidth)));
  pen.beginPath();
  for (let i = a; i < b; i += every) pen.lineTo(X(t[i]), Y(high[i]));
  for (let i = a + every * Math.floor((b - 1 - a) / every); i >= a; i -= every) pen.lineTo(X(t[i]), Y(low[i]));
  pen.fillStyle = colour("noise"); pen.globalAlpha = 0.2;
  pen.fill(); pen.globalAlpha = 1;
}

/** Round steps for an axis. */
function steps(low, high, count) {
  const raw = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(raw));
  let step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw);
  while (Math.floor(high / step + 1e-9) - Math.ceil(low / step - 1e-9) < 1) step /= 2;
  const out = [];
  for (let v = Math.ceil(low / step) * step; v <= high + 1e-9 * step; v += step) out.push(Math.abs(v) < step * 1e-6 ? 0 : v);
  return out;
}

function timeSteps(from, to, width) {
  const wish = ((to - from) / Math.max(width, 1)) * 95;
  const step = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400].find((s) => s >= wish) || 28800;
  const out = [];
  for (let t = Math.ceil(from / step) * step; t <= to; t += step) out.push(t);
  return out;
}

const LEFT = 46; // room for numbers

/** One plot: series [{data, colour, width, breaks}], an optional band about zero. */
function plot(height, series, options = {}) {
  const [canvas, start] = sheet(height, options.label), cursor = el(".cursor"), picked = el(".picked");
  const box = el(".draw", null, canvas, cursor, picked);
  const seconds = (px) => view.from + ((px - LEFT) / Math.max(canvas.clientWidth - LEFT, 1)) * (view.to - view.from);
  const panel = { box, cursor, picked, seconds, draw() { paint(start, series, options); } };
  steer(box, canvas, picked, seconds);
  view.panels.push(panel);
  nearby.observe(box);
  return box;
}

function paint(start, series, options) {
  const [pen, width, height] = start(), { from, to } = view, inner = height - 8;
  const tube = options.tube, edges = tube ? [{ t: tube.t, y: tube.low }, { t: tube.t, y: tube.high }] : [];
  let [low, high] = extent([...series.map((s) => s.data), ...edges], from, to);
  if (!(low <= high)) [low, high] = [-1, 1];
  if (options.band) { const most = Math.max(-low, high, 2.5 * options.band); [low, high] = [-most, most]; }
  const pad = 0.06 * (high - low) || Math.max(Math.abs(high) * 0.02, options.least || 0.01);
  low -= pad; high += pad;
  const X = (t) => LEFT + ((t - from) / (to - from)) * (width - LEFT), Y = (v) => 4 + inner * (1 - (v - low) / (high - low));
  pen.font = "11px system-ui, sans-serif";
  grid(pen, X, Y, width, height, low, high, options);
  if (options.band) {
    pen.fillStyle = colour("noise"); pen.globalAlpha = 0.16;
    pen.fillRect(LEFT, Y(options.band), width - LEFT, Y(-options.band) - Y(options.band)); pen.globalAlpha = 1;
  }
  pen.save(); pen.beginPath(); pen.rect(LEFT, 0, width - LEFT, height); pen.clip();
  if (tube) ribbon(pen, tube, X, Y, from, to);
  for (const s of series) {
    pen.strokeStyle = colour(s.colour); pen.lineWidth = s.width || 1.2; pen.globalAlpha = s.alpha || 1; pen.lineJoin = "round";
    line(pen, s.data, X, Y, from, to, gapOf(s.data.t, s.gap), s.breaks);
  }
  pen.restore();
}

function grid(pen, X, Y, width, height, low, high, options) {
  pen.strokeStyle = colour("faint"); pen.fillStyle = colour("weak"); pen.lineWidth = 1; pen.textAlign = "right"; pen.textBaseline = "middle";
  const marks = steps(low, high, Math.max(2, Math.floor(height / 24))), told = onAxis(marks);
  marks.forEach((v, i) => {
    const y = Math.round(Y(v)) + 0.5;
    pen.beginPath(); pen.moveTo(LEFT, y); pen.lineTo(width, y); pen.stroke();
    if (y > 4 && y < height - 3) pen.fillText(told[i], LEFT - 6, y);
  });
  for (const t of timeSteps(view.from, view.to, width)) { const x = Math.round(X(t)) + 0.5; pen.beginPath(); pen.moveTo(x, 0); pen.lineTo(x, height); pen.stroke(); }
}

/** The axis of times, above all plots. */
function timeAxis() {
  const [canvas, start] = sheet(20, "");
  const panel = { cursor: null, draw() {
    const [pen, width] = start();
    pen.font = "11.5px system-ui, sans-serif"; pen.fillStyle = colour("soft"); pen.textBaseline = "middle"; pen.textAlign = "center";
    for (const t of timeSteps(view.from, view.to, width)) {
      const x = LEFT + ((t - view.from) / (view.to - view.from)) * (width - LEFT);
      if (x > LEFT + 14 && x < width - 18) pen.fillText(clock(t), x, 10);
    }
  } };
  view.panels.push(panel);
  canvas.removeAttribute("role");
  const strip = el(".strip", null, canvas);
  axisKeys(strip);
  return strip;
}

/** Drag to choose a stretch, click to go three times nearer, double-click to see all; the cursor shows on every plot. */
function steer(box, canvas, picked, seconds) {
  let down = null, timer = 0;
  const at = (e) => Math.min(Math.max(e.clientX - canvas.getBoundingClientRect().left, LEFT), canvas.clientWidth);
  box.onpointerdown = (e) => { down = at(e); };
  box.onpointermove = (e) => {
    const x = at(e);
    point(seconds(x));
    if (down !== null && Math.abs(x - down) > 4) Object.assign(picked.style, { display: "block", left: `${Math.min(x, down)}px`, width: `${Math.abs(x - down)}px` });
  };
  box.onpointerup = (e) => {
    const x = at(e), begin = down;
    down = null;
    picked.style.display = "none";
    if (begin === null) return;
    if (Math.abs(x - begin) > 4) return setZoom(seconds(Math.min(x, begin)), seconds(Math.max(x, begin)));
    clearTimeout(timer);
    const t = seconds(x), span = (view.to - view.from) / 6;
    timer = setTimeout(() => setZoom(t - span, t + span), 220);
  };
  box.onpointerleave = () => { down = null; picked.style.display = "none"; point(null); };
  box.ondblclick = () => { clearTimeout(timer); whole(); };
}

function whole() {
  const v = DATA.voyages[view.voyage];
  setZoom(v.start_s, v.end_s);
}

/** Show the moment t on every plot. */
function point(t) {
  for (const panel of view.panels) {
    if (!panel.cursor) continue;
    const width = panel.cursor.parentNode.clientWidth, x = LEFT + ((t - view.from) / (view.to - view.from)) * (width - LEFT);
    Object.assign(panel.cursor.style, { display: t === null ? "none" : "block", left: `${x}px` });
    if (panel.say) panel.say(t);
  }
}

/** The nearest sample, unless it is farther away than a line reaches. */
function valueAt({ t, y }, at, least) {
  const i = Math.min(lower(t, at), t.length - 1);
  const j = i > 0 && at - t[i - 1] < t[i] - at ? i - 1 : i;
  return Math.abs(t[j] - at) < gapOf(t, least) ? y[j] : NaN;
}
