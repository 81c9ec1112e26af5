"""`twin.diagnose`: which physical effect is missing, with size, interval and probability, or an honest answer
that is none."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from twin.api.result import PathLike, Progress, Result, quietly
from twin.api.voyages import several
from twin.physics.ship import Ship
from twin.recording.checks import losses
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.diagnosis.case import Case
from twin.study.diagnosis.effect_diagnosis import diagnose as judged
from twin.study.diagnosis.tell_diagnosis import terminal_lines
from twin.study.estimation import identifiability
from twin.study.estimation.residual_arrays import features

if TYPE_CHECKING:
    import matplotlib.axes


@dataclass(frozen=True, repr=False)
class Diagnosis(Result):
    """What is missing from the model. Its rows are the candidates, likeliest first."""

    case: Case = field(repr=False)
    voyages: tuple[Voyage, ...] = field(repr=False)

    @property
    def verdict(self) -> str:
        """One of missing, nothing_missing, unknown, undecided."""
        return str(self.data["verdict"])

    @property
    def reason(self) -> str:
        """The rule that decided, as in JSON (docs/diagnosis.md, section 7)."""
        return str(self.data["reason"])

    @property
    def sentence(self) -> str:
        """The verdict in words, with its reason."""
        return str(self.data["sentence"])

    @property
    def effects(self) -> list[str]:
        """Names to add, lasting causes first; empty unless the verdict is `missing`."""
        return list(self.data["missing"])

    @property
    def probabilities(self) -> dict[str, float]:
        """Of every candidate that is shown, of nothing missing, and of something unknown."""
        return {c["effect"]: c["probability"] for c in self.data["candidates"]} | dict(
            self.data["probabilities"]
        )

    def text(self) -> list[str]:
        """The lines of `twin diagnose`."""
        lines = terminal_lines(self.to_dict()) + losses(self.data["data_checks"])
        if "identifiability" in self.data:
            lines += ["", *identifiability.text(self.data["identifiability"])]
        return lines

    def _rows(self) -> Any:
        return self.data["candidates"]

    def __repr__(self) -> str:
        named = f" {', '.join(self.effects)}" if self.effects else ""
        return f"<Diagnosis of {self.data['ship']!r}: {self.verdict}{named}. {self.sentence}>"

    def with_identifiability(self, residual: PathLike | None = None) -> "Diagnosis":
        """Also what the first of the voyages can tell at all. `residual`: an ONNX file of what was learned,
        and whether that stands apart from the core; SettingsError when it must not be used."""
        model = self.case.model
        learned = features(str(residual), model.ship) if residual is not None else ()
        report = identifiability.report(self.voyages[0], model, *learned)
        return self.with_keys(identifiability=plain(report))

    def plot(self) -> "matplotlib.axes.Axes":
        """The candidates' probabilities, likeliest on top."""
        from matplotlib import pyplot

        _, axes = pyplot.subplots()
        rows = list(self.data["candidates"])[::-1]
        axes.barh([c["effect"] for c in rows], [c["probability"] for c in rows])
        axes.set(xlabel="probability", xlim=(0.0, 1.0), title=f"{self.data['ship']}: {self.verdict}")
        return axes

    def page(self) -> str:
        """The page of `twin diagnose --report`."""
        from twin.report.page import content, html

        tracks, voyages = list(self.case.tracks), list(self.voyages)
        return html(content("diagnose", self.to_dict(), tracks, self.case.model, voyages=voyages))


def diagnose(
    ship: Ship,
    voyages: Voyage | Iterable[Voyage],
    *,
    reference: Voyage | Iterable[Voyage] = (),
    progress: Progress | None = None,
) -> Diagnosis:
    """Judge all effects of the catalogue jointly on these voyages.

    `reference`: voyages of the same ship on which nothing was wrong; they say how much an imperfect model
    leaves unexplained, beside what the ship's calibration stored. DataError when a voyage cannot be used.
    """
    asked = several(voyages)
    done = judged(asked, ship, several(reference), quietly(progress))
    return Diagnosis(done.case, tuple(asked), data=done.result)
