"""What a voyage can tell: a straight run tells less than a zigzag, and look-alikes are named."""

from dataclasses import replace

import numpy as np
import pytest

from twin.errors import DataError
from twin.live.learning.learned_force import scale_of
from twin.live.learning.residual import bundled
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation
from twin.recording.jsonable import plain
from twin.recording.voyage import Voyage
from twin.study.estimation import identifiability
from twin.study.estimation.identifiability import (
    angles,
    basis,
    observability,
    principal,
    report,
    residual_angles,
    text,
    verdict,
)
from twin.study.estimation.observability import gramian
from twin.study.estimation.residual_arrays import features, learned_force
from twin.study.estimation.respond import steered
from twin.study.track.track import track

STEP = 1.25
SHIP = load("kvlcc2")


def sailed(seconds=500.0, helm=15.0, log=True, wind=None):
    """A voyage of the model itself: zigzags of so many degrees every 130 s, with noise."""
    model, rng, rows, state = Model.of(SHIP), np.random.default_rng(0), [], (0.0, 0.0, 0.3, 7.0, 0.0, 0.0)
    t = np.arange(0.0, seconds, STEP)
    rudder = np.radians(helm) * np.sign(np.sin(2.0 * np.pi * t / 260.0))
    for delta in rudder:
        rows.append(state)
        state = model.step(state, Situation(delta=delta, n=1.6), STEP)
    x, y, psi, u, v, r = np.array(rows).T
    noise = rng.normal(size=(8, t.size)) * np.array(
        [[0.4], [0.4], [0.06], [0.02], [0.02], [1e-3], [0.03], [0.03]]
    )
    columns = {
        "north_m": x + noise[0],
        "east_m": y + noise[1],
        "heading_true_north_deg": np.mod(np.degrees(psi) + noise[2], 360.0),
        "surge_velocity_mps": u + noise[3],
        "sway_velocity_mps": v + noise[4],
        "yaw_rate_degps": np.degrees(r) + noise[5],
        "rudder_angle_deg": np.degrees(rudder),
        "propeller_rate_rpm": np.full(t.size, 96.0),
    }
    if log:
        columns |= {
            "surge_velocity_through_water_mps": u + noise[6],
            "sway_velocity_through_water_mps": v + noise[7],
        }
    if wind is not None:
        columns |= {
            "true_wind_speed_mps": np.full(t.size, wind),
            "true_wind_direction_deg": np.full(t.size, 90.0),
        }
    return Voyage("sailed", t, columns)


@pytest.fixture(scope="module")
def zigzag():
    return sailed(wind=8.0)


@pytest.fixture(scope="module")
def told(zigzag):
    return report(zigzag, Model.of(SHIP))


def test_with_all_sensors_every_state_and_the_current_can_be_seen(told):
    measured = told["observability"]["as measured"]
    assert measured["rank"] == measured["of"] == 11
    assert max(measured["still_unknown"].values()) < 1.0


def test_without_position_only_place_is_lost(told):
    blind = told["observability"]["without position"]
    assert blind["rank"] == 9 and set(blind["weakest"]) <= {"x", "y"}


def test_a_straight_run_without_a_log_tells_less_than_a_zigzag():
    straight, zigzag = (
        observability(track(sailed(helm=h, log=False), SHIP), Model.of(SHIP))["as measured"]
        for h in (0.0, 15.0)
    )
    assert straight["log10_condition"] > zigzag["log10_condition"] + 1.0


def test_a_gramian_of_known_rank_and_weakness():
    S = np.zeros((1, 8, 11))
    S[0, 0, 0], S[0, 1, 1] = 100.0, 10.0
    g = gramian(S)
    assert (g["rank"], g["informative"]) == (2, 2)
    assert g["still_unknown"]["x"] == pytest.approx(0.01, rel=1e-3) and g["still_unknown"][
        "v"
    ] == pytest.approx(1.0)


def test_what_is_read_a_fourth_as_often_tells_half_as_well(zigzag):
    """Test: the same voyage, of whose readings only every fourth step has some. Expected: of place, heading, speeds,
    stream and forces twice as much is still unknown, within a quarter."""
    t, model = track(zigzag, SHIP), Model.of(SHIP)
    seldom = np.where(np.arange(len(t))[:, None] % 4, np.nan, t.measured)
    often, rarely = (
        observability(replace(t, measured=m), model)["as measured"]["still_unknown"]
        for m in (t.measured, seldom)
    )
    assert {name: rarely[name] / x for name, x in often.items()} == pytest.approx(
        dict.fromkeys(often, 2.0), rel=0.25
    )


def test_a_window_in_which_nothing_was_read_tells_nothing():
    g = gramian(np.zeros((4, 8, 11)))
    assert (g["rank"], g["informative"]) == (0, 0)
    assert g["log10_condition"] == 24.0 and set(g["still_unknown"].values()) == {1.0}


def test_principal_angles_of_planes_by_hand():
    e = np.eye(4)
    tilt = np.column_stack([np.cos(0.3) * e[:, 0] + np.sin(0.3) * e[:, 2], e[:, 3]])
    assert principal(e[:, :2], tilt) == pytest.approx(np.degrees([0.3, np.pi / 2.0]))
    tiny = np.column_stack([e[:, 0] + 1e-9 * e[:, 2]])
    assert principal(basis(tiny), e[:, :2])[0] == pytest.approx(np.degrees(1e-9), rel=1e-3)


