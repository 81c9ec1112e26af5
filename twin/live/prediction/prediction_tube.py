"""The tube around the predictions of this tick: within it the ship will be, with the level that reference
voyages promise, if helm and engine are held.

On board the level asked of the table is corrected, slowly: a prediction that was said at t is judged at
t + H, one at a time for each horizon, and

    a <- a + g (a_0 - [outside])                held in [a_0/3, 2 a_0],  a_0 = 1 - level

so that what is left of a season or a loading is made good over days; it cannot calibrate (Gibbs & Candes
2021, with delayed feedback).
"""

from collections.abc import Sequence
from typing import NamedTuple

from twin.live.learning.residual import ship_hash
from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import Prediction, Region, usual_error
from twin.live.prediction.calibrated import TARGETS, RegionTable, calibrated_of
from twin.live.prediction.circumstances import Circumstances
from twin.live.prediction.judge import Foretold, Judge, VerifiedPrediction, course
from twin.live.signals.measured import Measured
from twin.physics.ship import Ship

GAIN = 0.015  # g
CALIBRATED, SETTLING = "calibrated", "the observer has not settled yet"


class Counted(NamedTuple):
    """Predictions judged with the helm held, and how many of them were inside in place and in heading."""

    judged: int = 0
    place: int = 0
    heading: int = 0


class PredictionTube:
    """`around` each tick; without a [tube] in the ship file it does nothing."""

    def __init__(self, ship: Ship):
        self.ship, self.why_not = ship, ""
        self.table = self._usable(calibrated_of(ship))
        self.circumstances, self._judge = Circumstances(ship), Judge()
        table = self.table
        self.counted: dict[float, Counted] = dict.fromkeys(table.horizons, Counted()) if table else {}
        self.usual = {h: usual_error(ship, h)[:2] for h in self.counted}
        self._a = {(h, of): 1.0 - table.level for h in self.counted for of in TARGETS} if table else {}
        self._waiting: dict[float, Foretold] = {}
        self.beyond = ""  # what no reference voyage had, in the last round

    def _usable(self, table: RegionTable | None) -> RegionTable | None:
        if table is not None and table.model != ship_hash(self.ship):
            self.why_not = (
                f"the [tube] of the ship file was found with another model ({table.model}, now "
                f"{ship_hash(self.ship)}) and is not used. `twin tube` makes one for this model"
            )
            return None
        return table

    def around(
        self, now_s: float, measured: Measured, e: Estimate, ahead: Sequence[Prediction], good: bool
    ) -> Sequence[Prediction]:
        """The predictions of this tick with the tube around each."""
        if self.table is None:
            return ahead
        self.circumstances.step(now_s, measured, good)
        self._judge.hear(measured)
        if self._waiting:
            self._learn(now_s)
        return [self._with_region(now_s, measured, e, p) for p in ahead] if ahead else ahead

    def _with_region(self, now_s: float, measured: Measured, e: Estimate, p: Prediction) -> Prediction:
        table = self.table
        h = table.horizon(p.horizon_s) if table else None
        if table is None or h is None:
            return p
        known = self.circumstances.known(now_s, e, measured, p, self.usual[h])
        along, across, heading = table.sigmas(h, known, self.usual[h])
        name, cell = table.cell(h, known)
        q, q_psi = (
            table.quantile(of, 1.0 - self._a[h, t])
            for t, of in zip(TARGETS, (cell.place, cell.heading), strict=True)
        )
        self.beyond = table.beyond(known)
        settled = self.circumstances.settled(now_s)
        promised = settled and not self.beyond
        region = Region(
            q * along,
            q * across,
            q_psi * heading,
            course(p.state),
            table.promise(cell) if promised else 0.0,
            cell.voyages,
            name,
            CALIBRATED if promised else self.beyond if settled else SETTLING,
        )
        if promised and h not in self._waiting:
            self._waiting[h] = Foretold(now_s - p.age_s, now_s, now_s + p.horizon_s, p.state, known, region)
        return p._replace(region=region)

    def _learn(self, now_s: float) -> None:
        """What came due, once in H."""
        for h, foretold in [*self._waiting.items()]:
            judged = self._judge.ask(foretold, now_s, self.circumstances.moved_s)
            if judged is False:
                continue
            del self._waiting[h]
            if isinstance(judged, VerifiedPrediction) and judged.held:
                self._correct(h, inside(judged))

    def _correct(self, h: float, kept: tuple[bool, bool]) -> None:
        assert self.table is not None
        a_0, n = 1.0 - self.table.level, self.counted[h]
        self.counted[h] = Counted(n.judged + 1, n.place + kept[0], n.heading + kept[1])
        for target, good in zip(TARGETS, kept, strict=True):
            a = self._a[h, target] + GAIN * (a_0 - (not good))
            self._a[h, target] = min(max(a, a_0 / 3.0), 2.0 * a_0)


def inside(judged: VerifiedPrediction) -> tuple[bool, bool]:
    """Whether place and heading were inside the region that was said."""
    r = judged.foretold.region
    assert r is not None
    return (
        (judged.along / r.along_m) ** 2 + (judged.across / r.across_m) ** 2 <= 1.0,
        abs(judged.heading) <= r.heading,
    )
