"""The league's page, docs/results/hidden-effects.md: what was run, what was found against what was wanted,
and every table."""

from collections.abc import Sequence
from typing import Any

from bench.league import league_score, league_tables
from bench.league.league_score import Row
from bench.league.league_tables import share, table

GOALS = {
    "named": ("named first", ">= 85 %"),
    "named_in_group": ("named, within its group", ">= 95 %"),
    "false_alarms": ("false alarms", "<= 2 %"),
    "unknown_recognised": ("unknown effects recognised", ">= 80 %"),
    "pairs_found": ("both of a pair", ">= 80 %"),
    "coverage95": ("95 % intervals that hold the truth", "90-98 %"),
    "error_after_over_oracle": ("held-out error after `add` over the oracle's", "<= 1.2"),
}
COUNTED = {
    "false_alarms": "nothing_cases",
    "unknown_recognised": "unknown_cases",
    "pairs_found": "pair_cases",
}
HEAD = """# The hidden-effect league

`{command}`: {done}; hulls {hulls}; strengths {strengths}; seeds {seeds}.

Voyages come from the reference sea (`bench/reference`: 6-DOF, MMG, no formula shared with the twin); each
ship is a bundled file calibrated on six calm reference voyages. A case is one voyage of 30 minutes (the 2 m
boat: 20 minutes, 900 of its lengths), diagnosed alone, with the reference voyages known only through the ship
file.

* **Named**: the hidden effect is the first of `missing`. **In its group**: it is among `missing`, or among
  the effects that the diagnosis says it could not tell from the first; or, when nothing is named, in the
  group of at most four of which it says that one is surely there. **Wrong**: another effect comes first.
* **Before**, **after**, **oracle**: mean 120 s open-loop position error on *another* voyage (same hidden
  effect, another manoeuvre): of the calibrated ship; after `add` of what was named, fitted on the diagnosed
  voyage (nothing is added when nothing was named); and after the same fit of the *true* effect in the
  catalogue's form.
  Ratios are geometric means over cases, so that a tanker does not outweigh a boat."""


def page(rows: Sequence[Row], result: dict[str, Any], calibrations: dict[str, Any]) -> str:
    """The whole page."""
    parts = [head(result["run"]), goals(rows, result)]
    parts += [league_tables.by(what, rows) for what in ("hull", "strength", "manoeuvre", "seed")]
    parts += [
        league_tables.effects(rows),
        league_tables.gain(rows),
        league_tables.parameters(rows),
        league_tables.nothing(rows),
        league_tables.outside(rows),
    ]
    parts += [
        league_tables.pairs(rows),
        league_tables.straight(rows),
        cost(rows),
        peer(rows),
        ships(calibrations),
    ]
    parts += [failed(rows)]
    return "\n\n".join(p for p in parts if p) + "\n"


def head(run: dict[str, Any]) -> str:
    whole = run["answered"] == run["planned"]
    return HEAD.format(
        command=run["command"],
        done=f"all {run['planned']} cases" if whole else f"{run['answered']} of {run['planned']} cases",
        hulls=", ".join(run["hulls"]),
        strengths=", ".join(f"{s:g}" for s in run["strengths"]),
        seeds=", ".join(map(str, run["seeds"])),
    )


def goals(rows: Sequence[Row], result: dict[str, Any]) -> str:
    """What was found beside what was wanted; shares of few cases say little, so their number stands beside
    them."""
    single, lines = league_score.of_kind(rows, "effect"), []
    intervals = sum(len(r.get("parameters", [])) for r in rows)
    for key, (words, goal) in GOALS.items():
        value, cases = (
            result[key],
            intervals if key == "coverage95" else result[COUNTED[key]] if key in COUNTED else len(single),
        )
        shown = league_tables.number(value) if key.endswith("oracle") else share(value)
        lines += [[words, f"**{shown}**", goal, cases]] if cases else []
    if single:
        lines.append(
            ["a wrong effect first", share(league_score.share(single, league_tables.wrong)), "", len(single)]
        )
        lines.append(
            [
                "no effect named",
                share(league_score.share(single, lambda r: not r["missing"])),
                "",
                len(single),
            ]
        )
    return table("## In total", ["measure", "found", "goal", "cases"], lines)


def cost(rows: Sequence[Row]) -> str:
    lines = []
    for hull in dict.fromkeys(r["hull"] for r in rows):
        mine = [r for r in rows if r["hull"] == hull and "seconds" in r]
        if mine:
            wall, cpu = ([r[k] for r in mine] for k in ("seconds", "cpu_seconds"))
            hour = league_score.middle([r["cpu_seconds"] * 3600.0 / r["duration_s"] for r in mine])
            seconds = (league_score.middle(wall), max(wall), league_score.middle(cpu), hour)
            lines.append([hull, *(f"{s:.1f}" for s in seconds)])
    columns = ["hull", "median s a case", "greatest", "median CPU s a case", "CPU s for an hour of voyage"]
    words = (
        "All candidates, one thread, 10 Hz; the machine was shared, so the processor's own time stands "
        "beside the clock's."
    )
    return table(f"## Time\n\n{words}", columns, lines) if lines else ""


def peer(rows: Sequence[Row]) -> str:
    mine = [r for r in rows if "peer" in r]
    if not mine:
        return "## pysindy\n\nIt was not installed in this run (`pip install pysindy`)."
    right, own = (
        league_score.share(mine, lambda r: r["peer"]["right"]),
        league_score.share(mine, league_score.named),
    )
    seconds = league_score.middle([r["peer"]["seconds"] for r in mine])
    return f"""## pysindy

Sparse regression (STLSQ) of the residual accelerations of the same {len(mine)} voyages on 13 terms that an
engineer would offer it; only causes that have a term of their own. Its largest term belongs to the cause in
{share(right)}; the twin names the cause first in {share(own)}. Median {seconds:.2f} s a voyage. It has no
answer for "nothing is
missing", gives no newtons, and sees no fault of an instrument."""


def ships(calibrations: dict[str, Any]) -> str:
    lines = []
    for hull, c in calibrations.items():
        last = c["held_out"][-1]
        shares = ", ".join(f"{100 * s:.2g} %" for s in c["floor"]["share"])
        lines.append(
            [hull, f"{last['before_m']:.3g} m", f"{last['position_m']:.3g} m", shares, f"{c['temper']:.1f}"]
        )
    columns = ["hull", "bundled file", "calibrated", "unexplained of surge, sway, yaw", "temper"]
    words = "Calibrated on six voyages; 120 s position error on a seventh."
    return table(f"## The ships\n\n{words}", columns, lines) if lines else ""


def failed(rows: Sequence[Row]) -> str:
    lines = [f"* {r['key']}: {r['why']}" for r in rows if r["verdict"] == "failed"]
    return "\n".join(["## Failed", "", *lines]) if lines else ""
