"""What the ship file says is wrong with an instrument is taken off what it says, and nothing else."""

from dataclasses import replace
from math import cos, pi, sin

import pytest

from twin.live.gates.faults import KnownFaults
from twin.live.observer.estimate import Estimate
from twin.live.signals.measured import Measured
from twin.physics.effects.gyro_bias import GyroBias
from twin.physics.effects.gyro_scale import GyroScale
from twin.physics.effects.heading_bias import HeadingBias
from twin.physics.effects.receiver_smoothing import ReceiverSmoothing
from twin.physics.effects.speed_log_scale import SpeedLogScale
from twin.physics.state import Rates

E = Estimate(10.0, 20.0, 3.13, 6.0, 0.5, 0.02, current_north=0.4, current_east=-0.3, ready=True)
READ = {
    "x": 11.0,
    "y": 21.0,
    "psi": -3.12,
    "u": 6.1,
    "v": 0.4,
    "r": 0.021,
    "u_r": 6.9,
    "v_r": 0.3,
    "delta": 0.1,
    "n": 1.5,
    "depth": 40.0,
}


def undone(ship, *faults, e=E, derived=(), without=()):
    known = KnownFaults(replace(ship, effects=faults))
    measured = Measured(5.0, {a: x for a, x in READ.items() if a not in without}, derived=set(derived))
    assert known.undo(measured, e, Rates(0.01, 0.0, 0.0)) is measured
    return {a: x - READ[a] for a, x in measured.si.items() if x != READ[a]}


def test_a_gyros_bias_its_scale_and_a_compasss_bias_are_taken_off_the_short_way_round(kvlcc2):
    assert undone(kvlcc2, GyroBias(bias=0.003)) == {"r": pytest.approx(-0.003)}
    assert undone(kvlcc2, GyroScale(scale=0.1)) == {"r": pytest.approx(-0.1 * E.r)}
    off = undone(kvlcc2, HeadingBias(bias=0.05))
    assert off["psi"] == pytest.approx(-0.05) and {"x", "y", "r", "u_r"}.isdisjoint(off)
    off = undone(kvlcc2, HeadingBias(bias=-0.05), e=replace(E, psi=-pi + 0.01))
    assert abs(off["psi"]) < 0.1


def test_a_logs_scale_is_that_of_the_speed_through_the_water_where_the_ship_is(kvlcc2):
    """Expected: 4 % of the estimated speed less the current in the ship's axes."""
    ahead, aside = E.current_body()
    off = undone(kvlcc2, SpeedLogScale(scale=0.04))
    assert off == {"u_r": pytest.approx(-0.04 * (6.0 - ahead)), "v_r": pytest.approx(-0.04 * (0.5 - aside))}
    assert ahead == pytest.approx(-0.4, abs=0.01) and abs(aside - 0.3) < 0.02


def test_faults_of_several_instruments_go_together_and_what_is_missing_or_derived_is_left(kvlcc2):
    both = GyroBias(bias=0.003), SpeedLogScale(scale=0.04)
    assert set(undone(kvlcc2, *both)) == {"r", "u_r", "v_r"}
    assert set(undone(kvlcc2, *both, without=("u_r",))) == {"r"}  # the log needs its speed
    assert set(undone(kvlcc2, *both, derived=("r",))) == {"u_r", "v_r"}
    assert set(undone(kvlcc2, *both, derived=("u_r",))) == {"r", "u_r", "v_r"}


def test_speeds_that_come_from_positions_have_what_the_compass_turned_and_nothing_of_the_receivers_velocity(
    kvlcc2,
):
    """Test: speed over ground measured by a receiver with an attitude of its own, and derived from positions by
    the compass. Expected: a compass bias turns only the second, and smoothing is only in the first."""
    bias, smooth = HeadingBias(bias=0.05, turned=0.0), ReceiverSmoothing(time=3.0)
    assert {"u", "v"}.isdisjoint(undone(kvlcc2, bias))
    off = undone(kvlcc2, bias, derived=("u", "v"))
    assert off["v"] == pytest.approx(-(E.v * cos(0.05) - E.u * sin(0.05)) + E.v)
    assert {"u", "v"} <= set(undone(kvlcc2, smooth))
    assert undone(kvlcc2, smooth, derived=("u", "v")) == {}


@pytest.mark.parametrize("faults, ready", (((), True), ((GyroBias(bias=0.003),), False)))
def test_without_a_fault_or_an_estimate_nothing_is_touched(kvlcc2, faults, ready):
    assert undone(kvlcc2, *faults, e=replace(E, ready=ready)) == {}
