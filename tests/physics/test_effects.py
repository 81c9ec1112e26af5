"""Every effect of the catalogue is asked the same questions."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
import sympy
import torch

from twin.physics.effects import BUILT_IN, UNNAMED
from twin.physics.model import Model
from twin.physics.state import Situation

ISSUE = [
    "Wind",
    "WaveDrift",
    "CrossFlowDrag",
    "HullFouling",
    "PropellerWear",
    "RudderWear",
    "RudderOffset",
    "Loading",
    "Bank",
    "TowForce",
    "ExternalForce",
    "PropellerWalk",
    "RollCoupling",
    "Current",
    "VaryingCurrent",
    "ShallowWater",
    "SteeringLag",
    "HeadingBias",
    "SpeedLogBias",
    "SpeedLogScale",
    "SpeedLogMisalignment",
    "AntennaOffset",
    "SensorDelay",
    "GyroBias",
    "GyroScale",
    "HeadingLag",
    "CompassDeviation",
    "ReceiverSmoothing",
]
READ = ("x", "y", "psi", "u", "v", "r", "u_r", "v_r", "wind_to")
# change sign in a mirror
ATHWART = {"y", "psi", "v", "r", "v_r", "delta", "wind_to", "wave_to", "phi", "v_dot", "r_dot"}
MIRRORED = {  # parameters that do so too
    "RudderOffset": {"offset"},
    "TowForce": {"starboard", "turning"},
    "ExternalForce": {"east", "turn_east"},
    "PropellerWalk": {"c_y", "c_n"},
    "Current": {"east"},
    "HeadingBias": {"bias", "turned"},
    "SpeedLogMisalignment": {"angle"},
    "AntennaOffset": {"starboard"},
    "GyroBias": {"bias"},
    "HullAsymmetry": {"Y_0", "N_0"},
    "CompassDeviation": {"A", "C", "E"},
    "VaryingCurrent": {"east"} | {f"east_{wave}{k}" for wave in "cs" for k in "123"},
}
each = pytest.mark.parametrize("Kind", (*BUILT_IN, *UNNAMED), ids=lambda kind: kind.__name__)


def busy(Kind, ship):
    """The effect with every parameter away from null."""
    return Kind(
        **{
            p.name: (p.default if p.default != p.null else p.null + 0.7 * p.sd) * p.scale(ship)
            for p in Kind.params()
        }
    )


def respond(effect, s, ship):
    """What the effect makes of this moment: accelerations, an actuator's next angle, or what the instruments
    say."""
    if effect.kind == "Lag":
        return (
            effect.step(s.delta, 2.0 * s.delta, 0.1),
            effect.step(s.delta, 1.001 * s.delta, 0.1),
            effect.dead_time(),
        )
    if effect.kind == "SensorFault":
        read = effect.read(s, ship)
        return tuple(getattr(read, name) for name in READ)
    return tuple(Model(ship, (effect,)).nu_dot(s))


def at(moment, wrap=lambda x: x, **changes):
    return Situation(**{k: wrap(v) for k, v in (moment | changes).items()})


def test_the_catalogue_holds_what_was_promised_in_four_kinds():
    assert [kind.__name__ for kind in BUILT_IN][: len(ISSUE)] == ISSUE
    assert {kind.kind for kind in BUILT_IN} == {"Force", "Flow", "Lag", "SensorFault"}


@each
def test_it_says_what_it_is_where_it_may_lie_and_who_says_so(Kind, ship):
    assert Kind.__doc__ and Kind.__doc__.strip().endswith(".") and len(Kind.__doc__) > 40
    assert Kind.source and Kind.kind in ("Force", "Flow", "Lag", "SensorFault")
    assert set(Kind.needs) <= {f.name for f in fields(Situation)}
    assert Kind.params()
    for p in Kind.params():
        assert p.unit and p.doc, p.name
        assert p.lo <= p.null <= p.hi and p.lo <= p.default <= p.hi and p.lo < p.hi, p.name
        assert 0.0 < p.sd <= p.hi - p.lo, p.name
    busy(Kind, ship).check(ship)


@each
def test_at_null_it_does_exactly_nothing(Kind, ship, moment):
    absent = Kind.absent(ship)
    if absent.kind == "Lag":
        assert absent.dead_time() == 0.0
        assert absent.step(0.1, 0.3, 0.1) == pytest.approx(0.3, abs=1e-15)
    elif absent.kind == "SensorFault":
        assert absent.read(at(moment), ship) == at(moment)
    else:
        assert Model(ship, (absent,)).nu_dot(at(moment)) == Model(ship).nu_dot(at(moment))


@each
def test_each_of_its_parameters_does_something(Kind, ship, moment):
    base = Kind.plausible(ship)
    usual = respond(base, at(moment, delta=0.5), ship)
    for p in Kind.params():
        changed = base.but(**{p.name: getattr(base, p.name) + 0.9 * p.sd * p.scale(ship)})
        assert respond(changed, at(moment, delta=0.5), ship) != usual, p.name


@each
def test_floats_arrays_tensors_and_symbols_agree(Kind, ship, moment):
    effect, shifts = busy(Kind, ship), (0.0, 0.1, -0.7)
    states = [
        moment | {"u": moment["u"] + d, "r": moment["r"] * (1.0 + d), "delta": d, "psi": moment["psi"] + d}
        for d in shifts
    ]
    floats = np.array([respond(effect, at(m), ship) for m in states])
    stacked = {k: np.array([m[k] for m in states]) for k in moment}
    arrays = respond(effect, Situation(**stacked), ship)
    tensors = respond(effect, Situation(**{k: torch.tensor(v) for k, v in stacked.items()}), ship)
    wide = lambda x: np.broadcast_to(np.asarray(x, float), len(shifts))
    np.testing.assert_allclose(np.stack([wide(a) for a in arrays], 1), floats, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(np.stack([wide(a) for a in tensors], 1), floats, rtol=1e-12, atol=1e-15)
    symbols = {k: sympy.Symbol(k, real=True) for k in ("u", "v", "r", "psi", "delta")}
    said = respond(effect, Situation(**(moment | symbols)), ship)
    numbers = [float(sympy.sympify(e).subs({symbols[k]: moment[k] for k in symbols})) for e in said]
    np.testing.assert_allclose(numbers, respond(effect, at(moment), ship), rtol=1e-9, atol=1e-12)


@each
def test_its_gradient_is_finite_for_a_ship_at_rest_in_still_weather(Kind, ship, moment):
    still = dict.fromkeys(moment, 0.0) | {"depth": 9.0, "T_p": 8.0, "bank_port": 60.0, "bank_starboard": 25.0}
    s = Situation(**{k: torch.tensor(v, dtype=torch.float64, requires_grad=True) for k, v in still.items()})
    inputs = [getattr(s, name) for name in still]
    values = {
        p.name: torch.tensor(p.null * p.scale(ship), dtype=torch.float64, requires_grad=True)
        for p in Kind.params()
    }
    said = [x for x in respond(Kind(**values), s, ship) if torch.is_tensor(x) and x.requires_grad]
    gradients = torch.autograd.grad(sum(said), [*inputs, *values.values()], allow_unused=True)
    assert all(g is None or torch.isfinite(g) for g in gradients)


@each
def test_a_mirrored_ship_does_the_mirrored_thing(Kind, ship, moment):
    effect = busy(Kind, ship)
    flipped = effect.but(**{name: -getattr(effect, name) for name in MIRRORED.get(Kind.__name__, ())})
    mirror = {k: -v if k in ATHWART else v for k, v in moment.items()}
    mirror |= {"bank_port": moment["bank_starboard"], "bank_starboard": moment["bank_port"]}
    true, seen = respond(effect, at(moment), ship), respond(flipped, at(mirror), ship)
    signs = {"Lag": (-1, -1, 1), "SensorFault": [-1 if name in ATHWART else 1 for name in READ]}.get(
        Kind.kind, (1, -1, -1)
    )
    np.testing.assert_allclose(np.array(signs) * seen, true, rtol=1e-12, atol=1e-15)


@each
def test_it_is_linear_in_its_parameters_or_nearly_so(Kind, ship, moment):
    """Half the prior's width does half of what the whole does, within 15 %: the diagnosis counts on it."""
    if Kind.kind == "Lag":
        pytest.skip("a rate limit is not linear; the diagnosis simulates it")
    null = np.array(respond(Kind.absent(ship), at(moment), ship), float)
    for p in Kind.params():
        size = p.sd * p.scale(ship)
        whole, half = (
            np.array(respond(Kind.absent(ship).but(**{p.name: k * size}), at(moment), ship), float) - null
            for k in (1.0, 0.5)
        )
        scale = np.max(np.abs(whole))
        assert np.max(np.abs(2.0 * half - whole)) <= 0.15 * scale, p.name


