"""Do positions and headings confirm the estimated motion? What the innovations cannot see: a speed or a rate
of turn that is off for good pulls the estimate along with it.

    |(eta(t) - eta(t - T) - int R(psi) nu_hat dt) . d|  <=  2 n_eta + int (|d.i| beta_u + |d.j| beta_v) dt +
        U n_psi T     for directions d
    |psi(t) - psi(t - T) - int r_hat dt|                <=  2 n_psi + int beta_r dt

eta and psi as measured, i and j the ship's axes, beta the bound of the certificate, T a minute.
"""

from collections import deque
from math import cos, degrees, hypot, pi, sin
from typing import NamedTuple

from twin.live.observer.estimate import Estimate
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured

WINDOW_S = 60.0
EVERY_S = 5.0  # between two measurements from which a way is counted
# n_eta: three deviations of a usual satellite receiver, its bias left out, for that is the same a minute ago
POSITION_M = 3.0
DIRECTIONS = tuple((cos(k * pi / 8.0), sin(k * pi / 8.0)) for k in range(8))

Bound = tuple[float, float, float]


class Fix(NamedTuple):
    """What was measured once, and what had been sailed by then."""

    time_s: float
    measured: tuple[float, ...]
    sailed: tuple[float, ...]
    allowed: tuple[float, ...]


class Parity:
    """Fed once a tick; `why` says what does not agree, with both numbers, "" when all does."""

    def __init__(self, heading_noise: float) -> None:
        self.heading_noise = heading_noise
        self.begin()

    def begin(self) -> None:
        """Anew, after a pause or a step: no way is counted across it."""
        self._x = self._y = self._psi = 0.0  # sailed by the estimate
        self._most = [0.0] * len(DIRECTIONS)  # how far that may be off, by direction
        self._turned = self._path = 0.0  # the same of the heading, and the way through the ground
        self._places: deque[Fix] = deque()
        self._headings: deque[Fix] = deque()
        self._place = self._heading = ""

    @property
    def why(self) -> str:
        """What does not confirm the motion, in words; "": nothing."""
        return self._place or self._heading

    def feed(self, measured: Measured, e: Estimate, beta: Bound, dt: float) -> str:
        """One tick of dt seconds; what does not agree now."""
        if measured.steps:
            self.begin()
        self._sail(e, beta, dt)
        si, fresh, now_s = measured.si, measured.fresh, measured.now_s
        if "x" in fresh and "y" in si:
            age_s = measured.age_s("x")
            east, north = e.velocity_ned()[1] * age_s, e.velocity_ned()[0] * age_s
            fix = Fix(
                now_s - age_s,
                (si["x"], si["y"]),
                (self._x - north, self._y - east),
                (*self._most, self._path),
            )
            if before := _minute_ago(self._places, fix):
                self._place = self._apart(before, fix)
        if "psi" in fresh:
            age_s = measured.age_s("psi")
            fix = Fix(now_s - age_s, (si["psi"],), (self._psi - e.r * age_s,), (self._turned,))
            if before := _minute_ago(self._headings, fix):
                self._heading = self._astray(before, fix)
        return self.why

    def _sail(self, e: Estimate, beta: Bound, dt: float) -> None:
        c, s = cos(e.psi), sin(e.psi)
        self._x += (e.u * c - e.v * s) * dt
        self._y += (e.u * s + e.v * c) * dt
        self._psi += e.r * dt
        self._turned += beta[2] * dt
        self._path += hypot(e.u, e.v) * dt
        u, v, most = beta[0] * dt, beta[1] * dt, self._most
        self._most = [
            m + u * abs(c * a + s * b) + v * abs(c * b - s * a)
            for m, (a, b) in zip(most, DIRECTIONS, strict=True)
        ]

    def _apart(self, before: Fix, now: Fix) -> str:
        """Positions against the way sailed."""
        north, east = (
            m - n - (p - q)
            for m, n, p, q in zip(now.measured, before.measured, now.sailed, before.sailed, strict=True)
        )
        still = 2.0 * POSITION_M + self.heading_noise * (now.allowed[-1] - before.allowed[-1])
        for (a, b), m, n in zip(DIRECTIONS, now.allowed, before.allowed, strict=False):
            if abs(a * north + b * east) > still + m - n:
                for_s = now.time_s - before.time_s
                return (
                    f"positions against the estimated speed, off = {hypot(north, east):.1f} m in "
                    f"{for_s:.0f} s, allowed {still + m - n:.1f} m"
                )
        return ""

    def _astray(self, before: Fix, now: Fix) -> str:
        """Headings against the estimated turning."""
        off = abs(turn(now.measured[0] - before.measured[0] - (now.sailed[0] - before.sailed[0])))
        most = 2.0 * self.heading_noise + now.allowed[0] - before.allowed[0]
        if off <= most:
            return ""
        for_s = now.time_s - before.time_s
        return (
            f"headings against the estimated rate of turn, off = {degrees(off):.2f} deg in {for_s:.0f} "
            "s, "
            f"allowed {degrees(most):.2f} deg"
        )


def _minute_ago(kept: deque[Fix], fix: Fix) -> Fix | None:
    """The oldest measurement within the window, once it is about as old as that; the new one is kept now and
    then."""
    while kept and fix.time_s - kept[0].time_s > WINDOW_S + EVERY_S:
        kept.popleft()
    if not kept or fix.time_s - kept[-1].time_s >= EVERY_S:
        kept.append(fix)
    return kept[0] if fix.time_s - kept[0].time_s >= WINDOW_S - EVERY_S else None
