"""What it takes to hide an effect in the truth: numbers, changes of hull and weather, what is then true."""

from dataclasses import dataclass, field

FULL_SCALE = 50.0  # [m] above this length a ship, below a boat


@dataclass
class Plan:
    numbers: dict = field(default_factory=dict)
    hull: dict = field(default_factory=dict)
    weather: dict = field(default_factory=dict)
    truth: dict = field(default_factory=dict)


def calm_resistance(hull):
    """Resistance [N] at service speed."""
    return 0.5 * hull.rho * hull.L * hull.d * hull.U0**2 * hull.R0


def either(rng):
    return float(rng.choice([-1.0, 1.0]))
