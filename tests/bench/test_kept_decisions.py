"""The fixed set of voyages with a known truth: an answer is kept, and decided again from what was searched."""

from bench.decisions.__main__ import decided, kept_answer
from bench.decisions.question import KnownCase
from tests.thorough import thorough
from twin.commands.story import MONDAY, SHIP
from twin.physics.ship import load
from twin.recording.read import read_voyage


@thorough
def test_a_kept_search_gives_the_same_answer_again(tmp_path):
    """Test: the first ten minutes of Monday. Expected: the same verdict, reason and names, from the search alone."""
    truth = {"hidden": {"HullFouling": 1.0}}
    question = KnownCase(
        "short monday", truth, lambda: (load(SHIP), [read_voyage(MONDAY).between(0.0, 600.0)])
    )
    answer = kept_answer(tmp_path, question, "now", again=False)
    again = decided(tmp_path, question, "now")
    assert {k: answer[k] for k in ("verdict", "reason")} == {k: again[k] for k in ("verdict", "reason")}
    assert answer["missing"] == list(again["missing"])
    assert kept_answer(tmp_path, question, "now", again=False)["facts"] == answer["facts"]
