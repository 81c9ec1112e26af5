"""The tube around a prediction: judged by the instruments at their own time, of the right cell, corrected
slowly, and no part of what the twin believes."""

from math import degrees, exp, hypot, pi, radians

import pytest

from tests.live.prediction.tube_tables import N, with_tube
from twin.live.observer.estimate import Estimate
from twin.live.observer.predict import Prediction, Region, usual_error
from twin.live.prediction.calibrated import calibrated_of
from twin.live.prediction.circumstances import SEAS, Circumstances, Regressors, sea_of
from twin.live.prediction.coverage import coverage, entry
from twin.live.prediction.judge import Foretold, Judge, VerifiedPrediction, along_and_across
from twin.live.prediction.prediction_tube import GAIN, PredictionTube, inside
from twin.live.signals.measured import Measured
from twin.physics.ship import from_table, save, text, to_table

PHI = (1.0, 0.2, 0.1, 0.0, 0.3, 0.5, 0.0, 0.0)
KNOWN = Regressors(PHI, PHI, "still", "slight")


def foretold(state=(0.0, 0.0, 0.0, 7.0, 0.0, 0.0), due_s=100.0, start_s=40.0, region=None):
    return Foretold(start_s, start_s, due_s, state, KNOWN, region)


def heard(time_s, x, y, psi):
    return Measured(
        time_s + 0.3,
        {"x": x, "y": y, "psi": psi},
        {"x": 1.0, "y": 1.0, "psi": 1.0},
        time={"x": time_s, "psi": time_s},
    )


def judge_of(*samples):
    judge = Judge()
    for sample in samples:
        judge.hear(heard(*sample))
    return judge


def test_a_prediction_is_judged_on_the_line_between_two_samples_at_their_own_time():
    """Test: fixes of 99.6 and 100.6 s for a prediction of 100 s, at 7 m/s north. Expected: the place of 100 s,
    where the ship was; the heading the short way round north."""
    judge = judge_of((99.6, 697.2, 0.0, 2.0 * pi - 0.01), (100.6, 704.2, 0.0, 0.015))
    judged = judge.ask(foretold((705.0, 2.0, 0.01, 7.0, 0.0, 0.0)), 101.0, 0.0)
    assert judged.along == pytest.approx(5.0, abs=0.1) and judged.across == pytest.approx(1.95, abs=0.1)
    assert judged.heading == pytest.approx(0.01, abs=1e-9)


def test_it_waits_for_the_sample_of_its_time_but_not_for_ever():
    judge = judge_of((99.0, 0.0, 0.0, 0.0))
    assert judge.ask(foretold(), 99.5, 0.0) is False
    assert judge.ask(foretold(), 101.0, 0.0) is False
    assert judge.ask(foretold(), 106.0, 0.0) is None


def test_a_hole_in_the_fixes_judges_nothing():
    assert judge_of((97.0, 0.0, 0.0, 0.0), (100.5, 0.0, 0.0, 0.0)).ask(foretold(), 101.0, 0.0) is None


def test_a_heading_that_no_compass_measured_judges_nothing():
    judge = Judge()
    for t in (99.5, 100.5):
        measured = heard(t, 0.0, 0.0, 0.0)
        measured.derived = {"psi"}
        judge.hear(measured)
    assert judge.ask(foretold(), 101.0, 0.0) is False


def test_along_and_across_by_hand():
    """Test: predicted course east (heading 80 deg, 10 deg of drift to starboard), 3 m too far east, 4 m too
    far north. Expected: 3 m ahead, 4 m to port."""
    speed = (5.0 * pi / pi, 5.0 * 0.17632698)  # tan 10 deg
    along, across = along_and_across((14.0, 23.0, radians(80.0), *speed, 0.0), (10.0, 20.0))
    assert (along, across) == (pytest.approx(3.0), pytest.approx(-4.0))


def test_a_helm_that_moved_meanwhile_is_not_held():
    judge = judge_of((99.5, 0.0, 0.0, 0.0), (100.5, 7.0, 0.0, 0.0))
    assert judge.ask(foretold(start_s=40.0), 101.0, 39.0).held
    assert not judge.ask(foretold(start_s=40.0), 101.0, 55.0).held


def test_small_corrections_hold_the_helm_and_a_helm_order_or_engine_order_does_not(kvlcc2):
    """Test: rudder noise of 2 deg, then 8 deg of helm, then the engine to half. Expected: moved at each of the
    two orders only; the regime is `moving` for L/U after that."""
    c, e = Circumstances(kvlcc2), Estimate(u=7.0, ready=True, sigma=(1.0,) * 6)
    shaft = 1.2
    moved = []
    for k in range(3000):
        delta = radians((2.0 if k % 2 else -0.5) + (8.0 if k >= 1000 else 0.0))
        measured = Measured(0.1 * k, {"delta": delta, "n": shaft * (0.5 if k >= 2000 else 1.0)})
        c.step(0.1 * k, measured, True)
        moved.append(c.moved_s)
    assert sorted(set(moved)) == [0.0, 100.0, 200.0]
    p = Prediction(60.0, (0.0,) * 6, (1.0,) * 6, 2.0, "learned")
    at = {t: c.known(t, e, Measured(t), p, (1.0, 0.1)).helm for t in (201.0, 200.0 + 320.0 / 7.0 + 1.0)}
    assert list(at.values()) == ["moving", "still"]


