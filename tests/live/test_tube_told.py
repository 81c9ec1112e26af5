"""What the stabilizer tells a tube of each tick's samples, and what begins its bound anew: contradicted, too wide,
another sea, another kind of observer."""

from math import inf
from types import SimpleNamespace

import pytest

from tests.live.followed import CARRIED, INSTRUMENTS, Followed, H, RolledAlong, Watch, bounds, least, told
from twin.live.certificate.observer_tube import NO_PULL, NONE
from twin.live.contradiction import LIMIT
from twin.live.seen import Certified
from twin.live.stabilizer import Stabilizer


def test_the_tube_is_told_what_counted_as_a_measurement_and_what_pulled_without():
    """Test: a tick with all, one whose v is old and whose r was not accepted, one that came late. Expected: what counts
    pulls by itself; after a late tick only what is measured since counts, and its pull beside."""
    one = Watch()
    one.run()
    assert one.tube.stepped[-1] == ((True,) * 3, 0.5, NO_PULL, H, True, True, 0.04)
    assert one.tube.stepped[-1][2] is NO_PULL
    one.observer.received["r"] = False
    one.run(ages={"v": 1.1, "psi": 1.1}, more={"H_s": 0.7}, acts=False)
    assert one.tube.stepped[-1] == ((True, False, False), 0.7, (0.0, 0.02, 0.03), H, False, False, 0.04)
    one.observer.received["r"] = True
    one.run(dt=2.0 * H, ages={"u": 0.1})
    assert one.tube.stepped[-1] == ((False, True, True), 0.5, (0.01, 0.02, 0.03), 2.0 * H, True, True, 0.04)
    one.run(ages={"u": 0.5, "v": 0.6})
    assert one.tube.stepped[-1][0] == (True, False, True) and one.tube.stepped[-1][2] == (0.0, 0.02, 0.0)
    one.run(dt=0.5 * H, ages={"u": 0.75, "v": 0.76})
    assert one.tube.stepped[-1][0] == (True, False, True)
    one.observer.received["psi"] = False
    one.run(lost=("H_s",))
    assert one.tube.stepped[-1][1] == 0.0 and one.tube.stepped[-1][5] is False
    one.run(dt=None)
    assert one.tube.stepped[-1][3] == H


def test_a_wave_height_that_comes_or_goes_begins_the_bound_anew_and_without_one_nothing_is_promised():
    one = Watch()
    one.run(3, lost=("H_s",))
    assert one.why == ["no wave height"] * 3 and not one.said.inside
    assert told(one.tube)[0] == "know"  # the bound goes on
    held_against, one.tube.takes = [], True
    one.one._parity.feed = lambda measured, e, beta, dt: held_against.append(beta) or ""
    one.run()
    assert told(one.tube, 0) == ("reset", *bounds()) and one.why[-1].endswith("wait = 1.5 s")
    assert held_against == [pytest.approx(INSTRUMENTS[0])]
    one.run(3)
    assert one.why[-1] is None
    one.run(lost=("H_s",))
    assert told(one.tube, 0) == ("reset", *bounds()) and one.one._inside == 1


def test_a_bound_as_wide_as_the_set_is_no_bound_and_comes_back_by_what_is_known():
    wide = Certified(0.6, 1000.0, False, 180.0, 0.05, 0.0)
    one = Watch()
    one.run()
    one.tube.nothing = ["too wide"]
    assert one.run().inside
    known = least(INSTRUMENTS, CARRIED)
    assert [name for name, _, _ in one.tube.told] == ["know", "reset"]
    assert told(one.tube) == ("reset", *least(((0.3, 0.4, 0.05), 0.2), known))
    one.tube.nothing = ["too wide", "still too wide"]
    assert one.run() == wide and one.why[-1] == "still too wide"
    one.tube.left = "out"
    one.run()
    one.tube.left, one.tube.nothing = None, ["too wide"]
    assert one.run() == wide and one.why[-1] == "too wide"


@pytest.mark.parametrize("axis, said", [("u", "surge speed"), ("v", "sway speed"), ("r", "rate of turn")])
def test_a_sample_that_contradicts_the_bound_takes_the_promise_away_for_a_minute(axis, said):
    """Test: two fresh samples far off. Expected: the word of that row in each tick for a minute, though the set was
    never left; afterwards the promise waits as after any other reason."""
    one = Watch()
    one.run(2, fresh=("u", "v", "r"))
    one.observer.innovation = {axis: 9.0}
    one.run(fresh=(axis,))
    assert one.why[-1] is None and one.one._watched["uvr".index(axis)]._far == pytest.approx(LIMIT / 2.0)
    one.run(fresh=(axis,))
    assert one.why[-1] == f"{said} is measured farther from the estimate than its bound allows"
    said_s, one.observer.innovation = one.now_s, {}
    while one.now_s < said_s + 60.0 - H:
        one.run()
        assert one.why[-1] == one.one.broken != "" and not one.said.inside
    one.run()
    assert one.why[-1].endswith("wait = 1.5 s") and one.one._inside == 1 and one.one.broken == ""
    assert told(one.tube) == (
        "reset",
        *bounds(),
    )  # what was carried while it was contradicted is worth nothing
    one.run(2)
    assert not one.said.inside
    assert one.run().inside


def test_only_a_fresh_sample_in_time_is_added_up_and_only_an_accepted_one_is_a_share():
    one = Watch()
    one.run()
    one.observer.innovation = {"u": 9.0, "v": 9.0, "r": 9.0}
    one.observer.received["v"] = False
    one.run(fresh=("v", "r"), ages={"r": 1.1})
    assert [test._far > 0.0 for test in one.one._watched] == [False, True, False]
    assert [test._share > 0.0 for test in one.one._watched] == [True, False, False]


def test_a_certificate_that_does_not_hold_contradicts_nothing():
    one = Watch()
    one.tube.certificate.ok = False
    one = Watch(one.tube, why_not="no")
    one.observer.innovation = {"u": 9.0}
    one.run(5, fresh=("u",))
    assert one.one.broken == "" and one.why == ["no"] * 5


def test_rows_that_are_suspected_count_as_no_measurement_of_the_rolled_bound_and_leave_open_all():
    """Expected: distrusted only while the tube goes the way of the estimate; what the instruments leave open is then
    what a ship can do."""
    one = Watch(RolledAlong())
    one.run(2)
    assert one.tube.followed == [("the way", 0.5, True, NONE)] * 2 and not one.tube.stepped
    one.tube.uncounted = [0.0, 0.4, 0.0]
    one.observer.innovation = {"v": -9.0}
    one.run(fresh=("v",))
    assert one.one._watched[1]._off == -0.4 and one.one._watched[1].suspects
    one.tube.left = "out"
    one.run(acts=False, lost=("H_s",))
    assert (
        one.tube.followed[-1] == ("the way", 0.0, False, (False, True, False)) and one.tube.distrusted == NONE
    )
    assert told(one.tube) == ("reset", (0.3, 4.0, pytest.approx(0.011)), pytest.approx(0.04))


def test_a_tube_that_rolls_back_follows_only_an_observer_that_does():
    one = Watch(RolledAlong())
    one.tube.step = lambda *of: one.tube.stepped.append(of)
    motion = one.observer
    one.observer = SimpleNamespace(**vars(motion), estimate=motion.estimate)
    one.run()
    assert len(one.tube.stepped) == 1 and not one.tube.followed


def test_nothing_is_known_of_before_the_first_tick():
    one = Stabilizer(Followed())
    assert one.promises and one._since_late_s == inf and one.outside == "" == one.broken
