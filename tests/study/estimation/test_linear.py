"""A track that is linearised: its tangents are the innovations' own, also of instruments that are wrong or late."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.study.estimation.columns import core_unknowns, with_values
from twin.study.estimation.fit import fit
from twin.study.estimation.innovations import NoiseModel, innovate
from twin.study.estimation.linear import linearise
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.estimation.respond import later
from twin.study.reference.structure import noise_model_of
from twin.study.track.smooth_motion import smooth_motion


def test_tangents_say_what_a_changed_model_would_leave_over(judged):
    """Misfit at theta predicted from A and b against the misfit of a model that was really changed."""
    t, model, unknowns = judged
    known, floor = catalogue(), NoiseModel()
    A, b, ee = innovate([linearise(t, model, unknowns, known)], [floor])[0].total()
    theta = np.zeros(len(unknowns))
    theta[[1, 4]] = 0.004, 0.002  # a number of the core, and the compass
    changed = with_values(
        model, unknowns, [u.centre + d for u, d in zip(unknowns, theta, strict=True)], known
    )
    _, _, really = innovate([linearise(t, changed, unknowns, known)], [floor])[0].total()
    predicted = ee - 2.0 * float(b @ theta) + float(theta @ A @ theta)
    assert really != pytest.approx(ee, rel=1e-3)
    assert predicted == pytest.approx(really, rel=5e-3)


def test_what_numbers_push_beside_the_smooth_motion_is_what_they_push_there(judged):
    """Test: a motion that is off by 3 degrees, by 0.1 m/s ahead and abeam and by 0.01 deg/s; what derivatives
    and a wind push along it. Expected: what they push along the smooth motion and, by its slopes, beside it,
    within a tenth of the difference. Of a model without a late reading, which would be taken out of the motion
    by the measured way."""
    t, model = judged[0], Model(judged[1].ship, ())
    t = replace(t, weather=t.weather | {"wind_speed": np.full(len(t), 12.0), "wind_to": np.full(len(t), 0.7)})
    off, known = np.array([0.05, 0.1, 0.1, 2e-4]), catalogue()
    unknowns = [
        *(u for u in core_unknowns(model) if u.name in ("Y_uv", "N_ur", "N_vv", "C_L")),
        *effect_unknowns(known["Wind"], model),
    ]
    other = replace(t, state=t.state + np.concatenate([[0.0, 0.0], off]))
    line, there = (linearise(x, model, unknowns, known, exact=True) for x in (t, other))
    sd = np.array([u.sd for u in unknowns])
    change, told = (there.A - line.A) * sd, np.einsum("kaip,i->kap", line.bends[:, :, :4], off) * sd
    for j, unknown in enumerate(unknowns):
        assert np.abs(told - change)[..., j].max() < 0.1 * np.abs(change)[..., j].max(), unknown.label


def test_a_fit_that_is_begun_far_off_arrives_where_one_does_that_is_begun_near(judged):
    """Test: a hull and a rudder begun three prior widths from the ship file's. Expected: found within a tenth
    of one."""
    t, model, _ = judged
    unknowns, known = (
        [u for u in core_unknowns(model) if u.name in ("Y_uv", "Y_ur", "N_uv", "N_ur", "C_L")],
        catalogue(),
    )
    far = with_values(
        model,
        unknowns,
        [u.centre + k * u.sd for u, k in zip(unknowns, (3.0, -3.0, 3.0, -3.0, 3.0), strict=True)],
        known,
    )
    near_by, far_off = (
        fit([t], begun, unknowns, known, noise_model_of(model.ship)) for begun in (model, far)
    )
    assert np.abs((far_off.value - near_by.value) / [u.sd for u in unknowns]).max() < 0.1
    assert np.abs((far_off.value - near_by.value) / near_by.sd).max() < 1.0


@pytest.mark.parametrize("late_s", [2.0, 6.0])
def test_how_late_positions_are_is_told_however_rough_the_path_through_them(judged, late_s):
    """Test: positions with 0.1 m of scatter and so late, a log with 2 cm/s, asked where the receiver is that
    late. Expected: there it stays, within three standard errors (the path alone, which holds a little of that
    scatter, would move it by five)."""
    t, model, _ = judged
    rng = np.random.default_rng(5)
    before = np.minimum(t.t - late_s, 0.0)  # it sailed straight
    place = np.column_stack(
        [np.interp(t.t - late_s, t.t, x) + before * (x[1] - x[0]) / t.h for x in t.state[:, :2].T]
    )
    log = t.state[:, 3:5] + 0.02 * rng.standard_normal((len(t), 2))
    shown = np.column_stack(
        [
            place + 0.1 * rng.standard_normal(place.shape),
            t.state[:, 2],
            np.full((len(t), 2), np.nan),
            t.state[:, 5],
            log,
        ]
    )
    state, sd = smooth_motion(shown, t.h, model.ship)
    unknowns = [u for u in effect_unknowns(catalogue()["SensorDelay"], model) if u.name == "delay"]
    late = model.but(catalogue()["SensorDelay"].absent(model.ship).but(delay=late_s))
    line = linearise(
        replace(t, measured=shown, state=state, sd=sd),
        late,
        unknowns,
        catalogue(),
        {unknowns[0].label: late_s},
    )
    A, b, _ = innovate([line], [noise_model_of(model.ship)])[0].total()
    assert abs(float(b[0] / A[0, 0])) < 3.0 / float(A[0, 0]) ** 0.5


def test_what_a_late_receiver_showed_of_before_its_first_step_says_nothing(judged):
    """Test: positions that stand 50 m aside for two steps, as of a receiver that has no older ones to show, judged
    about one that is late by two steps and about a prompt one. Expected: the first sees none of it, the other
    does."""
    t, model, _ = judged
    aside = t.measured.copy()
    aside[:2, :2] += 50.0
    kind = catalogue()["SensorDelay"]
    for delay, alike in ((2.0 * t.h, True), (0.0, False)):
        m = model.but(kind.absent(model.ship).but(delay=delay))
        e, other = (linearise(replace(t, measured=x), m, [], catalogue()).e for x in (t.measured, aside))
        assert np.array_equal(e, other, equal_nan=True) == alike


def test_to_call_a_receiver_late_that_is_not_explains_nothing(judged):
    """Test: positions with 0.3 m of scatter that are in time, judged about a receiver that is late by whole
    steps. Expected: the best that any lateness makes of them is no better than without (a path that runs
    ahead of its own scatter would gain a hundred nats)."""
    t, model, _ = judged
    shown = t.measured.copy()
    shown[:, :2] = t.state[:, :2] + 0.3 * np.random.default_rng(7).standard_normal((len(t), 2))
    state, sd = smooth_motion(shown, t.h, model.ship)
    unknowns, best = [u for u in effect_unknowns(catalogue()["SensorDelay"], model) if u.name == "delay"], []
    for steps in (0, 1, 2):
        late = (
            model.but(catalogue()["SensorDelay"].absent(model.ship).but(delay=steps * t.h))
            if steps
            else model
        )
        line = linearise(
            replace(t, measured=shown, state=state, sd=sd),
            late,
            unknowns,
            catalogue(),
            {unknowns[0].label: steps * t.h},
        )
        told = innovate([line], [noise_model_of(model.ship)])[0]
        A, b, ee = told.total()
        best.append(-0.5 * (ee + float(told.logdet.sum())) + 0.5 * float(b[0] ** 2 / A[0, 0]))
    # at the end a row of the readings stands twice, another at the beginning not at all
    assert max(best[1:]) < best[0] + 6.0


def test_a_fault_of_an_instrument_that_one_voyage_lacks_says_nothing_there(judged):
    t, model, _ = judged
    log = catalogue()["SpeedLogScale"]
    unknowns, faulty = effect_unknowns(log, model), model.but(log.absent(model.ship).but(scale=0.05))
    with_log = linearise(t, faulty, unknowns, catalogue(), {unknowns[0].label: 0.05})
    silent = linearise(
        replace(t, measured=np.where(np.arange(8) < 6, t.measured, np.nan)), model, unknowns, catalogue()
    )
    alone, both = (
        innovate(lines, [NoiseModel()])[0].total()[0][0, 0] for lines in ([with_log], [silent, with_log])
    )
    assert with_log.turns and not silent.turns and both == pytest.approx(alone, rel=1e-6) and alone > 0.0


def test_until_the_core_is_found_faults_of_instruments_are_judged_along_the_smooth_path(judged):
    """Test: a fit with a turned compass in the model, as calibration asks and as adding an effect does.
    Expected: the filter's path has a say in the second alone."""
    t, model, unknowns = judged
    fitted = [
        fit([t], model, unknowns[-2:], catalogue(), NoiseModel(), smooth=smooth) for smooth in (True, False)
    ]
    assert [bool(f.lines[0].turns) for f in fitted] == [False, True]


