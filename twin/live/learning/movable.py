"""Which numbers of the named effects may move on board, how far, and what each does to the ship.

    column_j = M [nu_dot(theta + e_j step) - nu_dot(theta)]/step        [N, N, N m for one unit of theta_j]

The column is a secant of the one physics: whatever a number does, by a force, by the ship's inertia or by the
water it feels, stands in it. What has no column of this kind does not move: a current has a filter of its
own (estimate.py), a late gear has a state, and a wrong instrument leaves the ship alone."""

from collections.abc import Sequence
from copy import copy
from typing import NamedTuple

from twin.live.learning.ridge import LARGEST
from twin.live.observer.dynamics import Forces, KnownDynamics
from twin.physics.effect import Effect, Flow
from twin.physics.effect import Force as ForceEffect
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import Force, Situation

REACH = 2.0  # how far a number may go from the ship file's, in deviations of its prior
# the same where it changes its inertia or the water it feels: all slopes change with it, and the certificate
# must hold
NEAR = 0.5
SECANT_STEP = 0.1  # of a secant, in deviations of the prior


class Movable(NamedTuple):
    """One number of one effect: where the ship file has it, its box and its prior deviation, all in its own
    unit."""

    kind: type[Effect]
    name: str
    unit: str
    start: float
    low: float
    high: float
    sd: float

    @property
    def label(self) -> str:
        """Effect and number, as in Wind.c_x."""
        return f"{self.kind.__name__}.{self.name}"

    def of(self, effects: Sequence[Effect]) -> float | None:
        """Its value among these effects; None where the effect is switched off."""
        return next((getattr(e, self.name) for e in effects if type(e) is self.kind), None)


def adaptable(effect: Effect) -> bool:
    """Whether an effect's numbers may move: it pushes the ship, or changes how it feels the water without
    carrying it along."""
    return isinstance(effect, ForceEffect) or (isinstance(effect, Flow) and not effect.stream)


def reach(effect: Effect) -> float:
    """How far its numbers may go, in deviations of their priors."""
    alters = isinstance(effect, Flow) or type(effect).alter is not ForceEffect.alter  # type: ignore[attr-defined]
    return NEAR if alters else REACH


def movable(effects: Sequence[Effect], ship: Ship) -> tuple[Movable, ...]:
    """Every number that may move: inside the catalogue's box, and within reach of where the ship file has
    it."""
    out = []
    for effect in effects:
        for p in effect.params() if adaptable(effect) else ():
            start, sd, (lo, hi) = float(getattr(effect, p.name)), p.sd * float(p.scale(ship)), p.box(ship)
            if sd > 0.0:
                far = reach(effect) * sd
                low, high = max(float(lo), start - far), min(float(hi), start + far)
                out.append(Movable(type(effect), p.name, p.unit, start, low, high, sd))
    return tuple(out)


def moved(
    effects: Sequence[Effect], numbers: Sequence[Movable], values: Sequence[object]
) -> tuple[Effect, ...]:
    """The effects with these values in them (any kind of number), in the same order."""
    new: dict[type[Effect], dict[str, object]] = {}
    for number, value in zip(numbers, values, strict=True):
        new.setdefault(number.kind, {})[number.name] = value
    return tuple(e.but(**new[type(e)]) if type(e) in new else e for e in effects)  # type: ignore[arg-type]


class Columns:
    """What one prior deviation of each number does, in units of the force scale; probes are made anew when
    the model changes."""

    def __init__(self, numbers: Sequence[Movable], scale: Force):
        self.numbers, self.scale = numbers, scale
        self._model: Model | None = None
        self._probes: list[tuple[Model, float] | None] = []

    def at(self, s: Situation, forces: Forces, physics: KnownDynamics, learned: Force) -> list[float]:
        """(surge, sway, yaw) of the first number, of the second, ...; nothing from effects that are switched
        off."""
        if physics.model is not self._model:
            self._model, self._probes = physics.model, [self.probe(physics.model, n) for n in self.numbers]
        u, v, r = physics.rates_of(s, forces, learned)
        out, s, grown = [], copy(s), s.grown
        for probe in self._probes:
            if probe is None:
                out += [0.0, 0.0, 0.0]
                continue
            model, share = probe
            rates = KnownDynamics(model, physics.current).rates(s, learned)
            push = physics.force_for(rates.u - u, rates.v - v, rates.r - r, grown)
            out += [_cut(x / size / share) for x, size in zip(push, self.scale, strict=True)]
        return out

    @staticmethod
    def probe(model: Model, number: Movable) -> tuple[Model, float] | None:
        """The model with the number a step on, away from the nearer end of its box, and that step in prior
        deviations."""
        value = number.of(model.effects)
        if value is None:
            return None
        share = SECANT_STEP if number.high - value > value - number.low else -SECANT_STEP
        return Model(model.ship, moved(model.effects, (number,), (value + share * number.sd,))), share


def _cut(x: float) -> float:
    """As large as a regressor may be; what is no number says nothing."""
    return x if -LARGEST <= x <= LARGEST else LARGEST if x > LARGEST else -LARGEST if x < -LARGEST else 0.0
