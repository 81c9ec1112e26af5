"""`twin.tube`: how far predictions on board may be off, from reference voyages."""

import os
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from twin.api.result import Progress, Result, metres, quietly
from twin.api.voyages import at_least_one
from twin.live.learning.residual import ship_hash
from twin.live.prediction.calibrated import SECTION, calibrated_of
from twin.live.signals import config
from twin.num import as_given, num
from twin.physics.ship import Ship, save
from twin.recording.checks import of_voyages
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.reference.foretold import errors_of
from twin.study.reference.sailed import own_references, refuse_twice, samples_hash
from twin.study.reference.tube_calibration import section
from twin.study.reference.tube_doubts import doubts
from twin.study.reference.tube_lines import rows, terminal_lines

if TYPE_CHECKING:
    import matplotlib.axes


@dataclass(frozen=True, repr=False)
class TubeCalibration(Result):
    """`ship`: with its [tube], as `twin run` and `twin replay` take it. Its rows are the horizons."""

    ship: Ship

    @property
    def warnings(self) -> list[str]:
        """What these voyages cannot promise, in words an owner can act on."""
        return list(self.data["doubts"])

    def _rows(self) -> Any:
        return [{k: v for k, v in row.items() if k != "regimes"} for row in self.data["horizons"]]

    def __repr__(self) -> str:
        last = self.data["horizons"][-1]
        return (
            f"<TubeCalibration of {self.ship.name!r}: {100 * last['level']:.0f} % within "
            f"{metres(last['place_m'])} at {as_given(last['horizon_s'])} s, {len(self.warnings)} warnings>"
        )

    def page(self) -> str:
        """How wide the tube is, by horizon and by what the ship does, and what it rests on."""
        from twin.report.result_page import Bars, PageTable, result_page

        rows = self._rows()
        at = [r | {"at": f"after {as_given(r['horizon_s'])} s"} for r in rows]
        regimes = [{**g, "horizon_s": r["horizon_s"]} for r in self.data["horizons"] for g in r["regimes"]]
        sizes = {"voyages": "voyages", "predictions": "predictions", "place_m": "[m]", "heading_deg": "[deg]"}
        return result_page(
            f"{self.ship.name}: tube around its predictions",
            f"{100 * rows[-1]['level']:.0f} % within {metres(rows[-1]['place_m'])} and "
            f"{num(rows[-1]['heading_deg'])} deg after {as_given(rows[-1]['horizon_s'])} s, in the mean.",
            self.warnings,
            (
                Bars("Place", "m", "at", {"place_m": ""}, at),
                Bars("Heading", "deg", "at", {"heading_deg": ""}, at),
                PageTable(
                    "By horizon",
                    {"horizon_s": "horizon [s]", "level": "share", **sizes},
                    rows,
                    given=("horizon_s",),
                ),
                PageTable(
                    "By what the ship does",
                    {"regime": "while", "horizon_s": "horizon [s]", **sizes},
                    regimes,
                    given=("horizon_s",),
                ),
            ),
        )

    def text(self) -> list[str]:
        """The lines of `twin tube`."""
        return terminal_lines(self.data)

    def plot(self) -> "matplotlib.axes.Axes":
        """Within how many metres a prediction comes true, in the mean [m], over the horizon [s]."""
        from matplotlib import pyplot

        _, axes = pyplot.subplots()
        rows = self._rows()
        axes.plot([r["horizon_s"] for r in rows], [r["place_m"] for r in rows], "o-")
        level = f"{100 * rows[-1]['level']:.0f} %"
        axes.set(xlabel="horizon [s]", ylabel=f"{level} within [m]", title=self.ship.name)
        axes.set_ylim(bottom=0.0)
        return axes


def tube(
    ship: Ship,
    voyages: Voyage | Iterable[Voyage],
    *,
    settings: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> TubeCalibration:
    """Take voyages on which nothing was wrong, and which the model was not calibrated to, through the loop as
    it runs on board, and find within how many metres and degrees its predictions came true.

    `settings`: the file that `twin run` uses, so that network, rate and horizons are the same. 90 % takes
    nine voyages; of fewer the best level they can show is promised. DataError when a voyage cannot be used,
    is proved wrong or is given twice. A few seconds for ten minutes of voyage.
    """
    every = at_least_one(voyages)
    return of_read(ship, every, own_references(ship, every), settings, quietly(progress))


def of_read(
    ship: Ship,
    every: Sequence[Voyage],
    fitted: Sequence[str],
    settings: str | os.PathLike[str] | None,
    tell: Progress,
) -> TubeCalibration:
    """The same of voyages that are read already. `fitted`: names of those that the ship was calibrated to.
    DataError as above."""
    refuse_twice((v.name, samples_hash(v)) for v in every)
    of_voyages(every, ship)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "ship.toml"
        save(ship, path)
        # nothing that one voyage taught the loop may help it on the next
        chosen = (
            config.load(os.fspath(settings) if settings is not None else None)
            .but("ship.file", str(path))
            .but("state.folder", "")
        )
        found = []
        for voyage in every:
            tell(f"{voyage.name} through the loop")
            found.append(errors_of(voyage, chosen))
    source = f"twin tube, {len(every)} voyages: {', '.join(v.name for v in every[:20])}"
    table = section(ship, ship_hash(ship), found, source)
    made = replace(ship, notes={**ship.notes, SECTION: table})
    calibrated = calibrated_of(made)
    assert calibrated is not None
    said = {
        "schema_version": 1,
        "ship": ship.name,
        "level": table["level"],
        "voyages": [
            {"name": v.name, "predictions": sum(len(x) for x in e.values())}
            for v, e in zip(every, found, strict=True)
        ],
        "horizons": rows(ship, calibrated, [e for e in found if any(e.values())]),
        "doubts": doubts(table, every, chosen["prediction.horizons_s"], float(ship.L_pp), fitted),
    }
    return TubeCalibration(made, data=plain(said))
