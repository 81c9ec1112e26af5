"""What the model cannot predict one step ahead, and how that depends on every unknown: a Kalman filter with
its tangents.

Along the smooth motion the ship is linear: delta = (x, y, psi, u, v, r), a slowly varying acceleration b
(what any model of this kind leaves over: its structural error) and a slowly varying current c, both
first-order Gauss-Markov; and, where a sea was seen to work, what waves do (waves.py). The filter's gains do
not depend on the unknowns theta, so its innovations are affine in them:
epsilon = e - G theta. Whitened, they give the normal equations A = G'G, b = G'e of every later question.
Tracks are cut into segments that are filtered side by side.

Source: Ljung (1999) System identification, sec. 7.4 (innovations form); Kennedy & O'Hagan (2001) (model
    discrepancy).
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from twin.study.estimation.abreast import Where, abreast, beside_each
from twin.study.estimation.filters import (
    FLOW,
    GROUND,
    HEADING,
    LIGHT,
    MOTION,
    PLACE,
    SLOW,
    SPEEDS,
    STATES,
    Filters,
    NoiseVariances,
    ReceiverError,
    Stretches,
)
from twin.study.estimation.linear import MEMORY_B, MEMORY_C, Linear
from twin.study.estimation.normal import Normal, Sums
from twin.study.estimation.respond import (
    standard,
)
from twin.study.track import waves
from twin.study.track.motion_channels import READINGS
from twin.study.track.segments import segments
from twin.study.track.track import Track

ABREAST = 24  # segments filtered side by side: a step of more takes as much longer, and holds them all


@dataclass(frozen=True)
class NoiseModel:
    """What a correct model of this kind still leaves unexplained on this ship: the structural noise model.

    `share` (3,): slow acceleration error as a share of the acceleration that hull, rudder and propeller cause
        at that moment, in surge, sway, yaw;
    `calm`: the same share of a standard acceleration, there even when nothing happens;
    `white` (3,): fast part, of a standard acceleration; `flow`: scatter of the water's own motion, as a share
    of U_0; `sensor`: factor on the readings' scatter;
    `wander`: how far the position that satellites show strays from itself in one second, and sqrt(t) times
        as far in t [m/sqrt(s)];
    `heading_wander`: the same of the heading that a compass or a pair of antennas shows [rad/sqrt(s)];
    `velocity_error`: of the velocity over ground that a receiver shows, and moves its place by, as a share of
        U_0, and `velocity_error_s`: how long it lasts [s] (first-order Gauss-Markov);
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
    heading_wander: float = 0.0
    velocity_error: float = 0.0
    velocity_error_s: float = 2.0

    def scaled(self, factor: float = 1.0, white: float = 1.0, flow: float = 1.0) -> "NoiseModel":
        """The same with its slow part, its fast part and the water's flow times these factors."""
        (a, b, c), (d, e, f) = self.share, self.white
        return replace(
            self,
            share=(factor * a, factor * b, factor * c),
            white=(white * d, white * e, white * f),
            flow=flow * self.flow,
        )


def innovate(
    lines: Sequence[Linear], noise_models: Sequence[NoiseModel], most: int | None = None
) -> list[Normal]:
    """Filter every segment of every track (or an even choice of `most`), under every noise model, side by
    side; the normal equations for each noise model."""
    where = segments([line.track for line in lines], float(lines[0].model.ship.scale("time")), most)
    erring = any(n.velocity_error > 0.0 for n in noise_models)
    rows = np.arange(len(READINGS)) if erring else _rows(lines)
    stretches = _stretches(lines, where, rows, erring)
    noise = _noise(lines, noise_models, where, rows)
    filters, sums = (
        Filters(stretches, noise, _start(lines, noise_models, where)),
        Sums(len(noise_models), len(where), stretches.shown.shape[-1] - 1, rows),
    )
    for k in range(len(stretches.here)):
        sums.add(*filters.correct(k))
        filters.advance(k)
    return sums.normals(stretches.here, tuple(where))


