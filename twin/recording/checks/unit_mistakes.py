"""Rates and speeds in another unit than they were read in."""

from twin.recording.checks.candidate_mistake import Single, Words, changes, said, scaled
from twin.recording.checks.undo import AHEAD, FIRST, RATE, Undo, as_velocity, velocity
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.mapping import GROUND
from twin.recording.units import UNITS

SPEED_NAMES = {"kn": "knots"}


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
            words = [f"in {unit}"] * (unit != read) + ["positive to port"] * (sign < 0)
            what = f"the rate of turn is {' and '.join(words)}"
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


def speed_fix(unit: str) -> Words:
    """The entry of the map that holds the speed, by each name that it may have there: one when it comes with
    the course, else both."""

    def fix(view: VoyageView) -> str:
        frame = str(view.voyage.meta.get("velocity_frame"))
        names = GROUND.get(frame, ())[: 1 if frame == "course" else 2]
        instead = f" ({' and '.join(names)} where the map has that)" if names else ""
        return f'unit = "{unit}" for {AHEAD}{"" if frame == "course" else " and sway"}{instead}'

    return fix
