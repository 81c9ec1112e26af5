"""How far a calibration is: its stages in order, and how long each takes beside the others."""

from collections.abc import Callable
from time import monotonic

SHOWN_FROM = 0.1  # share of the work that must be done before a remaining time means anything
LEAST_LEFT_S = 10.0  # less is not told
# first words of what is told, and seconds of one core for four voyages of twenty minutes at 10 Hz
CORE_STAGES = {
    "fitting the core": 4.1,
    "testing again whether waves": 2.0,
    "testing whether wind": 0.1,
    "testing whether the compass": 0.2,
    "estimating the noise model": 5.5,
    "fitting again with this noise model": 2.1,
}
FIT_STAGES = {"asking how the instruments": 3.8, **CORE_STAGES}
AGAIN = "fitting again, with"  # the core once more, with a part that was found
PATH, ONCE_MORE, BASELINE = (
    "fitting along the path",
    "once more, with every voyage",
    "estimating the baseline",
)


class Stages:
    """Told each stage of a calibration in words; tells it on with which of how many it is, and about how long
    it still takes.

    `every`: how many times as many voyages the second fit has as the first [1]; None where there is one fit.
    """

    def __init__(
        self,
        tell: Callable[[str], None],
        every: float | None,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        self._tell, self._clock, self._began = tell, clock, clock()
        second = [] if every is None else [(ONCE_MORE, 0.0), *((s, every * w) for s, w in FIT_STAGES.items())]
        self._plan = [*FIT_STAGES.items(), (PATH, 1.0), *second, (BASELINE, 7.5 * (every or 1.0))]
        self._at = -1

    def __call__(self, text: str) -> None:
        if text.startswith(AGAIN):  # in place of what was left of the core as it was
            rest = self._plan[self._at + 1 :]
            while rest and rest[0][0] in CORE_STAGES:
                rest = rest[1:]
            self._plan[self._at + 1 :] = [(AGAIN, 0.0), *CORE_STAGES.items(), *rest]
        later = range(self._at + 1, len(self._plan))
        found = next((i for i in later if text.startswith(self._plan[i][0])), None)
        if found is None:
            return self._tell(text)
        self._at = found
        self._tell(f"{text} ({found + 1} of {len(self._plan)}{self._left()})")

    def _left(self) -> str:
        """About how long the other stages take; "" where that is not known yet, or nearly nothing."""
        done = sum(w for _, w in self._plan[: self._at])
        every = sum(w for _, w in self._plan)
        if done < SHOWN_FROM * every:
            return ""
        left_s = (self._clock() - self._began) * (every - done) / done
        if left_s < LEAST_LEFT_S:
            return ""
        return f", about {left_s:.0f} s left" if left_s < 90.0 else f", about {left_s / 60.0:.0f} min left"
