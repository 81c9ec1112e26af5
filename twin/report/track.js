// The track over ground and the heat strip.
function trackPlot(v, lines) {
  const height = 380, [canvas, start] = sheet(height, `Track of ${v.name} over ground, measured and modelled`), t = v.track;
  const paths = [{ x: t.x, y: t.y, name: "measured" }, ...lines.map((l) => ({ ...t.lines[l.key], name: l.colour }))];
  const draw = () => {
    const [pen, width] = start();
    let box = [Infinity, -Infinity, Infinity, -Infinity];
    const zoomed = view.to - view.from < 0.98 * (v.end_s - v.start_s), a = lower(t.t, view.from), b = lower(t.t, view.to);
    for (const p of paths) for (let i = zoomed ? a : 0; i < (zoomed ? b : t.t.length); i++) {
      if (p.x[i] !== p.x[i]) continue;
      box = [Math.min(box[0], p.x[i]), Math.max(box[1], p.x[i]), Math.min(box[2], p.y[i]), Math.max(box[3], p.y[i])];
    }
    const room = 26, k = Math.min((width - 2 * room) / (box[3] - box[2] || 1), (height - 2 * room) / (box[1] - box[0] || 1));
    const X = (e) => width / 2 + (e - (box[2] + box[3]) / 2) * k, Y = (n) => height / 2 - (n - (box[0] + box[1]) / 2) * k;
    for (const p of paths) {
      pen.strokeStyle = colour(p.name); pen.lineWidth = p.name === "measured" ? 2.2 : 1.5; pen.lineJoin = "round";
      stroke(pen, p, t.t, X, Y, 0, t.t.length, zoomed ? 0.25 : 1, v.restarts, p.name !== "measured");
      if (zoomed) stroke(pen, p, t.t, X, Y, a, b, 1, v.restarts, p.name !== "measured");
    }
    scaleBar(pen, width, height, k);
  };
  view.watchers.push(draw);
  return canvas;
}

function stroke(pen, p, t, X, Y, a, b, alpha, restarts, torn) {
  pen.globalAlpha = alpha;
  pen.beginPath();
  let up = true, cut = 0;
  for (let i = a; i < b; i++) {
    if (p.x[i] !== p.x[i]) { up = true; continue; }
    while (torn && cut < restarts.length && restarts[cut] < t[i] - 1e-3) { up = true; cut++; }
    up ? pen.moveTo(X(p.y[i]), Y(p.x[i])) : pen.lineTo(X(p.y[i]), Y(p.x[i]));
    up = false;
  }
  pen.stroke();
  pen.globalAlpha = 1;
}

function scaleBar(pen, width, height, k) {
  const length = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000].filter((m) => m * k < width / 4).pop() || 1;
  pen.strokeStyle = pen.fillStyle = colour("soft"); pen.lineWidth = 1.5; pen.font = "11.5px system-ui, sans-serif"; pen.textAlign = "left";
  pen.beginPath(); pen.moveTo(8, height - 8); pen.lineTo(8 + length * k, height - 8); pen.stroke();
  pen.fillText(length >= 1000 ? `${length / 1000} km` : `${length} m`, 8, height - 14);
  pen.beginPath(); pen.moveTo(width - 14, 34); pen.lineTo(width - 14, 10); pen.lineTo(width - 18, 17); pen.moveTo(width - 14, 10); pen.lineTo(width - 10, 17); pen.stroke();
  pen.textAlign = "center"; pen.fillText("N", width - 14, 48);
}

const HEAT_TOP = 16; // times the noise at which the scale ends

function heatColour(x) {
  const at = Math.min(Math.max(Math.log2(Math.max(x, 1e-3)) / Math.log2(HEAT_TOP), 0), 1) * 3, i = Math.min(Math.floor(at), 2), f = at - i;
  const stops = [0, 1, 2, 3].map((k) => colour(`heat${k}`).split(",").map(Number));
  return stops[i].map((c, j) => Math.round(c + f * (stops[i + 1][j] - c)));
}

/** Channel by time: how many times its noise each channel is off. */
function heatStrip(v) {
  const row = 19, names = 210, [canvas, start] = sheet(row * v.heat.rows.length + 20, `Errors of ${v.name} over time, by channel, in units of its noise`);
  let moment = null; // that the keys have come to
  const draw = () => {
    const [pen, width] = start(), X = (t) => names + ((t - v.start_s) / (v.end_s - v.start_s)) * (width - names), t = v.heat.t;
    const shades = Array.from({ length: 61 }, (_, i) => `rgb(${heatColour(HEAT_TOP ** (i / 60)).join(",")})`);
    pen.font = "12.5px system-ui, sans-serif"; pen.textBaseline = "middle";
    v.heat.rows.forEach((r, k) => {
      pen.fillStyle = colour("soft"); pen.textAlign = "left"; pen.fillText(named(r.name)[0], 0, k * row + row / 2);
      for (let i = 0; i < t.length; i++) {
        if (r.y[i] !== r.y[i]) continue;
        const x = X(t[i]), end = i + 1 < t.length ? X(t[i + 1]) : i ? Math.min(X(t[i] + (t[1] - t[0])), width) : width;
        pen.fillStyle = shades[Math.round(Math.min(Math.max(Math.log(r.y[i]) / Math.log(HEAT_TOP), 0), 1) * 60)];
        pen.fillRect(x, k * row + 1, end - x + 0.6, row - 2);
      }
    });
    const bottom = row * v.heat.rows.length;
    pen.fillStyle = colour("weak"); pen.textAlign = "center"; pen.font = "11.5px system-ui, sans-serif";
    for (const s of timeSteps(v.start_s, v.end_s, width - names)) if (X(s) < width - 16) pen.fillText(clock(s), X(s), bottom + 11);
    pen.strokeStyle = colour("ink"); pen.lineWidth = 1.2;
    if (view.to - view.from < 0.98 * (v.end_s - v.start_s)) pen.strokeRect(X(view.from), 0.6, X(view.to) - X(view.from), bottom);
    if (moment !== null) { pen.beginPath(); pen.moveTo(X(moment), 0); pen.lineTo(X(moment), bottom); pen.stroke(); }
  };
  canvas.style.cursor = "pointer";
  const go = (s) => { setZoom(s - DATA.longest_s / 2, s + DATA.longest_s * 1.5); document.getElementById("plots").scrollIntoView({ behavior: "smooth" }); };
  canvas.onclick = (e) => {
    const box = canvas.getBoundingClientRect(), s = v.start_s + ((e.clientX - box.left - names) / (box.width - names)) * (v.end_s - v.start_s);
    if (s >= v.start_s) go(s);
  };
  const label = `${canvas.getAttribute("aria-label")}. Arrows move along the voyage, Enter shows that time in the plots`;
  stripOfTimes(canvas, label, { over: () => [v.start_s, v.end_s], moved: (t) => { moment = t; draw(); }, chosen: go });
  view.watchers.push(draw);
  return canvas;
}

function heatLegend() {
  const bar = el("canvas", { width: 120, height: 10, style: { width: "120px", height: "10px", display: "inline-block", verticalAlign: "middle", margin: "0 8px", borderRadius: "3px" } });
  view.watchers.push(() => {
    const pen = bar.getContext("2d");
    for (let i = 0; i < 120; i++) { pen.fillStyle = `rgb(${heatColour(HEAT_TOP ** (i / 119)).join(",")})`; pen.fillRect(i, 0, 1, 10); }
  });
  return el(".legend", null, el("span", null, "noise", bar, `${HEAT_TOP} times the noise`));
}
