"""A voyage as it would be had one mistake not been made: columns changed, what follows from them made anew.

Velocities that the heading turned into the ship's axes are turned back first, so that another heading turns
them otherwise.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from twin.recording.checks.voyage_view import VoyageView
from twin.recording.place import derive
from twin.recording.voyage import Voyage

NORTH, EAST, HEADING = "north_m", "east_m", "heading_true_north_deg"
AHEAD, ASIDE, RATE = "surge_velocity_mps", "sway_velocity_mps", "yaw_rate_degps"
RUDDER, TURNS = "rudder_angle_deg", "propeller_rate_rpm"
Columns = Mapping[str, np.ndarray]
Undo = Callable[[Columns], dict[str, np.ndarray]]
FIRST, SECOND = "first_velocity", "second_velocity"  # as they were given: ahead and aside, or north and east


def by_heading(voyage: Voyage) -> bool:
    """Whether the velocities were turned into the ship's axes by the heading (given by the earth, or by
    course)."""
    return voyage.meta.get("velocity_frame") in ("earth", "course")


def measured(voyage: Voyage) -> dict[str, np.ndarray]:
    """The columns that were measured, velocities as they were given, and the clock. Each (N,), in the unit
    in its name."""
    derived = voyage.meta.get("derived", {})
    out = {name: x for name, x in voyage.columns.items() if name not in derived and np.isfinite(x).any()}
    if AHEAD in out and ASIDE in out:
        w = out.pop(AHEAD) + 1j * out.pop(ASIDE)
        if by_heading(voyage):
            w = w * np.exp(1j * np.radians(out[HEADING]))
        out |= {FIRST: w.real, SECOND: w.imag}
    return out | {"time_s": voyage.time_s}


def remade(voyage: Voyage, columns: Columns) -> Voyage:
    """The voyage of measured columns: velocities turned by the heading, what was derived derived again.
    Each column (N,), in the unit in its name."""
    out = dict(columns)
    time_s = out.pop("time_s")
    if FIRST in out:
        w = out.pop(FIRST) + 1j * out.pop(SECOND)
        if by_heading(voyage):
            w = w * np.exp(-1j * np.radians(out[HEADING]))
        out |= {AHEAD: w.real, ASIDE: w.imag}
    full, _ = derive(time_s, out)
    return replace(voyage, time_s=time_s, columns=full)


def undone(view: VoyageView, undo: Undo) -> VoyageView:
    """The view without the mistake."""
    voyage = view.even
    seen = measured(voyage)
    return VoyageView(remade(voyage, {**seen, **undo(seen)}), view.ship)


def velocity(c: Columns) -> np.ndarray:
    """The velocity as it was given: ahead + i aside, or north + i east. (N,) complex [m/s]."""
    return c[FIRST] + 1j * c[SECOND]


def as_velocity(w: np.ndarray) -> dict[str, np.ndarray]:
    """Both columns (N,) of a velocity [m/s] as it was given: the inverse of `velocity`."""
    return {FIRST: w.real, SECOND: w.imag}
