"""How far ahead a voyage is judged, and that there is something to judge it by."""

from dataclasses import replace

import numpy as np
import pytest

from tests.study.conftest import seldom
from twin.errors import DataError
from twin.physics.model import Model
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.horizon import HORIZON_S, horizon_s, mean_horizon_s, where_read
from twin.study.diagnosis.open_loop_check import expected_errors, mean_error_m
from twin.study.track.track import track


def test_a_voyage_that_is_logged_slowly_is_judged_where_a_position_was_read(tanker, voyages):
    """Test: a sample every nine seconds, of which 120 s are no multiple. Expected: the model ends somewhere, and
    somewhere is expected, 117 s ahead; of a sample every second 120 s ahead to the last digit."""
    case = assemble([seldom(voyages["Wind"], 9)], tanker)
    assert mean_error_m(case, case.model) > 1.0 and min(expected_errors(case).values()) > 1.0
    assert horizon_s(case.tracks[0], case.model) == pytest.approx(117.0)
    assert horizon_s(track(voyages["Wind"], tanker), Model.of(tanker)) == HORIZON_S


def test_a_voyage_whose_positions_are_never_so_far_apart_is_refused_before_it_is_judged(tanker, voyages):
    """Test: a position every 250 s. Expected: one line with how often one was read and what to record."""
    every = voyages["Wind"]
    columns = {n: x.copy() for n, x in every.columns.items()}
    for name in ("north_m", "east_m"):
        columns[name][np.arange(columns[name].size) % 250 > 0] = np.nan
    with pytest.raises(
        DataError, match=r"read together 5 times in 12\d\d s, and never 120 s apart.* every 3 s"
    ):
        assemble([every.with_rows(every.time_s, columns)], tanker)


def test_times_ahead_are_asked_where_positions_were_read(tanker, voyages):
    """Test: a sample every nine seconds, one every second, and a position every 250 s. Expected: 54 s and
    117 s ahead for 60 s and 120 s, and 10 s as it is, for the nearest step is there; the same to the last
    digit; and none."""
    asked, every = [10.0, 60.0, 120.0], track(voyages["Wind"], tanker)
    slow = track(seldom(voyages["Wind"], 9), tanker)
    assert where_read([slow], asked) == pytest.approx([10.0, 54.0, 117.0])
    assert where_read([every], asked) == where_read([every, slow], asked) == asked
    measured = every.measured.copy()
    measured[np.arange(len(measured)) % round(250.0 / every.h) > 0] = np.nan
    assert where_read([replace(every, measured=measured)], asked) == []


def test_the_mean_error_of_voyages_of_unlike_length_looks_as_far_ahead_as_their_parts_do_in_the_mean(
    tanker, voyages
):
    """Test: 20 minutes, which are judged 120 s ahead, and 240 s of them, judged 60 s ahead. Expected: nearer
    to 120 s, for most parts are of the longer, whichever is given first; of one voyage, or two alike, its own."""
    whole, model = track(voyages["Wind"], tanker), Model.of(tanker)
    short = whole.part(0, round(240.0 / whole.h))
    both = mean_horizon_s([whole, short], model)
    assert horizon_s(short, model) == pytest.approx(60.0, abs=1.0) and 105.0 < both < 118.0
    assert mean_horizon_s([short, whole], model) == pytest.approx(both)
    assert mean_horizon_s([short], model) == mean_horizon_s([short] * 2, model) == horizon_s(short, model)
