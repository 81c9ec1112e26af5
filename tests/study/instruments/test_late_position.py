"""A receiver that is late, whose velocity the ship's compass turned, is told by the log and by nothing else."""

import numpy as np
import pytest

from twin.recording.voyage import Voyage
from twin.study.instruments.findings import Instruments
from twin.study.instruments.instrument_estimate import estimate

STEP_S = 0.1


def boat(late_s: float, log_late_s: float = 0.0, *, with_log: bool = True) -> Voyage:
    """Eight minutes of turns and changes of speed of a boat of 23 m that slides outward as hard as its rate of turn,
    and loses speed by it; half of the way at 10 m/s."""
    rng = np.random.default_rng(4)
    t = np.arange(-10.0, 480.0, STEP_S)
    legs = np.repeat(rng.choice([-0.12, -0.06, 0.0, 0.06, 0.12], t.size), rng.integers(80, 300, t.size))[
        : t.size
    ]
    ahead = np.repeat(rng.choice([5.0, 7.0, 10.0], t.size), rng.integers(500, 900, t.size))[: t.size]
    r, u, v, psi = np.zeros((4, t.size))
    u[0] = 8.0
    for k in range(t.size - 1):
        r[k + 1] = r[k] + STEP_S * (legs[k] * u[k] / 8.0 - r[k]) / 3.0
        u[k + 1] = u[k] + STEP_S * ((ahead[k] - u[k]) / 8.0 - 15.0 * r[k] ** 2)
        v[k + 1] = v[k] + STEP_S * (-4.0 * r[k] - v[k]) / 1.5
        psi[k + 1] = psi[k] + STEP_S * r[k + 1]
    way = (u + 1j * v) * np.exp(1j * psi) + 0.2 - 0.15j
    place = np.concatenate([[0.0], np.cumsum(0.5 * STEP_S * (way[1:] + way[:-1]))])

    def shown(x, late=0.0, sd=0.0):
        return np.interp(at - late, t, x) + sd * rng.normal(size=at.size)

    at = np.arange(0.0, 480.0, 0.5)
    heading = shown(psi, 0.0, 0.004)
    over_ground = shown(way.real, late_s, 0.05) + 1j * shown(way.imag, late_s, 0.05)
    turned = over_ground * np.exp(-1j * heading)
    columns = {
        "north_m": shown(place.real, late_s, 0.6),
        "east_m": shown(place.imag, late_s, 0.6),
        "heading_true_north_deg": np.mod(np.degrees(heading), 360.0),
        "yaw_rate_degps": np.degrees(shown(r, 0.0, 0.003)),
        "surge_velocity_mps": turned.real,
        "sway_velocity_mps": turned.imag,
    }
    if with_log:
        columns["surge_velocity_through_water_mps"] = shown(u, log_late_s, 0.05)
    return Voyage("boat", at, columns, {})


def found_of(voyage: Voyage) -> Instruments:
    return estimate([voyage], 23.0, own=False)


@pytest.mark.parametrize("late_s, log_late_s, fault", [(2.0, 0.0, "gnss_delay"), (0.0, 1.0, "log_delay")])
def test_of_receiver_and_log_the_later_one_is_told_and_the_log_reads_right(late_s, log_late_s, fault):
    """Test: a receiver 2 s late beside a prompt log; a log 1 s late beside a prompt receiver. Expected: that age,
    and no scale and no bias of the log, that would shrink and shift it as the late velocity does in turns."""
    found = found_of(boat(late_s, log_late_s))
    age = found.of(fault)
    assert age.seen and age.value == pytest.approx(late_s or log_late_s, abs=0.1)
    assert not {"log_scale", "log_bias", "gnss_delay", "log_delay"} & {*found.faults} - {fault}


def test_without_a_log_nothing_tells_that_a_receiver_is_late():
    """Expected: no age of it, and no other fault in its place."""
    found = found_of(boat(2.0, with_log=False))
    assert "gnss_delay" not in found.log_bayes_factors and not {"heading_delay", "antenna"} & {*found.faults}


def test_a_boat_with_a_prompt_receiver_and_log_has_no_late_one():
    assert not {"gnss_delay", "log_delay", "log_scale", "log_bias"} & {*found_of(boat(0.0)).faults}
