"""One channel's gate and its memories, on made-up samples: every verdict at its limit, and what is remembered,
number by number."""

from math import exp, inf, isclose, log
from types import SimpleNamespace

import pytest

from twin.live.gates.frozen import Frozen
from twin.live.gates.gate import Gate
from twin.live.gates.rivals import Rivals
from twin.live.signals.channels import Channel
from twin.live.signals.readings import Quality, Reading

SLOW = Channel("north_m", "x", 1.0, -100.0, 100.0, 2.0)
ANGLE = Channel("heading_true_north_deg", "psi", 0.0175, -360.0, 720.0, 60.0, wraps=360.0)


class Told:
    """A gate and who speaks to it; times count from 1000 s, stamps from 1.7e9."""

    def __init__(self, channel=SLOW, allowance=1.0, **more):
        self.gate = Gate(channel, allowance, **more)

    def say(self, value, t, source="a", motion=0.0, received=None):
        received_s = 1000.0 + (t if received is None else received)
        return self.gate.accept(
            Reading(self.gate.channel.name, value, 1.7e9 + t, received_s, source), 1000.0 + t, motion
        )

    def quality(self, t):
        return self.gate.quality(1000.0 + t)


def test_the_first_sample_and_its_range():
    one = Told()
    assert one.quality(0.0) is Quality.NEVER_SEEN and one.gate.lost(0.0) and one.gate.value is None
    for value, quality in ((100.1, Quality.OUT_OF_RANGE), (-101.0, Quality.OUT_OF_RANGE), (inf, Quality.NOT_FINITE),
                           (float("nan"), Quality.NOT_FINITE)):  # fmt: skip
        assert one.say(value, 0.0) is quality
    assert one.gate.refused == 4 and one.quality(0.1) is Quality.NOT_FINITE
    assert one.quality(4.9) is Quality.NOT_FINITE and one.quality(5.0) is Quality.NEVER_SEEN
    assert one.say(-100.0, 1.0) is Quality.OK and one.quality(1.0) is Quality.OK and one.gate.step == 0.0
    assert (one.gate.value, one.gate.time_s, one.gate.received_s, one.gate.source) == (
        -100.0,
        1001.0,
        1001.0,
        "a",
    )
    assert one.gate.samples == 0 and one.gate.interval_s == 0.0
    assert Told().say(100.0, 0.0) is Quality.OK


def test_what_was_refused_counts_until_the_next_good_sample_or_until_it_is_stale():
    one = Told()
    one.say(0.0, 0.0)
    one.say(500.0, 1.0)
    assert one.quality(1.0) is Quality.OUT_OF_RANGE
    one.say(0.1, 1.5)
    assert one.quality(1.6) is Quality.OK
    one.say(500.0, 1.7)
    one.gate.expires_s = inf
    assert one.quality(1.7 + 4.9) is Quality.OUT_OF_RANGE and one.quality(1.7 + 5.1) is Quality.OK


def test_a_channel_is_lost_after_ten_of_its_own_periods_at_least_a_second_at_most_the_tables_limit():
    for period_s, stale_s in ((0.05, 1.0), (0.2, 2.0), (0.9, 5.0)):
        one = Told()
        for k in range(11):
            assert one.gate.stale_s() == 5.0, k
            one.say(0.0, period_s * k)
        assert one.gate.samples == 10 and one.gate.interval_s == pytest.approx(period_s)
        assert one.gate.stale_s() == pytest.approx(stale_s)
        last = period_s * 10
        assert one.quality(last + stale_s - 0.01) is Quality.OK
        assert one.quality(last + stale_s + 0.01) is Quality.STALE and one.gate.lost(
            1000.0 + last + stale_s + 0.01
        )
        assert one.gate.expires_s == pytest.approx(1000.0 + last + stale_s)


