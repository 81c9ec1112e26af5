// Elements and colours.
const DATA = JSON.parse(document.getElementById("data").textContent);
const RESULT = DATA.result;

/** An element: el("td.n", {onclick}, children...); text is always text, never markup. */
function el(what, props, ...children) {
  const [tag, ...classes] = what.split(".");
  const node = document.createElement(tag || "div");
  if (classes.length) node.className = classes.join(" ");
  for (const [key, value] of Object.entries(props || {})) {
    if (key === "style") Object.assign(node.style, value);
    else if (key.startsWith("on") || key in node) node[key] = value;
    else node.setAttribute(key, value);
  }
  for (const child of children.flat()) if (child !== null && child !== undefined && child !== false) node.append(child);
  return node;
}

const drawings = document.createElement("template");
drawings.innerHTML = "<svg></svg>";

/** A part of a drawing: shape("path", {d, class}). */
function shape(tag, props) {
  const node = document.createElementNS(drawings.content.firstChild.namespaceURI, tag);
  for (const [key, value] of Object.entries(props)) node.setAttribute(key, value);
  return node;
}

function section(title, about, ...children) {
  return el("section", null, el(".head", null, el("h2", null, title), about ? el("p", null, about) : null), ...children);
}

/** 1234567 N as 1.23 MN. */
function si(x, unit) {
  if (x === null || x === undefined) return "–";
  for (const [k, p] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]]) if (Math.abs(x) >= k) return `${num(x / k)} ${p}${unit}`;
  return `${num(x)} ${unit}`;
}

function clock(s) {
  const sign = s < 0 ? "-" : "", t = Math.abs(Math.round(s)), h = Math.floor(t / 3600), m = Math.floor((t % 3600) / 60);
  const two = (x) => String(x).padStart(2, "0");
  return sign + (h ? `${h}:${two(m)}:${two(t % 60)}` : `${m}:${two(t % 60)}`);
}

const UNITS = [["_mps", "m/s"], ["_degps", "deg/s"], ["_rev_s", "1/s"], ["_deg", "deg"], ["_rad", "rad"], ["_rpm", "rpm"], ["_us", "us"], ["_n", "N"], ["_m", "m"], ["_s", "s"]];

/** "sway_velocity_through_water_mps" -> ["sway velocity through water", "m/s"], "port.pwm_us" -> ["port pwm", "us"]. */
function named(column) {
  const [end, unit] = UNITS.find(([e]) => column.endsWith(e)) || ["", ""];
  return [column.slice(0, column.length - end.length).replaceAll(/[_.]/g, " ").replace(" true north", ""), unit];
}

function unpack(text) {
  const bytes = atob(text), raw = new Uint8Array(bytes.length);
  for (let i = 0; i < bytes.length; i++) raw[i] = bytes.charCodeAt(i);
  return new Float32Array(raw.buffer);
}

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** What is printed is printed for light paper, and drawn as wide as paper is: a canvas that was drawn for a screen would be squeezed. */
function printedLight(redrawn) {
  const root = document.documentElement;
  let shown = root.dataset.theme;
  addEventListener("beforeprint", () => { shown = root.dataset.theme; root.dataset.theme = "light"; root.classList.add("paper"); redrawn(); });
  addEventListener("afterprint", () => { root.dataset.theme = shown; root.classList.remove("paper"); redrawn(); });
}

/** A file's name as one word of a shell. */
const quoted = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

/** A command with a button that copies it. */
function command(text) {
  const button = el("button", { "aria-live": "polite", onclick: () => copy(text, button) }, "copy");
  return el(".command", null, el("code", null, text), button);
}

function copy(text, button) {
  const done = () => { button.textContent = "copied"; setTimeout(() => (button.textContent = "copy"), 1200); };
  const box = el("textarea", { value: text, style: { position: "fixed", opacity: 0 } });
  document.body.append(box);
  box.select();
  if (document.execCommand("copy")) done();
  box.remove();
  button.focus(); // where the keyboard was
}

function table(heads, rows) {
  const head = el("tr", null, heads.map((h) => el(h.startsWith(">") ? "th.n" : "th", null, h.replace(">", ""))));
  const name = heads.map((h) => h.replace(">", "")).filter(Boolean).join(", "); // a table that is wider than the screen is scrolled by keyboard, too
  return el(".scroll", { tabIndex: 0, role: "group", "aria-label": `Table: ${name}` }, el("table", null, el("thead", null, head), el("tbody", null, rows)));
}
