"""Numbers of which what they do is not in proportion to them: an iteration from afar may find what one from
nothing cannot see."""

from collections.abc import Sequence

import numpy as np

from twin.physics.model import Model
from twin.study.diagnosis.case import Case
from twin.study.estimation.columns import Unknown, changed
from twin.study.estimation.respond import respond, standard

# times the linear guess, where a Newton iteration begins again when it ended in no plain scenario, or at
# nothing
MULTI_START = (2.0, 4.0)
BENT = 0.3  # share of what a number does that is not in proportion to it


def bent_numbers(case: Case, mine: np.ndarray, at: np.ndarray) -> list[int]:
    """Parameters of which what they do is not in proportion to them: about nothing they may not be seen,
    and an iteration may end on a lower top. `mine` (M,): index; `at` (Q,) in prior widths."""
    models = [case.at(mine, at, track) for track in case.tracks]
    return [int(i) for i in mine if bends(case, models, case.effects[i])]


def late_numbers(case: Case, mine: np.ndarray) -> list[int]:
    """Of these numbers (M,) those in seconds of a fault by which place and speed over ground are late: when
    it turned the speed goes along with it. `mine`: index."""
    prompt = case.model.prompt()[0]
    late = {u.owner for u in (case.effects[i] for i in mine) if _later(case, u) != prompt}
    return [int(i) for i in mine if case.effects[i].owner in late and case.effects[i].unit == "s"]


def _later(case: Case, unknown: Unknown) -> float:
    other = changed(case.model, unknown, unknown.centre + unknown.sd, case.catalogue)
    return other.prompt()[0]


def bends(case: Case, models: Sequence[Model], unknown: Unknown) -> bool:
    """Whether so many prior widths of a number do clearly more, or less, than so many times what one does, on
    one of the voyages; `models`: on each."""
    for line, model in zip(case.lines, models, strict=True):
        if not unknown.acts_on(line.track):
            continue
        here = model.without_inputs(line.track.missing())[0]
        none, one, far = (
            respond(line.track, changed(here, unknown, unknown.centre + k * unknown.sd, case.catalogue))[0]
            for k in (0.0, 1.0, MULTI_START[-1])
        )
        did, missed = (
            (far - none) / standard(here),
            (far - none - MULTI_START[-1] * (one - none)) / standard(here),
        )
        if np.linalg.norm(missed) > BENT * np.linalg.norm(did):
            return True
    return False
