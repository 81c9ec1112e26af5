"""The filter: floors side by side are floors one at a time, and what a floor holds."""

from dataclasses import replace

import numpy as np
import pytest

from tests.thorough import thorough
from twin.errors import SettingsError
from twin.physics.effects import catalogue
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.innovations import NoiseModel, innovate, innovate_each
from twin.study.estimation.linear import linearise
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.estimation.respond import standard
from twin.study.reference.structure import noise_model_of, structural_noise, structural_noise_beside
from twin.study.track.segments import read_parts, segments
from twin.study.track.track import READINGS, track


def test_floors_side_by_side_are_floors_one_at_a_time(judged):
    t, model, unknowns = judged
    lines = [linearise(t, model, unknowns, catalogue())]
    floors = [NoiseModel(), NoiseModel().scaled(4.0, white=2.0)]
    together = innovate(lines, floors)
    for floor, both in zip(floors, together, strict=True):
        alone = innovate(lines, [floor])[0]
        np.testing.assert_allclose(both.A, alone.A, rtol=1e-9)
        np.testing.assert_allclose(both.logdet, alone.logdet, rtol=1e-9)


def test_groups_of_lines_side_by_side_are_as_each_alone(judged, monkeypatch):
    """Test: three groups, of one voyage, of two halves and of the voyage again, two of them side by side.
    Expected: each as it is alone, and no more asked for than are filtered together."""
    t, model, unknowns = judged
    whole = linearise(t, model, unknowns, catalogue())
    halves = [linearise(t.part(*cut), model, unknowns, catalogue()) for cut in ((0, 700), (700, len(t)))]
    groups, floors, asked = [[whole], halves, [whole]], [NoiseModel(), NoiseModel().scaled(4.0)], []
    count = len(segments([t], float(model.ship.scale("time"))))
    monkeypatch.setattr("twin.study.estimation.innovations.ABREAST", count + 1)

    def generated():
        for group in groups:
            asked.append(group)
            yield group

    each = innovate_each(generated(), floors)
    for k, (group, normals) in enumerate(zip(groups, each, strict=True)):
        assert len(asked) == (2, 2, 3)[k]
        for normal, alone in zip(normals, innovate(group, floors), strict=True):
            np.testing.assert_allclose(normal.A, alone.A, rtol=1e-6)
            np.testing.assert_allclose(normal.ee, alone.ee, rtol=1e-6)
            assert np.array_equal(normal.count, alone.count)


def test_where_a_segment_has_no_reading_nothing_is_corrected_and_the_others_are_as_ever(judged):
    """Test: every second step read, of one segment the even ones and of the others the odd ones, so that at each
    step some have nothing. Expected: each as it is alone, where its steps have either all or none."""
    t, model, unknowns = judged
    where = segments([t], float(model.ship.scale("time")))
    shown, read = t.measured.copy(), np.arange(len(t)) % 2 == 0
    for i, (_, a, b) in enumerate(where):
        shown[a:b][read[a:b] == bool(i % 2)] = np.nan
    sparse = replace(t, measured=shown)
    together = innovate([linearise(sparse, model, unknowns, catalogue())], [NoiseModel()])[0]
    assert 0 < together.count.sum() < 0.6 * np.isfinite(t.measured).sum()
    for i, (_, a, b) in enumerate(where):
        only = replace(sparse, whole=sparse.whole & (np.arange(len(t)) >= a) & (np.arange(len(t)) < b))
        alone = innovate([linearise(only, model, unknowns, catalogue())], [NoiseModel()])[0]
        np.testing.assert_allclose(alone.A[0], together.A[i], rtol=1e-5, atol=1e-5 * alone.A.max())
        assert alone.ee[0] == pytest.approx(together.ee[i], rel=1e-5)
        assert alone.logdet[0] == pytest.approx(together.logdet[i], rel=1e-9)


def test_readings_that_no_voyage_has_change_nothing(judged, monkeypatch):
    """Test: without a log, filtered with the six readings that there are and with two empty ones beside them."""
    t, model, unknowns = judged
    shown = t.measured.copy()
    shown[:, 6:] = np.nan
    lines = [linearise(replace(t, measured=shown), model, unknowns, catalogue())]
    six = innovate(lines, [NoiseModel()])[0]
    monkeypatch.setattr("twin.study.estimation.innovations._rows", lambda lines: np.arange(8))
    eight = innovate(lines, [NoiseModel()])[0]
    np.testing.assert_allclose(six.A, eight.A, rtol=1e-5, atol=1e-5 * eight.A.max())
    np.testing.assert_allclose(six.energy, eight.energy, rtol=1e-5)
    assert six.energy.shape == (len(six.where), 8) and not six.energy[:, 6:].any()
    np.testing.assert_allclose(six.logdet, eight.logdet, rtol=1e-9)


