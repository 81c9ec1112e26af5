// The server's answers, and the address: #/part/item?key=value.

export const state = { project: null, jobs: [], kept: {} };

export async function ask(path, said) {
  const options = said === undefined ? {} : { method: "POST", headers: { "Content-Type": "application/json" }, body: said instanceof Blob ? said : JSON.stringify(said) };
  let answer;
  try { answer = await fetch(path, options); } catch { throw new Error("twin studio does not answer. Is it still running?"); }
  if (answer.ok) return answer.json();
  const text = await answer.text();
  let words = text;
  try { words = JSON.parse(text).said; } catch { /* plain text */ }
  throw new Error(words);
}

export async function reload() {
  state.project = await ask("/api/project");
  state.jobs = state.project.jobs;
}

const cache = new Map(), last = { job: "", all: null }; // the samples seen last

/** A JSON file of a job that is over: it never changes. */
export async function found(job, file = "result.json") {
  const key = `${job}/${file}`;
  if (!cache.has(key)) cache.set(key, ask(`/api/jobs/${key}`).catch((error) => { cache.delete(key); throw error; }));
  return cache.get(key);
}

/** The samples of a file that was looked at: {time_s, channel: Float32Array}. */
export async function samples(job, looked) {
  if (last.job === job) return last.all;
  const all = new Float32Array(await (await fetch(`/api/jobs/${job}/series.f32`)).arrayBuffer());
  const row = (i) => all.subarray(i * looked.samples, (i + 1) * looked.samples), out = { time_s: row(0) };
  looked.columns.forEach((c, i) => { out[c.name] = row(i + 1); });
  Object.assign(last, { job, all: out });
  return out;
}

/** base64 of float32 -> numbers */
export function unpack(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

export function route() {
  const [path, query] = location.hash.replace(/^#\/?/, "").split("?"), [part, ...item] = path.split("/").map(decodeURIComponent);
  return { part: part || "data", item: item.join("/"), query: new URLSearchParams(query || "") };
}

export function address(part, item, query) {
  const asked = new URLSearchParams(Object.entries(query || {}).filter(([, v]) => v !== undefined && v !== null && v !== "")).toString();
  return `#/${part}${item ? `/${encodeURIComponent(item).replaceAll("%2B", "+")}` : ""}${asked ? `?${asked}` : ""}`;
}

/** The same page with another choice in its address; `quiet`: it is not drawn anew. */
export function change(keys, quiet) {
  const r = route(), query = { ...Object.fromEntries(r.query), ...keys };
  const to = address(r.part, r.item, query);
  if (quiet) history.replaceState(null, "", to);
  else location.hash = to;
}

export const files = (...kinds) => state.project.files.filter((f) => kinds.includes(f.kind));
export const newest = (verb, test = () => true) => state.jobs.filter((j) => j.verb === verb && test(j)).at(-1);
export const over = (job) => !["waiting", "running"].includes(job.state);

/** Asks for a job and goes to its page. */
export async function start(asked, part = asked.verb) {
  const { job } = await ask("/api/jobs", asked);
  await reload();
  location.hash = address(part, job);
  return job;
}
