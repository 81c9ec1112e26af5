"""A number that carries its unit goes through the same code, which must give N, N, N m, and add no apples to
pears."""

import sys
from fractions import Fraction
from types import SimpleNamespace

import pytest

from twin.physics import core
from twin.physics.effects import BUILT_IN, varying_current, wave_drift, wind
from twin.physics.model import Model
from twin.physics.ship import PARTICULARS
from twin.physics.state import Situation

FLOOR = 1e-5  # a bare number this small is a floor under a square root, in whatever unit


class Quantity:
    """A float with powers of kg, m and s; radians are none."""

    _maths = "quantity_maths"

    def __init__(self, value, unit=(0, 0, 0)):
        self.value, self.unit = float(value), tuple(Fraction(p).limit_denominator(12) for p in unit)

    def _like(self, other):
        if isinstance(other, Quantity):
            assert other.unit == self.unit or other.value == 0.0 or self.value == 0.0, (
                f"{self.unit} with {other.unit}"
            )
            return other
        assert abs(other) <= FLOOR or not any(self.unit), f"{self.unit} with the bare number {other}"
        return Quantity(other, self.unit)

    def __add__(self, other):
        other = self._like(other)
        return Quantity(self.value + other.value, other.unit if self.value == 0.0 else self.unit)

    def __mul__(self, other):
        other = other if isinstance(other, Quantity) else Quantity(other)
        return Quantity(self.value * other.value, [a + b for a, b in zip(self.unit, other.unit, strict=True)])

    def __pow__(self, power):
        return Quantity(self.value**power, [p * Fraction(power).limit_denominator(12) for p in self.unit])

    def __abs__(self):
        return Quantity(abs(self.value), self.unit)

    def __neg__(self):
        return Quantity(-self.value, self.unit)

    def __sub__(self, other):
        return self + (-other)

    def __rsub__(self, other):
        return -self + other

    def __truediv__(self, other):
        return self * (other**-1 if isinstance(other, Quantity) else 1.0 / other)

    def __rtruediv__(self, other):
        return self**-1 * other

    def __lt__(self, other):
        return self.value < self._like(other).value

    def __gt__(self, other):
        return self.value > self._like(other).value

    __radd__, __rmul__ = __add__, __mul__


def _pure(name):
    import math

    def function(x):
        assert not any(x.unit), f"{name} of {x.unit}"
        return Quantity(getattr(math, name)(x.value))

    return function


sys.modules["quantity_maths"] = SimpleNamespace(
    sqrt=lambda x: x**0.5, **{n: _pure(n) for n in ("sin", "cos", "tanh", "exp")}
)

KG, M, S = (1, 0, 0), (0, 1, 0), (0, 0, 1)
UNITS = {
    "-": (0, 0, 0),
    "rad": (0, 0, 0),
    "1/rad": (0, 0, 0),
    "L": (0, 0, 0),
    "m": M,
    "m2": (0, 2, 0),
    "s": S,
    "kg": KG,
    "kg m2": (1, 2, 0),
    "kg/m3": (1, -3, 0),
    "m/s": (0, 1, -1),
    "m/s2": (0, 1, -2),
    "rad/s": (0, 0, -1),
    "rad/s2": (0, 0, -2),
    "1/s": (0, 0, -1),
    "N": (1, 1, -2),
    "N m": (1, 2, -2),
}
FIELDS = dict.fromkeys(("x", "y", "depth", "H_s", "draught", "bank_port", "bank_starboard"), "m")
FIELDS |= dict.fromkeys(("u", "v", "u_r", "v_r", "wind_speed"), "m/s") | dict.fromkeys(("r", "n"), "1/s")
FIELDS |= dict.fromkeys(("psi", "delta", "wind_to", "wave_to", "phi"), "rad") | dict.fromkeys(
    ("t", "T_p"), "s"
)
FIELDS |= dict.fromkeys(("u_dot", "v_dot"), "m/s2") | {"r_dot": "rad/s2"}


@pytest.fixture
def scenario(ship, moment, monkeypatch):
    """The ship and the moment with their units, and the constants of physics with theirs."""
    from dataclasses import replace

    for module in (core, wave_drift):
        monkeypatch.setattr(module, "GRAVITY", Quantity(9.80665, UNITS["m/s2"]))
    monkeypatch.setattr(wind, "RHO_AIR", Quantity(1.225, UNITS["kg/m3"]))
    monkeypatch.setattr(varying_current, "HOUR", Quantity(3600.0, S))
    united = {f.name: Quantity(getattr(ship, f.name), UNITS[f.metadata["unit"]]) for f in PARTICULARS}
    return replace(ship, **united), lambda: Situation(
        **{k: Quantity(v, UNITS[FIELDS[k]]) for k, v in moment.items()}
    )


def test_the_core_gives_newtons_and_newton_metres(scenario):
    ship, moment = scenario
    for name, force in Model(ship).known(moment()).items():
        for component, unit in zip(force, ("N", "N", "N m"), strict=True):
            assert not isinstance(component, Quantity) or component.unit == UNITS[unit], name
    rates = Model(ship).nu_dot(moment())
    assert [rate.unit for rate in rates] == [UNITS["m/s2"], UNITS["m/s2"], UNITS["rad/s2"]]


@pytest.mark.parametrize("Kind", BUILT_IN, ids=lambda kind: kind.__name__)
def test_an_effect_gives_the_unit_it_should(Kind, scenario):
    ship, moment = scenario
    sized = {p.name: (p.default or p.sd) * p.scale(ship) for p in Kind.params()}
    for p in Kind.params():
        if p.of:
            assert sized[p.name].unit == UNITS[p.unit], (
                f"{p.name}: of={p.of!r} has another unit than {p.unit}"
            )
    effect = Kind(
        **{
            p.name: Quantity(getattr(sized[p.name], "value", sized[p.name]), UNITS[p.unit])
            for p in Kind.params()
        }
    )
    s = moment()
    if Kind.kind == "Force":
        for component, unit in zip(effect.force(s, ship), ("N", "N", "N m"), strict=True):
            assert not isinstance(component, Quantity) or component.unit == UNITS[unit]
        altered = effect.alter(ship)
        assert all(getattr(altered, f.name).unit == UNITS[f.metadata["unit"]] for f in PARTICULARS)
    elif Kind.kind == "Flow":
        for component, unit in zip(effect.water(s, ship), ("m/s", "m/s", *"------"), strict=True):
            assert not isinstance(component, Quantity) or component.unit == UNITS[unit]
    elif Kind.kind == "SensorFault":
        read = effect.read(s, ship)
        assert all(getattr(read, name).unit == UNITS[unit] for name, unit in FIELDS.items())
    else:
        assert effect.dead_time().unit == S
