"""A random ship of a family that is plausible: it turns, stops and stays controllable as ships do."""

import numpy as np

from bench.fleet import fleet_weather, sail
from bench.fleet.drive import Propulsion
from bench.fleet.fleet_legs import COURSE, RUDDER, FleetLeg, zigzag
from bench.fleet.hull_families import FAMILIES
from bench.fleet.kit import Kit
from bench.fleet.random_particulars import draw, linear
from bench.fleet.random_ship import RandomShip

TRIES = 60
# ships from this seed on have speed and course over ground; before, a receiver with an attitude
BY_COURSE = 100


def build(family: str, seed: int) -> RandomShip:
    """The first plausible ship of this seed: turning circle, zigzags and stopping as ships have them."""
    for k in range(TRIES):
        rng = np.random.default_rng([seed, sorted(FAMILIES).index(family), k])
        shape, kinds, resistances = FAMILIES[family]
        p = draw(rng, str(rng.choice(kinds)))
        a = linear(p, rng)
        R = resistances[rng.integers(len(resistances))](p, a, rng)
        drive = Propulsion.draw(p, rng)
        drive.balance(R(p.U0))
        ship = RandomShip(
            family,
            seed,
            p,
            shape(p, a, R, rng),
            drive,
            fleet_weather.Windage(p, rng),
            Kit.draw(p, rng, family == "heeling", by_course=seed >= BY_COURSE),
            p.B * rng.uniform(0.04, 0.09),
        )
        if plausible(ship):
            return ship
    raise RuntimeError(f"{family} {seed}: no plausible ship in {TRIES}")


def plausible(ship: RandomShip) -> bool:
    """IMO MSC.137(76) with a fifth of slack: advance and tactical diameter at 35 degrees, first overshoots;
    and half of the speed is lost in one to forty lengths when the shaft stops."""
    p = ship.p
    if not 0.2 * ship.drive.n0 * p.D_P < p.U0 < 1.3 * ship.drive.n0 * p.D_P * p.pitch:
        return False

    def run(legs: list[FleetLeg], lengths: float) -> dict[str, np.ndarray]:
        return sail.sail(ship, legs, fleet_weather.FleetWeather(), lengths * p.unit_s, 0, heading=0.0)

    turn = run([FleetLeg(COURSE, 1), FleetLeg(RUDDER, 99, np.radians(35))], 16)
    x, y, psi = turn["x"], turn["y"], turn["psi"]
    if not np.isfinite(psi).all() or psi.max() < np.pi or turn["u"].min() < 0.1 * p.U0:
        return False
    start = int(np.argmax(turn["t"] >= p.unit_s))
    advance = (x[np.argmax(psi > np.pi / 2)] - x[start]) / p.L
    diameter = (y[np.argmax(psi > np.pi)] - y[start]) / p.L
    if not (1.2 < advance < 5.4 and 1.2 < diameter < 6.0):
        return False
    for angle, most in ((10, 25), (20, 30)):
        z = run(zigzag(angle), 30)
        over = np.degrees(np.abs(z["psi"])).max() - angle
        if not 0.5 < over < 1.5 * most:
            return False
    stop = run([FleetLeg(COURSE, 1), FleetLeg(COURSE, 99, rate=0.0)], 45)
    slow = np.argmax(stop["u"] < 0.5 * p.U0)
    return bool(slow and 1.0 < (stop["t"][slow] / p.unit_s) < 42)
