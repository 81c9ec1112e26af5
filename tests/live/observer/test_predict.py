"""What is said about the future: right for a ship that obeys its model, honest about doubt, a little in
each tick."""

from dataclasses import replace
from math import degrees, hypot, radians
from types import SimpleNamespace

import pytest

from twin.live.observer.dynamics import Dynamics, KnownDynamics
from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import LEARNED, Middle, Predictor, Sureness, carry, ensemble
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Force, Situation

NONE = Force(0.0, 0.0, 0.0)


def nothing(s, forces):
    return NONE


def start(ship, delta=0.1):
    e = Estimate(psi=0.3, u=0.8 * ship.U_0, r=0.0, sigma=(1.0, 1.0, 0.01, 0.05, 0.05, 1e-4), ready=True)
    n = 0.9 * ship.U_0 / (0.7 * ship.D_P)
    return e, Situation(e.x, e.y, e.psi, e.u, e.v, e.r, delta=delta, n=n)


@pytest.mark.parametrize("name", ("kvlcc2", "usv"))
def test_the_coarse_steps_of_a_prediction_agree_with_fine_ones(name):
    ship = load(name)
    e, s = start(ship)
    predictor = Predictor(ship, (10.0, 60.0, 120.0))
    predictor.lead_s = 0.0
    done = []
    while not done:
        done = predictor.advance(0.0, e, s, KnownDynamics(Model.of(ship)), nothing, True)
    state = (s.x, s.y, s.psi, s.u, s.v, s.r)
    for k in range(12000):
        state = Model.of(ship).step(state, s, 0.01)
        if k + 1 in (1000, 6000, 12000):
            p = done[(1000, 6000, 12000).index(k + 1)]
            assert hypot(p.state[0] - state[0], p.state[1] - state[1]) < 0.01 * ship.L_pp
            assert abs(degrees((p.state[2] - state[2] + 3.0) % 6.283185307 - 3.0)) < 0.5


def test_a_round_is_spread_over_ticks(kvlcc2):
    e, s = start(kvlcc2)
    predictor = Predictor(kvlcc2, refresh_s=2.0, rate_hz=10.0)
    rounds = [
        bool(predictor.advance(0.1 * k, e, s, KnownDynamics(Model.of(kvlcc2)), nothing, True))
        for k in range(60)
    ]
    assert 2 <= sum(rounds) <= 4 and predictor.steps_a_tick <= 4


def test_a_horizon_that_the_settings_name_twice_is_foretold_once(kvlcc2):
    """A step of no length between the two would end the loop (the learned force's line has no slope there)."""
    e, s = start(kvlcc2)
    predictor, done = Predictor(kvlcc2, (60.0, 10.0, 10.0)), []
    while not done:
        done = predictor.advance(0.0, e, s, KnownDynamics(Model.of(kvlcc2)), nothing, True)
        predictor.lead_s = 0.0
    assert predictor.horizons_s == (10.0, 60.0)
    assert [len(p.state) for p in done] == [6, 6]


def test_until_past_errors_have_taught_it_the_uncertainty_is_a_prior_and_wide(make_bridge):
    ticks = make_bridge().run(10.0)
    first = next(t.predictions for t in ticks if t.predictions)
    assert [p.horizon_s for p in first] == [10.0, 60.0, 120.0]
    assert {p.status for p in first} == {"prior"}
    assert first[2].sigma.north_m > 10.0 > first[0].sigma.north_m


def test_the_uncertainty_covers_two_errors_of_three(kvlcc2):
    """Test: errors of a known size (Rayleigh with 5 m along an axis). Expected: one sigma covers 68 %."""
    import random

    dice, sure = random.Random(1), Sureness(kvlcc2, 60.0)
    inside = 0
    for k in range(3000):
        true = (dice.gauss(0.0, 5.0), dice.gauss(0.0, 5.0), 0.0, 0.0, 0.0, 0.0)
        if k >= 500:
            inside += hypot(*true[:2]) <= 1.51 * sure.sigma((0.0,) * 6)[0]
        sure.feed((0.0,) * 6, true)
    assert inside / 2500 == pytest.approx(0.68, abs=0.03)
    assert sure.status == "learned" and sure.seen > LEARNED


