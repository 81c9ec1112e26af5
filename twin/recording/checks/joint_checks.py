"""All checks together: one mistake is told once, and a channel that another check doubts is no witness."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from twin.num import as_given
from twin.recording.checks.check_result import Check, cannot_tell, doubtful
from twin.recording.checks.other_ship import as_its_own, other_ship
from twin.recording.checks.propeller import with_believed_turns
from twin.recording.checks.relations import offs
from twin.recording.checks.single import BROKEN, Explained, coarse, explain
from twin.recording.checks.steps import without_steps
from twin.recording.checks.undo import HEADING, measured, remade
from twin.recording.checks.voyage_view import VoyageView
from twin.recording.voyage import Voyage

# from one sample to the next [rad]: sums of the rate of turn over a zigzag of 25 deg are then off by 3 %
MOST_TURNED = np.radians(15.0)
MAX_MISTAKES = 3  # mistakes that are told one after the other
OF_MOTION = (
    "velocity_frame",
    "yaw_rate",
    "compass",
    "rudder_sign",
    "rudder_unit",
    "propeller_rate",
    "actuators",
    "speed_log",
    "wind",
    "other_ship",
)
FROZEN_CHANNEL = "a channel that stands still"
MOVES = (HEADING, "surge_velocity_mps", "yaw_rate_degps")  # what actuators are seen by
# which relations a check's proof rests on beside its own: where one of them is broken it proves nothing
WITNESSES: dict[str, tuple[str, ...]] = {
    "velocity_frame": ("turning",),
    "yaw_rate": ("course",),
    "rudder_sign": ("turning", "course"),
    "propeller_rate": ("place", "course"),
    "speed_log": ("place", "course"),
    "wind": ("turning", "course"),
    "rudder_unit": ("turning",),
    "actuators": ("turning", "place", FROZEN_CHANNEL),
}
Checks = Sequence[Callable[[VoyageView], Check]]


def joint_answers(view: VoyageView, checks: Checks) -> list[Check]:
    """The answers in the table's order."""
    if view.turned_between > MOST_TURNED:
        return [seldom(check.__name__, view) or check(view) for check in checks]
    answers = {check.__name__: check(view) for check in checks}
    named, without = named_mistakes(view, answers)
    if without is not view:
        again = {check.__name__: check(without) for check in checks if check.__name__ in OF_MOTION}
        answers |= {name: a for name, a in again.items() if name not in named}
    answers |= named
    answers |= of_this_ship(answers, without)
    broken = {name for name, off in offs(coarse(without)).items() if off is not None and off > BROKEN}
    if any(f"{channel} stays" in answers["frozen"].text for channel in MOVES):
        broken.add(FROZEN_CHANNEL)
    return [not_proved_beside(a, broken) if name not in named else a for name, a in answers.items()]


def seldom(name: str, view: VoyageView) -> Check | None:
    """The answer of a check of motion where the ship turns too far between two samples."""
    if name not in (*OF_MOTION, "heading_steps"):
        return None
    return cannot_tell(
        name,
        f"the ship turns by {np.degrees(view.turned_between):.0f} deg and more from one sample to the next, "
        f"{as_given(view.step_s, 3)} s later. Record place and heading more often.",
    )


def of_this_ship(answers: dict[str, Check], view: VoyageView) -> dict[str, Check]:
    """`propeller_rate` and `other_ship` beside each other: by a ship's propeller a unit of the shaft is
    proved only where the voyage, so mended, is seen to be that ship's; then it is no other ship's either."""
    answer = answers.get("propeller_rate")
    if answer is None or not answer.unusable or view.ship is None:
        return {}
    mended = with_believed_turns(view)
    if as_its_own(mended):
        return {"other_ship": other_ship(mended)}
    text = f"{answer.text} Not proved: other_ship: {answers['other_ship'].text}"
    return {"propeller_rate": doubtful(answer.name, text)}


def named_mistakes(view: VoyageView, answers: dict[str, Check]) -> tuple[dict[str, Check], VoyageView]:
    """(the mistakes that explain what disagrees, by the check they belong to; the view without them)."""
    named: dict[str, Check] = {}
    here = view
    if answers["heading_steps"].unusable:
        psi = without_steps(view)
        if psi is not None:
            voyage = view.voyage
            changed = replace(voyage, columns={**voyage.columns, HEADING: psi})
            here = VoyageView(remade_by(voyage, changed), view.ship)
    for _ in range(MAX_MISTAKES):
        found: Explained | None = explain(here)
        if found is None or (found.check.name in named and named[found.check.name].unusable):
            break
        named[found.check.name] = found.check
        if found.view is None:
            break
        here = found.view
    return named, here


def remade_by(voyage: Voyage, changed: Voyage) -> Voyage:
    """The voyage with another heading: what the old one turned is turned back by the old, and by the new
    again."""
    return remade(voyage, {**measured(voyage), HEADING: changed[HEADING]})


def not_proved_beside(answer: Check, broken: set[str]) -> Check:
    """A proof that rests on what another check doubts is a doubt itself."""
    doubted = [name for name in WITNESSES.get(answer.name, ()) if name in broken]
    if not answer.unusable or not doubted:
        return answer
    others = [name for name in doubted if name != FROZEN_CHANNEL]
    why = (
        f"{' and '.join(others)} of the same channels do not agree either"
        if others
        else f"it rests on {FROZEN_CHANNEL}"
    )
    return doubtful(answer.name, f"{answer.text} Not proved: {why}; see the other checks.")
