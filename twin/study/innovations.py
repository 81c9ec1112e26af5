"""What the model cannot predict one step ahead, and how that depends on every unknown: a Kalman filter with its tangents.

Along the smooth motion the ship is linear: delta = (x, y, psi, u, v, r), a slowly varying acceleration b (what any model of this
kind leaves over: its structural error) and a slowly varying current c, both first-order Gauss-Markov. The filter's gains do
not depend on the unknowns theta, so its innovations are affine in them: epsilon = e - G theta. Whitened, they give the normal
equations A = G'G, b = G'e of every later question. Tracks are cut into segments that are filtered side by side.

Source: Ljung (1999) System identification, sec. 7.4 (innovations form); Kennedy & O'Hagan (2001) (model discrepancy).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from twin.physics import core
from twin.physics.effect import Effect
from twin.physics.effects import find
from twin.physics.model import Model

from .columns import LATE, Unknown, columns
from .respond import advance, jacobian, lagged, respond
from .segments import segments
from .track import Track

STATES = 11  # delta (6), b (3), c (2)
MEMORY_B, MEMORY_C = 3.0, 12.0  # correlation times of b and c, in ship lengths sailed


@dataclass(frozen=True)
class Floor:
    """What a correct model of this kind still leaves unexplained on this ship: the structural floor.

    `share` (3,): slow acceleration error as a share of the acceleration that hull, rudder and propeller cause at that moment,
    in surge, sway, yaw; `calm`: the same share of a standard acceleration, there even when nothing happens; `white`: fast
    part; `flow`: scatter of the water's own motion, as a share of U_0; `sensor`: factor on the readings' scatter; `doubt`: share of
    the force of the effects under judgement that may be something else (none on a reference voyage).
    """

    share: tuple[float, float, float] = (0.05, 0.05, 0.05)
    calm: float = 0.5
    white: float = 0.05
    flow: float = 0.004
    sensor: float = 1.3
    doubt: float = 0.0

    def scaled(self, factor: float = 1.0, white: float = 1.0, flow: float = 1.0) -> "Floor":
        surge, sway, yaw = (factor * s for s in self.share)
        return replace(self, share=(surge, sway, yaw), white=white * self.white, flow=flow * self.flow)


@dataclass(frozen=True)
class Linear:
    """One track, linearised about its smooth motion and a model: all that the filter needs, for any floor."""

    track: Track
    F: np.ndarray  # (N, 11, 11)
    defect: np.ndarray  # (N, 6): model's step minus the smooth motion's
    H: np.ndarray  # (N, 8, 11)
    e: np.ndarray  # (N, 8): measured minus read, NaN where there was none
    A: np.ndarray  # (N, 3, P) float32, m/s2 per unit of each unknown
    R: np.ndarray  # (N, 8, P) float32
    busy: np.ndarray  # (N, 3): acceleration that hull, rudder and propeller cause
    model: Model = field(repr=False)
    doubted: np.ndarray | float = 0.0  # (N, 3): acceleration by the effects under judgement, whose forms are only roughly right
    slack: np.ndarray | float = 0.0  # (N, 3): and one that no hypothesis takes away, of effects in the model and of the sea


def linearise(
    track: Track, model: Model, unknowns: Sequence[Unknown], catalogue: dict[str, type[Effect]], at: dict[str, float] | None = None
) -> Linear:
    """Everything about one track that does not depend on the floor (`at`: values of unknowns that the model already holds)."""
    h, n = track.h, len(track)
    _, reading = respond(track, model)
    A, R = columns(track, model, unknowns, catalogue, at)
    U = float(model.ship.scale("speed"))
    current = [Unknown("Current", axis, "m/s", 0.0, 0.02 * U, -U, U) for axis in ("north", "east")]
    flow, _ = columns(track, _without_current(model), current, {"Current": find("Current")})
    F = np.zeros((n, STATES, STATES))
    psi, u, v = track.state[:, 2], track.state[:, 3], track.state[:, 4]
    c, s = np.cos(psi), np.sin(psi)
    rate = np.zeros((n, STATES, STATES))  # the continuous system matrix
    rate[:, 0, 2], rate[:, 0, 3], rate[:, 0, 4] = -u * s - v * c, c, -s
    rate[:, 1, 2], rate[:, 1, 3], rate[:, 1, 4] = u * c - v * s, s, c
    rate[:, 2, 5] = 1.0
    rate[:, 3:6, :6] = jacobian(track, model)
    rate[:, 3:6, 6:9] = np.eye(3)
    rate[:, 3:6, 9:11] = flow
    time = float(model.ship.scale("time"))
    F = np.eye(STATES) + h * rate + 0.5 * h * h * rate @ rate
    F[:, 6:9, 6:9] = np.eye(3) * np.exp(-h / (MEMORY_B * time))
    F[:, 9:11, 9:11] = np.eye(2) * np.exp(-h / (MEMORY_C * time))
    defect = advance(track, model)
    defect[:-1] -= track.state[1:]
    defect[-1] = 0.0
    H = np.zeros((n, 8, STATES))
    H[:, :6, :6] = np.eye(6)
    H[:, 6, 3] = H[:, 7, 4] = 1.0
    H[:, 6, 9], H[:, 6, 10], H[:, 7, 9], H[:, 7, 10] = -c, -s, s, -c
    e = track.measured - reading
    for j, unknown in enumerate(unknowns):
        if unknown.owner == LATE:  # no model holds it: what is known of it is taken off the readings
            e -= R[:, :, j] * (at or {}).get(unknown.label, 0.0)
    e[:, 2] = (e[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
    return Linear(track, F, defect, H, e, A.astype(np.float32), R.astype(np.float32), busy(track, model), model)


def _without_current(model: Model) -> Model:
    return Model(model.ship, tuple(e for e in model.effects if type(e).__name__ != "Current"))


def busy(track: Track, model: Model) -> np.ndarray:
    """(N, 3) how hard hull, propeller and rudder are at work, as accelerations [m/s2, m/s2, rad/s2], over the last length."""
    s = track.situation(delta=lagged(track, model))
    forces = model.known(s)
    width = max(3, int(model.ship.scale("time") / track.h))
    out = np.empty((len(track), 3))
    for i, axis in enumerate("XYN"):
        square = np.zeros(track.t.shape)
        for name in ("hull", "propeller", "rudder", "coriolis"):
            square += np.broadcast_to(getattr(forces[name], axis), track.t.shape) ** 2
        mean = np.convolve(square, np.ones(width) / width, "same")
        out[:, i] = np.sqrt(mean) / (model.c.m_u, model.c.m_v, model.c.m_r)[i]
    return out


def standard(model: Model) -> np.ndarray:
    """(3,) accelerations by the ship's own force and moment scale [m/s2, m/s2, rad/s2]."""
    c: core.Coefficients = model.c
    force, moment = float(model.ship.scale("force")), float(model.ship.scale("moment"))
    return np.array([force / c.m_u, force / c.m_v, 0.3 * moment / c.m_r])


