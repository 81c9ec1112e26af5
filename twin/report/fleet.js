// The fleet: one table, the ship with most wrong first, and each ship's history.
const STATES = { missing: ["bad", "missing"], weather: ["fair", "weather only"], unknown: ["fair", "unknown"], undecided: ["fair", "undecided"], nothing_missing: ["good", "nothing missing"], not_asked: ["fair", "not judged"], reference: ["good", "calibrated on"] };
const day = (v) => (v && (v.start_time_utc ? v.start_time_utc.slice(0, 10) : v.voyage)) || "";
const size = (number) => {
  if (!number) return "";
  const p = readable(number);
  return `${withUnit(`${p.name} ${num(p.value, 2)}`, p)} (${num(p.low95, 2)} to ${num(p.high95, 2)}${p.at_box_end ? ", at the end of its box" : ""})`;
};
const percent = (x) => (x === null || x === undefined ? "–" : `${Math.round(100 * x)} %`);
const signed = (x) => `${x < 0 ? "−" : "+"}${num(Math.abs(x), 2)}`;
const slope = (trend, unit) => {
  if (!trend) return "";
  const t = readable({ ...trend, unit });
  return `${signed(t.slope)} a ${t.per} (${signed(t.low95)} to ${signed(t.high95)})`;
};
const badge = (state) => { const [mood, word] = STATES[state] || ["fair", state]; return el(`span.badge.${mood}`, null, word); };

function head() {
  const v = RESULT.voyages, first = RESULT.ships[0], wrong = RESULT.counts.missing;
  const said = wrong ? `On ${wrong} of ${RESULT.ships.length} ships a cause of ship or instruments is named; first ${first.ship}: ${first.causes.map((c) => c.effect).join(" and ")}` : `On none of ${RESULT.ships.length} ships a cause of ship or instruments is named`;
  const theme = el("button", { onclick: () => { const d = document.documentElement.dataset; d.theme = d.theme === "dark" ? "light" : "dark"; } }, "light / dark");
  const counts = `${v.listed} voyages: ${v.judged} judged${v.references ? `, ${v.references} calibrated on` : ""}${v.failed ? `, ${v.failed} not` : ""}`;
  return el("header", null, el("div", null, el(".eyebrow", null, `Fleet · ${counts}`), el("h1", null, said), Object.entries(RESULT.counts).filter(([, n]) => n).map(([state, n]) => el("span.chip", null, `${n} ${STATES[state][1]}`))), theme);
}

function ranking() {
  const rows = RESULT.ships.flatMap((s) => {
    const named = s.causes.length ? s.causes : [null];
    return named.map((c, i) => el("tr", null,
      el("td.n", null, i ? "" : String(s.rank)),
      el("td.d", null, i ? "" : el("a", { href: `#ship-${s.rank}` }, s.ship)),
      el("td.d", null, c ? [el("b", null, c.effect), c.belongs_to === "voyage" ? " (weather)" : ""] : badge(s.state)),
      el("td.d", null, day(c ? c.since : s.since)), el("td", null, c ? size(c.number) : ""), el("td", null, c ? slope(c.trend, c.number?.unit) : ""),
      el("td.d", null, c && c.share_of_error !== null ? [el("span.bar100", { style: { width: "70px" } }, el("i", { style: { width: `${100 * Math.min(Math.max(c.share_of_error, 0), 1)}%` } })), percent(c.share_of_error)] : ""),
      el("td.d", null, i ? "" : chance(s.over_months))));
  });
  return section("Ranked by what is wrong", "by the latest voyage of each ship: causes by their share of the open-loop error, then unknown, undecided, nothing missing", table([">rank", "ship", "verdict", "since", "size, 95 %", "trend, 95 %", "of the error", "over the months"], rows));
}

function chance(m) {
  if (!m.references) return el("span.note", null, "no scores of references");
  return m.voyages ? [m.alarm ? el("span.badge.bad", null, "alarm") : null, ` M ${num(m.value, 2)}`] : "";
}

