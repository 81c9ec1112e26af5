"""What the checks of instruments against each other feed to their tests, on made-up measurements whose answer is
known: a second writing of their equations, number by number."""

import cmath
import random
from math import atan2, cos, hypot, inf, pi, sin

import pytest

from twin.live.gates import crosscheck, cusum
from twin.live.gates.crosscheck import COMPASS, CURRENT, POSITIONS, CrossChecks, Heading, Stream, Way
from twin.live.gates.cusum import Cusum
from twin.live.gates.hole import is_hole
from twin.live.signals.measured import Measured

U_0, STEP_S = 8.0, 0.5


class Noted:
    """In a test's place: takes down what it is fed with."""

    def __init__(self):
        self.fed, self.alarm, self.calm, self.suspicious = [], False, True, False

    def feed(self, x, allowed=0.0):
        self.fed.append((x, allowed))
        return self.alarm

    def usual(self, off):
        return off


def tick(now_s, si, age_s=0.0, fresh=None, derived=()):
    """A tick whose measurements are all `age_s` old."""
    fresh = si if fresh is None else fresh
    return Measured(
        now_s,
        dict(si),
        dict.fromkeys(fresh, STEP_S),
        derived=set(derived),
        time=dict.fromkeys(si, now_s - age_s),
    )


def walked(u, v, psi, off, age_s=0.3, alter=lambda k, measured: measured, ticks=45):
    """A ship at a constant speed whose positions walk off by `off` (north, east) [m/s]: what the tests of along
    and across were fed."""
    way, along, across = Way(U_0), Noted(), Noted()
    way._tests = along, across
    north, east = u * cos(psi) - v * sin(psi), u * sin(psi) + v * cos(psi)
    for k in range(ticks):
        now_s = 100.0 + STEP_S * k
        then_s = now_s - age_s
        si = {"u": u, "v": v, "psi": psi, "x": (north + off[0]) * then_s, "y": (east + off[1]) * then_s}
        way.feed(alter(k, tick(now_s, si, age_s)), STEP_S)
    return [x for x, _ in along.fed], [x for x, _ in across.fed]


@pytest.mark.parametrize(
    "u, v, psi, share",
    (
        (8.0, 0.0, 0.0, 1.0),
        (7.0, 0.8, 2.2, 8.0 / hypot(7.0, 0.8)),
        (2.0, -0.3, -1.0, 2.0),
        (16.0, 0.0, 3.0, 0.5),
    ),
)
def test_the_way_of_positions_less_that_of_speed_along_and_across_at_service_speed(u, v, psi, share):
    """Expected: two blocks of ten seconds, each the walk-off turned into the direction that is sailed."""
    off = (0.4, -0.25)
    course = psi + atan2(v, u)
    d = (off[0] + 1j * off[1]) * cmath.exp(-1j * course) * share
    along, across = walked(u, v, psi, off)
    assert along == pytest.approx([d.real] * 2) and across == pytest.approx([d.imag] * 2)


def test_of_a_ship_that_lies_still_the_way_is_told_north_and_east():
    for u, known in ((0.79, False), (0.81, True)):
        along, across = walked(u, 0.0, 1.0, (0.4, -0.25))
        d = (0.4 - 0.25j) * (cmath.exp(-1j) if known else 1.0) * 2.0
        assert along[0] == pytest.approx(d.real) and across[0] == pytest.approx(d.imag)


@pytest.mark.parametrize("lost", ("u", "v", "psi", "x", "y"))
def test_without_one_of_its_measurements_the_block_of_the_way_ends(lost):
    """Test: for one tick at 7.5 s, and at the second block. Expected: a block begins anew there."""

    def without(k, measured):
        if k in (15, 30):
            del measured.si[lost]
        return measured

    assert len(walked(8.0, 0.0, 0.0, (0.1, 0.0), alter=without)[0]) == 0
    derived = lambda k, measured: measured.derived.add(lost) or measured
    assert len(walked(8.0, 0.0, 0.0, (0.1, 0.0), alter=derived)[0]) == (0 if lost in ("u", "psi") else 2)


@pytest.mark.parametrize("rare", ("x", "y"))
def test_a_block_of_the_way_ends_with_a_position(rare):
    """Test: a position each 8 s. Expected: blocks of 16 s, the way between them counted."""

    def seldom(k, measured):
        if k % 16:
            del measured.fresh[rare]
        return measured

    along, across = walked(8.0, 0.0, 0.0, (0.1, 0.3), alter=seldom, ticks=97)
    assert along == pytest.approx([0.1] * 3) and across == pytest.approx([0.3] * 3)


def test_a_pause_begins_a_new_way():
    way, along = Way(U_0), Noted()
    way._tests = along, Noted()
    si = {"u": 8.0, "v": 0.0, "psi": 0.0, "x": 0.0, "y": 0.0}
    for k in range(25):
        if k == 15:
            way.pause()
        way.feed(tick(STEP_S * k, si), STEP_S)
    assert not along.fed


