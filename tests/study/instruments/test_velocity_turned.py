"""What turned the velocity into the ship's axes, from the noise of heading and velocity alone."""

from dataclasses import replace

import numpy as np
import pytest

from tests.study.instruments.test_instruments import voyage
from twin.study.instruments.instrument_samples import ReadingSamples, of_voyage
from twin.study.instruments.velocity_turned import UNKNOWN, TurnedShare, turned_share

HEADING, U, V = "heading_true_north_deg", "surge_velocity_mps", "sway_velocity_mps"


def sailed(seed, by, heading_deg=0.2, speed=0.04, coarse=False, n=900, yaw_deg=0.0, sway=0.0):
    """Readings of a ship that winds along at 6 m/s, one a second; yaw and sway in waves of 8 s, in step."""
    rng, t = np.random.default_rng(seed), np.arange(float(n))
    wave = np.sin(2.0 * np.pi * t / 8.0)
    psi = 1.2 * np.sin(2.0 * np.pi * t / 300.0) + np.radians(yaw_deg) * wave
    u = 6.0 + 0.3 * np.sin(t / 90.0) + speed * rng.normal(size=n)
    v = -0.4 * np.cos(2.0 * np.pi * t / 300.0) + sway * wave + speed * rng.normal(size=n)
    shown = psi + np.radians(heading_deg) * rng.normal(size=n)
    shown = np.round(shown, 2) if coarse else shown
    if by == "compass":
        ground = (u + 1j * v) * np.exp(1j * (psi - shown))
        u, v = ground.real, ground.imag
    columns = {"time_s": t, "north_m": 6.0 * t, "east_m": 0.0 * t, HEADING: np.degrees(shown) % 360.0}
    return of_voyage(voyage(columns | {U: u, V: v}, ""))


@pytest.mark.parametrize("coarse", [False, True])
@pytest.mark.parametrize("by", ["compass", "receiver"])
def test_the_noise_of_the_heading_in_the_velocity_says_what_turned_it(by, coarse):
    for seed in range(0, 40, 2):
        told = turned_share([sailed(seed, by, coarse=coarse), sailed(seed + 1, by, coarse=coarse)])
        assert told.by == by
        assert abs(told.share - (by == "compass")) < 5.0 * told.sd


def test_what_one_voyage_leaves_open_several_tell_together():
    voyages = [sailed(seed, "compass", heading_deg=0.07) for seed in range(8)]
    assert [turned_share([v]).by for v in voyages].count("receiver") == 0
    assert turned_share(voyages[:1]).sd > 2.0 * turned_share(voyages).sd
    assert turned_share([sailed(1, "compass", heading_deg=0.4)]).by == ""
    assert turned_share(voyages).by == "compass"


@pytest.mark.parametrize("by", ["compass", "receiver"])
def test_yaw_and_sway_in_waves_are_no_noise(by):
    """In step they look as an error of the heading in the velocity does."""
    assert turned_share([sailed(seed, by, yaw_deg=2.0, sway=-0.2) for seed in (1, 2)]).by == by


@pytest.mark.parametrize("by", ["compass", "receiver"])
def test_readings_without_noise_say_nothing(by):
    assert turned_share([sailed(1, by, heading_deg=0.0, speed=0.0)]) == UNKNOWN


def test_a_gap_and_a_jump_change_nothing():
    whole = sailed(3, "compass", n=1200)
    other = sailed(4, "compass")
    before = turned_share([whole, other])
    v, psi = whole.by["velocity"], whole.by["heading at velocity"]
    v.y[600] += 3.0
    keep = np.r_[0:300, 420 : v.t.size]
    for s in (v, psi):
        object.__setattr__(s, "t", s.t[keep])
        object.__setattr__(s, "y", s.y[keep])
    assert turned_share([whole, other]).by == before.by == "compass"
    assert abs(turned_share([whole, other]).share - before.share) < 3.0 * before.sd


def test_half_a_share_is_neither():
    assert [TurnedShare(share, 0.01, 4).by for share in (-0.5, 0.4, 0.5, 1.5)] == [""] * 4
    assert (TurnedShare(0.95, 0.05, 4).by, TurnedShare(0.1, 0.05, 4).by) == ("compass", "receiver")


def test_voyages_that_contradict_each_other_are_believed_less():
    """What waves make of the share is another on each."""
    alike, apart = [sailed(seed, "compass") for seed in (1, 2)], [sailed(1, "compass"), sailed(2, "receiver")]
    assert turned_share(apart).sd > 3.0 * turned_share(alike).sd
    assert turned_share(apart).by == ""


def test_a_heading_that_stands_still_says_nothing():
    """Shown in whole degrees, on one course."""
    one = sailed(1, "compass")
    still = {
        k: ReadingSamples(s.t, 0.0 * s.y) if k == "heading at velocity" else s for k, s in one.by.items()
    }
    assert turned_share([replace(one, by=still)]) == UNKNOWN
