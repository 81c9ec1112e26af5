// What the mouse does on plots, by keyboard: one strip of times is entered by Tab, its keys move a moment along it.

/** Makes `node` such a strip. `over()`: [from, to] that it shows; `moved(t)`: draw the moment; `chosen(t)`: Enter;
 * `word(t)`: what a screen reader says; `other(key, t)`: another key, true when it was one of its own. */
function stripOfTimes(node, label, { over, moved, chosen, word = clock, other = () => false }) {
  let at = null;
  const show = (t) => {
    at = t;
    const [from, to] = over();
    for (const [key, x] of [["valuemin", Math.round(from)], ["valuemax", Math.round(to)], ["valuenow", Math.round(t)], ["valuetext", word(t)]]) node.setAttribute(`aria-${key}`, x);
    moved(t);
  };
  const held = () => { const [from, to] = over(); return at === null || at < from || at > to ? (from + to) / 2 : at; };
  node.tabIndex = 0;
  for (const [key, value] of [["role", "slider"], ["aria-label", label]]) node.setAttribute(key, value);
  node.onfocus = () => { if (node.matches(":focus-visible")) show(held()); };
  node.onblur = () => moved(null);
  node.onkeydown = (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    const [from, to] = over(), step = (to - from) / (e.shiftKey ? 10 : 100), t = held();
    const to_t = { ArrowRight: t + step, ArrowUp: t + step, ArrowLeft: t - step, ArrowDown: t - step, PageUp: t + (to - from) / 10, PageDown: t - (to - from) / 10, Home: from, End: to }[e.key];
    if (to_t !== undefined) show(Math.min(Math.max(to_t, from), to));
    else if (e.key === "Enter" || e.key === " ") chosen(t, show);
    else if (!other(e.key, t, show)) return;
    e.preventDefault();
    e.stopPropagation();
  };
}

/** The axis of times above all plots: arrows show a moment on each, Enter begins a stretch and Enter again goes to it. */
function axisKeys(node) {
  let began = null;
  const near = (t, times, show) => { const span = (view.to - view.from) * times / 2; setZoom(t - span, t + span); show(Math.min(Math.max(t, view.from), view.to)); };
  const moved = (t) => {
    if (t === null) began = null;
    point(t);
    stretch(began, t);
  };
  stripOfTimes(node, "Moment on every plot. Arrows move it; Enter begins a stretch and Enter again shows it; plus and minus show less and more time; Escape shows the whole voyage", {
    over: () => [view.from, view.to],
    moved,
    word: (t) => (began === null ? clock(t) : `${clock(began)} to ${clock(t)}`),
    chosen: (t, show) => {
      const from = began;
      began = from === null ? t : null;
      if (from === null) return show(t);
      if (Math.abs(t - from) < (view.to - view.from) / 200) return near(t, 1 / 3, show); // as a click
      setZoom(Math.min(from, t), Math.max(from, t));
      show(Math.min(Math.max(t, view.from), view.to));
    },
    other: (key, t, show) => {
      if (key === "Escape" && began !== null) { began = null; show(t); return true; }
      const times = { "+": 1 / 2, "=": 1 / 2, "-": 2 }[key];
      if (times) near(t, times, show);
      return Boolean(times);
    },
  });
}

/** The stretch that is being chosen, on every plot. */
function stretch(from, to) {
  for (const { cursor, picked } of view.panels) {
    if (!picked) continue;
    const width = cursor.parentNode.clientWidth - LEFT, px = (t) => LEFT + ((t - view.from) / (view.to - view.from)) * width;
    if (from === null || to === null) picked.style.display = "none";
    else Object.assign(picked.style, { display: "block", left: `${px(Math.min(from, to))}px`, width: `${Math.abs(px(to) - px(from))}px` });
  }
}
