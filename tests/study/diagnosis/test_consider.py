"""Facts about the causes of an explanation."""

from types import SimpleNamespace

import numpy as np
import pytest

from twin.study.diagnosis import assemble, consider
from twin.study.diagnosis.consider import lines_apart, without_hollow
from twin.study.diagnosis.facts import Cause
from twin.study.track.segments import segments

EXPLANATION = ("HullFouling", "RudderOffset", "SpeedLogBias")
KEPT = EXPLANATION[:2]


def cause(name, reached=None):
    return Cause(name, "ship", True, False, False, 0.9, 0.9, 20.0, 20.0, 0.1, 5.0, 1.0, reached)


def case_in_which(**sizes):
    """A case, and the set of the two causes of the ship fitted to these sizes."""
    case = SimpleNamespace(
        effects=[SimpleNamespace(owner=name, name="size") for name in EXPLANATION],
        catalogue={name: SimpleNamespace(size="") for name in EXPLANATION},
    )
    z = np.array([sizes.get(name, 0.0) for name in EXPLANATION])
    return case, {KEPT: SimpleNamespace(posterior=SimpleNamespace(z=z))}


@pytest.mark.parametrize(
    "log_as_before, fouling, explains",
    [
        (1.0, 0.0, ["RudderOffset", "SpeedLogBias"]),  # fouling only made good what the log took
        (1.0, 1.2, [*EXPLANATION]),
        (None, 0.0, [*EXPLANATION]),  # nothing is taken out of the explanation
    ],
)
def test_a_cause_that_ends_at_nothing_without_an_instrument_that_is_as_it_was_explains_nothing(
    log_as_before, fouling, explains
):
    case, found = case_in_which(HullFouling=fouling, RudderOffset=2.0)
    causes = [*map(cause, KEPT), cause("SpeedLogBias", log_as_before)]
    told = without_hollow(case, found, EXPLANATION, causes)
    assert [c.effect for c in told if c.in_explanation] == explains
    assert without_hollow(case, {}, EXPLANATION, causes) == causes  # nobody fitted what is left


def test_each_of_several_voyages_is_scored_on_as_many_segments_as_a_reference_was(make, kvlcc2, monkeypatch):
    """Test: two voyages of two segments each, of which two are read of all together. Expected: each is scored
    on both of its own; a single voyage on what was read of it."""
    monkeypatch.setattr(assemble, "MOST_SEGMENTS", 2)
    monkeypatch.setattr(consider, "MOST_SEGMENTS", 2)
    sailed = [make(seed=i, seconds=1500.0) for i in (0, 1)]
    case, alone = assemble.assemble(sailed, kvlcc2), assemble.assemble(sailed[:1], kvlcc2)
    time = float(kvlcc2.scale("time"))

    def read(lines):
        return [len(segments([line.track], time)) for line in lines]

    assert read(case.lines) == [1, 1] and read(lines_apart(case)) == [2, 2]
    assert lines_apart(alone) is alone.lines and read(alone.lines) == [2]
    columns = [line.A.shape[-1] for line in lines_apart(case)]
    assert columns == [len(case.unknowns)] * 2
