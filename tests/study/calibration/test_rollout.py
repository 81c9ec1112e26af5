"""The core is led to where the ship went: from a wrong one it finds its way, and stays inside what ships
have."""

from dataclasses import replace

import numpy as np
import pytest

from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation
from twin.study.calibration.rollout import HORIZON, PathProblem, rolled_out
from twin.study.estimation.columns import core_unknowns
from twin.study.prediction.openloop import coarse, coarse_each
from twin.study.prediction.trial import shaft_speed
from twin.study.track.track import READINGS, Track

NAMES = ("N_ur", "N_vr", "X_uu", "a_H", "Y_uv")


def sailed(model: Model, lengths: float = 40.0) -> Track:
    """A zigzag of this model, measured without a fault."""
    time = float(model.ship.scale("time"))
    h, steps = time / 12.0, int(lengths * 12)
    state, side, states, rudder = (0.0, 0.0, 0.0, 0.9 * float(model.ship.U_0), 0.0, 0.0), 1.0, [], []
    n = shaft_speed(model, float(model.ship.U_0))
    for _ in range(steps):
        side = -side if side * state[2] > 0.35 else side
        states.append(state)
        rudder.append(0.35 * side)
        state = model.step(state, Situation(delta=0.35 * side, n=n), h)
    path = np.array(states)
    measured = np.full((steps, len(READINGS)), np.nan)
    measured[:, :6] = path
    return Track(
        "z",
        h * np.arange(steps),
        h,
        path,
        np.array(rudder),
        np.full(steps, n),
        {},
        measured,
        np.full(8, 0.01),
        np.ones(steps, bool),
    )


def miss(track: Track, model: Model) -> float:
    time = float(model.ship.scale("time"))
    return float(np.nanmean(np.hypot(*coarse(track, model, HORIZON * time, 1, time).off()[-1, :, :2].T)))


@pytest.fixture(scope="module")
def true():
    return Model.of(load("kvlcc2"))


def test_a_core_that_is_15_percent_off_is_led_back_to_the_path(true):
    track = sailed(true)
    off = {
        name: getattr(true.ship.derivatives, name) * factor
        for name, factor in zip(NAMES, (0.85, 1.15, 1.15, 0.85, 0.85), strict=True)
    }
    wrong = Model(true.ship.with_derivatives(**off))
    unknowns = [u for u in core_unknowns(wrong) if u.name in NAMES]
    found = rolled_out([track], wrong, unknowns, {})
    assert miss(track, found) < 0.25 * miss(track, wrong)
    for u in unknowns:
        assert u.lo <= getattr(found.ship.derivatives, u.name) <= u.hi


def test_a_core_that_predicts_well_stays_where_it_is(true):
    track = sailed(true)
    unknowns = [u for u in core_unknowns(true) if u.name in NAMES]
    found = rolled_out([track], true, unknowns, {})
    moved = [abs(getattr(found.ship.derivatives, u.name) - u.centre) / u.sd for u in unknowns]
    assert max(moved) < 0.3 and miss(track, found) <= 1.05 * miss(track, true) + 0.05


@pytest.mark.parametrize("every", [120, 90, 60])
def test_what_was_not_measured_makes_no_error_smaller(true, every):
    """Test: a break in the controls every so many steps, so that up to most of the predictions cannot be judged, and
    no log. Expected: the error along the track that is usual on the whole one; what was not measured is no error."""
    track = sailed(true, 80.0)
    wrong = Model(true.ship.with_derivatives(X_uu=0.7 * float(true.ship.derivative("X_uu"))))
    unknowns = [u for u in core_unknowns(wrong) if u.name in NAMES]
    measured = track.measured.copy()
    measured[:, 3] = np.nan
    broken = replace(track, measured=measured, whole=np.arange(len(track)) % every > 5)
    whole, holed = (PathProblem([t], wrong, unknowns, {}) for t in (track, broken))
    z = np.zeros(len(unknowns))
    for problem in (whole, holed):
        problem.weigh(z)
    np.testing.assert_allclose(holed.scale[:, 0], whole.scale[:, 0], rtol=0.25)
    off = holed.off(z)
    assert np.isnan(off[:, -1, 0]).mean() > 0.25 and np.isnan(off[..., 3]).all()
    residual = holed.residual(z).reshape(off.shape)
    assert (residual[np.isnan(off)] == 0.0).all() and np.abs(residual).max() < 8.0


def test_a_number_at_the_end_of_its_box_is_its_end_to_the_bit(true):
    """An end in widths of a prior is a rounding error off, and no ship file may hold what lies outside."""
    (own,) = (u for u in core_unknowns(true) if u.name == "X_udot")
    own = replace(own, centre=-0.0127, sd=0.003)
    problem = PathProblem([], true, [own], {})
    assert problem.centre + problem.sd * problem.box[1] > own.hi
    assert problem.values(problem.box[1]) == [own.hi]


def test_windows_begin_only_where_they_may_and_perhaps_nowhere():
    model = Model.of(load("kvlcc2"))
    t = sailed(model)
    late = np.arange(len(t)) > len(t) // 2
    some, every, none = (
        coarse(t, model, 60.0, leads=1, begins=begins) for begins in (late, None, late & ~late)
    )
    assert (
        some.start.tolist() == [k for k in every.start if late[k]]
        and 0 < some.start.size < every.start.size
        and none.start.size == 0
    )
    np.testing.assert_array_equal(some.promised[0], every.promised[0][:, late[every.start]])


def test_predictions_of_many_cores_side_by_side_are_those_one_at_a_time():
    model, names = Model.of(load("kvlcc2")), NAMES[:3]
    track, time = sailed(model), float(model.ship.scale("time"))
    numbers = {n: np.linspace(0.8, 1.2, 4) * float(model.ship.derivative(n)) for n in names}
    together = Model(model.ship.with_derivatives(**{n: x[:, None] for n, x in numbers.items()}))
    found = coarse_each(track, together, 4, HORIZON * time, 3, time)
    for i, windows in enumerate(found):
        alone = Model(model.ship.with_derivatives(**{n: float(x[i]) for n, x in numbers.items()}))
        expected = coarse(track, alone, HORIZON * time, 3, time).off()
        np.testing.assert_allclose(windows.off(), expected, rtol=1e-9, atol=1e-12)
    assert np.nanmax(np.abs(found[0].off() - found[3].off())) > 1.0
