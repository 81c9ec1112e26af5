"""The parts of a voyage, each judged with numbers fitted to the others."""

import numpy as np

from tests.study.track.test_holes import with_hole
from twin.study.track.segments import segments
from twin.study.track.track import track
from twin.study.update.adding import FOLDS, part_of, parts_of


def test_a_fit_leaves_out_the_segments_that_lie_in_the_part_it_is_judged_by(make, kvlcc2):
    """Test: a voyage with a hole of eleven hours, linearised whole, and only from the first segment behind the
    hole on. Expected: every segment is of the part in which its middle is judged, and no part has none."""
    t = track(with_hole(make(seconds=3000.0), 4e4, at_s=300.0), kvlcc2)
    where = segments([t], 0.25 * float(kvlcc2.scale("time")))
    parts = parts_of([t], [t], where)
    assert parts.tolist() == [part_of(0.5 * (a + b - 1), len(t)) for _, a, b in where]
    assert np.unique(parts).size == FOLDS
    first = next(a for _, a, _ in where if t.t[a] > 4e4)
    behind = [(i, a - first, b - first) for i, a, b in where if a >= first]
    assert parts_of([t], [t.part(first, len(t))], behind).tolist() == parts[-len(behind) :].tolist()
