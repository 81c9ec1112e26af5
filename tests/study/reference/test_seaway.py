"""Waves are seen when they are there, and only then; what they swing is neither hers nor noise."""

from dataclasses import replace

import numpy as np
import pytest

from twin.num import num
from twin.physics.effects import find
from twin.physics.model import Model
from twin.study.estimation.fit import present
from twin.study.estimation.linear import linearise
from twin.study.estimation.respond import respond
from twin.study.estimation.start import steadied, wave_period_s, waves_in_words, waves_on
from twin.study.prediction.openloop import coarse
from twin.study.reference import seaway, steering_gear
from twin.study.reference.seaway import at_sea, excited, levelled, swung
from twin.study.track.track import track
from twin.study.track.waves import LASTING, RATE, as_shown, carried, lasting, renewed, swinging

PERIOD_S = 12.0
YAW, SWAY = 0.01, 0.3  # amplitudes [rad, m/s]


@pytest.fixture(scope="module")
def calm(tanker, voyages):
    return track(voyages["nothing"], tanker)


def in_waves(t, yaw=YAW, sway=SWAY, period_s=PERIOD_S):
    """The same track in a sea that yaws and sways it, seen by all instruments alike, and its roll and rudder
    swinging with it."""
    omega = 2.0 * np.pi / period_s
    swing, rate = np.sin(omega * t.t), omega * np.cos(omega * t.t)
    psi, v = yaw * swing, sway * omega * swing / omega
    aside = -sway / omega * np.cos(omega * t.t)
    c, s = np.cos(t.state[:, 2]), np.sin(t.state[:, 2])
    zero = np.zeros_like(swing)
    off = np.column_stack(
        [-s * aside, c * aside, psi, t.state[:, 4] * psi, v - t.state[:, 3] * psi, yaw * rate, zero, zero]
    )
    measured = t.measured + off
    measured[:, 6:] = np.nan
    return replace(
        t,
        state=t.state + off[:, :6],
        measured=measured,
        delta=t.delta + 0.02 * swing,
        weather=dict(t.weather) | {"phi": 0.1 * swing},
    )


@pytest.fixture(scope="module")
def rough(calm, tanker):
    return swung(in_waves(calm), Model.of(tanker))


def test_a_log_that_shows_less_met_a_stronger_sea(calm, rough):
    shown = np.tile(np.eye(8), (len(rough), 1, 1))
    shown[:, 6, 6], shown[:, 7, 7] = 0.9, 0.8
    strength = as_shown(rough, shown).swell / rough.swell
    np.testing.assert_allclose(strength[0], [1.0, 1.0, 1.0, 1.0 / 0.9, 1.0 / 0.8, 1.0])
    assert as_shown(calm, shown) is calm


def test_a_calm_track_is_left_as_it_is(calm, tanker):
    assert swung(calm, Model.of(tanker)) is calm


def test_a_sea_that_was_measured_but_moves_nobody_is_no_sea(calm, tanker):
    measured = replace(calm, weather=dict(calm.weather) | {"H_s": np.full(len(calm), 3.0)})
    assert at_sea(measured, Model.of(tanker))
    assert swung(measured, Model.of(tanker)) is measured


@pytest.mark.parametrize(
    "gain, measured, believed",
    [(1.0, True, True), (-1.0, True, False), (1.0, False, False), (99.0, False, True)],
)
def test_a_sea_that_was_measured_need_only_be_the_likelier(
    monkeypatch, calm, tanker, gain, measured, believed
):
    rough = in_waves(calm)
    recorded = replace(
        calm, weather=dict(calm.weather) | ({"H_s": np.full(len(calm), 3.0)} if measured else {})
    )
    monkeypatch.setattr(
        seaway, "likeliest_waves", lambda *_: (replace(rough, swell=np.ones((len(calm), 6))), gain, 0.0)
    )
    assert (swung(recorded, Model.of(tanker)).swell is not None) is believed


def test_a_slow_gear_is_no_sea(tanker, voyages):
    lagging = track(voyages["SteeringLag"], tanker)
    assert swung(lagging, Model.of(tanker)).swell is None


def test_what_is_asked_beside_a_slow_gear_is_asked_from_where_that_gear_stands(tanker, voyages, monkeypatch):
    asked = []

    def seen(track, model, unknowns, *known, **like):
        asked.extend((u.owner, u.centre, present(model, u)) for u in unknowns)
        return linearise(track, model, unknowns, *known, **like)

    monkeypatch.setattr(seaway, "linearise", seen)
    monkeypatch.setattr(steering_gear, "linearise", seen)
    swung(in_waves(track(voyages["SteeringLag"], tanker)), Model.of(tanker))
    assert any(there != 0.0 for owner, _, there in asked if owner == "SteeringLag")
    assert all(centre == there for _, centre, there in asked)


def test_a_model_that_no_filter_can_follow_says_nothing_of_waves(calm, tanker, monkeypatch):
    def lost(*_):
        raise np.linalg.LinAlgError

    monkeypatch.setattr(seaway, "innovate_each", lost)
    rough = in_waves(calm)
    assert swung(rough, Model.of(tanker)) is rough


def test_waves_are_told_with_their_voyage_and_period(rough, calm):
    (said,) = waves_in_words(waves_on([calm, rough]))
    assert calm.name in said and f"{num(wave_period_s(rough))} s" in said


