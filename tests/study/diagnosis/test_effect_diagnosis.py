"""Plant and find: an effect hidden in a truth of another form is named; with nothing hidden the answer is
nothing."""

import json
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.thorough import one_of, thorough
from twin import cli
from twin.commands.story import MONDAY, SHIP, TUESDAY
from twin.physics.effects import catalogue, find
from twin.physics.model import Model
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.study.diagnosis import effect_diagnosis
from twin.study.diagnosis.effect_diagnosis import diagnose
from twin.study.diagnosis.tell_diagnosis import terminal_lines
from twin.study.reference.evidence import Hypothesis


@pytest.fixture(scope="module")
def monday(tmp_path_factory):
    """What the command says of the bundled voyage."""
    out = tmp_path_factory.mktemp("diagnosis") / "d.json"
    assert cli.main(["diagnose", str(MONDAY), "--ship", str(SHIP), "--json", str(out)]) == 0
    return json.loads(out.read_text())


def test_the_hidden_effect_of_the_bundled_voyage_is_named(monday):
    assert monday["verdict"] == "missing"
    assert monday["missing"] == ["HullFouling"]
    assert monday["learned_since"] == [], "python -m bench.bundled"


@thorough
@pytest.mark.parametrize("wait_s", [10.0, 30.0])
def test_a_log_of_two_to_six_rows_a_minute_names_the_same(monday, wait_s):
    """Test: Monday with a row every 10 s and every 30 s, a quarter and three quarters of the ship's time.
    Expected: the same name, and a size within the two intervals."""
    voyage = read_voyage(MONDAY)
    rows = np.unique(np.searchsorted(voyage.time_s, np.arange(voyage.time_s[0], voyage.time_s[-1], wait_s)))
    seldom = voyage.with_rows(voyage.time_s[rows], {n: x[rows] for n, x in voyage.columns.items()})
    told = diagnose([seldom], load(SHIP)).result
    assert told["missing"] == ["HullFouling"]
    often, size = (d["candidates"][0]["parameters"][0] for d in (monday, told))
    assert (
        size["low95"] < often["value"] < size["high95"] and often["low95"] < size["value"] < often["high95"]
    )


def test_the_answer_has_the_keys_of_the_contract(monday):
    assert {"schema_version", "verdict", "missing", "candidates", "next_manoeuvre"} <= monday.keys()
    first = monday["candidates"][0]
    assert {
        "effect",
        "probability",
        "parameters",
        "typical_force",
        "error_without",
        "error_with",
        "cannot_be_told_from",
    } <= first.keys()
    assert {"name", "value", "low95", "high95", "unit"} <= first["parameters"][0].keys()
    assert first["typical_force"].keys() == {"X_N", "Y_N", "N_Nm"}


def test_what_an_effect_is_is_said_to_the_end_of_its_sentence(monday):
    """Every sentence of the catalogue ends, also where its docstring runs over two lines."""
    for row in monday["candidates"]:
        assert row["says"] == find(row["effect"]).sentence() and row["says"].endswith(".")
    two_lines = [e.sentence() for e in catalogue().values() if "\n" in e.__doc__.strip()]
    assert two_lines and all(s.endswith(".") and "\n" not in s for s in two_lines)


def test_the_size_comes_with_an_interval_and_a_force_in_newtons(monday):
    first = monday["candidates"][0]
    extra = first["parameters"][0]
    assert extra["low95"] < extra["value"] < extra["high95"]
    assert extra["low95"] > 0.05
    assert 1e5 < first["typical_force"]["X_N"] < 2e6


def test_the_error_falls_on_parts_not_used_for_the_fit(monday):
    first = monday["candidates"][0]
    assert first["error_with"] < 0.8 * first["error_without"]
    assert 0.0 < first["error_floor"] < first["error_without"]


@thorough
def test_two_voyages_together_say_it_more_clearly_than_one(tanker, monday):
    both = diagnose([read_voyage(MONDAY), read_voyage(TUESDAY)], tanker).result
    assert both["missing"] == ["HullFouling"]
    one, two = (r["candidates"][0]["parameters"][0] for r in (monday, both))
    assert two["high95"] - two["low95"] < one["high95"] - one["low95"]


