"""The mistakes that `single` tries, one row each: what it is called, how it is undone, what the map needs."""

from collections.abc import Callable

import numpy as np

from twin.live.signals.geodesy import MAX_LATITUDE_DEG, datum, to_chart
from twin.recording.checks.candidate_mistake import Single, changes, said, scaled
from twin.recording.checks.undo import (
    EAST,
    FIRST,
    HEADING,
    NORTH,
    RATE,
    RUDDER,
    SECOND,
    TURNS,
    Columns,
    Undo,
    as_velocity,
    by_heading,
    velocity,
)
from twin.recording.checks.unit_mistakes import of_rate, of_speed
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.units import DEG_PER_RAD

NEAR_DEG = 1e-4  # ten metres, over which the chart is as good as the globe
HEADINGS: tuple[tuple[str, Callable[[np.ndarray], np.ndarray], str], ...] = (
    ("the heading counts from east, anticlockwise", lambda x: 90.0 - x, "sign = -1 and offset = 90"),
    ("the heading counts anticlockwise from north", lambda x: -x, "sign = -1"),
    ("the heading is 180 deg off", lambda x: x + 180.0, "offset = 180"),
    ("the heading is 90 deg too small", lambda x: x + 90.0, "offset = 90"),
    ("the heading is 90 deg too large", lambda x: x - 90.0, "offset = -90"),
    ("the heading counts anticlockwise from west", lambda x: 270.0 - x, "sign = -1 and offset = 270"),
    ("the heading counts anticlockwise from south", lambda x: 180.0 - x, "sign = -1 and offset = 180"),
    ("the heading is in radians", lambda x: x * DEG_PER_RAD, 'unit = "rad"'),
)
CLOCKS: tuple[tuple[str, float, str], ...] = (
    ("the time is in milliseconds", 1e-3, "ms"),
    ("the time is in minutes", 60.0, "min"),
    ("the time is in hours", 3600.0, "h"),
    ("the time is in microseconds", 1e-6, "us"),
)
VELOCITIES: tuple[tuple[str, Callable[[np.ndarray], np.ndarray], str, str], ...] = (
    ("surge and sway are swapped", lambda w: 1j * w.conj(), "swap their columns", "body"),
    ("surge is positive astern", lambda w: -w.conj(), "sign = -1 for surge", "body"),
    ("surge and sway have the other sign", lambda w: -w, "sign = -1 for both", "body"),
    ("sway is positive to port", lambda w: w.conj(), "sign = -1 for sway", "body"),
    (
        "the velocities are east and north, not north and east",
        lambda w: 1j * w.conj(),
        "swap their columns",
        "earth",
    ),
    (
        "the velocity to the east is positive to the west",
        lambda w: w.conj(),
        "sign = -1 for the one to the east",
        "earth",
    ),
    (
        "the velocity to the north is positive to the south",
        lambda w: -w.conj(),
        "sign = -1 for the one to the north",
        "earth",
    ),
    (
        "the course over ground is in radians",
        lambda w: np.abs(w) * np.exp(1j * np.angle(w) * DEG_PER_RAD),
        'unit = "rad" for it',
        "course",
    ),
    ("the course over ground is 180 deg off", lambda w: -w, "offset = 180 for it", "course"),
    (
        "the course over ground counts from east, anticlockwise",
        lambda w: 1j * w.conj(),
        "sign = -1 and offset = 90 for it",
        "course",
    ),
)


def headed(turn: Callable[[np.ndarray], np.ndarray], mirrored: bool) -> Undo:
    """A way back: the heading [deg] (N,) turned by `turn`, and the yaw rate reversed where the heading was
    mirrored."""
    return lambda c: {HEADING: turn(c[HEADING])} | ({RATE: -c[RATE]} if mirrored and RATE in c else {})


def sign_of_east(view: VoyageView) -> str:
    """What the map needs, by the column of the place that was given."""
    given = view.voyage.meta.get("given", ())
    return f"sign = -1 for {'longitude_deg' if 'longitude_deg' in given else 'east_m'}"


def sign_of_north(view: VoyageView) -> str:
    """The same of the other column."""
    given = view.voyage.meta.get("given", ())
    return f"sign = -1 for {'latitude_deg' if 'latitude_deg' in given else 'north_m'}"


def exchanged(view: VoyageView) -> str:
    """What the two columns of the place are called that stand in each other's place."""
    return "latitude and longitude are exchanged" if _on_the_globe(view) else "north and east are swapped"


def exchange(view: VoyageView) -> Undo:
    """The place with its two columns in each other's place. Of latitude and longitude a degree is so many
    metres as it would be there."""
    if not _on_the_globe(view):
        return lambda c: {NORTH: c[EAST], EAST: c[NORTH]}
    at = view.voyage.meta["datum"]
    latitude, longitude = at["latitude_deg"], at["longitude_deg"]
    north, east = metres_a_degree(latitude, longitude)
    true_north, true_east = metres_a_degree(longitude, latitude)
    return lambda c: {NORTH: c[EAST] * true_north / east, EAST: c[NORTH] * true_east / north}