def test_the_period_and_the_strength_of_the_waves_are_found(rough):
    assert wave_period_s(rough) == pytest.approx(PERIOD_S, rel=0.1)
    omega, sway = 2.0 * np.pi / PERIOD_S, np.sqrt(np.mean(rough.swell[:, 4] ** 2))
    assert 0.4 < sway / (SWAY * omega / np.sqrt(2.0)) < 2.5


def test_how_she_heels_to_waves_is_averaged_out_and_her_rudder_is_left_as_it_was(rough):
    level, inside = levelled(rough), slice(20, -20)
    assert np.abs(level.weather["phi"][inside]).max() < 0.02 < np.abs(rough.weather["phi"][inside]).max()
    assert level.delta is rough.delta and level.n is rough.n


def test_a_prediction_begins_in_the_motion_without_waves(rough, calm, tanker):
    model = Model.of(tanker)
    errors = {}
    for name, t in (("calm", calm), ("waves", rough), ("as shown", replace(rough, swell=None))):
        windows = coarse(t, model, 60.0, leads=1)
        errors[name] = float(np.nanmean(np.where(windows.valid, windows.errors()["position"], np.nan)))
    assert errors["waves"] < 0.5 * (errors["calm"] + errors["as shown"])
    assert steadied(calm) is calm


def test_what_carries_waves_on_keeps_their_strength(rough):
    """P = Phi P Phi' + Q with a Q that can be, and Phi = exp(omega h A) by its series."""
    on, whole, new = (M(rough)[100] for M in (swinging, lasting, renewed))
    np.testing.assert_allclose(on @ whole @ on.T + new, whole, atol=1e-12 * whole.max())
    assert np.linalg.eigvalsh(new).min() > -1e-12 * whole.max() and LASTING[0, 0] == 1.0
    powers = [np.eye(4)]
    for k in range(1, 20):
        powers.append(powers[-1] @ RATE * float(rough.h * rough.swell[100, 1]) / k)
    np.testing.assert_allclose(carried(rough)[100, 1], sum(powers), atol=1e-12)


def test_waves_push_nobody_for_long():
    """|w / noise| = |s / (s2 + 2 zeta o1 s + o1^2)| |s / (s2 + 2 zeta o2 s + o2^2)|: a fifth of their
    frequency shows a thousandth of its middle."""
    gain = [abs(np.linalg.solve(1j * x * np.eye(4) - RATE, [0.0, 0.0, 1.0, 0.0])[0]) for x in (0.0, 0.2, 1.0)]
    assert gain[0] == pytest.approx(0.0, abs=1e-12)
    by_hand = np.prod([x / abs((o**2 - x**2) + 0.2j * o * x) for x in (0.2,) for o in (0.9, 1.1)])
    assert gain[1] == pytest.approx(by_hand, rel=1e-9)
    assert (gain[1] / gain[2]) ** 2 < 0.002


def test_waves_stir_the_mean_of_what_drag_does_and_nothing_without_waves(rough, calm, tanker):
    """Half of |v + a| (v + a) + |v - a| (v - a) is more than |v| v by a^2 sign v: of cross-flow drag with
    swings of 0.5 m/s about 1 m/s."""
    model = Model.of(tanker)
    assert not excited(calm, model).any()
    swing = 0.5 * np.sin(2.0 * np.pi / PERIOD_S * rough.t)
    drifting = np.column_stack([rough.state[:, :4], 1.0 + swing, 0.0 * swing])
    drag = replace(model, effects=(find("CrossFlowDrag")(c_d=0.4),))
    more = (excited(replace(rough, state=drifting), m) for m in (drag, model))
    added = np.median((next(more) - next(more))[200:-200, 1])
    by_hand = -0.5 * float(tanker.rho) * float(tanker.L_pp) * float(tanker.T) * 0.4 * 0.5**2 / drag.c.m_v
    assert added == pytest.approx(by_hand, rel=0.15)


def test_an_antenna_on_a_mast_swings_with_the_roll_that_is_averaged_for_the_forces(rough, tanker):
    """Test: a roll of 3 deg with the waves, an antenna 30 m above the axis. Expected: by hand, the velocity that it
    shows athwart swings by height times rate of roll, but for what differences over two steps leave of it; the
    roll that drives the ship is nearly gone; and half of the track holds half of the roll."""
    omega, phi = 2.0 * np.pi / wave_period_s(rough), np.radians(3.0)
    swing = {"phi": phi * np.sin(omega * rough.t), "p": phi * omega * np.cos(omega * rough.t)}
    rolling = replace(rough, weather={**rough.weather, **swing})
    model = Model.of(tanker).but(find("AntennaOffset")(ahead=0.0, above=30.0))
    still = respond(rough, Model.of(tanker))[1][200:-200, 4]
    swung = respond(levelled(rolling), model)[1][200:-200, 4] - still
    left = np.sin(omega * rough.h) / (omega * rough.h)
    assert np.std(swung) == pytest.approx(left * 30.0 * phi * omega / 2.0**0.5, rel=0.05)
    once, twice = levelled(rolling), levelled(levelled(rolling))
    assert np.std(once.weather["phi"][200:-200]) < 0.1 * np.std(swing["phi"])
    assert np.array_equal(twice.rolled["phi"], once.rolled["phi"])
    assert once.part(0, 100).rolled["p"].size == 100
