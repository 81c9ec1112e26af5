"""What reference voyages showed of the predictions' errors, as the ship file's [tube] holds it.

    sigma_i = usual_i exp(c_i . phi)                 i: along, across the predicted track, heading
    place:   (along/sigma_along)^2 + (across/sigma_across)^2 <= q^2          heading:  |error| <= q sigma

q is the quantile that a new voyage like the references keeps with the level (`twin tube`); it is looked up in
the regime's own cell where 45 voyages filled it, else in its parent's.
"""

from collections.abc import Mapping
from math import exp
from typing import Any, NamedTuple

from twin.errors import SettingsError
from twin.live.prediction.circumstances import NAMES, Regressors
from twin.num import as_given
from twin.physics.maths import dot, total
from twin.physics.ship import Ship

SECTION = "tube"
AXES = ("along", "across", "heading")
TARGETS = ("place", "heading")
BEYOND = (4, 5, 6)  # of phi: waves, wind, the estimate's sigma; beyond the references nothing is promised
WORDS = {4: "wave height", 5: "wind", 6: "uncertainty of the estimate"}
OWN = len(NAMES) - 2  # from here on phi of place and phi of heading differ
GREATEST_EXPONENT = 50.0  # of exp(c . phi): beyond it is no error of a ship any more
ROOM = 0.1  # of the references' range, by which it may be left


class Cell(NamedTuple):
    """A regime: on how many voyages it rests, and the quantiles of place and heading at the levels."""

    voyages: int
    place: tuple[float, ...]
    heading: tuple[float, ...]


class Horizon(NamedTuple):
    """The coefficients c of along, across and heading, and the cells by name."""

    coefficients: tuple[tuple[float, ...], ...]
    cells: dict[str, Cell]


class RegionTable(NamedTuple):
    """[tube] of a ship file. `level`: what is promised, `levels`: of the quantiles, rising."""

    level: float
    voyages: int
    model: str
    levels: tuple[float, ...]
    low: tuple[float, ...]  # phi over the references: of place, sigma and error of heading behind it
    high: tuple[float, ...]
    seas: tuple[str, ...]
    horizons: dict[float, Horizon]

    def horizon(self, horizon_s: float) -> float | None:
        """The horizon of the table that this one is."""
        return next((h for h in self.horizons if abs(h - horizon_s) < 0.5), None)

    def sigmas(self, h: float, known: Regressors, usual: tuple[float, ...]) -> tuple[float, float, float]:
        """The usual error along, across [m] and in heading [rad]."""
        place, heading = self.within(known)
        along, across, turning = self.horizons[h].coefficients
        return (
            usual[0] * exp(dot(along, place)),
            usual[0] * exp(dot(across, place)),
            usual[1] * exp(dot(turning, heading)),
        )

    def within(self, known: Regressors) -> tuple[list[float], list[float]]:
        """phi held inside what the references had."""
        values = (*known.place, *known.heading[OWN:])
        held = [
            lo if x < lo else hi if x > hi else x
            for x, lo, hi in zip(values, self.low, self.high, strict=True)
        ]
        return held[: OWN + 2], held[:OWN] + held[OWN + 2 :]

    def beyond(self, known: Regressors) -> str:
        """What no reference voyage had, in words; "" where they had it all."""
        if known.sea not in self.seas and "unknown" in (known.sea, *self.seas):
            return "wave height is not known" if known.sea == "unknown" else "no reference knew its waves"
        for k in BEYOND:
            if known.place[k] > self.high[k] + ROOM * max(self.high[k] - self.low[k], 1.0):
                return f"{WORDS[k]} above the references'"
        return ""

    def cell(self, h: float, known: Regressors) -> tuple[str, Cell]:
        """The regime's own cell, else its parent's."""
        cells = self.horizons[h].cells
        name = next(n for n in (f"{known.helm}_{known.sea}", known.helm, "all") if n in cells)
        return name, cells[name]

    def promise(self, cell: Cell) -> float:
        """The level, or the best that so few voyages can show."""
        return min(self.level, cell.voyages / (cell.voyages + 1.0))

    def quantile(self, of: tuple[float, ...], level: float) -> float:
        """At this level, on the line between the two around it; held inside the table."""
        levels = self.levels
        for k in range(1, len(of)):
            if level <= levels[k]:
                share = max((level - levels[k - 1]) / (levels[k] - levels[k - 1]), 0.0)
                return of[k - 1] + share * (of[k] - of[k - 1])
        return of[-1]


def calibrated_of(ship: Ship) -> RegionTable | None:
    """The ship file's [tube]; None where it has none. SettingsError where it cannot be used."""
    table = ship.notes.get(SECTION)
    if table is None:
        return None
    try:
        return _read(table)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise SettingsError(
            f"{ship.name}: [tube] cannot be used ({type(error).__name__}: {error}). Make it again by "
            "`twin tube`, or leave the whole section out."
        ) from None


def _read(table: Mapping[str, Any]) -> RegionTable:
    n = len(NAMES)
    level, levels = float(table["level"]), _row(table["levels"])
    if not levels or list(levels) != sorted(levels):
        raise ValueError("levels must rise")
    if not 0.0 < level < 1.0:
        raise ValueError(f"level = {as_given(level)} is no share between 0 and 1")
    low, high = _row(table["lowest"], n + 2), _row(table["highest"], n + 2)
    if any(lo > hi for lo, hi in zip(low, high, strict=True)):
        raise ValueError("lowest lies above highest")
    horizons = {
        float(h): Horizon(
            tuple(_row(table[f"{axis}_{h:g}s"], n) for axis in AXES),
            {
                name.removeprefix(f"cell_{h:g}s_"): _cell(entry, len(levels))
                for name, entry in table.items()
                if name.startswith(f"cell_{h:g}s_")
            },
        )
        for h in table["horizons_s"]
    }
    if not horizons or any("all" not in h.cells for h in horizons.values()):
        raise ValueError("a horizon without its cell `all`")
    widest = [max(abs(lo), abs(hi)) for lo, hi in zip(low, high, strict=True)]
    place, heading = widest[: OWN + 2], widest[:OWN] + widest[OWN + 2 :]
    for horizon in horizons.values():
        for row, phi in zip(horizon.coefficients, (place, place, heading), strict=True):
            if total(abs(c) * x for c, x in zip(row, phi, strict=True)) > GREATEST_EXPONENT:
                raise ValueError("coefficients that no references give")
    return RegionTable(
        level,
        int(table["voyages"]),
        str(table["model"]),
        levels,
        low,
        high,
        tuple(table["seas"]),
        horizons,
    )


def _cell(entry: Mapping[str, Any], most: int) -> Cell:
    place, heading = _row(entry["place"]), _row(entry["heading"])
    if not 0 < len(place) == len(heading) <= most:
        raise ValueError(f"a cell with {len(place)} quantiles for {most} levels")
    if any(not row[0] > 0.0 or list(row) != sorted(row) for row in (place, heading)):
        raise ValueError("quantiles must lie above 0 and rise")
    return Cell(int(entry["voyages"]), place, heading)


def _row(values: Any, count: int | None = None) -> tuple[float, ...]:
    row = tuple(float(x) for x in values)
    if (count is not None and len(row) != count) or any(not abs(x) < 1e12 for x in row):
        raise ValueError(f"{count} finite numbers are needed")
    return row
