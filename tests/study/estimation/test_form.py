"""What the core leaves out of calm water, as columns."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.actuators import Actuator
from twin.physics.effects import find
from twin.physics.model import Model
from twin.study.estimation import form
from twin.study.estimation.columns import columns, form_unknowns
from twin.study.reference.nuisance import from_ship, nuisance_unknowns
from twin.study.track.track import track

MIRROR = np.array([1.0, -1.0, -1.0])  # X, Y, N of a ship seen in a mirror


@pytest.fixture(scope="module")
def sailed(tanker, voyages):
    return track(voyages["calm"], tanker), Model.of(tanker)


def mirrored(t):
    state = t.state * np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
    return replace(t, state=state, delta=-t.delta, weather=dict(t.weather) | {"phi": -t.weather["phi"]})


@pytest.mark.parametrize("name", list(form.TERMS))
def test_every_term_pushes_a_mirrored_ship_the_mirrored_way(sailed, name):
    t, model = sailed
    here = form.accelerations(t, model)[name]
    assert np.abs(here).max() > 0.0 or name.startswith("X_at")  # of speeds at which it never sailed
    assert form.accelerations(mirrored(t), model)[name] == pytest.approx(here * MIRROR)


@pytest.mark.parametrize("name", ["X_vvvv", "Y_vvv", "N_vvr", "q_vv"])
def test_in_a_stream_every_term_is_what_it_would_be_at_the_speed_through_the_water(sailed, name):
    t, model = sailed
    north, east, psi = 0.8, -0.5, t.state[:, 2]
    state = t.state.copy()
    state[:, 3] -= north * np.cos(psi) + east * np.sin(psi)
    state[:, 4] -= east * np.cos(psi) - north * np.sin(psi)
    stream = model.but(find("Current")(north=north, east=east))
    assert form.accelerations(t, stream)[name] == pytest.approx(
        form.accelerations(replace(t, state=state), model)[name]
    )
    assert form.accelerations(t, stream)[name] != pytest.approx(form.accelerations(t, model)[name], rel=0.02)


def test_without_a_measured_heel_its_terms_are_nothing(sailed):
    t, model = sailed
    blind = replace(t, weather={k: w for k, w in t.weather.items() if k != "phi"})
    for name in ("Y_phi", "N_p", "N_pdot"):
        assert not form.accelerations(blind, model)[name].any()


def test_the_cubic_terms_are_what_a_published_polynomial_has_and_the_modulus_form_has_not():
    """KVLCC2 by Yasukawa & Yoshimura (2015): sway and yaw of the hull, fitted with the core's terms and with
    these beside them."""
    v, r = (a.ravel() for a in np.meshgrid(np.linspace(-0.4, 0.4, 21), np.linspace(-0.7, 0.7, 21)))
    u = np.sqrt(1.0 - v * v)
    Y = -0.315 * v + 0.083 * r - 1.607 * v**3 + 0.379 * v * v * r - 0.391 * v * r * r + 0.008 * r**3
    modulus = np.stack([v, u * v, u * r, abs(v) * v, abs(v) * r, abs(r) * v, abs(r) * r], 1)
    a = form.Along(v, r, 0 * v, 0 * v, 0 * v, 0 * v)
    cubic = np.stack([term(a) for axis, _, term in form.HULL.values() if axis == "Y"], 1)
    left = [
        np.linalg.norm(Y - c @ np.linalg.lstsq(c, Y, rcond=None)[0])
        for c in (modulus, np.hstack([modulus, cubic]))
    ]
    assert left[1] < 0.01 * left[0]


def test_resistance_may_be_otherwise_about_every_speed_and_between_two_of_them_in_shares():
    """By hand: at 0.7 U_0 the terms about 0.6 and 0.8 U_0 count half; ahead and astern they push it the same
    way round; all of them together are one coefficient of the square of the speed."""
    zero, ahead = np.zeros(5), np.array([0.7, -0.7, 0.6, 1.0, 1.3])
    a = form.Along(zero, zero, zero, zero, zero, ahead)
    about = {name: term(a) for name, (_, _, term) in form.HULL.items() if name.startswith("X_at")}
    assert about["X_at_0.6_U"] == pytest.approx([0.5, -0.5, 1.0, 0.0, 0.0]) and about["X_at_0.8_U"][
        :2
    ] == pytest.approx([0.5, -0.5])
    assert sum(about.values())[:4] == pytest.approx([1.0, -1.0, 1.0, 1.0])


@pytest.mark.parametrize("label, sd", [("form.Y_vvv", 0.8), ("core.X_uuu", 0.05)])
def test_what_an_earlier_calibration_did_not_learn_of_the_form_is_none_and_not_anything(tanker, label, sd):
    unknowns = nuisance_unknowns(Model.of(tanker), {})
    stored = {
        k: v for k, v in tanker.notes["structural"].items() if k not in ("labels", "offset", "covariance")
    }
    keep = [i for i, name in enumerate(tanker.notes["structural"]["labels"]) if name != label]
    labels = [tanker.notes["structural"]["labels"][i] for i in keep]
    rest = {
        "labels": labels,
        "offset": np.array(tanker.notes["structural"]["offset"])[keep].tolist(),
        "covariance": np.array(tanker.notes["structural"]["covariance"])[np.ix_(keep, keep)].tolist(),
    }
    (i,) = [k for k, u in enumerate(unknowns) if u.label == label]
    assert unknowns[i].sd == sd
    for notes, width in ((stored | rest, 1e-3), ({}, 1.0)):
        known = from_ship(Model.of(replace(tanker, notes={**tanker.notes, "structural": notes})), unknowns)
        assert np.sqrt(np.linalg.inv(known.information)[i, i]) == pytest.approx(width)


def test_they_are_nuisance_and_change_no_model(sailed):
    t, model = sailed
    mine = [u for u in nuisance_unknowns(model, {}) if u.owner == "form"]
    assert mine == form_unknowns()
    A, R = columns(t, model, mine, {})
    assert A.shape == (len(t), 3, len(form.TERMS)) and R.shape == (len(t), 8, len(form.TERMS))


def test_the_rudder_of_a_ship_of_actuators_has_the_same_terms(sailed):
    """Test: the tanker's own propeller and rudder as an actuator. Expected: what they give as its own."""
    t, own = sailed
    d, ship = own.ship.derivatives, own.ship
    numbers = {"D": ship.D_P, "K_T0": d.K_T0, "K_T1": d.K_T1, "A_R": ship.A_R, "x": d.x_R * ship.L_pp}
    main = Actuator("main", "propeller", ("rate_rev_s", "angle_rad"), **numbers)
    parts = Model(replace(ship, actuators=(main,)), own.effects)
    told = replace(t, orders={"main.rate": t.n, "main.angle": t.delta})
    for name in form.RUDDER:
        assert form.accelerations(told, parts)[name] == pytest.approx(form.accelerations(t, own)[name])
        assert np.abs(form.accelerations(told, parts)[name]).max() > 0.0