def test_the_rhythm_is_a_mean_in_which_a_gap_counts_as_three_periods_and_a_minute_not_at_all():
    one = Told(channel=SLOW, allowance=inf)
    for k in range(6):
        one.say(0.0, 0.5 * k)
    one.say(0.0, 2.5 + 4.0)
    assert one.gate.samples == 6 and one.gate.interval_s == pytest.approx(0.5 + (1.5 - 0.5) / 6.0)
    one.say(0.0, 6.5 + 60.0)
    assert one.gate.samples == 6
    one.say(0.0, 6.5 + 60.0 + 59.9)
    assert one.gate.samples == 7
    one.gate.samples, one.gate.interval_s = 498, 1.0
    one.say(0.0, 126.4 + 2.0)
    assert one.gate.interval_s == pytest.approx(1.0 + 1.0 / 499.0)
    one.say(0.0, 128.4 + 2.0)
    before = 1.0 + 1.0 / 499.0
    assert one.gate.interval_s == pytest.approx(before + (2.0 - before) * 0.002)


def test_who_may_speak_the_chosen_one_or_the_first_until_it_is_lost():
    one = Told(source="b")
    assert one.say(0.0, 0.0) is Quality.CONFLICT and one.gate.refused == 0 and one.gate.rival == ""
    assert one.say(0.0, 0.1, "b") is Quality.OK and one.say(0.0, 0.2) is Quality.CONFLICT
    assert one.quality(0.3) is Quality.OK
    one = Told()
    one.say(0.0, 0.0)
    assert one.say(0.0, 1.0, "b") is Quality.CONFLICT
    assert (one.gate.rival, one.gate.rival_s, one.gate.refused) == ("b", 1001.0, 1)
    assert one.say(0.1, 1.1) is Quality.OK
    assert one.quality(2.9) is Quality.CONFLICT and one.quality(3.0) is Quality.OK
    assert one.say(0.0, 6.1, "b") is Quality.CONFLICT  # not yet lost
    assert one.say(0.0, 6.2, "b") is Quality.OK and one.gate.source == "b"


def test_stamps_that_repeat_or_run_backwards():
    one = Told()
    one.say(0.0, 1.0)
    assert one.say(0.0, 1.0) is Quality.DUPLICATE and one.gate.refused == 0
    assert one.say(0.0, 0.9) is Quality.OUT_OF_ORDER and one.gate.refused == 1
    assert one.gate.accept(Reading("north_m", 0.0, 1.7e9, 1001.0, "a"), 1001.0) is Quality.OUT_OF_ORDER


@pytest.mark.parametrize(
    "value, dt, quality",
    ((1.0, 0.1, Quality.OK), (1.2, 0.1, Quality.OK), (1.21, 0.1, Quality.JUMP), (-1.21, 0.1, Quality.JUMP),
     (21.0, 10.0, Quality.OK), (21.1, 10.0, Quality.JUMP), (90.0, 15.0, Quality.OK), (90.0, 14.9, Quality.JUMP)),
)  # fmt: skip
def test_a_jump_is_more_than_noise_and_the_fastest_change_unless_the_channel_was_silent_long(
    value, dt, quality
):
    """Expected: 1 for noise and 2 a second; after three times the stale time of 5 s anything goes."""
    one = Told()
    one.say(0.0, 0.0)
    assert one.say(value, dt) is quality
    assert one.quality(dt) is quality and one.gate.value == (value if quality is Quality.OK else 0.0)


def test_a_step_that_lasts_is_believed_after_its_time_and_its_samples_and_told_less_the_ships_way():
    for times, motion in (((1.0, 1.6, 2.19, 2.2), 0.0), ((1.0, 2.3, 2.35), 0.5)):
        one = Told()
        one.say(0.0, 0.9)
        for t in times[:-1]:
            assert one.say(50.0, t, motion=motion) is Quality.JUMP and one.gate.step == 0.0
        assert one.say(50.0, times[-1], motion=motion) is Quality.OK
        assert one.gate.step == pytest.approx(50.0 - motion * (times[-1] - 0.9)) and one.gate.value == 50.0
        assert one.say(50.0, times[-1] + 0.1) is Quality.OK and one.gate.step == 0.0


