"""What the model cannot predict one step ahead, and how that depends on every unknown: a Kalman filter with
its tangents.

Along the smooth motion the ship is linear: delta = (x, y, psi, u, v, r), a slowly varying acceleration b
(what any model of this kind leaves over: its structural error) and a slowly varying current c, both
first-order Gauss-Markov; and, where a sea was seen to work, what waves do (waves.py). The filter's gains do
not depend on the unknowns theta, so its innovations are affine in them:
epsilon = e - G theta. Whitened, they give the normal equations A = G'G, b = G'e of every later question.
    Tracks are cut into
segments that are filtered side by side.

Source: Ljung (1999) System identification, sec. 7.4 (innovations form); Kennedy & O'Hagan (2001) (model
    discrepancy).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from twin.physics.effect import Effect
from twin.physics.effects import of_role
from twin.physics.maths import total
from twin.physics.model import Model
from twin.study.estimation.abreast import Where, abreast, beside_each
from twin.study.estimation.columns import LATE, Unknown, beside, columns, turns
from twin.study.estimation.filters import (
    FLOW,
    LIGHT,
    MOTION,
    PLACE,
    SHIP,
    SLOW,
    SPEEDS,
    STATES,
    WAVES,
    Filters,
    NoiseVariances,
    Stretches,
)
from twin.study.estimation.normal import Normal, Sums
from twin.study.estimation.respond import (
    SATELLITES,
    accelerations,
    advance,
    faulty,
    jacobian,
    keep_steered,
    later,
    respond,
    standard,
    steered,
    when_true,
)
from twin.study.estimation.start import undone
from twin.study.track import waves
from twin.study.track.segments import segments
from twin.study.track.track import Track

EVERY = 4  # grid steps, an eighth of a ship length, over which slopes change little
MEMORY_B, MEMORY_C = 3.0, 12.0  # correlation times of b and c, in ship lengths sailed


@dataclass(frozen=True)
class NoiseModel:
    """What a correct model of this kind still leaves unexplained on this ship: the structural floor.

    `share` (3,): slow acceleration error as a share of the acceleration that hull, rudder and propeller
        cause at that moment,
    in surge, sway, yaw; `calm`: the same share of a standard acceleration, there even when nothing happens;
    `white` (3,): fast part, of a standard acceleration; `flow`: scatter of the water's own motion, as a share
    of U_0; `sensor`: factor on the readings' scatter;
    `wander`: how far the position that satellites show strays from itself in one second, and sqrt(t) times
        as far in t [m/sqrt(s)];
    `doubt`: share of the force of the effects under judgement that may be something else (none on a
        reference voyage).
    """

    share: tuple[float, float, float] = (0.05, 0.05, 0.05)
    calm: float = 0.5
    white: tuple[float, float, float] = (0.05, 0.05, 0.05)
    flow: float = 0.004
    sensor: float = 1.3
    wander: float = 0.0
    doubt: float = 0.0

    def scaled(self, factor: float = 1.0, white: float = 1.0, flow: float = 1.0) -> "NoiseModel":
        (a, b, c), (d, e, f) = self.share, self.white
        return replace(
            self,
            share=(factor * a, factor * b, factor * c),
            white=(white * d, white * e, white * f),
            flow=flow * self.flow,
        )


@dataclass(frozen=True)
class Linear:
    """One track, linearised about its smooth motion and a model: all that the filter needs, for any floor."""

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

    def only(self, columns: np.ndarray) -> "Linear":
        """The same with some of the unknowns (places, in the order that is wanted)."""
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
) -> Linear:
    """Everything about one track that does not depend on the floor (`at`: values of unknowns that the model
    already holds), about the motion as it was if the model's sensor faults are there. `smooth`: these are
    judged along that motion alone. `exact`: what unknowns push is known beside that motion, too, where the
    filter believes it to be."""
    shown, track = track, undone(track, model)
    # what is late shows another moment: no slope of this one says a wave two seconds ago
    late_s, prompt = model.prompt()
    reading = later(track, respond(track, prompt)[1], late_s)
    # whose column is taken off the readings in full digits
    late = any(u.owner == LATE and u.label in (at or {}) for u in unknowns)
    A, R = columns(track, model, unknowns, catalogue, at, np.float64 if late else np.float32)
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
        slopes = faulty(track, prompt)
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
    rate[:, SPEEDS, FLOW] = _by_current(track, model)
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
    some = track.where(steps)

    def slopes(m: Model) -> np.ndarray:
        keep_steered(some, m, track, steps)  # a gear is stepped through all of them
        return np.concatenate([jacobian(some, m)[:, :, 2:], _by_current(some, m)], axis=2)

    out, here = np.zeros((steps.size, 3, 6, len(unknowns)), np.float32), slopes(model)
    for j, unknown in enumerate(unknowns):
        if (other := beside(track, model, unknown, catalogue, at)) is not None:
            out[..., j] = (slopes(other[0]) - here) / other[1]
    after = np.searchsorted(steps, np.arange(len(track)), "right").clip(1, steps.size - 1)
    share = ((np.arange(len(track)) - steps[after - 1]) / (steps[after] - steps[after - 1])).astype(
        np.float32
    )[:, None, None, None]
    return (1.0 - share) * out[after - 1] + share * out[after]


def _by_current(track: Track, model: Model) -> np.ndarray:
    """(N, 3, 2) acceleration per m/s of current to the north and to the east."""
    current, still, step = (
        of_role("stream").absent(model.ship),
        _without_current(model),
        0.02 * float(model.ship.scale("speed")),
    )
    here = accelerations(track, still)
    there = [accelerations(track, still.but(current.but(**{axis: step}))) for axis in ("north", "east")]
    return np.stack([(a - here) / step for a in there], axis=2)


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
    last length."""
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