/** A size over the voyages with its 95 % intervals; hollow: weighed, and not named. */
function history(cause) {
  const list = cause.sizes.map(readable), wide = 420, tall = 110, left = 52, foot = 18;
  const days = list.map((p) => Date.parse(p.start_time_utc || "")), dated = days.every((d) => isFinite(d)) && new Set(days).size > 1;
  const at = dated ? days.map((d) => (d - Math.min(...days)) / (Math.max(...days) - Math.min(...days))) : list.map((_, i) => (list.length > 1 ? i / (list.length - 1) : 0.5));
  const all = list.flatMap((p) => [p.low95, p.high95, 0]), low = Math.min(...all), high = Math.max(...all);
  const X = (i) => left + 8 + at[i] * (wide - left - 16), Y = (v) => 6 + ((tall - foot - 12) * (high - v)) / (high - low || 1);
  const drawing = shape("svg", { viewBox: `0 0 ${wide} ${tall}`, width: wide, height: tall, role: "img", "aria-label": `${cause.effect}, ${list[0].name} over ${list.length} voyages, ${withUnit(list.map((p) => num(p.value)).join(", "), list[0])}` });
  const word = (x, y, text, anchor) => { const node = shape("text", { x, y, "text-anchor": anchor, class: "mark" }); node.textContent = text; drawing.append(node); };
  for (const v of new Set([low, 0, high])) if (v === 0 || Math.abs(Y(v) - Y(0)) > 12) word(left - 4, Y(v) + 4, num(v, 2), "end");
  drawing.append(shape("path", { d: `M${left} ${Y(0)}H${wide}`, class: "nought" }), shape("polyline", { points: list.map((p, i) => `${X(i)},${Y(p.value)}`).join(" "), class: "way" }));
  list.forEach((p, i) => drawing.append(shape("path", { d: `M${X(i)} ${Y(p.low95)}V${Y(p.high95)}`, class: "middle" }), shape("circle", { cx: X(i), cy: Y(p.value), r: 4, class: p.named ? "named" : "weighed" })));
  word(list.length > 1 ? left + 8 : X(0), tall - 3, day(list[0]), list.length > 1 ? "start" : "middle");
  if (list.length > 1) word(wide - 8, tall - 3, day(list[list.length - 1]), "end");
  return el("div", null, el("code", null, withUnit(`${cause.effect}: ${list[0].name}`, list[0])), el(".scroll", { tabIndex: 0, role: "group", "aria-label": drawing.getAttribute("aria-label") }, drawing), el("span.note", null, `named on ${cause.named_on} of ${cause.of_voyages} voyages, since ${day(cause.since)}; ${cause.trend ? slope(cause.trend, cause.number?.unit) : "three sizes make a trend"}`));
}

function ship(s) {
  const voyages = s.voyages.map((v) => el("tr", null, el("td", null, v.voyage || v.file), el("td.d", null, v.start_time_utc ? v.start_time_utc.slice(0, 10) : ""), el("td", null, Object.entries(v.tags).map(([k, x]) => el("span.chip", null, `${k}: ${x}`))),
    el("td", null, v.failed ? el("span.fair", null, v.failed) : [badge(v.verdict), " ", v.causes.filter((c) => c.named).map((c) => `${c.effect} ${size(c.parameters[0])}`).join("; ")]),
    el("td.n", null, v.position_mae_m === null ? "" : `${num(v.position_mae_m)} (${num(v.position_expected_m)})`), el("td.n", null, v.p_value === null ? "" : num(v.p_value, 2))));
  const commands = s.latest ? [command(`twin diagnose ${quoted(s.latest.file)} --ship ${quoted(s.file)} --report diagnose.html`)] : [];
  const lasting = s.causes.filter((c) => c.lasting).map((c) => c.effect);
  if (lasting.length) commands.push(command(`twin add ${lasting.join(" ")} --ship ${quoted(s.file)} --voyage ${quoted(s.latest.file)} -o better.toml`));
  const out = section(`${s.rank} · ${s.ship}`, s.file, el("p", { style: { margin: "0 0 10px" } }, s.latest ? s.sentence : "No voyage of this ship could be judged."),
    el(".two", null, s.causes.filter((c) => c.sizes.length).map(history)),
    table(["voyage", "began", "tags", "verdict", ">error (expected) [m]", ">p"], voyages), commands);
  out.id = `ship-${s.rank}`;
  return out;
}

document.documentElement.dataset.theme = (location.hash.match(/theme=(dark|light)/) || [])[1] || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
document.title = DATA.title;
document.getElementById("page").className = "fleet";
const months = section("Over the months", "many ships, many voyages, many tests", RESULT.months.map((text) => el("p.note", null, text)));
document.getElementById("page").append(head(), ranking(), months, ...RESULT.ships.map(ship), el("footer", null, "shiptwin · this page is whole: it asks nothing of any network"));
printedLight(() => {});
document.documentElement.dataset.readyMs = "0";
