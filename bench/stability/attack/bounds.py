"""The bound that the loop's own tube tells of a group of runs, tick by tick."""

import numpy as np

from bench.stability.attack.cases import FULL_RUN
from bench.stability.attack.waters import Waters
from twin.live.certificate.rolled_tube import RolledTube, tube_of
from twin.live.observer.rollback import Path, Pull, Stretch

PULLS = (3, 4, 5, 2)  # places of u, v, r, psi among an observer's states
NOWHERE = (0.0,) * 6


def bounds(w: Waters) -> np.ndarray:
    """(K + 1, 4, N) of u, v, r and the heading. What is exceeded is not told to the tube."""
    seen: dict[tuple[str, float], np.ndarray] = {}
    told = []
    for i, group in enumerate(w.groups):
        # of full ticks all tubes are alike but for the ages that an observer corrects at
        key = (
            group.pattern,
            (group.delay if w.c.inner > 1 else 0.0) if group.pattern == FULL_RUN else float(i),
        )
        if key not in seen:
            seen[key] = _of(w, i)
        told.append(seen[key])
    return np.repeat(np.stack(told, axis=-1), w.runs, axis=-1)


def _of(w: Waters, i: int) -> np.ndarray:
    tube, h, group = tube_of(w.c), w.c.h, w.groups[i]
    told = [(*tube.beta, tube.psi)]
    lasts = w.lasts[:, i] / group.excess.tick
    if isinstance(tube, RolledTube):
        paths = _paths(w, i, lasts * h, group.delay)
        for path in paths:
            tube.follow(path)
            told.append((*tube.beta, tube.psi))
        return np.array(told)
    for k, last in enumerate(lasts):
        tube.step(tuple(w.comes[k, :3, i].tolist()), dt=last * h)
        told.append((*tube.beta, tube.psi))
    return np.array(told)


def _paths(w: Waters, i: int, lasts_s: np.ndarray, age: float) -> list[Path]:
    """The way of an observer whose samples are all of one age (0, a half or one tick): each tick anew from
    the moment of its samples."""
    ticks_s = np.concatenate(([0.0], np.cumsum(lasts_s)))
    u, v, r = (0.5 * sum(w.c.operating.ranges[name]) for name in ("u", "v", "r"))
    still = u, v, r
    paths = []
    for k in range(w.ticks):
        pulls = [
            Pull(place, True, 0.0) for place, comes in zip(PULLS, w.comes[k, :, i], strict=True) if comes
        ]
        now_s = float(ticks_s[k + 1])
        taken_s = float(ticks_s[k]) if age == 1.0 else now_s - age * float(lasts_s[k])
        if age == 1.0 and k == 0:
            pulls = []  # from before the first tick: it is the start
        start_s = float(ticks_s[k])
        stretches = []
        if age == 0.0:
            stretches = [Stretch(now_s, [still] * w.c.inner, pulls, NOWHERE)]
        elif age < 1.0:
            steps = int(np.ceil(0.5 * w.c.inner))
            stretches = [
                Stretch(taken_s, [still] * steps, pulls, NOWHERE),
                Stretch(now_s, [still] * steps, [], NOWHERE),
            ]
        else:
            stretches = [
                Stretch(taken_s, [], pulls, NOWHERE),
                Stretch(now_s, [still] * w.c.inner, [], NOWHERE),
            ]
        paths.append(Path(start_s, NOWHERE, stretches))
    return paths
