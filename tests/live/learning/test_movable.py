"""Which numbers of the named effects may move, how far, and what each does to the ship."""

from dataclasses import replace

import pytest

from twin.live.learning.learned_force import scale_of
from twin.live.learning.movable import Columns, movable, moved
from twin.live.learning.ridge import LARGEST
from twin.live.observer.dynamics import KnownDynamics
from twin.physics import core
from twin.physics.effects import BUILT_IN, find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Force, Situation

STILL = ("Current", "VaryingCurrent", "SteeringLag")  # and every SensorFault


def turning(**more):
    """Every component of the motion away from zero, every input measured."""
    return Situation(
        0.0,
        0.0,
        0.6,
        6.5,
        -0.7,
        -0.006,
        delta=0.3,
        n=1.3,
        wind_speed=12.0,
        wind_to=2.0,
        H_s=2.0,
        T_p=8.0,
        wave_to=1.5,
        depth=35.0,
        bank_port=150.0,
        bank_starboard=400.0,
        phi=0.04,
        t=100.0,
        **more,
    )


def columns(ship, *effects, without=()):
    ship = ship.with_effects(*effects)
    model, _ = Model.of(ship).without_inputs(set(without))
    s, known = turning(), KnownDynamics(model)
    numbers = movable(ship.effects, ship)
    return numbers, Columns(numbers, scale_of(ship)).at(s, known.forces(s), known, Force()), s


def test_a_worn_rudders_column_is_the_rudder_force_taken_away(kvlcc2):
    (number,), found, s = columns(kvlcc2, find("RudderWear")(loss=0.2))
    c, S = kvlcc2.c, scale_of(kvlcc2)
    force = core.rudder(s.u_r, s.v_r, s.r, s.delta, core.thrust(s.u_r, s.n, c), c)
    assert (number.label, number.unit, number.start) == ("RudderWear.loss", "-", 0.2)
    assert found == pytest.approx([-number.sd * f / size for f, size in zip(force, S, strict=True)], rel=1e-9)


def test_foulings_column_is_the_calm_water_resistance(kvlcc2):
    (number,), found, s = columns(kvlcc2, find("HullFouling")(extra=0.2))
    resistance = (kvlcc2.c.X_u + kvlcc2.c.X_uu * s.u_r) * s.u_r
    assert found == pytest.approx([number.sd * resistance / scale_of(kvlcc2).X, 0.0, 0.0], rel=1e-9)


def test_a_heavier_ships_column_holds_her_inertia(kvlcc2):
    """Expected: M times what its accelerations change by, by a model loaded so; it has no force of that
    name."""
    loaded = find("Loading")(mass=0.02, draught=0.0, x_G=0.0)
    numbers, found, s = columns(kvlcc2, loaded)
    j = [n.label for n in numbers].index("Loading.mass")
    before, after = (
        KnownDynamics(Model.of(kvlcc2.with_effects(e))) for e in (loaded, loaded.but(mass=0.021))
    )
    change = [b - a for a, b in zip(before.rates(s, Force()), after.rates(s, Force()), strict=True)]
    push = [
        x * numbers[j].sd / 0.001 / size
        for x, size in zip(before.force_for(*change), scale_of(kvlcc2), strict=True)
    ]
    assert found[3 * j : 3 * j + 3] == pytest.approx(push, rel=0.02) and abs(push[2]) > 0.1


def test_what_is_switched_off_for_want_of_its_input_has_no_column(kvlcc2):
    both = (find("Wind").plausible(kvlcc2), find("RudderWear").plausible(kvlcc2))
    numbers, found, _ = columns(kvlcc2, *both, without=("wind_speed",))
    assert found[:12] == [0.0] * 12 and all(found[12:]) and numbers[-1].label == "RudderWear.loss"


def test_asking_leaves_the_situation_as_it_was(kvlcc2):
    ship = kvlcc2.with_effects(find("ShallowWater").plausible(kvlcc2))
    s, known, numbers = turning(), KnownDynamics(Model.of(ship)), movable(ship.effects, ship)
    forces = known.forces(s)
    before = replace(s)
    Columns(numbers, scale_of(ship)).at(s, forces, known, Force())
    assert s == before


@pytest.mark.parametrize("speed", (1e30, 1e200, float("nan")))
def test_a_situation_that_cannot_be_has_columns_of_a_usual_size(kvlcc2, speed):
    ship = kvlcc2.with_effects(find("RudderWear")(loss=0.2), find("HullFouling")(extra=0.2))
    s, known = replace(turning(), u=speed), KnownDynamics(Model.of(ship))
    found = Columns(movable(ship.effects, ship), scale_of(ship)).at(s, known.forces(s), known, Force())
    assert len(found) == 6 and all(abs(x) <= LARGEST for x in found)


@pytest.mark.parametrize("Kind", BUILT_IN, ids=lambda k: k.__name__)
@pytest.mark.parametrize("name", ("kvlcc2", "usv"))
def test_every_number_that_moves_stays_in_the_catalogues_box(Kind, name):
    """Expected: start inside, every corner accepted by the catalogue; currents, late gears and instruments do
    not move at all."""
    ship = load(name)
    effect = Kind.plausible(ship)
    numbers = movable((effect,), ship)
    assert bool(numbers) == (Kind.kind != "SensorFault" and Kind.__name__ not in STILL)
    for end in ("low", "start", "high"):
        for e in moved((effect,), numbers, [getattr(n, end) for n in numbers]):
            e.check(ship)
    assert all(n.low < n.high and n.low <= n.start <= n.high and n.sd > 0.0 for n in numbers)


@pytest.mark.parametrize("Kind", BUILT_IN, ids=lambda k: k.__name__)
def test_every_number_that_moves_does_something(Kind, kvlcc2):
    numbers, found, _ = columns(kvlcc2, Kind.plausible(kvlcc2))
    for j, number in enumerate(numbers):
        assert any(abs(x) > 1e-6 for x in found[3 * j : 3 * j + 3]), number.label
