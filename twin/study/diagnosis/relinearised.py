"""A case about numbers of its effects: inside their boxes, and with the voyages linearised there."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from twin.physics.model import Model
from twin.study.diagnosis.case import Case
from twin.study.estimation.columns import ROUGH, Unknown
from twin.study.estimation.linear import Linear, linearise
from twin.study.estimation.respond import respond


def clipped(case: Case, z: np.ndarray) -> np.ndarray:
    """Parameters (Q,) kept inside their boxes, in prior widths."""
    lo = np.array([(u.lo - u.centre) / u.sd for u in case.effects])
    hi = np.array([(u.hi - u.centre) / u.sd for u in case.effects])
    return np.clip(z, lo, hi)


def about(
    case: Case, z: np.ndarray, mine: np.ndarray, fresh: Sequence[Unknown]
) -> tuple[list[Model], list[Linear]]:
    """The model with the parameters `mine` (M,) at z (Q,) on each voyage, and the tracks linearised about it
    (columns of other unknowns than `fresh` stay what they were). `z` in prior widths."""
    models = [case.at(mine, z, line.track) for line in case.lines]
    at = {case.effects[i].label: case.effects[i].centre + case.effects[i].sd * z[i] for i in mine}
    column = {u.label: i for i, u in enumerate(case.unknowns)}
    fresh = [u for u in fresh if u.owner != ROUGH]  # what is known roughly does not change with what is asked
    place = [column[u.label] for u in fresh]
    lines = []
    for line, model in zip(case.lines, models, strict=True):
        there = Model(case.linearised.ship, model.effects)
        here, _ = there.without_inputs(line.track.missing())
        new = linearise(line.shown, here, fresh, case.catalogue, at)
        A, R = line.A.copy(), line.R.copy()
        A[:, :, place], R[:, :, place] = new.A, new.R
        sure = line.model.but(*(flow for flow in here.flows if flow.stream))
        moved = np.abs(respond(line.track, here)[0] - respond(line.track, sure)[0])
        turns = line.turns | {place[j]: turn for j, turn in new.turns.items()}
        lines.append(replace(new, A=A, R=R, turns=turns, doubted=moved, slack=line.slack, busy=line.busy))
    return models, lines
