"""`twin.check_voyage`: do the signs, units, frames and clocks of a voyage agree with each other; and
`twin.suggest_map`: what the columns of an unknown table may be."""

import os
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from twin.api.result import PathLike, Result
from twin.errors import UsageError
from twin.num import as_given
from twin.physics.ship import Ship
from twin.recording.checks import Check
from twin.recording.checks.proved_wrong import refusal
from twin.recording.formats.choose import sources_of
from twin.recording.import_voyage import Imported, checked, import_voyage, summary
from twin.recording.suggest_map import suggestion
from twin.recording.voyage import Voyage

if TYPE_CHECKING:
    from twin.report.curves import Drawings

WORDS = ("mistake", "look", "content")  # what a check says of a voyage, the worst first


@dataclass(frozen=True, repr=False)
class VoyageCheck(Result):
    """`voyage`, and what each check has seen in it. Its rows are the checks: name, whether it is content,
    whether it proves a mistake, and its words."""

    voyage: Voyage
    checks: tuple[Check, ...] = field(repr=False)

    def refused(self, accept: Collection[str] = ()) -> list[str]:
        """The names of the checks that prove a sign, unit or frame wrong and are not accepted."""
        return [c.name for c in self._imported.refused(accept)]

    def refusal(self, path: str, accept: Collection[str] = (), map: str | None = None) -> str:
        """Why the file at `path`, read by this `map`, is not imported, and the two ways out: one line."""
        return refusal(path, self._imported.refused(accept), map)

    def text(self, every: bool = False) -> list[str]:
        """The lines of `twin import`; `every`: what each check saw, those that are content too."""
        return summary(self._imported, every)

    @property
    def _imported(self) -> Imported:
        return Imported(self.voyage, list(self.checks))

    def _rows(self) -> Any:
        return self.data["data_checks"]

    def page(self) -> str:
        """What each check has seen, and every channel over time."""
        from twin.report.result_page import PageTable, result_page

        wrong = ", ".join(self.refused())
        said = f"{wrong}: a sign, unit or frame is wrong." if wrong else "No check proves a mistake."
        rows = [{"name": c.name, "said": _said(c), "text": c.text} for c in self.checks]
        rows.sort(key=lambda row: WORDS.index(row["said"]))
        v, derived = self.voyage, dict(self.data.get("derived", {}))
        found = [{"name": name, "from": text} for name, text in derived.items()]
        facts = [
            f"{v.name}: {len(v)} rows, {as_given(v.duration_s, 5)} s, a row each {as_given(v.step_s)} s.",
            *([f"Not recorded: {', '.join(v.absent())}."] if v.absent() else []),
            *map(str, self.data.get("notes", ())),
        ]
        return result_page(
            v.name,
            said,
            facts,
            (
                PageTable("Checks", {"name": "check", "said": "says", "text": "what it saw"}, rows),
                PageTable("Found from other channels", {"name": "channel", "from": "from"}, found),
                _channels(v),
            ),
        )

    def __repr__(self) -> str:
        wrong = ", ".join(self.refused()) or "no mistake proved"
        return f"<VoyageCheck of {self.voyage.name!r}: {len(self.checks)} checks, {wrong}>"


def _said(check: Check) -> str:
    return WORDS[0] if check.unusable else WORDS[2] if check.ok else WORDS[1]


def _channels(voyage: Voyage) -> "Drawings":
    """A small drawing of each channel that was recorded."""
    from twin.report.curves import LOW, Curve, Curves, Drawings, thinned

    t = voyage.time_s - voyage.time_s[0]
    names = [name for name in voyage.columns if voyage.has(name)]
    each = [
        Curves(name, "", "", [Curve("recorded", "--measured", thinned(t, voyage[name]))], high=LOW)
        for name in names
    ]
    return Drawings("Channels over time [s]", each)


def check_voyage(ship: Ship | None, voyage: Voyage) -> VoyageCheck:
    """Ask every check of `twin import` about a voyage; a `ship` lets them say more (None: not known).

    A mistake that is proved is no error here: see `refused`. Milliseconds to a second.
    """
    return _of(checked(voyage, ship))


def import_file(
    path: Sequence[PathLike],
    map: PathLike | None = None,
    ship: PathLike | None = None,
    sources: Sequence[str] = (),
    controls: bool = True,
    accept: Sequence[str] = (),
) -> VoyageCheck:
    """A file or several read as one voyage, and checked: what `twin import` does."""
    paths = [Path(p) for p in path]
    return _of(import_voyage(paths, map, ship, sources, controls, accept))  # type: ignore[arg-type]


def _of(found: Imported) -> VoyageCheck:
    return VoyageCheck(found.voyage, tuple(found.checks), data=found.as_json())


def suggest_map(paths: PathLike | Iterable[PathLike], *, sources: Iterable[str] = ()) -> str:
    """The map of one table or several whose columns are not known, as TOML to be confirmed by a person; what
    each line rests on stands beside it.

    `sources`: the instrument to take of several, as "CHANNEL=NAME" or "NAME". DataError when a file cannot be
    used; UsageError when none is given.
    """
    given = [paths] if isinstance(paths, str | os.PathLike) else list(paths)
    if not given:
        raise UsageError("no file to propose a map for: give one or more.")
    return suggestion([Path(p) for p in given], sources_of(list(sources)))