@pytest.mark.parametrize("name", one_of(["RudderWear", "Current", "HeadingBias"]))
def test_an_effect_hidden_in_the_reference_sea_is_named(diagnosed, name):
    result = diagnosed(name)
    assert result["verdict"] == "missing"
    assert result["missing"][0] == name, "\n".join(terminal_lines(result))


def test_nothing_hidden_means_nothing_missing(diagnosed):
    result = diagnosed("nothing")
    assert result["verdict"] == "nothing_missing", "\n".join(terminal_lines(result))
    assert result["missing"] == []


@thorough
def test_play_in_the_rudders_linkage_is_no_name_of_the_catalogue_but_what_it_resembles_is_said(
    tanker, voyages
):
    """Test: a rudder that hangs loose by 2.5 deg to either side. Expected: unknown, and not a worn rudder;
    what it looks like, with its size."""
    result = diagnose([voyages["RudderBacklash"]], tanker).result
    assert result["verdict"] == "unknown" and result["missing"] == []
    (like,) = result["resembles"]
    assert like["effect"] == "RudderPlay" and "RudderPlay" not in catalogue()
    (gap,) = like["parameters"]
    assert gap["low95"] <= np.radians(2.5) <= gap["high95"] and gap["unit"] == "rad"
    assert ("resembles RudderPlay: The rudder hangs loose") in result["sentence"] and any(
        "gap" in line for line in terminal_lines(result)
    )


def test_what_is_named_stands_before_what_acts_like_it(diagnosed):
    """Expected: where a cause is named it comes first; where nothing is known, what it looks like."""
    result = diagnosed("RudderWear")
    like = {**result["candidates"][0], "effect": "RudderPlay", "probability": 0.1}

    def order(verdict):
        lines = terminal_lines(result | {"verdict": verdict, "resembles": [like]})
        return [line.split()[-1] for line in lines if re.fullmatch(r" +\d+ %  Rudder(Wear|Play)", line)]

    assert order("missing") == ["RudderWear", "RudderPlay"]
    assert order("unknown") == ["RudderPlay", "RudderWear"]


@thorough
def test_liquid_that_swings_in_a_slack_tank_is_no_load(tanker, voyages):
    """Test: a tank of an eighth of its mass, forward or aft, whose liquid swings aside. Expected: unknown, no
    name, and what it looks like first."""
    result = diagnose([voyages["Sloshing"]], tanker).result
    assert result["verdict"] == "unknown" and result["missing"] == [], "\n".join(terminal_lines(result))
    like, *_ = result["resembles"]
    assert "SwayingMass" in (like["effect"], *like["together_with"])


@thorough
def test_what_stands_clear_of_what_calibration_left_unexplained_is_named_all_the_same(tanker, voyages):
    """Test: a strong stream, asked of a ship file that leaves half of what turns the ship unexplained.
    Expected: it is the answer, for a log shows the water without any model of turning."""
    notes = tanker.notes["structural"]
    coarse = notes | {name: notes[name] | {"share": [0.02, 0.05, 0.52]} for name in ("floor", "beside")}
    result = diagnose(
        [voyages["Current"]], replace(tanker, notes={**tanker.notes, "structural": coarse})
    ).result
    assert result["missing"] == ["Current"], "\n".join(terminal_lines(result))


def test_a_straight_voyage_is_not_enough_to_acquit_a_ship(tanker, voyages):
    """Test: a calm, straight, steady voyage. Expected: undecided, and no name."""
    result = diagnose([voyages["straight"]], tanker).result
    assert result["verdict"] == "undecided", "\n".join(terminal_lines(result))
    assert result["missing"] == []


def test_what_was_not_recorded_cannot_be_judged_and_the_answer_says_so(tanker, voyages):
    whole = voyages["nothing"].between(0.0, 600.0)
    blind = Voyage("blind", whole.time_s, {n: x for n, x in whole.columns.items() if "wind" not in n})
    result = diagnose([blind], tanker).result
    assert {"effect": "Wind", "lacks": ["true_wind_speed_mps", "true_wind_direction_deg"]} in result[
        "not_judged"
    ]
    assert any("Wind (true_wind_speed_mps and" in line for line in terminal_lines(result))


