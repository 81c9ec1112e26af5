"""The inputs that the fuzzer kept, and those that once broke something, each once and without the fuzzer."""

import json
from pathlib import Path

import pytest

from bench.fuzz.aboard import FuzzedVoyage, LoopTarget, Watched
from bench.fuzz.run import Fuzzing, added, known, read
from bench.fuzz.targets import TARGETS
from twin.live.left_open import LeftOpen

CORPUS = Path(__file__).parent / "corpus"
AT_MOST = 120  # inputs of a target: the suite has other things to do


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """`made(name)` is a target, made once."""
    kept = {}

    def make(name):
        if name not in kept:
            certificate = tmp_path_factory.mktemp("fuzz") / "certificate.json"
            kept[name] = LoopTarget(certificate) if name == "loop" else TARGETS[name].make()
        return kept[name]

    return make


@pytest.mark.parametrize("name", TARGETS)
def test_what_the_fuzzer_kept_breaks_nothing(made, name):
    """Test: every input of the corpus, and the seeds. Expected: no promise of the target is broken."""
    target, inputs = made(name), sorted((CORPUS / name).glob("*"))[:AT_MOST]
    assert inputs, f"no corpus of {name}: twin-bench fuzz --target {name}"
    for data in (*(path.read_bytes() for path in inputs), *TARGETS[name].seeds()):
        target.one(data)


def test_the_corpus_sails_through_pauses_set_clocks_and_silence_with_a_promise_in_between(made):
    """Expected: taken together the loop's inputs come to every kind of decision, and the promise is given,
    taken back and given again: otherwise nothing would be tried."""
    target, fates = made("loop"), []
    look = FuzzedVoyage._look

    def noted(sailing, tick):
        fates.append((tick.certificate.inside, tick.mode))
        look(sailing, tick)

    FuzzedVoyage._look = noted
    try:
        for path in sorted((CORPUS / "loop").glob("*"))[:AT_MOST]:
            target.one(path.read_bytes())
    finally:
        FuzzedVoyage._look = look
    assert {inside for inside, _ in fates} == {True, False}
    assert {"hybrid", "dead reckoning"} <= {mode for _, mode in fates}


def test_a_loop_that_takes_a_sample_for_the_truth_is_found(made, monkeypatch):
    """Test: what a sample leaves open loses the instrument's noise and its age. Expected: a seed finds the
    promise that is not kept."""
    target = made("loop")
    monkeypatch.setattr(LeftOpen, "bounds", property(lambda _: ((0.0, 0.0, 0.0), 0.0)))
    with pytest.raises(Watched, match="a promise that is not kept"):
        for data in TARGETS["loop"].seeds():
            target.one(data)


def test_what_libfuzzer_says_is_read():
    """Expected: counts of the last line of progress; what was raised, and the input that did it."""
    said = (
        "#2\tINITED cov: 110 ft: 227 corp: 18/16Kb exec/s: 0 rss: 69Mb\n"
        "#1467\tREDUCE cov: 131 ft: 260 corp: 21/16Kb lim: 3808\n"
        " === Uncaught Python exception: ===\nKeyError: 'u'\nTraceback\n"
        "artifact_prefix='x'; Test unit written to .fuzz/broke/loop-crash-ab\n"
    )
    assert read("loop", 9.0, said, 77) == (
        "loop", 9.0, 1467, 131, 21, "KeyError: 'u'", ".fuzz/broke/loop-crash-ab",
    )  # fmt: skip
    assert read("loop", 9.0, said, 0).broken == ""


def test_what_earlier_runs_tried_is_added_up(tmp_path):
    """Test: a run of 900 inputs on file, and one of 100 that broke. Expected: 1000 inputs in the time of both,
    and what the last one left."""
    first, last = (
        Fuzzing("log", 9.0, 900, 30, 4, "", ""),
        Fuzzing("log", 1.0, 100, 31, 5, "KeyError", "log-1"),
    )
    assert known("log", tmp_path) is None and added(None, first) == first
    (tmp_path / "log.tried.json").write_text(json.dumps(first._asdict()))
    assert added(known("log", tmp_path), last) == ("log", 10.0, 1000, 31, 5, "KeyError", "log-1")
