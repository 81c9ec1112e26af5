"""What compare found, as lines on a terminal: the verdict first, every error beside its noise."""

import textwrap
from collections.abc import Sequence
from typing import Any

from twin.num import as_given, num
from twin.recording.checks import whose
from twin.study.estimation.start import waves_in_words
from twin.study.track.jumps import jumps_in_words

BAR = 24


def terminal_lines(result: dict[str, Any]) -> list[str]:
    """The whole answer, a line each; before it, that a voyage may be of another ship."""
    return [
        *whose(result["data_checks"]),
        *textwrap.wrap(result["verdict"], 100),
        *textwrap.wrap(result["water_sentence"], 100),
        "",
        f"{result['ship']}, {len(result['voyages'])} voyage{'s' * (len(result['voyages']) > 1)}; model: core"
        + "".join(f" + {e}" for e in result["model"]["effects"])
        + (" + residual" if result["model"].get("residual") else ""),
        *horizon_lines(result["horizons"]),
        *_channels(result["channels"]),
        *_forces(result),
        *_where(result),
        *_worst(result["worst_windows"]),
        *_off(result["switched_off"]),
        *waves_in_words(result["waves"]),
        *jumps_in_words(result["jumps"]),
        *_checks(result["data_checks"]),
    ]


def _units(error: float, floor: float) -> str:
    """Error in units of noise, and a bar of it (doubling every fifth of its length)."""
    times = error / max(floor, 1e-12)
    bar = 0
    while bar < BAR and 2.0 ** (bar * 5.0 / BAR) < times:
        bar += 1
    return f"x{num(times, 3):<6}{'#' * bar}".rstrip()


def horizon_lines(rows: list[dict[str, Any]]) -> list[str]:
    """The open-loop error of each horizon beside what is expected, in m and deg, under its heading."""
    of = rows[0]["noise_floor"]["of"]
    heads = ("position [m]", "across [m]", "heading [deg]", f"position over expected ({of})")
    out = ["", f"open loop   {_in_columns(heads)}"]
    for r in rows:
        n = r["noise_floor"]
        cells = [
            f"{num(r[k], 3)} / {num(n[k], 2)}" for k in ("position_mae_m", "lateral_mae_m", "heading_mae_deg")
        ]
        units = _units(r["position_mae_m"], n["position_mae_m"])
        out.append(f"{as_given(r['horizon_s']):>6} s    {_in_columns([*cells, units])}")
    return out


def _in_columns(cells: Sequence[str]) -> str:
    """The last as it is; the others as wide as two numbers of this table become."""
    return "".join(f"{cell:<19}" for cell in cells[:-1]) + cells[-1]


def _channels(channels: dict[str, dict[str, Any]]) -> list[str]:
    out = [
        "",
        f"{'channel':<36}{'error':>9}{'expected':>9}{'R2':>8}{'skill':>8}   (skill: against dead reckoning)",
    ]
    for name, c in channels.items():
        cells = [
            f"{c[k]:>{w}.3f}" if c[k] is not None else " " * (w - 1) + "-"
            for k, w in (("r2", 8), ("skill", 8))
        ]
        out.append(f"{name:<36}{num(c['mae'], 3):>9}{num(c['noise'], 2):>9}{cells[0]}{cells[1]}")
    return out


def _forces(result: dict[str, Any]) -> list[str]:
    share = ", ".join(f"{axis} {100.0 * x:.1f} %" for axis, x in result["unexplained_force"].items())
    out = ["", f"force the model misses, beyond noise: {share}"]
    return out + (
        [f"learned share of all force: {100.0 * result['learned_share']:.1f} %"]
        if result["model"].get("residual")
        else []
    )


def _where(result: dict[str, Any]) -> list[str]:
    if not result["where"]:
        return ["", "where: no condition stands out beyond chance"]
    out = ["", "where it fails (error against elsewhere, share of the time)"]
    return out + [
        f"  x{num(w['error_ratio'], 2):<5}{100 * w['time_share']:>4.0f} %  {w['condition']}"
        for w in result["where"]
    ]


def _worst(windows: list[dict[str, Any]]) -> list[str]:
    out = ["", "worst windows (error against the mean of all)"]
    return out + [
        f"  {w['voyage']}: {w['start_s']:.0f} to {w['end_s']:.0f} s, "
        f"{num(w['position_m'], 3)} m and {num(w['heading_deg'], 2)} deg off (x{num(w['error_ratio'], 2)})"
        for w in windows
    ]


def _off(entries: list[dict[str, Any]]) -> list[str]:
    return [
        f"switched off on {e['voyage']}: {e['effect']}, {', '.join(e['not_measured'])} was not recorded"
        for e in entries
    ]


def _checks(checks: list[dict[str, Any]]) -> list[str]:
    bad = [c for c in checks if not c["ok"]]
    if not bad:
        blind = sum(not c["told"] for c in checks)
        cannot = f", {blind} cannot tell" if blind else ""
        return ["", f"data checks: {len(checks) - blind} pass{cannot}"]
    return ["", "data checks"] + [
        f"  look  {c.get('voyage', '')}{': ' * ('voyage' in c)}{c['check']}: {c['text']}" for c in bad
    ]
