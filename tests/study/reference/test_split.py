"""A seaway split into low-frequency motion and motion with the waves; and what the ship file then says."""

from dataclasses import replace

import numpy as np
import pytest

from twin.errors import SettingsError
from twin.live.certificate.plant import seaway_of, usual_disturbance
from twin.physics import ship as ships
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.reference.hierarchical import hierarchical_quantile
from twin.study.reference.split import SplitVoyage, force, low_frequency, scores, section, window

STEP_S = 0.1


@pytest.fixture(scope="module")
def model():
    return Model.of(ships.load("kvlcc2"))


def voyage(model, amplitude, seconds=240.0, T_p=8.0):
    """The model's own run under a slow helm, with a sine of the waves' period added to v."""
    n = round(seconds / STEP_S)
    delta = 0.1 * np.sin(2.0 * np.pi * np.arange(n) * STEP_S / 120.0)
    state, sailed = (0.0, 0.0, 0.2, 6.0, 0.0, 0.0), []
    for k in range(n):
        sailed.append(state)
        state = model.step(state, Situation(delta=float(delta[k]), n=1.2), STEP_S)
    x = np.array(sailed).T
    wave = amplitude * np.sin(2.0 * np.pi * np.arange(n) * STEP_S / T_p)
    nu = x[3:] + np.array([0.0 * wave, wave, 0.0 * wave])
    return SplitVoyage(STEP_S, nu, x[2], {"delta": delta, "n": np.full(n, 1.2)}, np.zeros((2, n)), 2.0, T_p)


def test_a_sine_of_the_waves_period_is_found_as_motion_and_not_as_force(model):
    """Expected: 0.3 m/s of sway over 2 m of waves is 0.15 m/s a metre; no drift beyond that of calm water."""
    *drift, u, v, _, _ = scores(model, voyage(model, 0.3), usual_disturbance(model).calm)
    assert v == pytest.approx(0.15, rel=0.1) and u < 0.01 and drift == [0.0, 0.0, 0.0]


def test_wind_blows_on_the_ship_over_ground_and_not_through_the_water():
    """Test: the model's own run in a wind of 10 m/s from abeam and a stream of 1.5 m/s. Expected: the model that
    has that wind lacks less than a thousandth of it."""
    ship = ships.load("kvlcc2")
    windy, n = Model.of(ship).but(find("Wind").plausible(ship)), 600
    north, east = 1.0, -1.1
    sea = windy.but(find("Current")(north=north, east=east))
    air = {"wind_speed": 10.0, "wind_to": 1.5}
    state, sailed = (0.0, 0.0, 0.2, 6.0, 0.0, 0.0), []
    for _ in range(n):
        sailed.append(state)
        state = sea.step(state, Situation(delta=0.1, n=1.2, **air), STEP_S)
    x = np.array(sailed).T
    current = np.array([np.full(n, north), np.full(n, east)])
    voyage = SplitVoyage(STEP_S, x[3:], x[2], {"delta": 0.1, "n": 1.2, **air}, current, 1.0, 8.0)
    s = Situation(psi=x[2], u=x[3], v=x[4], r=x[5], **air)
    push = windy.pushes[0].force(s, ship)
    lacking = force(windy, voyage.nu, voyage.psi, voyage)[:, 2:-2]
    assert np.all(np.abs(lacking).max(axis=1) < 0.01 * np.abs(np.array(push)).max(axis=1))


def test_a_steady_force_is_found_as_drift(model):
    """Test: the same motion, but the model that explains it lacks a tenth of its propeller rate. Expected: a
    drift ahead beyond a calm water of nothing, none of the size in a model that lacks nothing."""
    still = voyage(model, 0.0)
    short = replace(still, inputs={**still.inputs, "n": 0.9 * np.asarray(still.inputs["n"])})
    lacking, whole = (scores(model, v, (0.0, 0.0, 0.0))[0] for v in (short, still))
    assert lacking > 10.0 * whole


def test_the_average_leaves_a_straight_line_as_it_is():
    line = np.linspace(0.0, 5.0, 400)[None]
    n = window(8.0, STEP_S)
    assert low_frequency(line, n)[0, 2 * n : -2 * n] == pytest.approx(line[0, 2 * n : -2 * n])


def test_too_few_voyages_can_promise_nothing_at_that_level():
    """Expected: 90 % needs nine voyages, however many samples each has."""
    rng = np.random.default_rng(1)
    assert hierarchical_quantile([rng.random(1000) for _ in range(8)], 0.9) == float("inf")
    assert hierarchical_quantile([rng.random(1000) for _ in range(9)], 0.9) < 1.0


def test_the_hierarchical_quantile_keeps_its_level_for_new_voyages():
    """Test: scores that differ from voyage to voyage by more than within one. Expected: over many calibrations
    of 19 voyages the next one's scores lie under the quantile 90 % of the time, or a little more."""
    rng, kept = np.random.default_rng(2), []
    for _ in range(400):
        voyages = rng.lognormal(0.0, 0.6, (20, 1)) * rng.random((20, 50))
        kept.append(np.mean(voyages[19] <= hierarchical_quantile(list(voyages[:19]), 0.9)))
    assert 0.88 < np.mean(kept) < 0.97


def test_what_was_found_is_what_the_certificate_takes(model):
    ship = model.ship
    found = [(1.0, 2.0, 3.0, 0.1, 0.2, 0.01, 0.02)] * 40
    d = usual_disturbance(Model.of(replace(ship, notes={"seaway": section(found, 0.95, "a test")})))
    assert d.per_metre == (1.0, 2.0, 3.0) and d.motion == (0.1, 0.2, 0.01, 0.02)
    assert d.noise((0.15, 0.15, 0.0005), 2.0) == pytest.approx((0.35, 0.55, 0.0205))


def test_a_seaway_that_is_no_number_is_refused_in_one_line(model):
    with pytest.raises(SettingsError, match=r"seaway.drift_X = 'much': a number from 0 on is needed"):
        seaway_of(replace(model.ship, notes={"seaway": {"drift_X": "much"}}))


def test_every_bundled_ship_says_what_a_seaway_does_to_her():
    for name in ships.bundled():
        assert seaway_of(ships.load(name)) is not None