@dataclass(frozen=True)
class Normal:
    """Normal equations of whitened innovations, one for each segment: epsilon = e - G theta, A = G'G, b = G'e."""

    A: np.ndarray  # (S, P, P)
    b: np.ndarray  # (S, P)
    ee: np.ndarray  # (S,)
    logdet: np.ndarray  # (S,) sum of log det of the innovations' covariance
    count: np.ndarray  # (S,) readings
    energy: np.ndarray  # (S, 8) sum of squares by reading
    where: tuple[tuple[int, int, int], ...]  # (track, first step, last step)

    def total(self) -> tuple[np.ndarray, np.ndarray, float]:
        return self.A.sum(0), self.b.sum(0), float(self.ee.sum())

    def only(self, keep: np.ndarray) -> "Normal":
        """Some of the segments."""
        rows = np.flatnonzero(keep)
        return Normal(
            self.A[rows], self.b[rows], self.ee[rows], self.logdet[rows], self.count[rows], self.energy[rows],
            tuple(self.where[i] for i in rows),
        )  # fmt: skip


def innovate(lines: Sequence[Linear], floors: Sequence[Floor], most: int | None = None) -> list[Normal]:
    """Filter every segment of every track (or an even choice of `most`), under every floor, side by side; the normal equations
    for each floor."""
    where = segments([line.track for line in lines], float(lines[0].model.ship.scale("time")), most)
    T, S, W = max(b - a for _, a, b in where), len(where), len(floors)
    P = lines[0].A.shape[2]

    def stack(pick: Callable[[Linear], np.ndarray], fill: float = 0.0) -> np.ndarray:
        first = pick(lines[0])
        out = np.full((T, S, *first.shape[1:]), fill, first.dtype)
        for k, (i, a, b) in enumerate(where):
            out[: b - a, k] = pick(lines[i])[a:b]
        return out

    F, H, e = stack(lambda x: x.F), stack(lambda x: x.H), stack(lambda x: x.e, np.nan)
    defect, turn = stack(lambda x: x.defect), stack(_turn)
    A, R = stack(lambda x: x.A), stack(lambda x: x.R)
    slow = np.concatenate([stack(lambda x, f=f: _slow(x, f)) for f in floors], axis=1)  # type: ignore[misc]
    row = np.tile(np.arange(S), W)  # every floor runs over all segments
    model = lines[0].model
    h = np.array([lines[i].track.h for i, _, _ in where])[row]
    time, speed = float(model.ship.scale("time")), float(model.ship.scale("speed"))
    scatter = np.stack([lines[i].track.sd for i, _, _ in where])

    def by_floor(value: Callable[[Floor], "float | np.ndarray"]) -> np.ndarray:
        return np.repeat(np.array([value(f) for f in floors], dtype=float), S, axis=0)

    noise = (by_floor(lambda f: f.sensor)[:, None] * scatter[row]) ** 2  # (SW, 8)
    flow = (by_floor(lambda f: f.flow) * speed) ** 2
    fast = (by_floor(lambda f: f.white)[:, None] * standard(model)) ** 2 * (h * time)[:, None]  # velocity variance in one step
    keep_b, keep_c = 1.0 - np.exp(-2.0 * h / (MEMORY_B * time)), 1.0 - np.exp(-2.0 * h / (MEMORY_C * time))
    C, X = _start(model, slow[0], flow), np.zeros((S * W, STATES, 1 + P))
    eye, sums = np.arange(STATES), _Sums(S * W, P)
    h_ = h[:, None, None]
    for k in range(T):
        ok = np.isfinite(e[k])[row]
        Hk = H[k][row] * ok[:, :, None]
        E = -(Hk @ X)
        E[:, :, 0] += np.where(ok, e[k][row], 0.0)
        E[:, :, 1:] -= R[k][row] * ok[:, :, None]
        HC = Hk @ C
        Sk = HC @ Hk.transpose(0, 2, 1)
        Sk[:, eye[:8], eye[:8]] += np.where(ok, noise, 1.0)
        L = np.linalg.cholesky(Sk)
        white = np.linalg.inv(L) @ np.concatenate([E, HC], axis=2)
        V = white[:, :, 1 + P :]
        sums.add(white[:, :, : 1 + P], L, ok)
        VT = V.transpose(0, 2, 1)
        Fk = F[k][row]
        X = Fk @ (X + VT @ white[:, :, : 1 + P])
        X[:, :6, 0] += defect[k][row]
        push = h_ * A[k][row]
        X[:, 3:6, 1:] += push
        X[:, 0:3, 1:] += 0.5 * h_ * (turn[k][row] @ push)
        C = Fk @ (C - VT @ V) @ Fk.transpose(0, 2, 1)
        C[:, eye[3:6], eye[3:6]] += fast
        C[:, eye[6:9], eye[6:9]] += keep_b[:, None] * slow[k]
        C[:, eye[9:], eye[9:]] += (keep_c * flow)[:, None]
    whole = sums.normal(tuple(where) * W)
    return [whole.only(np.arange(S * W) // S == w) for w in range(W)]


class _Sums:
    """Running sums of whitened innovations by segment."""

    def __init__(self, S: int, P: int) -> None:
        self.M = np.zeros((S, 1 + P, 1 + P))
        self.logdet, self.count, self.energy = np.zeros(S), np.zeros(S), np.zeros((S, 8))
        self.held: list[np.ndarray] = []

    def add(self, white: np.ndarray, L: np.ndarray, here: np.ndarray) -> None:
        self.held.append(white)
        if len(self.held) == 16:
            self._fold()
        self.logdet += 2.0 * np.log(np.diagonal(L, axis1=1, axis2=2)).sum(1)
        self.count += here.sum(1)
        self.energy += white[:, :, 0] ** 2 * here

    def _fold(self) -> None:
        if self.held:
            W = np.concatenate(self.held, axis=1)
            self.M += W.transpose(0, 2, 1) @ W
            self.held = []

    def normal(self, where: tuple[tuple[int, int, int], ...]) -> Normal:
        self._fold()
        M = self.M
        return Normal(M[:, 1:, 1:], -M[:, 1:, 0], M[:, 0, 0], self.logdet, self.count, self.energy, where)


def _turn(line: Linear) -> np.ndarray:
    """(N, 3, 3) body velocities to d(x, y, psi)/dt."""
    c, s = np.cos(line.track.state[:, 2]), np.sin(line.track.state[:, 2])
    out = np.zeros((c.size, 3, 3))
    out[:, 0, 0], out[:, 0, 1], out[:, 1, 0], out[:, 1, 1], out[:, 2, 2] = c, -s, s, c, 1.0
    return out


def _slow(line: Linear, floor: Floor) -> np.ndarray:
    """(N, 3) variance of the slowly varying acceleration error."""
    calm = floor.calm * standard(line.model)
    return (np.array(floor.share) ** 2) * (line.busy**2 + calm**2) + np.square(floor.doubt * line.doubted) + np.square(line.slack)


def _start(model: Model, slow: np.ndarray, flow: np.ndarray) -> np.ndarray:
    """(S, 11, 11) covariance at the start of each segment: the motion nearly unknown, b and c as they usually are."""
    ship = model.ship
    L, U, time = float(ship.L_pp), float(ship.scale("speed")), float(ship.scale("time"))
    motion = np.array([0.05 * L, 0.05 * L, 0.1, 0.1 * U, 0.1 * U, 0.1 / time]) ** 2
    diagonal = np.column_stack([np.tile(motion, (len(slow), 1)), slow, flow, flow])
    return np.eye(STATES) * diagonal[:, None, :]
