"""One track, linearised about its smooth motion and a model: what an error of the state, the slow forces, the
stream and every unknown do in a step, and what the instruments show of them."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from twin.physics.actuators import KeptForces
from twin.physics.effect import Effect
from twin.physics.maths import total
from twin.physics.model import Model
from twin.study.estimation.columns import LATE, Unknown, beside, columns, turns
from twin.study.estimation.filters import (
    FLOW,
    MOTION,
    SLOW,
    SPEEDS,
    STATES,
)
from twin.study.estimation.respond import (
    SATELLITES,
    advance,
    by_stream,
    faulty,
    jacobian,
    keep_steered,
    later,
    moving,
    respond,
    steered,
    when_true,
)
from twin.study.estimation.start import undone
from twin.study.track import waves
from twin.study.track.track import Track

EVERY = 4  # grid steps, an eighth of a ship length, over which slopes change little
MEMORY_B, MEMORY_C = 3.0, 12.0  # correlation times of b and c, in ship lengths sailed


@dataclass(frozen=True)
class Linear:
    """One track, linearised about its smooth motion and a model: all that the filter needs, for any noise
    model."""

    track: Track  # with the model's faults of instruments taken out of the motion
    shown: Track  # with them in it
    F: np.ndarray  # (N, 11, 11)
    defect: np.ndarray  # (N, 6): model's step minus the smooth motion's
    H: np.ndarray  # (N, 8, 11)
    e: np.ndarray  # (N, 8): measured minus read, NaN where there was none
    A: np.ndarray  # (N, 3, P) float32, m/s2 per unit of each unknown
    R: np.ndarray  # (N, 8, P) float32
    # column of a faulty instrument's number -> (N, 8, 8) float32 (see `columns.turns`)
    turns: dict[int, np.ndarray]
    bends: np.ndarray | None  # (N, 3, 6, P) float32: A by heading, velocities and current
    busy: np.ndarray  # (N, 3): acceleration that hull, rudder and propeller cause
    model: Model = field(repr=False)
    # (N, 3): acceleration by the effects under judgement, whose forms are only roughly right
    doubted: np.ndarray | float = 0.0
    slack: np.ndarray | float = 0.0  # (N, 3): and one that no hypothesis takes away, of effects in the model
    fitful: np.ndarray | float = 0.0  # (N, 3): and one that comes and goes within the ship's time

    def only(self, columns: np.ndarray) -> "Linear":
        """The same with some of the unknowns (places, in the order that is wanted). `columns` (K,): index."""
        turns = {k: self.turns[j] for k, j in enumerate(columns.tolist()) if j in self.turns}
        bends = None if self.bends is None else self.bends[..., columns]
        return replace(self, A=self.A[:, :, columns], R=self.R[:, :, columns], turns=turns, bends=bends)


def linearise(
    track: Track,
    model: Model,
    unknowns: Sequence[Unknown],
    catalogue: dict[str, type[Effect]],
    at: dict[str, float] | None = None,
    *,
    smooth: bool = False,
    exact: bool = False,
    like: "Linear | None" = None,
    same: Sequence[int] = (),
) -> Linear:
    """Everything about one track that does not depend on the noise model (`at`: values of unknowns that the
    model already holds), about the motion as it was if the model's sensor faults are there. `smooth`: these
    are judged along that motion alone. `exact`: what unknowns push is known beside that motion, too, where
    the filter believes it to be. `like`: the same track about another model, with only
    those unknowns, at the places `same`, that do the same in this one."""
    shown, track = track, undone(track, model)
    # what is late shows another moment: no slope of this one says a wave two seconds ago
    late_s, prompt = model.prompt()
    reading = later(track, respond(track, prompt)[1], late_s)
    # whose column is taken off the readings in full digits
    late = any(u.owner == LATE and u.label in (at or {}) for u in unknowns)
    known = {} if like is None else {j: (like.A[:, :, k], like.R[:, :, k]) for k, j in enumerate(same)}
    A, R = columns(track, model, unknowns, catalogue, at, np.float64 if late else np.float32, known)
    bent = _bends(track, model, unknowns, catalogue, at) if exact else None
    turned = {} if smooth else turns(track, model, unknowns, catalogue, at)
    e = when_true(track, track.measured - reading, late_s)
    for j, unknown in enumerate(unknowns):
        if unknown.owner == LATE:  # no model holds it: what is known of it is taken off the readings
            e -= R[:, :, j] * (at or {}).get(unknown.label, 0.0)
    e[:, 2] = (e[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
    defect = advance(track, model)
    defect[:-1] -= track.state[1:]
    defect[-1] = 0.0
    system, reader = _system(track, model), _reader(track)
    if model.faults:
        slopes = faulty(moving(track, prompt), prompt)
        track, reader = waves.as_shown(track, slopes), slopes @ reader
    if late_s:  # what was true between two steps is read at the nearer one, on its way to the other
        off = round(late_s / track.h) - late_s / track.h
        reader[:, SATELLITES] = reader[:, SATELLITES] @ (np.eye(STATES) + off * (system - np.eye(STATES)))
    A, R = (x.astype(np.float32, copy=False) for x in (A, R))
    return Linear(track, shown, system, defect, reader, e, A, R, turned, bent, busy(track, model), model)


def _system(track: Track, model: Model) -> np.ndarray:
    """(N, 11, 11) what takes the state one step on: the ship's own slopes, and b and c that fade."""
    h, time = track.h, float(model.ship.scale("time"))
    rate = np.zeros((len(track), 6, STATES))  # the continuous system matrix, but for b and c, which fade
    psi, u, v = track.state[:, 2], track.state[:, 3], track.state[:, 4]
    c, s = np.cos(psi), np.sin(psi)
    rate[:, 0, 2], rate[:, 0, 3], rate[:, 0, 4] = -u * s - v * c, c, -s
    rate[:, 1, 2], rate[:, 1, 3], rate[:, 1, 4] = u * c - v * s, s, c
    rate[:, 2, 5] = 1.0
    rate[:, SPEEDS, MOTION] = jacobian(track, model)
    rate[:, SPEEDS, SLOW] = np.eye(3)
    rate[:, SPEEDS, FLOW] = by_stream(track, _without_current(model))
    F = np.zeros((len(track), STATES, STATES))
    F[:, MOTION] = np.eye(6, STATES) + h * rate + 0.5 * h * h * rate[..., MOTION] @ rate
    F[:, SLOW, SLOW] = np.eye(3) * np.exp(-h / (MEMORY_B * time))
    F[:, FLOW, FLOW] = np.eye(2) * np.exp(-h / (MEMORY_C * time))
    return F


