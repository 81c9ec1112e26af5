"""The certificate beside the loop: the observer's error stays inside the live bound, and nothing is promised where nothing holds."""

from math import hypot

from twin.live.certificate import Tube, certify
from twin.live.learned import LearnedForce
from twin.live.stabilizer import Stabilizer
from twin.physics.model import Model


def stabilized(ship, make_bridge, **sailing):
    K = 12.0 * ship.U_0 / ship.L_pp
    tube = Tube(certify(Model.of(ship), (K, K, K), 0.1, delay_samples=5))
    return make_bridge(loop={"stabilizer": Stabilizer(tube), "learned": LearnedForce(ship, None, "none")}, **sailing)


def test_on_a_voyage_the_error_stays_inside_the_bound(kvlcc2, make_bridge):
    bridge = stabilized(kvlcc2, make_bridge)
    for _ in range(60):
        tick = bridge.run(1.0)[-1]
        assert tick.certificate.inside and tick.certificate.margin > 0.5
        assert hypot(bridge.error("surge_velocity_mps"), bridge.error("sway_velocity_mps")) < tick.certificate.bound
    assert 0.0 < tick.certificate.bound < 1.0


def test_without_measurements_the_bound_grows_and_comes_back(kvlcc2, make_bridge):
    bridge = stabilized(kvlcc2, make_bridge)
    before = bridge.run(30.0)[-1].certificate.bound
    silent = bridge.run(10.0, lambda readings, b: [r for r in readings if "velocity" not in r.channel])
    assert silent[-1].certificate.bound > before
    assert bridge.run(60.0)[-1].certificate.bound < silent[-1].certificate.bound


def test_outside_the_operating_set_nothing_is_promised(kvlcc2, make_bridge):
    bridge = stabilized(kvlcc2, make_bridge, shaft=0.01)
    bridge.sailing.state = (0.0, 0.0, 0.5, 0.1, 0.0, 0.0)
    assert not bridge.run(5.0)[-1].certificate.inside


def test_without_a_certificate_nothing_is_promised(make_bridge):
    assert not make_bridge().run(5.0)[-1].certificate.inside
