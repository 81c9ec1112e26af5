"""What kinematics say of one voyage is no surer than numbers of sound instruments agree from voyage to voyage."""

import numpy as np
import pytest

import twin
from tests.study.instruments.test_instruments import KEPT, late, voyage
from twin.study.instruments.arrow import ArrowReduced
from twin.study.instruments.instrument_estimate import estimate
from twin.study.instruments.kinematic_fit import from_day_to_day
from twin.study.instruments.unknowns import INDEX, UNKNOWNS, day_to_day, widths

P = len(UNKNOWNS)
WIDTHS = widths(8.0, 100.0, 20.0)


def told(rng, rows=60):
    """What a voyage with readings of every number says of them."""
    J = rng.standard_normal((rows, P)) / WIDTHS
    return ArrowReduced(J.T @ J, J.T @ rng.standard_normal(rows), 0.0, lambda b: b, np.zeros(0), np.zeros(0))


def test_what_differs_on_a_voyage_is_integrated_out():
    """Expected: A and g as by eliminating e from the joint normal equations of theta and e, written out in full."""
    before = told(np.random.default_rng(3))
    after = from_day_to_day(before, WIDTHS)
    k = [i for i, u in enumerate(UNKNOWNS) if u.varies]
    T = np.linalg.inv((day_to_day() * np.outer(WIDTHS, WIDTHS))[np.ix_(k, k)])
    H = np.block([[before.A, before.A[:, k]], [before.A[k], before.A[np.ix_(k, k)] + T]])
    whole = np.linalg.inv(H + np.diag(np.r_[WIDTHS**-2, np.zeros(len(k))]))
    mean = whole @ np.r_[before.g, before.g[k]]
    alone = np.linalg.inv(after.A + np.diag(WIDTHS**-2))
    assert alone == pytest.approx(whole[:P, :P], rel=1e-6, abs=1e-12)
    assert alone @ after.g == pytest.approx(mean[:P], rel=1e-6, abs=1e-9)


def test_however_good_the_readings_one_voyage_tells_no_more_than_what_varies_allows():
    before = told(np.random.default_rng(4))
    A = from_day_to_day(ArrowReduced(1e8 * before.A, before.g, *([None] * 4)), WIDTHS).A
    k = [i for i, u in enumerate(UNKNOWNS) if u.varies]
    own = np.sqrt(np.diag(np.linalg.inv(A))[k]) / WIDTHS[k]
    assert own == pytest.approx([UNKNOWNS[i].varies for i in k], rel=0.01)


def test_what_a_log_shows_at_one_speed_is_known_better_than_its_scale_or_its_bias():
    """Expected: of both, put together at the speed of the voyage, a third of what the bias may be off, or less."""
    i, j = INDEX["log_scale"], INDEX["log_bias"]
    T = (day_to_day() * np.outer(WIDTHS, WIDTHS))[np.ix_([i, j], [i, j])]
    at_speed = np.array([8.0, 1.0])
    assert np.sqrt(at_speed @ T @ at_speed) < 0.3 * np.sqrt(T[1, 1])


def test_a_planted_age_is_named_and_its_interval_is_as_wide_as_ages_differ(sail):
    """Test: position and velocity 2 s late. Expected: named; the interval holds the truth and is as wide as what
    varies; the engine of the study, which has reference voyages for that, is surer."""
    shown = {name: x[::5] for name, x in sail(720.0, seed=3).items() if name in KEPT}
    for name in ("north_m", "east_m", "surge_velocity_mps", "sway_velocity_mps"):
        shown = late(shown, name, 2.0)
    found = twin.instruments(None, voyage(shown)).found.of("gnss_delay")
    sure = estimate([voyage(shown)]).of("gnss_delay")
    assert found.seen and found.interval[0] < 2.0 < found.interval[1]
    assert found.sd > 0.9 * UNKNOWNS[INDEX["gnss_delay"]].varies > 2.0 * sure.sd
