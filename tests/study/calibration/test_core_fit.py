"""Calibration: the held-out error falls, what is not excited keeps its prior, and the file carries what
remains."""

import json
from dataclasses import fields, replace

import numpy as np
import pytest

from bench.bundled import recorded
from bench.real.planted_faults import PlantedReadings, antenna_elsewhere
from bench.reference import SeaCase, simulate
from tests.study.conftest import seldom
from tests.thorough import thorough
from twin import cli
from twin.api.json_key import absent_keys, unknown_paths
from twin.api.json_keys import KEYS
from twin.physics.ship import load, save
from twin.recording.write import write_voyage
from twin.study.calibration.calibration_record import sourced
from twin.study.calibration.core_fit import fitted_core
from twin.study.calibration.doubts import doubts
from twin.study.calibration.usual import significantly_there
from twin.study.estimation.innovations import NoiseModel
from twin.study.reference.derivatives import KEPT, with_one_step_core
from twin.study.reference.sailed import sailed


@pytest.fixture(scope="module")
def calibrated(voyages, tmp_path_factory):
    """The published tanker calibrated on two voyages and measured on a third."""
    folder = tmp_path_factory.mktemp("calibrate")
    paths = {}
    for name in ("calm", "calm too", "nothing"):
        paths[name] = folder / f"{name.replace(' ', '-')}.mcap"
        write_voyage(voyages[name].between(0.0, 800.0), paths[name])
    out, said, page = folder / "better.toml", folder / "said.json", folder / "page.html"
    words = ["calibrate", str(paths["calm"]), str(paths["calm too"]), "--held-out", str(paths["nothing"])]
    asked = ["--ship", "kvlcc2", "-o", str(out), "--json", str(said), "--report", str(page)]
    assert cli.main([*words, *asked]) == 0
    assert "not used for the fit, goes from" in page.read_text() and "kappa" in page.read_text()
    return load(out), json.loads(said.read_text())


def test_its_json_has_the_keys_of_the_table(calibrated):
    _, said = calibrated
    assert unknown_paths(KEYS["calibrate"], said) == []
    assert absent_keys(KEYS["calibrate"], said) == []


def test_the_error_falls_on_a_voyage_that_was_not_used(calibrated):
    _, said = calibrated
    at_120 = said["held_out"][-1]
    assert at_120["horizon_s"] == 120.0
    assert at_120["position_m"] < 0.8 * at_120["before_m"]


def test_the_ship_file_carries_standard_errors_and_what_remains(calibrated):
    ship, said = calibrated
    assert ship.notes["derivatives"]["X_uu"]["sd"] > 0.0
    structural = ship.notes["structural"]
    size = len(structural["labels"])
    assert len(structural["offset"]) == size and len(structural["covariance"]) == size
    assert set(structural["floor"]) == {f.name for f in fields(NoiseModel)}
    assert structural["by_regime"] and said["floor"]["share"]


def test_a_core_that_was_fitted_along_the_path_leaves_the_one_by_steps_in_the_file(calibrated):
    """Of what the voyages excite; by that core the next voyage is read."""
    ship, said = calibrated
    assert said["fitted_by"] == "paths"
    by_steps = with_one_step_core(ship)
    other = {n for n in ship.notes["derivatives"] if by_steps.derivative(n) != ship.derivative(n)}
    assert {"N_rr", "K_T0"} <= other and not other.intersection(said["unexcited"])


def test_beside_all_that_is_usual_less_is_left_than_beside_the_core_alone(calibrated):
    structural = calibrated[0].notes["structural"]
    alone, beside = structural["floor"], structural["beside"]
    assert set(beside) == set(alone)
    assert all(b <= a for a, b in zip(alone["share"], beside["share"], strict=True))
    assert 1.5 <= structural["temper_beside"] <= 8.0


def test_what_the_voyages_do_not_excite_is_named_and_keeps_its_prior(calibrated):
    ship, said = calibrated
    published = load("kvlcc2")
    for name in said["unexcited"]:
        assert getattr(ship.derivatives, name) == getattr(published.derivatives, name)
        assert "prior kept" in ship.notes["derivatives"][name]["source"]


def test_calibrating_again_starts_from_the_prior_and_not_from_its_own_answer(calibrated):
    ship, _ = calibrated
    entry = ship.notes["derivatives"]["N_ur"]
    assert entry["prior_value"] == load("kvlcc2").derivatives.N_ur
    assert entry["prior_value"] != entry["value"]


def test_what_no_ship_can_show_is_not_told_as_usual(calibrated):
    ship, _ = calibrated
    labels = ["SteeringLag.delay", "HeadingBias.bias"]
    told = significantly_there(
        ship, {"labels": labels, "offset": [-0.4, 0.02], "covariance": [[1e-4, 0.0], [0.0, 1e-6]]}
    )
    assert [t["name"] for t in told] == ["HeadingBias.bias"]