def test_a_step_must_agree_with_itself_and_begins_anew_when_it_does_not_or_when_it_was_none():
    one = Told()
    one.say(0.0, 0.0)
    for t, value in ((1.0, 50.0), (1.5, 50.5), (2.0, -50.0), (2.5, -50.0), (3.1, -50.0)):
        assert one.say(value, t) is Quality.JUMP
    assert one.say(-50.0, 3.2) is Quality.OK and one.gate.step == pytest.approx(-50.0)
    one = Told()
    one.say(0.0, 0.0)
    one.say(50.0, 1.0)
    one.say(50.0, 1.5)
    assert one.say(0.0, 1.6) is Quality.OK  # back again: forgotten
    assert one.say(50.0, 2.3) is Quality.JUMP and one.say(50.0, 2.4) is Quality.JUMP
    assert one.say(50.0, 3.4) is Quality.JUMP and one.say(50.0, 3.5) is Quality.OK
    one = Told()  # within the same instant, a candidate may move by noise only
    one.say(0.0, 0.0)
    one.say(50.0, 1.0)
    assert one.gate._candidate == (50.0, 1001.0, 1001.0, 1)
    one.say(51.1, 1.0 + 1e-9)
    assert one.gate._candidate[3] == 1


def test_an_angle_goes_the_short_way_round():
    one = Told(ANGLE, 3.0)
    one.say(359.0, 0.0)
    assert one.say(2.0, 0.1) is Quality.OK
    assert one.gate.difference(2.0, 359.0) == pytest.approx(3.0) == -one.gate.difference(359.0, 2.0)
    assert one.gate.difference(100.0, 200.0) == pytest.approx(-100.0)
    assert Told().gate.difference(2.0, 359.0) == -357.0


def test_a_channel_that_loses_samples_is_told_once_its_rhythm_is_known():
    one = Told()
    for k in range(31):
        one.say(0.0, 0.1 * k)
        assert not one.gate.losing(1000.0 + 0.1 * k)
    usual = one.gate._rate
    silent_s = 3.0 * -(log(6.0 / usual))
    assert silent_s > 0.1 and one.gate.samples == 30
    assert not one.gate.losing(1003.0 + silent_s - 0.01) and one.gate.losing(1003.0 + silent_s + 0.01)
    one.gate.samples = 29
    assert not one.gate.losing(1090.0)
    one.gate.samples, one.gate.interval_s = 30, 1.0
    assert not one.gate.losing(1e6)
    one.gate.interval_s = 0.0
    assert not one.gate.losing(1e6)


def test_the_rate_of_samples_fades_over_three_seconds():
    """Expected: a third of a sample a second with each, faded by (1 + x + x^2/2) of the time since the last."""
    one, rate, last = Told(), 0.0, 0.0
    for t in (0.0, 0.5, 0.6, 0.6, 2.0, 1.9, 3.0):
        one.say(0.0, t, received=t)
        x = (t - last) / 3.0 if rate else 0.0
        rate = rate / (1.0 + x + 0.5 * x * x) if x > 0.0 else rate
        if t not in (1.9,) and not (t == 0.6 and last == 0.6):
            rate, last = rate + 1.0 / 3.0, t
        assert one.gate._rate == pytest.approx(rate), t


def test_a_frozen_channel_is_refused_and_its_stamp_remembered():
    one = Told(frozen=Frozen(least=0.5))
    one.say(0.0, 0.0)
    for k in range(1, 40):
        one.say(0.1 * (k % 2), 0.1 * k)
    verdicts = [one.say(0.1, 4.0 + 0.5 * k, motion=1.0) for k in range(12)]
    assert Quality.FROZEN in verdicts and verdicts[-1] is Quality.FROZEN
    assert one.say(0.1, 4.0 + 0.5 * 11, motion=1.0) is Quality.DUPLICATE


