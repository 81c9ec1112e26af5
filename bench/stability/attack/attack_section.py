"""What `twin-bench stability --attack` prints, as Markdown."""

from collections.abc import Sequence
from math import degrees

import numpy as np

from bench.stability.attack.adversary_search import RANDOM, Attacked, CaseAttacked
from bench.stability.attack.cases import DELAYS, EXCESSES, FACTORS, MIXED, Excess
from bench.stability.attack.section import HEAD

INSIDE = (
    "| ship | Hz | certificate | K 1/s | b | sample's age | runs | left | broken | error/tube | error/b "
    "| at random |"
)
MIXED_AGES = (
    "| ship | Hz | certificate | age of u, v, r, psi in ticks | b, ages alike | b' | runs | broken "
    "| error/tube | error/b' |"
)
OUTSIDE = "| ship | Hz | certificate |"


def section(found: Sequence[CaseAttacked], command: str) -> str:
    """The whole part of the page."""
    groups = [g for x in found for g in x.groups]
    inside = [g for g in groups if g.group.inside]
    broken, samples = (sum(getattr(g, name) for g in inside) for name in ("violations", "samples"))
    runs = sum(g.runs for g in inside)
    least, most, gain = _tightness(found)
    lines = [
        HEAD,
        "",
        f"`{command}` ({sum(x.seconds for x in found):.0f} s of processor time)",
        "",
        f"**{broken} violations in {runs} runs inside the assumptions** ({samples} samples), by adversaries "
        "that know ship and observer;",
        f"{sum(g.runs for g in groups) - runs} more runs exceed one assumption or all. Each run is attacked "
        "at random, then greedily (all pushes the way the error has), then along the adjoint of its own "
        "linearised error, then from better places (`bench/stability/attack/`).",
        "",
        "### Inside",
        "",
        "b: the ultimate bound (m/s, m/s, deg/s). Sample's age: at most, in samples. Error/tube and error/b: "
        "the greatest error over the live and the ultimate bound, by axis; the first with short ticks and "
        "lost samples too. At random: error/b of the random runs among them. On board: the certificate that "
        "the loop takes (its own delay, the heading estimated); as far as it reaches: of a turn beyond the "
        "usual set (docs/stability.md, 4c); late n: that of Theorem 2 as in Runs above.",
        f"Over all rows b is {_list(least)} to {_list(most)} times the greatest error met (u, v, r), and the "
        f"adversary's error {_list(gain)} times that of the random runs (median).",
        "",
        *_table(INSIDE, [row for x in found for row in _inside(x)]),
        "",
        "### Samples of different ages",
        "",
        "Of observers that correct a sample at its own time (Theorem 3), in every tick a sample of each row. "
        "b': the ultimate bound that covers any ages up to a tick.",
        "",
        *_table(MIXED_AGES, [row for x in found for row in _mixed(x)]),
        "",
        "### Outside",
        "",
        f"The least factor tried ({', '.join(f'{f:g}' for f in FACTORS)}) over the limit at which the "
        "live bound was broken, and in brackets the greatest error over it at the greatest factor. Samples "
        "are at most as old as allowed, but for `delay` and `all`.",
        "",
        *_table(OUTSIDE + "".join(f" {name} |" for name in EXCESSES), [_outside(x) for x in found]),
        "",
        _teeth(found),
        "",
    ]
    return "\n".join(lines)


def _table(head: str, rows: list[list[str]]) -> list[str]:
    return [head, "|" + "---|" * (head.count("|") - 1), *(f"| {' | '.join(row)} |" for row in rows)]


def _inside(x: CaseAttacked) -> list[list[str]]:
    rows = []
    for delay in DELAYS if x.delay else DELAYS[:1]:
        some = [
            g
            for g in x.groups
            if g.group.inside and g.group.pattern not in MIXED and (g.group.delay == delay or not x.delay)
        ]
        u, v, r = x.bound
        rows.append(
            [
                *_name(x),
                f"{x.K:.3g}",
                f"{u:.3f}, {v:.3f}, {degrees(r):.3f}",
                f"{delay * x.delay:g}",
                str(sum(g.runs for g in some)),
                str(sum(g.left for g in some)),
                str(sum(g.violations for g in some)),
                _ratios(np.max([g.of_tube for g in some], axis=0)),
                _ratios(np.max([g.of_bound for g in some], axis=0)),
                _ratios(np.max([g.by_pass[RANDOM] for g in some if g.full], axis=0)),
            ]
        )
    return rows


def _mixed(x: CaseAttacked) -> list[list[str]]:
    rows = []
    for g in (g for g in x.groups if g.group.pattern in MIXED):
        u, v, r = g.bound or (np.inf,) * 3
        rows.append(
            [
                *_name(x),
                ", ".join(f"{age:g}" for age in g.group.ages),
                f"{x.bound[0]:.3f}, {x.bound[1]:.3f}, {degrees(x.bound[2]):.3f}",
                f"{u:.3f}, {v:.3f}, {degrees(r):.3f}" if g.bound else "none",
                str(g.runs),
                str(g.violations),
                _ratios(g.of_tube),
                _ratios(g.of_bound) if g.bound else "",
            ]
        )
    return rows


def _name(x: CaseAttacked) -> list[str]:
    return [
        x.case.ship,
        f"{x.case.rate_hz:g}",
        x.case.name + (f", {x.inner} inner steps" if x.inner > 1 else ""),
    ]


def _outside(x: CaseAttacked) -> list[str]:
    return [*_name(x), *(_first(x, name) for name in EXCESSES)]


def _first(x: CaseAttacked, name: str) -> str:
    by_factor = [exceeded(x, name, f) for f in FACTORS]
    least = next((f"{f:g}" for f, g in zip(FACTORS, by_factor, strict=True) if g.violations), "none")
    return f"{least} ({by_factor[-1].of_tube.max():.2f})"


def exceeded(x: CaseAttacked, name: str, factor: float) -> Attacked:
    """The runs of a case that exceed this by that factor."""
    excess = Excess()._replace(**dict.fromkeys(EXCESSES[name], factor))
    return next(g for g in x.groups if g.group.excess == excess)


def _tightness(found: Sequence[CaseAttacked]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """By axis: the least and the greatest of b over the greatest error met, by case; the median gain over
    the random runs."""
    met, by_chance = [], []
    for x in found:
        full = [g for g in x.groups if g.group.inside and g.full]
        met.append(np.max([g.of_bound for g in full], axis=0))
        by_chance.append(np.max([g.by_pass[RANDOM] for g in full], axis=0))
    return 1.0 / np.max(met, axis=0), 1.0 / np.min(met, axis=0), np.median(np.array(met) / by_chance, axis=0)


def _teeth(found: Sequence[CaseAttacked]) -> str:
    """How many certificates each excess broke at the greatest factor."""
    most = FACTORS[-1]
    counts = {name: sum(exceeded(x, name, most).violations > 0 for x in found) for name in EXCESSES}
    told = ", ".join(f"{name} {count} of {len(found)}" for name, count in counts.items())
    return f"At {most:g} times the limit the live bound was broken by: {told}."


def _ratios(x: np.ndarray) -> str:
    return " / ".join(f"{y:.2f}" for y in x)


def _list(x: np.ndarray) -> str:
    return ", ".join(f"{y:.1f}" for y in x)