def test_a_calibration_that_ended_badly_says_so_and_a_good_one_only_that_it_rests_on_few_voyages(calibrated):
    _, said = calibrated
    assert [text.partition(":")[0] for text in said["doubts"]] == ["2 reference voyages"]
    fell = {
        "horizon_s": 120.0,
        "windows": 9,
        "position_m": 4.0,
        "before_m": 9.0,
        "heading_deg": 1.0,
        "before_deg": 2.0,
    }
    at_its_end = [
        {"name": "N_rr", "value": -0.6, "excited": True},
        {"name": "X_u", "value": 0.0, "excited": True},
    ]
    assert doubts(at_its_end, [fell], (0.1, 0.1, 0.1))[0].startswith("N_rr stopped")
    flow = [
        {"name": "gamma_v", "value": -0.15, "sd": 0.03, "excited": True},
        {"name": "gamma_r", "value": 0.05, "sd": 0.03, "excited": True},
    ]
    (backwards,) = doubts(flow, [fell], (0.1, 0.1, 0.1))
    assert backwards.startswith("gamma_v -0.15: ") and "sign" in backwards
    (rose,) = doubts([], [fell | {"position_m": 12.0}], (0.1, 0.1, 0.1))
    assert "9.00 -> 12.0 m" in rose and "twin compare" in rose
    (turned,) = doubts([], [fell | {"heading_deg": 5.0}], (0.1, 0.1, 0.1))
    assert "(2.00 -> 5.00 deg)" in turned
    (coarse,) = doubts([], [fell], (0.1, 0.4, 0.1))
    assert "40 % in sway" in coarse
    assert "--held-out" in doubts([], [fell | {"windows": 0}], (0.1, 0.1, 0.1))[0]
    (late,) = doubts(
        [], [fell], (0.1, 0.1, 0.1), [{"name": "SteeringLag.travel_time"}, {"name": "HeadingBias.bias"}]
    )
    assert "record the rudder's feedback" in late
    (blind,) = doubts(
        [], [fell], (0.1, 0.1, 0.1), (), {"RudderWear.loss": 1.6, "HeadingBias.bias": 0.2, "core.N_rr": 1.6}
    )
    assert blind.startswith("RudderWear.loss (1.6") and "core" not in blind


def test_a_file_that_is_no_voyage_leaves_no_ship_file(tmp_path, capsys):
    (tmp_path / "empty.csv").write_text("")
    code = cli.main(
        ["calibrate", str(tmp_path / "empty.csv"), "--ship", "kvlcc2", "-o", str(tmp_path / "x.toml")]
    )
    assert code == 4
    assert not (tmp_path / "x.toml").exists()
    assert len(capsys.readouterr().err.strip().splitlines()[-1]) > 20


def by_steps(voyages, ship, folder):
    """(the ship file, what was told) of a calibration on all but the last, which is held out."""
    *fitted, held = (sailed(v, ship) for v in voyages)
    made = fitted_core(fitted, [(held.track, 0)], ship, by="steps").calibrated()
    save(made.ship, folder / "better.toml")
    return load(folder / "better.toml"), made.result


@thorough
def test_an_antenna_that_stands_elsewhere_on_the_references_becomes_a_part_of_the_ship(voyages, tmp_path):
    """64 m ahead of where the ship file has it, as if the receiver were never told its length; predictions
    are better for it."""
    elsewhere = (
        antenna_elsewhere(seldom(voyages[name].between(0.0, 500.0)), 64.0)
        for name in ("calm", "calm too", "nothing")
    )
    ship, result = by_steps(elsewhere, load("kvlcc2"), tmp_path)
    (antenna,) = [e for e in ship.effects if type(e).__name__ == "AntennaOffset"]
    assert antenna.ahead == pytest.approx(64.0, rel=0.25)
    assert (
        result["antenna"]["ahead"]["value"] == antenna.ahead
        and "measured there" in ship.notes["effects"]["AntennaOffset"]["ahead"]["source"]
    )
    above = ship.notes["effects"]["AntennaOffset"]["above"]["source"]
    assert ("above" in result["antenna"]) == ("measured there" in above)
    assert "AntennaOffset" in ship.notes["structural"]["beside_effects"]


def test_a_number_that_the_voyages_left_as_it_was_is_not_said_to_be_measured():
    """Test: an antenna's height where no roll was recorded, and its place ahead, ten times as sure as before.
    Expected: the first keeps its prior in the ship file's words, the second was measured."""
    assert sourced(0.9, 0.9, "measured there") == KEPT
    assert sourced(3.0, 0.3, "measured there").endswith(": measured there")