def test_a_voyage_too_short_to_judge_exits_with_4_and_one_line(tanker, voyages, tmp_path, capsys):
    from twin.recording.write import write_voyage

    write_voyage(voyages["nothing"].between(0.0, 60.0), tmp_path / "short.mcap")
    assert cli.main(["diagnose", str(tmp_path / "short.mcap"), "--ship", str(SHIP)]) == 4
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert "nothing: 59 s" in said and "ship lengths" in said


@thorough
def test_a_wind_is_news_unless_it_blew_as_hard_on_the_reference_voyages(tanker, voyages):
    news = diagnose([voyages["Wind"]], tanker).result
    assert (news["missing"], news["as_on_references"]) == (["Wind"], []), "\n".join(terminal_lines(news))
    known = diagnose([voyages["Wind"]], tanker, [voyages["calm"], voyages["Wind again"]]).result
    assert "Wind" not in known["missing"] and known["as_on_references"] == ["Wind"], "\n".join(
        terminal_lines(known)
    )
    assert (
        "Wind: no more of it than on the reference voyages; it is allowed for, and not called missing."
    ) in terminal_lines(known)


@thorough
def test_references_given_on_the_command_count_like_a_calibration(tanker, voyages):
    asked, *references = (voyages[name].between(0.0, 700.0) for name in ("HeadingBias", "calm", "calm too"))
    result = diagnose([asked], tanker, references).result
    assert result["missing"][:1] == ["HeadingBias"], "\n".join(terminal_lines(result))
    assert np.isfinite(result["floor"]["temper"])


def test_a_cause_is_named_beside_the_weather_of_an_ordinary_day(tanker, voyages):
    """Test: wind and stream that the model does not know, and a fouled hull. Expected: the hull first, the
    weather in a part of its own; only what lasts is offered for the ship file."""
    result = diagnose([voyages["june"]], tanker).result
    assert result["missing"][0] == "HullFouling" and result["answer"]["lasting"] == ["HullFouling"], (
        "\n".join(terminal_lines(result))
    )
    assert "Current" in {w["effect"] for w in result["weather"]}
    assert "today's water and wind:" in terminal_lines(result) and result["sentence"].startswith(
        "Missing: HullFouling"
    )
    assert all(0.0 < c["probability"] <= 0.99 for c in result["candidates"]) and result["reason"] == "named"
    assert result["rivals"][0]["log_bayes_factor"] == 0.0 and len(result["rivals"]) > 1


def test_a_voyage_that_the_ship_was_calibrated_on_is_said_to_be_one(monday):
    """Expected: nothing of it beside a later voyage, a line above the verdict beside its own."""
    assert monday["calibrated_on"] == []
    lines = terminal_lines(monday | {"calibrated_on": ["monday"]})
    assert lines[0].startswith("monday: the ship was calibrated on this voyage")
    assert lines[1:] == terminal_lines(monday)


@pytest.mark.parametrize("name, numbers", [("Wind", ["Wind.c_x"]), ("VaryingCurrent", ["scatter"])])
def test_only_the_restless_water_itself_is_told_by_its_scatter(tanker, monkeypatch, name, numbers):
    """Test: the likeliest hypothesis is restless water and nothing else; the next holds this weather. Expected:
    a wind keeps the numbers of the set that holds it."""
    monkeypatch.setattr(effect_diagnosis, "parameters", lambda case, found, name: [{"name": f"{name}.c_x"}])
    for of_name in ("beyond_file", "typical_force", "set_and_rate"):
        monkeypatch.setattr(effect_diagnosis, of_name, lambda *_: None)
    case = SimpleNamespace(
        catalogue=catalogue(),
        weather=("Wind", "VaryingCurrent"),
        model=Model.of(tanker),
        noise_model=SimpleNamespace(flow=0.01),
    )
    said = [Hypothesis((), "streaming", 0.0, 0.0), Hypothesis((name,), "usual", -0.1, 0.0)]
    found = {h.effects: SimpleNamespace(posterior=None) for h in said}
    told = SimpleNamespace(case=case, weighed=said, found=found, causes=(), shown=())
    assert [p["name"] for p in effect_diagnosis._weather(told, name, 0.55)["parameters"]] == numbers
