"""`twin.add` and `twin.remove`: an effect put into a ship's model and proved, or taken out again."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from twin.api.result import Progress, Result, frame, metres, quietly
from twin.api.voyages import at_least_one, several
from twin.errors import UsageError
from twin.physics.effect import Effect
from twin.physics.effects import find_for
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.recording.checks import losses
from twin.recording.voyage import Voyage
from twin.study.reference.sailed import Sailed, refuse_twice, sailed
from twin.study.update.added import refused, terminal_lines
from twin.study.update.addition import HELD_OUT, Added
from twin.study.update.addition import add as fitted
from twin.study.update.removal import remove as taken_out

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas


@dataclass(frozen=True, repr=False)
class Update(Result):
    """`ship`: with the effects. Its rows are the numbers of the effects with their 95 % intervals."""

    ship: Ship
    before: Ship = field(repr=False)
    made: Added = field(repr=False)
    voyages: tuple[Voyage, ...] = field(repr=False)  # it was judged by

    @property
    def accepted(self) -> bool:
        """Whether the held-out error falls; `ship` has the effects all the same, so ask before you save."""
        return bool(self.data["accepted"])

    @property
    def error_before_m(self) -> float:
        """Mean open-loop position error [m] on held-out voyages at the longest horizon, without the
        effects."""
        return float(self.data["horizons"][-1]["before"]["position_mae_m"])

    @property
    def error_after_m(self) -> float:
        """The same with them."""
        return float(self.data["horizons"][-1]["after"]["position_mae_m"])

    @property
    def interval_m(self) -> tuple[float, float]:
        """95 % interval of what the proof is about, after minus before (`data["judged_by"]` says what and in
        which unit)."""
        return float(self.data["judged_by"]["low95"]), float(self.data["judged_by"]["high95"])

    @property
    def errors(self) -> "pandas.DataFrame":
        """One row a horizon: errors before and after, and what was expected."""
        return frame(self.data["horizons"])

    @property
    def refused(self) -> str:
        """Why it is not proved, and what would prove it."""
        return refused(self.made.proof, self.made.fall, self.data["proof"]["kind"] == HELD_OUT)

    def text(self) -> list[str]:
        """The lines of `twin add`."""
        return [*terminal_lines(self.to_dict()), *losses(self.data["data_checks"])]

    def _rows(self) -> Any:
        return [
            {"effect": effect, "parameter": name, **number}
            for effect, numbers in self.data["parameters"].items()
            for name, number in numbers.items()
        ]

    def __repr__(self) -> str:
        fall = f"{metres(self.error_before_m)} -> {metres(self.error_after_m)}"
        return (
            f"<Update of {self.data['ship']!r} with {', '.join(self.data['added'])}: {fall}, accepted: "
            f"{self.accepted}>"
        )

    def plot(self) -> "matplotlib.axes.Axes":
        """Held-out position error over horizon, before and after."""
        from matplotlib import pyplot

        _, axes = pyplot.subplots()
        rows = self.data["horizons"]
        for key in ("before", "after"):
            axes.plot(
                [r["horizon_s"] for r in rows], [r[key]["position_mae_m"] for r in rows], "o-", label=key
            )
        axes.set(xlabel="horizon [s]", ylabel="held-out position error [m]", title=self.data["ship"])
        axes.set_ylim(bottom=0.0)
        axes.legend()
        return axes

    def page(self) -> str:
        """The page of `twin add --report`."""
        from twin.report.page import content, html

        result = self.to_dict() | {"history": self.ship.notes["history"]}
        made, voyages = self.made, list(self.voyages)
        return html(content("add", result, made.held, made.model, Model.of(self.before), voyages))


def add(
    ship: Ship,
    effects: str | Sequence[str],
    voyages: Voyage | Iterable[Voyage],
    *,
    held_out: Voyage | Iterable[Voyage] = (),
    cross_validated: bool = False,
    force: bool = False,
    progress: Progress | None = None,
) -> Update:
    """Fit named effects to the voyages and prove on held-out ones that the error falls.

    `held_out`: voyages to judge by; without any the last third of every voyage, or (`cross_validated`) every
    third in turn. `force`: accepted although it is not proved. SettingsError when there is no such effect,
    DataError when a voyage lacks what it needs, UsageError when no effect is named.
    """
    names = [effects] if isinstance(effects, str) else list(effects)
    if not names:
        raise UsageError("no effect to add. `twin.diagnose(...).effects` may be empty: look at its sentence.")
    chosen = [find_for(name, ship) for name in dict.fromkeys(names)]
    used, kept = ([sailed(v, ship) for v in vs] for vs in (at_least_one(voyages), several(held_out)))
    return of_sailed(ship, chosen, used, kept, cross_validated, force, quietly(progress))


def check_proof(held_out: Sequence[Any], cross_validated: bool) -> None:
    """UsageError where a proof would rest on voyages held out and on thirds of the others alike."""
    if held_out and cross_validated:
        raise UsageError("--held-out and --cross-validated: a proof rests on one of them. Leave one out.")


def of_sailed(
    ship: Ship,
    effects: Sequence[type[Effect]],
    used: Sequence[Sailed],
    kept: Sequence[Sailed],
    cross_validated: bool,
    force: bool,
    tell: Progress,
) -> Update:
    """The same of voyages that are read already. DataError: one is given twice."""
    refuse_twice((s.voyage.name, s.sha256) for s in (*used, *kept))
    check_proof(kept, cross_validated)
    made = fitted(ship, effects, used, kept, force, cross_validated, tell)
    return Update(made.ship, ship, made, tuple(s.voyage for s in kept or used), data=made.result)


def remove(ship: Ship, effects: str | Sequence[str]) -> Ship:
    """The ship without these effects, its history remembering both; SettingsError when it has no such
    effect."""
    return taken_out(ship, [effects] if isinstance(effects, str) else list(effects))
