"""Effects of somebody else's package, installed from a wheel: one of the ship, one of an instrument, one of the
weather. A calibration keeps what is usual of them, and each is diagnosed and added like ours."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.thorough import thorough

ROOT = Path(__file__).parents[2]
PROJECT = """[build-system]
requires = ["setuptools>=61"]
build-backend = "setuptools.build_meta"
[project]
name = "harbour-effects"
version = "1.0"
[project.entry-points."twin.effects"]
Derrick = "harbour_effects.derrick:Derrick"
GroundSpeedScale = "harbour_effects.ground_speed_scale:GroundSpeedScale"
RotorSail = "harbour_effects.rotor_sail:RotorSail"
"""
DERRICK = '''"""A derrick that slews to and fro with a load over the side.

N = moment sin(2 pi t / 300 s)
"""
from math import pi

from twin.physics.effect import Force, param
from twin.physics.maths import sin
from twin.physics.state import Force as ForceVector


class Derrick(Force):
    """A derrick slews with its load over the side, and the ship turns with it, to and fro."""

    needs = ("t",)
    source = "a test"
    moment: float = param(1.0, unit="N m", lo=-20.0, hi=20.0, sd=1.5, of="moment", doc="greatest moment")

    def force(self, s, ship):
        return ForceVector(N=self.moment * sin(2.0 * pi / 300.0 * s.t))
'''
GROUND_SPEED_SCALE = '''"""A speed over ground whose scale is off.

(u, v)_m = (1 + scale) (u, v)
"""
from dataclasses import replace

from twin.physics.effect import SensorFault, param


class GroundSpeedScale(SensorFault):
    """The receiver shows a fixed percentage too much or too little speed over ground; its positions are right."""

    source = "a test"
    scale: float = param(0.02, unit="-", lo=-0.2, hi=0.2, sd=0.02, doc="shown speed over the true one, less 1")

    def read(self, s, ship):
        return replace(s, u=s.u * (1.0 + self.scale), v=s.v * (1.0 + self.scale))
'''
ROTOR_SAIL = '''"""A rotor sail: a lift across the air past the ship (Magnus).

X = 1/2 rho_a area lift V_rw v_rw,  Y = -1/2 rho_a area lift V_rw u_rw
"""
from twin.physics.effect import Force, param
from twin.physics.maths import cos, hypot, sin
from twin.physics.state import Force as ForceVector


class RotorSail(Force):
    """A rotor sail pushes the ship across the wind past it."""

    belongs_to = "voyage"
    needs = ("wind_speed", "wind_to")
    needs_ship = ("A_L",)
    source = "a test"
    lift: float = param(1.0, unit="-", lo=-10.0, hi=10.0, sd=1.0, doc="lift coefficient on the lateral area")

    def force(self, s, ship):
        u = s.u - s.wind_speed * cos(s.wind_to - s.psi)
        v = s.v - s.wind_speed * sin(s.wind_to - s.psi)
        q = 0.5 * 1.225 * ship.A_L * self.lift * hypot(u, v)
        return ForceVector(X=q * v, Y=-q * u)
'''
FILES = {
    "__init__": "",
    "derrick": DERRICK,
    "ground_speed_scale": GROUND_SPEED_SCALE,
    "rotor_sail": ROTOR_SAIL,
}
# prior widths of it that are hidden, and the wind that is recorded [m/s], which turns by half a circle: across a
# steady one a rotor sail is a pull from a fixed bearing
HIDDEN = {"Derrick": (3.0, None), "GroundSpeedScale": (3.0, None), "RotorSail": (3.0, 16.0)}
SAIL = """
import json, sys
from math import pi
import twin
from tests.study.conftest import ship, voyage
from twin.physics.effects import find

TRUE = ship().with_derivatives(X_uu=1.3 * ship().derivatives.X_uu)

