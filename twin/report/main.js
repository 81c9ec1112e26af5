// The page, from the verdict down.
function tone() {
  if (DATA.kind === "add") return RESULT.forced ? ["fair", "forced"] : RESULT.accepted ? ["good", "the error falls"] : ["bad", "not written"];
  if (DATA.kind === "diagnose" && RESULT.reason === "weather_only") return ["fair", "water and weather"];
  if (DATA.kind === "diagnose") return { missing: ["bad", "missing"], nothing_missing: ["good", "nothing missing"], unknown: ["fair", "unknown cause"], undecided: ["fair", "undecided"] }[RESULT.verdict] || ["fair", RESULT.verdict];
  if (!RESULT.horizons.length) return ["fair", "not judged"];
  const times = RESULT.horizons.map((h) => Math.max(h.position_mae_m / h.noise_floor.position_mae_m, h.heading_mae_deg / h.noise_floor.heading_mae_deg));
  const last = times[times.length - 1], x = last < limit() ? Math.max(...times) : last;
  return x < limit() ? ["good", "as expected"] : x < 4 ? ["fair", `${num(x, 2)} times the expected error`] : ["bad", `${num(x, 2)} times the expected error`];
}

function head() {
  const [mood, word] = tone();
  const names = DATA.voyages.map((v) => v.name).join(", ");
  return el("header", null, el("div", null, el(".eyebrow", null, `${DATA.title} · ${names}`), el("h1", null, DATA.verdict), el(`span.badge.${mood}`, null, word), RESULT.water_sentence ? el("p", null, RESULT.water_sentence) : null), themeButton());
}

function next() {
  const f = RESULT.files || {}, rest = `${(f.voyages || ["VOYAGE.mcap"]).map(quoted).join(" ")} --ship ${quoted(f.ship || "SHIP.toml")}`;
  if (DATA.kind === "compare") return section("Next", "which physical effect is missing?", command(`twin diagnose ${rest} --report diagnose.html`));
  if (DATA.kind === "add" && RESULT.output) return section("Next", "the better model against the same measurements", command(`twin compare ${(f.judged || f.voyages || ["VOYAGE.mcap"]).map(quoted).join(" ")} --ship ${quoted(RESULT.output)}`));
  return null;
}

function build() {
  const start = performance.now();
  document.documentElement.dataset.theme = wishedTheme();
  document.title = DATA.title;
  const own = { compare: [], diagnose: [rankingSection(), momentsSection(), manoeuvreSection()], add: [fittedSection(), ladderSection()] }[DATA.kind] || [];
  const parts = [head(), ...own.filter(Boolean), errorsSection(), next(), el(".two", null, whereSection(), worstSection()), DATA.voyages.length ? voyageParts() : null, channelsSection(), checksSection(), provenanceSection()];
  document.getElementById("page").append(...parts.filter(Boolean), el("footer", null, "shiptwin · this page is whole: it asks nothing of any network"));
  live();
  document.documentElement.dataset.readyMs = String(Math.round(performance.now() - start));
}
build();
