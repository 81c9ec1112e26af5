"""What the helmsman does: tables of legs, as long as ship lengths take, so that they suit every hull."""

from dataclasses import dataclass

COURSE, ZIGZAG, RUDDER = 0, 1, 2


@dataclass(frozen=True)
class Leg:
    """COURSE: turn by `a` degrees, hold; ZIGZAG: rudder +-a against heading +-b; RUDDER: hold rudder `a`."""

    mode: int
    lengths: float  # how long, in L/U0 of time
    a: float = 0.0
    b: float = 0.0
    rate: float = 1.0  # propeller rate / initial rate; below zero: astern until it stops


def zigzag(angle):
    return [Leg(COURSE, 2), Leg(ZIGZAG, 43, angle, angle)]


MANOEUVRES = {
    "zigzag_10": zigzag(10),
    "zigzag_20": zigzag(20),
    "turning_circle": [
        Leg(COURSE, 3),
        Leg(RUDDER, 25, 20),
        Leg(COURSE, 6),
        Leg(RUDDER, 25, -20),
        Leg(COURSE, 6),
    ],
    "course_changes": [
        Leg(COURSE, 4),
        Leg(COURSE, 6, 20),
        Leg(COURSE, 6, -35),
        Leg(COURSE, 7, 45),
        Leg(COURSE, 6, -30),
        Leg(COURSE, 7, -60),
        Leg(COURSE, 8, 75),
    ],
    "speed_changes": [
        Leg(COURSE, 5),
        Leg(COURSE, 7, 0, rate=0.6),
        Leg(COURSE, 7, 15, rate=0.85),
        Leg(COURSE, 8, -15, rate=0.45),
        Leg(COURSE, 8, 10, rate=1.0),
        Leg(COURSE, 6, -10, rate=0.7),
    ],
    "crash_stop": [Leg(COURSE, 4), Leg(COURSE, 22, 0, rate=-0.75), Leg(COURSE, 16, 0, rate=0.8)],
    "reciprocal_runs": [Leg(COURSE, 14), Leg(COURSE, 20, 180)],
    "square": [Leg(COURSE, 11), Leg(COURSE, 11, 90), Leg(COURSE, 11, 90), Leg(COURSE, 11, 90)],
    "straight": [Leg(COURSE, 45)],
    "mixed": None,  # drawn from the seed: course changes, zigzags, turns, speeds
}


def mixed_leg(rng):
    """One leg of a varied voyage."""
    rate = float(rng.choice([1.0, 1.0, 0.9, 0.75, 0.6]))
    side = float(rng.choice([-1, 1]))
    kind = rng.random()
    if kind < 0.45:
        return Leg(COURSE, rng.uniform(4, 8), side * rng.uniform(10, 70), rate=rate)
    if kind < 0.70:
        angle = float(rng.choice([10, 15, 20]))
        return Leg(ZIGZAG, rng.uniform(8, 13), side * angle, angle, rate)
    if kind < 0.90:
        return Leg(RUDDER, rng.uniform(3, 6), side * rng.uniform(8, 28), rate=rate)
    return Leg(COURSE, rng.uniform(3, 6), 0.0, rate=rate)


def legs(name, hull, duration_s, rng):
    """Pairs (leg, start [s]) of a voyage, by name or from Legs, repeated or drawn until they last.

    A boat's legs are twice as many lengths.
    """
    if isinstance(name, str) and name not in MANOEUVRES:
        raise ValueError(f"unknown manoeuvre {name!r}. Known: {', '.join(MANOEUVRES)}.")
    plan = MANOEUVRES[name] if isinstance(name, str) else name
    unit = hull.L / hull.U0 * (2.0 if hull.L < 5 else 1.0)
    out, seconds = [], 0.0
    while seconds < duration_s:
        for leg in plan or [mixed_leg(rng)]:
            out.append((leg, seconds))
            seconds += leg.lengths * unit
    return out
