"""What a voyage says about itself before anyone believes it: signs, units, frames, clock, gaps.

Each check is a function of a `View` that answers with one `Check`: what it saw, what it believes and what to
do, with numbers. `ok` is True when nothing speaks against the data, also when the data cannot tell (the text
says which). A check that can *prove* a mistake is `unusable`: whoever reads the voyage, `twin import` as well
as every verb of the study, then refuses it (exit 4) unless told to accept it (proved_wrong.py).
"""

from collections.abc import Callable, Sequence
from typing import Any

from twin.physics.ship import Ship
from twin.recording.checks.actuator_response import actuators
from twin.recording.checks.channel_samples import frozen, missing_samples, plausible_values, spikes
from twin.recording.checks.check_result import Check
from twin.recording.checks.compass import compass
from twin.recording.checks.copies import copies
from twin.recording.checks.joint_checks import joint_answers
from twin.recording.checks.motion import velocity_frame
from twin.recording.checks.other_ship import other_ship
from twin.recording.checks.propeller import propeller_rate
from twin.recording.checks.proved_wrong import refuse
from twin.recording.checks.rudder import rudder_sign, rudder_unit
from twin.recording.checks.size import duration, ship_size
from twin.recording.checks.standstill import actuator_zero
from twin.recording.checks.steps import heading_steps
from twin.recording.checks.timekeeping import clock_steps, control_gaps, time_gaps, time_stamps, whole_file
from twin.recording.checks.turning import yaw_rate
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.checks.water import speed_log
from twin.recording.checks.wind_triangle import wind
from twin.recording.voyage import Voyage

__all__ = ["CHECKS", "Check", "run_checks"]

CHECKS: tuple[Callable[[VoyageView], Check], ...] = (
    whole_file,
    time_stamps,
    time_gaps,
    control_gaps,
    clock_steps,
    missing_samples,
    plausible_values,
    spikes,
    frozen,
    copies,
    heading_steps,
    velocity_frame,
    yaw_rate,
    compass,
    rudder_sign,
    rudder_unit,
    propeller_rate,
    actuators,
    actuator_zero,
    speed_log,
    wind,
    ship_size,
    other_ship,
    duration,
)


LOSSES = ("whole_file", "time_gaps", "control_gaps")  # the checks that say what is not there
WHOSE = ("ship_size", "other_ship")  # and those that ask whose voyage it is


def of_voyages(voyages: Sequence[Voyage], ship: Ship | None = None) -> list[dict[str, Any]]:
    """The entries `data_checks` of a verb's answer, asked before it computes anything; with more than one
    voyage each names its own. DataError: of one of them a sign, unit or frame is proved wrong."""
    many, out = len({v.name for v in voyages}) > 1, list[dict[str, Any]]()
    for voyage in voyages:
        checks = run_checks(voyage, ship)
        refuse(voyage, checks)
        out += [c.as_json() | ({"voyage": voyage.name} if many else {}) for c in checks]
    return out


def losses(entries: Sequence[dict[str, Any]]) -> list[str]:
    """What the voyages lack, a line each, out of such entries."""
    lost = [c for c in entries if c["check"] in LOSSES and not c["ok"]]
    return [f"lost  {c.get('voyage', '')}{': ' * ('voyage' in c)}{c['text']}" for c in lost]


def whose(entries: Sequence[dict[str, Any]]) -> list[str]:
    """That a voyage may be of another ship, a line each, out of such entries: what is read before any
    number."""
    doubts = [c for c in entries if c["check"] in WHOSE and not c["ok"]]
    return [
        f"{c.get('voyage', '')}{': ' * ('voyage' in c)}this may be a voyage of another ship: {c['text']}"
        for c in doubts
    ]


def run_checks(voyage: Voyage, ship: Ship | None = None) -> list[Check]:
    """Every check's answer, in the table's order; `ship` lets propeller, size and duration say more.

    When what disagrees has one explanation, it is the answer of the check that it belongs to, and the others
    are asked again on the voyage without that mistake."""
    return joint_answers(VoyageView(voyage, ship), CHECKS)
