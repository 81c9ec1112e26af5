// How it looks: colours, which way is up, how much is shown. Kept in the browser.

import { by, say, set } from "/dom.js";

const kept = (name, usual) => {
  try { return localStorage.getItem(name) ?? usual; } catch { return usual; }
};
const keep = (name, value) => {
  try { localStorage.setItem(name, value); } catch { /* a browser that keeps nothing */ }
};

export const look = { headUp: kept("up", "north") === "head", zoom: 1 };

export function wire(changed) {
  for (const button of document.querySelectorAll("[data-theme-name]")) {
    button.addEventListener("click", () => theme(button.dataset.themeName));
  }
  theme(kept("theme", matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
  window.addEventListener("storage", (event) => { if (event.key === "theme" && event.newValue) theme(event.newValue); }); // chosen on another page
  by("up").addEventListener("click", () => {
    look.headUp = !look.headUp;
    keep("up", look.headUp ? "head" : "north");
    up();
    changed();
  });
  const zoomed = (factor) => () => {
    look.zoom = factor ? Math.min(Math.max(look.zoom * factor, 1 / 16), 16) : 1;
    changed();
  };
  by("closer").addEventListener("click", zoomed(2));
  by("wider").addEventListener("click", zoomed(0.5));
  by("fit").addEventListener("click", zoomed(0));
  up();
}

function up() {
  say(by("up"), look.headUp ? "Head up" : "North up");
  set(by("up"), { "aria-label": look.headUp ? "Head up; change to north up" : "North up; change to head up" });
}

function theme(name) {
  document.documentElement.dataset.theme = ["light", "dark", "night"].includes(name) ? name : "light";
  for (const button of document.querySelectorAll("[data-theme-name]")) {
    set(button, { "aria-pressed": button.dataset.themeName === document.documentElement.dataset.theme });
  }
  keep("theme", name);
}
