"""What a model says along a track: the accelerations it would give the ship there, and what the instruments
would read."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from twin.physics import core
from twin.physics.actuators import KeptForces
from twin.physics.dual import Dual
from twin.physics.effect import Lag
from twin.physics.effects import of_role
from twin.physics.effects.of_actuator import OfActuator
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.track.track import READINGS, STATE, Track


def respond(track: Track, model: Model, kept: KeptForces | None = None) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3) accelerations [m/s2, m/s2, rad/s2] and (N, 8) readings (see READINGS) of a ship that moves along
    the track."""
    s, nu_dot = sailing(track, model, kept)
    return nu_dot, readings(s, model)


def sailing(track: Track, model: Model, kept: KeptForces | None = None) -> tuple[Situation, np.ndarray]:
    """A ship that moves along the track, as an instrument that is right would have it, and its accelerations
    (N, 3) [m/s2, m/s2, rad/s2]. `kept`: what actuators gave along it."""
    s = track.situation(**steered(track, model, kept))
    nu_dot = _nu_dot(s, model)
    s.u_dot, s.v_dot, s.r_dot = nu_dot.T
    return track.instruments(s), nu_dot


def accelerations(track: Track, model: Model, kept: KeptForces | None = None) -> np.ndarray:
    """(N, 3) accelerations alone. In m/s2 and rad/s2: SI. `kept`: what actuators gave along the track."""
    return _nu_dot(track.situation(**steered(track, model, kept)), model)


def standard(model: Model) -> np.ndarray:
    """(3,) accelerations by the force and moment scale of the ship as its file has it [m/s2, m/s2, rad/s2]:
    no hypothesis is likelier for what it makes of the noise."""
    c: core.Coefficients = model.ship.c
    force, moment = float(model.ship.scale("force")), float(model.ship.scale("moment"))
    return np.array([force / c.m_u, force / c.m_v, 0.3 * moment / c.m_r])


def _nu_dot(s: Situation, model: Model) -> np.ndarray:
    return np.column_stack([np.broadcast_to(a, np.shape(s.psi)) for a in model.nu_dot(s)])


def readings(s: Situation, model: Model) -> np.ndarray:
    """(N, 8), in SI: what the instruments say of situation s (whose u_r and v_r the model has set), faults
    and all; (K, N, 8) of K situations beside each other."""
    out = np.empty((*np.shape(s.u_r + s.psi), len(READINGS)))
    s = _shown(replace(s), model)
    for i, name in enumerate(READINGS):
        out[..., i] = getattr(s, name)
    return out


def _shown(s: Situation, model: Model) -> Situation:
    """What the faulty instruments make of a situation that is no one else's."""
    for fault in model.faults:
        s = fault.read(s, model.loaded)
    return s


SATELLITES = [READINGS.index(name) for name in ("x", "y", "u", "v")]


def later(track: Track, shown: np.ndarray, late_s: float) -> np.ndarray:
    """The readings (N, 8), in SI, those of the satellites as they were so long ago: on each stretch of
    consecutive steps, before its first and behind its last the ship turns on as it did there."""
    if not late_s:
        return shown
    out = shown.copy()
    for a, b in stretches(track):
        if b - a > 1:
            at = np.arange(b - a) - late_s / track.h
            for j in SATELLITES[2:]:
                out[a:b, j] = _beyond(shown[a:b, j], at)
            turned = 0.5j * track.h * shown[a:b, 5]  # by half of a step, to starboard
            place = _beyond(shown[a:b, 0] + 1j * shown[a:b, 1], at, turned)
            out[a:b, 0], out[a:b, 1] = place.real, place.imag
    return out


def by_lateness(track: Track, shown: np.ndarray, width_s: float) -> np.ndarray:
    """(N, 8), in SI per second: what a little more lateness changes of the readings `shown` (N, 8), over
    `width_s` to either side: the smooth motion holds noise of the readings, and its own slopes more of it."""
    return (later(track, shown, width_s) - later(track, shown, -width_s)) / (2.0 * width_s)


def _beyond(x: np.ndarray, at: np.ndarray, turned: np.ndarray | None = None) -> np.ndarray:
    """`x` (N,) at the steps `at`: between its own by straight lines, beyond its ends as it changed in the
    last step there, which turns on: by twice `turned` (N,), powers of e, in a step."""
    first, last = (0.0, 0.0) if turned is None else (turned[0], turned[-1])
    before, behind = np.minimum(at, 0.0), np.maximum(at - (x.size - 1), 0.0)
    # from the middle of that step to the middle of the way
    ahead_of_first = before * (x[1] - x[0]) * np.exp(first * (before - 1.0))
    past_last = behind * (x[-1] - x[-2]) * np.exp(last * (behind + 1.0))
    return np.asarray(np.interp(at, np.arange(x.size), x) + ahead_of_first + past_last)