def test_the_current_is_remembered_north_and_east_and_what_parts_from_it_is_fed():
    """Test: blocks on changing headings in a current that changes; stand-ins for the tests. Expected: the current
    follows as 1/k, or as fast as it was seen to change; what made an alarm is taken back, then it follows a tenth
    as fast, and so where a test is suspicious."""
    stream, tests = Stream(U_0), (Noted(), Noted())
    stream._tests = tests
    dice, now_s, known, unsuspected = random.Random(3), 0.0, None, 0j
    for k in range(70):
        psi, there = dice.uniform(-3.0, 3.0), complex(dice.uniform(-1.0, 1.0), dice.uniform(-1.0, 1.0))
        tests[1].alarm, tests[0].calm = k in (40, 41, 42), k % 7 != 3
        tests[0].suspicious, tests[1].suspicious = k % 9 == 4, tests[1].alarm
        seen = there * cmath.exp(-1j * psi)
        for _ in range(20):
            si = {"u": 5.0, "v": 0.5, "u_r": 5.0 - seen.real, "v_r": 0.5 - seen.imag, "psi": psi}
            stream.feed(tick(now_s, si), STEP_S)
            now_s += STEP_S
        if known is None:
            known = unsuspected = there
        off = (there - known) * cmath.exp(-1j * psi)
        assert len(tests[0].fed) == len(tests[1].fed) == k + 1
        assert tests[0].fed[-1][0] == pytest.approx(off.real, abs=1e-9)
        assert tests[1].fed[-1][0] == pytest.approx(off.imag, abs=1e-9)
        alarm = k in (40, 41, 42)
        # the stand-in is in alarm before it is fed as well, so what it taught is not taken back here
        pace = 0.1 if alarm or k % 9 == 4 else 1.0
        share = 1.0 / min(k + 1, 60) if alarm else max(1.0 / min(k + 1, 60), stream._rate.gain(0.14))
        known += pace * share * off * cmath.exp(1j * psi)
        if tests[0].calm:
            unsuspected = known
        assert complex(*stream._current) == pytest.approx(known, abs=1e-9), k
        assert complex(*stream._unsuspected) == pytest.approx(unsuspected, abs=1e-9), k
        assert stream.alarm is alarm


def test_what_taught_since_it_became_suspicious_is_taken_back_once():
    stream, test = Stream(U_0), Noted()
    stream._tests = test, Noted()

    def block(ahead):
        for k in range(20):
            stream.feed(tick(STEP_S * k, {"u": 5.0, "u_r": 5.0 - ahead, "psi": 0.0}), STEP_S)

    block(1.0)
    test.calm = False
    block(2.0)
    assert stream._current == pytest.approx([1.5, 0.0]) and stream._unsuspected == pytest.approx((1.0, 0.0))
    test.feed = lambda x: [setattr(test, word, True) for word in ("alarm", "suspicious")]
    block(3.0)  # the alarm: back to 1.0, then a tenth of a third of 3.0 - 1.5
    assert stream._current == pytest.approx([1.0 + 0.1 / 3.0 * 1.5, 0.0])
    block(3.0)  # still there: nothing is taken back again
    assert stream._current[0] > 1.05


@pytest.mark.parametrize("lost", ("u", "u_r", "psi"))
def test_without_one_of_its_measurements_the_block_of_the_current_ends(lost):
    for derived in (False, True):
        stream = Stream(U_0)
        stream._tests = Noted(), Noted()
        for k in range(30):
            measured = tick(STEP_S * k, {"u": 5.0, "u_r": 4.0, "psi": 0.3})
            if k == 15 and derived:
                measured.derived.add(lost)
            elif k == 15:
                del measured.si[lost]
            stream.feed(measured, STEP_S)
        assert len(stream._tests[0].fed) == (1 if derived and lost == "u_r" else 0)


@pytest.mark.parametrize("turned, judged", ((0.0, True), (1.4, True), (1.8, False), (2.0 * pi, False)))
def test_a_block_in_which_the_ship_turned_through_too_much_says_nothing_of_the_current(turned, judged):
    """Expected: mean of the unit vectors over an arc a is sin(a/2)/(a/2): below 0.9 from 1.6 rad on."""
    stream = Stream(U_0)
    stream._tests = Noted(), Noted()
    for k in range(20):
        stream.feed(tick(STEP_S * k, {"u": 5.0, "u_r": 4.0, "psi": turned * k / 19.0}), STEP_S)
    assert bool(stream._tests[0].fed) is judged and (stream._tests[1].fed in ([], [(0.0, 0.0)]))


def turning(rates, psi_rate, ticks=33, step_s=0.25, psi_every=1, age_s=0.1, alter=lambda k, measured: None):
    """The heading turns at `psi_rate`, the gyro says `rates(k)`: what the test was fed."""
    heading, test = Heading(40.0), Noted()
    heading._test = test
    for k in range(ticks):
        now_s = 50.0 + step_s * k
        psi = (3.0 + psi_rate * (now_s - age_s) + pi) % (2.0 * pi) - pi
        measured = tick(now_s, {"psi": psi, "r": rates(k)}, fresh=("r",) if k % psi_every else ("psi", "r"))
        measured.time["psi"] = now_s - age_s
        alter(k, measured)
        heading.feed(measured, step_s)
    return test.fed


