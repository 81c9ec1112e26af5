"""The feedback of rudder or shaft is lost: neither stops for that."""

import pytest


def without(channel):
    return lambda readings, bridge: [r for r in readings if r.channel != channel]


@pytest.mark.parametrize(
    "channel, attribute, floor", [("propeller_rate_rpm", "n", 1.0), ("rudder_angle_deg", "delta", 0.15)]
)
def test_I23_a_lost_feedback_of_rudder_or_shaft_is_held_said_and_not_promised_upon(
    make_service, channel, attribute, floor
):
    """Test: in a zigzag one feedback falls silent for 30 s, in the loop that the service builds. Expected:
    physics goes on with its last value, in no tick with 0; dead reckoning, the reason in words with the
    value; no promise until it is heard again."""
    bridge = make_service()
    bridge.run(70.0)
    seen = bridge.loop.last.situation
    last, force = getattr(seen, attribute), {f.name: f for f in bridge.ticks[-1].known}
    for _ in range(300):
        tick = bridge.run(0.1, without(channel))[-1]
        assert abs(getattr(bridge.loop.last.situation, attribute)) > floor
        if tick.mode == "dead reckoning":
            assert not tick.certificate.inside and any(
                channel in text and "is held" in text for text in tick.reasons
            )
    assert tick.mode == "dead reckoning" and getattr(bridge.loop.last.situation, attribute) == pytest.approx(
        last, rel=0.1
    )
    told = next(text for text in tick.reasons if "is held" in text)
    shown = {"n": 60.0, "delta": 57.29578}[attribute] * getattr(bridge.loop.last.situation, attribute)
    assert f"{shown:.4g}" in told
    if attribute == "n":
        thrust = {f.name: f for f in tick.known}["propeller"].X_N
        assert thrust > 0.5 * force["propeller"].X_N > 0.0
    heard = bridge.run(10.0)
    assert heard[-1].certificate.inside and not any("is held" in text for text in heard[-1].reasons)


def test_a_feedback_that_never_was_is_not_invented(make_bridge):
    bridge = make_bridge()
    tick = bridge.run(10.0, without("propeller_rate_rpm"))[-1]
    assert bridge.loop.last.situation.n == 0.0 and not any("is held" in text for text in tick.reasons)
