"""Gaps in which a control changed: nothing is judged in them, and what lies behind is begun anew."""

import numpy as np
import pytest

from bench.small_boats import ship_of
from twin import calibrate, diagnose
from twin.errors import DataError
from twin.physics.model import Model
from twin.recording.checks import losses, of_voyages
from twin.recording.unknown_controls import CONTROLS, gaps, known
from twin.recording.voyage import Voyage
from twin.study.prediction.openloop import predict
from twin.study.track.segments import segments
from twin.study.track.track import track


def without_controls(voyage, first_s, last_s, names=CONTROLS):
    gone = (voyage.time_s > first_s) & (voyage.time_s < last_s)
    return voyage.with_rows(
        voyage.time_s, {n: np.where(gone, np.nan, x) if n in names else x for n, x in voyage.columns.items()}
    )


def logged(values, waits=None):
    t = np.cumsum(np.ones(len(values)) if waits is None else np.r_[0.0, waits])
    values = np.asarray(values, float)
    return Voyage("v", t, {"rudder_angle_deg": values, "propeller_rate_rpm": np.full(t.size, 90.0)})


def test_a_gap_in_which_the_rudder_went_over_is_unknown_and_one_in_which_it_stood_is_not():
    waits = np.ones(99)
    waits[[20, 60]] = 6.0
    rudder = np.where(np.arange(100) <= 20, 0.0, 20.0)
    v = logged(rudder, waits)
    ((last, first),) = gaps(v, "rudder_angle_deg")
    assert first - last == 6.0 and last == v.time_s[20] and gaps(v, "propeller_rate_rpm") == []
    t = np.arange(0.0, v.time_s[-1], 0.5)
    np.testing.assert_array_equal(~known(v, t), (t > last) & (t < first))


def test_a_moment_without_samples_is_no_gap_however_fast_the_rudder_moves():
    rudder = np.clip(np.cumsum(np.tile(np.repeat([2.0, -2.0], 15), 10)), -20.0, 20.0)
    waits = np.ones(rudder.size - 1)
    waits[::7] = 3.0
    assert gaps(logged(rudder, waits), "rudder_angle_deg") == []


def test_noise_and_a_logger_that_speaks_when_something_changes_are_no_gaps():
    rng = np.random.default_rng(0)
    waits = np.ones(499)
    waits[::20] = 10.0
    assert gaps(logged(rng.normal(size=500), waits), "rudder_angle_deg") == [], (
        "a rudder amidships, read with noise"
    )
    steps = np.repeat(np.r_[np.arange(0.0, 20.0, 0.5), np.arange(20.0, 0.0, -0.5)], 1)
    pauses = np.where(np.arange(steps.size - 1) % 10 == 0, 60.0, 1.0)
    assert gaps(logged(steps, pauses), "rudder_angle_deg") == [], "each word half a degree on from the last"


@pytest.mark.parametrize("seconds", [6.0, 20.0])
def test_nothing_is_judged_in_a_gap_and_a_new_segment_begins_behind_it(make, kvlcc2, seconds):
    """Test: the controls of a voyage go missing for a while from shortly before the shaft's order to well
    into it."""
    whole = make(seed=1)
    rudder = np.abs(np.diff(whole["rudder_angle_deg"]))
    first = float(whole.time_s[200 + int(np.argmax(rudder[200:900]))]) - 0.5 * seconds
    voyage = without_controls(whole, first, first + seconds)
    assert len(gaps(voyage, "rudder_angle_deg")) == 1
    t = track(voyage, kvlcc2)
    inside = (t.t > first) & (t.t < first + seconds)
    assert inside.any() and not t.whole[inside].any()
    assert t.whole[~inside].mean() > 0.99
    stretches = [(t.t[a], t.t[b - 1]) for _, a, b in segments([t], float(kvlcc2.scale("time")))]
    assert all(end <= first + 2.0 or begin >= first + seconds - 2.0 for begin, end in stretches)
    assert any(first + seconds - 2.0 <= begin <= first + seconds + 2.0 for begin, _ in stretches)
    w = predict(t, Model.of(kvlcc2))
    over = (t.t[w.start] < first) & (t.t[w.start] + 120.0 > first + seconds)
    assert over.any() and not w.valid[-1, over].any()


def test_the_seconds_and_the_control_are_said(make, kvlcc2):
    whole = make(seed=1)
    at = float(whole.time_s[200 + int(np.argmax(np.abs(np.diff(whole["rudder_angle_deg"]))[200:900]))])
    entries = of_voyages([without_controls(whole, at - 3.0, at + 4.0, CONTROLS[:1])], kvlcc2)
    (line,) = (text for text in losses(entries) if "rudder_angle_deg" in text)
    assert "changed in 1 gap" in line and "nothing is judged there" in line
    assert not any("control" in text for text in losses(of_voyages([whole], kvlcc2)))


def test_the_voyage_of_another_vessel_is_told_by_what_drives_it(make, kvlcc2):
    """Test: a tanker's voyage with the file of a boat of thrusters, and without its shaft. Expected: what it
    has and what drives the other; then what it lacks."""
    voyage = make(seed=1)
    with pytest.raises(DataError, match="it has rudder_angle_deg, propeller_rate_rpm, and what drives"):
        track(voyage, ship_of("thrusters"))
    bare = without_controls(voyage, -1.0, 1e6, ("propeller_rate_rpm",))
    with pytest.raises(DataError, match=r"The voyage has no propeller_rate_rpm\. Check the map"):
        track(bare, kvlcc2)


@pytest.mark.parametrize("verb, known_s", [(diagnose, 40.0), (diagnose, 20.0), (calibrate, 20.0)])
def test_a_voyage_whose_controls_are_never_there_for_long_is_refused_by_name(tanker, voyages, verb, known_s):
    """Test: rudder and shaft are known for so long in every 300 s. Expected: one line that says what to record,
    where a diagnosis has nothing to predict, or the filter nothing to read."""
    v = voyages["nothing"]
    gone = v.time_s % 300.0 > known_s
    few = v.with_rows(
        v.time_s, {n: np.where(gone, np.nan, x) if n in CONTROLS else x for n, x in v.columns.items()}
    )
    with pytest.raises(DataError, match=r"nowhere there together for \d+ s without a gap"):
        verb(tanker, few)