def test_the_turning_of_the_heading_less_that_of_the_gyro_over_four_seconds():
    """Expected: exact over the antimeridian, with a heading that is older than the gyro, and one that is seldom;
    nothing is unseen while the gyro stands."""
    for every in (1, 6):
        fed = turning(lambda k: 0.05, 0.062, psi_every=every, ticks=60)
        assert len(fed) >= 2 and [x for x, _ in fed] == pytest.approx([0.012] * len(fed))
        assert [unseen for _, unseen in fed] == [0.0] * len(fed)
    assert (
        len(turning(lambda k: 0.05, 0.05, ticks=16)) == 0
        and len(turning(lambda k: 0.05, 0.05, ticks=17)) == 1
    )


def test_between_two_samples_of_the_gyro_it_is_taken_by_the_trapezoid_and_half_the_difference_is_unseen():
    """Test: a gyro that swings between 0.01 and 0.07 rad/s. Expected: its mean; half of 0.06 unseen."""
    fed = turning(lambda k: 0.01 if k % 2 else 0.07, 0.04, age_s=0.0)
    assert [x for x, _ in fed] == pytest.approx([0.0] * 2, abs=1e-12)
    assert [unseen for _, unseen in fed] == pytest.approx([0.03] * 2)


@pytest.mark.parametrize("lost", ("psi", "r"))
def test_without_heading_or_gyro_a_stretch_ends_and_the_gyros_last_sample_is_forgotten(lost):
    def without(k, measured):
        if 10 <= k < 18:
            del measured.si[lost]

    fed = turning(lambda k: 0.5 if k < 10 else 0.05, 0.062, ticks=36, alter=without)
    assert fed == [(pytest.approx(0.012), 0.0)]
    derived = lambda k, measured: measured.derived.add(lost)
    assert turning(lambda k: 0.05, 0.062, alter=derived) == []


def test_each_alarm_has_its_words_in_their_order_and_a_hole_pauses_every_check(kvlcc2):
    checks = CrossChecks(kvlcc2)
    assert checks.reasons == [] and len(checks._lacking) == 2
    lacks = [Noted(), Noted()]
    for one in lacks:
        one.reasons, one.fed, one.paused = ["the shaft", "the rudder"], [], 0
        one.feed, one.pause = one.fed.append, lambda one=one: setattr(one, "paused", one.paused + 1)
    checks._lacking = tuple(lacks)
    measured = tick(0.0, {})
    now = crosscheck.CorrectedTick(measured, None, None, None, None, 0.1)
    for check, alarm in ((checks._heading, "_test"), (checks._way, "_tests"), (checks._stream, "_tests")):
        stub = Noted()
        stub.alarm = True
        setattr(check, alarm, stub if alarm == "_test" else (Noted(), stub))
    checks.feed(now)
    assert checks.reasons == [COMPASS, POSITIONS, CURRENT, "the shaft", "the rudder"]
    assert [one.fed for one in lacks] == [[now], [now]] and [one.paused for one in lacks] == [0, 0]
    checks._way._start = checks._heading._start = (1.0, 2.0, 3.0)
    checks._stream._since_s = 4.0
    checks.feed(now._replace(dt=1.01))
    assert [one.paused for one in lacks] == [1, 1] and [one.fed for one in lacks] == [[now], [now]]
    assert checks._way._start is checks._heading._start is None and checks._stream._since_s == 0.0


@pytest.mark.parametrize(
    "dt, period_s, hole",
    ((0.1, 0.1, False), (1.0, 0.1, False), (1.01, 0.1, True), (0.0, 0.1, True), (-1.0, 0.1, True),
     (1.4, 1.0, False), (1.5, 1.0, False), (1.51, 1.0, True), (float("nan"), 0.1, True)),
)  # fmt: skip
def test_a_hole_is_over_a_second_and_over_one_and_a_half_periods(dt, period_s, hole):
    assert is_hole(dt, period_s) is hole


def test_scales_and_limits_of_each_check():
    """Expected: what a block may be off without being noise, in the ship's own speed."""
    way, stream, heading = Way(U_0), Stream(U_0), Heading(40.0)
    assert [x for t in way._tests for x in (t.least, t.most)] == pytest.approx([0.1, 0.24, 0.1, 0.48])
    assert [x for t in stream._tests for x in (t.least, t.most)] == pytest.approx([0.14, 0.0] * 2)
    assert (heading._test.least, heading._test.most) == (3e-4, 6e-4)
    assert Cusum(0.1).most == inf and Cusum(0.1).scale == 0.1 and Cusum(0.1).mean == 0.0
    assert cusum.H == 10.0
