"""On what a voyage is scored against healthy ones."""

from twin.study.diagnosis import assemble, healthy_score
from twin.study.diagnosis.healthy_score import lines_apart
from twin.study.track.segments import segments


def test_each_of_several_voyages_is_scored_on_as_many_segments_as_a_reference_was(make, kvlcc2, monkeypatch):
    """Test: two voyages of two segments each, of which two are read of all together. Expected: each is scored
    on both of its own; a single voyage on what was read of it."""
    monkeypatch.setattr(assemble, "MOST_SEGMENTS", 2)
    monkeypatch.setattr(healthy_score, "MOST_SEGMENTS", 2)
    sailed = [make(seed=i, seconds=1500.0) for i in (0, 1)]
    case, alone = assemble.assemble(sailed, kvlcc2), assemble.assemble(sailed[:1], kvlcc2)
    time = float(kvlcc2.scale("time"))

    def read(lines):
        return [len(segments([line.track], time)) for line in lines]

    assert read(case.lines) == [1, 1] and read(lines_apart(case)) == [2, 2]
    assert lines_apart(alone) is alone.lines and read(alone.lines) == [2]
    columns = [line.A.shape[-1] for line in lines_apart(case)]
    assert columns == [len(case.unknowns)] * 2