def sailed(*effects, seed, wind, seconds=600.0):
    return voyage(*effects, of=TRUE, seed=seed, wind=wind, veer=pi, seconds=seconds, name=f"voyage{seed}")
"""
CALIBRATE = (
    SAIL
    + """
fit = twin.calibrate(ship(), sailed(seed=1, wind=9.0), held_out=sailed(seed=2, wind=9.0))
fit.ship.save(sys.argv[1])
usual = fit.ship.notes["structural"]
print(json.dumps({"labels": usual["labels"], "weather": usual["weather"]}))
"""
)
JUDGE = (
    SAIL
    + """
name, widths, wind = json.loads(sys.argv[1])
ours, size = twin.Ship.load(sys.argv[2]), find(name).params()[0]
hidden = widths * size.sd * size.scale(ours)
short, other = (
    sailed(find(name)(**{size.name: hidden}), seed=seed, wind=wind, seconds=seconds)
    for seed, seconds in ((3, 450.0), (4, 700.0))
)
found = twin.diagnose(ours, short)
better = twin.add(ours, name, short, held_out=other)
(number,) = better.data["parameters"][name].values()
print(json.dumps({"named": found.effects, "accepted": better.accepted, "number": number, "hidden": hidden}))
"""
)


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The environment of a Python that has the package, from its wheel and without a network."""
    folder = tmp_path_factory.mktemp("harbour")
    package = folder / "source" / "harbour_effects"
    package.mkdir(parents=True)
    (package.parent / "pyproject.toml").write_text(PROJECT)
    for name, text in FILES.items():
        (package / f"{name}.py").write_text(text)
    pip = [sys.executable, "-m", "pip"]
    build = [*pip, "wheel", "-q", "--no-index", "--no-deps", "--no-build-isolation", "-w", folder]
    done = subprocess.run([*build, package.parent], capture_output=True, text=True, timeout=120)
    if done.returncode:
        pytest.skip(f"no wheel can be built here: {done.stderr.strip().splitlines()[-1:]}")
    (wheel,) = folder.glob("*.whl")
    put = [*pip, "install", "-q", "--no-index", "--no-deps", "--target", folder / "site", wheel]
    subprocess.run(put, check=True, capture_output=True, timeout=120)
    return os.environ | {"PYTHONPATH": os.pathsep.join((str(folder / "site"), str(ROOT)))}


def told(env, script, *words):
    done = subprocess.run(
        [sys.executable, "-c", script, *words], capture_output=True, text=True, env=env, cwd=ROOT, timeout=600
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def calibrated(installed, tmp_path_factory):
    """(ship file, what is usual of it) of a calibration on two voyages on which nothing is hidden; the ship has
    more resistance than its file had."""
    file = str(tmp_path_factory.mktemp("calibrated") / "ship.toml")
    return file, told(installed, CALIBRATE, file)


@thorough
def test_a_calibration_keeps_what_is_usual_of_the_effects_of_others(calibrated):
    """Expected: how much of an effect of the ship or of an instrument a healthy ship shows is in its file, by its
    numbers; of the weather how strong it was, without a number, for tomorrow's is another one."""
    usual = calibrated[1]
    owners = {label.partition(".")[0] for label in usual["labels"]}
    assert {"Derrick", "GroundSpeedScale"} <= owners and "RotorSail" not in owners
    assert usual["weather"]["RotorSail"] > 0.0


@thorough
@pytest.mark.parametrize("name", HIDDEN)
def test_an_effect_of_others_is_named_and_added_like_ours(installed, calibrated, name):
    """Test: hidden in two voyages, the catalogue otherwise ours. Expected: it alone is named; added, what was
    held out is likelier, and its interval holds the size that was hidden."""
    found = told(installed, JUDGE, json.dumps([name, *HIDDEN[name]]), calibrated[0])
    assert found["named"] == [name] and found["accepted"]
    assert found["number"]["low95"] <= found["hidden"] <= found["number"]["high95"]
