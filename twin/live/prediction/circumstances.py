"""What is known when a prediction is said: the numbers on which its usual error depends, and the regime it
belongs to.

    phi = (1, |r| L/U, |delta|, exp(-(t - t_helm) U/L), H_s/(L/100), V_w/U, log(sigma/sigma_0), log(q/q_0))

t_helm: when helm or engine last moved; V_w: true wind; sigma: the estimate's; q: the error of this voyage so
far (the 68 % quantile that the predictor learns), q_0 its prior. Regimes: helm still or moved within the last
L/U; sea unknown, slight, moderate or rough, by H_s/L.
"""

from math import exp, hypot, log
from typing import Any, NamedTuple, cast

from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import Prediction
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship

HELD_RAD, HELD_J = 0.05, 0.05  # within these rudder [rad] and shaft [n D_P/U_0] count as held
SETTLED = 5.0  # ship lengths sailed until the observer's current is found
LEAST_U = 0.3  # of U_0: slower, nothing is divided by the speed
SIGMA_PLACE_M, SIGMA_HEADING_RAD = 3.0, 0.01  # sigma_0
SEAS = ("unknown", "slight", "moderate", "rough")
SEA_BORDERS = (0.5 / 320.0, 1.25 / 320.0)  # H_s/L: sea states 3 and 4 (WMO table 3700) for a ship of 320 m
HELMS = ("still", "moving")
NAMES = ("one", "turning", "rudder", "helm_moved", "waves", "wind", "sigma", "error_so_far")


class Regressors(NamedTuple):
    """phi of place and of heading, and the regime."""

    place: tuple[float, ...]
    heading: tuple[float, ...]
    helm: str
    sea: str


class Circumstances:
    """`step` each tick, `known` when a prediction is said."""

    def __init__(self, ship: Ship):
        self.L, self.least_U = float(ship.L_pp), LEAST_U * float(ship.U_0)
        self._settle_s = SETTLED * ship.L_pp / ship.U_0
        self._shaft = HELD_J * ship.U_0 / ship.D_P if ship.D_P else float("inf")  # [1/s]
        self._delta = self._n = 0.0
        self.moved_s = float("-inf")  # when helm or engine last moved
        self._now_s, self._now = float("nan"), cast(tuple[Any, ...], ())  # what holds at this moment
        self._good_s: float | None = None  # since when there is an estimate without a break

    def step(self, now_s: float, measured: Measured, good: bool) -> None:
        """Note what helm and engine do; `good`: there is an estimate that predictions can start from."""
        if not good:
            self._good_s = None
        elif self._good_s is None:
            self._good_s = now_s
        si = measured.si
        delta, n = si.get("delta", self._delta), si.get("n", self._n)
        if abs(delta - self._delta) > HELD_RAD or abs(n - self._n) > self._shaft:
            self._delta, self._n, self.moved_s = delta, n, now_s

    def settled(self, now_s: float) -> bool:
        """Whether the observer has had the time to find the current."""
        return self._good_s is not None and now_s - self._good_s >= self._settle_s

    def known(
        self, now_s: float, e: Estimate, measured: Measured, p: Prediction, usual: tuple[float, ...]
    ) -> Regressors:
        """Of prediction p; `usual`: the prior of its error in place [m] and heading [rad]."""
        if self._now_s != now_s:
            self._now_s, self._now = now_s, self._common(now_s, e, measured)
        common, of_place, of_heading, helm, sea = self._now
        return Regressors(
            (*common, of_place, log_ratio(p.sigma[0], usual[0])),
            (*common, of_heading, log_ratio(p.sigma[2], usual[1])),
            helm,
            sea,
        )

    def _common(self, now_s: float, e: Estimate, measured: Measured) -> tuple[Any, ...]:
        """What all horizons share: the first six of phi, log(sigma/sigma_0) of place and of heading, helm and
        sea."""
        si, U = measured.si, max(hypot(e.u, e.v), self.least_U)
        H_s, time_s = si.get("H_s"), self.L / U
        since_s = now_s - self.moved_s
        phi = (
            1.0,
            abs(e.r) * time_s,
            abs(si.get("delta", self._delta)),
            exp(-since_s / time_s),
            100.0 * (H_s or 0.0) / self.L,
            si.get("wind_speed", 0.0) / U,
        )
        of_place = log_ratio(e.sigma[0], SIGMA_PLACE_M)
        of_heading = log_ratio(e.sigma[2], SIGMA_HEADING_RAD)
        return phi, of_place, of_heading, HELMS[since_s < time_s], sea_of(H_s, self.L)


def sea_of(H_s: float | None, L: float) -> str:
    """The name of a sea for a ship of this length."""
    if H_s is None:
        return SEAS[0]
    slight, moderate = SEA_BORDERS
    return SEAS[1] if H_s <= slight * L else SEAS[2] if H_s <= moderate * L else SEAS[3]


def log_ratio(x: float, of: float) -> float:
    """log(x/of), x no smaller than a thousandth of it."""
    return log(max(x / of, 1e-3))
