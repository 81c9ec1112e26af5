"""`twin.check_effect`: is an effect of one's own fit for the loop, the study, the training and the
certificate."""

from dataclasses import dataclass, field
from typing import Any

from twin.api.result import Result
from twin.physics.effect import Effect
from twin.physics.ship import Ship
from twin.report.effect_contract import Answer, answers_as_json, check, find_to_check


@dataclass(frozen=True, repr=False)
class EffectCheck(Result):
    """What was asked of an effect, and the answers. Its rows are the questions: answer and words."""

    effect: type[Effect]
    answers: tuple[Answer, ...] = field(repr=False)

    @property
    def wrong(self) -> list[str]:
        """The questions whose answer must be mended; empty where the effect is sound."""
        return [a.question for a in self.answers if a.ok is False]

    def text(self) -> list[str]:
        """The lines of `twin effects --check`."""
        return [self.effect.__name__, *(a.line() for a in self.answers)]

    def _rows(self) -> Any:
        return self.data["answers"]

    def page(self) -> str:
        """Every question with its answer."""
        from twin.report.result_page import PageTable, result_page

        said = f"{len(self.wrong)} of {len(self.answers)} to mend." if self.wrong else "Sound."
        rows = [a._asdict() for a in self.answers]
        columns = {"question": "question", "ok": "sound", "text": "what is wrong"}
        return result_page(self.effect.__name__, said, parts=(PageTable("Questions", columns, rows),))

    def __repr__(self) -> str:
        return f"<EffectCheck of {self.effect.__name__}: {len(self.wrong)} of {len(self.answers)} to mend>"


def check_effect(effect: type[Effect] | str, *, ship: Ship | None = None) -> EffectCheck:
    """Ask an effect everything that the twin will ask of it: null does nothing, whole voyages, tensors,
    intervals, a mirrored ship, finite slopes at rest.

    `effect`: its class, or its name: of the catalogue, of an installed one however broken, or a file NAME.py.
    `ship`: on which (default: a bundled one). SettingsError when there is no such effect. Seconds.
    """
    kind = find_to_check(effect) if isinstance(effect, str) else effect
    answers = check(kind, ship)
    return EffectCheck(kind, tuple(answers), data=answers_as_json(kind, answers))
