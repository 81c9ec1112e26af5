"""The tutorial notebook: it runs from its first cell to its last, tells the story it promises, and its results
are the JSON that docs/json.md describes."""

import runpy
from pathlib import Path

import pytest

from tests.thorough import thorough
from twin.api.json_key import absent_keys, unknown_paths
from twin.api.json_keys import KEYS

pytest.importorskip("pandas")
matplotlib = pytest.importorskip("matplotlib")
pytestmark = thorough
PAGE = Path(__file__).parents[2] / "docs" / "tutorials" / "notebook.py"
RESULTS = {"before": "compare", "after": "compare", "found": "diagnose", "better": "add"}


@pytest.fixture(scope="module")
def story():
    """What the notebook's names hold in the end."""
    matplotlib.use("Agg")
    from matplotlib import pyplot

    pyplot.close("all")
    return runpy.run_path(str(PAGE)) | {"figures": len(pyplot.get_fignums())}


def test_growth_is_named_and_the_error_falls_where_it_was_not_fitted(story):
    found, better = story["found"], story["better"]
    assert found.verdict == "missing" and found.effects == ["HullFouling"]
    assert better.accepted and better.error_after_m < 0.5 * better.error_before_m
    last = [story[name].to_dict()["horizons"][-1]["position_mae_m"] for name in ("before", "after")]
    assert last == pytest.approx([better.error_before_m, better.error_after_m], rel=0.02)


def test_every_plot_of_the_notebook_is_drawn(story):
    assert story["figures"] == PAGE.read_text().count(".plot(")


@pytest.mark.parametrize("name", RESULTS)
def test_the_json_of_a_result_has_the_keys_of_the_table(story, name):
    """Test: a real result. Expected: no key that the table lacks, none of its keys lacks in the result."""
    keys, result = KEYS[RESULTS[name]], story[name].to_dict()
    assert unknown_paths(keys, result) == []
    assert absent_keys(keys, result) == []
