"""The model: what it adds up, what it leaves out, and what it names."""

import subprocess
import sys

import pytest

from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.state import WEATHER, Force, Situation


def test_known_forces_are_named_and_add_up_to_the_acceleration(ship, situation):
    model = Model(ship, (find("Wind").plausible(ship), find("HullFouling").plausible(ship)))
    known = model.known(situation)
    assert list(known) == ["hull", "coriolis", "propeller", "rudder", "Wind", "HullFouling"]
    X = sum(f.X for f in known.values())
    assert model.nu_dot(situation).u == pytest.approx(X / model.c.m_u)


def test_the_learned_force_is_added_and_kept_apart(ship, situation):
    learned = Model(ship, residual=lambda s: Force(1e4, 2e4, 3e5))
    assert "residual" not in learned.known(situation)
    extra = learned.nu_dot(situation).u - Model(ship).nu_dot(situation).u
    assert extra == pytest.approx(1e4 / learned.c.m_u)


def test_an_effect_whose_input_is_missing_is_switched_off_and_said(ship):
    model = Model(ship, (find("Wind").plausible(ship), find("Current").plausible(ship)))
    left, off = model.without_inputs({"wind_speed"})
    assert [type(e).__name__ for e in left.effects] == ["Current"]
    assert [type(e).__name__ for e in off] == ["Wind"]
    assert model.without_inputs(set()) == (model, ())


def test_adding_an_effect_again_replaces_it(ship):
    Wind = find("Wind")
    model = Model(ship).but(Wind.plausible(ship)).but(Wind.absent(ship))
    assert model.effects == (Wind.absent(ship),)


def test_currents_add_up(ship, situation):
    Current, Varying = find("Current"), find("VaryingCurrent")
    both = Model(ship, (Current(north=0.3, east=0.1), Varying.absent(ship).but(north=0.2)))
    one = Model(ship, (Current(north=0.5, east=0.1),))
    assert both.nu_dot(situation) == pytest.approx(one.nu_dot(situation))


def test_every_weather_field_is_optional():
    bare = Situation()
    assert all(getattr(bare, name) is None for name in WEATHER)


def test_physics_imports_nothing_beyond_the_standard_library():
    code = (
        "import sys, pkgutil, importlib, twin.physics.effects as e\n"
        "import twin.physics.model, twin.physics.ship\n"
        "[importlib.import_module(m.name) for m in pkgutil.walk_packages(twin.physics.__path__, "
        "'twin.physics.')]\n"
        "from twin.physics.ship import load\n"
        "load('kvlcc2')\n"
        "tops = {m.partition('.')[0] for m in sys.modules}\n"
        "print(sorted(tops - set(sys.stdlib_module_names) - {'twin', '__main__', '__mp_main__'} - "
        "set(sys.argv[1:])))\n"
    )
    bare = subprocess.run(
        [sys.executable, "-c", "import sys; print(*{m.partition('.')[0] for m in sys.modules})"],
        capture_output=True,
        text=True,
    )
    out = subprocess.run([sys.executable, "-c", code, *bare.stdout.split()], capture_output=True, text=True)
    assert out.stdout.strip() == "[]", out.stdout + out.stderr


def test_an_antenna_stands_where_the_true_heading_puts_it_whatever_the_compass_shows(ship, situation):
    """In whichever order the faults were named: a late receiver shows the antenna's place, the compass turns
    what it shows, and moves nothing."""
    compass, gyro = find("HeadingBias").plausible(ship), find("GyroBias").plausible(ship)
    antenna, late = find("AntennaOffset").plausible(ship), find("SensorDelay").plausible(ship)
    said = []
    for order in ((compass, gyro, antenna, late), (late, antenna, gyro, compass)):
        shown = situation
        for fault in Model(ship, order).faults:
            shown = fault.read(shown, ship)
        said.append(shown)
    placed = late.read(antenna.read(situation, ship), ship)
    for shown in said:
        assert (shown.x, shown.y) == pytest.approx((placed.x, placed.y), abs=1e-9)
        assert shown.psi == pytest.approx(situation.psi + compass.bias)
    assert (said[0].u, said[0].v) == pytest.approx((said[1].u, said[1].v), abs=1e-12)
