"""A named effect that grows: what is sailed is what is said, and what is counted is counted right."""

from types import SimpleNamespace

import numpy as np
import pytest

from bench.adaptation.effect_growth import (
    CHANGE_S,
    GROWTHS,
    HOW,
    RUN_S,
    STARTS_S,
    Growth,
    LearnedEffects,
    RowsAlone,
    arrival,
    growing,
    late,
    learned,
    summary,
)
from bench.adaptation.growth_page import figure, page
from bench.reference import HULLS
from twin.live.learning.adapted_row import BESIDE, SIZES
from twin.live.learning.learned_force import scale_of
from twin.live.learning.movable import movable
from twin.physics.effects import find
from twin.physics.model import Model
from twin.physics.ship import load

KVLCC2 = HULLS["kvlcc2"]


@pytest.fixture(scope="module")
def worn():
    ship = load("kvlcc2").with_effects(find("RudderWear")(loss=0.15))
    return SimpleNamespace(model=Model.of(ship))


@pytest.mark.parametrize("name", GROWTHS)
def test_the_hull_that_is_sailed_is_the_truth_that_is_told(name):
    """Expected: what the ship file says holds before the change and the told truth after it; the windows lie
    around it."""
    growth = GROWTHS[name]
    before, after = (
        {f: getattr(hull, f) / getattr(KVLCC2, f) for f in ("A_R", "R0", "m")} for hull in hulls(growth)
    )
    of = {
        "RudderWear": lambda x: 1.0 - x["A_R"],
        "HullFouling": lambda x: x["R0"] - 1.0,
        "Loading": lambda x: x["m"] - 1.0,
    }.get(growth.effect)
    if of:
        assert of(before) == pytest.approx(growth.file[growth.grows]) and of(after) == pytest.approx(
            growth.truth
        )
    else:
        assert not growth.file
    assert (
        STARTS_S[0] + 120.0 == CHANGE_S == STARTS_S[1] and STARTS_S[-1] + 120.0 < RUN_S and late().sum() == 3
    )


def hulls(growth: Growth):
    case = growing(growth, 1)[0]
    return case.hull, case.change.hull if case.change else case.hull


def test_there_is_a_ship_on_which_nothing_changes_with_an_effect_and_without():
    still = [g for g in GROWTHS.values() if growing(g, 1)[0].change is None]
    assert {bool(g.effect) for g in still} == {True, False} and len(GROWTHS) > len(still) + 2


def test_rows_alone_leave_the_effects_numbers_where_the_ship_file_has_them(worn):
    """Test: a rudder force that misses, told to both ways of learning. Expected: the number grows in one, not
    in the other."""
    ship = worn.model.ship
    told = []
    for k in range(1200):
        swing = np.sin(k / 36.0)
        q = [0.0] * (2 + 3 * SIZES) + [0.1 * swing, 0.5 * swing, 0.4 * swing]
        told.append(((0.1 * swing, 0.5 * swing, 0.4 * swing), q, 1.25, ""))
    heard = SimpleNamespace(
        model=worn.model,
        acting=SimpleNamespace(rows=[0, 0], network=SimpleNamespace(S=scale_of(ship))),
        courses=[SimpleNamespace(starts=np.array([600, 1199]))],
        states=np.zeros((1200, 1, 11)),
        streams=[told],
    )
    off, rows, on = (learned(HOW[how], heard) for how in ("off", "rows alone", "on"))
    assert isinstance(RowsAlone(ship, scale_of(ship), 2), HOW["on"])
    assert on.value.shape == (1, 2, 1) and on.rows.shape == (1, 2, 3, 2 + BESIDE)
    assert (
        on.value[0, -1, 0] == pytest.approx(0.30, abs=0.01)
        and rows.value[0, -1, 0] == off.value[0, -1, 0] == 0.15
    )
    assert not off.rows.any() and not off.acting.any() and on.acting[0, -1, 0] == pytest.approx(1.0, abs=0.1)


def test_errors_are_summed_by_window_seed_and_scenario():
    heading = np.arange(4.0 * len(STARTS_S)).reshape(4, -1)
    said = summary(heading, 2.0 * heading, np.array(["TS-01", "TS-02", "TS-01", "TS-02"]), 2)
    assert said["heading_deg"] == heading.mean(0).tolist() and said["late_heading_deg"] == [
        heading[:2, -3:].mean(),
        heading[2:, -3:].mean(),
    ]
    assert (
        said["late_lateral_m"][1] == 2.0 * heading[2:, -3:].mean()
        and said["by_scenario_deg"]["TS-02"] == heading[1::2, -3:].mean()
    )


def test_the_interval_that_holds_the_truth_is_counted(worn):
    growth = Growth("RudderWear", {"loss": 0.15}, {}, {}, "loss", 0.30)
    many, (number,) = len(STARTS_S), movable(worn.model.effects, worn.model.ship)
    value = np.full((2, many, 1), 0.30)
    value[1] += 2.5 * 0.1 * number.sd
    known = LearnedEffects(*[np.zeros((2, many))] * 2, value, np.full((2, many, 1), 0.1), np.zeros((2, many)))
    said = arrival(growth, worn, known, np.array(["TS-01", "TS-02"]))
    assert (
        said["held"] == 0.5
        and said["label"] == "RudderWear.loss"
        and said["value"]["TS-01"][-1] == pytest.approx(0.30)
    )
    assert (
        said["half_95"]["TS-02"][0] == pytest.approx(1.96 * 0.1 * number.sd)
        and arrival(GROWTHS["as it is"], worn, known, np.array([])) is None
    )


def result():
    many = len(STARTS_S)
    ways = {
        how: {
            "heading_deg": [0.1] * many,
            "lateral_m": [1.0] * many,
            "late_heading_deg": [0.1, 0.2],
            "late_lateral_m": [1.0, 1.0],
            "by_scenario_deg": {"TS-01": 0.1},
        }
        for how in HOW
    }
    number = {
        "label": "RudderWear.loss",
        "file": 0.15,
        "truth": 0.3,
        "held": 0.9,
        "value": {"TS-01": [0.2] * many},
        "half_95": {"TS-01": [0.05] * many},
        "spread": {"TS-01": [0.01] * many},
    }
    growths = {"grows": {"how": ways, "number": number}, "as it is": {"how": ways, "number": None}}
    return {"seeds": 2, "change_s": CHANGE_S, "late_s": 600.0, "starts_s": STARTS_S, "growths": growths}


def test_the_page_holds_errors_with_their_spread_and_the_number_with_its_interval(tmp_path):
    text = "\n".join(page(result()))
    assert (
        "| grows | 0.150 ± 0.071 / 1.00 ± 0.00 |"
    ) in text and "| RudderWear.loss | 0.15 | 0.3 | 0.200 ± 0.050 (0.010) | 90 % |" in text
    figure(result(), tmp_path / "named.png")
    assert (tmp_path / "named.png").read_bytes().startswith(b"\x89PNG")