def innovate_each(
    groups: Iterable[Sequence[Linear]], noise_models: Sequence[NoiseModel]
) -> Iterator[list[Normal]]:
    """`innovate` of each of these groups of lines, some of them side by side: a step of few segments takes as
    long as one of many. No more groups are asked for than are filtered together."""
    held: list[Sequence[Linear]] = []
    for lines in groups:
        held.append(lines)
        tracks = [line.track for some in held for line in some]
        if len(segments(tracks, float(lines[0].model.ship.scale("time")))) >= ABREAST:
            yield from _apart(held, noise_models)
            held = []
    if held:
        yield from _apart(held, noise_models)


def _apart(groups: Sequence[Sequence[Linear]], noise_models: Sequence[NoiseModel]) -> list[list[Normal]]:
    """Filtered together, and told of each group by itself."""
    if len(groups) == 1:
        return [innovate(groups[0], noise_models)]
    of = np.repeat(np.arange(len(groups)), [len(lines) for lines in groups])
    normals = innovate([line for lines in groups for line in lines], noise_models)
    group = of[[track for track, _, _ in normals[0].where]]
    return [[n.only(group == g) for n in normals] for g in range(len(groups))]


def _rows(lines: Sequence[Linear]) -> np.ndarray:
    """(K,) index of the readings that there are at all."""
    return np.flatnonzero(np.any([np.isfinite(x.e).any(0) for x in lines], axis=0))


def _stretches(lines: Sequence[Linear], where: Where, rows: np.ndarray, erring: bool) -> Stretches:
    e = abreast([x.e[:, rows] for x in lines], where, np.nan)
    defect = abreast([x.defect for x in lines], where)
    spread, here = abreast([_spread(x) for x in lines], where), np.isfinite(e)
    shown = beside_each(np.where(here, e, 0.0), [x.R[:, rows] for x in lines], where)
    np.multiply(shown[..., 1:], np.where(here, -1.0, 0.0).astype(LIGHT)[..., None], out=shown[..., 1:])
    pushed = np.empty((*defect.shape, shown.shape[-1]), LIGHT)
    pushed[..., 0] = defect
    np.matmul(spread, abreast([x.A for x in lines], where), out=pushed[..., 1:])
    turned, turns = _turns(lines, where, rows)
    turns *= here[:, :, None, :, None]
    return Stretches(
        F=abreast([x.F for x in lines], where),
        H=abreast([x.H[:, rows] for x in lines], where) * here[..., None],
        here=here,
        shown=shown,
        pushed=pushed,
        spread=spread,
        turned=turned,
        turns=turns.reshape(*here.shape[:2], -1, rows.size),
        bends=None
        if lines[0].bends is None
        else abreast([x.bends for x in lines if x.bends is not None], where),
        swing=abreast([waves.swinging(x.track) for x in lines], where) if _in_waves(lines) else None,
        erring=abreast([_erring(x) for x in lines], where) * here[..., GROUND, None] if erring else None,
    )


def _erring(line: Linear) -> np.ndarray:
    """(N, 2, 2) what a receiver's error to the north and east is of the velocities ahead and to starboard."""
    c, s = np.cos(line.track.state[:, 2]), np.sin(line.track.state[:, 2])
    return np.stack([np.stack([c, s], -1), np.stack([-s, c], -1)], -2)


