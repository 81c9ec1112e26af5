"""The part of the page of `twin-bench adaptation` where a named effect grows."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np


def page(r: dict[str, Any]) -> list[str]:
    """Markdown."""
    minutes, errors = r["late_s"] / 60.0, {name: g["how"] for name, g in r["growths"].items()}
    return [
        "## A named effect grows in the middle of a voyage",
        "",
        "The calibrated core with Wind and WaveDrift and their network, and one effect more in the ship "
        "file at the size it had before: "
        f"zigzags of 1500 s, {r['seeds']} seeds of six voyages, the change at {r['change_s']:.0f} s. "
        "Learning off; on but for the effects' "
        f"numbers (rows alone); on. Heading deg / lateral m of free runs begun {minutes:.0f} minutes or more "
        "after the change: mean and "
        "spread (n - 1) over seeds.",
        "",
        *_late(r),
        "",
        "The same by the second the free runs begin at.",
        "",
        *by_window("ship", errors, r["starts_s"]),
        "",
        "The number that grows, as the twin publishes it: mean over voyages at the last window +- half the "
        "95 % interval it gives (and the "
        "spread of its values over voyages), and the share of the late windows in which the interval holds "
        "the truth.",
        "",
        *_arrival(r),
    ]


def _late(r: dict[str, Any]) -> list[str]:
    ways = list(next(iter(r["growths"].values()))["how"])
    rows = [
        f"| {name} |"
        + "".join(
            f" {_spread(e['late_heading_deg'], 3)} / {_spread(e['late_lateral_m'], 2)} |"
            for e in g["how"].values()
        )
        for name, g in r["growths"].items()
    ]
    return [f"| ship | {' | '.join(ways)} |", "|---" * (1 + len(ways)) + "|", *rows]


def _spread(values: list[float], digits: int) -> str:
    sd = float(np.std(values, ddof=1)) if len(values) > 1 else 0.0
    return f"{np.mean(values):.{digits}f} ± {sd:.{digits}f}"


def by_window(what: str, errors: dict[str, Any], starts_s: Sequence[float]) -> list[str]:
    """A row for each ship or change and each way of learning, a column for each window."""
    rows = [
        f"| {name}, {how} |"
        + "".join(f" {a:.3f} / {b:.2f} |" for a, b in zip(e["heading_deg"], e["lateral_m"], strict=True))
        for name, ways in errors.items()
        for how, e in ways.items()
    ]
    return [
        f"| {what}, learning | {' | '.join(f'{t:.0f} s' for t in starts_s)} |",
        "|---" * (1 + len(starts_s)) + "|",
        *rows,
    ]


def _arrival(r: dict[str, Any]) -> list[str]:
    found = [g["number"] for g in r["growths"].values() if g["number"]]
    scenarios = list(found[0]["value"])
    rows = [
        f"| {n['label']} | {n['file']:g} | {n['truth']:g} |"
        + "".join(
            f" {n['value'][ts][-1]:.3f} ± {n['half_95'][ts][-1]:.3f} ({n['spread'][ts][-1]:.3f}) |"
            for ts in scenarios
        )
        + f" {100.0 * n['held']:.0f} % |"
        for n in found
    ]
    head = f"| number | ship file | truth since the change | {' | '.join(scenarios)} | interval holds it |"
    return [head, "|---" * (4 + len(scenarios)) + "|", *rows]


def figure(r: dict[str, Any], path: Path) -> None:
    """Above: heading error over time since the change. Below: the number that grows, with its interval,
    towards the truth."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    since = np.array(r["starts_s"]) - r["change_s"]
    grown = {
        name: g
        for name, g in r["growths"].items()
        if g["number"] and g["number"]["truth"] != g["number"]["file"]
    }
    fig, axes = plt.subplots(2, len(grown), figsize=(3.7 * len(grown), 6), sharex=True, squeeze=False)
    for (name, g), (above, below) in zip(grown.items(), axes.T, strict=True):
        for (how, e), colour in zip(g["how"].items(), ("tab:orange", "tab:green", "tab:blue"), strict=True):
            above.plot(
                since,
                e["heading_deg"],
                "o-",
                ms=4,
                color=colour,
                label=f"learning {how}" if how != "rows alone" else how,
            )
        above.set(title=name, ylim=(0.0, None))
        n = g["number"]
        for (ts, value), colour in zip(
            n["value"].items(), ("tab:blue", "tab:cyan", "tab:gray"), strict=False
        ):
            half = np.array(n["half_95"][ts])
            below.plot(since, value, "o-", ms=3, color=colour, label=ts)
            below.fill_between(since, value - half, value + half, color=colour, alpha=0.15)
        below.step(
            [since[0], 0.0, since[-1]],
            [n["file"], n["truth"], n["truth"]],
            where="post",
            color="k",
            lw=1,
            label="truth",
        )
        below.set(xlabel="s since the change", ylabel=n["label"])
    axes[0, 0].set(ylabel="heading error over 120 s, deg")
    axes[0, 0].legend(fontsize=8)
    axes[1, 0].legend(fontsize=8)
    fig.tight_layout()
    fig.savefig(path, dpi=72)
    plt.close(fig)
