"""Instruments that check each other over minutes: none of them need be right for two of them to disagree.

    positions   against  speed over ground      (p - p0)/t - mean of R(psi)(u, v)
    ground      against  water                   R(psi)((u, v) - (u_r, v_r)): a current, which changes slowly
    heading     against  rate of turn            (psi - psi0)/t - mean of r
    shaft       against  speed                   the force ahead that the ship's equations lack
    rudder      against  turning                 the moment they lack while its feedback stands

Each is a mean over blocks of time, tested by a cumulative sum (cusum.py) whose mean and scale are the ship's
own. A text never holds a number, so that it can be counted.
"""

from collections.abc import Iterator
from math import cos, hypot, sin

from twin.live.gates.current_rate import CurrentRate
from twin.live.gates.cusum import SLOWLY, Cusum
from twin.live.gates.hole import is_hole
from twin.live.gates.lacking import FAST, SLOW, CorrectedTick, Lacking
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship

POSITIONS = "positions against speed over ground and heading: they walk apart"
CURRENT = "speed over ground against speed through water: they part faster than a current changes"
COMPASS = "heading_true_north_deg against yaw_rate_degps: the heading does not turn as the gyro says"
WAY_S, STREAM_S, TURN_S = 10.0, 10.0, 4.0  # blocks


class CrossChecks:
    """Fed with every tick; `reasons` are the disagreements of now, in words that stay the same."""

    def __init__(self, ship: Ship, period_s: float = 0.1):
        """period_s: of the loop; a hole in its ticks ends every block."""
        U, T, self._period_s = ship.U_0, ship.L_pp / ship.U_0, period_s
        self._way = Way(U)
        self._stream = Stream(U)
        self._heading = Heading(T)
        # of one shaft and one rudder; what an actuator of several lacks, the others may bring
        self._lacking = () if ship.actuators else (Lacking(ship, FAST), Lacking(ship, SLOW))
        self.reasons: list[str] = []

    def feed(self, now: CorrectedTick) -> None:
        """One tick."""
        measured, dt = now.measured, now.dt
        if is_hole(dt, self._period_s):
            for check in (self._way, self._stream, self._heading, *self._lacking):
                check.pause()
            return
        self._way.feed(measured, dt)
        self._stream.feed(measured, dt)
        self._heading.feed(measured, dt)
        for lacking in self._lacking:
            lacking.feed(now)
        self.reasons = list(self._said())

    def _said(self) -> Iterator[str]:
        if self._heading.alarm:
            yield COMPASS
        if self._way.alarm:
            yield POSITIONS
        if self._stream.alarm:
            yield CURRENT
        yield from dict.fromkeys(text for lacking in self._lacking for text in lacking.reasons)


class Way:
    """Positions against the way that speed and heading make; along and across the ship, as a share of its
    speed."""

    def __init__(self, U_0: float):
        self.U_0 = U_0
        least = 0.01 * U_0 + 0.02
        self._tests = Cusum(least, 0.03 * U_0), Cusum(least, 0.06 * U_0)  # a compass may be 3 deg off
        self._start: tuple[float, float, float] | None = None  # x, y, time
        self._sums = [0.0, 0.0, 0.0]  # way north and east, way ahead

    @property
    def alarm(self) -> bool:
        """Whether one of its tests has found a disagreement."""
        return any(test.alarm for test in self._tests)

    def pause(self) -> None:
        """The measurements have a hole: begin a new stretch."""
        self._start = None

    def feed(self, measured: Measured, dt: float) -> None:
        """One tick, `dt` [s] after the last."""
        si = measured.si
        if (
            not measured.has("x", "y", "psi", "u", "v")
            or "u" in measured.derived
            or "psi" in measured.derived
        ):
            self._start = None
            return
        c, s = cos(si["psi"]), sin(si["psi"])
        north, east = si["u"] * c - si["v"] * s, si["u"] * s + si["v"] * c
        self._sums[0] += north * dt
        self._sums[1] += east * dt
        self._sums[2] += hypot(north, east) * dt
        if "x" not in measured.fresh or "y" not in measured.fresh:
            return
        age_s, t = measured.age_s("x"), measured.time["x"]
        if self._start is not None:
            if t - self._start[2] < WAY_S:
                return
            self._judge(
                si["x"] - self._start[0],
                si["y"] - self._start[1],
                north * age_s,
                east * age_s,
                t - self._start[2],
            )
        self._start, self._sums = (si["x"], si["y"], t), [north * age_s, east * age_s, 0.0]

    def _judge(self, x: float, y: float, over_north: float, over_east: float, span_s: float) -> None:
        """Position's way less the speed's, [m/s] along and across that way, at the ship's service speed."""
        north, east = self._sums[0] - over_north, self._sums[1] - over_east
        way, mean = hypot(north, east), self._sums[2] / span_s
        if way < 0.1 * self.U_0 * span_s:
            c, s = 1.0, 0.0
        else:
            c, s = north / way, east / way
        off_n, off_e = (x - north) / span_s, (y - east) / span_s
        share = self.U_0 / max(mean, 0.5 * self.U_0)
        self._tests[0].feed((off_n * c + off_e * s) * share)
        self._tests[1].feed((off_e * c - off_n * s) * share)


