"""The stabilizer beside a tube that takes down what it is told: when a promise is given and what it waits for, tick by
tick and reason by reason."""

from math import inf, pi

import pytest

from tests.live.followed import CARRIED, INSTRUMENTS, WINDOW, H, Motion, Watch, bounds, least, told
from twin.live.seen import Certified
from twin.live.signals.measured import Measured
from twin.live.stabilizer import Stabilizer


def test_without_a_certificate_or_an_estimate_nothing_is_promised_and_it_says_why():
    nobody = Stabilizer(None, authority_margin=0.3)
    assert nobody.step(Motion(), Measured(0.0), "s") == Certified(0.0, authority_margin=0.3)
    assert nobody.outside == "" and nobody.gain == 0.0 and not nobody.promises
    assert Stabilizer(None, "no file").outside == "no file"
    early = Watch(authority_margin=0.2)
    early.observer.ready = False
    assert early.run() == Certified(margin=0.6, authority_margin=0.2) and early.why == ["no estimate yet"]
    late = Watch(why_not="of another ship")
    late.observer.ready = False
    late.run()
    assert late.why == ["of another ship"] and late.one.gain == 0.4


@pytest.mark.parametrize("restarts", (0, 1, 7))
def test_a_promise_is_the_bound_in_speed_and_turning_with_its_margins(restarts):
    """Expected: from the first tick on, as the estimate begins at what is measured, however often it began."""
    one = Watch(authority_margin=0.2)
    one.observer.restarts = restarts
    assert one.run() == Certified(0.6, pytest.approx(0.5), True, pytest.approx(0.05 * 180.0 / pi), 0.05, 0.2)
    assert one.why == [None]
    one.tube.certificate.ok = False
    refused = Watch(one.tube, why_not="its gain does not hold")
    assert not refused.run().inside and refused.why == ["its gain does not hold"]


def test_the_promise_comes_back_when_all_that_a_late_measurement_looks_back_on_was_inside():
    """Test: one tick outside of the set. Expected: that tick and the next begin at what the instruments leave open, two
    more carry on what was known, the fourth inside promises; before it, the seconds that are left."""
    one = Watch()
    one.run(3)
    assert told(one.tube) == ("know", *least(INSTRUMENTS, CARRIED))
    one.tube.left = "too fast"
    assert not one.run().inside and one.why[-1] == "too fast" and one.one._inside == 0
    assert told(one.tube) == ("reset", *bounds())
    one.tube.left = None
    assert not one.run().inside and one.why[-1].endswith("when it was not, wait = 1.5 s")
    assert told(one.tube) == ("reset", *bounds())  # of before nothing is known
    since_s = one.now_s
    one.tube.beta = (0.2, 0.05, 0.001)
    for left_s in ("1.0", "0.50"):
        assert not one.run().inside and one.why[-1].endswith(f"wait = {left_s} s")
        assert one.tube.looked_back[-1] == ((0.01, 0.02, 0.03), 0.04, since_s)
        assert told(one.tube) == ("reset", *least(INSTRUMENTS, CARRIED))
        assert one.tube.asked[-1] == (pytest.approx(least(INSTRUMENTS, CARRIED)[0]), H)
    assert one.run().inside and one.why[-1] is None
    assert told(one.tube) == ("know", *least(INSTRUMENTS, CARRIED))
    assert one.why[-4].startswith("all is well again; the promise waits until no late measurement")
    assert one.tube.asked[-1][0] == pytest.approx(least(INSTRUMENTS, CARRIED)[0])
    for _ in range(2):  # proven: the tube's own bound counts as well
        one.run()
        assert one.tube.asked[-1] == ((0.2, 0.05, 0.001), H)


def test_where_only_the_way_to_now_left_the_set_it_begins_anew_in_this_tick_already():
    """Test: a tick whose way may have left the set though the samples of now lie in it, and the same while an
    instrument is doubted. Expected: no promise in it, and that tick counts as the first of those inside; not where
    something is wrong besides."""
    for doubt, inside in (("", 1), ("the log is broken", 0)):
        one = Watch()
        one.run(3)
        one.tube.left, one.tube.only_way = "too fast", True
        assert not one.run(doubt=doubt).inside and one.why[-1] == (doubt or "too fast")
        assert one.one._inside == inside and told(one.tube) == ("reset", *bounds())
        one.tube.left = None
        ticks = WINDOW - inside
        assert [one.run().inside for _ in range(ticks)] == [False] * (ticks - 1) + [True]


def test_a_bound_that_rests_on_what_was_before_is_none_and_no_way_before_counts():
    """Test: a sample whose time is before the ship was surely inside. Expected: no promise in that tick, though the
    ticks inside are enough and the way back left the set; at the next one it is back."""
    one = Watch()
    one.run(WINDOW + 1)
    one.tube.from_s, one.tube.left, one.tube.only_way = 0.0, "too fast", True
    assert not one.run().inside and one.why[-1].endswith(f"wait = {H:.2f} s")
    one.tube.from_s, one.tube.left = inf, None
    assert one.run().inside


