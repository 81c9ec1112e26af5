"""The filter: its tangents are the innovations' own, and floors side by side are floors one at a time."""

from dataclasses import replace

import numpy as np
import pytest

from twin.errors import SettingsError
from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.study.estimation.columns import core_unknowns, effect_unknowns, with_values
from twin.study.estimation.fit import fit
from twin.study.estimation.innovations import NoiseModel, innovate, linearise
from twin.study.estimation.respond import later
from twin.study.reference.structure import floor_of, structural_floor
from twin.study.track.segments import read_parts, segments
from twin.study.track.smooth_motion import smooth_motion
from twin.study.track.track import READINGS, track


@pytest.fixture(scope="module")
def judged(tanker, voyages):
    model = Model.of(tanker)
    unknowns = [*core_unknowns(model)[:4], *effect_unknowns(catalogue()["HeadingBias"], model)]
    return track(voyages["nothing"], tanker), model, unknowns


def test_tangents_say_what_a_changed_model_would_leave_over(judged):
    """Misfit at theta predicted from A and b against the misfit of a model that was really changed."""
    t, model, unknowns = judged
    known, floor = catalogue(), NoiseModel()
    A, b, ee = innovate([linearise(t, model, unknowns, known)], [floor])[0].total()
    theta = np.array([0.0, 0.004, 0.0, 0.0, 0.002, 0.0])
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
    within a tenth of the difference."""
    t, model, _ = judged
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
    near_by, far_off = (fit([t], begun, unknowns, known, floor_of(model.ship)) for begun in (model, far))
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
    A, b, _ = innovate([line], [floor_of(model.ship)])[0].total()
    assert abs(float(b[0] / A[0, 0])) < 3.0 / float(A[0, 0]) ** 0.5


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
        told = innovate([line], [floor_of(model.ship)])[0]
        A, b, ee = told.total()
        best.append(-0.5 * (ee + float(told.logdet.sum())) + 0.5 * float(b[0] ** 2 / A[0, 0]))
    assert max(best[1:]) < best[0] + 3.0


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


def test_floors_side_by_side_are_floors_one_at_a_time(judged):
    t, model, unknowns = judged
    lines = [linearise(t, model, unknowns, catalogue())]
    floors = [NoiseModel(), NoiseModel().scaled(4.0, white=2.0)]
    together = innovate(lines, floors)
    for floor, both in zip(floors, together, strict=True):
        alone = innovate(lines, [floor])[0]
        np.testing.assert_allclose(both.A, alone.A, rtol=1e-9)
        np.testing.assert_allclose(both.logdet, alone.logdet, rtol=1e-9)


def test_innovations_of_a_calibrated_ship_are_no_larger_than_promised(judged):
    t, model, unknowns = judged
    normal = innovate([linearise(t, model, unknowns, catalogue())], [floor_of(model.ship)])[0]
    assert 0.5 < normal.ee.sum() / normal.count.sum() < 1.6


@pytest.mark.parametrize("wander", [0.0, 0.1])
def test_how_far_the_position_that_satellites_show_strays_is_found(judged, wander):
    """Test: position with white noise, and with one that strays by 10 cm in a second, 77 cm in a minute.
    Expected: found within a third."""
    t, model, unknowns = judged
    rng = np.random.default_rng(7)
    steps = wander * np.sqrt(t.h) * rng.standard_normal((len(t), 2))
    shown = t.measured.copy()
    shown[:, :2] = t.state[:, :2] + 0.1 * rng.standard_normal((len(t), 2)) + np.cumsum(steps, axis=0)
    strayed = replace(t, measured=shown, sd=np.r_[0.1, 0.1, t.sd[2:]])
    found = structural_floor(
        [linearise(strayed, model, unknowns, catalogue())], unknowns, floor_of(model.ship)
    ).wander
    assert found < 0.03 if wander == 0.0 else found == pytest.approx(wander, rel=0.35)


def test_a_damaged_floor_in_the_ship_file_is_one_line(tanker):
    table = {**tanker.notes["structural"], "floor": {**tanker.notes["structural"]["floor"], "wander": "far"}}
    with pytest.raises(
        SettingsError,
        match=r"\[structural\] floor in the ship file is damaged "
        r".*'far'.*Calibrate it again",
    ):
        floor_of(replace(tanker, notes={**tanker.notes, "structural": table}))


def test_a_floor_of_one_fast_part_is_that_of_every_axis(tanker):
    """Test: ship files of before 2026-11-24 hold one number. Expected: the same floor as three alike."""
    stored = dict(tanker.notes["structural"]["floor"])
    one, three = (
        floor_of(replace(tanker, notes={"structural": {"floor": stored | {"white": white}}}))
        for white in (0.1, [0.1, 0.1, 0.1])
    )
    assert one == three and one.white == (0.1, 0.1, 0.1)


def test_each_axis_has_a_fast_part_of_its_own(judged):
    """Test: a place and a speed that swing by 8 cm and 5 cm/s about the path, a heading that does not.
    Expected: surge and sway are restless, and the yaw is trusted as before."""
    t, model, unknowns = judged
    rng, shown = np.random.default_rng(7), t.measured.copy()
    speed = 0.05 * rng.standard_normal((len(t), 2))
    shown[:, 3:5] = (
        t.state[:, 3:5]
        + np.cumsum(speed, axis=0)
        - np.column_stack([np.convolve(np.cumsum(s), np.ones(9) / 9, "same") for s in speed.T])
    )
    before, after = (
        structural_floor([linearise(x, model, unknowns, catalogue())], unknowns)
        for x in (t, replace(t, measured=shown))
    )
    assert min(after.white[:2]) > 3.0 * max(before.white[:2]) and after.white[2] <= 2.0 * before.white[2]


def test_a_hole_in_the_controls_ends_a_segment(judged):
    t, model, unknowns = judged
    line = linearise(t, model, unknowns, catalogue())
    whole = t.whole.copy()
    whole[300:310] = False
    broken = replace(line, track=replace(t, whole=whole))
    assert all(b <= 300 or a >= 310 for _, a, b in segments([broken.track], float(model.ship.scale("time"))))


@pytest.mark.parametrize("slow_gear", [False, True])
def test_what_the_filter_would_not_read_may_be_left_out(judged, slow_gear):
    """Of 1200 s (eight segments of a ship four times as quick) every other one is read; the gear remembers
    what came before."""
    t, model, unknowns = judged
    known, time_s = catalogue(), 0.25 * float(model.ship.scale("time"))
    if slow_gear:
        model = model.but(known["SteeringLag"](delay=1.0, travel_time=30.0))
    (part,) = read_parts([t], time_s, 4)
    assert len(part) < 0.8 * len(t) and part.whole.sum() < 0.6 * t.whole.sum()
    where = [(a, b) for _, a, b in segments([part], time_s)]
    assert [(part.steps()[a], part.steps()[b - 1] + 1) for a, b in where] == [
        (a, b) for _, a, b in segments([t], time_s, 4)
    ]
    whole, read = linearise(t, model, unknowns, known), linearise(part, model, unknowns, known)
    for (a, b), (_, first, last) in zip(where, segments([t], time_s, 4), strict=True):
        for name in ("F", "e", "A", "R", "busy"):
            theirs = getattr(whole, name)[first:last]
            np.testing.assert_allclose(
                getattr(read, name)[a:b], theirs, rtol=1e-3, atol=1e-3 * np.nanmax(np.abs(theirs))
            )


def test_a_voyage_that_is_read_whole_stays_as_it_is(judged):
    t, model, _ = judged
    assert read_parts([t], float(model.ship.scale("time")), 20)[0] is t


def test_a_track_holds_samples_and_invents_none(tanker, voyages):
    """The log speaks every half second, the grid is slower: every step has one; a silenced log has none."""
    whole = voyages["nothing"]
    columns = dict(whole.columns)
    columns["surge_velocity_through_water_mps"] = np.where(
        whole.time_s < 600.0, columns["surge_velocity_through_water_mps"], np.nan
    )
    t = track(type(whole)("half", whole.time_s, columns), tanker)
    seen = np.isfinite(t.measured[:, READINGS.index("u_r")])
    assert seen[t.t < 590.0].mean() > 0.9 and not seen[t.t > 605.0].any()


def test_a_turned_compass_that_is_known_costs_nothing(judged):
    """The same voyage with heading and speed over ground turned by a compass: under its own fault it is as
    probable as it was, also beside an antenna that is known to stand elsewhere."""
    t, model, _ = judged
    known, bias = catalogue(), 0.05
    antenna = known["AntennaOffset"].absent(model.ship).but(ahead=0.2 * model.ship.L_pp)
    compass = known["HeadingBias"].absent(model.ship).but(bias=bias, turned=bias)
    c, s = np.cos(bias), np.sin(bias)

    def turned(values, psi, u, v):
        out = values.copy()
        out[:, psi], out[:, u], out[:, v] = (
            values[:, psi] + bias,
            values[:, u] * c + values[:, v] * s,
            values[:, v] * c - values[:, u] * s,
        )
        return out

    through_it = replace(t, state=turned(t.state, 2, 3, 4), measured=turned(t.measured, 2, 3, 4))
    unknowns = [*core_unknowns(model), *effect_unknowns(known["GyroBias"], model)]
    straight = innovate([linearise(t, model.but(antenna), unknowns, known)], [NoiseModel()])[0]
    shown = innovate([linearise(through_it, model.but(compass, antenna), unknowns, known)], [NoiseModel()])[0]
    believed = innovate([linearise(through_it, model.but(antenna), unknowns, known)], [NoiseModel()])[0]
    A, b, ee = straight.total()
    for told, expected in zip(shown.total(), (A, b, ee), strict=True):
        np.testing.assert_allclose(told, expected, rtol=0.02, atol=1e-3 * np.abs(expected).max())
    assert float(believed.ee.sum()) > float(ee) + 20.0