def test_a_late_receiver_shows_a_wave_as_it_was_then_on_each_stretch_by_itself(judged):
    t, *_ = judged
    late_s, omega = 2.0, 2.0 * np.pi / 6.0
    moments = t.t[np.r_[0:200, 300:500]]
    part = t.where(np.r_[0:200, 300:500])
    shown = np.column_stack([np.sin(omega * moments)] * 8)
    then = later(part, shown, late_s)
    # compass, gyro and log are in time
    np.testing.assert_array_equal(then[:, [2, 5, 6, 7]], shown[:, [2, 5, 6, 7]])
    settled = np.r_[5:200, 205:400]
    # straight lines between steps of 1.25 s
    assert np.abs(then[settled, 0] - np.sin(omega * (moments[settled] - late_s))).max() < 0.25
    assert np.abs(then[:, 0]).max() < 3.0  # before a stretch begins, along a straight line
    assert later(part, shown, 0.0) is shown


@pytest.mark.parametrize("late_s", [3.0, -3.0])
def test_beyond_its_ends_a_late_place_turns_on_as_the_ship_did(judged, late_s):
    """Test: a circle at 4 m/s and 0.05 rad/s, shown 3 s late and 3 s early. Expected: on the circle all the way, to
    4 cm; a straight line would leave it by 0.8 m."""
    t, *_ = judged
    part = t.part(0, 200)
    turned = 0.05 * part.t
    shown = np.zeros((200, 8))
    shown[:, 0], shown[:, 1], shown[:, 5] = 80.0 * np.sin(turned), -80.0 * np.cos(turned), 0.05
    then = later(part, shown, late_s)
    assert np.abs(np.hypot(then[:, 0], then[:, 1]) - 80.0).max() < 0.05
