"""How far ahead the twin sees, on a voyage that is over: from its own estimate, open loop, under the
recorded helm, engine and weather.

Every `every_s` a ship is set off where the estimate was, with the current and the learned force as they were
known then, and carried ahead; after each horizon it is compared with what was measured. Never a smoothed
fit.
"""

import itertools
from collections import deque
from copy import copy
from dataclasses import replace
from math import ceil, degrees, hypot
from typing import NamedTuple

from twin.live.loop import Loop
from twin.live.observer.controls import with_measured_controls
from twin.live.observer.dynamics import INPUTS, KnownDynamics
from twin.live.observer.predict import STEP_LENGTHS, LearnedAt, Middle, carry
from twin.live.observer.steering import Steering
from twin.live.signals.derive import turn
from twin.physics.maths import total
from twin.physics.state import Situation


class Sight(NamedTuple):
    """Mean absolute errors after one horizon, over `windows` starts."""

    horizon_s: float
    windows: int
    position_m: float
    heading_deg: float


class Start(NamedTuple):
    time_s: float
    situation: Situation
    physics: KnownDynamics
    learned: LearnedAt
    steering: Steering | None


class Foresight:
    """`look` after each tick, `judged` at the end."""

    def __init__(
        self, loop: Loop, horizons_s: tuple[float, ...] = (10.0, 60.0, 120.0), every_s: float = 30.0
    ):
        self.loop, self.horizons_s, self.every_s = loop, horizons_s, every_s
        self.step_s = min(STEP_LENGTHS * loop.ship.L_pp / loop.ship.U_0, 1.0)
        self._starts: deque[Start] = deque()  # not judged yet
        self._course: deque[tuple[float, dict[str, float]]] = deque()  # what was measured since the first
        self._errors: dict[float, list[tuple[float, float]]] = {h: [] for h in horizons_s}
        self._next_start: float | None = None
        self._next_step = -1e18

    def look(self, now_s: float) -> None:
        """Remember what was measured, and now and then a start."""
        seen = self.loop.last
        if seen is None or now_s < self._next_step - 1e-6 or not seen.estimate.ready:
            return
        self._next_step = now_s + self.step_s
        self._course.append((now_s, dict(seen.measured.si)))
        while self._starts and now_s > self._end_s(self._starts[0]):
            self._judge(self._starts.popleft())
        self._forget(self._starts[0].time_s if self._starts else now_s)
        if self._next_start is None:
            self._next_start = now_s + self.every_s
        elif now_s >= self._next_start:
            self._next_start = now_s + self.every_s
            known_now = self.loop.learned.as_known_now()
            dynamics = self.loop.dynamics
            start = Start(
                now_s,
                replace(seen.situation),
                dynamics.now,
                lambda s, f: known_now.at(s, f).force,
                dynamics.steering(),
            )
            self._starts.append(start)

    def judged(self) -> list[Sight]:
        """The errors at each horizon that the voyage is long enough for."""
        while self._starts:
            self._judge(self._starts.popleft())
        return [
            Sight(h, len(found), *(total(column) / len(found) for column in zip(*found, strict=True)))
            for h, found in self._errors.items()
            if found
        ]

    def _end_s(self, start: Start) -> float:
        """From when on nothing that is measured tells of a start."""
        return start.time_s + self.horizons_s[-1] + 2.0 * self.step_s

    def _forget(self, before_s: float) -> None:
        while self._course[0][0] < before_s:
            self._course.popleft()

    def _judge(self, start: Start) -> None:
        for horizon_s, error in self._sail(start).items():
            self._errors[horizon_s].append(error)

    def _sail(self, start: Start) -> dict[float, tuple[float, float]]:
        """(position error [m], heading error [deg]) after each horizon."""
        s, found, middle, steering = replace(start.situation), {}, Middle(), start.steering
        course = [(t, si) for t, si in self._course if start.time_s <= t <= self._end_s(start)]
        left = list(self.horizons_s)
        for (t, si), (t_next, si_next) in itertools.pairwise(course):
            for name in INPUTS:
                if name in si:
                    setattr(s, name, si[name])
            with_measured_controls(s, si)
            if steering:
                steering.take(si)
            if t_next - t > 5.0:
                break
            while left and start.time_s + left[0] <= t_next + 1e-6:
                there = replace(s)
                carry(
                    there,
                    start.physics,
                    start.learned,
                    start.time_s + left[0] - t,
                    copy(middle),
                    steering and steering.copy(),
                )
                if error := _error(there, si, si_next, (start.time_s + left[0] - t) / (t_next - t)):
                    found[left[0]] = error
                left.pop(0)
            steps = ceil((t_next - t) / self.step_s)
            for _ in range(steps):
                carry(s, start.physics, start.learned, (t_next - t) / steps, middle, steering)
        return found


def _error(
    s: Situation, before: dict[str, float], after: dict[str, float], share: float
) -> tuple[float, float] | None:
    """Against what was measured, on the line between two moments; None where it was not."""
    if not all(name in si for name in ("x", "y", "psi") for si in (before, after)):
        return None
    x, y = (before[name] + share * (after[name] - before[name]) for name in ("x", "y"))
    psi = before["psi"] + share * turn(after["psi"] - before["psi"])
    return hypot(s.x - x, s.y - y), abs(degrees(turn(s.psi - psi)))
