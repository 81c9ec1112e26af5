"""Which stretches of several voyages are read."""

import numpy as np
import pytest

from twin.study.estimation.normal import Normal
from twin.study.reference.between import voyages
from twin.study.track.segments import SEGMENT_LENGTHS, read_parts, segments
from twin.study.track.track import READINGS, Track

H, TIME_S = 1.0, 4.0  # a segment is of 64 steps


def voyage(pieces):
    """A voyage of so many segments."""
    n = round(pieces * SEGMENT_LENGTHS * TIME_S / H)
    none = np.zeros(n)
    seen = np.zeros((n, len(READINGS)))
    return Track("v", H * np.arange(n), H, seen[:, :6], none, none, {}, seen, np.ones(8), none == 0.0)


@pytest.mark.parametrize("pieces", [(60, 1, 60), (60, 1), (1, 60), (5,) * 7 + (1, 1), (2,) * 80])
def test_of_every_voyage_something_is_read(pieces):
    """Test: short voyages among long ones, of which an even choice has no segment, and more voyages than are
    chosen. Expected: the even choice and a segment of each; each is a voyage by itself for what differs between
    them."""
    tracks, most = [voyage(k) for k in pieces], 20
    parts = read_parts(tracks, TIME_S, most)
    where = segments(parts, TIME_S)
    assert {i for i, _, _ in where} == set(range(len(pieces)))
    assert most <= len(where) <= most + len(pieces)
    every = segments(tracks, TIME_S)
    assert set(segments(tracks, TIME_S, most)) >= {
        every[k] for k in np.linspace(0, len(every) - 1, most).astype(int)
    }
    S = len(where)
    normal = Normal(np.zeros((S, 1, 1)), np.zeros((S, 1)), *np.zeros((3, S)), np.zeros((S, 8)), tuple(where))
    assert len(voyages(normal, np.ones(1), 1.0)) == len(tracks)


def test_an_even_choice_that_reads_every_voyage_is_kept():
    tracks = [voyage(30), voyage(30)]
    every = segments(tracks, TIME_S)
    assert segments(tracks, TIME_S, 20) == [every[k] for k in np.linspace(0, 59, 20).astype(int)]