def on_a_mast(v, height):
    """The voyage as an antenna so high above the axis of roll shows it: heel carries it aside."""
    q = PlantedReadings.of(v)
    aside = height * np.sin(v.si("roll_deg"))
    swing = np.gradient(aside, v.time_s)
    c, s = np.cos(q.psi), np.sin(q.psi)
    swung = replace(q, x=q.x - aside * s, y=q.y + aside * c)
    return replace(
        swung, north=q.north - aside * q.r * c - swing * s, east=q.east - aside * q.r * s + swing * c
    ).into(v)


@thorough
def test_an_antenna_on_a_mast_that_heel_carries_aside_becomes_a_part_of_the_ship():
    """Test: three voyages of a container ship that heels by some degrees in its turns, seen by an antenna 30
    m above the axis of roll, and by a low one.
    Expected: its height and no place ahead, and predictions as good as with the low one (the heel of its
        turns had been taken for sway)."""
    recordings = simulate(
        [
            SeaCase("container", m, seed=970 + i, duration_s=600.0)
            for i, m in enumerate(("zigzag_20", "turning_circle", "mixed"))
        ]
    )
    ship, off, ships = load("container"), [], []
    for height in (0.0, 30.0):
        *fitted, held = (
            sailed(on_a_mast(recorded(str(i), r.columns, every=15), height), ship)
            for i, r in enumerate(recordings)
        )
        found = fitted_core(fitted, [(held.track, 0)], ship, by="steps")
        ships.append(found.chosen.ship)
        off.append(found.held_out[-1]["position_m"])
    (antenna,) = [e for e in ships[1].effects if type(e).__name__ == "AntennaOffset"]
    assert antenna.above == pytest.approx(30.0, rel=0.15) and abs(antenna.ahead) < 8.0
    assert off[1] < 1.3 * off[0]


def test_a_ship_whose_antenna_is_where_her_file_has_it_gets_none(calibrated):
    ship, said = calibrated
    assert said["antenna"] == {} and not ship.effects


@thorough
def test_wind_that_blew_on_the_references_becomes_a_part_of_the_ship_and_none_does_that_did_not(
    calibrated, tmp_path
):
    """Test: three voyages of the 2 m boat in a wind that was recorded; the tanker's in a calm. Expected: how
    it pushes the boat, clearly, and that no calibration of it is taken for one of any other day's wind; of
    the tanker nothing."""
    recordings = simulate(
        [
            SeaCase("usv", m, hidden=(("Wind", 0.6),), seed=980 + i, duration_s=45.0)
            for i, m in enumerate(("zigzag_20", "mixed", "speed_changes"))
        ]
    )
    windy = (recorded(str(i), r.columns, every=4) for i, r in enumerate(recordings))
    ship, result = by_steps(windy, load("usv"), tmp_path)
    (wind,) = [e for e in ship.effects if type(e).__name__ == "Wind"]
    sd = ship.notes["effects"]["Wind"]["c_y"]["sd"]
    assert wind.c_y > 4.0 * sd and result["wind"]["c_y"]["value"] == wind.c_y
    assert (
        "Wind" not in ship.notes["structural"]["beside_effects"]
        and "Wind" not in ship.notes["structural"]["weather"]
    )
    assert result["too_faint"] == [] and calibrated[1]["wind"] == {}


@thorough
def test_little_water_on_the_references_becomes_a_part_of_the_ship_and_deep_water_does_not(
    calibrated, tmp_path
):
    """Test: the 2 m boat over one and a half times its draught, in deep water and, held out, over two and a half
    times; the tanker's in deep water. Expected: how it answers to the bottom is found beside the core."""
    shares = ((("ShallowWater", 1.0),), (), (("ShallowWater", 0.3),))
    recordings = simulate(
        [
            SeaCase("usv", m, hidden=hidden, seed=990 + i, duration_s=60.0)
            for i, (m, hidden) in enumerate(zip(("zigzag_20", "mixed", "speed_changes"), shares, strict=True))
        ]
    )
    river = (recorded(str(i), r.columns, every=4) for i, r in enumerate(recordings))
    ship, result = by_steps(river, load("usv"), tmp_path)
    (shallow,) = [e for e in ship.effects if type(e).__name__ == "ShallowWater"]
    sd = ship.notes["effects"]["ShallowWater"]["sway"]["sd"]
    assert shallow.sway > 4.0 * sd and result["shallow_water"]["sway"]["value"] == shallow.sway
    assert "ShallowWater" not in ship.notes["structural"]["weather"]
    assert calibrated[1]["shallow_water"] == {}