def test_an_effect_made_of_the_cores_own_columns_has_angle_zero(told):
    """Fouling is a share of X_u and X_uu, which the core fits: the voyage cannot tell them apart."""
    fouling, wind = told["angles"]["HullFouling"], told["angles"]["Wind"]
    assert fouling["smallest_deg"] < 1e-3 and fouling["share_inside_core"] > 0.999
    assert wind["smallest_deg"] > fouling["smallest_deg"] and wind["nearest"] in told["angles"]


def test_effects_without_their_inputs_are_not_judged(told):
    assert "WaveDrift" not in told["angles"] and "Bank" not in told["angles"]


def test_features_that_are_the_cores_terms_meet_it_and_others_do_not(zigzag, told):
    t, model = track(zigzag, SHIP), Model.of(SHIP)
    same = residual_angles(t, model, lambda s: np.column_stack([s.v_r * abs(s.v_r), s.r * abs(s.r)]))
    other = residual_angles(t, model, lambda s: np.random.default_rng(1).normal(size=(s.u.size, 2)))
    assert same["sway"]["smallest_deg"] < 0.1 and "disjoint" in " ".join(verdict(told | {"residual": same}))
    assert other["sway"]["smallest_deg"] > 60.0 and "do not meet" in " ".join(
        verdict(told | {"residual": other})
    )


def test_what_was_learned_is_judged_by_its_features_and_by_its_force(zigzag, told):
    """Test: the bundled tanker's residual. Expected: features times last layer are the force that the loop
    adds; shares of it by axis, and in words."""
    phi, W = features(str(bundled(SHIP)), SHIP)
    s = Situation(u=7.5, v=0.1, r=1e-3, u_r=7.5, v_r=0.1, delta=0.1, n=1.6)
    force = np.array([x[0] for x in learned_force(str(bundled(SHIP)), SHIP)(s)])
    assert (phi(s) @ W.T)[0] * np.array(scale_of(SHIP)) == pytest.approx(force, rel=1e-3, abs=10.0)
    found = residual_angles(track(zigzag, SHIP), Model.of(SHIP), phi, W)
    assert all(0.0 <= a["force_inside_core"] <= 1.0 for a in found.values())
    assert "of its force" in "\n".join(text(told | {"residual": found}))


def test_a_residual_that_is_believed_nowhere_on_a_voyage_is_said_to_be(zigzag, told):
    """Test: features that are nothing at every moment, as those of a residual far outside what it was trained on.
    Expected: no angle of what is not there, and a sentence instead of it."""
    nothing = residual_angles(
        track(zigzag, SHIP), Model.of(SHIP), lambda s: np.zeros((s.u.size, 3)), np.ones((3, 3))
    )
    assert nothing == {}
    said = "\n".join(text(told | {"residual": nothing}))
    assert "residual is not believed anywhere on sailed" in said and "residual" not in "\n".join(text(told))


def test_features_of_the_wrong_length_are_refused(zigzag):
    with pytest.raises(DataError, match="one row each"):
        residual_angles(track(zigzag, SHIP), Model.of(SHIP), lambda s: np.ones((3, 2)))


def test_the_report_is_plain_and_can_be_read(told):
    assert plain(told)["voyage"] == "sailed"
    page = "\n".join(text(told))
    assert "as measured" in page and "HullFouling" in page and "11/11" in page


def test_the_current_that_the_model_has_is_nudged_not_replaced(zigzag):
    model = Model.of(SHIP).but(find("Current").plausible(SHIP).but(north=0.5))
    t = track(zigzag, SHIP)
    assert observability(t, model)["as measured"]["rank"] == 11


def test_a_gear_is_stepped_through_all_of_a_voyage_of_which_only_some_rows_are_used(zigzag, monkeypatch):
    """Test: a slow steering gear, and a fourth of the zigzag's rows. Expected: the rudder of each row as it is
    on the whole voyage, and the angles of all rows."""
    t, model = track(zigzag, SHIP), Model.of(SHIP).but(find("SteeringLag").plausible(SHIP))
    of_all, seen = angles(t, model), []

    def learned(s):
        seen.append(s.delta)
        return np.column_stack([s.v_r])

    monkeypatch.setattr(identifiability, "ROWS", t.whole.sum() // 4)
    residual_angles(t, model, learned)
    every = -(-t.whole.sum() // identifiability.ROWS)
    np.testing.assert_array_equal(seen[0], steered(t, model)["delta"][t.whole][::every])
    walk, all_rows = angles(t, model)["PropellerWalk"], of_all["PropellerWalk"]
    assert walk["largest_deg"] == pytest.approx(all_rows["largest_deg"], abs=1.0)


def test_wind_on_a_ship_whose_windage_nobody_knows_has_no_angle(zigzag, told):
    bare = replace(SHIP, A_F=None, A_L=None)
    found = angles(track(zigzag, bare), Model.of(bare))
    assert set(told["angles"]) - set(found) == {"Wind"}