def test_on_a_voyage_the_predictions_come_true_at_the_time_they_name(make_bridge):
    """Test: a steady turn, so that the helm stays. Expected: each 10 s prediction lands where the ship
    then is, within three sigma."""
    bridge = make_bridge(helm_deg=lambda t: 10.0)
    said, truth = [], {}
    for tick in bridge.run(200.0):
        said += [(tick.time_s + p.horizon_s, p) for p in tick.predictions if abs(p.horizon_s - 10.0) < 0.5]
        truth[round(tick.time_s, 1)] = tick.estimate
    late = [(t, p) for t, p in said[len(said) // 2 :] if round(t, 1) in truth]
    gaps = [
        (
            hypot(p.state.north_m - truth[round(t, 1)].north_m, p.state.east_m - truth[round(t, 1)].east_m),
            p.sigma.north_m,
        )
        for t, p in late
    ]
    assert late[-1][1].status == "learned"  # by then thirty have come due
    assert all(0.0 < p.age_s < 3.0 for _, p in said)  # the estimate it started from is one round old
    assert len(gaps) > 20 and all(gap < 0.5 for gap, _ in gaps)
    assert sum(gap < 1.51 * 3.0 * sigma for gap, sigma in gaps) > 0.9 * len(gaps)


def test_without_a_good_estimate_nothing_is_foretold(kvlcc2):
    e, s = start(kvlcc2)
    predictor = Predictor(kvlcc2)
    assert all(
        not predictor.advance(0.1 * k, e, s, KnownDynamics(Model.of(kvlcc2)), nothing, False)
        for k in range(100)
    )


def test_a_model_that_runs_away_foretells_nothing_and_does_no_harm(kvlcc2):
    """Test: an engine a hundred times too strong. Expected: no prediction, no exception."""
    e, s = start(kvlcc2)
    s.n = 100.0
    predictor = Predictor(kvlcc2)
    assert all(
        not predictor.advance(0.1 * k, e, s, KnownDynamics(Model.of(kvlcc2)), nothing, True)
        for k in range(100)
    )


def test_an_ensemble_of_64_ships_sails_as_64_single_ones(kvlcc2):
    import numpy as np

    _e, s = start(kvlcc2)
    rudders = np.linspace(-0.3, 0.3, 64)
    many = ensemble(
        Situation(0.0, 0.0, s.psi, s.u, np.zeros(64), 0.0, delta=rudders, n=s.n),
        KnownDynamics(Model.of(kvlcc2)),
        nothing,
        120.0,
        1.0,
    )
    for k in (0, 31, 63):
        one = ensemble(
            Situation(0.0, 0.0, s.psi, s.u, 0.0, 0.0, delta=float(rudders[k]), n=s.n),
            KnownDynamics(Model.of(kvlcc2)),
            nothing,
            120.0,
            1.0,
        )
        assert many.x[k] == pytest.approx(one.x, abs=1e-6) and many.psi[k] == pytest.approx(one.psi, abs=1e-9)
    assert radians(5.0) < abs(many.psi[0] - s.psi)


def test_the_learned_force_of_a_step_is_that_of_its_middle():
    """Test: a force that grows by 2 N each second, steps of 5, 5 and 3 s. Expected: the first is held at its
    beginning, the others are exact: 2 x 7.5 and 2 x 11.5 N."""
    middle = Middle()
    said = [middle.of(Force(2.0 * t, 0.0, 0.0), h).X for t, h in ((0.0, 5.0), (5.0, 5.0), (10.0, 3.0))]
    assert said == pytest.approx([0.0, 15.0, 23.0])


def test_a_rudder_that_is_still_on_its_way_is_foretold_where_a_slow_gear_will_have_it(kvlcc2):
    """Test: 20 deg ordered 5 s ago, a gear with 2 s of dead time and 28 s of travel. Expected: the turn of
    that order, not of the angle that the rudder has by now."""
    slow = kvlcc2.with_effects(find("SteeringLag")(delay=2.0, travel_time=28.0))
    dynamics, measured = Dynamics(slow), SimpleNamespace(si={"delta": 0.0, "n": 1.2}, now_s=0.0)
    e = Estimate(u=7.0)
    for k in range(60):
        measured.now_s, measured.si["delta"] = 0.1 * k, radians(20.0) if k > 10 else 0.0
        s, physics, _ = dynamics.known(e, measured)
    assert 0.0 < s.delta < radians(10.0)
    held, carried = ({"steering": None}, {"steering": dynamics.steering()})
    headings = []
    for how in (held, carried):
        there, middle = replace(s), Middle()
        for _ in range(120):
            carry(there, physics, nothing, 1.0, middle, **how)
        headings.append(degrees(there.psi))
    at_once = replace(s, delta=radians(20.0))
    middle = Middle()
    for _ in range(120):
        carry(at_once, physics, nothing, 1.0, middle)
    assert headings[0] < 0.7 * degrees(at_once.psi)
    assert 0.8 * degrees(at_once.psi) < headings[1] < degrees(at_once.psi)
    assert dynamics.steering().gears[0].actual == s.delta  # the gear on board did not move with the forecast