def _on_the_globe(view: VoyageView) -> bool:
    """Whether the place was given by a latitude and a longitude of which each could be the other."""
    at = view.voyage.meta.get("datum") or {}
    return (
        "latitude_deg" in view.voyage.meta.get("given", ()) and abs(at["longitude_deg"]) <= MAX_LATITUDE_DEG
    )


def metres_a_degree(latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
    """How many metres to the north and to the east a degree of latitude and one of longitude are there."""
    here = datum(latitude_deg, longitude_deg)
    ahead = to_chart(here, latitude_deg + NEAR_DEG, longitude_deg)
    aside = to_chart(here, latitude_deg, longitude_deg + NEAR_DEG)
    assert ahead and aside  # within MAX_LATITUDE_DEG
    return ahead[0] / NEAR_DEG, aside[1] / NEAR_DEG


def west(c: Columns) -> dict[str, np.ndarray]:
    """East counted as west: the column (N,) [m] reversed."""
    return {EAST: -c[EAST]}


def end_for_end(view: VoyageView) -> Undo:
    """The voyage as it would be recorded with bow and stern in each other's place: ahead is astern, and
    rudder and shaft work the other way."""
    turned = (RUDDER, TURNS) if by_heading(view.voyage) else (RUDDER, TURNS, FIRST, SECOND)
    return lambda c: {HEADING: c[HEADING] + 180.0} | {name: -c[name] for name in turned if name in c}


# no mistake: the healthy ship beside which every mistake is tried
GOES_ASTERN = Single(said("the ship goes astern"), end_for_end, said(""), "", (HEADING,), frozenset())


def singles(view: VoyageView) -> tuple[Single, ...]:
    """All mistakes that this voyage may hold."""
    out: list[Single] = []
    for text, turn, fix in HEADINGS:
        fixed = f"{fix} for {HEADING}"
        out.append(
            Single(
                said(text),
                changes(headed(turn, False)),
                said(fixed),
                "velocity_frame",
                (HEADING,),
                frozenset(("heading",)),
            )
        )
        if "anticlockwise" in text:
            both = f"{text}, and the rate of turn is positive to port (as ROS has them)"
            also = f"{fixed}; sign = -1 for {RATE}"
            out.append(
                Single(
                    said(both),
                    changes(headed(turn, True)),
                    said(also),
                    "velocity_frame",
                    (HEADING, RATE),
                    frozenset(("heading", "rate")),
                )
            )
    out += [*of_rate(view), *of_speed(view)]
    for text, by, unit in CLOCKS:
        fix = f'[time] unit = "{unit}"'
        check = "velocity_frame"
        out.append(
            Single(
                said(text),
                changes(scaled("time_s", by)),
                said(fix),
                check,
                (),
                frozenset(("place", "rate", "velocity")),
            )
        )
    for text, turn, fix, frame in VELOCITIES:
        undo: Undo = (lambda f: lambda c: as_velocity(f(velocity(c))))(turn)
        out.append(
            Single(
                said(text),
                changes(undo),
                said(fix),
                "velocity_frame",
                (FIRST,),
                frozenset(("velocity",)),
                frame,
            )
        )
    earthly: Undo = lambda c: as_velocity(velocity(c) * np.exp(-1j * np.radians(c[HEADING])))  # noqa: E731
    swapped: Undo = lambda c: as_velocity(1j * velocity(c).conj() * np.exp(-1j * np.radians(c[HEADING])))  # noqa: E731
    south: Undo = lambda c: {NORTH: -c[NORTH]}  # noqa: E731
    feet: Undo = lambda c: {NORTH: c[NORTH] * 0.3048, EAST: c[EAST] * 0.3048}  # noqa: E731
    v, p = frozenset(("velocity",)), frozenset(("place",))
    out += [
        Single(
            said("surge and sway are earth-fixed (dx/dt and dy/dt)"),
            changes(earthly),
            said('frame = "earth" for both'),
            "velocity_frame",
            (FIRST, HEADING),
            v,
            "body",
        ),
        Single(
            said("surge and sway are earth-fixed and swapped (east, north)"),
            changes(swapped),
            said('frame = "earth" for both, and swap their columns'),
            "velocity_frame",
            (FIRST, HEADING),
            v,
            "body",
        ),
        Single(
            exchanged,
            exchange,
            said("swap their columns"),
            "velocity_frame",
            (NORTH, EAST),
            p,
        ),
        Single(
            said("east is positive to the west"), changes(west), sign_of_east, "velocity_frame", (EAST,), p
        ),
        Single(
            said("north is positive to the south"),
            changes(south),
            sign_of_north,
            "velocity_frame",
            (NORTH,),
            p,
        ),
        Single(
            said("the positions are in feet"),
            changes(feet),
            said('unit = "ft" for them'),
            "velocity_frame",
            (NORTH, EAST),
            p,
        ),
        Single(
            said("the rudder is positive to port"),
            changes(scaled(RUDDER, -1.0)),
            said(f"sign = -1 for {RUDDER}"),
            "rudder_sign",
            (RUDDER,),
            frozenset(("rudder",)),
        ),
        Single(
            said("the shaft is positive astern"),
            changes(scaled(TURNS, -1.0)),
            said(f"sign = -1 for {TURNS}"),
            "propeller_rate",
            (TURNS,),
            frozenset(("turns",)),
        ),
    ]
    return tuple(out)
