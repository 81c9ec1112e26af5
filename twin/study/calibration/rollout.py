"""The core fitted to where the ship really went: open-loop predictions over a few lengths, begun again and
again along the voyages.

A filter's innovations tell the fast part of a motion from the noise to any precision, and believe it: where a
sensor's timing or the form of a force is a little off, the derivatives that explain it best one step ahead
need not be the ones that lead the ship to the right place. What the twin promises is the place. So from the
innovations' answer, or from the first model where that predicts better, Gauss-Newton goes on with the errors
after HORIZON ship lengths, or after SHORTEST_S where a boat sails these sooner, under the same priors (output
error, multiple shooting; Ljung 1999, sec. 7.2; Bock 1983)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from twin.physics.model import Model
from twin.study.estimation.box import within
from twin.study.estimation.columns import Unknown, with_values
from twin.study.estimation.dissipation import half_spaces
from twin.study.estimation.fit import Catalogue
from twin.study.prediction.openloop import HORIZONS_S, coarse_each
from twin.study.track.track import Track

HORIZON, LEADS = 3.0, 3  # ship lengths ahead, looked at so often on the way
SHORTEST_S = HORIZONS_S[0]  # a prediction is judged no sooner: three lengths of a boat are a second or two
OVERLAP = 3.0  # of the time ahead over that between the beginnings of two predictions
ROUNDS, TRIES = 2, 4
COMPARED_STATES = [0, 1, 2, 3]  # x, y, psi, u: what a prediction is judged by
DERIVATIVE_STEP = 0.1  # prior widths by which a derivative is changed to see what it does
LEAST_FALL = 0.02  # share by which the cost must fall for another round


@dataclass
class PathProblem:
    """The unknowns in prior widths from their centres, and what the tracks say of them."""

    tracks: Sequence[Track]
    model: Model
    unknowns: Sequence[Unknown]
    catalogue: Catalogue

    def __post_init__(self) -> None:
        self.centre, self.sd = (
            np.array([u.centre for u in self.unknowns]),
            np.array([u.sd for u in self.unknowns]),
        )
        self.lo, self.hi = np.array([[u.lo, u.hi] for u in self.unknowns]).T
        self.box = (np.array([[u.lo, u.hi] for u in self.unknowns]).T - self.centre) / self.sd
        self.hull = half_spaces(self.model.ship, self.unknowns)
        self.scale = np.ones(1)

    def values(self, z: np.ndarray) -> list[float]:
        """The numbers at z (P,), each in its own unit and inside its box to the last bit."""
        return list(np.clip(self.centre + self.sd * z, self.lo, self.hi).tolist())

    def off(self, z: np.ndarray) -> np.ndarray:
        """(W, K, 4) errors of all predictions, NaN where nothing was measured."""
        return self.off_each(z[None])[0]

    def off_each(self, Z: np.ndarray) -> np.ndarray:
        """(Q, W, K, 4) the same at each of these places Z (Q, P), all in one pass."""
        ahead = max(HORIZON * float(self.model.ship.scale("time")), SHORTEST_S)
        numbers = np.clip(self.centre + self.sd * Z, self.lo, self.hi).T
        ship = self.model.ship.with_derivatives(
            **{
                name: float(x[0]) if np.all(x == x[0]) else x[:, None]
                for u, x in zip(self.unknowns, numbers, strict=True)
                for name in u.names
            }
        )
        model, parts = Model(ship, self.model.effects), []
        for t in self.tracks:
            of_track = model.without_inputs(t.missing())[0]
            each = coarse_each(t, of_track, len(Z), ahead, LEADS, ahead / OVERLAP)
            parts.append([w.off()[..., COMPARED_STATES].transpose(1, 0, 2) for w in each])
        return np.concatenate(parts, axis=1)

    def weigh(self, z: np.ndarray) -> None:
        """Sets the usual size of an error that was measured, by lead and channel, as it is at z (P,);
        neighbouring predictions share most of theirs."""
        off = np.abs(self.off(z))
        usual, measured = np.zeros(off.shape[1:]), np.isfinite(off).any(0)
        usual[measured] = 1.4826 * np.nanmedian(off[:, measured], axis=0)
        self.scale = np.maximum(usual, 1e-9) * np.sqrt(len(COMPARED_STATES) * LEADS * OVERLAP)

    def residual(self, z: np.ndarray) -> np.ndarray:
        """(R,) errors at z (P,) in units of their usual size; what is far off counts as eight times that, and
        what was not measured as none."""
        return self.residual_each(z[None])[0]

    def residual_each(self, Z: np.ndarray) -> np.ndarray:
        """(Q, R) the same at each of these places (Q, P)."""
        return np.nan_to_num(self.off_each(Z) / self.scale).clip(-8.0, 8.0).reshape(len(Z), -1)

    def cost(self, residual: np.ndarray, z: np.ndarray) -> float:
        """-log probability of these errors (R,) at z (P,), but for a constant."""
        return 0.5 * float(residual @ residual) + 0.5 * float(z @ z)


def rolled_out(
    tracks: Sequence[Track], model: Model, unknowns: Sequence[Unknown], catalogue: Catalogue
) -> Model:
    """The model whose core leads the ship most nearly where it went, begun from `model` or from the
    unknowns' centres."""
    problem = PathProblem(tracks, model, unknowns, catalogue)
    here = (np.array([float(model.ship.derivative(u.name)) for u in unknowns]) - problem.centre) / problem.sd
    starts = [here, np.zeros_like(here)]
    problem.weigh(starts[0])
    z = min(starts, key=lambda start: problem.cost(problem.residual(start), start))
    for _ in range(ROUNDS):
        problem.weigh(z)
        before = problem.cost(problem.residual(z), z)
        z, after = _descend(problem, z)
        if after > (1.0 - LEAST_FALL) * before:
            break
    return with_values(model, unknowns, problem.values(z), catalogue)


def _descend(problem: PathProblem, z: np.ndarray) -> tuple[np.ndarray, float]:
    """One step of Levenberg and Marquardt, inside the boxes and the half-spaces of a hull that dissipates; z
    itself when no step is better."""
    r = problem.residual(z)
    best = problem.cost(r, z)
    step = np.where(z + DERIVATIVE_STEP <= problem.box[1], DERIVATIVE_STEP, -DERIVATIVE_STEP)
    J = (problem.residual_each(z + np.diag(step)) - r).T / step
    JJ, pull = J.T @ J + np.eye(z.size), J.T @ r + z
    for damping in np.geomspace(0.01, 100.0, TRIES):
        H = np.linalg.inv(JJ + damping * np.diag(np.diag(JJ)))
        new = within(z - H @ pull, H, problem.box, problem.hull)
        cost = problem.cost(problem.residual(new), new)
        if cost < best:
            return new, cost
    return z, best