def test_what_is_known_by_hand(kvlcc2):
    c = Circumstances(kvlcc2)
    c.moved_s = 100.0
    e = Estimate(u=8.0, v=0.0, r=0.01, ready=True, sigma=(6.0, 6.0, 0.02, 0.1, 0.1, 1e-3))
    measured = Measured(140.0, {"delta": -0.2, "H_s": 1.6, "wind_speed": 12.0})
    p = Prediction(60.0, (0.0,) * 6, (20.0, 20.0, 0.05, 0.1, 0.1, 1e-3), 2.0, "learned")
    known = c.known(140.0, e, measured, p, (10.0, 0.1))
    assert known.place == pytest.approx((1.0, 0.4, 0.2, exp(-1.0), 0.5, 1.5, 0.693147, 0.693147), abs=1e-6)
    assert known.heading[6:] == pytest.approx((0.693147, -0.693147), abs=1e-6)
    assert (known.helm, known.sea) == ("still", "rough")
    assert [sea_of(H_s, 320.0) for H_s in (None, 0.4, 1.0, 3.0)] == list(SEAS)


def test_nothing_is_settled_before_five_ship_lengths(kvlcc2):
    c, need_s = Circumstances(kvlcc2), 5.0 * kvlcc2.L_pp / kvlcc2.U_0
    c.step(10.0, Measured(10.0), True)
    assert not c.settled(10.0 + need_s - 1.0) and c.settled(10.0 + need_s)
    c.step(400.0, Measured(400.0), False)
    c.step(401.0, Measured(401.0), True)
    assert not c.settled(402.0)


def test_the_table_by_hand(kvlcc2):
    """Test: across grows with the waves, the regime `still_slight` has its own quantiles. Expected: sigma by
    the formula, its cell here and the parent's elsewhere, quantiles on the line between two levels."""
    across = [0.0] * N
    across[4] = 2.0
    own = {"voyages": 9, "place": [3.0], "heading": [3.0]}
    calibrated = calibrated_of(with_tube(kvlcc2, across_60s=across, cell_60s_still_slight=own))
    along, aside, turning = calibrated.sigmas(60.0, KNOWN, (10.0, 0.1))
    assert (along, aside, turning) == pytest.approx((10.0, 10.0 * exp(0.6), 0.1))
    assert calibrated.cell(60.0, KNOWN)[0] == "still_slight"
    assert calibrated.cell(60.0, KNOWN._replace(helm="moving"))[0] == "all"
    place = calibrated.horizons[60.0].cells["all"].place
    asked = [calibrated.quantile(place, p) for p in (0.5, 0.85, 0.9, 0.93, 0.999)]
    assert asked == pytest.approx([1.0, 1.5, 2.0, 3.0, 4.0])


def test_few_voyages_promise_the_best_they_can_show(kvlcc2):
    cells = {f"cell_{h}s_all": {"voyages": 3, "place": [5.0], "heading": [5.0]} for h in (10, 60, 120)}
    calibrated = calibrated_of(with_tube(kvlcc2, **cells))
    cell = calibrated.horizons[10.0].cells["all"]
    assert calibrated.promise(cell) == 0.75 and calibrated.quantile(cell.place, 0.9) == 5.0


def test_beyond_the_references_nothing_is_promised(kvlcc2):
    calibrated = calibrated_of(with_tube(kvlcc2))
    waves = (*KNOWN.place[:4], 9.0, *KNOWN.place[5:])
    assert calibrated.beyond(KNOWN) == ""
    assert "wave height" in calibrated.beyond(KNOWN._replace(place=waves, sea="rough"))
    assert "not known" in calibrated.beyond(KNOWN._replace(sea="unknown"))


def test_a_ship_file_without_a_tube_stays_as_it_is(kvlcc2):
    assert PredictionTube(kvlcc2).table is None
    assert text(to_table(from_table(to_table(kvlcc2)))) == text(to_table(kvlcc2))


def test_a_tube_of_another_model_is_not_used_and_it_is_said(kvlcc2):
    tube = PredictionTube(with_tube(kvlcc2, model="0123456789abcdef"))
    assert tube.table is None and "twin tube" in tube.why_not


def judged_at(along, heading, region):
    return VerifiedPrediction(foretold(region=region), along, 0.0, heading, True)


