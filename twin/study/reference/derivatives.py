"""The core's derivatives as reference voyages tell of them, and as the ship file remembers them."""

import datetime
from collections.abc import Sequence
from dataclasses import replace
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.ship_notes import read_from
from twin.study.estimation.box import within
from twin.study.estimation.columns import Unknown, core_unknowns, with_values
from twin.study.estimation.dissipation import half_spaces
from twin.study.estimation.fit import Fit

KEPT = "prior kept: the reference voyages do not excite it"
UNEXCITED = 0.1  # a derivative of whose prior variance the voyages took away less than this keeps its prior


class Derivative(NamedTuple):
    """One derivative; `gained`: what the voyages took away of its prior variance."""

    unknown: Unknown
    fitted: float
    sd: float
    gained: float

    @property
    def excited(self) -> bool:
        """Whether the voyages say enough of it."""
        return self.gained >= UNEXCITED

    @property
    def value(self) -> float:
        """What it is taken for: as fitted, or where its prior is."""
        return self.fitted if self.excited else self.unknown.centre


def informed_by(found: Fit) -> list[Derivative]:
    """Those among the fit's unknowns; where those that keep their priors would leave the others with a hull
    that does not dissipate, the others are the nearest with which it does."""
    rows = zip(found.unknowns, found.value.tolist(), found.sd.tolist(), found.gained.tolist(), strict=True)
    told = [Derivative(*row) for row in rows if row[0].owner == "core"]
    free = [d for d in told if d.excited]
    if not free:
        return told
    kept = found.model.ship.with_derivatives(**{n: d.unknown.centre for d in told for n in d.unknown.names})
    centre, prior, sd = np.array([(d.unknown.centre, d.unknown.sd, d.sd) for d in free]).T
    z = (np.array([d.fitted for d in free]) - centre) / prior
    lo, hi = np.array([(d.unknown.lo, d.unknown.hi) for d in free]).T
    box = (np.array([lo, hi]) - centre) / prior
    near = within(z, np.diag((sd / prior) ** 2), box, half_spaces(kept, [d.unknown for d in free]))
    fitted = np.clip(centre + prior * near, lo, hi)  # in widths of a prior a box ends a rounding error off
    value = dict(zip((d.unknown.name for d in free), fitted.tolist(), strict=True))
    return [d._replace(fitted=value.get(d.unknown.name, d.fitted)) for d in told]


def first_prior(unknown: Unknown, ship: Ship) -> Unknown:
    """A derivative that was calibrated before keeps the prior that it had then, so that no voyage counts
    twice."""
    entry = ship.notes.get("derivatives", {}).get(unknown.name, {}) if unknown.owner == "core" else {}
    centre = entry.get("prior_value") if isinstance(entry, dict) else None
    return unknown if centre is None else replace(unknown, centre=float(centre))


def by_particulars(ship: Ship) -> Ship:
    """The ship with the derivatives that it had before it was calibrated first, as far as its file keeps
    them."""
    model = Model.of(ship)
    own = [first_prior(u, ship) for u in core_unknowns(model)]
    return with_values(model, own, [u.centre for u in own], {}).ship


def with_derivatives(ship: Ship, found: Sequence[Derivative]) -> Ship:
    """The ship with their values, standard errors and priors."""
    source = (
        (f"calibrated {datetime.date.today().isoformat()}"),
        KEPT,
    )
    entries = {
        name: {
            "value": d.value,
            "unit": d.unknown.unit,
            "sd": d.sd,
            "prior_value": d.unknown.centre,
            "prior_sd": d.unknown.sd,
            "source": source[not d.excited],
        }
        for d in found
        for name in d.unknown.names
    }
    after = ship.with_derivatives(**{name: d.value for d in found for name in d.unknown.names})
    return noted(after, "derivatives", entries)


def with_core_of(ship: Ship, other: Ship) -> Ship:
    """The ship with the derivatives of another fit to the same voyages; their standard errors stay."""
    values = {name: float(other.derivative(name)) for name in ship.notes["derivatives"] if other.has(name)}
    entries = {name: ship.notes["derivatives"][name] | {"value": value} for name, value in values.items()}
    return noted(ship.with_derivatives(**values), "derivatives", entries)


def one_step_core(ship: Ship, by_steps: Ship) -> dict[str, float]:
    """What the ship file keeps of the core that was fitted by steps: by how much that differs from the file's
    own [prime units]; nothing where it is the file's own."""
    off = {name: _off(name, ship, by_steps) for name in ship.notes["derivatives"] if ship.has(name)}
    return {name: x for name, x in off.items() if x}


def _off(name: str, ship: Ship, by_steps: Ship) -> float:
    return float(by_steps.derivative(name)) - float(ship.derivative(name))


def with_one_step_core(ship: Ship) -> Ship:
    """The ship with the core that predicts best one step ahead, as a filter reads a voyage. Its file has
    another one where that predicts better several lengths ahead; a voyage is judged about the one by which
    the noise model and the numbers' covariance were found. Inside the boxes, also where its owner has moved a
    number of the file since. SettingsError: the file does not hold it as it was written."""
    off, model = ship.notes.get("structural", {}).get("one_step_core", {}), Model.of(ship)
    with read_from(ship, "[structural] one_step_core"):
        own = [(u, u.centre + float(off[u.name])) for u in core_unknowns(model) if u.name in off]
        if not all(isfinite(value) for _, value in own):
            raise ValueError("not finite")
    return with_values(model, [u for u, _ in own], [value for _, value in own], {}).ship


def noted(ship: Ship, section: str, entries: dict[str, Any]) -> Ship:
    """The ship whose file remembers this too."""
    return replace(ship, notes={**ship.notes, section: {**ship.notes.get(section, {}), **entries}})