def innovate(lines: Sequence[Linear], floors: Sequence[NoiseModel], most: int | None = None) -> list[Normal]:
    """Filter every segment of every track (or an even choice of `most`), under every floor, side by side; the
    normal equations for each floor."""
    where = segments([line.track for line in lines], float(lines[0].model.ship.scale("time")), most)
    told, noise = _stretches(lines, where), _noise(lines, floors, where)
    filters, sums = (
        Filters(told, noise, _start(lines, floors, where)),
        Sums(len(floors), len(where), told.shown.shape[-1] - 1),
    )
    for k in range(len(told.here)):
        sums.add(*filters.correct(k))
        filters.advance(k)
    return sums.normals(told.here, tuple(where))


def _stretches(lines: Sequence[Linear], where: Where) -> Stretches:
    e, defect = abreast([x.e for x in lines], where, np.nan), abreast([x.defect for x in lines], where)
    spread, here = abreast([_spread(x) for x in lines], where), np.isfinite(e)
    shown = beside_each(np.where(here, e, 0.0), [x.R for x in lines], where)
    np.multiply(shown[..., 1:], np.where(here, -1.0, 0.0).astype(LIGHT)[..., None], out=shown[..., 1:])
    pushed = np.empty((*defect.shape, shown.shape[-1]), LIGHT)
    pushed[..., 0] = defect
    np.matmul(spread, abreast([x.A for x in lines], where), out=pushed[..., 1:])
    return Stretches(
        F=abreast([x.F for x in lines], where),
        H=abreast([x.H for x in lines], where) * here[..., None],
        here=here,
        shown=shown,
        pushed=pushed,
        spread=spread,
        turns={j: turn * here[..., None] for j, turn in _turns(lines, where).items()},
        bends=None
        if lines[0].bends is None
        else abreast([x.bends for x in lines if x.bends is not None], where),
        swing=abreast([waves.swinging(x.track) for x in lines], where) if _in_waves(lines) else None,
    )


def _turns(lines: Sequence[Linear], where: Where) -> dict[int, np.ndarray]:
    """Of every column that any of the tracks has; nothing on one whose instruments lack what is at fault."""
    some = {j for x in lines for j in x.turns}
    return {
        j: abreast([x.turns.get(j, np.zeros((len(x.track), 8, 8), np.float32)) for x in lines], where)
        for j in some
    }


