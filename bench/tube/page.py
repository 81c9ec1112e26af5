"""What `twin-bench tube` prints, as Markdown."""

from collections.abc import Iterable, Mapping, Sequence

from bench.tube.interval_score import EVERY, CoverageRow


def page(
    counts: Mapping[str, int],
    own: Mapping[str, Mapping[str, Sequence[CoverageRow]]],
    others: Mapping[str, Sequence[CoverageRow]],
) -> str:
    """The whole page."""
    ships = " ".join(f"{hull}={n}" for hull, n in counts.items())
    return f"""# The tube around the predictions, tried

`twin-bench tube --ships {ships} --work .tube`

90 % is promised of the place (ellipse) and of the heading (to either side), if helm and engine are held.
Each voyage (any sea up to the ship's highest of `twin-bench seaway`; courses, zigzags, turns and speeds
drawn from its seed) went through the loop that the service builds and was judged by a tube of all *other*
voyages of its hull, against the measured place and heading. Inside: each voyage has weight one; behind ±:
the standard deviation from voyage to voyage. On: voyages whose quantile the tube took, after a third of the
others (12 at most) had given the regression. Radius: of the circle of the ellipse's area. Score: the
interval score, the smaller the better. The slow correction on board is left out. How it works:
[decision 0021](../decisions/{DECISION}).

## Left one voyage out
{_head(*OWN)}
{_lines([_row(hull, r) for r in by["model"]] for hull, by in own.items())}

## Beside dead reckoning
A tube around dead reckoning (speed over ground and rate of turn stay as they are), made and judged in the
same way.

{_head(*BESIDE)}
{_lines(_beside(hull, by) for hull, by in own.items())}

## The tube of one hull on another
Never seen: neither the hull nor the sea. Nothing here is promised: voyages of other ships are not
exchangeable.

{_head(*OTHER)}
{_lines([_other(pair, r)] for pair, rows in others.items() for r in rows)}
"""


OWN = (
    "ship",
    "s",
    "group",
    "voyages",
    "predictions",
    "on",
    "place inside",
    "heading inside",
    "radius m",
    "heading deg",
    "score m",
    "score deg",
)
BESIDE = (
    "ship",
    "s",
    "inside, model",
    "inside, reckoning",
    "radius m, model",
    "reckoning",
    "heading deg, model",
    "reckoning",
)
OTHER = (
    "calibrated on -> judged on",
    "s",
    "voyages",
    "place inside",
    "heading inside",
    "radius m",
    "heading deg",
)
DECISION = "0021-the-tube-around-a-prediction-is-split-conformal-with-the-voyage-as-unit.md"


def _row(hull: str, r: CoverageRow) -> list[str]:
    return [
        hull,
        f"{r.horizon_s:g}",
        r.group,
        str(r.voyages),
        str(r.predictions),
        f"{r.calibrated_on:.0f}",
        _share(r.place_inside, r.place_spread),
        _share(r.heading_inside, r.heading_spread),
        f"{r.place_m:.3g}",
        f"{r.heading_deg:.2g}",
        f"{r.place_score_m:.3g}",
        f"{r.heading_score_deg:.2g}",
    ]


def _beside(hull: str, by: Mapping[str, Sequence[CoverageRow]]) -> list[list[str]]:
    other = {r.horizon_s: r for r in by["reckoning"] if r.group == EVERY}
    pairs = [(m, other[m.horizon_s]) for m in by["model"] if m.group == EVERY and m.horizon_s in other]
    return [
        [
            hull,
            f"{m.horizon_s:g}",
            f"{100 * m.place_inside:.1f} %",
            f"{100 * d.place_inside:.1f} %",
            f"{m.place_m:.3g}",
            f"{d.place_m:.3g}",
            f"{m.heading_deg:.2g}",
            f"{d.heading_deg:.2g}",
        ]
        for m, d in pairs
    ]


def _other(pair: str, r: CoverageRow) -> list[str]:
    return [
        pair,
        f"{r.horizon_s:g}",
        str(r.voyages),
        _share(r.place_inside, r.place_spread),
        _share(r.heading_inside, r.heading_spread),
        f"{r.place_m:.3g}",
        f"{r.heading_deg:.2g}",
    ]


def _share(mean: float, spread: float) -> str:
    return f"{100 * mean:.1f} ± {100 * spread:.0f} %"


def _head(*names: str) -> str:
    return f"| {' | '.join(names)} |\n|{'---|' * len(names)}"


def _lines(blocks: Iterable[Sequence[Sequence[str]]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for rows in blocks for row in rows)
