"""The bound that the loop's own tube tells of a group of runs, tick by tick."""

import numpy as np

from bench.stability.attack.cases import FULL_RUN, MIXED
from bench.stability.attack.run_batch import RunBatch
from bench.stability.attack.waters import Waters
from twin.live.certificate.rolled_tube import RolledTube, tube_of
from twin.live.certificate.set_parts import SetParts
from twin.live.observer.rollback import Path, Pull, Stretch

PULLS = (3, 4, 5, 2)  # places of u, v, r, psi among an observer's states
NOWHERE = (0.0,) * 6


def bounds(w: Waters) -> np.ndarray:
    """(K + 1, 4, N) of u, v, r and the heading. What is exceeded is not told to the tube."""
    seen: dict[tuple[str, float], np.ndarray] = {}
    told = []
    for i, group in enumerate(w.groups):
        # of full ticks all tubes are alike
        key = (group.pattern, 0.0 if group.pattern in (FULL_RUN, *MIXED) else float(i))
        if key not in seen:
            seen[key] = _of(w, i)
        told.append(seen[key])
    return np.repeat(np.stack(told, axis=-1), w.runs, axis=-1)


def _of(w: Waters, i: int) -> np.ndarray:
    tube, h = tube_of(w.c), w.c.h
    told = [(*tube.beta, tube.psi)]
    for k, last in enumerate(w.lasts[:, i] / w.groups[i].excess.tick):
        tube.step(tuple(w.comes[k, :3, i].tolist()), dt=last * h)
        told.append((*tube.beta, tube.psi))
    return np.array(told)


def along_the_way(w: Waters, was: RunBatch, parts: SetParts) -> tuple[np.ndarray, np.ndarray]:
    """Of observers that correct at a sample's own time: bounds as above, each run by the way of its estimate;
    and (K + 1, N) whether that has surely been in the set till then."""
    assert was.motions is not None
    told = np.empty((w.ticks + 1, 4, was.motions.shape[-1]))
    surely = np.ones((w.ticks + 1, told.shape[-1]), bool)
    for i, group in enumerate(w.groups):
        ways = Ways(w, i, group.ages)
        for run in range(i * w.runs, (i + 1) * w.runs):
            tube = RolledTube(w.c, parts=parts)
            told[0, :, run] = *tube.beta, tube.psi
            for k in range(w.ticks):
                tube.follow(ways.path(k, was.motions[k, :, :, run]))
                told[k + 1, :, run] = *tube.beta, tube.psi
                surely[k + 1, run] = surely[k, run] and not tube.left
    return told, surely


class Ways:
    """The ways of observers whose samples of each row are all of one age (0, a half or one tick): each tick
    anew from the tick before."""

    def __init__(self, w: Waters, i: int, ages: tuple[float, ...]) -> None:
        lasts_s = w.lasts[:, i] / w.groups[i].excess.tick * w.c.h
        self.w, self.i, self.ages = w, i, ages
        self.ticks_s = np.concatenate(([0.0], np.cumsum(lasts_s))).tolist()

    def path(self, k: int, motions: np.ndarray) -> Path:
        """(steps, 4) the motions of tick k."""
        steps = [(u, v, r, stream) for u, v, r, stream in motions.tolist()]
        before_s, now_s = self.ticks_s[k], self.ticks_s[k + 1]
        half = len(steps) // 2
        stretches = [
            Stretch(0.5 * (before_s + now_s), steps[:half], self._pulls(k, 0.5), NOWHERE),
            Stretch(now_s, steps[half:], self._pulls(k, 0.0), NOWHERE),
        ]
        if k and (late := self._pulls(k, 1.0)):  # from before the first tick: it is the start
            stretches.insert(0, Stretch(before_s, [], late, NOWHERE))
        return Path(before_s, NOWHERE, stretches)

    def _pulls(self, k: int, age: float) -> list[Pull]:
        comes = self.w.comes[k, :, self.i].tolist()
        return [
            Pull(place, True, 0.0)
            for place, of_row, there in zip(PULLS, self.ages, comes, strict=True)
            if of_row == age and there
        ]
