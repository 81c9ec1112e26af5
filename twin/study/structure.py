"""The structural floor of a ship: how much a calibrated model of this kind still leaves unexplained, found on reference voyages.

Each number of the Floor is the one under which the reference voyages are most probable, the core's own uncertainty integrated
out (type-II maximum likelihood; Rasmussen & Williams 2006, sec. 5.4), searched on a geometric grid, one number at a time.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from .columns import Unknown
from .fit import evidence
from .innovations import Floor, Linear, innovate

STEPS = (0.5, 2.0)
BOUNDS = {"share": (0.005, 0.5), "calm": (0.1, 4.0), "white": (0.002, 1.0), "flow": (0.0005, 0.05), "sensor": (0.7, 4.0)}


def structural_floor(lines: Sequence[Linear], unknowns: Sequence[Unknown], start: Floor = Floor(), temper: float = 1.0) -> Floor:
    """The most probable floor of these reference voyages (linearised about the fitted model)."""
    sd = np.array([u.sd for u in unknowns])

    def score(floor: Floor) -> float:
        return evidence(innovate(lines, [floor])[0], sd) / temper

    floor, best = start, score(start)
    for name, change in (*_numbers(), *_numbers()):
        floor, best = _climb(floor, best, name, change, score)
    return floor


def _numbers() -> list[tuple[str, Callable[[Floor, float], Floor]]]:
    def share(i: int) -> Callable[[Floor, float], Floor]:
        return lambda f, k: replace(f, share=tuple(s * k if j == i else s for j, s in enumerate(f.share)))

    def single(name: str) -> Callable[[Floor, float], Floor]:
        return lambda f, k: replace(f, **{name: getattr(f, name) * (k**0.5 if name == "sensor" else k)})

    return [("share", share(i)) for i in range(3)] + [(n, single(n)) for n in ("calm", "white", "flow", "sensor")]


def _climb(floor: Floor, best: float, name: str, change: Callable[[Floor, float], Floor], score: Callable[[Floor], float]) -> tuple[Floor, float]:
    """Walk one number up or down while the voyages become more probable."""
    for step in STEPS:
        walked = False
        while _inside(trial := change(floor, step), name):
            value = score(trial)
            if value <= best + 1e-6:
                break
            floor, best, walked = trial, value, True
        if walked:
            break
    return floor, best


def _inside(floor: Floor, name: str) -> bool:
    lo, hi = BOUNDS[name]
    values = getattr(floor, name)
    return all(lo <= v <= hi for v in (values if isinstance(values, tuple) else (values,)))