def _turns(lines: Sequence[Linear], where: Where, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(C,) the columns of faulty instruments that any of the tracks has, and (T, S, C, K, K) what they do of
    each segment; nothing on one whose instruments lack what is at fault."""
    columns = sorted({j for x in lines for j in x.turns})
    size = (max(b - a for _, a, b in where), len(where), len(columns), rows.size, rows.size)
    out = np.zeros(size, LIGHT)
    for k, (i, a, b) in enumerate(where):
        for c, j in enumerate(columns):
            if j in lines[i].turns:
                out[: b - a, k, c] = lines[i].turns[j][a:b, rows[:, None], rows]
    return np.array(columns, int), out


def _in_waves(lines: Sequence[Linear]) -> bool:
    return any(line.track.swell is not None for line in lines)


def _noise(
    lines: Sequence[Linear], noise_models: Sequence[NoiseModel], where: Where, rows: np.ndarray
) -> NoiseVariances:
    """Every noise model in turn, over all segments."""
    ship, h = lines[0].model.ship, _steps(lines, where)
    time, speed = float(ship.scale("time")), float(ship.scale("speed"))
    new_b, new_c = 1.0 - np.exp(-2.0 * h / (MEMORY_B * time)), 1.0 - np.exp(-2.0 * h / (MEMORY_C * time))
    fitful = abreast([np.broadcast_to(np.square(x.fitful), (len(x.track), 3)) for x in lines], where)
    new = []
    for noise_model in noise_models:
        slow = new_b[:, None] * abreast([_slow(x, noise_model) for x in lines], where)
        out = np.zeros((*slow.shape[:2], STATES))
        out[..., PLACE] = (noise_model.wander**2 * h)[:, None]
        out[..., HEADING] = noise_model.heading_wander**2 * h
        white = np.array(noise_model.white) * standard(lines[0].model)
        out[..., SPEEDS] = (white**2 + fitful) * (h * time)[:, None]
        out[..., SLOW], out[..., FLOW] = slow, (new_c * (noise_model.flow * speed) ** 2)[:, None]
        new.append(out)
    reading = [abreast([_reading(x.track, f)[:, rows] for x in lines], where) for f in noise_models]
    swell = abreast([waves.renewed(x.track) for x in lines], where) if _in_waves(lines) else None
    return NoiseVariances(
        np.stack(reading, axis=1), np.stack(new, axis=1), swell, _receiver_error(noise_models, h, speed)
    )


def _receiver_error(noise_models: Sequence[NoiseModel], h: np.ndarray, speed: float) -> ReceiverError | None:
    """What a receiver errs by; none where no noise model has it. `h` (S,) [s]; `speed`: U_0 [m/s]."""
    if not any(n.velocity_error > 0.0 for n in noise_models):
        return None
    left = np.exp(-h / np.array([n.velocity_error_s for n in noise_models])[:, None])
    usual = np.array([n.velocity_error * speed for n in noise_models])[:, None] ** 2
    return ReceiverError(h, left, (1.0 - left**2) * usual)


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


def _slow(line: Linear, noise_model: NoiseModel) -> np.ndarray:
    """(N, 3) variance of the slowly varying acceleration error."""
    calm = noise_model.calm * standard(line.model)
    return (
        (np.array(noise_model.share) ** 2) * (line.busy**2 + calm**2)
        + np.square(noise_model.doubt * line.doubted)
        + np.square(line.slack)
    )


def _reading(track: Track, noise_model: NoiseModel) -> np.ndarray:
    """(N, 8) variance of each reading."""
    return np.square(
        noise_model.sensor
        * np.broadcast_to(track.sd if track.ripple is None else track.sd * track.ripple, (len(track), 8))
    )


def _start(lines: Sequence[Linear], noise_models: Sequence[NoiseModel], where: Where) -> np.ndarray:
    """(W, S, n, n) covariance at the start of each segment: the motion nearly unknown, b, c and the waves as
    they usually are."""
    ship, first = lines[0].model.ship, [(i, a, a + 1) for i, a, _ in where]
    L, U, time = float(ship.L_pp), float(ship.scale("speed")), float(ship.scale("time"))
    diagonal = np.zeros((len(noise_models), len(where), STATES))
    diagonal[..., MOTION] = np.array([0.05 * L, 0.05 * L, 0.1, 0.1 * U, 0.1 * U, 0.1 / time]) ** 2
    for usual, noise_model in zip(diagonal, noise_models, strict=True):
        usual[:, SLOW], usual[:, FLOW] = (
            abreast([_slow(x, noise_model) for x in lines], first)[0],
            (noise_model.flow * U) ** 2,
        )
    parts = [np.eye(STATES) * diagonal[..., None, :]]
    if _in_waves(lines):
        parts.append(abreast([waves.lasting(x.track) for x in lines], first)[0])
    if any(n.velocity_error > 0.0 for n in noise_models):
        parts.append(
            np.eye(2) * np.array([(n.velocity_error * U) ** 2 for n in noise_models])[:, None, None, None]
        )
    out = np.zeros((*diagonal.shape[:2], *2 * (sum(p.shape[-1] for p in parts),)))
    begin = 0
    for part in parts:
        out[..., begin : begin + part.shape[-1], begin : begin + part.shape[-1]] = part
        begin += part.shape[-1]
    return out
