"""Several publishers of one channel: who is heard, and what is said of it, on a whole loop."""

from tests.live.gates.test_sensors import HEADING, only, said
from twin.live.signals.readings import Quality


def test_I25_two_publishers_of_one_channel_are_named_and_the_first_is_used(bridge):
    """Test: a second heading source 5 deg off. Expected: both named within 2 s, the first believed."""
    bridge.run(10.0)
    ticks = bridge.run(
        2.0, only(HEADING, lambda r, b: [r, r._replace(value=(r.value + 5.0) % 360.0, source="other")])
    )
    assert said(ticks, "ship and other both publish it")
    assert abs(bridge.error(HEADING)) < 0.2


def test_I25_when_the_first_falls_silent_the_second_takes_over(bridge):
    bridge.run(10.0)
    bridge.run(3.0, only(HEADING, lambda r, b: r._replace(source="other")))
    tick = bridge.ticks[-1]
    assert (
        tick.quality.heading_true_north_deg == Quality.OK
        and bridge.loop.sensors.gates[HEADING].source == "other"
    )


def test_the_owner_may_choose_who_speaks(kvlcc2, make_bridge):
    from twin.live.gates.sensors import Sensors

    bridge = make_bridge(loop={"sensors": Sensors(kvlcc2, {HEADING: "good"})})
    both = only(HEADING, lambda r, b: [r._replace(value=0.0, source="bad"), r._replace(source="good")])
    ticks = bridge.run(5.0, both)
    assert abs(bridge.error(HEADING)) < 0.2 and not said(ticks, "both publish")


def test_F3_a_source_that_nobody_is_is_named_after_ten_seconds(kvlcc2, make_bridge):
    """Test: the owner names a compass that does not exist. Expected: said within 10 s, and no more once it
    speaks."""
    from twin.live.gates.sensors import Sensors

    bridge = make_bridge(loop={"sensors": Sensors(kvlcc2, {HEADING: "gyro 2"})})
    assert not said(bridge.run(9.9), "never been heard")
    assert said(bridge.run(0.4), f"{HEADING}: its source 'gyro 2' has never been heard")
    bridge.run(1.0, only(HEADING, lambda r, b: r._replace(source="gyro 2")))
    assert not said(
        bridge.run(1.0, only(HEADING, lambda r, b: r._replace(source="gyro 2"))), "never been heard"
    )
