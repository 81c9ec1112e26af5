"""Which single mistake explains all that disagrees: each is undone on the data, and all relations asked
again.

The cost of a voyage is the sum over its relations of log(1 + (off / usual)^2). The mistake that lowers it
most is named when it puts right what it touches, harms nothing, and no other that would put the same right
comes near. A ship that goes astern is no mistake: where that explains as much, none is proved."""

from dataclasses import dataclass

import numpy as np

from twin.recording.checks.actuator_response import actuators
from twin.recording.checks.candidate_mistake import Single
from twin.recording.checks.check_result import Check, doubtful, wrong
from twin.recording.checks.compass import fitted
from twin.recording.checks.relations import USUAL_SCATTER, offs
from twin.recording.checks.single_table import GOES_ASTERN, singles
from twin.recording.checks.undo import measured, undone
from twin.recording.checks.voyage_view import VoyageView

BROKEN = 1.5  # a relation this far off asks for an explanation
MENDED = 1.0
ROWS = 4000
MARGIN = 1.0  # of the cost: less between two explanations leaves both


@dataclass(frozen=True)
class Tried:
    """One mistake undone: what it leaves, and how much of the cost it takes away."""

    single: Single
    view: VoyageView
    after: dict[str, float | None]
    gain: float
    mended: frozenset[str]
    harmed: frozenset[str]


@dataclass(frozen=True)
class Explained:
    """The answer of the mistake's own check, and the voyage without it."""

    check: Check
    view: VoyageView | None
    uses: frozenset[str]


def cost(off: dict[str, float | None]) -> float:
    """Sum over the relations of log(1 + (x/usual)^2); those that cannot be asked cost nothing."""
    return sum(float(np.log1p((x / USUAL_SCATTER[name]) ** 2)) for name, x in off.items() if x is not None)


def explain(view: VoyageView) -> Explained | None:
    """The one mistake that explains what disagrees; None when nothing does, or nothing explains it."""
    view = coarse(view)
    before = offs(view)
    if not broken(before):
        return None
    given = frozenset(measured(view.even))
    tried = [
        t
        for s in (*singles(view), *fitted(view))
        if s.possible(view, given) and (t := attempt(view, s, before)).mended and not t.harmed
    ]
    tried.sort(key=lambda t: -t.gain)
    if not tried:
        return None
    best = tried[0]
    rivals = [t for t in tried[1:] if t.mended & best.mended and t.single.fix(view) != best.single.fix(view)]
    rival = rivals[0] if rivals else None
    margin = best.gain - (rival.gain if rival else 0.0)
    saw = ", ".join(f"{SAYS[name]} ({before[name]:.1f} times what may be)" for name in sorted(best.mended))
    text = f"{saw}: if {best.single.text(view)} all of it agrees"
    if rival is not None and margin < MARGIN:
        return Explained(
            doubtful(
                best.single.check,
                f"{text}; so it does if {rival.single.text(view)}. "
                "Which, this voyage cannot tell. "
                f"In the map: {best.single.fix(view)}; or: "
                f"{rival.single.fix(view)}.",
            ),
            None,
            best.single.uses,
        )
    if may_go_astern(view, before, best):
        return Explained(
            doubtful(
                best.single.check,
                f"{text}; so it does if {GOES_ASTERN.text(view)}, and neither rudder nor propulsion says "
                f"that it does not. If it goes ahead, in the map: {best.single.fix(view)}.",
            ),
            None,
            best.single.uses,
        )
    if best.single.check == "compass":
        return Explained(
            doubtful("compass", f"{text}. In the map: {best.single.fix(view)}."), best.view, best.single.uses
        )
    second = (
        f"; the next best, {rival.single.text(view)}, leaves {cost(rival.after):.1f} against "
        f"{cost(best.after):.1f}"
        if rival
        else ""
    )
    return Explained(
        wrong(best.single.check, f"{text}{second}; that is believed. In the map: {best.single.fix(view)}."),
        best.view,
        best.single.uses,
    )


def may_go_astern(view: VoyageView, before: dict[str, float | None], best: Tried) -> bool:
    """Whether all that this mistake puts right is as on a healthy ship, and nothing else is broken, if the
    ship goes astern; and its actuators do not push it as its file has them only without the mistake.
    `before`: the relations with it."""
    astern = offs(undone(view, GOES_ASTERN.undo(view)))
    left = broken(astern)
    if left - broken(before) or any(astern[name] is None or name in left for name in best.mended):
        return False
    return actuators(view).ok or not actuators(best.view).ok


def broken(off: dict[str, float | None]) -> set[str]:
    """The relations that ask for an explanation."""
    return {name for name, x in off.items() if x is not None and x > BROKEN}


def coarse(view: VoyageView) -> VoyageView:
    """The voyage on a grid of at most ROWS rows, for it is looked at once for each mistake."""
    voyage = view.even
    if len(voyage) <= ROWS:
        return VoyageView(voyage, view.ship)
    return VoyageView(voyage.on_grid(view.step_s * np.ceil(len(voyage) / ROWS)), view.ship)


SAYS = {
    "place": "position and velocity tell of different ways",
    "turning": "heading and rate of turn tell of different turning",
    "course": "the ship does not go where its heading points",
    "rudder": "the rudder turns it to the other side",
    "thrust": "it goes astern with its shaft turning ahead",
}


def attempt(view: VoyageView, single: Single, before: dict[str, float | None]) -> Tried:
    """The mistake undone. A relation that the voyage could tell before and cannot tell after counts as it
    was."""
    without = undone(view, single.undo(view))
    after = offs(without)
    kept = {name: before[name] if x is None else x for name, x in after.items()}
    mended = frozenset(
        name for name in broken(before) if after[name] is not None and (after[name] or 0.0) <= MENDED
    )
    harmed = frozenset(
        n for n, x in kept.items() if x is not None and x > max(MENDED, 1.2 * (before[n] or 0.0))
    )
    return Tried(
        single,
        without,
        after,
        cost(before) - cost({n: x for n, x in kept.items() if before[n] is not None or (x or 0.0) > MENDED}),
        mended,
        harmed,
    )
