"""Whether a rudder has the authority over what the certificate leaves open."""

from dataclasses import replace

import pytest

from twin.live.certificate.authority import HARD_OVER, authority, authority_margin
from twin.live.certificate.certificate import certify
from twin.live.observer.operating import propeller_rate
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation


@pytest.fixture(scope="module")
def model():
    return Model.of(load("kvlcc2"))


@pytest.fixture(scope="module")
def certificate(model):
    return certify(model, None, 0.1)


def test_the_authority_of_a_tanker_is_that_of_its_rudder(model):
    """Test: yaw acceleration by 35 deg of rudder beside that without, straight ahead at U_0. Expected: the half
    difference of both sides is within a tenth of one side's."""
    n, U = propeller_rate(model), model.loaded.U_0
    none, over = (model.nu_dot(Situation(u=U, delta=d, n=n))[2] for d in (0.0, HARD_OVER))
    assert authority(model) == pytest.approx(over - none, rel=0.1) and authority(model) > 0.0


def test_a_tankers_rudder_has_not_the_authority_and_a_tighter_bound_gives_it_back(model, certificate):
    """Test: the certificate's own bound and D, then both a tenth. Expected: below 0 (0.62e-3 + 0.22e-3 of
    0.44e-3 rad/s^2 by hand in docs/stability.md), then above."""
    first = authority_margin(model, certificate)
    assert -1.6 < first < -0.4
    D = certificate.disturbance
    easier = replace(
        certificate,
        bound=tuple(0.1 * b for b in certificate.bound),
        disturbance=replace(D, calm=tuple(0.1 * d for d in D.calm)),
    )
    assert authority_margin(model, easier) == pytest.approx(1.0 - 0.1 * (1.0 - first), rel=1e-9)
    assert authority_margin(model, easier) > 0.5


def test_the_loop_of_the_service_publishes_it(make_service):
    ticks = make_service().run(2.0)
    assert ticks[-1].certificate.authority_margin < 0.0
