"""docs/results/real-kvlcc2.md from the numbers of bench/real/kvlcc2.py."""

from collections.abc import Sequence
from typing import Any

from bench.real import planted_faults

OTHERS = (
    "On the other runs together (which also chose between two ways of fitting, and whether an antenna "
    "was moved)"
)
CYCLES = 3  # whole zigzag cycles, for a mean of the rudder angle to say something
HEAD = """# Real data: KVLCC2 in two towing tanks

`SHIPTWIN_DATA=DIR twin-bench real --out docs/results/real-kvlcc2.md`

Zigzags of SIMMAN 2008, imported through `docs/maps/`. All errors are open loop: the model starts from the
measured motion and runs on the recorded rudder and propeller; mean over windows that begin every ten seconds.
*Dead reckoning* goes on as at
the start. *Floor* is what a perfect model (or, of a calibrated ship, one as good as its calibration)
would show."""


def page(result: dict[str, Any]) -> str:
    return "\n\n".join([HEAD, *(_basin(b) for b in result["basins"])]) + "\n"


def _basin(b: dict[str, Any]) -> str:
    fitted = ", ".join(r["name"] for r in b["runs"] if r["fitted"])
    parts = [
        f"## {b['basin']}: {b['words']}",
        f"Ship file `{b['ship']}`: published coefficients (Yasukawa and Yoshimura 2015), nothing fitted to "
        "these runs.",
        _runs(b),
        f"### Calibrated on some, judged on the others\n\nFitted to {fitted}. "
        f"{OTHERS}:\n\n" + _before_after(b),
        _noise_lines(b),
        "### The rudder's asymmetry\n\n" + _helm(b["helm"]),
        *(_diagnosis(d) for d in b["diagnoses"]),
        _gain_lines(b["asked"]),
        "### Known faults put into the readings of the runs that it was not fitted "
        "to\n\n" + planted_faults.table(b["faults"]),
    ]
    return "\n\n".join(parts)


def _runs(b: dict[str, Any]) -> str:
    lines = [
        "### Published coefficients, run by run",
        "",
        "| run | after | windows | position m | dead reckoning m | heading deg | dead reckoning deg |",
        "|" + "---|" * 7,
    ]
    for run in b["published"]:
        for row in run["horizons"]:
            lines.append(f"| {run['name']} | {row['horizon_s']:g} s | {row['windows']} | {_errors(row)} |")
    return "\n".join(lines)


def _errors(row: dict[str, Any]) -> str:
    return (
        f"{row['position_mae_m']:.3g} | {row['reckoned_m']:.3g} | {row['heading_mae_deg']:.2g} | "
        f"{row['reckoned_deg']:.2g}"
    )


def _before_after(b: dict[str, Any]) -> str:
    lines = [
        "| after | position m: published | calibrated | floor | heading deg: published | calibrated | floor "
        "|",
        "|" + "---|" * 7,
    ]
    for before, after in zip(b["published_on_others"], b["calibrated_on_others"], strict=True):
        floor = after["noise_floor"]
        position = (
            f"{before['position_mae_m']:.3g} | {after['position_mae_m']:.3g} | {floor['position_mae_m']:.2g}"
        )
        heading = (
            f"{before['heading_mae_deg']:.2g} | {after['heading_mae_deg']:.2g} | "
            f"{floor['heading_mae_deg']:.2g}"
        )
        lines.append(f"| {after['horizon_s']:g} s | {position} | {heading} |")
    return "\n".join(lines)


def _noise_lines(b: dict[str, Any]) -> str:
    shares = ", ".join(f"{100 * s:.2g} %" for s in b["floor"]["share"])
    return f"Unexplained of the forces at work in surge, sway, yaw: {shares}; temper {b['temper']:.1f}."


def _helm(helm: Sequence[dict[str, Any]]) -> str:
    lines = [
        f"Mean rudder over whole zigzag cycles, in runs with {CYCLES} or more (the first cycles still lose "
        "speed); starboard positive,",
        "zero for a ship that is alike on both sides.",
        "",
        "| run | cycles | mean rudder deg |",
        "|---|---|---|",
    ]
    rows = [
        f"| {h['name']} | {h['cycles']} | {_number(h['mean_rudder_deg'])} |"
        for h in helm
        if h["cycles"] >= CYCLES
    ]
    return (
        "\n".join(lines + rows)
        if rows
        else f"No run has {CYCLES} whole zigzag cycles, over which a mean rudder angle would mean something."
    )


def _gain_lines(asked: Sequence[dict[str, Any]]) -> str:
    """What `add` would make of each asymmetric effect, although the diagnosis did not ask for it."""
    lines = ["Asked directly: each effect fitted on the calibration's runs, judged on the others.", ""]
    lines += ["| effect | numbers (95 %) | position m | heading deg |", "|---|---|---|---|"]
    for a in asked:
        sizes = "; ".join(
            f"{x['name']} {x['value']:.3g} {x['unit']} ({x['low95']:.2g} to {x['high95']:.2g})"
            for x in a["numbers"]
        )
        fall = [f"{a['before'][k]:.3g} -> {a['after'][k]:.3g}" for k in ("position_mae_m", "heading_mae_deg")]
        lines.append(f"| {a['effect']} | {sizes} | {fall[0]} | {fall[1]} |")
    return "\n".join(lines)


def _diagnosis(d: dict[str, Any]) -> str:
    p = d["probabilities"]
    named = f", names {' and '.join(d['missing'])}" if d["missing"] else ""
    lines = [
        f"**`diagnose`, {d['of']}**: `{d['verdict']}`, `{d['reason']}`{named} "
        f"(nothing missing {p['nothing_missing']:.2f}, unknown {p['unknown']:.2f})."
    ]
    for c in d["candidates"]:
        sizes = "; ".join(
            f"{x['name']} {x['value']:.3g} {x['unit']} ({x['low95']:.2g} to {x['high95']:.2g})"
            for x in c["parameters"]
        )
        force = ", ".join(f"{k.replace('_', ' ')} {v:.2g}" for k, v in c["typical_force"].items())
        alike = (
            (f"; cannot be told from {', '.join(c['cannot_be_told_from'])}")
            if c["cannot_be_told_from"]
            else ""
        )
        error = (
            f"Error after {c['error_horizon_s']:.0f} s {c['error_without']:.3g} m -> {c['error_with']:.3g} m"
        )
        lines.append(
            f"* {c['effect']} {c['probability']:.2f}: {sizes}. Typical force {force}. {error}{alike}."
        )
    if d["not_judged"]:
        lines.append(
            "* Not judged, for want of what was not recorded: "
            f"{', '.join(n['effect'] for n in d['not_judged'])}."
        )
    if d["next_manoeuvre"]:
        lines.append(f"* Next: {d['next_manoeuvre']['manoeuvre']} ({d['next_manoeuvre']['why']}).")
    return lines[0] + "\n\n" + "\n".join(lines[1:])


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:+.2f}"
