"""What a long voyage costs in memory while it is judged."""

import tracemalloc
from importlib import import_module

import numpy as np

from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.recording.voyage import Voyage
from twin.study.estimation.columns import core_unknowns
from twin.study.estimation.linear import linearise
from twin.study.reference.nuisance import instruments
from twin.study.reference.sailed import read_all
from twin.study.track.track import track


def peak_of(action):
    """(what it gives, the most memory that it held at once [bytes], what is held afterwards)."""
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    made = action()
    after, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return made, most - before, after - before


def test_linearising_holds_no_column_twice(make, kvlcc2):
    """Expected: at its peak no more than half again of what is kept (twice as much when columns were made in
    double precision first)."""
    model, known = Model.of(kvlcc2), catalogue()
    unknowns = (*core_unknowns(model), *instruments(model, known))
    t = track(make(seed=1, seconds=4000.0), kvlcc2)
    line, most, kept = peak_of(lambda: linearise(t, model, unknowns, known))
    assert line.A.dtype == line.R.dtype == np.float32 and most < 1.5 * kept


def test_hashing_a_voyage_does_not_read_all_of_it_into_the_memory(make, kvlcc2, on_disk, monkeypatch):
    path = on_disk(make(seed=1))
    import_module("scipy.signal")  # else it would be loaded below, and pytest reads what it loads
    monkeypatch.setattr(
        "pathlib.Path.read_bytes",
        lambda self: (_ for _ in ()).throw(AssertionError("the whole file at once")),
    )
    (sailed,) = read_all([path], kvlcc2)
    assert len(sailed.sha256) == 64


def test_only_what_is_asked_of_a_voyage_is_put_on_the_grid_for_its_controls(make, kvlcc2, monkeypatch):
    seen, whole = [], Voyage.on_grid
    monkeypatch.setattr(
        Voyage, "on_grid", lambda self, *a, **k: (seen.append(set(self.columns)), whole(self, *a, **k))[1]
    )
    track(make(seed=1), kvlcc2)
    assert (
        {"rudder_angle_deg"} in seen
        and {"propeller_rate_rpm"} in seen
        and not any("north_m" in columns for columns in seen)
    )
