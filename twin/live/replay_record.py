"""What a replay keeps for its page: state, predictions, health and weights over time, in bounded memory."""

import hashlib
from array import array
from collections.abc import Iterable
from math import hypot, nan
from typing import Any

from twin.live.guard import INVALID
from twin.live.loop import Loop
from twin.live.observer.estimate import STATES
from twin.live.prediction.coverage import entry
from twin.live.prediction.due_predictions import Watch
from twin.live.prediction.judge import VerifiedPrediction
from twin.live.seen import Seen

MOMENTS_KEPT = 24_000  # moments that are kept; of a longer voyage every second, fourth, ...
AHEAD = (*STATES, "place", "turn", "held", "radius", "half_turn", "level")
GAP_TICKS = 15  # a reason that is away for less is still there
SPANS = 300  # of one reason; where it comes and goes oftener, short absences count as presence


class Kept:
    """Columns of numbers over time that let every second row go when there are too many."""

    def __init__(self, names: Iterable[str]):
        self.columns = {name: array("d") for name in names}
        self.every, self._due = 1, 0

    def take(self, row: dict[str, float]) -> None:
        """One row; a name that is not in it is not known (NaN)."""
        self._due -= 1
        if self._due > 0:
            return
        self._due = self.every
        for name, column in self.columns.items():
            column.append(row.get(name, nan))
        if len(next(iter(self.columns.values()))) >= MOMENTS_KEPT:
            self.columns = {name: column[::2] for name, column in self.columns.items()}
            self.every *= 2


class Spans:
    """When each of some words was said: [first s, last s], one after the other."""

    def __init__(self) -> None:
        self.of: dict[str, list[list[float]]] = {}
        self._gap_s: dict[str, float] = {}

    def take(self, now_s: float, words: Iterable[str], gap_s: float) -> None:
        """The words of a moment."""
        for word in words:
            spans, gap = self.of.setdefault(word, []), self._gap_s.setdefault(word, gap_s)
            if spans and now_s - spans[-1][1] <= gap:
                spans[-1][1] = now_s
            else:
                spans.append([now_s, now_s])
            if len(spans) > SPANS:
                self._gap_s[word] = 2.0 * gap
                self.of[word] = _joined(spans, 2.0 * gap)


def _joined(spans: list[list[float]], gap_s: float) -> list[list[float]]:
    out = [spans[0]]
    for span in spans[1:]:
        if span[0] - out[-1][1] <= gap_s:
            out[-1][1] = span[1]
        else:
            out.append(span)
    return out


class ReplayRecord:
    """`look` after each tick. `provenance`: ship, settings, version; `sha256`: of everything that the twin
    said: the same replay gives the same."""

    def __init__(self) -> None:
        self.provenance: dict[str, str] = {}
        ours = [f"{what}_{name}" for what in ("estimate", "sigma") for name in STATES]
        self.moments = Kept(["time_s", *ours, "weight", "share", "rejected"])
        self.measured = {name: Kept(["time_s", "value"]) for name in STATES}
        self.ahead: dict[float, Kept] = {}
        self.modes, self.reasons = Spans(), Spans()
        self._hash = hashlib.sha256()
        self._watch: Watch | None = None

    @property
    def sha256(self) -> str:
        """Of the wide records of all ticks, in their order."""
        return self._hash.hexdigest()

    def look(self, loop: Loop, tick: Any) -> None:
        """Takes what a tick knew and said."""
        self._hash.update(tick.SerializeToString())
        if loop.last is None:
            return
        gap_s = GAP_TICKS * loop.period_s
        self.modes.take(tick.time_s, [tick.mode], gap_s)
        self.reasons.take(tick.time_s, map(without_numbers, tick.reasons), gap_s)
        self._moment(loop.last, tick)
        self._predictions(loop, loop.last, tick.time_s)

    def _moment(self, seen: Seen, tick: Any) -> None:
        row = {"time_s": tick.time_s, "weight": seen.learned.weight, "share": tick.learned.share}
        if seen.estimate.ready:
            pairs = zip(STATES, seen.estimate.state(), seen.estimate.sigma, strict=True)
            for name, value, sigma in pairs:
                row |= {f"estimate_{name}": value, f"sigma_{name}": sigma}
        self.moments.take(row | {"rejected": tick.rejected})
        m = seen.measured
        for name, kept in self.measured.items():
            if name in m.fresh and name in m.si:
                kept.take({"time_s": m.time[name], "value": m.si[name]})

    def _predictions(self, loop: Loop, seen: Seen, now_s: float) -> None:
        """Those that came due, against what was measured."""
        if self._watch is None:
            self._watch = Watch(loop.ship, loop.predictor.horizons_s)
        good = seen.verdict.mode != INVALID
        for h, judged in self._watch.look(now_s, seen.measured, seen.estimate, seen.ahead, good):
            self.ahead.setdefault(h, Kept(["time_s", *AHEAD])).take(_verified(judged))


def _verified(j: VerifiedPrediction) -> dict[str, float]:
    """A prediction by the moment it was for: its state, how far off it was, and the region promised [SI]."""
    row = {"time_s": j.foretold.due_s} | dict(zip(STATES, j.foretold.state, strict=True))
    row |= {"place": hypot(j.along, j.across), "turn": j.heading, "held": float(j.held)}
    if (region := j.foretold.region) and region.level:
        of = entry(j, region)
        row |= {"place": of.error, "radius": of.radius, "half_turn": of.heading, "level": of.level}
    return row


def without_numbers(reason: str) -> str:
    """A reason as it is the same from tick to tick."""
    return reason.partition(", for ")[0].partition(" = ")[0]
