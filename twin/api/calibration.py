"""`twin.calibrate`: the core of a ship's model fitted to voyages on which nothing was wrong."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from twin.api.result import Progress, Result, frame, metres, quietly
from twin.api.voyages import at_least_one, several
from twin.errors import DataError
from twin.num import as_given, readable
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.checks import of_voyages
from twin.recording.voyage import Voyage
from twin.study.calibration.calibration_lines import terminal_lines
from twin.study.calibration.core_fit import fitted_core
from twin.study.calibration.doubts import doubts_of
from twin.study.calibration.held_out import LAST, knowing_nothing, split
from twin.study.calibration.stages import Stages
from twin.study.calibration.worse import away_on_references, refusal
from twin.study.reference.sailed import Sailed, refuse_twice, sailed
from twin.study.track.segments import long_enough

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas


@dataclass(frozen=True, repr=False)
class Calibration(Result):
    """`ship`: calibrated, or as it was where that made it worse (`accepted`, `refused`). Its rows are the
    derivatives: before, after, standard error, whether excited."""

    ship: Ship

    @property
    def accepted(self) -> bool:
        """Whether the open-loop error on what was not used for the fit did not grow."""
        return bool(self.data["accepted"])

    @property
    def refused(self) -> str:
        """Why the uncalibrated numbers are kept, and what to sail; "" where they are not."""
        return str(self.data["refused"])

    @property
    def errors(self) -> "pandas.DataFrame":
        """Open-loop error on what was not used for the fit, one row a horizon: `position_m`, `heading_deg`,
        and before the fit `before_m`, `before_deg`."""
        return frame(self.data["held_out"])

    @property
    def warnings(self) -> list[str]:
        """What is doubtful about this calibration, in words an owner can act on."""
        return list(self.data["doubts"])

    def text(self) -> list[str]:
        """The lines of `twin calibrate`."""
        return terminal_lines(self.to_dict())

    def _rows(self) -> Any:
        return self.data["derivatives"]

    def __repr__(self) -> str:
        return f"<Calibration of {self.ship.name!r}: {self._fall()}, {len(self.warnings)} warnings>"

    def _fall(self) -> str:
        last = self.data["held_out"][-1]
        return (
            f"{metres(last['before_m'])} -> {metres(last['position_m'])} at {as_given(last['horizon_s'])} s"
        )

    def _sentence(self) -> str:
        """What became of the error: where the heading's falls, the place's may grow a little."""
        last = self.data["held_out"][-1]
        return (
            "The open-loop error in place, on what was not used for the fit, goes from "
            f"{metres(last['before_m'])} to {metres(last['position_m'])} "
            f"after {as_given(last['horizon_s'])} s."
        )

    def page(self) -> str:
        """The error before and after, by horizon and by what the ship did, and every derivative."""
        from twin.report.result_page import Bars, PageTable, result_page

        rows = [r | {"at": f"after {as_given(r['horizon_s'])} s"} for r in self.data["held_out"]]
        both = {"before_m": "before", "position_m": "now"}
        shown = {
            "name": "derivative",
            "before": "before",
            "value": "now",
            "sd": "+- (sd)",
            "unit": "unit",
            "excited": "excited",
        }
        regimes = {"regime": "while", "horizon_s": "horizon [s]", "position_m": "error [m]"}
        return result_page(
            f"{self.ship.name}: calibration",
            self.refused or self._sentence(),
            self.warnings,
            (
                Bars(f"Open-loop position error ({self.data['held_out_is']})", "m", "at", both, rows),
                PageTable("By what the ship did", regimes, self.data["by_regime"], given=("horizon_s",)),
                PageTable("Derivatives", shown, [readable(d) for d in self.data["derivatives"]]),
            ),
        )

    def plot(self) -> "matplotlib.axes.Axes":
        """Open-loop position error on what was not used for the fit [m] over the horizon [s], before and
        after."""
        from matplotlib import pyplot

        _, axes = pyplot.subplots()
        rows = [r for r in self.data["held_out"] if r["position_m"] is not None]
        for key, label in (("before_m", "before"), ("position_m", "calibrated")):
            axes.plot([r["horizon_s"] for r in rows], [r[key] for r in rows], "o-", label=label)
        axes.set(xlabel="horizon [s]", ylabel="open-loop position error [m]", title=self.ship.name)
        axes.set_ylim(bottom=0.0)
        axes.legend()
        return axes


def calibrate(
    ship: Ship,
    voyages: Voyage | Iterable[Voyage],
    *,
    held_out: Voyage | Iterable[Voyage] = (),
    progress: Progress | None = None,
) -> Calibration:
    """Fit the core to reference voyages (nothing wrong on them; calm, or with the wind recorded).

    `held_out`: voyages on which the error is measured; they are never fitted, and are no reference voyages.
    Without any the last third of three or more voyages is held back for that, and the ship that is returned
    is then fitted to all; of one or two the last 30 % of each is held back and not fitted. Where that error
    grew, the ship is returned as it was and `refused` says why. `progress(text)` is told every step.
    DataError when a voyage cannot be used. Seconds to minutes.
    """
    every = [sailed(v, ship) for v in at_least_one(voyages)]
    return of_sailed(ship, every, [sailed(v, ship) for v in several(held_out)], quietly(progress))


def of_sailed(ship: Ship, every: list[Sailed], kept: list[Sailed], tell: Progress) -> Calibration:
    """The same of voyages that are read already. DataError: no numbers of the ship go with them, one is given
    twice or nowhere whole for long enough."""
    refuse_twice((s.voyage.name, s.sha256) for s in (*every, *kept))
    checks = of_voyages([s.voyage for s in (*every, *kept)], ship)
    for s in every:
        long_enough(s.track, ship)
    fitted, held, words = split(every, kept, ship)
    tell = Stages(tell, len(every) / len(fitted) if words == LAST else None)
    try:
        with np.errstate(invalid="ignore"):  # the algebra says it, too
            first = last = fitted_core(fitted, held, ship, tell)
    except np.linalg.LinAlgError as error:
        raise DataError(_no_fit(ship, fitted, checks)) from error
    by_horizon = zip(first.held_out, knowing_nothing(held, Model.of(ship)), strict=True)
    why = refusal(ship, [e | far for e, far in by_horizon], first.core.unexcited)
    if words == LAST and not why:
        tell("once more, with every voyage")
        last = fitted_core(every, held, ship, tell, begun=first)
    done = last.calibrated(tell, first)
    r, why = done.result, why or away_on_references(done.ship, last.core.unexcited)
    found = doubts_of(r, ship, done.ship, len(last.core.tracks))
    said = {"held_out_is": words, "doubts": found, "accepted": not why, "refused": why, "data_checks": checks}
    return Calibration(ship if why else done.ship, data=r | said)


def _no_fit(ship: Ship, fitted: list[Sailed], checks: list[dict[str, Any]]) -> str:
    """Why no model of this ship goes through these voyages, as far as the checks of the data say."""
    doubt = next((f" {c['check']}: {c['text']}" for c in checks if c["ok"] is False), "")
    return (
        f"{', '.join(s.voyage.name for s in fitted)}: no numbers of {ship.name} can be fitted to "
        f"this motion. Give voyages of this ship, in its units.{doubt}"
    )
