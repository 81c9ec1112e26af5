"""What the workbench says of a diagnosis, in a real browser, of one that is made up here."""

import json

import pytest

from tests.studio.by_mouse import go, opened, shown

NAME = "0900-diagnose"
CAUSE = {
    "effect": "HullFouling",
    "probability": 0.4,
    "parameters": [],
    "error_horizon_s": 120.0,
    "error_without": 20.0,
    "error_with": 26.0,
    "error_floor": 4.0,
}
NOT_PREDICTED = CAUSE | {"effect": "PropellerWear", "error_without": 30.0, "error_with": None}
RESULT = {
    "verdict": "undecided",
    "reason": "undecided",
    "sentence": "Undecided.",
    "candidates": [CAUSE, NOT_PREDICTED],
    "probabilities": {"nothing_missing": 0.1, "unknown": 0.1},
    "resembles": [],
    "weather": [],
    "rivals": [],
    "next_manoeuvre": {
        "separates": ["HullFouling", "PropellerWear"],
        "manoeuvre": "speed changes",
        "why": "odds 90 to 1",
    },
}
VOYAGE = {
    "name": "monday",
    "channels": [],
    "inputs": [],
    "times": [],
    "heat": {"t": "", "rows": []},
    "track": {"x": "", "y": "", "lines": {}},
}
ASKED = {"verb": "diagnose", "ship": "tanker.toml", "voyages": ["monday.mcap"]}


@pytest.fixture(scope="module")
def page(tab, project, served):
    folder = project.folder / "jobs" / NAME
    folder.mkdir(parents=True)
    for file, content in (
        ("job.json", {"asked": ASKED, "command": "twin diagnose", "created_s": 1.0}),
        ("end.json", {"exit_code": 0, "ended_s": 2.0}),
        ("result.json", RESULT),
        ("view.json", {"causes": [], "forces": [], "voyages": [VOYAGE], "longest_s": 120.0}),
    ):
        (folder / file).write_text(json.dumps(content))
    page = opened(tab, served)
    go(page, f"#/diagnose/{NAME}")
    return page


def test_an_error_that_rises_with_a_cause_is_not_said_to_fall_and_one_that_is_not_known_is_not_said(page):
    said = shown(page)
    assert (
        "the 120 s error is 20.0 m without it, 26.0 m with it; 4.00 m is expected even with the right cause"
        in said
    )
    assert "falls" not in said and "30.0 m" not in said and not page.said


def test_the_next_manoeuvre_stands_once(page):
    said = shown(page)
    assert said.count("speed changes") == 1
    assert "To tell HullFouling from PropellerWear, sail: speed changes (odds 90 to 1)." in said
    assert "A voyage of another day" in said