def test_innovations_of_a_calibrated_ship_are_no_larger_than_promised(judged):
    t, model, unknowns = judged
    normal = innovate([linearise(t, model, unknowns, catalogue())], [noise_model_of(model.ship)])[0]
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
    found = structural_noise(
        [linearise(strayed, model, unknowns, catalogue())], unknowns, noise_model_of(model.ship)
    ).wander
    assert found < 0.03 if wander == 0.0 else found == pytest.approx(wander, rel=0.35)


@pytest.mark.parametrize("wander", [0.0, 2e-3])
def test_how_far_the_heading_that_a_compass_shows_strays_is_found(judged, wander):
    """Test: a heading with white noise of 0.1 deg, and one that strays by 0.11 deg in a second, 0.9 in a minute,
    beside a gyro that does not. Expected: found within a third."""
    t, model, unknowns = judged
    rng, sd = np.random.default_rng(7), np.radians(0.1)
    steps = wander * np.sqrt(t.h) * rng.standard_normal(len(t))
    shown = t.measured.copy()
    shown[:, 2] = t.state[:, 2] + sd * rng.standard_normal(len(t)) + np.cumsum(steps)
    strayed = replace(t, measured=shown, sd=np.r_[t.sd[:2], sd, t.sd[3:]])
    found = structural_noise(
        [linearise(strayed, model, unknowns, catalogue())], unknowns, noise_model_of(model.ship)
    ).heading_wander
    assert found < 4e-4 if wander == 0.0 else found == pytest.approx(wander, rel=0.35)


@thorough
def test_a_receiver_that_errs_moves_the_place_that_it_shows(judged):
    """Test: a place and a velocity over ground with one error of 0.15 m/s that lasts 8 s. Expected: the ship is not
    tossed by it, and what errs is found within half."""
    t, model, unknowns = judged
    rng, left = np.random.default_rng(7), np.exp(-t.h / 8.0)
    error = np.zeros((len(t), 2))
    for k in range(1, len(t)):
        error[k] = left * error[k - 1] + 0.15 * np.sqrt(1.0 - left**2) * rng.standard_normal(2)
    c, s = np.cos(t.state[:, 2]), np.sin(t.state[:, 2])
    shown = t.measured.copy()
    shown[:, :2] += np.cumsum(error, axis=0) * t.h
    shown[:, 3] += c * error[:, 0] + s * error[:, 1]
    shown[:, 4] += c * error[:, 1] - s * error[:, 0]
    erring = replace(t, measured=shown)
    start = noise_model_of(model.ship)
    found = structural_noise([linearise(erring, model, unknowns, catalogue())], unknowns, start)
    speed = float(model.ship.scale("speed"))
    assert found.velocity_error * speed == pytest.approx(0.15, rel=0.5)
    assert max(found.white[:2]) < 4.0 * max(start.white[:2])


def test_a_damaged_floor_in_the_ship_file_is_one_line(tanker):
    table = {**tanker.notes["structural"], "floor": {**tanker.notes["structural"]["floor"], "wander": "far"}}
    with pytest.raises(
        SettingsError,
        match=r"\[structural\] floor in the ship file is damaged "
        r".*'far'.*Calibrate it again",
    ):
        noise_model_of(replace(tanker, notes={**tanker.notes, "structural": table}))


def test_a_floor_of_one_fast_part_is_that_of_every_axis(tanker):
    """Test: ship files of before 2026-11-24 hold one number. Expected: the same floor as three alike."""
    stored = dict(tanker.notes["structural"]["floor"])
    one, three = (
        noise_model_of(replace(tanker, notes={"structural": {"floor": stored | {"white": white}}}))
        for white in (0.1, [0.1, 0.1, 0.1])
    )
    assert one == three and one.white == (0.1, 0.1, 0.1)


@thorough
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
        structural_noise_beside([linearise(x, model, unknowns, catalogue())], unknowns, NoiseModel())
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


def test_a_force_that_comes_and_goes_is_noise_as_large_as_the_force(judged):
    """Test: half of the fast part of the noise model's variance as a force that is the same all voyage.
    Expected: the normal equations of the whole fast part."""
    t, model, unknowns = judged
    line = linearise(t, model, unknowns, catalogue())
    whole = NoiseModel(white=(0.1, 0.06, 0.04))
    half = replace(whole, white=tuple(np.sqrt(0.5) * np.array(whole.white)))
    force = np.sqrt(0.5) * np.array(whole.white) * standard(model)
    expected = innovate([line], [whole])[0]
    said = innovate([replace(line, fitful=np.tile(force, (len(t), 1)))], [half])[0]
    np.testing.assert_allclose(said.A, expected.A, rtol=1e-6)
    np.testing.assert_allclose(said.logdet, expected.logdet, rtol=1e-6)
