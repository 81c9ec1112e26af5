"""`twin.instruments`: what is wrong with the instruments, by how their readings go together."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from twin.api.result import Progress, Result, quietly
from twin.api.voyages import at_least_one
from twin.errors import UsageError
from twin.num import readable
from twin.physics.ship import Ship
from twin.recording.checks import of_voyages
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.instruments.corrections import as_map, corrected
from twin.study.instruments.instrument_estimate import Instruments, estimate
from twin.study.instruments.instrument_lines import (
    ambiguities,
    amount,
    as_it_is,
    as_json,
    either,
    nothing_new,
    terminal_lines,
)
from twin.study.instruments.ship_file_numbers import as_filed

if TYPE_CHECKING:
    import matplotlib.axes

FRAMES = {"compass": "course", "receiver": "body"}  # who turned the velocity -> the frame it came in


@dataclass(frozen=True, repr=False)
class InstrumentCheck(Result):
    """What is wrong with compass, log, receiver, gyro and vane. Its rows are the numbers: value, 95 %
    interval, whether it was seen, and what these voyages cannot tell."""

    found: Instruments = field(repr=False)
    ship: Ship | None = field(default=None, repr=False)

    @property
    def faults(self) -> list[str]:
        """The faults that were seen, by the names of docs/instruments.md."""
        return [str(f["fault"]) for f in self.data["faults"]]

    @property
    def distinct(self) -> list[str]:
        """Those of them that these voyages tell from every other: what `as_map` writes, and `corrected` but
        for those that the ship's file has."""
        return [str(f["fault"]) for f in self.data["faults"] if not f["or_instead"]]

    @property
    def as_filed(self) -> list[str]:
        """Those of them that the file of the ship they were asked with has, within 95 % of what these voyages
        and the file leave open."""
        return as_filed(self.ship, self.found)

    @property
    def effects(self) -> list[str]:
        """The same as effects of the catalogue; a fault that no effect describes is left out."""
        return list(dict.fromkeys(f["effect"] for f in self.data["faults"] if f["effect"]))

    def corrected(self, ship: Ship) -> Ship:
        """The ship with the `distinct` faults as effects of its instruments, but for those that its file has
        as these voyages tell them; what its effect cannot hold is left out (`not_held`), and so is what these
        voyages do not tell from another (`ambiguous`)."""
        return corrected(ship, self.found)[0]

    def not_held(self, ship: Ship) -> list[str]:
        """The numbers of `distinct` faults that no effect of the catalogue holds, each with its size and
        unit."""
        left = corrected(ship, self.found)[1]
        return [f"{e.unknown.meaning} ({amount(e.value, e.unknown.unit)})" for e in left]

    def not_written(self, ship: Ship | None) -> str:
        """Why `corrected` would leave this ship as it is, or, where it is None, `as_map` has nothing to take
        off; "" where there is something to write."""
        if self.distinct and (ship is None or self.corrected(ship).effects != ship.effects):
            return ""
        out = self.ambiguous() + [as_it_is(f) for f in self.as_filed]
        out += [f"no effect holds {left}" for left in (self.not_held(ship) if ship else ())]
        return "; ".join(out) or "no fault of an instrument was seen"

    def ambiguous(self) -> list[str]:
        """Of each fault that was seen and that these voyages do not tell from another: from which, and what
        would tell them apart; of those that the ship's file has (`as_filed`), nothing."""
        return ambiguities(self.found, self.as_filed)

    def as_map(self) -> str:
        """The lines of a map that take the constants of `distinct` faults off. SettingsError when there are
        none."""
        return as_map(self.found)

    def text(self) -> list[str]:
        """The lines of `twin instruments`."""
        return terminal_lines(self.found, self.ship)

    def _rows(self) -> Any:
        return self.data["numbers"]

    def __repr__(self) -> str:
        voyages = ", ".join(v["name"] for v in self.data["voyages"])
        return f"<InstrumentCheck of {voyages}: {', '.join(self.faults) or 'no fault seen'}>"

    def page(self) -> str:
        """The faults that were seen, and every number with its 95 % interval."""
        from twin.report.result_page import Bars, PageTable, result_page

        faults = [f | {"called": f["effect"] or f["fault"]} for f in self.data["faults"]]
        new = [f for f in faults if f["fault"] not in self.as_filed]
        seen = ", ".join(either(f["fault"], f["or_instead"]) for f in new) or nothing_new(self.as_filed)
        columns = {"meaning": "number", "value": "value", "lo": "from", "hi": "to", "unit": "unit"}
        more = {"seen": "seen", "unseen_below": "else less than", "hard_to_tell_from": "hard to tell from"}
        bayes = {"log_bayes_factor_of_any": "log Bayes factor"}
        return result_page(
            f"Instruments of {', '.join(v['name'] for v in self.data['voyages'])}",
            f"{seen[0].upper()}{seen[1:]}.",
            parts=(
                Bars("What was seen", "", "called", bayes, faults),
                PageTable("Numbers (95 %)", columns | more, [readable(n) for n in self.data["numbers"]]),
            ),
        )

    def plot(self) -> "matplotlib.axes.Axes":
        """Every number in its own standard errors, with its 95 % interval; 0: nothing is wrong."""
        from matplotlib import pyplot

        _, axes = pyplot.subplots()
        rows = [n for n in self.data["numbers"] if n["cramer_rao_sd"]][::-1]
        for k, n in enumerate(rows):
            at, low, high = (n[key] / n["cramer_rao_sd"] for key in ("value", "lo", "hi"))
            axes.plot([low, high], [k, k], "-", color="C0" if n["seen"] else "0.7")
            axes.plot([at], [k], "o", color="C0" if n["seen"] else "0.7")
        axes.axvline(0.0, color="0.5", lw=0.8)
        axes.set_yticks(range(len(rows)), [n["name"] for n in rows])
        axes.set(xlabel="value over its standard error")
        return axes


def instruments(
    ship: Ship | None,
    voyages: Voyage | Iterable[Voyage],
    *,
    velocity_by: str | None = None,
    progress: Progress | None = None,
) -> InstrumentCheck:
    """Ask whether position, velocity, heading, rate of turn, log and wind of these voyages agree, without
    rudder, shaft or model (`read_voyage(..., controls=False)`).

    Of the `ship` only the length is used: how far off an antenna may be; None: nothing is known of it.
    `velocity_by`: what turned the velocity over ground into the ship's axes, "compass" or "receiver"; else as
    recorded, or as the readings say. DataError when a voyage cannot be used; UsageError for another
    `velocity_by`. Seconds to minutes.
    """
    if velocity_by not in (None, *FRAMES):
        raise UsageError(
            f"velocity_by={velocity_by!r}: give {' or '.join(map(repr, FRAMES))}, or leave it out."
        )
    asked = at_least_one(voyages)
    of_voyages(asked)
    if velocity_by:
        asked = [v.with_meta(velocity_frame=FRAMES[velocity_by]) for v in asked]
    found = estimate(asked, float(ship.L_pp) if ship else None, quietly(progress), varying=True)
    said = {"schema_version": 1, "ship": ship.name if ship else None} | as_json(found)
    return InstrumentCheck(found, ship, data=plain(said))
