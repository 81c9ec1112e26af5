"""What is learned from: the frame that drifts with the water, and a split through which nothing leaks."""

from itertools import pairwise

import numpy as np
import pytest

from export.data import BLOCK_S, PARTS, leg, model_of, split
from twin.errors import DataError


@pytest.fixture(scope="module")
def legs(ship, sailed):
    tracks = [s.track for s in sailed]
    return [leg(t, model_of(ship, tracks)) for t in tracks]


def test_the_water_is_found_and_gone(legs):
    """Expected: the current that was sailed in, within the noise of log and GNSS; speeds are those through
    the water."""
    one = legs[0]
    assert np.allclose(one.water[200:].mean(0), (0.3, -0.2), atol=0.02)
    c, s = np.cos(one.state[:, 2]), np.sin(one.state[:, 2])
    place = np.gradient(one.state[:, :2], one.h, axis=0)
    along = place[:, 0] * c + place[:, 1] * s
    assert np.abs(along - one.state[:, 3])[20:-20].mean() < 0.02


def test_the_water_is_known_from_the_past_alone(ship, sailed):
    """Test: cut a track short. Expected: the same current up to the cut but for its smoothed last moments."""
    t = sailed[0].track
    model = model_of(ship, [t])
    whole, cut = leg(t, model), leg(t.part(0, 300), model)
    assert np.allclose(whole.water[:280], cut.water[:280], atol=1e-9)


def test_whole_voyages_go_to_one_part_in_the_order_of_time(legs):
    parts = split(legs)
    named = {part: [one.name for one in parts[part]] for part in PARTS}
    assert named == {"train": ["v0", "v1", "v2", "v3"], "validation": ["v4"], "test": ["v5"]}


def test_no_moment_of_a_single_voyage_is_in_two_parts_and_a_block_lies_between(legs):
    """Test: one voyage, cut in time. Expected: parts in order, at least one whole block of nobody's between
    them."""
    parts = split(legs[:1])
    block = min(BLOCK_S, len(legs[0]) * legs[0].h / 12)
    ends = [(parts[p][0].t[0], parts[p][0].t[-1]) for p in PARTS]
    for (_, end), (start, _) in pairwise(ends):
        assert start - end >= block


def test_windows_stay_inside_their_part(legs):
    """Expected: no roll-out begins where it would run into the gap."""
    part = split(legs[:1])["train"][0]
    assert part.starts(48, 5).max() + 48 < len(part)


def test_too_little_is_refused(legs):
    with pytest.raises(DataError, match="Give more"):
        split([legs[0].part(0, 2)])
