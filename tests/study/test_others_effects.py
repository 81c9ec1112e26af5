"""Effects of somebody else's package, installed from a wheel: one of the ship, one of an instrument, one of the
weather. All are candidates; the one of the ship is diagnosed and added like ours."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = """[build-system]
requires = ["setuptools>=61"]
build-backend = "setuptools.build_meta"
[project]
name = "harbour-effects"
version = "1.0"
[project.entry-points."twin.effects"]
Derrick = "harbour_effects.derrick:Derrick"
GyroScale = "harbour_effects.gyro_scale:GyroScale"
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
GYRO_SCALE = '''"""A rate gyro whose scale is off.

r_m = (1 + scale) r
"""
from dataclasses import replace

from twin.physics.effect import SensorFault, param


class GyroScale(SensorFault):
    """The rate gyro shows a fixed percentage too much or too little."""

    needs = ("r",)
    attitude = True
    source = "a test"
    scale: float = param(0.05, unit="-", lo=-0.5, hi=0.5, sd=0.05, doc="shown rate of turn over the true one, less 1")

    def read(self, s, ship):
        return replace(s, r=s.r * (1.0 + self.scale))
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
FILES = {"__init__": "", "derrick": DERRICK, "gyro_scale": GYRO_SCALE, "rotor_sail": ROTOR_SAIL}
# how many prior widths of it are hidden, and the wind that is recorded [m/s]
HIDDEN = {"Derrick": (3.0, None)}
SAIL = """
import json, sys
import twin
from tests.study.conftest import ship, voyage
from twin.physics.effects import find

def sick(name, widths, wind, seed):
    effect = find(name)
    number = effect.params()[0]
    there = effect(**{number.name: widths * number.sd * number.scale(ship())})
    return voyage(there, seed=seed, wind=wind, seconds=500.0, name=f"{name}{seed}")
"""
JUDGE = (
    SAIL
    + """
name, widths, wind = json.loads(sys.argv[1])
voyage, other = (sick(name, widths, wind, seed) for seed in (3, 4))
found = twin.diagnose(ship(), voyage)
better = twin.add(ship(), name, voyage, held_out=other)
(number,) = better.data["parameters"][name].values()
size = find(name).params()[0]
hidden = widths * size.sd * size.scale(ship())
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


@pytest.mark.parametrize("name", HIDDEN)
def test_an_effect_of_others_is_named_and_added_like_ours(installed, name):
    """Test: hidden in two voyages, the catalogue otherwise ours. Expected: it alone is named; added, what was
    held out is likelier, and its interval holds the size that was hidden."""
    widths, wind = HIDDEN[name]
    found = told(installed, JUDGE, json.dumps([name, widths, wind]))
    assert found["named"] == [name] and found["accepted"]
    assert found["number"]["low95"] <= found["hidden"] <= found["number"]["high95"]
