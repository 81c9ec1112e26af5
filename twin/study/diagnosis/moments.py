"""Moments at which something pushed it that was not there before and after: a ship that passed, a gust, a
net that was caught and lost.

What lasts all voyage is an effect. What lasts a few ship lengths is lost in the whole of it, and a ship with
which nothing else is wrong would be called sound. So, beside the best hypothesis, each stretch of one to
sixteen lengths is asked whether it is likelier with a push of its own: a constant acceleration in surge,
sway and yaw of about the size of the ship's own forces, integrated out."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from twin.physics import core
from twin.physics.model import Model
from twin.study.diagnosis.case import MOST_SEGMENTS, Case
from twin.study.diagnosis.open_loop_check import in_plain_scenario
from twin.study.diagnosis.refine import Found, standing
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import Linear
from twin.study.estimation.respond import shown_since, standard
from twin.study.estimation.start import wave_period_s
from twin.study.reference.evidence import likeliest
from twin.study.track.segments import segments

# of a stretch, in ship lengths, up to a segment's; each begins half-way through the one before
LENGTHS = (1.0, 2.0, 4.0, 8.0, 16.0)
PUSH_LOG_BAYES = 15.0  # log evidence, tempered, that a push of its own must add
IN_WAVES = 30.0  # and where waves toss it: a group of them pushes, too
GAP = 0.1  # of the shorter of two stretches, between them, that is none
SAME_WAY = 0.5  # cosine between two pushes, in standard accelerations, that are one which goes on
SWELL_S = 25.0  # the longest waves; what swings it more slowly may be what is asked for


@dataclass(frozen=True)
class Moment:
    """A stretch of a voyage, how much likelier it is with a push of its own, and that push in standard
    accelerations of surge, sway, yaw."""

    voyage: str
    start_s: float
    end_s: float
    log_evidence: float
    push: np.ndarray

    def as_json(self, model: Model) -> dict[str, Any]:
        """With the push as a force on this ship [N, N, N m]."""
        surge, sway, yaw = (standard(model) * self.push).tolist()
        X, Y, N = core.force_for(surge, sway, yaw, model.c)
        return {
            "voyage": self.voyage,
            "start_s": self.start_s,
            "end_s": self.end_s,
            "X_N": float(X),
            "Y_N": float(Y),
            "N_Nm": float(N),
        }


def moments(case: Case, found: Found) -> list[Moment]:
    """The stretches that clearly had a push of their own under a hypothesis, the likeliest first; none that
    overlaps a likelier one, and those that follow each other as one."""
    out: list[Moment] = []
    enough = {t.name: IN_WAVES if 0.0 < wave_period_s(t) < SWELL_S else PUSH_LOG_BAYES for t in case.tracks}
    for m in sorted(stretches(case, found), key=lambda m: -m.log_evidence):
        if m.log_evidence > enough[m.voyage] and not any(
            m.voyage == o.voyage and m.start_s < o.end_s and o.start_s < m.end_s for o in out
        ):
            out.append(m)
    return sorted(joined(out), key=lambda m: -m.log_evidence)


def joined(found: Sequence[Moment]) -> list[Moment]:
    """The same, with those that follow each other and push the same way as one: a push that lasts longer than
    a segment. The push of the whole is their mean over time."""
    out: list[Moment] = []
    for m in sorted(found, key=lambda m: (m.voyage, m.start_s)):
        if out and _goes_on(out[-1], m):
            before = out.pop()
            lasts = np.array([before.end_s - before.start_s, m.end_s - m.start_s])
            push = lasts @ np.array([before.push, m.push]) / lasts.sum()
            gained = before.log_evidence + m.log_evidence
            m = Moment(m.voyage, before.start_s, m.end_s, gained, push)
        out.append(m)
    return out


def _goes_on(before: Moment, after: Moment) -> bool:
    apart = after.start_s - before.end_s
    shorter = min(m.end_s - m.start_s for m in (before, after))
    along = float(before.push @ after.push) / float(np.linalg.norm(before.push) * np.linalg.norm(after.push))
    return before.voyage == after.voyage and apart <= GAP * shorter and along > SAME_WAY


def stretches(case: Case, found: Found) -> list[Moment]:
    """Every stretch of each length, with what it says."""
    lines, at = standing(case, found)
    noise_model = case.scenarios([in_plain_scenario(found.hypothesis).scenario], found.doubt)[0]
    normal = innovate(lines, [noise_model], MOST_SEGMENTS)[0]
    theta = likeliest(
        normal, case.nuisance, case.unknowns, case.effects, case.temper, at, found.hypothesis.effects
    )
    known = [_in_one(line, theta) for line in lines]
    return [m for lengths in LENGTHS for m in _tried(case, known, noise_model, lengths)]


def _in_one(line: Linear, theta: np.ndarray) -> Linear:
    """The track with all that is known of the unknowns as a single column, and without what a late receiver
    showed of before its first step: a push at its end, to which it stands, would be none of the ship's."""
    turns = {0: sum(theta[j] * turn for j, turn in line.turns.items())} if line.turns else {}
    e = shown_since(line.track, line.e, line.model.prompt()[0])
    return replace(line, e=e, A=line.A @ theta[:, None], R=line.R @ theta[:, None], turns=turns)


def _tried(case: Case, lines: Sequence[Linear], noise_model: NoiseModel, lengths: float) -> list[Moment]:
    time = float(case.model.ship.scale("time"))
    where = segments([line.track for line in lines], time, MOST_SEGMENTS)
    steps = [max(4, round(lengths * time / line.track.h)) for line in lines]
    most = max(-(-(b - a) // (steps[i] // 2)) for i, a, b in where)
    pushed = [
        _pushed(case, x, [(a, b) for j, a, b in where if j == i], steps[i], most) for i, x in enumerate(lines)
    ]
    normal, out = innovate(pushed, [noise_model], MOST_SEGMENTS)[0], []
    for (i, a, b), A, pull in zip(where, normal.A / case.temper, normal.b / case.temper, strict=True):
        for k in range(most):
            first, own = a + k * (steps[i] // 2), slice(3 * k + 1, 3 * k + 4)
            last = min(first + steps[i], b) - 1
            if last - first >= steps[i] // 2:
                e, H = pull[own] - A[own, 0], A[own, own] + np.eye(3)
                push, t = np.linalg.solve(H, e), lines[i].track.t
                gain = 0.5 * float(e @ push) - 0.5 * float(np.linalg.slogdet(H)[1])
                out.append(Moment(lines[i].track.name, float(t[first]), float(t[last]), gain, push))
    return out


def _pushed(case: Case, line: Linear, where: Sequence[tuple[int, int]], steps: int, most: int) -> Linear:
    """The track with, behind its own column, three more for each stretch of its segments: a push of one
    standard acceleration in each axis."""
    A = np.zeros((len(line.track), 3, 1 + 3 * most), line.A.dtype)
    R = np.zeros((len(line.track), line.R.shape[1], A.shape[2]), line.R.dtype)
    A[:, :, :1], R[:, :, :1] = line.A, line.R
    for a, b in where:
        for k, first in enumerate(range(a, b, steps // 2)):
            A[first : min(first + steps, b), range(3), range(3 * k + 1, 3 * k + 4)] = standard(case.model)
    return replace(line, A=A, R=R)
