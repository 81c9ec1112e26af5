// The frame of the page: parts, colours, work in progress, and which part is drawn.

import { address, ask, change, over, reload, route, state } from "/app/api.js";
import { button, clock, el } from "/app/dom.js";
import { repaint } from "/app/plot.js";
import { add } from "/app/add.js";
import { calibrate } from "/app/calibrate.js";
import { compare } from "/app/compare.js";
import { data } from "/app/data.js";
import { diagnose } from "/app/diagnose.js";
import { live } from "/app/live.js";
import { steps } from "/app/shared.js";
import { ship } from "/app/ship.js";

const PARTS = { data: ["Data", data], ship: ["Ship", ship], calibrate: ["Calibrate", calibrate], compare: ["Compare", compare], diagnose: ["Diagnose", diagnose], add: ["Add", add], live: ["Live", live] };
const by = (id) => document.getElementById(id);
let drawing = 0, last = "";

export function say(text) {
  by("said").textContent = text || "";
  by("said").hidden = !text;
}

/** Draws the part that the address names; what had the focus keeps it. */
async function draw() {
  const mine = ++drawing, r = route(), [title, part] = PARTS[r.part] || PARTS.data, held = document.activeElement?.id;
  document.title = `${title} · twin studio`;
  by("parts").replaceChildren(...Object.entries(PARTS).map(([name, [text]]) => el("a", { href: address(name), "aria-current": name === r.part ? "page" : undefined }, text)));
  by("folder").textContent = `${state.project.folder.split(/[\\/]/).pop()}${state.project.read_only ? " (read only)" : ""}`;
  by("folder").title = state.project.folder;
  let shown;
  try { shown = await part(r); } catch (error) { say(error.message); shown = [el("h1", null, title), el("p", null, error.message)]; }
  if (mine !== drawing) return;
  const heading = shown.flat(Infinity).find((n) => n?.tagName === "H1");
  heading?.setAttribute("tabindex", "-1");
  const at = scrollY, same = last === `${r.part}/${r.item}`;
  by("view").replaceChildren(...shown.flat(Infinity).filter(Boolean));
  if (held && by(held)) by(held).focus({ preventScroll: true });
  else if (!same && last) heading?.focus({ preventScroll: true });
  window.scrollTo(0, same ? at : 0);
  last = `${r.part}/${r.item}`;
  window.twinStudio.drawn += 1;
}

/** A person did something: the old message goes, what went wrong is said. */
export const doing = (action) => async (event) => {
  event?.preventDefault?.();
  say("");
  try { await action(event); } catch (error) { say(error.message); }
};

export async function again() {
  await reload();
  work();
  await draw();
}

/** The strip of what is at work: steps, time gone, time that is left, cancel. */
function work() {
  const at = state.jobs.filter((j) => !over(j)), strip = by("work");
  strip.hidden = !at.length;
  for (const j of at) document.querySelector(`[data-steps="${j.name}"]`)?.replaceChildren(...steps(j));
  strip.replaceChildren(...at.map((j) => {
    const gone = j.took_s ?? 0, left = j.usual_s ? Math.max(j.usual_s - gone, 0) : null;
    const time = j.state === "waiting" ? "waits for its turn" : `${clock(gone)} so far${left === null ? "" : left > 0 ? `, about ${clock(left)} left` : ", longer than usual"}`;
    const bar = el("progress", { max: 1, "aria-label": `${j.verb}: how far` });
    if (j.usual_s) bar.value = Math.min(gone / j.usual_s, 0.98);
    return el(".job", { "data-job": j.name }, bar, el("span.text", null, el("b", null, `${j.verb === "look" ? "reading" : j.verb}: `), `${j.progress.at(-1)?.text || "starting"} · ${time}`), state.project.read_only ? null : button("Cancel", doing(async () => { await ask(`/api/jobs/${j.name}/cancel`, {}); await again(); }), { class: "small", "aria-label": `Cancel ${j.verb}` }));
  }));
}

async function watch() {
  for (;;) {
    await new Promise((done) => setTimeout(done, state.jobs.some((j) => !over(j)) ? 400 : 3000));
    try {
      const before = new Map(state.jobs.map((j) => [j.name, j.state])), jobs = await ask("/api/jobs");
      const changed = jobs.length !== state.jobs.length || jobs.some((j) => before.get(j.name) !== j.state);
      state.jobs = jobs;
      if (changed && route().part === "live") { await reload(); work(); } // the bridge's picture goes on
      else if (changed) await again();
      else work();
      if (by("said").dataset.gone) { delete by("said").dataset.gone; say(""); }
    } catch (error) { by("said").dataset.gone = "1"; say(error.message); }
  }
}

function theme(name) {
  const known = ["light", "dark", "night"].includes(name) ? name : "light";
  document.documentElement.dataset.theme = known;
  for (const b of document.querySelectorAll("[data-theme-name]")) b.setAttribute("aria-pressed", b.dataset.themeName === known);
  try { localStorage.setItem("theme", known); } catch { /* a browser that keeps nothing */ }
  repaint();
}

for (const b of document.querySelectorAll("[data-theme-name]")) b.addEventListener("click", () => theme(b.dataset.themeName));
let keptTheme = null;
try { keptTheme = localStorage.getItem("theme"); } catch { /* a browser that keeps nothing */ }
theme(keptTheme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
window.addEventListener("hashchange", doing(again)); // files may have come from elsewhere meanwhile
window.twinStudio = { state, drawn: 0, change };

try {
  await again();
  watch();
} catch (error) { say(error.message); }
