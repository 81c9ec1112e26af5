// Takes the frames of the twin's viewer, ten a second, and draws each once; what is old never looks live.

import { by } from "/dom.js";
import { draw, takeTrail } from "/chart.js";
import { look, wire } from "/look.js";
import { alarms, header, panels, silence } from "/panels.js";

const SILENT_MS = 1000;
let frame = null;
let came = performance.now(); // when the last frame came
let waiting = false;

function why() {
  const gone = performance.now() - came;
  if (gone > SILENT_MS) return `twin view HAS NOT ANSWERED FOR ${(gone / 1000).toFixed(0)} s: what stands here is old`;
  if (!frame) return "";
  const { silent, silent_s, heard, over, name } = frame.feed;
  if (!silent) return "";
  if (over) return `THE LOG IS OVER: what stands here is ${silent_s.toFixed(0)} s old`;
  if (!heard) return `NOTHING HEARD YET on ${name} (${silent_s.toFixed(0)} s)`;
  return `NOTHING HEARD FOR ${silent_s.toFixed(0)} s: what stands here is old`;
}

function paint() {
  waiting = false;
  const text = why();
  document.documentElement.classList.toggle("old", Boolean(text));
  silence(text);
  if (!frame) return;
  header(frame, Boolean(text));
  draw(frame, Boolean(text));
  alarms(frame.alarms, acknowledge);
  if (frame.feed.heard) panels(frame);
}

function soon() {
  if (!waiting) requestAnimationFrame(paint);
  waiting = true;
}

async function acknowledge(key) {
  const options = { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ key }) };
  try { await fetch("/acknowledge", options); } catch { /* the next frame shows whether it was taken */ }
}

wire(soon);
by("all").addEventListener("click", () => acknowledge(""));
window.addEventListener("resize", soon);
setInterval(() => { if (performance.now() - came > SILENT_MS) soon(); }, 250);

const events = new EventSource("/events");
events.onmessage = (event) => {
  frame = JSON.parse(event.data);
  came = performance.now();
  soon();
};
events.addEventListener("trail", (event) => takeTrail(JSON.parse(event.data)));
window.twinView = { look, frame: () => frame };
