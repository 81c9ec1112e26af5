// What several parts need: the voyages and the ship to choose, a job's state, what became of it.

import { address, ask, files, found, newest, over, state } from "/app/api.js";
import { again, doing } from "/app/main.js";
import { boxes, button, choose, clock, command, el, field } from "/app/dom.js";

export const TAGS = [["reference", "reference"], ["voyage", "voyage"], ["held_out", "held out"]];
export const voyages = (...tags) => files("voyage").filter((f) => !tags.length || tags.includes(f.tag));

/** A Set or value that lives as long as the page. */
export function kept(name, first) {
  if (!(name in state.kept)) state.kept[name] = first();
  return state.kept[name];
}

/** The ship to start from: the newest ship file, unless another was chosen. `changed`: what follows then. */
export function theShip(name, changed) {
  const ships = files("ship").sort((a, b) => a.changed_s - b.changed_s).map((f) => f.name), key = `${name}.ship`;
  if (!ships.includes(state.kept[key])) state.kept[key] = ships.at(-1) || "";
  return { name: state.kept[key], select: field("ship file", choose(`${name}-ship`, ships.map((s) => [s, s]), state.kept[key], (v) => { state.kept[key] = v; changed?.(); })) };
}

export function pickVoyages(legend, name, tags) {
  const set = kept(name, () => new Set(voyages(...tags).map((f) => f.name))), there = new Set(voyages().map((f) => f.name));
  for (const v of set) if (!there.has(v)) set.delete(v);
  return { set, box: boxes(legend, name.replace(".", "-"), voyages().map((f) => [f.name, `${f.name} (${f.tag.replace("_", " ")})`]), set) };
}

/** What has to be there before a verb can be asked, and where it is made; null when all is there. */
export function lacks() {
  const steps = [];
  if (!files("ship").length) steps.push(el("li", null, "A ship file: ", el("a", { href: address("ship", "new") }, "make a first model of the ship"), " from its main particulars, or drop one under ", el("a", { href: address("data") }, "Data"), "."));
  if (!files("voyage").length) steps.push(el("li", null, "A voyage: drop a log or a table under ", el("a", { href: address("data") }, "Data"), ", see what is doubted, and press Import."));
  return steps.length ? el("section.card", { "aria-label": "First" }, el("h2", null, "First"), el("ol", null, steps)) : null;
}

/** "alma.toml" -> "alma-2.toml", or the next that is free. */
export function nextName(base, end = "") {
  const stem = base.replace(/\.toml$/, "").replace(/-\d+$/, "") + end, there = new Set(state.project.files.map((f) => f.name));
  let name = `${stem}.toml`;
  for (let k = 2; there.has(name); k++) name = `${stem}-${k}.toml`;
  return name;
}

export function go(text, action, disabled) { return el("button.main", { type: "submit", disabled: disabled || state.project.read_only, onclick: doing(action) }, text); }

/** Earlier answers of a verb, to be opened again. */
export function earlier(verb, part, chosen) {
  const jobs = state.jobs.filter((j) => j.verb === verb).reverse();
  if (!jobs.length) return null;
  return el("details", { open: jobs.length < 6 }, el("summary", null, `${jobs.length} done here`), el(".scroll", { tabindex: 0, role: "group", "aria-label": `Earlier ${verb}` }, el("table", null, el("tbody", null, jobs.map((j) => el("tr", null,
    el("th", { scope: "row" }, el("a", { href: address(part, j.name), "aria-current": j.name === chosen ? "true" : undefined }, j.name)), el("td", null, `${words(j.asked)}`), el("td", null, stateWord(j)), el("td.n", null, j.took_s === null ? "" : clock(j.took_s)),
    el("td", null, over(j) && !state.project.read_only ? button("Forget", doing(async () => { await ask(`/api/jobs/${j.name}/forget`, {}); await again(); }), { class: "small", "aria-label": `Forget ${j.name}` }) : null)))))));
}

export const words = (a) => [a.effects?.join(" and "), (a.voyages || [a.file]).join(", "), a.ship && `with ${a.ship}`, a.output && `→ ${a.output}`].filter(Boolean).join(" ");
const STATES = { done: ["good", "done"], refused: ["fair", "not proved"], failed: ["bad", "failed"], cancelled: ["fair", "cancelled"], died: ["bad", "its worker died"], running: ["", "at work"], waiting: ["", "waits"] };
export const stateWord = (j) => el(`span.badge.${STATES[j.state]?.[0] || "note"}`, null, STATES[j.state]?.[1] || j.state);

/** What became of a job: its answer, or why there is none and how to go on. */
export async function answerOf(name) {
  const job = state.jobs.find((j) => j.name === name);
  if (!job) throw new Error(`${name}: there is no such job in this project (any more).`);
  if (over(job) && job.has.includes("result.json") && ["done", "refused"].includes(job.state)) return { job, result: await found(name), view: job.has.includes("view.json") ? await found(name, "view.json") : null };
  const retry = over(job) && !state.project.read_only ? button("Do it again", doing(async () => { const { job: next } = await ask("/api/jobs", job.asked); await again(); location.hash = location.hash.replace(name, next); }), { class: "main", id: "retry" }) : null;
  const why = { died: "The process that worked on this is gone (killed, or the computer went down). Nothing else of the project is touched.", cancelled: "This was cancelled before it wrote anything into the project: its files are as they were.", failed: job.said }[job.state];
  const list = el("ol", { "aria-label": "Steps so far", "data-steps": job.name }, steps(job));
  return { job, waiting: el("section.card", { "aria-label": "State" }, el(".head", null, el("h2", null, `${job.verb}: ${words(job.asked)}`), stateWord(job)), why ? el("p.big", null, why) : null, list, command(job.command), el(".tools", null, retry)) };
}

/** What a job has told of its progress; the list goes on while it is at work (main.js). */
export const steps = (job) => job.progress.map((p) => el("li", null, `${p.text} `, el("span.note", null, `${clock(p.s)}`)));

/** The foot of an answer: command, and the files that hold it. */
export function foot(job) {
  return el("section.card", { "aria-label": "Command and files" }, el("h2", null, "The same on the command line"), command(`${job.command} --json ${job.verb}.json`),
    el(".tools", null, el("a.button", { href: `/api/jobs/${job.name}/result.json`, download: `${job.name}.json` }, "Save as JSON"), job.has.includes("report.html") ? el("a.button", { href: `/api/jobs/${job.name}/report.html`, download: `${job.name}.html` }, "Save as one page") : null, button("Print", () => window.print())));
}

export { newest };
