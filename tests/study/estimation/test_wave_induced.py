"""What one wave does at once: the helm's answer, and sway and surge that go with the yaw."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.study.estimation import wave_induced
from twin.study.estimation.columns import SEA, sea_unknowns
from twin.study.estimation.respond import accelerations, readings
from twin.study.reference.nuisance import nuisance_unknowns
from twin.study.track.track import track

PERIOD_S = 12.0
MIRROR = np.array([1.0, -1.0, -1.0])  # X, Y, N of a ship seen in a mirror
INSIDE = slice(60, -60)


@pytest.fixture(scope="module")
def model():
    """The published tanker: the same to both sides, as no calibrated one is, and prompt."""
    return Model.of(load("kvlcc2"))


@pytest.fixture(scope="module")
def tossing(tanker, voyages):
    """A straight voyage on which each wave yaws it by a degree, and the helmsman answers with two."""
    t = track(voyages["straight"], tanker)
    omega = 2.0 * np.pi / PERIOD_S
    state = t.state.copy()
    state[:, 2] += np.radians(1.0) * np.sin(omega * t.t)
    state[:, 5] += np.radians(1.0) * omega * np.cos(omega * t.t)
    swell = np.tile([omega, omega, omega, 0.01, 0.01, 0.001], (len(t), 1))
    return replace(t, state=state, delta=t.delta - np.radians(2.0) * np.sin(omega * t.t), swell=swell)


@pytest.mark.parametrize("name", wave_induced.TERMS)
def test_in_calm_water_there_is_none_of_it(tossing, model, name):
    calm = replace(tossing, swell=None)
    pushed, read = wave_induced.columns(calm, model)[name]
    assert not pushed.any() and not read.any()


@pytest.mark.parametrize("name", wave_induced.HELM)
def test_a_mirrored_helm_answers_the_mirrored_way(tossing, model, name):
    state = tossing.state * np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
    mirrored = replace(tossing, state=state, delta=-tossing.delta)
    here, there = (wave_induced.columns(t, model)[name][0] for t in (tossing, mirrored))
    assert np.abs(here[:, 2]).max() > 0.0 and there == pytest.approx(here * MIRROR)


def test_what_is_left_open_of_the_helm_is_what_it_does_in_time_with_the_waves(tossing, model):
    """Test: the same voyage with a helm that was laid over by five degrees all the way. Expected: the same,
    but for what a stronger swing meets."""
    over = replace(tossing, delta=tossing.delta + np.radians(5.0))
    one, other = (wave_induced.columns(t, model)["helm"][0][INSIDE, 2] for t in (tossing, over))
    assert np.abs(other - one).max() < 0.1 * np.abs(one).max()
    # without the answer
    helm = replace(
        tossing, delta=tossing.delta + np.radians(2.0) * np.sin(2.0 * np.pi / PERIOD_S * tossing.t)
    )
    assert one == pytest.approx(
        (accelerations(tossing, model) - accelerations(helm, model))[INSIDE, 2], abs=0.1 * np.abs(one).max()
    )


def test_a_gear_that_is_a_little_late_in_waves_alone_is_the_helm_a_quarter_of_a_period_later(tossing, model):
    late = accelerations(tossing, model.but(find("SteeringLag")(delay=1.0, travel_time=0.0))) - accelerations(
        tossing, model
    )
    quarter = wave_induced.columns(tossing, model)["helm_earlier"][0]
    share = 2.0 * np.pi * 1.0 / PERIOD_S  # of a radian
    assert late[INSIDE, 2] == pytest.approx(
        -share * quarter[INSIDE, 2], abs=0.2 * share * np.abs(quarter).max()
    )


def test_a_swing_in_sway_in_time_with_the_yaw_is_seen_as_an_antenna_ahead_is_in_those_waves(tossing, model):
    """Test: an antenna a tenth of its length ahead; what it shows of the waves, and the term. Expected: the
    same."""
    ahead = find("AntennaOffset")(ahead=0.1 * float(model.ship.L_pp), starboard=0.0)
    still = wave_induced.steadied(tossing)
    shown = [readings(t.situation(), m) for t in (tossing, still) for m in (model.but(ahead), model)]
    of_waves = (shown[0] - shown[1]) - (shown[2] - shown[3])
    term = 0.1 * wave_induced.columns(tossing, model)["sway"][1]
    for column in (0, 1, 4):  # x, y, v
        assert term[INSIDE, column] == pytest.approx(
            of_waves[INSIDE, column], abs=0.05 * np.abs(term[:, column]).max()
        )


def test_every_term_is_free_when_a_voyage_is_judged(model, tanker):
    labels = [u.label for u in nuisance_unknowns(model, {})]
    assert {u.label for u in sea_unknowns()} <= set(labels) and {u.owner for u in sea_unknowns()} == {SEA}
