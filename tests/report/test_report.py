"""The page: whole in itself, opens in a real browser without a complaint, says what was found."""

import json
import re
import shlex
import subprocess
from html import unescape

import pytest

from tests.chromium import CHROMIUM
from tests.report import pages
from twin import report
from twin.errors import TwinError
from twin.physics.effects import find
from twin.physics.model import Model
from twin.report.page import content
from twin.study.prediction.open_loop_comparison import compare

BROWSER = CHROMIUM
FLAGS = (
    "--headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
    "--enable-logging=stderr"
)


@pytest.fixture
def stream(make, kvlcc2):
    return make(find("Current").absent(kvlcc2).but(east=0.8), name="stream")


@pytest.fixture
def page(sailed, stream, kvlcc2, tmp_path):
    """A page of compare, with text that would break a careless one."""
    s = sailed(stream)
    result = compare([s], Model.of(kvlcc2)).result | {
        "notes": ["</script><script>console.error('x')</script>"]
    }
    report.write(tmp_path / "page.html", "compare", result, [s.track], Model.of(kvlcc2), voyages=[s.voyage])
    return tmp_path / "page.html"


def opened(path, fragment=""):
    """(DOM, console lines) of a page in a real browser."""
    if BROWSER is None:
        pytest.skip("no Chromium on this machine")
    words = [BROWSER, *FLAGS.split(), "--virtual-time-budget=4000", "--dump-dom", f"file://{path}{fragment}"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=120)
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def test_the_page_asks_nothing_of_any_network(page):
    text = page.read_text()
    assert not re.findall(r"https?://|\bsrc=|@import|url\(|fetch\(|XMLHttpRequest|WebSocket", text)
    assert "default-src 'none'" in text


def test_the_page_opens_in_a_browser_without_a_complaint_and_shows_every_part(page):
    dom, complaints = opened(page)
    assert complaints == []
    assert "data-ready-ms" in dom
    for words in (
        "Error over the expected error",
        "Where it fails",
        "Worst windows",
        "Channel by time",
        "Track",
        "Data checks",
        "Provenance",
    ):
        assert f"<h2>{words}</h2>" in dom
    assert dom.index("<h1>120 s open-loop error") < dom.index("<h2>") and "twin diagnose" in dom


def test_the_page_is_dark_when_it_is_asked_to_be(page):
    assert 'data-theme="dark"' in opened(page, "#theme=dark")[0]


def test_the_page_of_diagnose_ranks_causes_in_newtons_with_the_command_beside(
    stream, sailed, kvlcc2, tmp_path
):
    number = {"name": "east", "value": 0.8, "low95": 0.7, "high95": 0.9, "unit": "m/s", "in_ship_file": 0.2}
    cause = {
        "effect": "Current",
        "probability": 0.97,
        "parameters": [number],
        "typical_force": {"X_N": 4.1e4, "Y_N": 5.12e5, "N_Nm": 3.2e7},
        "error_without": 72.0,
        "error_with": 13.0,
        "cannot_be_told_from": ["VaryingCurrent"],
    }
    next_one = {
        "separates": ["Current", "VaryingCurrent"],
        "manoeuvre": "reciprocal runs",
        "why": "it changes sign",
    }
    result = {
        "schema_version": 1,
        "verdict": "missing",
        "sentence": "Missing: Current (97 %).",
        "missing": ["Current"],
        "candidates": [cause],
        "next_manoeuvre": next_one,
    }
    report.write(tmp_path / "d.html", "diagnose", result, [sailed(stream).track], Model.of(kvlcc2))
    dom, complaints = opened(tmp_path / "d.html")
    assert complaints == []
    for words in (
        "Missing: Current (97 %).",
        "512 kN across it",
        "; ship file 0.200",
        "32.0 MN m of turning",
        "VaryingCurrent",
        "reciprocal runs",
        "twin add Current",
    ):
        assert words in dom
    weather = result | {"reason": "weather_only"}
    report.write(tmp_path / "w.html", "diagnose", weather, [sailed(stream).track], Model.of(kvlcc2))
    for page, badge in (("d", "missing"), ("w", "water and weather")):
        assert f">{badge}</span>" in opened(tmp_path / f"{page}.html")[0]