def _in_waves(lines: Sequence[Linear]) -> bool:
    return any(line.track.swell is not None for line in lines)


def _noise(lines: Sequence[Linear], floors: Sequence[NoiseModel], where: Where) -> NoiseVariances:
    """Every floor in turn, over all segments."""
    ship, h = lines[0].model.ship, _steps(lines, where)
    time, speed = float(ship.scale("time")), float(ship.scale("speed"))
    new_b, new_c = 1.0 - np.exp(-2.0 * h / (MEMORY_B * time)), 1.0 - np.exp(-2.0 * h / (MEMORY_C * time))
    new = []
    for floor in floors:
        slow = new_b[:, None] * abreast([_slow(x, floor) for x in lines], where)
        out = np.zeros((*slow.shape[:2], STATES))
        out[..., PLACE] = (floor.wander**2 * h)[:, None]
        out[..., SPEEDS] = (np.array(floor.white) * standard(lines[0].model)) ** 2 * (h * time)[:, None]
        out[..., SLOW], out[..., FLOW] = slow, (new_c * (floor.flow * speed) ** 2)[:, None]
        new.append(out)
    reading = [abreast([_reading(x.track, f) for x in lines], where) for f in floors]
    swell = abreast([waves.renewed(x.track) for x in lines], where) if _in_waves(lines) else None
    return NoiseVariances(np.stack(reading, axis=1), np.stack(new, axis=1), swell)


def _steps(lines: Sequence[Linear], where: Where) -> np.ndarray:
    """(S,) of each segment [s]."""
    return np.array([lines[i].track.h for i, _, _ in where])


def _spread(line: Linear) -> np.ndarray:
    """(N, 6, 3) float32: body accelerations to what they add to (x, y, psi, u, v, r) in a step."""
    h, c, s = line.track.h, np.cos(line.track.state[:, 2]), np.sin(line.track.state[:, 2])
    out = np.zeros((c.size, 6, 3))
    out[:, 0, 0], out[:, 0, 1], out[:, 1, 0], out[:, 1, 1], out[:, 2, 2] = c, -s, s, c, 1.0
    out *= 0.5 * h * h
    out[:, SPEEDS] = h * np.eye(3)
    return out.astype(LIGHT)


def _slow(line: Linear, floor: NoiseModel) -> np.ndarray:
    """(N, 3) variance of the slowly varying acceleration error."""
    calm = floor.calm * standard(line.model)
    return (
        (np.array(floor.share) ** 2) * (line.busy**2 + calm**2)
        + np.square(floor.doubt * line.doubted)
        + np.square(line.slack)
    )


def _reading(track: Track, floor: NoiseModel) -> np.ndarray:
    """(N, 8) variance of each reading."""
    return np.square(
        floor.sensor
        * np.broadcast_to(track.sd if track.ripple is None else track.sd * track.ripple, (len(track), 8))
    )


def _start(lines: Sequence[Linear], floors: Sequence[NoiseModel], where: Where) -> np.ndarray:
    """(W, S, n, n) covariance at the start of each segment: the motion nearly unknown, b, c and the waves as
    they usually are."""
    ship, first = lines[0].model.ship, [(i, a, a + 1) for i, a, _ in where]
    L, U, time = float(ship.L_pp), float(ship.scale("speed")), float(ship.scale("time"))
    diagonal = np.zeros((len(floors), len(where), STATES))
    diagonal[..., MOTION] = np.array([0.05 * L, 0.05 * L, 0.1, 0.1 * U, 0.1 * U, 0.1 / time]) ** 2
    for usual, floor in zip(diagonal, floors, strict=True):
        usual[:, SLOW], usual[:, FLOW] = (
            abreast([_slow(x, floor) for x in lines], first)[0],
            (floor.flow * U) ** 2,
        )
    C = np.eye(STATES) * diagonal[..., None, :]
    if not _in_waves(lines):
        return C
    out = np.zeros((*C.shape[:2], WAVES.stop, WAVES.stop))
    out[..., SHIP, SHIP], out[..., WAVES, WAVES] = (
        C,
        abreast([waves.lasting(x.track) for x in lines], first)[0],
    )
    return out