def test_what_was_measured_since_it_is_inside_leaves_open_its_ages_way():
    """Test: all samples stay the same for three seconds where the certificate allows one. Expected: while it has been
    inside since before they were measured they count with the way of their age; once outside they leave open all."""
    one = Watch()
    one.run(2)
    old = dict.fromkeys(("u", "v", "r", "psi"), 1.0)
    one.tube.beta = (9.0, 9.0, 9.0)
    one.run(ages=old)
    assert one.tube.asked[-1][0] == pytest.approx(least(bounds(1.0), CARRIED)[0])
    one.tube.left = "out"
    one.run()
    old = dict.fromkeys(old, 1.2)
    one.run(ages=old)
    assert told(one.tube) == ("reset", (12.0, 4.0, 0.1), pi)
    one.tube.left = None
    one.run(3)
    old = dict.fromkeys(old, 1.0 + 1e-9)  # inside for 1.0 s before this tick, and then for 1.5
    one.run(ages=old)
    assert told(one.tube)[0] == "know" and one.tube.asked[-1][0] == pytest.approx(
        least(bounds(1.0), CARRIED)[0]
    )


def test_each_reason_comes_before_the_next_and_any_of_them_ends_the_promise():
    """Expected: late, what is known to be wrong, places that do not confirm the motion, what nobody measures, what
    stepped, what leaves the set."""
    for reason, of in (
        ("the tick came late, after = 1.5 s where 0.50 s are certified", {"dt": 1.5}),
        ("the log is broken", {"doubt": "the log is broken"}),
        ("no rudder_angle_deg", {"lost": ("delta",)}),
        ("no propeller_rate_rpm", {"lost": ("n",)}),
        ("no heading", {"lost": ("psi",)}),
        ("v stepped and is believed", {"steps": {"v": 1.0}}),
    ):
        one = Watch()
        one.run(2)
        assert not one.run(**of).inside and one.why == [None, None, reason]
        both = Watch()
        both.tube.left = "too fast"
        both.run(**of)
        assert both.why == [reason]
    one = Watch()
    one.run(doubt="the log", dt=1.5, steps={"u": 1.0})
    one.run(doubt="the log", steps={"u": 1.0}, lost=("n",))
    one.run(steps={"u": 1.0}, lost=("n",))
    assert [why.split()[0] + " " + why.split()[1] for why in one.why] == [
        "the tick",
        "the log",
        "no propeller_rate_rpm",
    ]
    one = Watch()
    one.one._parity.feed = lambda *of: one.__setattr__("heard", of) or "apart"
    one.tube.heading_noise = 0.03
    one.run(lost=("n",))
    assert (
        one.why == ["apart"] and one.one._parity.heading_noise == 0.03 and one.heard[2:] == (one.tube.beta, H)
    )


def test_places_are_held_against_the_motion_from_each_beginning_of_the_estimate():
    one, begun = Watch(), []
    one.one._parity.begin = lambda: begun.append(one.now_s)
    one.run(3)
    one.observer.restarts += 1
    one.run(2)
    assert begun == [100.0 + H, 100.0 + 4 * H]


def test_an_estimate_that_begins_anew_begins_at_what_the_instruments_leave_open():
    """Test: set anew while v is too old. Expected: v is open, and said once something leaves the set, till it is
    measured; the promise holds on."""
    one = Watch()
    one.run(6)
    one.observer.restarts += 1
    first = one.run(ages={"v": 1.2})
    assert one.tube.told[0] == ("reset", pytest.approx((0.3, 4.0, 0.011)), pytest.approx(0.04))
    assert first.inside and one.one._inside == WINDOW + 1
    one.tube.left = "too fast"
    one.run(ages={"v": 1.2})
    assert (
        one.why[-1]
        == "sway speed through water is not measured often enough, age = 1.2 s where at most 1.0 s are certified"
    )
    one.run()
    assert one.why[-1] == "too fast"
    one = Watch()
    one.run(ages={"v": 1.2})
    one.run()
    one.tube.left = "too fast"
    one.run(ages={"v": 1.2})  # it has been measured since
    assert one.why[-1] == "too fast"


def test_an_estimate_that_begins_in_waves_is_off_by_their_motion_too():
    """Expected: the tube is set to that sea before it is asked what the instruments leave open, at each beginning."""
    one = Watch()
    one.run(3)
    assert one.tube.seas == [(0.5, True)]
    one.observer.restarts += 1
    one.run(more={"H_s": 2.0})
    one.run()
    assert one.tube.seas == [(0.5, True), (2.0, True)]


def test_after_a_late_tick_only_what_was_measured_since_leaves_anything_known():
    """Test: v is older than the late tick; the estimate begins anew, or it is outside of the set. Expected: v is open."""
    one = Watch()
    one.run(3)
    one.run(dt=2.0 * H)
    one.observer.restarts += 1
    one.run(ages={"v": 0.6})
    assert told(one.tube, 0)[1] == (0.3, 4.0, 0.011)
    one = Watch()
    one.run(3)
    one.tube.left = "too fast"
    one.run(dt=2.0 * H)
    one.run(ages={"v": 0.9})
    assert told(one.tube)[1] == (pytest.approx(0.3), 4.0, pytest.approx(0.011))


def test_of_what_was_never_measured_it_is_said_so_and_later_that_it_is_not():
    one = Watch()
    one.tube.left = "too fast"
    one.run(lost=("r",))
    one.run(derived=("r",))
    one.run()
    one.run(lost=("r",))
    assert one.why == [
        "rate of turn is not measured yet",
        "rate of turn is not measured yet",
        "too fast",
        "rate of turn is not measured",
    ]
