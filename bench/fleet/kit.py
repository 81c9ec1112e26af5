"""What is usual of the instruments of one ship: noise, lateness, small faults, gaps."""

from dataclasses import dataclass

import numpy as np

from bench.fleet.random_particulars import Particulars


@dataclass(frozen=True)
class Kit:
    """What is usual on one ship. SI units, rad; `step_*`: of quantisation."""

    every_s: float
    gnss: float
    gnss_wander: float
    gnss_late: float
    speed: float
    speed_late: float
    heading: float
    heading_bias: float
    deviation: float
    rate: float
    rate_bias: float
    log: float
    log_scale: float
    log_late: float
    log_angle: float
    arm: tuple[float, float]  # where the antenna really is from where it is said to be [m]
    high: float  # of the antenna above the centre of roll [m]
    wind_factor: float
    wind_angle: float
    has_log: bool
    has_wind: bool
    has_sea: bool
    has_roll: bool
    has_bank: bool
    has_depth: bool
    coarse: bool  # a bridge log: whole tenths of degrees and knots
    lost: float  # share of samples
    by_course: bool  # whether velocity came as speed and course over ground, turned by the compass

    @staticmethod
    def draw(p: Particulars, rng: np.random.Generator, heels: bool, by_course: bool) -> "Kit":
        boat, small = p.L < 30, lambda sd: float(sd * rng.standard_normal())
        return Kit(
            every_s=float(np.clip(p.unit_s / rng.uniform(14, 26), 0.1, 2.0)),
            gnss=rng.uniform(0.15, 0.6) if boat else rng.uniform(0.3, 1.2),
            gnss_wander=rng.uniform(0.1, 0.5) if boat else rng.uniform(0.3, 1.2),
            gnss_late=rng.uniform(0.05, 0.4),
            speed=rng.uniform(0.02, 0.06),
            speed_late=rng.uniform(0.05, 0.5),
            heading=np.radians(rng.uniform(0.05, 0.3)),
            heading_bias=np.radians(small(0.3)),
            deviation=np.radians(small(0.2)),
            rate=np.radians(rng.uniform(0.01, 0.05)) * (6 if boat else 1),
            rate_bias=small(0.001) / p.unit_s,
            log=rng.uniform(0.03, 0.08),
            log_scale=small(0.012),
            log_late=rng.uniform(0.1, 1.0),
            log_angle=np.radians(small(0.4)),
            arm=(small(0.015) * p.L, small(0.03) * p.B),
            high=p.B * rng.uniform(0.5, 1.2),
            wind_factor=1 + small(0.08),
            wind_angle=np.radians(small(4.0)),
            has_log=rng.random() < 0.75,
            has_wind=rng.random() < 0.67,
            has_sea=rng.random() < 0.5,
            has_roll=heels or rng.random() < 0.4,
            has_bank=rng.random() < 0.4,
            has_depth=rng.random() < 0.6,
            coarse=rng.random() < 0.35,
            lost=rng.choice([0.0, 0.0, 0.005, 0.02]) * 1.0,
            by_course=by_course,
        )
