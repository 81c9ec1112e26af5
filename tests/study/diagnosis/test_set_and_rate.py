"""A stream is told by its speed and direction, as a navigator logs it."""

from types import SimpleNamespace

import numpy as np
import pytest

from tests.study.diagnosis.test_overtime import sizes
from twin.physics.effects import find
from twin.physics.model import Model
from twin.study.diagnosis.acting import acting
from twin.study.diagnosis.set_and_rate import set_and_rate, stream_in_words
from twin.study.diagnosis.tell_diagnosis import candidate_lines, weather_lines


def told(ship, *names, effect):
    """The rows of an effect on voyages of half an hour with these names."""
    tracks = [SimpleNamespace(name=name, t=np.arange(0.0, 1801.0)) for name in names]
    found = SimpleNamespace(on=lambda voyage: Model(ship, (effect,)))
    return set_and_rate(SimpleNamespace(tracks=tracks), found, type(effect).__name__)


def test_a_steady_stream_is_one_row_a_voyage(kvlcc2):
    """By hand: 0.3 m/s north and 0.4 m/s west are 0.5 m/s toward 306.87 deg."""
    rows = told(kvlcc2, "monday", "tuesday", effect=find("Current")().but(north=0.3, east=-0.4))
    assert [(r["voyage"], r["time_s"]) for r in rows] == [("monday", 0.0), ("tuesday", 0.0)]
    assert np.allclose([(r["speed_mps"], r["toward_deg"]) for r in rows], (0.5, 306.87), atol=0.01)
    assert stream_in_words(rows[:1]) == "0.50 m/s toward 307 deg"
    assert stream_in_words(rows).endswith("on monday, 0.50 m/s toward 307 deg on tuesday")


def test_a_stream_that_changes_is_told_from_the_beginning_of_the_voyage_to_its_end(kvlcc2):
    """By hand: the cosine of an hour toward north, the sine toward east, 0.2 m/s each: in half an hour the
    stream turns from north through east to south."""
    turning = find("VaryingCurrent")().but(north_c1=0.2, east_s1=0.2)
    rows = told(kvlcc2, "monday", effect=turning)
    assert np.allclose([r["speed_mps"] for r in rows], 0.2)
    assert np.allclose([r["toward_deg"] for r in rows], [0.0, 45.0, 90.0, 135.0, 180.0])
    assert stream_in_words(rows).startswith(
        "0.20 m/s toward 0 deg at 0 min, 0.20 m/s toward 45 deg at 7 min 30 s"
    )


def test_wind_is_no_stream(kvlcc2):
    assert told(kvlcc2, "monday", effect=find("Wind")()) == []


def test_numbers_of_a_stream_that_changes_are_not_listed_one_by_one(kvlcc2):
    """Test: a named stream of fourteen numbers. Expected: the text has its speed and direction, and none of
    its harmonics."""
    rows = told(kvlcc2, "monday", effect=find("VaryingCurrent")().but(north=0.2, north_c1=0.1))
    number = {
        "name": "north_c1",
        "value": 0.1,
        "low95": 0.0,
        "high95": 0.2,
        "unit": "m/s",
        "at_box_end": False,
    }
    force = {"X_N": 1e5, "Y_N": 1e6, "N_Nm": 1e7}
    cause = {
        "effect": "VaryingCurrent", "probability": 0.9, "together_with": [], "parameters": [number],
        "typical_force": force, "stream": rows, "error_floor": 30.0, "error_horizon_s": 120.0,
        "error_without": 90.0, "error_with": 31.0, "cannot_be_told_from": [], "says": "",
    }  # fmt: skip
    path = {"horizon_s": 120.0, "error_without": 31.0, "error_floor": 30.0, "weather": ["VaryingCurrent"]}
    lines = weather_lines({"weather": [cause], "path": path, "candidates": [], "resembles": []})
    for text in ("\n".join(candidate_lines(cause)), "\n".join(lines)):
        assert "0.30 m/s toward 0 deg at 0 min" in text and "north_c1" not in text and "typically" not in text
    assert "31.0 m off after 120 s (30.0 m are expected)" in "\n".join(lines)


@pytest.mark.parametrize(
    "held, said", [(["Wind", "Current"], "with it the"), (["Wind"], "with Wind the"), ([], None)]
)
def test_how_near_the_model_comes_is_said_of_the_weather_with_which_it_does(held, said):
    """Test: wind and a restless water of today, of which the model ran with both, one or none."""
    number = {"name": "scatter", "value": 0.06, "unit": "m/s"}
    today = [
        {"effect": name, "probability": 0.9, "parameters": [number], "typical_force": None}
        for name in ("Wind", "Current")
    ]
    path = {"horizon_s": 120.0, "error_without": 31.0, "error_floor": 30.0, "weather": held}
    lines = weather_lines({"weather": today, "path": path, "candidates": [], "resembles": []})
    ends = [line for line in lines if "the model ends 31.0 m off" in line]
    assert [said in line for line in ends] == ([True] if said else [])


@pytest.mark.parametrize(
    "shares, said",
    [
        ((0.0, 0.1, 2.0, 2.1), "acts from about 20 min on, and not before"),
        ((2.0, 2.1, 0.0, 0.1), "acts until about 19 min 59 s, and no longer after it"),
        ((0.0, 2.1, 2.0, 0.1), "acts from about 10 min to 29 min 59 s, and not before or after"),
        ((2.0, 0.1, 2.0, 0.1), "comes and goes"),
        ((0.9, 1.1, 1.0, 1.0), "comes and goes"),
    ],
)
def test_a_cause_that_began_or_ended_is_said_to_have_done_so(shares, said):
    parts = [
        part | {"start_s": 600.0 * i, "end_s": 600.0 * i + 599.0} for i, part in enumerate(sizes(*shares))
    ]
    assert acting(parts) == said
    assert acting([part | {"voyage": f"v{i}"} for i, part in enumerate(parts)]) == "comes and goes"
