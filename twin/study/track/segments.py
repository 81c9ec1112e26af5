"""The stretches of a voyage that are judged each on its own, and as much of the track as it takes to judge
them."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from twin.errors import DataError
from twin.physics.ship import Ship
from twin.study.track.track import Track

SEGMENT_LENGTHS = 16  # a segment lasts while the ship sails so many of its lengths
FEWEST_STEPS = 24  # of the grid, of which a segment may be
BEFORE_LENGTHS, AFTER_LENGTHS = 4, 2  # and so much of what is about it is kept


def segments(tracks: Sequence[Track], time_s: float, most: int | None = None) -> list[tuple[int, int, int]]:
    """(track, first, last) of the stretches that are filtered on their own, or an even choice of `most` and
    one more of each track that this passes over; a break in the controls ends one. `time_s`: L/U_0."""
    out = []
    for i, track in enumerate(tracks):
        length = max(32, int(SEGMENT_LENGTHS * time_s / track.h))
        edges = np.flatnonzero(np.diff(np.concatenate([[False], track.whole, [False]]).astype(int)))
        for start, stop in zip(edges[::2], edges[1::2], strict=True):
            pieces = max(1, round((stop - start) / length))
            cuts = np.linspace(start, stop, pieces + 1).astype(int)
            out += [(i, int(a), int(b)) for a, b in pairwise(cuts) if b - a >= FEWEST_STEPS]
    if most is not None and len(out) > most:
        chosen, of = set(np.linspace(0, len(out) - 1, most).astype(int).tolist()), [i for i, _, _ in out]
        for i in set(of) - {of[k] for k in chosen}:
            first, count = of.index(i), of.count(i)
            chosen.add(first + count // 2)
        out = [out[k] for k in sorted(chosen)]
    return out


def long_enough(track: Track, ship: Ship) -> Track:
    """The same track. DataError: it is nowhere whole for long enough to be filtered."""
    if segments([track], float(ship.scale("time"))):
        return track
    raise too_short(track.name, FEWEST_STEPS * track.h)


def longest_s(track: Track) -> float:
    """For how long it is whole at most [s]."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], track.whole, [False]]).astype(int)))
    return track.h * float(np.max(edges[1::2] - edges[::2], initial=0))


def too_short(names: str, least_s: float) -> DataError:
    """What is said of a voyage that is nowhere whole for so long [s]."""
    return DataError(
        f"{names}: rudder, shaft and readings are nowhere there together for {least_s:.0f} s without a gap: "
        "nothing can be judged from it. Record them without gaps."
    )


def read_parts(tracks: Sequence[Track], time_s: float, most: int | None) -> list[Track]:
    """The same tracks without what the filter would not read of them (`most` segments of all together); each
    segment keeps some of what is about it, for a slow steering gear remembers what came before."""
    chosen = segments(tracks, time_s, most)
    if len(chosen) == len(segments(tracks, time_s)):
        return list(tracks)
    return [_kept(t, [(a, b) for j, a, b in chosen if j == i], time_s / t.h) for i, t in enumerate(tracks)]


def _kept(track: Track, stretches: Sequence[tuple[int, int]], length: float) -> Track:
    """The track at these stretches and what is about them (`length`: steps in a ship length); where there are
    none, its begin."""
    keep, whole = np.zeros(len(track), bool), np.zeros(len(track), bool)
    before, after = round(BEFORE_LENGTHS * length), round(AFTER_LENGTHS * length)
    keep[:before] = not stretches
    for a, b in stretches:
        keep[max(a - before, 0) : b + after], whole[a:b] = True, True
    return replace(track, whole=whole).where(keep)
