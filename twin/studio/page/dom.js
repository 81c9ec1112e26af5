// Elements from words: text is only ever text, never markup.

const SVG = "http://www.w3.org/2000/svg";

/** el("section.card", { id: "a", onclick: f }, "text", child, [children]) */
export function el(what, props, ...children) {
  const [tag, ...classes] = what.split("."), node = document.createElement(tag || "div");
  if (classes.length) node.className = classes.join(" ");
  for (const [name, value] of Object.entries(props || {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "disabled") node[name] = value;
    else node.setAttribute(name, value === true ? "" : value);
  }
  put(node, children);
  return node;
}

export function put(node, children) {
  for (const child of children.flat(Infinity)) {
    if (child === null || child === undefined || child === false) continue;
    node.append(child instanceof Node ? child : String(child));
  }
  return node;
}

export function svg(tag, props, ...children) {
  const node = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(props || {})) if (value !== undefined && value !== null) node.setAttribute(name, value);
  return put(node, children);
}

/** A table: heads are words, or [word, "n"] for a column of numbers; the first cell of a row is its head. */
export function table(caption, heads, rows) {
  const n = (i) => (Array.isArray(heads[i]) ? "n" : "");
  const cell = (tag, i, content, scope) => el(`${tag}${n(i) ? ".n" : ""}`, { scope }, content);
  return el(".scroll", { tabindex: 0, role: "group", "aria-label": caption }, el("table", null, el("caption", null, caption),
    el("thead", null, el("tr", null, heads.map((h, i) => cell("th", i, Array.isArray(h) ? h[0] : h, "col")))),
    el("tbody", null, rows.map((row) => el("tr", null, row.map((c, i) => cell(i ? "td" : "th", i, c, i ? undefined : "row")))))));
}

export function card(title, ...children) {
  return el("section.card", { "aria-label": title }, el(".head", null, el("h2", null, title)), ...children);
}

export function button(text, onclick, props) { return el("button", { type: "button", onclick, ...props }, text); }

/** A file's name as one word of a shell. */
export const quoted = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

/** The command line that does the same, to be copied. */
export function command(text) {
  return el(".command", null, el("code", null, text), button("Copy", () => navigator.clipboard?.writeText(text), { class: "small", "aria-label": `Copy the command ${text}` }));
}

export function field(label, input, ...behind) { return el("label.field", null, label, el("span.row", null, input, ...behind)); }

export function choose(id, options, value, onchange) {
  return el("select", { id, onchange: (e) => onchange?.(e.target.value) }, options.map(([v, text]) => {
    const option = el("option", { value: v }, text);
    option.selected = v === value;
    return option;
  }));
}

/** Boxes to tick; `chosen` is a Set that is kept up. */
export function boxes(legend, id, names, chosen, changed) {
  return el("fieldset", null, el("legend", null, legend), names.map(([value, text], i) => el("label", null,
    el("input", { type: "checkbox", id: `${id}-${i}`, checked: chosen.has(value), onchange: (e) => { e.target.checked ? chosen.add(value) : chosen.delete(value); changed?.(); } }), text)),
    names.length ? null : el("span.note", null, "none here yet"));
}

export function clock(s) {
  const t = Math.round(s), m = Math.floor(t / 60), h = Math.floor(m / 60);
  return h ? `${h}:${String(m % 60).padStart(2, "0")}:${String(t % 60).padStart(2, "0")}` : `${m}:${String(t % 60).padStart(2, "0")}`;
}

const UNITS = [["_mps", "m/s"], ["_degps", "deg/s"], ["_rev_s", "1/s"], ["_deg", "deg"], ["_rad", "rad"], ["_rpm", "1/min"], ["_us", "us"], ["_n", "N"], ["_m", "m"], ["_s", "s"]];

/** "yaw_rate_degps" -> ["yaw rate", "deg/s"], "port.pwm_us" -> ["port pwm", "us"] */
export function named(channel) {
  const [end, unit] = UNITS.find(([e]) => channel.endsWith(e)) || ["", ""];
  return [channel.slice(0, channel.length - end.length).replaceAll(/[_.]/g, " "), unit];
}
