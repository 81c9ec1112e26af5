"""The plan of one ship: its reference voyages, and the voyages on which something is hidden."""

from dataclasses import dataclass, replace
from math import exp

import numpy as np

from bench.fleet import fleet_weather, hidden_causes, instrument_recording, sail
from bench.fleet.fleet_legs import PLANS
from bench.fleet.hull_families import FAMILIES
from bench.fleet.random_ship import RandomShip

SHARES = {"nothing": 0.32, "single": 0.38, "pair": 0.11, "triple": 0.05, "outside": 0.14}
VOYAGES = 6  # asked of each ship
REFERENCES = (2, 3, 3, 4, 5, 6)
MINUTES = (6.0, 40.0)
LENGTHS = (25.0, 75.0)  # times of L/U0 that a voyage lasts within these minutes


@dataclass(frozen=True)
class FleetCase:
    """One voyage of a ship and what is hidden in it: name -> strength."""

    family: str
    seed: int
    number: int
    kind: str
    hidden: dict[str, float]

    @property
    def key(self) -> str:
        return f"{self.family}-{self.seed}-{self.number}"


@dataclass(frozen=True)
class SailedCase:
    """A voyage's columns, the weather that it had, what was hidden, in numbers, and how the velocity came, as
    an import says it ("": it does not)."""

    name: str
    time_s: np.ndarray
    columns: dict[str, np.ndarray]
    weather: fleet_weather.FleetWeather
    flaws: dict[str, float]
    velocity_frame: str = ""


def generator(ship: RandomShip, *more: int) -> np.random.Generator:
    return np.random.default_rng([ship.seed, sorted(FAMILIES).index(ship.family), *more])


def practice(family: str, seed: int) -> tuple[int, bool, np.random.Generator]:
    """How many reference voyages there are of a ship, and whether calm days were chosen for them."""
    rng = np.random.default_rng([seed, sorted(FAMILIES).index(family), 1])
    return int(rng.choice(REFERENCES)), bool(rng.random() < 0.6), rng


def references(ship: RandomShip) -> list[SailedCase]:
    """Two to six voyages of a healthy ship, on days that were chosen for it or not; one zigzag at least."""
    count, chosen, rng = practice(ship.family, ship.seed)
    plans = ["zigzag", *rng.choice(list(PLANS), count - 1)]
    out = []
    for i, plan in enumerate(plans):
        day = fleet_weather.draw(ship.p, rng, chosen)
        out.append(_sailed(ship, f"reference_{i + 1}", str(plan), day, hidden_causes.Flaws(), rng))
    return out


def plan(ship: RandomShip, voyages: int = VOYAGES) -> list[FleetCase]:
    """What is hidden on each of its voyages: effects that its instruments could show at all. A rudder that is
    stuck where its angle is recorded hides nothing: such a voyage is one of a healthy ship."""
    rng = generator(ship, 2)
    names = [n for n in hidden_causes.CATALOGUE if can_show(ship, n)]
    out = []
    for i in range(voyages):
        kind = str(rng.choice(list(SHARES), p=list(SHARES.values())))
        count = {"nothing": 0, "single": 1, "pair": 2, "triple": 3, "outside": 1}[kind]
        among = list(hidden_causes.OUTSIDE) if kind == "outside" else names
        picked = sorted(str(n) for n in rng.choice(among, count, replace=False))
        low = -1.8 if kind == "single" else -0.7
        hidden = {n: exp(rng.uniform(low, 0.5)) for n in picked}
        kind = kind if all(can_show(ship, n) for n in picked) else "nothing"
        out.append(FleetCase(ship.family, ship.seed, i, kind, hidden))
    return out


def can_show(ship: RandomShip, name: str) -> bool:
    """Whether a bridge with these instruments could ever name it."""
    kit = ship.kit
    return {
        "Wind": kit.has_wind,
        "WaveDrift": kit.has_sea,
        "ShallowWater": kit.has_depth,
        "Bank": kit.has_bank,
        "RollCoupling": kit.has_roll and ship.family != "heeling",
        "SteeringLag": ship.drive.ordered,
        "StuckRudder": ship.drive.ordered,
    }.get(name, kit.has_log if name.startswith("SpeedLog") else True)


def sailed(ship: RandomShip, case: FleetCase, acting: tuple[float, float] = sail.ALL_VOYAGE) -> SailedCase:
    """The voyage of a case; `acting`: from which to which share of it forces that are hidden act."""
    rng, day, changes = changed(ship, case)
    flaws = hidden_causes.Flaws()
    for change in changes.values():
        flaws, day = replace(flaws, **change.flaws), replace(day, **change.weather)
    return _on_a_plan(ship, case.key, day, flaws, rng, acting)


def changed(
    ship: RandomShip, case: FleetCase
) -> tuple[np.random.Generator, fleet_weather.FleetWeather, dict[str, hidden_causes.HiddenChange]]:
    """The day of a case as it is without what is hidden, what each hidden thing changes, and the generator
    that draws what follows."""
    rng = generator(ship, 3, case.number)
    day = fleet_weather.draw(ship.p, rng, False)
    hidden = case.hidden.items()
    return rng, day, {n: hidden_causes.EVERY[n](ship.p, ship.drive, rng, s) for n, s in hidden}


def sailed_again(ship: RandomShip, case: FleetCase, number: int, healthy: bool) -> SailedCase:
    """One more voyage, on another day and course, with what is wrong with ship and instruments as it is in
    the case; `healthy`: with nothing wrong on the same day and course."""
    flaws = hidden_causes.Flaws()
    for name, change in ({} if healthy else changed(ship, case)[2]).items():
        if name not in hidden_causes.OF_THE_VOYAGE:
            flaws = replace(flaws, **change.flaws)
    rng = generator(ship, 6, case.number, number)
    day = fleet_weather.draw(ship.p, rng, False)
    return _on_a_plan(ship, f"{case.key}_{number + 1}", day, flaws, rng)


def _on_a_plan(
    ship: RandomShip,
    name: str,
    day: fleet_weather.FleetWeather,
    flaws: hidden_causes.Flaws,
    rng: np.random.Generator,
    acting: tuple[float, float] = sail.ALL_VOYAGE,
) -> SailedCase:
    plan_name = str(rng.choice(["mixed", "mixed", "zigzag", "courses", "speeds", "circle"]))
    return _sailed(ship, name, plan_name, day, flaws, rng, acting)


def _sailed(
    ship: RandomShip,
    name: str,
    plan_name: str,
    day: fleet_weather.FleetWeather,
    flaws: hidden_causes.Flaws,
    rng: np.random.Generator,
    acting: tuple[float, float] = sail.ALL_VOYAGE,
) -> SailedCase:
    lasts = np.clip(ship.p.unit_s * rng.uniform(*LENGTHS), 60 * MINUTES[0], 60 * MINUTES[1])
    seed = int(rng.integers(2**31))
    true = sail.sail(ship, PLANS[plan_name](rng), day, float(lasts), seed, flaws, acting=acting)
    good = np.isfinite(true["u"])
    true = {k: v[good] for k, v in true.items()}
    t, columns = instrument_recording.record(ship, true, day, seed, flaws)
    told = {k: v for k, v in vars(flaws).items() if np.any(v)}
    return SailedCase(name, t, columns, day, told, "course" if ship.kit.by_course else "")
