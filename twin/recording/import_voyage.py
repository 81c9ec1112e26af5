"""`twin import`: measurements in, checked; a file that a check proves wrong is refused."""

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from twin.errors import SettingsError, did_you_mean
from twin.num import as_given
from twin.physics.ship import Ship, load
from twin.recording.checks import CHECKS, Check, run_checks
from twin.recording.checks.proved_wrong import proved_wrong
from twin.recording.formats.choose import sources_of
from twin.recording.map_file import read_map
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage

SCHEMA_VERSION = 1


class Imported(NamedTuple):
    """A voyage and what the checks say of it."""

    voyage: Voyage
    checks: list[Check]

    def refused(self, accept: Collection[str] = ()) -> list[Check]:
        """The checks that prove a mistake and are not accepted."""
        return proved_wrong(self.voyage, self.checks, accept)

    def as_json(self) -> dict[str, Any]:
        """What `twin import --json` writes."""
        v = self.voyage
        return {
            "schema_version": SCHEMA_VERSION,
            "voyage": v.name,
            "rows": len(v),
            "duration_s": v.duration_s,
            "step_s": v.step_s,
            "columns": [name for name in v.columns if v.has(name)],
            "absent": list(v.absent()),
            **{
                key: v.meta[key]
                for key in ("source", "map", "ship", "datum", "start_time_utc")
                if key in v.meta
            },
            "derived": dict(v.meta.get("derived", {})),
            "notes": list(v.meta.get("notes", ())),
            "data_checks": [c.as_json() for c in self.checks],
        }


def import_voyage(
    path: str | Path | Sequence[str | Path],
    map_path: str | Path | None = None,
    ship_path: str | Path | None = None,
    sources: Sequence[str] = (),
    controls: bool = True,
    accept: Sequence[str] = (),
) -> Imported:
    """Reads a file or several, through a map if they have their own columns, and checks them, with a ship if
    one is given. `accept`: checks that refuse it nowhere."""
    ship = load(ship_path) if ship_path else None
    voyage = read_voyage(path, read_map(Path(map_path)) if map_path else None, sources_of(sources), controls)
    return checked(accepted(voyage, accept), ship)


def accepted(voyage: Voyage, accept: Sequence[str]) -> Voyage:
    """The voyage with the names of checks that refuse it nowhere, beside those it has. SettingsError: no
    check has such a name."""
    known_checks(accept)
    every = {*accept, *voyage.meta.get("accepted", ())}
    return voyage.with_meta(accepted=sorted(every)) if every else voyage


def checked(voyage: Voyage, ship: Ship | None) -> Imported:
    """A voyage that was read, and what the checks say of it, with a ship if one is given."""
    if ship:
        voyage = voyage.with_meta(ship=ship.name)
    return Imported(voyage, run_checks(voyage, ship))


def known_checks(names: Sequence[str]) -> None:
    """SettingsError when one of the names is no check's."""
    known = [check.__name__ for check in CHECKS]
    for name in names:
        if name not in known:
            raise SettingsError(f"--accept: no check is called {name!r}.{did_you_mean(name, known)}")


def summary(found: Imported, every: bool = False) -> list[str]:
    """What is wrong first, then what asks for a look; what is quiet is one line, unless every check is asked
    for."""
    v = found.voyage
    lines = [f"{v.name}: {len(v)} rows, {as_given(v.duration_s, 6)} s, {how_often(v)}{read_as(v)}"]
    wrong = [c for c in found.checks if c.unusable]
    looks = [c for c in found.checks if not c.ok and not c.unusable]
    quiet = [c for c in found.checks if c.ok]
    lines += [f"  {mark(c):8s} {c.name}: {c.text}" for c in (*wrong, *looks, *(quiet if every else ()))]
    if not every:
        lines.append(f"  {quietly(quiet)}")
    lines += [f"  derived  {name}: {how}" for name, how in v.meta.get("derived", {}).items()]
    return lines + [f"  note     {note}" for note in v.meta.get("notes", ())]


def how_often(v: Voyage) -> str:
    """How often it was sampled; of a log with a row for each sentence of each instrument, how often a heading
    was."""
    headed = np.diff(v.time_s[np.isfinite(v.columns["heading_true_north_deg"])])
    usual = float(np.median(headed)) if headed.size else v.step_s
    what = "a heading" if usual > 1.5 * v.step_s else "a sample"
    return f"{what} every {as_given(usual, 6)} s"


def read_as(v: Voyage) -> str:
    """In what format it was read, for the sentence that says so."""
    return f", read as {v.meta['format']}" if "format" in v.meta else ""


def quietly(quiet: Sequence[Check]) -> str:
    """One line for the checks that have nothing against the voyage, and the names of those that cannot
    tell."""
    blind = [c.name for c in quiet if not c.informative]
    cannot = f"; cannot tell: {', '.join(blind)}" if blind else ""
    return (
        f"ok       {len(quiet) - len(blind)} checks have nothing against it{cannot} (--every-check: what "
        "each saw)"
    )


def mark(check: Check) -> str:
    """The word in front of a check's sentence."""
    return "WRONG" if check.unusable else "look" if not check.ok else "ok" if check.informative else "?"
