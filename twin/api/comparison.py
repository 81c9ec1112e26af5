"""`twin.compare`: model against measurement, open loop from the measured state."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from typing import TYPE_CHECKING, Any

from twin.api.result import PathLike, Progress, Result, frame, metres, quietly
from twin.api.voyages import at_least_one
from twin.errors import UsageError
from twin.num import as_given, num
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.voyage import Voyage
from twin.study.prediction.open_loop_comparison import ComparedVoyages
from twin.study.prediction.open_loop_comparison import compare as judged
from twin.study.prediction.openloop import HORIZONS_S
from twin.study.prediction.tell import terminal_lines
from twin.study.reference.sailed import Sailed, refuse_twice, sailed

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas


@dataclass(frozen=True, repr=False)
class Comparison(Result):
    """How far the model is off, and where. Its rows are the horizons."""

    found: ComparedVoyages = field(repr=False)
    model: Model = field(repr=False)

    @property
    def errors(self) -> "pandas.DataFrame":
        """One row a horizon: mean absolute errors in place [m], across the course [m] and in heading [deg],
        beside what was expected (`noise_floor`)."""
        return frame(self.data["horizons"])

    @property
    def where(self) -> "pandas.DataFrame":
        """One row a condition in which the error is larger than elsewhere: ratio and share of the time."""
        return frame(self.data["where"])

    @property
    def verdict(self) -> str:
        """The sentence that an engineer reads first."""
        return str(self.data["verdict"])

    def text(self) -> list[str]:
        """The lines of `twin compare`."""
        return terminal_lines(self.to_dict())

    def _rows(self) -> Any:
        return self.data["horizons"]

    def __repr__(self) -> str:
        row = self.data["horizons"][-1]
        error = (
            f"{metres(row['position_mae_m'])}, {num(row['heading_mae_deg'], 2)} deg at "
            f"{as_given(row['horizon_s'])} s"
        )
        expected = f"expected {metres(row['noise_floor']['position_mae_m'])}"
        return f"<Comparison of {self.data['ship']!r}: {error}; {expected}>"

    def plot(self, beside: "Comparison | None" = None) -> "matplotlib.axes.Axes":
        """Position error over horizon with what was expected; `beside`: an earlier comparison in the same
        axes."""
        from matplotlib import pyplot

        _, axes = pyplot.subplots()
        for found, label in ((self, "model"), (beside, "before")):
            if found is None:
                continue
            rows = found.data["horizons"]
            t = [r["horizon_s"] for r in rows]
            (line,) = axes.plot(t, [r["position_mae_m"] for r in rows], "o-", label=label)
            expected = [r["noise_floor"]["position_mae_m"] for r in rows]
            axes.plot(t, expected, ":", color=line.get_color(), label=f"expected ({label})")
        axes.set(xlabel="horizon [s]", ylabel="open-loop position error [m]", title=self.data["ship"])
        axes.set_ylim(bottom=0.0)
        axes.legend()
        return axes

    def page(self) -> str:
        """The page of `twin compare --report`."""
        from twin.report.page import content, html

        tracks, voyages = [s.track for s in self.found.sailed], [s.voyage for s in self.found.sailed]
        return html(content("compare", self.to_dict(), tracks, self.model, voyages=voyages))


def compare(
    ship: Ship,
    voyages: Voyage | Iterable[Voyage],
    *,
    horizons_s: Sequence[float] = HORIZONS_S,
    residual: PathLike | None = None,
    progress: Progress | None = None,
) -> Comparison:
    """Predict the voyages open loop, from the measured state with the recorded controls, and judge the
    errors together.

    `horizons_s`: how far ahead [s]. `residual`: an ONNX file of what was learned, added as the loop adds it.
    DataError when a voyage cannot be used or holds no stretch as long as the shortest horizon; UsageError for
    a horizon that is not ahead.
    """
    if not len(horizons_s) or not all(0.0 < h < inf for h in horizons_s):
        raise UsageError(f"horizons_s = {[*horizons_s]}: at least one number of seconds above 0 is needed.")
    quietly(progress)("predicting")
    return of_sailed(ship, [sailed(v, ship) for v in at_least_one(voyages)], horizons_s, residual)


def of_sailed(
    ship: Ship, found: Sequence[Sailed], horizons_s: Sequence[float], residual: PathLike | None = None
) -> Comparison:
    """The same of voyages that are read already. DataError: one is given twice."""
    refuse_twice((s.voyage.name, s.sha256) for s in found)
    model = Model.of(ship)
    if residual is not None:
        from twin.study.estimation.residual_arrays import learned_force

        model = replace(model, residual=learned_force(str(residual), ship))
    done = judged(found, model, sorted(set(horizons_s)))
    return Comparison(done, model, data=done.result)
