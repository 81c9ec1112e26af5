"""What the helmsman does, leg by leg, in times of the ship's own length over speed."""

from dataclasses import dataclass
from math import pi, radians

import numpy as np

COURSE, ZIGZAG, RUDDER, STEPS = range(4)


@dataclass
class FleetLeg:
    """COURSE: turn by `a` and hold; ZIGZAG: rudder +-a at heading +-b; RUDDER: hold; STEPS: random steps up
    to
    `a`."""

    mode: int
    lengths: float
    a: float = 0.0  # [rad]
    b: float = 0.0
    rate: float = 1.0  # of the service shaft speed


def zigzag(angle: float) -> list[FleetLeg]:
    return [FleetLeg(COURSE, 3), FleetLeg(ZIGZAG, 500, radians(angle), radians(angle))]


def mixed(rng: np.random.Generator) -> list[FleetLeg]:
    """Course changes, a few rudder steps, zigzags and turns at several speeds."""
    out = [FleetLeg(COURSE, 3)]
    for _ in range(80):
        rate = float(rng.choice([1.0, 1.0, 0.9, 0.75, 0.6]))
        mode = rng.choice([COURSE, COURSE, ZIGZAG, RUDDER, STEPS])
        turn = float(rng.choice([-1, 1]) * radians(rng.uniform(10, 70)))
        if mode == COURSE:
            out.append(FleetLeg(COURSE, rng.uniform(4, 9), turn, 0, rate))
        elif mode == ZIGZAG:
            out.append(
                FleetLeg(ZIGZAG, rng.uniform(9, 16), *(radians(float(rng.choice([10, 15, 20]))),) * 2, rate)
            )
        elif mode == RUDDER:
            out.append(
                FleetLeg(
                    RUDDER,
                    rng.uniform(4, 12),
                    float(rng.choice([-1, 1])) * radians(rng.uniform(8, 30)),
                    0,
                    rate,
                )
            )
        else:
            out.append(FleetLeg(STEPS, rng.uniform(8, 14), radians(15), 0, rate))
    return out


def courses(rng: np.random.Generator) -> list[FleetLeg]:
    return [FleetLeg(COURSE, 4)] + [
        FleetLeg(COURSE, rng.uniform(5, 9), float(rng.choice([-1, 1])) * radians(rng.uniform(15, 80)))
        for _ in range(80)
    ]


def speeds(rng: np.random.Generator) -> list[FleetLeg]:
    return [FleetLeg(COURSE, 4)] + [
        FleetLeg(
            COURSE,
            rng.uniform(6, 9),
            float(rng.choice([-1, 0, 1])) * radians(rng.uniform(5, 25)),
            0,
            rng.uniform(0.45, 1.0),
        )
        for _ in range(80)
    ]


def circle(rng: np.random.Generator) -> list[FleetLeg]:
    a = radians(rng.uniform(15, 35))
    return [
        FleetLeg(COURSE, 3),
        *(
            leg
            for _ in range(10)
            for leg in (
                FleetLeg(RUDDER, 16, a),
                FleetLeg(COURSE, 5),
                FleetLeg(RUDDER, 16, -a),
                FleetLeg(COURSE, 5),
            )
        ),
    ]


PLANS = {
    "mixed": mixed,
    "zigzag": lambda rng: zigzag(float(rng.choice([10, 15, 20]))),
    "courses": courses,
    "speeds": speeds,
    "circle": circle,
}


class FleetHelmsman:
    """Orders of rudder [rad] and shaft (share of service) from heading and rate of turn."""

    def __init__(self, legs: list[FleetLeg], unit_s: float, heading: float, rng: np.random.Generator) -> None:
        self.legs, self.unit, self.rng = iter(legs), unit_s, rng
        self.until, self.want, self.base, self.sign, self.held = 0.0, heading, heading, 1.0, 0.0
        self.leg, self.next_step, self.wait = FleetLeg(COURSE, 0), 0.0, 0.0

    def order(self, t: float, psi: float, r: float, hard: float) -> tuple[float, float]:
        if t >= self.until:
            self.leg = next(self.legs, FleetLeg(COURSE, 10))
            self.until = t + self.leg.lengths * self.unit
            self.base, self.sign = psi, 1.0
            self.want = (self.want if self.leg.a == 0 else psi) + (
                self.leg.a if self.leg.mode == COURSE else 0.0
            )
            self.next_step = t
        leg = self.leg
        if leg.mode == COURSE:
            off = (self.want - psi + pi) % (2 * pi) - pi
            d = max(-radians(22), min(radians(22), 1.1 * off - 1.6 * r * self.unit))
        elif leg.mode == ZIGZAG:
            if self.sign * (psi - self.base) > leg.b:
                self.sign = -self.sign
            d = self.sign * leg.a
        elif leg.mode == RUDDER:
            d = leg.a
        else:
            if t >= self.next_step:
                self.held, self.next_step = (
                    float(self.rng.uniform(-leg.a, leg.a)),
                    t + self.rng.uniform(0.7, 2.5) * self.unit,
                )
            d = self.held
        return max(-hard, min(hard, d)), leg.rate
