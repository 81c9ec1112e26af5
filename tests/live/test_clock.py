"""Deadlines that are kept, counted when missed, never made up by a burst (C2, C9, C10); a replay's clock."""

import itertools

import pytest

from twin.live.clock import MonotonicClock, ReplayClock


class Scenario:
    """A world whose time moves only when somebody sleeps or `pass_by` is called."""

    def __init__(self) -> None:
        self.mono, self.set_by = 100.0, 0.0

    def monotonic(self) -> float:
        return self.mono

    def wall(self) -> float:
        return 1.75e9 + self.mono + self.set_by

    def pass_by(self, seconds: float) -> None:
        self.mono += seconds

    def clock(self, rate_hz: float = 50.0) -> MonotonicClock:
        return MonotonicClock(rate_hz, self.monotonic, self.wall, self.pass_by)


def test_deadlines_do_not_drift_however_long_the_steps_take() -> None:
    scenario = Scenario()
    clock = scenario.clock()
    times = []
    for _ in range(1000):
        times.append(clock.wait().time_s)
        scenario.pass_by(0.013)
    assert times == pytest.approx([100.0 + i * 0.02 for i in range(1000)], abs=1e-9)
    assert clock.overruns == 0


def test_C2_a_stall_of_200_ms_skips_periods_and_makes_no_burst() -> None:
    scenario = Scenario()
    clock = scenario.clock()
    clock.wait()
    scenario.pass_by(0.207)
    late = clock.wait()
    assert (late.skipped, clock.overruns) == (9, 9)
    assert late.late_s == pytest.approx(0.007)
    after = clock.wait()
    assert after.skipped == 0 and after.time_s == pytest.approx(100.22)


@pytest.mark.parametrize("stall_s", [0.2, 0.2192, 0.211, 0.2001, 0.209])
def test_C2_after_a_stall_in_its_sleep_no_two_ticks_are_closer_than_half_a_period(stall_s: float) -> None:
    scenario = Scenario()

    def stalled(seconds: float) -> None:
        scenario.pass_by(seconds + (stall_s if scenario.mono < 100.01 else 0.0))

    clock = MonotonicClock(50.0, scenario.monotonic, scenario.wall, stalled)
    times = [clock.wait().time_s for _ in range(6)]
    gaps = [b - a for a, b in itertools.pairwise(times)]
    assert max(gaps) > stall_s and min(gaps) >= 0.01 - 1e-9
    assert clock.overruns >= 9 and times[-1] - 100.0 == pytest.approx(
        round((times[-1] - 100.0) / 0.02) * 0.02
    )


def test_a_step_that_is_merely_late_skips_nothing() -> None:
    scenario = Scenario()
    clock = scenario.clock()
    clock.wait()
    scenario.pass_by(0.025)
    late = clock.wait()
    assert late.skipped == 0 and late.late_s == pytest.approx(0.005)


@pytest.mark.parametrize("step_s", [3600.0, -7200.0, 1.0])
def test_C9_a_step_of_the_wall_clock_moves_no_deadline(step_s: float) -> None:
    scenario = Scenario()
    clock = scenario.clock()
    first = clock.wait()
    scenario.set_by = step_s
    stepped = clock.wait()
    assert stepped.wall_s - first.wall_s == pytest.approx(step_s + 0.02)
    assert stepped.time_s == pytest.approx(100.02) and stepped.skipped == 0


def test_C10_a_pause_of_ten_seconds_is_one_skip() -> None:
    scenario = Scenario()
    clock = scenario.clock(10.0)
    clock.wait()
    scenario.pass_by(10.0)
    assert clock.wait().skipped == 99


def test_slack_is_what_is_left_of_the_period() -> None:
    scenario = Scenario()
    clock = scenario.clock()
    clock.wait()
    scenario.pass_by(0.004)
    assert clock.slack_s() == pytest.approx(0.016)


def test_the_real_clock_keeps_50_hz() -> None:
    clock = MonotonicClock(50.0)
    times = [clock.wait().time_s for _ in range(26)]
    assert times[-1] - times[0] == pytest.approx(0.5, abs=0.2)


def test_a_replay_gives_the_logs_instants_and_ends() -> None:
    clock = ReplayClock([(1.0, 11.0), (1.1, 11.1)])
    assert [(i.time_s, i.wall_s) for i in iter(clock.wait, None)] == [(1.0, 11.0), (1.1, 11.1)]
    assert clock.wait() is None and clock.slack_s() is None


def test_instants_of_a_log_are_never_late_and_skip_nothing():
    assert ReplayClock([(3.0, 4.0)]).wait() == (0, 3.0, 4.0, 0.0, 0)