def test_the_page_of_an_unknown_cause_says_when_it_pushed_her_and_what_it_resembles(
    stream, sailed, kvlcc2, tmp_path
):
    track = sailed(stream).track
    moment = {
        "voyage": track.name,
        "start_s": 60.0,
        "end_s": 95.0,
        "X_N": -6e4,
        "Y_N": 7.24e5,
        "N_Nm": -1.17e7,
    }
    loose = {
        "effect": "RudderPlay",
        "probability": 0.99,
        "parameters": [],
        "typical_force": {"X_N": 0.0, "Y_N": 1e5, "N_Nm": 0.0},
        "says": "It hangs loose.",
    }
    stream_too = {"effect": "Current", "probability": 0.23, "parameters": []}
    stream_too |= {"error_without": 30.0, "error_with": None}  # which was not predicted
    result = {
        "schema_version": 1,
        "verdict": "unknown",
        "missing": [],
        "candidates": [stream_too],
        "moments": [moment],
        "resembles": [loose],
    }
    report.write(tmp_path / "d.html", "diagnose", result, [track], Model.of(kvlcc2))
    dom, complaints = opened(tmp_path / "d.html")
    assert complaints == []
    for words in (
        "Transient disturbances",
        "1:00 to 1:35",
        "724 kN",
        "-11.7 MN m",
        "It hangs loose.",
        "RudderPlay",
    ):
        assert words in dom
    assert "30.0 m without it" not in dom
    # which does not explain it; and is no effect of the catalogue
    assert "twin add Current" not in dom and "twin add RudderPlay" not in dom
    result |= {"verdict": "undecided", "one_of": ["Current", "RudderPlay"]}
    report.write(tmp_path / "d.html", "diagnose", result, [track], Model.of(kvlcc2))
    dom, complaints = opened(tmp_path / "d.html")
    assert complaints == [] and "It may be something like this" in dom
    assert "twin add Current" in dom and "twin add RudderPlay" not in dom


def test_the_page_of_add_shows_before_and_after(verb, on_disk, stream, tmp_path):
    words = ("--voyage", on_disk(stream), "-o", tmp_path / "s.toml", "--report", tmp_path / "a.html")
    assert verb("add", "Current", "--ship", "kvlcc2", *words) == 0
    dom, complaints = opened(tmp_path / "a.html")
    assert complaints == [] and "What was fitted" in dom and "The ladder" in dom and "model before" in dom


def test_a_page_of_diagnose_says_the_sentence_of_the_rule_that_decided(sailed, make, kvlcc2):
    said = "Undecided: these voyages cannot tell what, if anything, is missing."
    result = {
        "verdict": "undecided",
        "sentence": said,
        "missing": [],
        "candidates": [],
        "next_manoeuvre": None,
    }
    shown = content("diagnose", result, [sailed(make(seconds=400.0)).track], Model.of(kvlcc2))
    assert shown["verdict"] == said
    json.dumps(shown, allow_nan=False)


def test_an_hour_at_ten_hertz_is_a_page_of_a_few_megabytes_that_opens_in_two_seconds(
    sailed, make, kvlcc2, tmp_path
):
    hour = make(seconds=3600.0, wind=8.0)
    import numpy as np

    t = np.arange(0.0, 3598.0, 0.1)
    dense = hour.with_rows(t, {k: np.interp(t, hour.time_s, x) for k, x in hour.columns.items()})
    report.write(
        tmp_path / "h.html",
        "compare",
        {"verdict": "an hour"},
        [sailed(hour).track],
        Model.of(kvlcc2),
        voyages=[dense],
    )
    dom, complaints = opened(tmp_path / "h.html")
    ready = int(re.search(r'data-ready-ms="(\d+)"', dom).group(1))
    assert complaints == [] and (tmp_path / "h.html").stat().st_size < 8e6
    assert ready < 2000


@pytest.mark.parametrize("kind", ("compare", "diagnose", "add"))
def test_a_command_to_copy_takes_a_file_name_as_one_word_whatever_stands_in_it(
    kind, sailed, stream, kvlcc2, tmp_path
):
    """Test: names with a space and with what a shell would run. Expected: a shell reads back the names."""
    s, names = sailed(stream), ("MV Alma.toml", "monday $(reboot).mcap", "it's.toml")
    result = {"compare": {}, "diagnose": pages.diagnosis(s.track.name), "add": pages.addition()}[kind]
    files = {"ship": names[0], "voyages": [names[1]], "better": names[2]}
    result = compare([s], Model.of(kvlcc2)).result | result | {"output": names[0], "files": files}
    report.write(tmp_path / "page.html", kind, result, [s.track], Model.of(kvlcc2), before=Model.of(kvlcc2))
    commands = commands_of(opened(tmp_path / "page.html")[0])
    said = {word for words in commands for word in words}
    assert said >= {"compare": set(names[:2]), "diagnose": set(names), "add": set(names[:2])}[kind]


def commands_of(dom):
    """The words that a shell makes of each command on a page that was opened."""
    found = re.findall(r'<div class="command"><code>(.*?)</code>', dom)
    return [shlex.split(unescape(text)) for text in found]


def test_a_page_that_cannot_be_written_is_one_clear_line(sailed, make, kvlcc2, tmp_path):
    with pytest.raises(TwinError, match="cannot be written"):
        report.write(
            tmp_path / "no" / "p.html", "compare", {}, [sailed(make(seconds=400.0)).track], Model.of(kvlcc2)
        )
