"""Standard manoeuvres, sailed by the model itself, and which of them would tell two effects apart.

The one to sail is the one after which the wrong effect would explain least of what the right one does
(expected information); where nothing shows, the one that would show most of what these voyages could not."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import Any, NamedTuple

import numpy as np

from twin.physics.actuators.helm import ACROSS, actuator_orders
from twin.physics.maths import DEG
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.diagnosis.case import Case, visible
from twin.study.estimation.linear import linearise
from twin.study.prediction.trial import shaft_speed
from twin.study.track.track import READINGS, Track

LENGTHS = 40  # a manoeuvre lasts while the ship sails so many of its lengths
STEPS_PER_LENGTH = 12
TURN = 5.0  # lengths for which one actuator works unlike the others
SLOWEST = 0.3  # of U_0: at which a ship of actuators sails a manoeuvre


@dataclass
class HelmOrder:
    """What the helmsman sees and remembers: lengths sailed, heading change [rad], his last order."""

    lengths: float = 0.0
    turned: float = 0.0
    rate: float = 0.0  # r L / U
    side: float = 1.0


Order = Callable[[HelmOrder], tuple[float, float]]  # rudder [rad], shaft speed as a share of the usual
Alone = Callable[[float, int, int], float]  # lengths sailed, which actuator of how many -> factor on it


def _zigzag(angle: float) -> Order:
    def order(helm: HelmOrder) -> tuple[float, float]:
        if helm.side * helm.turned > angle:
            helm.side = -helm.side
        return helm.side * angle, 1.0

    return order


def _steer(course: Callable[[float], float], power: Callable[[float], float]) -> Order:
    """Hold a course (of lengths sailed) by proportional and rate action."""

    def order(helm: HelmOrder) -> tuple[float, float]:
        error = course(helm.lengths) - helm.turned
        return float(np.clip(1.5 * error - 1.0 * helm.rate, -25 * DEG, 25 * DEG)), power(helm.lengths)

    return order


def _in_turn(others: float) -> Alone:
    """Each of the actuators in turn as usual for a few lengths, and the others at that share of it, until
    the manoeuvre ends."""

    def alone(lengths: float, which: int, count: int) -> float:
        return 1.0 if int(lengths / min(TURN, LENGTHS / count)) % count == which else others

    return alone


class Manoeuvre(NamedTuple):
    """What the helmsman orders, in words what it is (`{azimuths}`: what those do, where a ship has several),
    and on a ship of actuators what single ones get beside: `alone` those that drive it, `side` (of lengths
    sailed, a share of full) its tunnel thrusters."""

    order: Order
    doc: str
    alone: Alone | None = None
    side: Callable[[float], float] | None = None

    def suits(self, model: Model) -> bool:
        """Whether the ship has what is to be sailed with."""
        parts, drives = len(model.ship.actuators), len(_drives(model))
        return (self.alone is None or drives > 1) and (self.side is None or parts > drives)

    def words(self, model: Model) -> str:
        """What it is, for the helmsman of this ship."""
        several = sum(a.kind == "azimuth" for a in model.ship.actuators) > 1
        return self.doc.format(azimuths=" (azimuths: all alike)" if several else "")


def _drives(model: Model) -> list[str]:
    """The actuators that drive the ship ahead."""
    return [a.name for a in model.ship.actuators if a.kind != ACROSS]


MANOEUVRES: dict[str, Manoeuvre] = {
    "zigzag 10/10": Manoeuvre(
        _zigzag(10 * DEG),
        "10 deg of helm{azimuths} to each side whenever the heading has changed by 10 deg, at constant power",
    ),
    "zigzag 20/20": Manoeuvre(
        _zigzag(20 * DEG),
        "20 deg of helm{azimuths} to each side whenever the heading has changed by 20 deg, at constant power",
    ),
    "turning circles": Manoeuvre(
        lambda h: (25 * DEG if h.lengths < LENGTHS / 2 else -25 * DEG, 1.0),
        "a circle to each side at 25 deg",
    ),
    "speed changes": Manoeuvre(
        _steer(lambda s: 0.0, lambda s: (1.0, 0.6, 1.0, 0.4)[int(s / 10) % 4]),
        "straight, at 100, 60, 100, 40 % of the shaft speed",
    ),
    "reciprocal runs": Manoeuvre(
        _steer(lambda s: pi * (s > LENGTHS / 2), lambda s: 1.0),
        "the same straight run there and back at constant power",
    ),
    "square": Manoeuvre(
        _steer(lambda s: 0.5 * pi * int(s / 10), lambda s: 1.0),
        "four straight legs at right angles at constant power",
    ),
    "zigzag with speed changes": Manoeuvre(
        lambda h: (_zigzag(20 * DEG)(h)[0], (1.0, 0.6, 1.0, 0.4)[int(h.lengths / 10) % 4]),
        "a 20/20 zigzag at 100, 60, 100 and 40 % of the usual shaft speed",
    ),
    "one actuator at a time": Manoeuvre(
        _steer(lambda s: 0.0, lambda s: 1.0),
        "each of those that drive the ship alone in turn for 5 lengths or less, the others stopped, on a "
        "course as far as it holds",
        alone=_in_turn(0.0),
    ),
    "uneven thrust": Manoeuvre(
        _steer(lambda s: 0.0, lambda s: 1.0),
        "each of those that drive the ship in turn as usual for 5 lengths or less, the others at 60 %, on a "
        "course as far as it holds",
        alone=_in_turn(0.6),
    ),
    "side thrust at low speed": Manoeuvre(
        lambda h: (0.0, 0.3),
        "at 30 % of the usual power, the tunnel thrusters full to each side in turn, for 5 lengths each",
        side=lambda s: 1.0 if int(s / 5) % 2 else -1.0,
    ),
}


def sail(case: Case, model: Model, manoeuvre: Manoeuvre) -> Track:
    """The track of a manoeuvre that the model sails in the water and weather of the case's first track, whose
    name it has, without what that did not record; NaN from where it runs away."""
    like = case.tracks[0]
    model, _ = model.without_inputs(like.missing())
    parts, speed = bool(model.ship.actuators), float(np.median(like.state[:, 3]))
    h = float(model.ship.scale("time")) / STEPS_PER_LENGTH
    if parts:  # what each gets in turn must fit into the lengths that are sailed
        speed = max(speed, SLOWEST * float(model.ship.U_0))
        h *= float(model.ship.U_0) / speed
    steps = LENGTHS * STEPS_PER_LENGTH
    usual = shaft_speed(model, speed) if parts else float(np.median(like.n[like.whole]))
    weather = {name: float(np.median(values)) for name, values in like.weather.items()}
    state = (0.0, 0.0, 0.0, speed, 0.0, 0.0)
    helm, L = HelmOrder(), float(model.ship.L_pp)
    states, orders = np.full((steps, 6), np.nan), np.zeros((steps, 2))
    actuator_rows: dict[str, np.ndarray] = {}
    for k in range(steps):
        if not np.isfinite(state).all():
            break
        delta, power = manoeuvre.order(helm)
        states[k], orders[k] = state, (delta, power * usual)
        given = inputs(model, manoeuvre, helm, delta, power * usual)
        for name, value in given.get("orders", {}).items():
            actuator_rows.setdefault(name, np.zeros(steps))[k] = value
        state = model.step(state, Situation(**given, t=k * h, **weather), h)
        speed = max(abs(state[3]), 1e-3)
        helm.lengths, helm.turned, helm.rate = helm.lengths + speed * h / L, state[2], state[5] * L / speed
    measured = np.full((steps, len(READINGS)), np.nan)
    seen = np.isfinite(like.measured).any(0)
    # only which readings there are counts: information does not depend on their values
    measured[:, seen] = 0.0
    return Track(
        like.name,
        h * np.arange(steps),
        h,
        states,
        orders[:, 0],
        orders[:, 1],
        {name: np.full(steps, value) for name, value in weather.items()},
        measured,
        like.sd,
        np.ones(steps, bool),
        orders=actuator_rows if parts else None,
    )


def inputs(model: Model, manoeuvre: Manoeuvre, helm: HelmOrder, delta: float, power: float) -> dict[str, Any]:
    """Rudder and shaft, or what each actuator is told, as fields of Situation."""
    if not model.ship.actuators:
        return {"delta": delta, "n": power}
    drives = _drives(model)
    share = manoeuvre.alone or (lambda lengths, which, count: 1.0)
    alone = {name: share(helm.lengths, i, len(drives)) for i, name in enumerate(drives)}
    side = manoeuvre.side(helm.lengths) if manoeuvre.side else 0.0
    return {"orders": actuator_orders(model.ship, delta, power, side, alone)}


def separation(case: Case, track: Track, first: str, second: str, z: np.ndarray) -> float:
    """Log odds that this track would be expected to give for `first` (at z (Q,) prior widths) against
    `second`."""
    here, _ = case.linearised.without_inputs(track.missing())
    A = case.reduced([linearise(track, here, case.unknowns, case.catalogue)], [case.noise_model])[0]
    a, b = A.rows((first,)), A.rows((second,))
    size = z[a]
    alone = float(size @ A.A[np.ix_(a, a)] @ size)
    pull = A.A[np.ix_(b, a)] @ size
    mimic = float(pull @ np.linalg.solve(A.A[np.ix_(b, b)] + np.eye(b.size), pull))
    return 0.5 * (alone - mimic)


def reason(scores: Mapping[str, float], best: str, model: Model) -> str:
    """Why that manoeuvre, in words for this ship (`scores`: log odds of those that the model can be sailed
    through)."""
    rest = sorted((name for name in scores if name != best), key=lambda name: -scores[name])
    other = (
        f"next best: {rest[0]}, {_odds(scores[rest[0]])}" if rest else "in every other the model runs away"
    )
    what = MANOEUVRES[best].words(model)
    return f"{what}: expected odds of {_odds(scores[best])} for the right one of the two; {other}"


def sailed(case: Case, model: Model) -> dict[str, Track]:
    """The track of every manoeuvre that suits the ship and that the model can be sailed through."""
    tracks = {name: sail(case, model, m) for name, m in MANOEUVRES.items() if m.suits(model)}
    return {name: t for name, t in tracks.items() if np.isfinite(t.state).all()}


def next_manoeuvre(
    case: Case, model: Model, first: str, second: str, z: np.ndarray
) -> dict[str, object] | None:
    """The manoeuvre that tells these two apart best, or None when none would. `z` (Q,) in prior widths."""
    scores = {name: separation(case, t, first, second, z) for name, t in sailed(case, model).items()}
    best = max(scores, key=lambda name: scores[name], default="")
    if not best or scores[best] < 1.0:
        return None
    return {"separates": [first, second], "shows": [], "manoeuvre": best, "why": reason(scores, best, model)}


def showing(case: Case, model: Model, unseen: Sequence[str]) -> dict[str, object] | None:
    """The manoeuvre that would show most of these effects, had they a plausible size; None when none would
    show one."""
    shown = {name: _shown_by(case, t, unseen) for name, t in sailed(case, model).items()}
    best = max(shown, key=lambda name: len(shown[name]), default="")
    if not best or not shown[best]:
        return None
    of = f"{len(shown[best])} of the {len(unseen)} that could not be seen"
    why = f"{MANOEUVRES[best].words(model)}: it would show {of}"
    return {"separates": [], "shows": shown[best], "manoeuvre": best, "why": why}


def _shown_by(case: Case, track: Track, names: Sequence[str]) -> list[str]:
    here, _ = case.linearised.without_inputs(track.missing())
    line = linearise(track, here, case.unknowns, case.catalogue)
    reduced = case.reduced([line], [case.noise_model])[0]
    return [name for name in names if visible(reduced, name)]


def _odds(log_odds: float) -> str:
    return f"{np.exp(log_odds):.0f} to 1" if log_odds < 6.9 else "more than 1000 to 1"
