"""The page and the plot of results that need no track: a sentence, what to heed, bars and tables."""

import re
from html import unescape

import pytest

import twin
import twin.errors
from twin.api.calibration import Calibration
from twin.api.tube import TubeCalibration
from twin.commands.story import MONDAY
from twin.report.result_page import Bars, PageTable, result_page


def words(page):
    """What a person reads on it."""
    return " ".join(unescape(re.sub(r"<style>.*?</style>|<[^>]+>", " ", page, flags=re.S)).split())


@pytest.fixture(scope="module")
def monday():
    return twin.read_voyage(MONDAY)


@pytest.fixture(scope="module")
def first():
    return twin.first_model("MV Alma", 180.0, 30.0, 10.5, block_coefficient=0.8)


def test_a_page_says_its_sentence_what_to_heed_and_draws_every_row():
    """Test: text that is code in HTML, a number that is not known. Expected: it is text; a bar for each number."""
    rows = [{"at": "10 s", "old": 4.0, "new": 1.0}, {"at": "60 s", "old": 8.0, "new": None}]
    bars = Bars("Errors", "m", "at", {"old": "before", "new": "now"}, rows)
    table = PageTable("The same", {"at": "after", "old": "before [m]", "new": "now [m]"}, rows)
    page = result_page("<Alma>", "Half & better.", ["<script>alert(1)</script>"], (bars, table))
    assert "<script" not in page and "<script>alert(1)</script>" in words(page)
    widths = [float(w) for w in re.findall(r'<rect [^>]*width="([\d.]+)"', page)]
    assert widths == pytest.approx([130.0, 32.5, 260.0])  # 4, 1 and 8 m: the longest fills its room
    for said in ("<Alma>", "Half & better.", "4.00 m before", "1.00 m now", "60 s 8.00 -"):
        assert said in words(page)


def test_counts_and_declared_numbers_stand_in_a_table_as_they_are():
    """Test: a count, what was declared, what was measured. Expected: all digits of the first two, three of the last."""
    row = {"count": 1234, "declared": 1234.5, "measured": 1234.5}
    table = PageTable("All", {name: name for name in row}, [row], given=("declared",))
    assert "1234 1234.5 1230" in words(result_page("t", "s", parts=(table,)))


def test_the_numbers_of_a_first_model_stand_as_they_were_given_with_their_units():
    said = words(twin.first_model("MV Alma", 187.54, 30.25, 10.5, block_coefficient=0.8).page())
    for part in ("L_pp 187.54 m given", "B 30.25 m given", "rho 1025 kg/m3 SEA", "C_b 0.8 - given"):
        assert part in said, part


def test_a_horizon_is_told_as_it_was_asked_for():
    """Test: 125 s. Expected: not 120 s, on the page of a calibration nor of a tube."""
    held = {"horizon_s": 125.0, "before_m": 20.0, "position_m": 10.0, "before_deg": 2.0, "heading_deg": 1.0}
    regimes = [{"regime": "straight", "horizon_s": 125.0, "position_m": 9.0}]
    data = {"held_out": [held], "held_out_is": "last third", "by_regime": regimes, "derivatives": []}
    found = Calibration(twin.Ship.load("kvlcc2"), data=data | {"refused": "", "doubts": []})
    said = words(found.page())
    assert "10.0 m after 125 s" in said and "straight 125 9.00" in said and "120" not in said
    size = {"voyages": 9, "predictions": 1234, "place_m": 12.0, "heading_deg": 2.0}
    row = {"horizon_s": 125.0, "level": 0.9, **size, "regimes": [{"regime": "straight", **size}]}
    said = words(TubeCalibration(found.ship, data={"horizons": [row], "doubts": []}).page())
    assert "after 125 s, in the mean" in said and "125 0.900 9 1234 12.0" in said and "120" not in said


def test_a_page_asks_nobody_for_anything(first):
    """Expected: one file; nothing of it is fetched."""
    assert not re.findall(r"""(?:src|href)=|url\(|@import|https?://(?!www\.w3\.org)""", first.page())


def test_a_first_model_says_what_it_does_and_where_each_number_is_from(first):
    said = words(first.page())
    assert (
        "first model from its main particulars" in said
        and "first overshoot of the 20/20 zigzag 8.93 deg at most 25 deg" in said
    )
    assert {row["source"] for row in first.to_dataframe().to_dict("records")} >= {"given"}
    assert len(repr(first)) < 200 and first.ship.L_pp == 180.0
    with pytest.raises(twin.errors.UsageError, match="block_coefficient"):
        twin.first_model("MV Alma", 180.0, 30.0, 10.5, block_coeficient=0.8)


def test_a_calibration_that_was_accepted_does_not_say_that_an_error_fell_which_grew():
    """Test: the place off by 1 m more after the fit, within what is accepted. Expected: from what to what."""
    held = {"horizon_s": 120.0, "before_m": 20.0, "position_m": 21.0, "before_deg": 2.0, "heading_deg": 1.0}
    data = {"held_out": [held], "held_out_is": "last third", "by_regime": [], "derivatives": []}
    found = Calibration(twin.Ship.load("kvlcc2"), data=data | {"refused": "", "doubts": []})
    said = words(found.page())
    assert "not used for the fit, goes from 20.0 m to 21.0 m after 120 s." in said and "better" not in said


def test_a_checked_voyage_says_what_each_check_saw(monday):
    found = twin.check_voyage(twin.Ship.load("kvlcc2"), monday)
    assert found.refused() == [] and "No check proves a mistake." in words(found.page())
    assert len(found.to_dataframe()) == len(found.checks) and len(repr(found)) < 200
    turned = dict(monday.columns) | {"rudder_angle_deg": -monday.columns["rudder_angle_deg"]}
    wrong = twin.check_voyage(None, monday.with_rows(monday.time_s, turned))
    assert wrong.refused() and wrong.refused()[0] in words(wrong.page())
    assert wrong.refused(accept=wrong.refused()) == []


def test_the_instruments_of_a_voyage_are_told_on_a_page_and_drawn(monday):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    found = twin.instruments(None, monday)
    assert "No instrument disagrees with the others beyond its noise." in words(found.page())
    assert len(found.plot().get_yticklabels()) == sum(bool(n["cramer_rao_sd"]) for n in found.data["numbers"])


def test_an_effect_is_checked_by_name_and_by_class():
    sound = twin.check_effect("Wind")
    assert sound.wrong == [] and "Sound." in words(sound.page())
    assert twin.check_effect(twin.catalogue()["Wind"]).to_dict() == sound.to_dict()


def test_a_map_is_proposed_for_a_table_of_unknown_columns(monday, tmp_path):
    table = monday.to_dataframe().rename(columns={"heading_true_north_deg": "HDG"})
    table.to_csv(tmp_path / "log.csv")
    assert "HDG" in twin.suggest_map(tmp_path / "log.csv")
