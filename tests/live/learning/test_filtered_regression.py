"""The unexplained force: what lasts as long as a manoeuvre is seen whole, waves and noise hardly."""

from math import sin

import pytest

from twin.live.learning.filtered_regression import Evidence
from twin.live.learning.learned_force import scale_of
from twin.live.observer.dynamics import KnownDynamics
from twin.physics.model import Model
from twin.physics.state import Rates

DT = 0.1


def heard(ship, force, seconds=900.0):
    """(d, regressor) in sway after each step, of a ship that only force(t), in units of the force scale,
    pushes aside; force is the regressor too."""
    physics, scale = KnownDynamics(Model(ship)), scale_of(ship)
    evidence, v, r, out = Evidence(ship, scale), 0.0, 0.0, []
    for k in range(int(seconds / DT)):
        q = force(DT * k)
        m = physics.force_for(0.0, 1.0, 0.0)
        n = physics.force_for(0.0, 0.0, 1.0)
        det = m.Y * n.N - m.N * n.Y
        push = q * scale.Y
        v, r = v + DT * push * n.N / det, r - DT * push * m.N / det
        evidence.feed((0.0, v, r), Rates(0.0, 0.0, 0.0), (0.0,) * 3, (0.0,) * 3, [q], physics, DT)
        if evidence.ready:
            out.append((evidence.unexplained[1], evidence.regressors[0]))
    return out


def test_it_is_ready_when_what_the_filters_began_with_is_gone(kvlcc2):
    """Test: a steady push from the first second. Expected: seen to 5 % from the first time it may be used."""
    assert all(d == pytest.approx(0.5, abs=0.025) for d, _ in heard(kvlcc2, lambda t: 0.5))


def test_a_force_that_comes_and_goes_with_a_manoeuvre_is_seen_as_its_regressor_is(kvlcc2):
    d, q = zip(*heard(kvlcc2, lambda t: sin(t / 30.0)), strict=True)
    assert max(abs(a - b) for a, b in zip(d, q, strict=True)) < 0.03
    assert max(q) > 0.2


def test_of_waves_a_hundredth_is_left(kvlcc2):
    """Test: a push of the sea's, 10 s from crest to crest, as large as the force scale."""
    late = heard(kvlcc2, lambda t: sin(0.63 * t))[3000:]
    assert max(abs(d) for d, _ in late) < 0.012