def region_of(along, across, heading):
    return Region(along, across, heading, 0.0, 0.9, 20, "all", "calibrated")


def test_inside_is_inside_the_ellipse():
    region = region_of(4.0, 2.0, 0.1)
    j = VerifiedPrediction(foretold(region=region), 2.0, 1.9, 0.05, True)
    assert inside(j) == (False, True) and inside(j._replace(across=1.7)) == (True, True)


def test_the_correction_is_slow_in_the_right_direction_and_bounded(kvlcc2):
    """Test: every prediction outside, then every one inside. Expected: a falls (a wider tube) by g (a_0 - 1) a
    time, not below a_0/3; then rises, not above 2 a_0."""
    tube = PredictionTube(with_tube(kvlcc2))
    tube._correct(10.0, (False, True))
    assert tube._a[10.0, "place"] == pytest.approx(0.1 - 0.9 * GAIN)
    assert tube._a[10.0, "heading"] == pytest.approx(0.1 + 0.1 * GAIN)
    for _ in range(100):
        tube._correct(10.0, (False, False))
    assert tube._a[10.0, "place"] == pytest.approx(0.1 / 3.0)
    for _ in range(1000):
        tube._correct(10.0, (True, True))
    assert tube._a[10.0, "place"] == pytest.approx(0.2)
    assert tube.counted[10.0] == (1101, 1000, 1001)


def test_coverage_width_and_interval_score_by_hand():
    """An ellipse of 4 m by 1 m; errors of 2 m ahead (inside) and 6 m (1.5 times out): 2 m and 2 + 10 m."""
    region = region_of(4.0, 1.0, 0.1)
    found = coverage(60.0, [entry(judged_at(along, 0.05, region), region) for along in (2.0, 6.0)])
    assert (found.place_inside, found.heading_inside, found.judged) == (0.5, 1.0, 2)
    assert found.place_radius_m == 2.0 and found.place_score_m == pytest.approx((2.0 + 12.0) / 2.0)
    assert found.heading_score_deg == found.heading_deg == pytest.approx(degrees(0.1))


def test_the_loop_of_the_service_says_the_tube_and_believes_the_same_without_it(
    make_service, kvlcc2, tmp_path
):
    """Test: the loop that the service builds, certificate, network and adaptation on, with and without a
    [tube]. Expected: the same estimates, forces and predictions to the last bit; the tube at every horizon,
    without a promise until the observer has settled, then with one; each horizon judged once in its time."""
    save(with_tube(kvlcc2, seas=["slight"]), tmp_path / "ship.toml")
    steady = {"helm_deg": lambda t: 0.0, "H_s": 0.1}
    plain, said = (
        make_service(**steady),
        make_service(settings={"ship.file": str(tmp_path / "ship.toml")}, **steady),
    )
    without, ticks = plain.run(260.0), said.run(260.0)
    for a, b in zip(without, ticks, strict=True):
        for p in b.predictions:
            p.ClearField("tube")
        assert a.estimate == b.estimate and list(a.known) == list(b.known) and a.learned == b.learned
        assert list(a.predictions) == list(b.predictions) and a.certificate == b.certificate
    assert not any(p.HasField("tube") for t in without for p in t.predictions)
    counted = said.loop.tube.counted
    assert 4 <= counted[10.0].judged <= 6 and counted[120.0].judged == 0
    region = said.loop.tube.around(
        said.now_s, said.loop.last.measured, said.loop.observer.estimate,
        [Prediction(60.0, (0.0, 0.0, 0.0, 7.0, 0.0, 0.0), (1.0,) * 6, 2.0, "learned")], True,
    )[0].region  # fmt: skip
    usual = usual_error(kvlcc2, 60.0)
    assert region.level == 0.9 and region.voyages == 20 and region.status == "calibrated"
    assert hypot(region.along_m, region.across_m) == pytest.approx(2.0 * 2.0**0.5 * usual[0], rel=0.05)


def test_the_message_holds_what_is_promised_and_why_nothing_is(make_service, kvlcc2, tmp_path):
    save(with_tube(kvlcc2, seas=["slight"]), tmp_path / "ship.toml")
    service = make_service(
        settings={"ship.file": str(tmp_path / "ship.toml")}, helm_deg=lambda t: 0.0, H_s=0.1
    )
    first = next(t for t in service.run(20.0) if t.predictions).predictions[0].tube
    assert first.level == 0.0 and "settled" in first.status and first.along_m > 0.0
    service.loop.tube.circumstances._good_s = 0.0
    later = [t for t in service.run(5.0) if t.predictions][-1].predictions
    assert [p.tube.level for p in later] == [0.9] * 3 and later[0].tube.regime == "all"
    assert later[0].tube.course_deg == pytest.approx(later[0].state.heading_true_north_deg, abs=2.0)
