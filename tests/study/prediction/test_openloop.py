"""Open-loop prediction: true to the model that made the voyage, honest about noise, whole about instruments
and holes."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.state import Force
from twin.study.estimation.innovations import NoiseModel
from twin.study.prediction.openloop import HORIZONS_S, ends, predict, predict_each
from twin.study.prediction.windows import MODEL, SENSORS, STRUCTURE
from twin.study.reference.sailed import fed, switched_off
from twin.study.reference.structure import once_off
from twin.study.track.track import track


def mean(windows, name, horizon, run=0):
    return float(np.nanmean(windows.errors(run)[name][windows.at(horizon)]))


def with_effect(ship, name, **values):
    return Model.of(ship).but(find(name).absent(ship).but(**values))


def test_the_model_that_made_a_voyage_without_noise_predicts_it_within_centimetres(make, kvlcc2):
    w = predict(track(make(noise=0.0), kvlcc2), Model.of(kvlcc2))
    assert mean(w, "position", 120.0) < 0.5 and np.degrees(mean(w, "heading", 120.0)) < 0.05


@pytest.mark.parametrize("lengths", [0.75, 1.5])
def test_a_log_slower_than_the_ship_is_stepped_finer_and_stays_in_the_world(make, kvlcc2, lengths):
    """Test: one row while it sails so many lengths. Expected: the model that made the voyage is off by what
    the rudder did in between, not by what steps too long for its make of it (before: 1e6 m)."""
    full = make(noise=0.0)
    rows = slice(None, None, round(32 * lengths))
    slow = full.with_rows(full.time_s[rows], {n: x[rows] for n, x in full.columns.items()})
    t = track(slow, kvlcc2)
    assert t.h < 1.001 * kvlcc2.scale("time") / 8 and t.whole.all()
    w = predict(t, Model.of(kvlcc2))
    assert np.isfinite(w.errors()["position"][w.at(120.0)]).sum() > 10
    assert mean(w, "position", 120.0) < 0.1 * kvlcc2.L_pp


@pytest.mark.parametrize("horizon", HORIZONS_S)
@pytest.mark.parametrize("name", ["position", "lateral", "heading"])
def test_a_perfect_model_errs_as_much_as_the_noise_floor_says(make, kvlcc2, name, horizon):
    windows = [predict(track(make(seed=k), kvlcc2), Model.of(kvlcc2), seed=k) for k in range(3)]
    error = np.mean([mean(w, name, horizon) for w in windows])
    floor = np.mean([mean(w, name, horizon, SENSORS) for w in windows])
    assert 0.6 < error / floor < 1.6


def test_a_structural_floor_is_no_lower_than_the_calibrated_ship_was_off_on_voyages_she_was_not_fitted_to(
    make, kvlcc2
):
    """Test: a ship file says that 120 s ahead it was once 300 m and 9 deg off, 10 s ahead hardly. Expected:
    the structural floor says so, too, and in between as a power of the time; the sensors' floor and the
    model's error are what they were."""
    off = [
        {"horizon_s": h, "position_m": p, "heading_deg": a}
        for h, p, a in ((10.0, 1e-6, 1e-6), (120.0, 300.0, 9.0))
    ]
    once = replace(kvlcc2, notes={**kvlcc2.notes, "structural": {"held_out": off}})
    before, after = (predict(track(make(), s), Model.of(s), noise_model=NoiseModel()) for s in (kvlcc2, once))
    assert mean(after, "position", 120.0, STRUCTURE) == pytest.approx(300.0) and mean(
        after, "heading", 120.0, STRUCTURE
    ) == pytest.approx(np.radians(9.0))
    assert mean(after, "position", 10.0, STRUCTURE) == mean(before, "position", 10.0, STRUCTURE)
    for run in (MODEL, SENSORS):
        assert mean(after, "position", 120.0, run) == mean(before, "position", 120.0, run)
    assert once_off(once, "position_m", np.array([5.0, 10.0, 120.0]))[:2] == pytest.approx([0.5e-6, 1e-6])


