"""What position, velocity and heading may really be: each mistake, the way it reads, and its cure."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from twin.recording.checks.voyage_view import VoyageView
from twin.recording.units import DEG_PER_RAD, KNOT_MPS

Flow = Callable[[VoyageView], np.ndarray]


@dataclass(frozen=True)
class Mistake:
    """What is wrong, the velocity over the earth if it is so (north + i east [m/s]), what the map needs."""

    text: str
    flow: Flow
    fix: str


def turned(w: np.ndarray, psi: np.ndarray) -> np.ndarray:
    """A velocity in the ship's axes as seen from the earth. Both (N,): w complex, ahead + i to starboard
    [m/s], psi [rad]; returns north + i east [m/s]."""
    return w * np.exp(1j * psi)


AS_THEY_ARE = Mistake("as they are", lambda a: turned(a.velocity, a.psi), "")
GEOMETRY = (
    AS_THEY_ARE,
    Mistake(
        "surge and sway are earth-fixed (dx/dt and dy/dt)",
        lambda a: a.velocity,
        'frame = "earth" for both',
    ),
    Mistake(
        "surge and sway are earth-fixed and swapped (east, north)",
        lambda a: 1j * a.velocity.conj(),
        'frame = "earth" for both, and swap their columns',
    ),
    Mistake(
        "north and east are swapped",
        lambda a: 1j * turned(a.velocity, a.psi).conj(),
        "swap their columns",
    ),
    Mistake(
        "surge and sway are swapped",
        lambda a: turned(1j * a.velocity.conj(), a.psi),
        "swap their columns",
    ),
    Mistake(
        "surge is positive astern",
        lambda a: turned(-a.velocity.conj(), a.psi),
        "sign = -1 for surge",
    ),
    Mistake(
        "surge and sway have the other sign",
        lambda a: turned(-a.velocity, a.psi),
        "sign = -1 for both",
    ),
    Mistake(
        "sway is positive to port",
        lambda a: turned(a.velocity.conj(), a.psi),
        "sign = -1 for sway",
    ),
    Mistake(
        "the heading is in radians",
        lambda a: turned(a.velocity, a.psi * DEG_PER_RAD),
        'unit = "rad" for it',
    ),
    Mistake(
        "the heading counts anticlockwise from east",
        lambda a: turned(a.velocity, np.pi / 2 - a.psi),
        "sign = -1 and offset = 90 for it",
    ),
    Mistake(
        "the heading counts anticlockwise",
        lambda a: turned(a.velocity, -a.psi),
        "sign = -1 for it",
    ),
    Mistake(
        "the heading is 90 deg too small",
        lambda a: turned(a.velocity, a.psi + np.pi / 2),
        "offset = 90 for it",
    ),
    Mistake(
        "the heading is 90 deg too large",
        lambda a: turned(a.velocity, a.psi - np.pi / 2),
        "offset = -90 for it",
    ),
    Mistake(
        "east is positive to the west",
        lambda a: turned(a.velocity, a.psi).conj(),
        "sign = -1 for east_m",
    ),
    Mistake(
        "north is positive to the south",
        lambda a: -turned(a.velocity, a.psi).conj(),
        "sign = -1 for north_m",
    ),
)
SCALES = (
    (1.0, "", ""),
    (KNOT_MPS, "the speeds are in knots", 'unit = "kn" for surge and sway'),
    (1.0 / KNOT_MPS, "the speeds are in m/s, read as knots", 'unit = "m/s" for surge and sway'),
    (1.0 / 3.6, "the speeds are in km/h", 'unit = "km/h" for surge and sway'),
    (0.3048, "the speeds are in ft/s", 'unit = "ft/s" for surge and sway'),
    (1.0 / 0.3048, "the positions are in feet", 'unit = "ft" for them'),
    (
        1e-3,
        "the time is in milliseconds, or the positions in km",
        '[time] unit = "ms", or unit = "km" for positions',
    ),
    (60.0, "the time is in minutes", '[time] unit = "min"'),
    (3600.0, "the time is in hours", '[time] unit = "h"'),
)