class Stream:
    """Speed over ground less speed through water: a current, which stays where it is over minutes, whichever
    way it heads; how fast it changes is learned (current_rate.py)."""

    REMEMBERS = 60.0  # blocks at most

    def __init__(self, U_0: float):
        self._least = 0.015 * U_0 + 0.02
        self._tests = Cusum(self._least, 0.0), Cusum(self._least, 0.0)
        self._current: list[float] | None = None  # north, east
        self._unsuspected = (0.0, 0.0)  # the same when last nothing was suspicious
        self._rate = CurrentRate()
        self._blocks = 0
        self._sums = [0.0] * 4
        self._since_s = 0.0

    @property
    def alarm(self) -> bool:
        """Whether one of its tests has found a disagreement."""
        return any(test.alarm for test in self._tests)

    def pause(self) -> None:
        """The measurements have a hole: begin a new block."""
        self._sums, self._since_s = [0.0] * 4, 0.0

    def feed(self, measured: Measured, dt: float) -> None:
        """One tick, `dt` [s] after the last."""
        si = measured.si
        if not measured.has("u", "u_r", "psi") or "u" in measured.derived or "psi" in measured.derived:
            self.pause()
            return
        sums = self._sums
        sums[0] += (si["u"] - si["u_r"]) * dt
        sums[1] += (si["v"] - si["v_r"]) * dt if measured.has("v", "v_r") else 0.0
        sums[2] += cos(si["psi"]) * dt
        sums[3] += sin(si["psi"]) * dt
        self._since_s += dt
        if self._since_s >= STREAM_S:
            self._judge(measured.has("v", "v_r"))
            self.pause()

    def _judge(self, both: bool) -> None:
        ahead, aside, c, s = (total / self._since_s for total in self._sums)
        size = hypot(c, s)
        if size < 0.9:  # it turned through too much of the compass
            return
        c, s = c / size, s / size
        seen = ahead * c - aside * s, ahead * s + aside * c
        if self._current is None:
            self._current = [*seen]
            self._unsuspected = self._current[0], self._current[1]
        now = self._current
        off = ahead - (now[0] * c + now[1] * s), (aside - (now[1] * c - now[0] * s)) if both else 0.0
        before = self.alarm
        for test, x in zip(self._tests, off, strict=True):
            test.feed(x)
        self._blocks += 1
        if self.alarm and not before:  # what taught since it became suspicious is taken back
            now[:] = self._unsuspected
        suspicious = any(test.suspicious for test in self._tests)
        self._rate.feed(*seen, self._least, suspicious)
        a = 1.0 / min(self._blocks, self.REMEMBERS)
        if not self.alarm:  # what is told as a fault is no current, however fast that changes
            a = max(a, self._rate.gain(self._least))
        a *= SLOWLY if suspicious else 1.0
        ahead, aside = (test.usual(x) for test, x in zip(self._tests, off, strict=True))
        now[0] += a * (ahead * c - aside * s)
        now[1] += a * (ahead * s + aside * c)
        if all(test.calm for test in self._tests):
            self._unsuspected = now[0], now[1]


class Heading:
    """The turning of the heading against the gyro, whose constant error is learned. Between two samples of
    the gyro the rate of turn may have been anything between them: half their difference counts for
    nothing."""

    def __init__(self, T: float):
        self._test = Cusum(3e-4, 6e-4)  # rad/s
        self._start: tuple[float, float] | None = None
        self._turned = self._unseen = 0.0  # by the gyro; how far that may be off between its samples [rad]
        self._rate: tuple[float, float] | None = None  # the gyro's last sample, and when

    @property
    def alarm(self) -> bool:
        """Whether its test has found a disagreement."""
        return self._test.alarm

    def pause(self) -> None:
        """The measurements have a hole: begin a new stretch."""
        self._start = self._rate = None

    def feed(self, measured: Measured, dt: float) -> None:
        """One tick, `dt` [s] after the last."""
        si = measured.si
        if not measured.has("psi", "r") or "r" in measured.derived or "psi" in measured.derived:
            self.pause()
            return
        r, t = si["r"], measured.time["r"]
        before, before_s = self._rate or (r, t)
        self._turned += 0.5 * (r + before) * (t - before_s)
        self._unseen += 0.5 * abs(r - before) * (t - before_s)
        self._rate = r, t
        if "psi" not in measured.fresh:
            return
        over, t = r * (t - measured.time["psi"]), measured.time["psi"]
        if self._start is not None:
            span_s = t - self._start[1]
            if span_s < TURN_S:
                return
            off = turn(si["psi"] - self._start[0] - self._turned + over)
            self._test.feed(off / span_s, self._unseen / span_s)
        self._start, self._turned, self._unseen = (si["psi"], t), over, 0.0
