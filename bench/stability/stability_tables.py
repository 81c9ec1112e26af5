"""What `twin-bench stability` prints: the slopes, the gains, the runs and how tight the bound was, as
Markdown.
"""

import argparse
from collections.abc import Iterable
from math import degrees, isfinite
from typing import Any

from twin.live.certificate import certificate as cert
from twin.live.certificate.enclosure import sampled, slopes
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load

SHIPS = ("kvlcc2", "container", "kvlcc2_model", "usv")
UNITS = "m/s, m/s, deg/s"
RUNS = (
    "ship",
    "Hz",
    "samples late",
    "H_s m",
    "drop-outs",
    "K 1/s",
    "runs",
    "left",
    "broken",
    "b",
    "error/tube",
    "b/seen",
    "numbers moved",
)


LOOPS = (
    "ship",
    "Hz",
    "H_s m",
    "drop-outs",
    "K 1/s",
    "runs",
    "ticks",
    "inside",
    "broken",
    "b",
    "error/tube",
    "b/seen",
)


def tables(rows: list[tuple[Any, ...]], loops: list[tuple[Any, ...]], args: argparse.Namespace) -> str:
    """The whole page."""
    runs, left, broken, samples, seconds = _sums(rows, "runs", "left", "violations", "samples", "seconds")
    own_runs, own_broken, own_samples, own_seconds = _sums(loops, "runs", "violations", "samples", "seconds")
    return f"""# The stabilizer's certificate, tried

`twin-bench stability --runs {args.runs} --seed {args.seed}` ({seconds + own_seconds:.0f} s here)

**{broken} violations in {runs} runs** ({samples} samples inside the operating set; {left} runs left it and
were judged until then) of an observer as the theorem has it. **{own_broken} violations in {own_runs} runs of
the twin's own loop** ({own_samples} ticks of which it said that its certificate holds). Theorem and
adversaries: `docs/stability.md`, `bench/stability/adversaries.py`.

## Runs
b: the ultimate bound ({UNITS}). Error/tube: the greatest error in units of the live bound, by axis
(1 = touched). b/seen: the ultimate bound over the greatest error met.

{_head(*RUNS)}
{_lines(_run(*row) for row in rows)}

Numbers moved: those of these effects, by the adversary, anywhere in the boxes of adaptation
(twin/live/learning/movable.py). With drop-outs the error may exceed b, which counts on measurements; the tube
must hold, and does.

## The loop itself
The twin's own sensors, gates, observer, guard and tube (`bench/stability/adversary_loop.py`), fed
with the readings of the same hostile ships once in each tick (every other ship's half a sample late), at the
K, delay and noise that it would take on board; no wind, no current, network and adaptation off; in waves with
the rudder hard over. Inside: the share of ticks in which it said that its certificate holds; only those are
judged, for of others it promises nothing.

{_head(*LOOPS)}
{_lines(_loop(*row) for row in loops)}

## Slopes and gains
Width of the sure slopes over that of 20 000 sampled ones (half of each coordinate on its ends), and the K
that would do, the same on every axis, in 1/s.

{_head("ship", "widest/sampled", "mean", "least K, continuous", "x L/U_0", *_columns())}
{_lines(_ship(name) for name in SHIPS)}
"""


def _columns() -> list[str]:
    return [f"{hz} Hz, {late} late" for hz in (10, 50) for late in (0, 1)]


def _head(*names: str) -> str:
    return f"| {' | '.join(names)} |\n|{'---|' * len(names)}"


def _lines(rows: Iterable[list[str]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _sums(rows: list[tuple[Any, ...]], *names: str) -> list[Any]:
    return [sum(getattr(o, name) for _, _, o in rows) for name in names]


def _loop(case: Any, c: Any, o: Any) -> list[str]:
    u, v, r = c.bound_in(case.H_s)
    bound, ticks = f"{u:.3f}, {v:.3f}, {degrees(r):.3f}" if c.ok else "no K like this holds", o.runs * o.steps
    return [
        case.ship,
        f"{case.rate_hz:g}",
        f"{case.H_s:g}",
        "yes" if case.dropouts else "no",
        f"{c.K[0]:.3g}",
        str(o.runs),
        str(ticks),
        f"{100.0 * o.samples / ticks:.0f} %",
        str(o.violations),
        bound,
        " / ".join(f"{x:.2f}" for x in o.of_tube) if o.samples else "-",
        _seen(o),
    ]


def _seen(o: Any) -> str:
    """The ultimate bound over the greatest error met, by axis."""
    return " / ".join(f"{1.0 / x:.1f}" if x > 0.0 else "-" for x in o.of_bound)


def _run(case: Any, c: Any, o: Any) -> list[str]:
    u, v, r = c.bound_in(case.H_s)
    return [
        case.ship,
        f"{case.rate_hz:g}",
        "/".join(map(str, case.delays)),
        f"{case.H_s:g}",
        "yes" if case.dropouts else "no",
        f"{c.K[0]:.3g}",
        str(o.runs),
        str(o.left),
        str(o.violations),
        f"{u:.3f}, {v:.3f}, {degrees(r):.3f}",
        " / ".join(f"{x:.2f}" for x in o.of_tube),
        _seen(o),
        ", ".join((*case.moving, "Wind")) if case.moving else "none",
    ]


def _ship(name: str) -> list[str]:
    model = Model.of(load(name))
    model = model.but(find("Wind").plausible(model.ship))
    operating = cert.of_ship(model)
    worst, mean = widening(model, operating)
    plant, time = cert.plant_of(model, operating, 1e-6), model.ship.scale("time")
    least = cert.assess(plant, (1.0, 1.0, 1.0), (0, 0, 0), (0.0, 0.0, 0.0), cert.Disturbance((0.0, 0.0, 0.0)))
    k = 1.0 - least.margin
    limits = [_limits(model, operating, 1.0 / hz, late) for hz in (10, 50) for late in (0, 1)]
    return [name, f"{worst:.2f}", f"{mean:.2f}", f"{k:.3g}", f"{k * time:.1f}", *limits]


def _limits(model: Model, operating: cert.OperatingSet, h: float, m: int) -> str:
    found = cert.gains_that_do(cert.plant_of(model, operating, h), (m, m, m))
    return f"{found[0]:.3g} to {found[1]:.3g}" if found else "none"


def widening(model: Model, operating: cert.OperatingSet) -> tuple[float, float]:
    """Worst and mean ratio of the sure range of a slope to the sampled one, over the nine slopes with u, v,
    r.
    """
    ranges = {**operating.ranges, "stream": (0.0, 0.0)}  # what a current adds is exact
    sure, seen = slopes(model, ranges), sampled(model, ranges)
    ratios = [
        (sure.hi[i][j] - sure.lo[i][j]) / (seen.hi[i][j] - seen.lo[i][j]) for i in range(3) for j in range(3)
    ]
    ratios = [x for x in ratios if isfinite(x)]
    return max(ratios), sum(ratios) / len(ratios)
