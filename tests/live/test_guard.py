"""The ladder of modes: hybrid, physics only, dead reckoning, invalid; down at once, and the learned force
back only after a while."""

import json

import pytest

from twin.live.certificate.certificate import certify
from twin.live.certificate.observer_tube import Tube
from twin.live.guard import LatchedFault
from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.manifest import hashed
from twin.live.learning.residual import bundled, check, load
from twin.live.stabilizer import Stabilizer
from twin.physics.model import Model


@pytest.fixture
def hybrid(kvlcc2):
    return LearnedForce(kvlcc2, load(bundled(kvlcc2), kvlcc2))


def degraded(ship, factor):
    """The bundled residual with its last layer times a factor."""
    path = bundled(ship)
    table = json.loads(path.with_suffix(".json").read_bytes())
    table["W"] = [[factor * w for w in row] for row in table["W"]]
    table |= {"W_max": 1e6, "output_bound": 3.0}
    return LearnedForce(ship, check(path.read_bytes(), json.dumps(hashed(table)).encode(), ship), adapt=False)


def test_a_fault_counts_at_once_and_ends_after_it_was_gone_for_a_while():
    held = LatchedFault(10.0)
    assert held.feed("why", 0.0) == "why"
    assert held.feed("", 5.0) == "why" and held.feed("", 9.9) == "why"
    assert held.feed("", 10.0) == ""


def test_with_a_good_residual_the_twin_is_hybrid(make_bridge, hybrid):
    ticks = make_bridge(loop={"learned": hybrid}).run(60.0)
    assert ticks[-1].mode == "hybrid" and ticks[-1].learned.weight == 1.0
    assert abs(ticks[-1].learned.N_Nm) <= ticks[-1].learned.bound_Nm
    assert 0.0 < max(t.learned.share for t in ticks) < 0.5


def test_M10_a_residual_that_makes_it_worse_is_switched_off_and_says_so(kvlcc2, make_bridge):
    """Test: the bundled last layer negated and tripled, on a ship that is exactly its model. Expected:
    physics only within the window."""
    learned = degraded(kvlcc2, -6.0)
    ticks = make_bridge(loop={"learned": learned}, noise=0.3).run(260.0)
    assert ticks[600].mode == "hybrid"
    assert ticks[-1].mode == "physics only" and any(
        "worse than the physics alone" in r for r in ticks[-1].reasons
    )
    assert ticks[-1].learned.N_Nm == 0.0 and ticks[-1].learned.weight == 0.0


def test_M6_a_residual_that_stays_at_its_bound_is_switched_off(kvlcc2, make_bridge):
    ticks = make_bridge(loop={"learned": degraded(kvlcc2, 1e4)}).run(30.0)
    off = [t for t in ticks if any("stays at its bound" in r for r in t.reasons)]
    assert off and off[0].index < 150 and ticks[-1].mode == "physics only"


def test_M7_in_a_state_it_was_not_trained_on_the_residual_has_no_say(make_bridge, hybrid):
    """Test: the engine astern. Expected: physics only, with the input and its range in words."""
    bridge = make_bridge(loop={"learned": hybrid}, shaft=-1.0)
    tick = bridge.run(10.0)[-1]
    assert tick.mode == "physics only" and any(
        "propeller" in r and "where it was trained" in r for r in tick.reasons
    )
    assert tick.learned.X_N == 0.0


def test_I23_without_the_rudder_it_is_dead_reckoning_and_nothing_is_learned(make_bridge, hybrid):
    bridge = make_bridge(loop={"learned": hybrid})
    bridge.run(20.0)
    silent = lambda readings, b: [r for r in readings if r.channel != "rudder_angle_deg"]
    tick = bridge.run(3.0, silent)[-1]
    assert tick.mode == "dead reckoning" and "no rudder_angle_deg" in tick.reasons[0]
    assert "rudder" in hybrid.adaptation.frozen
    assert bridge.run(1.0)[-1].mode == "hybrid"


def test_where_the_bound_is_contradicted_the_learned_force_rests_for_three_ship_lengths(
    kvlcc2, make_bridge, hybrid
):
    """Test: the log goes off by 1.5 m/s and stays. Expected: physics only, with the reason of whoever sees it
    first (the certificate's bound or the instruments against each other), and no learned force."""
    K = 12.0 * kvlcc2.U_0 / kvlcc2.L_pp
    tube = Tube(certify(Model.of(kvlcc2), (K, K, K), 0.1, delay_samples=5))
    bridge = make_bridge(loop={"stabilizer": Stabilizer(tube), "learned": hybrid})
    bridge.run(30.0)
    off = lambda readings, b: [
        r._replace(value=r.value + 1.5) if r.channel == "surge_velocity_mps" else r for r in readings
    ]
    ticks = bridge.run(20.0, off)
    seen = lambda reason: (
        reason.startswith("learned force off") and ("than its bound allows" in reason or "against" in reason)
    )
    first = next(i for i, t in enumerate(ticks) if any(seen(reason) for reason in t.reasons))
    assert not any(t.certificate.inside for t in ticks[first : first + 5])
    assert ticks[-1].mode == "physics only" and any(seen(reason) for reason in ticks[-1].reasons)
