// Small words for making and filling elements. What comes from the twin is always text, never markup.

const SVG = "http://www.w3.org/2000/svg";

export const by = (id) => document.getElementById(id);

export function made(name, attributes = {}, ...children) {
  return filled(document.createElement(name), attributes, children);
}

export function drawn(name, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, name), attributes, children);
}

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

// Sets a text only where it changed, so that nothing is laid out, or read aloud, again for nothing.
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    const text = String(value);
    if (element.getAttribute(name) !== text) element.setAttribute(name, text);
  }
}

export const fixed = (value, decimals) => (value === null || value === undefined ? "–" : value.toFixed(decimals).replace("-", "−"));

export const bearing = (degrees) => `${String(((Math.round(degrees) % 360) + 360) % 360).padStart(3, "0")}°`;

export function clock(wall_s) {
  const date = new Date(wall_s * 1000);
  return Number.isNaN(date.getTime()) ? "--:--:--" : date.toISOString().slice(11, 19);
}

// A table whose cells are kept from frame to frame: `rows` are [class name, head, [text, class name], ...].
export function table(element, caption, heads, rows) {
  if (!element.tHead) {
    element.append(made("caption", {}, caption), made("thead", {}, made("tr")), made("tbody"));
  }
  const top = element.tHead.rows[0];
  if (top.cells.length !== heads.length) {
    top.replaceChildren(...heads.map(() => made("th", { scope: "col" })));
  }
  heads.forEach((head, i) => say(top.cells[i], head));
  const body = element.tBodies[0];
  while (body.rows.length > rows.length) body.deleteRow(-1);
  while (body.rows.length < rows.length) body.append(made("tr", {}, made("th", { scope: "row" })));
  rows.forEach(([kind, head, ...cells], i) => {
    const row = body.rows[i];
    set(row, { class: kind });
    say(row.cells[0], head);
    while (row.cells.length > cells.length + 1) row.deleteCell(-1);
    while (row.cells.length < cells.length + 1) row.append(made("td"));
    cells.forEach(([text, look], k) => {
      say(row.cells[k + 1], text);
      set(row.cells[k + 1], { class: look || "" });
    });
  });
}
