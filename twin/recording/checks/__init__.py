"""What a voyage says about itself before anyone believes it: signs, units, frames, clock, gaps.

Each check is a function of a `View` that answers with one `Check`: what it saw, what it believes and what to
do, with numbers. `ok` is True when nothing speaks against the data, also when the data cannot tell (the text
says which). A check that can *prove* a mistake is `unusable`: `twin import` then refuses the file (exit 4)
unless told to accept it.
"""

from collections.abc import Callable

from twin.physics.ship import Ship
from twin.recording.checks.answer import Check
from twin.recording.checks.clock import time_gaps, time_stamps
from twin.recording.checks.motion import velocity_frame
from twin.recording.checks.propeller import propeller_rate
from twin.recording.checks.rudder import rudder_sign, rudder_unit
from twin.recording.checks.samples import frozen, missing_samples, plausible_values, spikes
from twin.recording.checks.size import duration, ship_size
from twin.recording.checks.turning import yaw_rate
from twin.recording.checks.view import View
from twin.recording.checks.water import speed_log
from twin.recording.checks.wind import wind
from twin.recording.voyage import Voyage

__all__ = ["CHECKS", "Check", "run_checks"]

CHECKS: tuple[Callable[[View], Check], ...] = (
    time_stamps,
    time_gaps,
    missing_samples,
    plausible_values,
    spikes,
    frozen,
    velocity_frame,
    yaw_rate,
    rudder_sign,
    rudder_unit,
    propeller_rate,
    speed_log,
    wind,
    ship_size,
    duration,
)


def run_checks(voyage: Voyage, ship: Ship | None = None) -> list[Check]:
    """Every check's answer, in the table's order; `ship` lets propeller, size and duration say more."""
    view = View(voyage, ship)
    return [check(view) for check in CHECKS]