def _bends(
    track: Track,
    model: Model,
    unknowns: Sequence[Unknown],
    catalogue: dict[str, type[Effect]],
    at: dict[str, float] | None,
) -> np.ndarray:
    """(N, 3, 6, P) what one unit of each unknown changes of the slopes of the accelerations, by
    filters.BENDS: at some steps, and along straight lines between them."""
    steps = np.unique(np.append(np.arange(0, len(track), EVERY), len(track) - 1))
    some, beside_it, in_streams = track.where(steps), KeptForces(), KeptForces()

    def slopes(m: Model) -> np.ndarray:
        keep_steered(some, m, track, steps)  # a gear is stepped through all of them
        by_stream_too = by_stream(some, _without_current(m), in_streams)
        return np.concatenate([jacobian(some, m, beside_it)[:, :, 2:], by_stream_too], axis=2)

    out, here = np.zeros((steps.size, 3, 6, len(unknowns)), np.float32), slopes(model)
    for j, unknown in enumerate(unknowns):
        if (other := beside(track, model, unknown, catalogue, at)) is not None:
            out[..., j] = (slopes(other[0]) - here) / other[1]
    after = np.searchsorted(steps, np.arange(len(track)), "right").clip(1, steps.size - 1)
    share = ((np.arange(len(track)) - steps[after - 1]) / (steps[after] - steps[after - 1])).astype(
        np.float32
    )[:, None, None, None]
    return (1.0 - share) * out[after - 1] + share * out[after]


def _reader(track: Track) -> np.ndarray:
    """(N, 8, 11) what right instruments show of the state: each its own, the log the speed through water."""
    c, s = np.cos(track.state[:, 2]), np.sin(track.state[:, 2])
    H = np.zeros((len(track), 8, STATES))
    H[:, MOTION, MOTION] = np.eye(6)
    H[:, 6, 3] = H[:, 7, 4] = 1.0
    H[:, 6, 9], H[:, 6, 10], H[:, 7, 9], H[:, 7, 10] = -c, -s, s, -c
    return H


def _without_current(model: Model) -> Model:
    return Model(model.ship, tuple(e for e in model.effects if type(e).role != "stream"))


def busy(track: Track, model: Model) -> np.ndarray:
    """(N, 3) how hard hull, propeller and rudder are at work, as accelerations [m/s2, m/s2, rad/s2], over the
    length about each moment (less of it at the ends of the track)."""
    s = track.situation(**steered(track, model))
    forces = model.known(s)
    width = max(3, int(model.ship.scale("time") / track.h))
    out = np.empty((len(track), 3))
    for i, axis in enumerate("XYN"):
        square = np.zeros(track.t.shape)
        for name in ("hull", "propeller", "rudder", "coriolis"):
            square += np.broadcast_to(getattr(forces[name], axis), track.t.shape) ** 2
        if parts := [getattr(forces[a.name], axis) for a in model.ship.actuators]:
            square += np.broadcast_to(total(parts), track.t.shape) ** 2
        mean = np.convolve(square, np.ones(width) / width, "same")
        out[:, i] = np.sqrt(mean) / (model.c.m_u, model.c.m_v, model.c.m_r)[i]
    return out
