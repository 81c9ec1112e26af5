"""One mistake in a recording, as the checks try it: its name, how it is undone, what the map needs."""

from collections.abc import Callable
from dataclasses import dataclass

from twin.recording.checks.undo import (
    Undo,
)
from twin.recording.checks.voyage_view import VoyageView

Words = Callable[[VoyageView], str]


@dataclass(frozen=True)
class Single:
    """One mistake: `undo(view)` gives the change of columns, `needs` the measured columns without which it
    cannot be."""

    text: Words
    undo: Callable[[VoyageView], Undo]
    fix: Words
    check: str
    needs: tuple[str, ...]
    uses: frozenset[str]
    frame: str = ""

    def possible(self, view: VoyageView, given: frozenset[str]) -> bool:
        """Whether the columns that it needs were given, in the velocity frame that it is about."""
        frame = view.voyage.meta.get("velocity_frame") or "body"
        return set(self.needs) <= given and self.frame in ("", frame)


def said(text: str) -> Words:
    """The same words for every voyage."""
    return lambda view: text


def changes(undo: Undo) -> Callable[[VoyageView], Undo]:
    """The same way back for every voyage."""
    return lambda view: undo


def scaled(name: str, by: float) -> Undo:
    """A way back: the column times `by`."""
    return lambda c: {name: c[name] * by}
