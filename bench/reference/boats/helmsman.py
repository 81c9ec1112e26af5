"""What the helmsman orders: helm and power as legs, and for the drives that serve them what each gets."""

import math
import random
from dataclasses import dataclass, field

from bench.reference.boats.craft import Craft, Drive

PLANS = ("mixed", "zigzag_20", "turning_circle", "straight")


@dataclass(frozen=True)
class BoatLeg:
    """`helm` -1 .. 1 to starboard, `power` a share of full, `own`: what single drives get beside that,
    `side`: what tunnel thrusters are told; `seconds` long. With `until_deg` helm is reversed whenever the
    heading has gone that far."""

    seconds: float
    power: float
    helm: float = 0.0
    side: float = 0.0
    own: dict[str, float] = field(default_factory=dict)
    until_deg: float = 0.0


def legs(plan: str, craft: Craft, rng: random.Random) -> list[BoatLeg]:
    """A minute or more of legs, repeated by the caller."""
    unit = max(craft.L / craft.U0, 1.5)
    if plan == "straight":
        return [BoatLeg(30.0 * unit, 0.75)]
    if plan == "turning_circle":
        return [
            BoatLeg(6 * unit, 0.75),
            BoatLeg(40 * unit, 0.75, 0.6),
            BoatLeg(6 * unit, 0.75),
            BoatLeg(40 * unit, 0.75, -0.6),
        ]
    if plan == "zigzag_20":
        return [BoatLeg(4 * unit, 0.75), BoatLeg(60 * unit, 0.75, 0.6, until_deg=20.0)]
    return [_drawn(craft, unit, rng) for _ in range(20)]


def _drawn(craft: Craft, unit: float, rng: random.Random) -> BoatLeg:
    power, seconds = rng.choice((0.35, 0.5, 0.65, 0.8, 0.95)), rng.uniform(3.0, 7.0) * unit
    if rng.random() < 0.25:
        return BoatLeg(2.0 * seconds, power, rng.choice((-1, 1)) * rng.uniform(0.3, 0.7), until_deg=15.0)
    own = {}
    if rng.random() < 0.5:
        own[rng.choice(craft.drives).name] = rng.uniform(-0.35, 0.2)
    side = rng.choice((-0.8, -0.5, 0.5, 0.8)) if power < 0.6 and rng.random() < 0.6 else 0.0
    return BoatLeg(seconds, power, rng.choice((0.0, 1.0)) * rng.uniform(-0.8, 0.8), side, own)


class BoatHelmsman:
    """Asked each tick; gives each drive its order (share of full, angle)."""

    def __init__(self, craft: Craft, plan: str, seed: int):
        if plan not in PLANS:
            raise ValueError(f"a {craft.name} sails {', '.join(PLANS)}, not {plan!r}.")
        self.craft, self.plan = craft, plan
        self._rng = random.Random(seed)
        self._legs: list[BoatLeg] = []
        self._until = 0.0
        self._side = 1.0
        self._from: float | None = None
        self.pods = all(d.kind == "pod" for d in craft.drives)

    def orders(self, t: float, psi: float) -> dict[str, tuple[float, float]]:
        while t >= self._until - 1e-9:
            if not self._legs:
                self._legs = legs(self.plan, self.craft, self._rng)
            self.leg = self._legs.pop(0)
            self._until, self._side, self._from = self._until + self.leg.seconds, 1.0, psi
        leg = self.leg
        if leg.until_deg and self._from is not None:
            turned = math.degrees(psi - self._from) * math.copysign(1.0, leg.helm)
            if turned * self._side > leg.until_deg:
                self._side = -self._side
        helm = leg.helm * self._side
        return {d.name: self._of(d, leg, helm) for d in self.craft.drives}

    def _of(self, d: Drive, leg: BoatLeg, helm: float) -> tuple[float, float]:
        own = leg.own.get(d.name, 0.0)
        if d.kind == "tunnel":
            return leg.side, 0.0
        if d.kind == "thruster":
            return _share(leg.power * (1.0 - math.copysign(helm, d.y * helm) if d.y else 1.0) + own), 0.0
        power = _share(leg.power + own)
        if d.kind == "pod":
            return power, (helm if d.x > 0.0 else -helm) * 0.7 + 0.4 * leg.side + 0.5 * own
        return power, helm * d.angle_max


def _share(x: float) -> float:
    return min(max(x, -1.0), 1.0)
