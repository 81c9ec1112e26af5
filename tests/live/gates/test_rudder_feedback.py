"""A rudder's feedback that is stuck: found by how it turns, and what it taught taken back; a rudder that is
truly held raises no alarm."""

from dataclasses import replace

import pytest

from tests.thorough import thorough
from twin.live.learning.learned_force import LearnedForce
from twin.live.learning.residual import bundled, load
from twin.physics.effects import find
from twin.physics.model import Model

RUDDER = "rudder_angle_deg"


def stuck():
    """The rudder's feedback stays at its last value."""
    last = {}
    return lambda readings, b: [
        r._replace(value=last.setdefault("v", r.value)) if r.channel == RUDDER else r for r in readings
    ]


def learning(ship, make_bridge, **sailing):
    learned = LearnedForce(ship, load(bundled(ship), ship))
    return make_bridge(loop={"learned": learned}, **sailing), learned


def suspected(ticks):
    return [t for t in ticks if any(RUDDER in text for text in t.reasons)]


def farthest(new, old):
    return max(
        abs(a - b) for row, other in zip(new, old, strict=True) for a, b in zip(row, other, strict=True)
    )


def zigzag(angle_deg):
    return lambda t: angle_deg if t % 160.0 < 80.0 else -angle_deg


@pytest.mark.parametrize(("angle_deg", "found"), [(15.0, True), pytest.param(5.0, False, marks=thorough)])
def test_I6_a_rudder_feedback_that_is_stuck_teaches_nothing(kvlcc2, make_bridge, angle_deg, found):
    """Test: a zigzag with learning on, then the feedback says the same for three minutes. Expected: learning
    stands still within three lengths, what acts is again what acted at a moment before, and helm of 15 deg
    that is not seen is said; of 5 deg the model could be that wrong. Before, no word against the feedback and
    learning in every second."""
    bridge, learned = learning(kvlcc2, make_bridge, helm_deg=zigzag(angle_deg))
    healthy = bridge.run(200.0)
    updates = learned.adaptation.updates
    healthy += bridge.run(40.0)
    before = []
    for _ in range(20):
        healthy += bridge.run(10.0)
        before.append(learned.adaptation.numbers())
    assert not suspected(healthy) and learned.adaptation.updates > updates + 2300
    ticks = bridge.run(180.0, stuck())
    assert RUDDER in learned.adaptation.frozen
    assert min(farthest(learned.adaptation.numbers(), old) for old in before) < 0.02
    said = [any("turns as if it moved" in text for text in t.reasons) for t in ticks]
    assert any(said) == found


@thorough
def test_a_feedback_that_moves_again_is_believed_after_a_while(kvlcc2, make_bridge):
    bridge, learned = learning(kvlcc2, make_bridge)
    bridge.run(400.0)
    bridge.run(180.0, stuck())
    assert learned.helm.stuck and learned.adaptation.frozen == learned.helm.stuck
    updates = learned.adaptation.updates
    bridge.run(300.0)
    assert not learned.helm.stuck and learned.adaptation.updates > updates + 500


def test_a_zigzag_is_not_suspected_even_where_half_of_the_rudder_is_worn_away(kvlcc2, make_bridge):
    """Expected: no word against the feedback, and learning goes on in every second."""
    worn = replace(kvlcc2, effects=(find("RudderWear").plausible(kvlcc2).but(loss=0.5),))
    bridge, learned = learning(kvlcc2, make_bridge)
    bridge.sailing.model = Model.of(worn)
    bridge.run(200.0)
    updates = learned.adaptation.updates
    ticks = bridge.run(400.0)
    assert not suspected(ticks)
    assert learned.adaptation.updates > updates + 3900


@thorough
@pytest.mark.parametrize("held_deg", [0.0, 35.0], ids=["straight course", "turning circle"])
def test_a_rudder_that_is_truly_held_is_not_suspected(kvlcc2, make_bridge, held_deg):
    """Test: after some helm the rudder stays for eight minutes, feedback without noise. Expected: nothing is
    said against it; learning rests."""
    bridge, learned = learning(
        kvlcc2, make_bridge, helm_deg=lambda t: zigzag(10.0)(t) if t < 200.0 else held_deg
    )
    exact = lambda readings, b: [
        r._replace(value=b.sailing.rudder) if r.channel == RUDDER else r for r in readings
    ]
    ticks = bridge.run(680.0, exact)
    assert not suspected(ticks)
    assert "nothing is learned until it moves" in learned.adaptation.frozen
