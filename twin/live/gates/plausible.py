"""Do the instruments agree with each other? Signs and units, by pairs that must move together.

    yaw rate against the turning of the heading, speed over ground against the positions, yaw rate against the
    rudder

Each pair is slow sums over a few ship lengths, k = sign(sum(a b)) sqrt(sum(a a)/sum(b b)); a factor near -1,
57.3 or 1.94 has a name. One without a name is said only where no noise explains it: noise of b alone makes
k too small, noise of a alone too large, so the true factor lies between rho k and k/rho, rho the correlation
(Frisch, Statistical confluence analysis, 1934), give or take five deviations of log k, sqrt((1 - rho^2)/n)
each, n the blocks remembered. Where the two do not go together (noise, waves) nothing is said here:
crosscheck.py asks whether they agree."""

from collections.abc import Sequence
from math import copysign, exp, sqrt

from twin.live.gates.hole import is_hole
from twin.live.signals.derive import turn
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship

TURNS = (
    (-1.0, "has the wrong sign"),
    (60.0, "is per minute"),
    (57.2958, "is in degrees where radians were meant"),
    (0.0174533, "is in radians where degrees were meant"),
)
SPEEDS = ((1.943844, "is in knots"), (0.514444, "was converted from knots twice"))

TOGETHER = 0.8  # correlation from which a factor means anything
FITS = 0.6, 1.6  # a factor between them may be 1
SURELY = 5.0  # deviations that noise reaches once in a million blocks: months at sea
LEAST_S = 2.0  # the shortest time over which a turning is measured


class Pair:
    """How one signal goes with another that it should equal."""

    def __init__(self, time_s: float, enough: float):
        self.time_s, self.enough = time_s, enough  # `enough`: rms of b, times sqrt(time), that may be judged
        self.ab = self.bb = self.aa = self.heard_s = 0.0
        self._w = 1.0  # of the last block

    def feed(self, a: float, b: float, dt: float) -> None:
        """One more moment of both signals, `dt` [s] after the last; what is older fades over `time_s`."""
        self._w = w = min(dt / self.time_s, 0.5)
        self.ab += w * (a * b - self.ab)
        self.bb += w * (b * b - self.bb)
        self.aa += w * (a * a - self.aa)
        self.heard_s += dt

    @property
    def judged(self) -> bool:
        """Whether enough has been heard, and moved enough, for its factor to mean anything."""
        return self.heard_s > 1.5 * self.time_s and self.bb > self.enough**2

    def factor(self) -> float:
        """Noise in either moves it less than it would a regression of one on the other."""
        return copysign(sqrt(self.aa / self.bb), self.ab)

    def factors(self) -> tuple[float, float]:
        """The least and the greatest factor that noise in either may make this one of."""
        rho, k = abs(self.correlation()), self.factor()
        by = exp(SURELY * sqrt((1.0 - min(rho, 1.0) ** 2) * self._w / (2.0 - self._w))) / rho
        return (k / by, k * by) if k > 0.0 else (k * by, k / by)

    def correlation(self) -> float:
        """Their correlation about zero, -1 to 1; 0 while neither moves."""
        return self.ab / sqrt(self.aa * self.bb) if self.aa > 0.0 else 0.0


class Plausibility:
    """Watches the pairs; `reasons()` says what cannot be true."""

    def __init__(self, ship: Ship, period_s: float = 0.1):
        """period_s: of the loop; no way is measured across a hole in its ticks."""
        T = ship.L_pp / ship.U_0
        self.time_s, self._period_s = T, period_s
        self.over_s = max(0.2 * T, LEAST_S)
        self._turn = Pair(max(2.0 * T, 10.0 * LEAST_S), 0.02 / T)
        self._speed = Pair(max(2.0 * T, 10.0 * LEAST_S), 0.15 * ship.U_0)
        self._helm = Pair(3.0 * T, 0.04)  # a: yaw rate [U_0/L], b: rudder, low-passed [rad]
        self._rudder = 0.0
        self._last: dict[str, tuple[float, ...]] = {}

    def feed(self, measured: Measured, dt: float) -> None:
        """One tick's measurements."""
        if is_hole(dt, self._period_s) or measured.steps:
            self._last.clear()  # no way is measured across a hole or a step
            return
        si = measured.si
        if "psi" in measured.fresh and "r" in si and "r" not in measured.derived:
            self._compare_turn(si["psi"], si["r"], measured.now_s - measured.age_s("psi"))
        if "x" in measured.fresh and measured.has("y", "u", "v") and "u" not in measured.derived:
            self._compare_speed(
                si["x"], si["y"], sqrt(si["u"] ** 2 + si["v"] ** 2), measured.now_s - measured.age_s("x")
            )
        if measured.has("delta", "r", "n") and si["n"] > 0.0 and si.get("u", 0.0) > 0.0:
            self._rudder += min(dt / self.time_s, 0.5) * (si["delta"] - self._rudder)
            self._helm.feed(si["r"] * self.time_s, self._rudder, dt)

    def _compare_turn(self, psi: float, r: float, t: float) -> None:
        """Over half a ship length at a time, so that the heading's noise does not matter."""
        psi0, sum_r, count, t0 = self._last.get("psi", (psi, 0.0, 0.0, t))
        if t - t0 >= self.over_s:
            self._turn.feed((sum_r + r) / (count + 1.0), turn(psi - psi0) / (t - t0), t - t0)
            self._last["psi"] = (psi, 0.0, 0.0, t)
        else:
            self._last["psi"] = (psi0, sum_r + r, count + 1.0, t0)

    def _compare_speed(self, x: float, y: float, speed: float, t: float) -> None:
        x0, y0, total, count, t0 = self._last.get("x", (x, y, 0.0, 0.0, t))
        if t - t0 >= self.over_s:
            way = sqrt((x - x0) ** 2 + (y - y0) ** 2) / (t - t0)
            self._speed.feed((total + speed) / (count + 1.0), way, t - t0)
            self._last["x"] = (x, y, 0.0, 0.0, t)
        else:
            self._last["x"] = (x0, y0, total + speed, count + 1.0, t0)

    def reasons(self) -> list[str]:
        """What cannot be true, in words."""
        said = []
        for pair, what, mistakes in (
            (self._turn, "yaw_rate_degps against the turning heading", TURNS),
            (self._speed, "speed over ground against the positions", SPEEDS),
        ):
            if (
                pair.judged
                and abs(pair.correlation()) > TOGETHER
                and (word := _word(pair.factor(), pair.factors(), mistakes))
            ):
                said.append(f"{what}: it {word}")
        if self._helm.judged and self._helm.correlation() < -0.5:
            said.append(
                "yaw_rate_degps against rudder_angle_deg: it turns against its rudder; one of the "
                "two has the wrong sign"
            )
        return said


def _word(factor: float, factors: tuple[float, float], mistakes: Sequence[tuple[float, str]]) -> str:
    """The mistake whose factor is nearest; "" when it, or what noise may make one of, may be 1."""
    off, word = min((abs(factor / value - 1.0), word) for value, word in mistakes)
    return word if off < 0.2 else "" if factors[1] > FITS[0] and factors[0] < FITS[1] else "does not fit"
