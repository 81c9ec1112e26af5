"""Which gains K the period and the delay allow, and which of them to take."""

from collections.abc import Sequence
from math import sqrt
from typing import Any

from twin.errors import SettingsError
from twin.live.certificate import comparison_systems as c3
from twin.live.certificate.comparison_systems import AXES, Matrix, Row
from twin.live.certificate.plant import Disturbance, Plant
from twin.live.certificate.recursion import NEVER, Ages, pushed, recursion
from twin.live.observer.operating import NU
from twin.physics.maths import total

GAIN_MARGIN = 3.0  # times the least K: what the loop's own is at least


def gains_that_do(plant: Plant, m: Ages, extra: Matrix | None = None) -> tuple[float, float] | None:
    """The least and the greatest uniform K that the period and the delay allow [1/s]; None: there is none."""

    def holds(k: float) -> bool:
        return c3.contracts(recursion(plant, (k, k, k), m, extra).G)

    grid = [10.0 ** (-6.0 + 0.05 * i) / plant.h for i in range(124)]
    good = [k for k in grid if holds(k)]
    if not good:
        return None
    return _edge(holds, good[0], good[0] / 1.2), _edge(holds, good[-1], good[-1] * 1.2)


def usual_gain(plant: Plant, m: Ages, extra: Matrix | None = None) -> Row | None:
    """A K to begin with: four times the least, or the middle of what is allowed if that is less."""
    limits = gains_that_do(plant, m, extra)
    if limits is None:
        return None
    k = min(4.0 * limits[0], sqrt(limits[0] * limits[1]))
    return k, k, k


def suited_gain(plant: Plant, m: Ages, usual: float, fastest: float) -> Row:
    """The loop's K: the usual one, or three times the least if that is more, so that a third of it would do;
    not above the middle of what is allowed, nor above what the loop lets act. The usual one where none
    holds."""
    limits = gains_that_do(plant, m)
    k = usual
    if limits is not None and limits[0] < fastest:
        k = min(max(usual, GAIN_MARGIN * limits[0]), sqrt(limits[0] * limits[1]), fastest)
    return k, k, k


def best_gain(
    plant: Plant, m: Ages, noise: Row, d: Disturbance, H_s: float = 0.0, extra: Matrix | None = None
) -> Row | None:
    """The K with the smallest bound against hostile noise and disturbance, each axis in units of its range;
    None when none is certified.
    """
    limits = gains_that_do(plant, m, extra)
    if limits is None:
        return None
    width = [hi - lo for lo, hi in (plant.operating.ranges[n] for n in NU)]
    push, calm = pushed(plant, 0.0)
    during = c3.add(c3.apply(push, d.at(H_s)), calm)

    def size(K: Row) -> float:
        step = recursion(plant, K, m, extra)
        end = c3.settled(step.G)
        if end is None:
            return NEVER
        g = c3.add(c3.apply(step.share(), during), c3.apply(c3.diagonal(step.heard), noise))
        return total(b / w for b, w in zip(c3.apply(end, g), width, strict=True))

    uniform: list[Row] = [(k, k, k) for k in _between(*limits)]
    K = min(uniform, key=size)
    for factor in (1.5, 1.2, 1.07):
        for _ in range(6):
            trials: list[Row] = [K] + [_one_changed(K, i, f) for i in AXES for f in (factor, 1.0 / factor)]
            better = min(trials, key=size)
            if better == K:
                break
            K = better
    return K


def _one_changed(K: Row, axis: int, factor: float) -> Row:
    u, v, r = (k * factor if i == axis else k for i, k in enumerate(K))
    return u, v, r


def _edge(holds: Any, good: float, bad: float) -> float:
    for _ in range(30):
        middle = sqrt(good * bad)
        good, bad = (middle, bad) if holds(middle) else (good, middle)
    return good


def _between(low: float, high: float, count: int = 25) -> list[float]:
    return [low * (high / low) ** (i / (count + 1.0)) for i in range(1, count + 1)]


def three(K: float | Sequence[float]) -> list[float]:
    """By axis; one number is that of each."""
    return [K] * 3 if isinstance(K, (int, float)) else [*K]


def check(K: Sequence[float], h: float, m: Sequence[int], noise: Sequence[float]) -> None:
    """SettingsError where one of these is no gain, period, delay or noise."""
    if (
        not len(K) == len(noise) == len(m) == 3
        or not all(0.0 <= x < float("inf") for x in (*K, h, *m, *noise))
        or not h > 0.0
        or not all(k > 0.0 for k in K)
    ):
        raise SettingsError(
            f"stabilizer: K = {tuple(K)}, period {h} s, delay {tuple(m)} samples, noise {tuple(noise)}: "
            "three positive gains, a positive period, no negative number are needed. Correct the settings."
        )