def when_true(track: Track, e: np.ndarray, late_s: float) -> np.ndarray:
    """What readings (N, 8), in SI, are off by, the satellites' at the step at which what they show was
    true, so that a filter mends the motion of that step by them. What was shown before a stretch's first
    step was true on a way that nobody saw: at the last steps, where nothing was shown yet, stands what the
    readings after it are off by, that nothing is lost or won by being late."""
    out, steps = e.copy(), round(late_s / track.h)
    for a, b in stretches(track) if steps else ():
        after = np.concatenate([e[a + steps : b], e[a + steps : min(a + 2 * steps, b)]])
        out[a:b, SATELLITES] = np.resize(after, (b - a, 8))[:, SATELLITES] if len(after) else np.nan
    return out


def shown_since(track: Track, e: np.ndarray, late_s: float) -> np.ndarray:
    """The errors of `when_true` (N, 8), in SI, without those of before each stretch's first step, that stand
    at its last ones: nothing was shown there (NaN)."""
    out, steps = e.copy(), round(late_s / track.h)
    for a, b in stretches(track) if steps else ():
        out[max(a, b - steps) : b, SATELLITES] = np.nan
    return out


def stretches(track: Track) -> list[tuple[int, int]]:
    """From where to where its steps follow each other."""
    return list(pairwise([0, *(np.flatnonzero(np.diff(track.steps()) != 1) + 1), len(track)]))


GEARS = 16  # steering gears whose rudder a track remembers


def lagged(track: Track, model: Model) -> np.ndarray:
    """(N,) the rudder as it truly stands [rad], when the track holds its order and the model has a lag."""
    return _lagged(track, model)[0]


def steered(track: Track, model: Model, kept: KeptForces | None = None) -> dict[str, Any]:
    """Rudder and actuators as they truly stand, as fields of Situation. `kept`: what these gave in this
    motion."""
    delta, orders = _lagged(track, model)
    if orders is None:
        return {"delta": delta}
    return {"delta": delta, "orders": orders if kept is None else kept.orders(orders)}


def keep_steered(track: Track, model: Model, of: Track, steps: np.ndarray) -> None:
    """Lets a choice of steps of a track remember what lags made of all of them. `steps` (K,): index."""
    if model.lags in track.rudder:
        return
    delta, orders = _lagged(of, model)
    some = None if orders is None else {k: x[steps] for k, x in orders.items()}
    track.rudder[model.lags] = (delta[steps], some)


def _lagged(track: Track, model: Model) -> tuple[np.ndarray, Mapping[str, np.ndarray] | None]:
    gears = model.lags
    if gears not in track.rudder:
        if len(track.rudder) >= GEARS:
            track.rudder.clear()
        of_rudder = [g for g in gears if not _moved_by(g)]
        orders = track.orders
        for gear in gears if orders else ():
            assert orders is not None
            late = _moved_by(gear)
            orders = {
                k: _behind(track, [gear], x) if k.partition(".")[0] in late else x for k, x in orders.items()
            }
        track.rudder[gears] = (_behind(track, of_rudder, track.delta), orders)
    return track.rudder[gears]  # type: ignore[no-any-return]


def _moved_by(gear: Lag) -> tuple[str, ...]:
    """The actuators that a gear moves; none of the rudder's own."""
    return gear.names if isinstance(gear, OfActuator) else ()


def _behind(track: Track, gears: Sequence[Lag], values: np.ndarray) -> np.ndarray:
    for gear in map(_plain, gears):
        order = np.interp(track.t - gear.dead_time(), track.t, values)
        out = np.empty_like(order)
        actual, h = float(order[0]), track.h
        for k, wanted in enumerate(order.tolist()):
            out[k] = actual = gear.step(actual, wanted, h)
        values = out
    return values


def _plain(gear: Lag) -> Lag:
    """The same in Python's own numbers, in which it is stepped many times faster than in numpy's."""
    return gear.but(**{name: float(value) for name, value in gear.values().items()})


def advance(track: Track, model: Model) -> np.ndarray:
    """(N, 6) where the model would be one grid step on, from each point of the smooth motion."""
    delta, orders = _lagged(track, model)
    half = None if orders is None else {k: _between(x) for k, x in orders.items()}
    s = track.situation(delta=_between(delta), n=_between(track.n), orders=half)
    state = tuple(track.state.T)
    return np.column_stack(model.step(state, s, track.h))