def test_a_structural_floor_stands_above_that_of_the_sensors(make, kvlcc2):
    w = predict(track(make(), kvlcc2), Model.of(kvlcc2), noise_model=NoiseModel())
    for name in ("position", "lateral", "heading"):
        assert mean(w, name, 120.0, STRUCTURE) > 2.0 * mean(w, name, 120.0, SENSORS)


@pytest.mark.parametrize(
    "name, values",
    [
        ("HeadingBias", {"bias": 0.05}),
        ("AntennaOffset", {"ahead": -60.0, "starboard": 8.0}),
        ("SensorDelay", {"delay": 3.0}),
        ("SpeedLogScale", {"scale": 0.1}),
    ],
)
def test_a_known_fault_of_an_instrument_is_undone_at_the_start_and_shown_in_the_readings(
    make, kvlcc2, name, values
):
    effect = find(name).absent(kvlcc2).but(**values)
    t = track(make(effect, noise=0.0), kvlcc2)
    aware, unaware = predict(t, Model.of(kvlcc2).but(effect)), predict(t, Model.of(kvlcc2))
    off = [np.nanmean(np.abs(w.off()[w.at(120.0)]) / t.sd) for w in (aware, unaware)]
    assert off[0] < 0.25 * off[1]


def test_a_high_antenna_that_heel_carries_aside_is_undone_where_roll_was_recorded(make, kvlcc2):
    """Test: 40 m above the axis of roll, heeling by 5 deg in a minute and a half (written by hand, not by the
    effect). Expected: a model that has the antenna there predicts as well as one without it does the voyage
    of a low antenna."""
    made, high = make(noise=0.0), 40.0
    turn, heel = (
        np.radians(made["heading_true_north_deg"]),
        np.radians(5.0) * np.sin(2.0 * np.pi * made.time_s / 90.0),
    )
    swung = high * np.sin(heel)
    columns = {**made.columns, "roll_deg": np.degrees(heel)}
    columns["north_m"], columns["east_m"] = (
        made["north_m"] - swung * np.sin(turn),
        made["east_m"] + swung * np.cos(turn),
    )
    columns["surge_velocity_mps"] = made["surge_velocity_mps"] - swung * np.radians(made["yaw_rate_degps"])
    columns["sway_velocity_mps"] = made["sway_velocity_mps"] + np.gradient(swung, made.time_s)
    there = track(made.with_rows(made.time_s, columns), kvlcc2)
    aware = Model.of(kvlcc2).but(find("AntennaOffset").absent(kvlcc2).but(above=high))
    off = [
        mean(predict(t, m), "position", 120.0)
        for t, m in ((track(made, kvlcc2), Model.of(kvlcc2)), (there, aware), (there, Model.of(kvlcc2)))
    ]
    assert off[1] < off[0] + 0.1 * (off[2] - off[0]) and off[2] > 5.0 * off[0]


def test_the_steering_gear_turns_orders_into_angles(make, kvlcc2):
    lag = find("SteeringLag").absent(kvlcc2).but(delay=8.0, travel_time=60.0)
    t = track(make(), kvlcc2)
    prompt, late = predict(t, Model.of(kvlcc2)), predict(t, Model.of(kvlcc2).but(lag))
    assert mean(late, "heading", 60.0) > 5.0 * mean(prompt, "heading", 60.0)


def test_a_window_over_a_hole_in_the_controls_is_not_judged(make, kvlcc2):
    v = make()
    v.columns["rudder_angle_deg"][(v.time_s > 600.0) & (v.time_s < 640.0)] = np.nan
    w = predict(track(v, kvlcc2), Model.of(kvlcc2))
    start, end = w.track.t[w.start], w.track.t[w.start] + 120.0
    over = (start < 640.0) & (end > 606.0)
    assert over.any() and not w.valid[w.at(120.0)][over].any()
    assert w.valid[w.at(120.0)][(end < 599.0)].all()