@each
def test_it_scales_with_the_ship(Kind, ship, moment):
    """By Froude's law the same effect at its plausible size gives the same accelerations on a model 1:25,
    where it has no size of its own."""
    # instruments and tides do not shrink with the ship
    own_size = {"GyroBias", "SensorDelay", "VaryingCurrent"}
    if Kind.kind in ("Lag", "SensorFault") or Kind.__name__ in own_size:
        pytest.skip("not a force of the ship's own size")
    k = 25.0
    small = replace(
        ship,
        L_pp=ship.L_pp / k,
        B=ship.B / k,
        T=ship.T / k,
        m=ship.m / k**3,
        x_G=ship.x_G / k,
        I_z=ship.I_z / k**5,
        U_0=ship.U_0 / k**0.5,
        D_P=ship.D_P / k,
        A_R=ship.A_R / k**2,
        A_F=ship.A_F / k**2,
        A_L=ship.A_L / k**2,
    )
    power = {
        "u": 0.5,
        "v": 0.5,
        "u_r": 0.5,
        "v_r": 0.5,
        "wind_speed": 0.5,
        "r": -0.5,
        "n": -0.5,
        "t": 0.5,
        "T_p": 0.5,
    }
    power |= dict.fromkeys(("x", "y", "depth", "H_s", "draught", "bank_port", "bank_starboard"), 1.0)
    scaled = {name: value / k ** power.get(name, 0.0) for name, value in moment.items()}
    big, little = (
        respond(Kind.plausible(ship), at(moment), ship),
        respond(Kind.plausible(small), at(scaled), small),
    )
    np.testing.assert_allclose([little[0], little[1], little[2] / k], big, rtol=1e-6)


@each
def test_its_plausible_size_is_bearable(Kind, ship, moment):
    """A plausible effect bends the motion; it does not throw the ship about."""
    if Kind.kind in ("Lag", "SensorFault"):
        pytest.skip("no force")
    with_it, without = respond(Kind.plausible(ship), at(moment), ship), Model(ship).nu_dot(at(moment))
    size = ship.U_0**2 / ship.L_pp  # the ship's own acceleration
    assert math.hypot(with_it[0] - without[0], with_it[1] - without[1]) < 0.3 * size
