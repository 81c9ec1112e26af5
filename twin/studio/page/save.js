// Every picture and table can be kept: PNG, SVG and CSV, made here and given to the browser.

import { button, el, svg } from "/app/dom.js";

function give(blob, name) {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 5000);
}

const plainName = (title) => title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "plot";
const KEPT = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-size", "font-family", "text-anchor", "opacity"];

/** A copy of a drawing that needs no style sheet. */
function alone(drawing) {
  const copy = drawing.cloneNode(true), from = [drawing, ...drawing.querySelectorAll("*")], to = [copy, ...copy.querySelectorAll("*")];
  from.forEach((node, i) => { const style = getComputedStyle(node); for (const name of KEPT) to[i].setAttribute(name, style.getPropertyValue(name)); });
  const box = drawing.viewBox.baseVal, paper = svg("rect", { width: box.width, height: box.height, fill: getComputedStyle(document.body).getPropertyValue("--card") });
  copy.prepend(paper);
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", box.width);
  copy.setAttribute("height", box.height);
  return new XMLSerializer().serializeToString(copy);
}

async function png(text) {
  const image = new Image(), link = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
  await new Promise((good, bad) => { image.onload = good; image.onerror = bad; image.src = link; });
  const canvas = el("canvas", { width: 2 * image.width, height: 2 * image.height }), pen = canvas.getContext("2d");
  pen.scale(2, 2);
  pen.drawImage(image, 0, 0);
  URL.revokeObjectURL(link);
  return new Promise((done) => canvas.toBlob(done, "image/png"));
}

export function csv(rows) {
  const cell = (x) => (x === null || x === undefined || Number.isNaN(x) ? "" : /[",\n]/.test(String(x)) ? `"${String(x).replaceAll('"', '""')}"` : String(x));
  return rows.map((row) => row.map(cell).join(",")).join("\n") + "\n";
}

export const giveText = (text, name, kind = "text/csv") => give(new Blob([text], { type: kind }), name);

/** The three buttons; `drawing()` gives an SVG element, `rows()` the numbers behind it. */
export function keepers(title, drawing, rows) {
  const name = plainName(title), props = (what) => ({ class: "small", "aria-label": `Save ${title} as ${what}` });
  return el(".tools.keep", { role: "group", "aria-label": `Save ${title}` },
    button("PNG", async () => give(await png(alone(drawing())), `${name}.png`), props("PNG")),
    button("SVG", () => giveText(alone(drawing()), `${name}.svg`, "image/svg+xml"), props("SVG")),
    button("CSV", () => giveText(csv(rows()), `${name}.csv`), props("CSV")));
}

/** A table with a button that saves it. */
export function kept(caption, heads, rows, drawn) {
  return el("figure", null, drawn, el(".tools", null, button("CSV", () => giveText(csv([heads.map((h) => (Array.isArray(h) ? h[0] : h)), ...rows]), `${plainName(caption)}.csv`), { class: "small", "aria-label": `Save ${caption} as CSV` })));
}
