"""The mistakes that `single` tries, one row each: what it is called, how it is undone, what the map needs."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from twin.recording.checks.undo import (
    AHEAD,
    EAST,
    FIRST,
    HEADING,
    NORTH,
    RATE,
    RUDDER,
    TURNS,
    Columns,
    Undo,
    as_velocity,
    velocity,
)
from twin.recording.checks.view import VoyageView
from twin.recording.units import DEG_PER_RAD, UNITS

Words = Callable[[VoyageView], str]
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
SPEED_NAMES = {"kn": "knots"}
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
        frame = view.voyage.meta.get("velocity_frame") or "body"
        return set(self.needs) <= given and self.frame in ("", frame)


def said(text: str) -> Words:
    return lambda view: text


def changes(undo: Undo) -> Callable[[VoyageView], Undo]:
    return lambda view: undo


def scaled(name: str, by: float) -> Undo:
    return lambda c: {name: c[name] * by}


def headed(turn: Callable[[np.ndarray], np.ndarray], mirrored: bool) -> Undo:
    return lambda c: {HEADING: turn(c[HEADING])} | ({RATE: -c[RATE]} if mirrored and RATE in c else {})


def sign_of_east(view: VoyageView) -> str:
    given = view.voyage.meta.get("given", ())
    return f"sign = -1 for {'longitude_deg' if 'longitude_deg' in given else 'east_m'}"


def sign_of_north(view: VoyageView) -> str:
    given = view.voyage.meta.get("given", ())
    return f"sign = -1 for {'latitude_deg' if 'latitude_deg' in given else 'north_m'}"


def west(c: Columns) -> dict[str, np.ndarray]:
    return {EAST: -c[EAST]}


def read_unit(view: VoyageView, channel: str, standard: str) -> str:
    """The unit that the map gave a channel."""
    return view.voyage.meta.get("units", {}).get(channel) or standard


def of_rate(view: VoyageView) -> list[Single]:
    """The rate of turn in another unit than it was read in, or positive to port, or both."""
    read, out = read_unit(view, RATE, "deg/s"), []
    for unit, size in UNITS["degps"].items():
        for sign in (1.0, -1.0):
            by = sign * size / UNITS["degps"][read]
            if by == 1.0:
                continue
            what = (
                "the rate of turn is "
                f"{f'in {unit}' if unit != read else ''}{' and ' * (unit != read and sign < 0)}{'positive to port' * (sign < 0)}"
            )
            fix = ", ".join([f'unit = "{unit}"'] * (unit != read) + ["sign = -1"] * (sign < 0))
            out.append(
                Single(
                    said(what),
                    changes(scaled(RATE, by)),
                    said(f"{fix} for {RATE}"),
                    "yaw_rate",
                    (RATE,),
                    frozenset(("rate",)),
                )
            )
    return out


def of_speed(view: VoyageView) -> list[Single]:
    """The speeds in another unit than they were read in."""
    read, out = read_unit(view, AHEAD, "m/s"), []
    for unit, size in UNITS["mps"].items():
        if unit != read:
            undo: Undo = (lambda k: lambda c: as_velocity(velocity(c) * k))(size / UNITS["mps"][read])
            what = (
                "the speeds are in "
                f"{SPEED_NAMES.get(unit, unit)}{f', read as {SPEED_NAMES.get(read, read)}' * (read != 'm/s')}"
            )
            out.append(
                Single(
                    said(what),
                    changes(undo),
                    speed_fix(unit),
                    "velocity_frame",
                    (FIRST,),
                    frozenset(("velocity",)),
                )
            )
    return out


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
    exchanged: Undo = lambda c: {NORTH: c[EAST], EAST: c[NORTH]}  # noqa: E731
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
            said("north and east are swapped"),
            changes(exchanged),
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


def speed_fix(unit: str) -> Words:
    """The entry of the map that holds the speed: one when it comes with the course, else both."""
    return lambda view: (
        f'unit = "{unit}" for '
        f"{AHEAD}{'' if view.voyage.meta.get('velocity_frame') == 'course' else ' and sway'}"
    )
