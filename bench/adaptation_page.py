"""The page of `twin-bench adaptation`."""

from typing import Any


def page(r: dict[str, Any]) -> list[str]:
    """Markdown."""
    ships, lies = (list(next(iter(r[part].values()))) for part in ("changed", "lies"))
    lines = [
        "# Laws of adaptation", "",
        f"`twin-bench adaptation{' --full' if r['full'] else ''} --seeds {r['seeds']}`: {r['voyages']} zigzags of 900 s for each ship "
        "(TS-01 to TS-03, 10/10 and 20/20), free runs of 120 s; every law in the boxes, the ball and behind the gate of "
        "twin/live/adapt.py. The last row is on board.",
        "", "## Ships that changed when the voyage began", "",
        "Heading deg / lateral m of windows begun 300 to 540 s after the change.", "",
        *_table(r["changed"], ships, lambda x: f"{x['heading_deg']:.3f} / {x['lateral_m']:.2f}"),
        "", "While it learns: windows begun 60 to 180 s after the change.", "",
        *_table(r["changed"], ships, lambda x: f"{x['heading_early_deg']:.3f} / {x['lateral_early_m']:.2f}"),
        "", "## Measurements that lie, on the ship as she is", "",
        "Heading deg / lateral m (300 to 540 s), and the greatest |A| that ever acted (at most 1).", "",
        *_table(r["lies"], lies, lambda x: f"{x['heading_deg']:.3f} / {x['lateral_m']:.2f} ({x['largest_A']:.2f})"),
    ]  # fmt: skip
    return lines


def _table(rows: dict[str, Any], columns: list[str], cell: Any) -> list[str]:
    lines = [f"| law | {' | '.join(columns)} |", "|---" * (1 + len(columns)) + "|"]
    return lines + [f"| {law} | {' | '.join(cell(found[c]) for c in columns)} |" for law, found in rows.items()]
