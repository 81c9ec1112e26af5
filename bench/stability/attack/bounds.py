"""The bound that the loop's own tube tells of a group of runs, tick by tick."""

import numpy as np

from bench.stability.attack.cases import FULL_RUN, MIXED
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
            (group.delay if w.c.inner > 1 else 0.0) if group.pattern in (FULL_RUN, *MIXED) else float(i),
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
        paths = _paths(w, i, lasts * h, group.ages)
        for path in paths:
            tube.follow(path)
            told.append((*tube.beta, tube.psi))
        return np.array(told)
    for k, last in enumerate(lasts):
        tube.step(tuple(w.comes[k, :3, i].tolist()), dt=last * h)
        told.append((*tube.beta, tube.psi))
    return np.array(told)


def _paths(w: Waters, i: int, lasts_s: np.ndarray, ages: tuple[float, ...]) -> list[Path]:
    """The way of an observer whose samples of each row are all of one age (0, a half or one tick): each tick
    anew from the tick before."""
    ticks_s = np.concatenate(([0.0], np.cumsum(lasts_s)))
    u, v, r = (0.5 * sum(w.c.operating.ranges[name]) for name in ("u", "v", "r"))
    cut = 0.5 in ages
    steps = int(np.ceil(0.5 * w.c.inner)) if cut else w.c.inner
    paths = []
    for k in range(w.ticks):

        def pulls(age: float, k: int = k) -> list[Pull]:
            return [
                Pull(place, True, 0.0)
                for place, of_row, comes in zip(PULLS, ages, w.comes[k, :, i], strict=True)
                if of_row == age and comes
            ]

        before_s, now_s = float(ticks_s[k]), float(ticks_s[k + 1])
        motions = [(u, v, r)] * steps
        stretches = [Stretch(now_s, motions, pulls(0.0), NOWHERE)]
        if cut:
            stretches.insert(0, Stretch(now_s - 0.5 * float(lasts_s[k]), motions, pulls(0.5), NOWHERE))
        if k and pulls(1.0):  # from before the first tick: it is the start
            stretches.insert(0, Stretch(before_s, [], pulls(1.0), NOWHERE))
        paths.append(Path(before_s, NOWHERE, stretches))
    return paths