def test_an_effect_whose_input_was_not_recorded_is_switched_off_and_said(make, kvlcc2):
    windy = Model.of(kvlcc2.with_effects(find("Wind").plausible(kvlcc2)))
    t = track(make(), kvlcc2)
    model, off = fed(windy, t)
    assert [type(e).__name__ for e in off] == ["Wind"] and not model.pushes
    assert switched_off(windy, [t]) == [
        {"effect": "Wind", "voyage": "made", "not_measured": ["wind_speed", "wind_to"]}
    ]


def test_a_learned_force_acts_as_a_force_of_the_same_size_does(make, kvlcc2):
    from dataclasses import replace

    t, push = track(make(), kvlcc2), 3e5
    learned = replace(Model.of(kvlcc2), residual=lambda s: Force(s.u * 0.0, s.u * 0.0 + push, s.u * 0.0))
    known = with_effect(
        kvlcc2,
        "TowForce",
        **{p.name: push for p in find("TowForce").params() if p.name in ("Y", "aside", "starboard")},
    )
    a, b = predict(t, learned).promised[0], predict(t, known).promised[0]
    assert known.pushes[0] != find("TowForce").absent(kvlcc2)
    assert np.allclose(a[-1, :, :2], b[-1, :, :2], atol=0.05)


def test_a_model_that_runs_away_is_as_wrong_as_can_be_written_and_no_more(make, kvlcc2):
    wild = Model.of(kvlcc2.with_derivatives(N_ur=50.0, N_uv=-50.0))
    w = predict(track(make(), kvlcc2), wild)
    assert np.isfinite(w.promised).all() and mean(w, "position", 120.0) > 50.0


def test_a_receiver_slower_than_the_grid_is_compared_and_a_hole_is_not(make, kvlcc2):
    v = make()
    for name in ("north_m", "east_m"):
        v.columns[name][1::2] = np.nan
        v.columns[name][(v.time_s > 600.0) & (v.time_s < 660.0)] = np.nan
    w = predict(track(v, kvlcc2), Model.of(kvlcc2))
    end = (w.track.t[w.start] + 60.0)[w.start < w.start[-1]]
    valid = w.valid[w.at(60.0)][w.start < w.start[-1]]
    assert not valid[(end > 606.0) & (end < 654.0)].any() and valid[end < 590.0].all()


def test_the_model_run_once_to_the_longest_horizon_ends_where_each_prediction_by_itself_does(make, kvlcc2):
    """Test: horizons of which the last is longer than the voyage. Expected: to the last digit what `predict`
    gives for each alone, and beyond the end of the voyage nothing."""
    t = track(make(seconds=600.0), kvlcc2)
    model, horizons = Model.of(kvlcc2), (10.0, 120.0, 900.0)
    together = ends(t, model, horizons)
    for horizon, found in zip(horizons, together, strict=True):
        alone = predict(t, model, [horizon], leads=1)
        np.testing.assert_array_equal(found.start, alone.start)
        np.testing.assert_array_equal(found.off(), alone.off())
    assert [bool(found.valid.any()) for found in together[:2]] == [True, True]
    assert not together[2].valid[together[2].at(900.0)].any()


def test_noise_models_side_by_side_give_each_what_it_gives_alone(make, kvlcc2):
    """Test: a ship once 30 m off after two minutes; a coarse noise model and a fine one. Expected: all three
    runs of each to the last digit, and the coarse one farther off."""
    t, noise_models = (
        track(make(seconds=600.0), kvlcc2),
        [NoiseModel(), NoiseModel((0.4, 0.4, 0.4), flow=0.05)],
    )
    held_out = [{"horizon_s": 120.0, "position_m": 30.0, "heading_deg": 1.0}]
    model = Model.of(replace(kvlcc2, notes={"structural": {"held_out": held_out}}))
    together = predict_each(t, model, noise_models, [60.0], leads=1)
    for noise_model, found in zip(noise_models, together, strict=True):
        np.testing.assert_array_equal(
            found.promised, predict(t, model, [60.0], noise_model=noise_model, leads=1).promised
        )
    fine, coarse = (mean(w, "position", 60.0, STRUCTURE) for w in together)
    assert coarse > 1.2 * fine
