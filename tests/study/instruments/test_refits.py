"""A fault is seen where fits of their own bear it out, not where one fit's scatters shrank with it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.thorough import thorough
from twin.recording.voyage import Voyage
from twin.study.instruments import findings
from twin.study.instruments.instrument_estimate import estimate
from twin.study.instruments.instrument_samples import of_voyage

SPEED_MPS, SWAY_PER_TURN_M = 7.0, -60.0


def hardly_turning(turn_deg: float, seconds: float = 2400.0, seed: int = 1) -> Voyage:
    """A sound ship on one course, then on another, with the heading swinging by a third of a degree; place,
    course and speed over ground turned by its compass, and a log of one axis, each with its usual noise."""
    rng = np.random.default_rng(seed)
    t = np.arange(seconds)
    early, late = rng.uniform(0.0, 2.0 * np.pi, 2)
    swing = 0.3 * np.sin(2.0 * np.pi * t / 120.0 + early) + 0.21 * np.sin(2.0 * np.pi * t / 47.0 + late)
    psi = np.radians(60.0 + turn_deg / (1.0 + np.exp(-(t - 0.5 * seconds) / 25.0)) + swing)
    r = np.gradient(psi, t)
    u, v = SPEED_MPS * (1.0 - 15.0 * np.abs(r)), SWAY_PER_TURN_M * r
    u = np.convolve(np.pad(u, 30, "edge"), np.full(61, 1.0 / 61.0), "valid")
    north = u * np.cos(psi) - v * np.sin(psi) + 0.2
    east = u * np.sin(psi) + v * np.cos(psi) - 0.1
    noise = lambda sd: sd * rng.standard_normal(t.size)
    shown = psi + np.radians(noise(0.05))
    over_ground = north + noise(0.03), east + noise(0.03)
    return Voyage(
        "sound",
        t,
        {
            "heading_true_north_deg": np.degrees(shown),
            "north_m": np.cumsum(north) + noise(0.5),
            "east_m": np.cumsum(east) + noise(0.5),
            "surge_velocity_mps": over_ground[0] * np.cos(shown) + over_ground[1] * np.sin(shown),
            "sway_velocity_mps": over_ground[1] * np.cos(shown) - over_ground[0] * np.sin(shown),
            "surge_velocity_through_water_mps": u + noise(0.03),
        },
        {"velocity_frame": "course"},
    )


@pytest.mark.parametrize(
    "turn_deg", [20.0, pytest.param(0.0, marks=thorough), pytest.param(60.0, marks=thorough)]
)
def test_sound_instruments_of_a_ship_that_hardly_turns_have_no_fault(turn_deg):
    """Test: a deviation, a log's scale and the like would make path and stream smaller, and their scatters with
    them. Expected: no fault, and no number called better known than a fit without it allows."""
    found = estimate([hardly_turning(turn_deg)], own=False, varying=True)
    assert found.faults == ()
    assert all(factor <= 5.0 for factor in found.log_bayes_factors.values())


def test_what_was_read_after_the_heading_was_lost_is_compared_with_nothing():
    """Test: the compass fails after a third of the voyage. Expected: the readings of all end there, and an
    instrument that begins later is none."""
    late = hardly_turning(20.0, 1200.0)
    lost, later = late.time_s > 400.0, late.time_s > 390.0
    cut = {name: x.copy() for name, x in late.columns.items()}
    cut["heading_true_north_deg"][lost] = np.nan
    cut["surge_velocity_through_water_mps"][~later] = np.nan
    read = of_voyage(replace(late, columns=cut))
    assert {kind: float(s.t[-1]) for kind, s in read.by.items()} == dict.fromkeys(read.by, 400.0)
    assert "place" in read.by and "log" not in read.by


def test_the_usual_speed_by_place_alone_does_not_count_the_noise_of_the_place():
    """Test: 7 m/s, places to 0.5 m, at 1 Hz, and shown to 5 m. Expected: 7 m/s."""
    sailed = hardly_turning(20.0)
    alone = {name: x for name, x in sailed.columns.items() if "velocity_mps" not in name}
    noise = np.random.default_rng(1).normal(0.0, 5.0, (2, sailed.time_s.size))
    alone |= {c: alone[c] + e for c, e in zip(("north_m", "east_m"), noise, strict=True)}
    assert of_voyage(replace(sailed, columns=alone)).speed == pytest.approx(7.0, rel=0.1)


def test_an_age_below_zero_is_no_fault():
    """No instrument is early; the readings of a voyage on one course may ask for that all the same."""
    fault, late = np.array(["gnss_delay", "gnss_delay", "log_scale"]), np.array([True, True, False])
    book = SimpleNamespace(fault=fault, late=late)
    of = lambda *mean: SimpleNamespace(at=np.arange(3), mean=np.array(mean))
    assert findings._early(book, of(-2.5, -0.1, -0.3), "gnss_delay")
    assert not findings._early(book, of(-2.5, 0.1, -0.3), "gnss_delay")
    assert not findings._early(book, of(-2.5, -0.1, -0.3), "log_scale")
