"""How far a calibration is: its stages in order, and how long they still take, by what this run took."""

from collections.abc import Callable, Container, Sequence
from itertools import takewhile
from time import monotonic
from typing import NamedTuple

from twin.recording.progress import Progress

SHOWN_FROM = 0.1  # share of the work that must be done before a remaining time means anything
LEAST_LEFT_S = 10.0  # less is not told
CORE, SEA, NOISE_MODEL = "fitting the core", "testing again whether waves", "estimating the noise model"
# shares of its time, where an earlier fit found from where to begin: its gear is not asked again
BEGUN_NEAR = {CORE: 0.4, NOISE_MODEL: 0.3}
# first words of what is told, and seconds of one core for four voyages of twenty minutes at 10 Hz
CORE_STAGES = {
    CORE: 4.5,
    SEA: 2.0,
    "testing whether wind or little water": 0.1,
    "testing whether the compass": 0.4,
    NOISE_MODEL: 10.5,
    "fitting again with this noise model": 2.8,
}
INSTRUMENTS = "asking how the instruments"
FIT_STAGES = {INSTRUMENTS: 3.6, **CORE_STAGES}
AGAIN = "fitting again, with"  # the core once more, with a part that was found
PATH, ONCE_MORE, BASELINE = (
    "fitting along the path",
    "once more, with every voyage",
    "estimating the baseline",
)


class Planned(NamedTuple):
    """A stage that is to come, or was."""

    words: str  # the first ones of what is told
    usual_s: float  # how long it takes for four voyages of twenty minutes
    every: float = 1.0  # times as many voyages as the first fit has


class Stages:
    """Told each stage of a calibration in words; tells it on with which of how many it is, and about how long
    it still takes: a stage that this run has had before, as long as it took then; any other its usual seconds
    times by how much slower than usual those were that this run has had.

    `every`: how many times as many voyages the second fit has as the first [1]; None where there is one fit.
    """

    def __init__(
        self,
        tell: Progress,
        every: float | None,
        clock: Callable[[], float] = monotonic,
    ) -> None:
        self._tell, self._clock, self._began, self._every = tell, clock, clock(), every or 1.0
        first = [Planned(*stage) for stage in FIT_STAGES.items()]
        second = [] if every is None else [Planned(ONCE_MORE, 0.0), *_near(first, self._every)]
        self._plan = [*first, Planned(PATH, 1.0), *second, Planned(BASELINE, 8.5, self._every)]
        self._at = -1
        self._took: dict[
            str, float
        ] = {}  # [s] of a stage when it was last done, with the first fit's voyages

    def __call__(self, text: str) -> None:
        if text.startswith(AGAIN):
            self._begun_again()
        later = range(self._at + 1, len(self._plan))
        found = next((i for i in later if text.startswith(self._plan[i].words)), None)
        if found is None:
            return self._tell(text)
        self._end_stage()
        self._at = found
        self._tell(f"{text} ({found + 1} of {len(self._plan)}{self._left()})")

    def _begun_again(self) -> None:
        """The core once more, in place of what was left of it as it was. A second fit begins with the part
        that was found."""
        done, rest = self._plan[: self._at + 1], self._plan[self._at + 1 :]
        left = list(takewhile(lambda p: p.words in (AGAIN, *CORE_STAGES), rest))
        if any(p.words == AGAIN for p in left):
            return
        every = done[-1].every if done else 1.0
        core = [Planned(*stage) for stage in CORE_STAGES.items()]
        found = {p.words for p in done}
        self._plan = [*done, Planned(AGAIN, 0.0, every), *_near(core, every, found), *rest[len(left) :]]

    def _end_stage(self) -> None:
        """The stage that is told now ends the one before."""
        now = self._clock()
        if self._at >= 0:
            p = self._plan[self._at]
            self._took[p.words] = (now - self._began) / p.every
        self._began = now

    def _left(self) -> str:
        """About how long this stage and the rest take; "" where that is not known yet, or nearly nothing."""
        done, rest = self._plan[: self._at], self._plan[self._at :]
        usual_s = sum({p.words: p.usual_s for p in done if p.words in self._took}.values())
        if not usual_s or _usual_s(done) < SHOWN_FROM * _usual_s(self._plan):
            return ""
        slower = sum(self._took.values()) / usual_s
        left_s = sum(p.every * self._took.get(p.words, slower * p.usual_s) for p in rest)
        if left_s < LEAST_LEFT_S:
            return ""
        return f", about {left_s:.0f} s left" if left_s < 90.0 else f", about {left_s / 60.0:.0f} min left"


def _near(stages: Sequence[Planned], every: float, found: Container[str] = BEGUN_NEAR) -> list[Planned]:
    """The same, `every` times as much of each, begun from where those that are `found` ended: in the sea as
    it is beside that core."""
    in_order = sorted(stages, key=lambda p: (INSTRUMENTS, SEA, p.words).index(p.words))
    shares = [BEGUN_NEAR.get(p.words, 1.0) if p.words in found else 1.0 for p in in_order]
    return [p._replace(every=every * k * p.every) for p, k in zip(in_order, shares, strict=True)]


def _usual_s(stages: Sequence[Planned]) -> float:
    return sum(p.every * p.usual_s for p in stages)