def rival(receiver, value, t, motion=0.0, source="b", received=None):
    """The receiver's second source."""
    rivals, one = receiver
    reading = Reading("north_m", value, 1.7e9 + t, 1000.0 + (t if received is None else received), source)
    rivals.compare(one.gate, reading, 1000.0 + t, motion)


def test_the_difference_of_two_sources_is_a_mean_over_four_seconds_carried_by_the_ships_motion():
    receiver = Rivals(), Told()
    receiver[1].say(10.0, 0.0)
    fed = []
    rival(receiver, 12.0, 0.5, motion=2.0)
    ((key, pair),) = receiver[0]._pairs.items()
    assert key == ("north_m", "a", "b") and (pair.test.least, pair.test.most) == (0.1, 150.0)
    pair.test = SimpleNamespace(feed=fed.append)
    for t, value in ((1.0, 13.0), (1.9, 14.0)):
        rival(receiver, value, t)
    rival(receiver, 99.0, 2.1)  # too far from what was believed
    receiver[1].say(10.0, 4.0)
    rival(receiver, 15.0, 4.49)
    assert fed == []
    rival(receiver, 16.0, 4.5)
    assert fed == [pytest.approx((1.0 + 3.0 + 4.0 + 5.0 + 6.0) / 5.0)]
    rival(receiver, 99.0, 4.6, received=30.0)  # a hole of more than 20 s: begun anew
    rival(receiver, 11.0, 4.7, received=34.0)
    assert fed[1:] == [pytest.approx((89.0 + 1.0) / 2.0)]


def test_rivals_that_say_nothing_usable_are_not_compared_and_no_more_than_sixty_four_are_kept():
    receiver = Rivals(), Told()
    rival(receiver, 1.0, 0.0)
    assert receiver[0]._pairs == {}
    receiver[1].say(10.0, 0.0)
    for value, t in ((101.0, 0.1), (-101.0, 0.1), (10.0, 2.1), (10.0, -2.1)):
        rival(receiver, value, t)
    assert receiver[0]._pairs == {}
    for k in range(70):
        rival(receiver, 10.0, 0.1, source=f"b{k}")
    assert len(receiver[0]._pairs) == 64
    rival(receiver, 10.0, 1.0, source="late", received=20.2)
    assert [key[2] for key in receiver[0]._pairs] == ["late"]


def test_a_rival_that_walks_away_is_named_while_it_is_heard():
    receiver = Rivals(), Told()
    receiver[1].say(10.0, 0.0)
    rival(receiver, 10.0, 0.1)
    (pair,) = receiver[0]._pairs.values()
    assert receiver[0].reasons(1000.1) == []
    pair.test.alarm = True
    assert receiver[0].reasons(1000.1) == ["north_m: a and b walk apart; one of the two is wrong"]
    assert receiver[0].reasons(pair.heard_s + 19.9)
    assert receiver[0].reasons(pair.heard_s + 20.0) == []


def test_the_scale_of_two_sources_is_that_of_the_channels_noise_ten_units_at_most():
    for channel, allowance, least, most in (
        (ANGLE, 3.0, 0.3, 3.0),
        (ANGLE, 40.0, 1.0, 10.0),
        (SLOW, 40.0, 1.0, 150.0),
    ):
        receiver = Rivals(), Told(channel, allowance)
        receiver[1].say(10.0, 0.0)
        rival(receiver, 10.0, 0.1)
        (pair,) = receiver[0]._pairs.values()
        assert (pair.test.least, pair.test.most) == pytest.approx((least, most))


def test_how_the_rate_fades_is_what_losing_asks():
    one = Told()
    one.gate.samples, one.gate.interval_s, one.gate._rate, one.gate._rate_s = 30, 0.5, 2.0, 1000.0
    limit_s = 3.0 * -(log(0.6))
    assert isclose(exp(-limit_s / 3.0), 0.6)
    assert not one.gate.losing(1000.0 + limit_s - 1e-6) and one.gate.losing(1000.0 + limit_s + 1e-6)
