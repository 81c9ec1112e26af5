"""A receiver that jumps and comes back tells of no force; a push that was real is kept, and so are waves."""

from dataclasses import replace

import numpy as np
import pytest

from twin.api.comparison import compare
from twin.study.prediction.tell import terminal_lines
from twin.study.track.jumps import jumps_in_words, jumps_on
from twin.study.track.track import track

AT_S, LASTED_S, JUMP_M = 400.0, 20.0, 60.0


def shifted(voyage, north_m):
    """The voyage with its place shown so far to the north (N,), and the velocity that goes with it."""
    psi, north = np.radians(voyage["heading_true_north_deg"]), np.gradient(north_m, voyage.time_s)
    moved = {
        "north_m": voyage["north_m"] + north_m,
        "surge_velocity_mps": voyage["surge_velocity_mps"] + north * np.cos(psi),
        "sway_velocity_mps": voyage["sway_velocity_mps"] - north * np.sin(psi),
    }
    return replace(voyage, columns=dict(voyage.columns) | moved)


@pytest.fixture(scope="module")
def jumped(voyages):
    """Lost by 60 m for 20 s, there and back."""
    v = voyages["nothing"]
    since = v.time_s - v.time_s[0] - AT_S
    there = (since > 0.0) & (since < LASTED_S)
    return shifted(v, JUMP_M * np.sin(np.pi * since / LASTED_S) ** 2 * there)


def test_a_place_that_jumps_and_comes_back_does_not_count(jumped, voyages, tanker):
    t, still = track(jumped, tanker), track(voyages["nothing"], tanker)
    start, end = t.jumps[0][0], t.jumps[-1][1]
    assert AT_S - 40.0 < start < AT_S + LASTED_S < end + 10.0 < AT_S + LASTED_S + 60.0
    assert {readings for _, _, readings in t.jumps} == {("place",)}
    lost = np.isfinite(still.measured) & ~np.isfinite(t.measured)
    assert 0.01 < lost[:, 0].mean() < 0.15 and not lost[:, 2].any() and t.whole.all()


def test_the_motion_is_as_it_was_without_the_jump(jumped, voyages, tanker):
    beside = track(jumped, tanker).state - track(voyages["nothing"], tanker).state
    assert np.abs(beside[:, :2]).max() < 0.15 * JUMP_M


@pytest.mark.parametrize("name", ["nothing", "RudderWear", "Current"])
def test_what_a_ship_does_by_itself_is_no_jump(voyages, tanker, name):
    assert track(voyages[name], tanker).jumps == ()


def test_a_push_that_was_real_is_still_there_behind_the_hole(voyages, tanker):
    """Test: 60 m to the north within 20 s, and no way back. Expected: behind the hole the place is the one that is
    shown."""
    v = voyages["nothing"]
    since = np.clip((v.time_s - v.time_s[0] - AT_S) / LASTED_S, 0.0, 1.0)
    t = track(shifted(v, JUMP_M * since), tanker)
    behind, still = t.t > AT_S + 120.0, track(v, tanker)
    assert t.jumps and (np.isfinite(t.measured) == np.isfinite(still.measured))[behind, 0].all()
    moved = t.state[behind, 0] - still.state[behind, 0]
    assert moved == pytest.approx(JUMP_M, abs=2.0)


def test_the_verbs_say_where_readings_do_not_count(jumped, tanker):
    said = jumps_in_words(jumps_on([track(jumped, tanker)]))
    assert len(said) == 1 and "no force that acts on this ship" in said[0] and "(place)" in said[0]
    compared = compare(tanker, jumped)
    assert compared.data["jumps"][0]["readings"] == ["place"]
    assert said[0] in terminal_lines(compared.data)