def _between(values: np.ndarray) -> np.ndarray:
    """Inputs half a step on."""
    return np.append(0.5 * (values[1:] + values[:-1]), values[-1])


def jacobian(track: Track, model: Model, kept: KeptForces | None = None) -> np.ndarray:
    """(N, 3, 6) derivative of the accelerations by x, y, psi, u, v, r, by central differences (position
    does not matter), all sides in one pass. In SI. `kept`: what actuators gave in these motions."""
    U, r = float(model.ship.scale("speed")), 1.0 / float(model.ship.scale("time"))
    sizes = {2: 1e-3, 3: 1e-3 * U, 4: 1e-3 * U, 5: 1e-3 * r}
    s = track.situation(**steered(track, model, kept))
    for row, (j, size) in enumerate(sizes.items()):
        sides = np.repeat(track.state[None, :, j], 2 * len(sizes), axis=0)
        sides[2 * row] += size
        sides[2 * row + 1] -= size
        setattr(s, STATE[j], sides)
    there = _abreast(s, model, (2 * len(sizes), len(track)))
    out = np.zeros((len(track), 3, 6))
    for row, (j, size) in enumerate(sizes.items()):
        out[:, :, j] = ((there[:, 2 * row] - there[:, 2 * row + 1]) / (2.0 * size)).T
    return out


def _abreast(s: Situation, model: Model, shape: tuple[int, int]) -> np.ndarray:
    """(3, K, N) accelerations in K situations beside each other."""
    return np.stack([np.broadcast_to(a, shape) for a in model.nu_dot(s)])


def by_stream(track: Track, still: Model, kept: KeptForces | None = None) -> np.ndarray:
    """(N, 3, 2) acceleration [m/s2, rad/s2] per m/s of a stream to the north and to the east, of a model
    without one, as a secant over a fiftieth of the usual speed. `kept`: what actuators gave in these
    streams."""
    step = 0.02 * float(still.ship.scale("speed"))
    of = np.array([[0.0, 0.0], [step, 0.0], [0.0, step]])[:, :, None]
    stream = of_role("stream").absent(still.ship).but(north=of[:, 0], east=of[:, 1])
    s = track.situation(**steered(track, still, kept))
    there = _abreast(s, still.but(stream), (3, len(track)))
    return ((there[:, 1:] - there[:, :1]) / step).transpose(2, 0, 1)


def moving(track: Track, model: Model) -> Situation:
    """What the ship does along the track, its accelerations included, were the instruments right."""
    s = track.situation()
    s.u_dot, s.v_dot, s.r_dot = model.nu_dot(s)
    return track.instruments(s)


def faulty(s: Situation, model: Model) -> np.ndarray:
    """(N, 8, 8) derivative of what the model's faulty instruments show by what they would show were they
    right (`moving`): a compass that is off turns what is left of one speed into the other. In SI.

    A fault that is written as the catalogue's are is differentiated as it stands (physics/dual.py); one that
    is not, by central differences."""
    try:
        return _slopes(s, model)
    except (TypeError, AttributeError, ValueError):
        return _differences(s, model)


def _slopes(s: Situation, model: Model) -> np.ndarray:
    size = len(READINGS)
    seeds = [tuple(float(i == j) for i in range(size)) for j in range(size)]
    s = replace(s, **{n: Dual(getattr(s, n), seed) for n, seed in zip(READINGS, seeds, strict=True)})
    s = _shown(s, model)
    out = np.zeros((np.size(s.t), size, size))
    for i, name in enumerate(READINGS):
        shown = getattr(s, name)
        for j, slope in enumerate(shown.slopes if isinstance(shown, Dual) else ()):
            out[:, i, j] = slope
    return out


def _differences(s: Situation, model: Model) -> np.ndarray:
    L, U, time = float(model.ship.L_pp), float(model.ship.scale("speed")), float(model.ship.scale("time"))
    out = np.zeros((np.size(s.t), len(READINGS), len(READINGS)))
    for j, (name, size) in enumerate(zip(READINGS, (L, L, 1.0, U, U, 1.0 / time, U, U), strict=True)):
        sides = [
            readings(replace(s, **{name: getattr(s, name) + sign * 1e-3 * size}), model)
            for sign in (1.0, -1.0)
        ]
        out[:, :, j] = (sides[0] - sides[1]) / (2e-3 * size)
    return out
