"""Skipped periods are said, in the reasons and by `twin health`."""

from twin.live import health_check
from twin.live.keelson import messages
from twin.live.lagging import Lagging


def test_C1_skipped_periods_are_said_with_their_share_and_no_longer_once_it_is_over():
    lagging = Lagging(10.0)
    assert [lagging.look(float(t), 0) for t in range(20)] == [""] * 20
    said = lagging.look(20.0, 20)
    assert "lagging: 20 periods skipped in the last 20 s (10.0 %)" in said
    assert lagging.look(29.0, 20) and lagging.look(30.0, 20) == ""
    assert "lagging: 50 periods skipped in the last 60 s" in lagging.look(70.0, 50)


def test_periods_that_the_start_itself_took_are_no_lag():
    lagging = Lagging(10.0)
    assert lagging.look(0.0, 3) == lagging.look(1.0, 3) == "" and "1 periods skipped" in lagging.look(2.0, 4)


def test_health_says_the_share_of_skipped_periods_and_what_was_not_logged():
    tick = messages.Tick(index=932, overruns=66, mode="physics only", rate_hz=10.0, log_dropped=5)
    code, said = health_check.health(tick)
    assert code == 0 and "66 periods skipped (6.6 %)" in said and "5 messages not logged" in said
    assert "0 periods skipped," in health_check.health(messages.Tick(mode="hybrid"))[1]
