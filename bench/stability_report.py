"""What `twin-bench stability` prints: the slopes, the gains, the runs and how tight the bound was, as Markdown."""

import argparse
from math import degrees, isfinite
from typing import Any

from twin.live import certificate as cert
from twin.live.enclosure import sampled, slopes
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load

SHIPS = ("kvlcc2", "container", "kvlcc2_model", "usv")
UNITS = "m/s, m/s, deg/s"


def tables(rows: list[tuple[Any, ...]], args: argparse.Namespace) -> str:
    """The whole page."""
    runs, broken = sum(o.runs for _, _, o, _ in rows), sum(o.violations for _, _, o, _ in rows)
    left = sum(o.left for _, _, o, _ in rows)
    return "\n".join(
        [
            "# The stabilizer's certificate, tried",
            "",
            f"`twin-bench stability --runs {args.runs} --seed {args.seed}` ({sum(o.seconds for _, _, o, _ in rows):.0f} s here)",
            "",
            f"**{broken} violations in {runs} runs** ({sum(o.samples for _, _, o, _ in rows)} samples inside the operating set; "
            f"{left} runs left it and were judged until then). Theorem and adversaries: `docs/stability.md`.",
            "",
            "## Runs",
            "Error over bound: of the live tube (1.0 = touched), and of the ultimate bound b. bound/seen = b over the greatest error met, by axis.",
            "",
            "| ship | Hz | samples late | H_s m | drop-outs | K 1/s | runs | left | broken | b (" + UNITS + ") | greatest error/tube | bound/seen |",
            "|---|---|---|---|---|---|---|---|---|---|---|---|",
            *[_run(*row) for row in rows],
            "",
            "With drop-outs the error may exceed b, which counts on measurements; the tube must hold, and does.",
            "",
            "## Slopes and gains",
            "Width of the sure slopes over that of 20 000 sampled ones (half of them corners), worst and mean entry; K by the same number on each axis.",
            "",
            "| ship | sure/sampled: worst | mean | least K 1/s, continuous | x L/U_0 | 10 Hz, 0 late | 10 Hz, 1 late | 50 Hz, 0 late | 50 Hz, 1 late |",
            "|---|---|---|---|---|---|---|---|---|",
            *[_ship(name) for name in SHIPS],
            "",
        ]
    )


def _run(case: Any, c: Any, o: Any, made: float) -> str:
    b = c.bound_in(case.H_s)
    seen = " / ".join(f"{1.0 / x:.1f}" if x > 0.0 else "-" for x in o.of_bound)
    tube = " / ".join(f"{x:.2f}" for x in o.of_tube)
    return (
        f"| {case.ship} | {case.rate_hz:g} | {'/'.join(map(str, case.delays))} | {case.H_s:g} | {'yes' if case.dropouts else 'no'} | {c.K[0]:.3g} | {o.runs} | "
        f"{o.left} | {o.violations} | {b[0]:.3f}, {b[1]:.3f}, {degrees(b[2]):.3f} | {tube} | {seen} |"
    )


def _ship(name: str) -> str:
    model = Model.of(load(name))
    model = model.but(find("Wind").plausible(model.ship))
    operating = cert.of_ship(model)
    worst, mean = widening(model, operating)
    plant, time = cert.plant_of(model, operating, 1e-6), model.ship.scale("time")
    least = cert.assess(plant, (1.0, 1.0, 1.0), (0, 0, 0), (0.0, 0.0, 0.0), cert.Disturbance((0.0, 0.0, 0.0)))
    k = 1.0 - least.margin
    cells = [_limits(model, operating, h, m) for h in (0.1, 0.02) for m in (0, 1)]
    return f"| {name} | {worst:.2f} | {mean:.2f} | {k:.3g} | {k * time:.1f} | " + " | ".join(cells) + " |"


def _limits(model: Model, operating: cert.OperatingSet, h: float, m: int) -> str:
    found = cert.gains_that_do(cert.plant_of(model, operating, h), (m, m, m))
    return f"{found[0]:.3g} to {found[1]:.3g}" if found else "none"


def widening(model: Model, operating: cert.OperatingSet) -> tuple[float, float]:
    """Worst and mean ratio of the sure range of a slope to the sampled one, over the nine slopes with u, v, r."""
    ranges = {**operating.ranges, "stream": (0.0, 0.0)}  # what a current adds is exact
    sure, seen = slopes(model, ranges), sampled(model, ranges)
    ratios = [(sure.hi[i][j] - sure.lo[i][j]) / (seen.hi[i][j] - seen.lo[i][j]) for i in range(3) for j in range(3)]
    ratios = [x for x in ratios if isfinite(x)]
    return max(ratios), sum(ratios) / len(ratios)
