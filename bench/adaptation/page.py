"""The page of `twin-bench adaptation`."""

from pathlib import Path
from typing import Any

from bench.adaptation import growth_page

SAID = {"off": "learning off", "on": "learning on", "told": "learning on, told of the change"}


def page(r: dict[str, Any]) -> list[str]:
    """Markdown."""
    ships, lies = (list(next(iter(r[part].values()))) for part in ("changed", "lies"))
    lines = [
        "# Laws of adaptation",
        "",
        f"`twin-bench adaptation{' --full' if r['full'] else ''} --seeds {r['seeds']}`: {r['voyages']} "
        "zigzags of 900 s for each ship "
        "(TS-01 to TS-03, 10/10 and 20/20), free runs of 120 s; every law in the boxes, the ball and behind "
        "the gate of "
        "twin/live/learning/adapt.py. The last row is on board.",
        "",
        "## Ships that changed when the voyage began",
        "",
        "Heading deg / lateral m of windows begun 300 to 540 s after the change.",
        "",
        *_table(r["changed"], ships, lambda x: f"{x['heading_deg']:.3f} / {x['lateral_m']:.2f}"),
        "",
        "While it learns: windows begun 60 to 180 s after the change.",
        "",
        *_table(r["changed"], ships, lambda x: f"{x['heading_early_deg']:.3f} / {x['lateral_early_m']:.2f}"),
        "",
        "## Measurements that lie, on the ship as it is",
        "",
        "Heading deg / lateral m (300 to 540 s), and the greatest |A| that ever acted (at most 1).",
        "",
        *_table(
            r["lies"], lies, lambda x: f"{x['heading_deg']:.3f} / {x['lateral_m']:.2f} ({x['largest_A']:.2f})"
        ),
        "",
        "## A change in the middle of a voyage",
        "",
        f"Zigzags of 900 s in other seas, the change at {r['change_s']:.0f} s; heading deg / lateral m of "
        "free runs by the second they "
        "begin at: learning off; on (the law on board); told (the same law, which forgets all it knew at the "
        "change: on board nobody says so). "
        "The run begun at the change knows nothing of it yet.",
        "",
        *growth_page.by_window("change", r["midway"], r["starts_s"]),
        "",
        "Heading deg by scenario, mean of the windows begun at the change and later, learning off / on / "
        "told.",
        "",
        *_by_scenario(r["midway"]),
        "",
        *growth_page.page(r["named"]),
    ]
    return lines


def _by_scenario(midway: dict[str, Any]) -> list[str]:
    scenarios = list(next(iter(midway.values()))["off"]["by_scenario_deg"])
    rows = [
        f"| {name} |"
        + "".join(
            f" {' / '.join(format(e['by_scenario_deg'][ts], '.3f') for e in hows.values())} |"
            for ts in scenarios
        )
        for name, hows in midway.items()
    ]
    return [f"| change | {' | '.join(scenarios)} |", "|---" * (1 + len(scenarios)) + "|", *rows]


def figure(r: dict[str, Any], path: Path) -> None:
    """Heading error of the free runs over time since the change, each change beside the ship as it is."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    since = [t - r["change_s"] for t in r["starts_s"]]
    changed = [name for name in r["midway"] if name != "as it is"]
    fig, axes = plt.subplots(2, -(-len(changed) // 2), figsize=(11, 6), sharex=True)
    healthy = r["midway"]["as it is"]["on"]["heading_deg"]
    for ax, name in zip(axes.flat, changed, strict=False):
        both = r["midway"][name]
        for how, colour in (("off", "tab:orange"), ("on", "tab:blue"), ("told", "tab:green")):
            ax.plot(since, both[how]["heading_deg"], "o-", ms=4, color=colour, label=SAID[how])
        ax.plot(since, healthy, ":", color="0.4", label="no change, learning on")
        ax.axvline(0.0, color="0.7", lw=0.8)
        ax.set(title=name, ylim=(0.0, None))
    for ax in axes[-1]:
        ax.set(xlabel="free run begins, s since the change")
    for ax in axes[:, 0]:
        ax.set(ylabel="heading error over 120 s, deg")
    fig.legend(*axes.flat[0].get_legend_handles_labels(), loc="upper center", ncol=4, fontsize=9)
    fig.tight_layout(rect=(0.0, 0.0, 1.0, 0.95))
    fig.savefig(path, dpi=72)
    plt.close(fig)


def _table(rows: dict[str, Any], columns: list[str], cell: Any) -> list[str]:
    lines = [f"| law | {' | '.join(columns)} |", "|---" * (1 + len(columns)) + "|"]
    return lines + [
        f"| {law} | {' | '.join(cell(found[c]) for c in columns)} |" for law, found in rows.items()
    ]
