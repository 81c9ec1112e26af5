"""Slopes of what a model gives and of what faulty instruments show, against differences one at a time."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effect import SensorFault, param
from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.estimation.respond import accelerations, by_stream, faulty, jacobian, moving, readings
from twin.study.track.track import READINGS, STATE, Track

SHIP = load("usv")
FAULTS = [name for name, e in catalogue().items() if e.kind == "SensorFault"]
SIZE = (SHIP.L_pp, SHIP.L_pp, 1.0, SHIP.U_0, SHIP.U_0, SHIP.U_0 / SHIP.L_pp, SHIP.U_0, SHIP.U_0)


class SquaredGyro(SensorFault):
    """A gyro of others, written with a library of its own."""

    needs = ("r",)
    attitude = True
    share: float = param(0.1, unit="s", lo=-1.0, hi=1.0, sd=0.1, doc="how much of the square it shows")

    def read(self, s, ship):
        return replace(s, r=s.r + self.share * np.sin(s.r) ** 2, psi=np.add(s.psi, 0.2 * s.r))


def drawn(n=60):
    """A track that no ship sails: every number drawn, with heel."""
    draw = np.random.default_rng(3)
    state = draw.standard_normal((n, 6)) * [50.0, 50.0, 1.0, 0.5, 0.2, 0.3] + [0, 0, 0, SHIP.U_0, 0, 0]
    weather = {"phi": 0.1 * draw.standard_normal(n), "p": 0.1 * draw.standard_normal(n)}
    delta, n_prop = 0.3 * draw.standard_normal(n), 10.0 + draw.standard_normal(n)
    return Track(
        "t", 0.1 * np.arange(n), 0.1, state, delta, n_prop, weather,
        np.zeros((n, len(READINGS))), np.ones(8), np.ones(n, bool),
    )  # fmt: skip


def at_fault(effect):
    """Every number of it a prior width from none, and no two alike."""
    k = {p.name: p.scale(SHIP) for p in effect.params()}
    sizes = {p.name: (p.null + (0.7 + 0.1 * i) * p.sd) * k[p.name] for i, p in enumerate(effect.params())}
    return Model.of(SHIP).but(effect(**sizes))


def differences(s, model):
    """(N, 8, 8) central differences of the readings, one at a time."""
    out = np.zeros((s.t.size, 8, 8))
    for j, (name, size) in enumerate(zip(READINGS, SIZE, strict=True)):
        there, back = (
            readings(replace(s, **{name: getattr(s, name) + sign * 1e-4 * size}), model)
            for sign in (1.0, -1.0)
        )
        out[:, :, j] = (there - back) / (2e-4 * size)
    return out


@pytest.mark.parametrize("effect", [*(catalogue()[n] for n in FAULTS), SquaredGyro], ids=lambda e: e.__name__)
def test_what_a_fault_makes_of_each_reading_is_its_slope_also_of_an_effect_of_others(effect):
    model = at_fault(effect)
    s = moving(drawn(), model)
    expected = differences(s, model)
    assert not np.allclose(expected, np.eye(8)) or effect.__name__ in ("GyroBias", "SpeedLogBias")
    np.testing.assert_allclose(faulty(s, model), expected, rtol=1e-6, atol=1e-7)


def test_faults_on_each_other_are_one_chain():
    model = Model.of(SHIP)
    for name in FAULTS:
        model = model.but(*at_fault(catalogue()[name]).faults)
    s = moving(drawn(), model)
    np.testing.assert_allclose(faulty(s, model), differences(s, model), rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("effects", [(), ("Current", "HullFouling", "RudderWear"), ("VaryingCurrent",)])
def test_slopes_of_the_accelerations_in_one_pass_are_those_one_at_a_time(effects):
    track, model = drawn(), Model.of(SHIP).but(*(catalogue()[n].plausible(SHIP) for n in effects))
    found = jacobian(track, model)
    for j, size in ((2, 1e-3), (3, 1e-3 * SHIP.U_0), (4, 1e-3 * SHIP.U_0), (5, 1e-3 * SIZE[5])):
        there, back = track.state.copy(), track.state.copy()
        there[:, j] += size
        back[:, j] -= size
        sides = [accelerations(replace(track, state=x), model) for x in (there, back)]
        expected = (sides[0] - sides[1]) / (2.0 * size)
        np.testing.assert_allclose(found[:, :, j], expected, rtol=1e-9, atol=1e-12, err_msg=STATE[j])
    assert not found[:, :, :2].any()


def test_what_a_stream_pushes_is_the_difference_to_still_water():
    track, model, step = drawn(), Model.of(SHIP), 0.02 * SHIP.U_0
    stream = catalogue()["Current"].absent(SHIP)
    still = accelerations(track, model)
    for i, axis in enumerate(("north", "east")):
        there = accelerations(track, model.but(stream.but(**{axis: step})))
        np.testing.assert_allclose(by_stream(track, model)[:, :, i], (there - still) / step, atol=1e-12)
