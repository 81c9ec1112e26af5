"""The page of a whole project: what was found in it and nothing else, whole in itself, readable in both lights."""

import json
import re
import subprocess
import sys
import time

import pytest

from tests.chromium import FAINT
from tests.report.test_report import commands_of, opened
from twin.studio.jobs import Jobs
from twin.studio.project import Project
from twin.studio.project_report import content, page

DATA = re.compile(r'<script id="data" type="application/json">(.*?)</script>', re.DOTALL)


def reported(folder, *more):
    """`twin studio . --report project.html`, as it is typed in the project's folder."""
    words = [sys.executable, "-m", "twin", "studio", ".", "--report", "project.html", *more]
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=200)


def data_of(text):
    return json.loads(DATA.search(text)[1]) | {"made_s": 0}


@pytest.fixture(scope="module")
def compared(project):
    """The demo's project in which Monday was compared with the model."""
    jobs = Jobs(project)
    jobs.add({"verb": "compare", "ship": "tanker.toml", "voyages": ["monday.mcap"]})
    until = time.monotonic() + 300.0
    while jobs.state("0001-compare") in ("waiting", "running"):
        jobs.turn()
        assert time.monotonic() < until
        time.sleep(0.2)
    return project


def test_nothing_is_sailed_for_the_page_of_a_project(compared):
    assert "trial" not in content(compared)["about"]


def test_a_project_in_which_nothing_was_done_says_so_and_what_to_do(tmp_path):
    project = Project(tmp_path)
    empty = content(project)
    assert "nothing was compared" in empty["verdict"] and not empty["comparisons"] and not empty["file"]
    project.take_demo()
    begun = content(project)
    assert begun["file"] == "tanker.toml" and begun["about"]["ship"] == "KVLCC2"
    assert {f["name"]: f["tag"] for f in begun["files"] if f["kind"] == "voyage"} == {
        "monday.mcap": "voyage",
        "tuesday.mcap": "held_out",
    }


def test_the_commands_for_a_project_take_the_ships_file_as_one_word(tmp_path):
    project = Project(tmp_path)
    project.take_demo()
    (tmp_path / "tanker.toml").rename(tmp_path / "MV Alma.toml")
    (tmp_path / "project.html").write_text(page(project))
    commands = commands_of(opened(tmp_path / "project.html")[0])
    assert {words[1] for words in commands if "MV Alma.toml" in words} == {"compare", "diagnose"}


def test_the_page_holds_the_answers_numbers_and_is_read_in_both_lights(compared, tab):
    done = reported(compared.folder)
    assert done.returncode == 0 and done.stdout == "wrote project.html\n", done.stderr
    path = compared.folder / "project.html"
    text = path.read_text()
    assert not re.findall(r"https?://|\bsrc=|@import|url\(|fetch\(|XMLHttpRequest|WebSocket", text)
    found = json.loads((compared.folder / "jobs/0001-compare/result.json").read_text())
    shown = data_of(text)
    assert shown["verdict"] == found["verdict"] and shown["result"]["horizons"] == found["horizons"]
    assert shown["comparisons"][0]["position_mae_m"] == found["horizons"][-1]["position_mae_m"]
    tab.leave()
    for width, theme in ((1280, "light"), (1280, "dark"), (360, "light")):
        tab.size(width, 900)
        tab.open("about:blank")
        tab.open(f"file://{path}#theme={theme}")
        tab.wait("document.documentElement?.dataset.readyMs === '0'", 30)
        assert not tab.value(FAINT), theme
        assert tab.value("document.documentElement.scrollWidth") <= width
    heads = tab.value("[...document.querySelectorAll('h2')].map((h) => h.textContent)")
    for part in ("Error over the expected error", "Every comparison", "Which effect is missing", "Voyages"):
        assert part in heads
    said = tab.value("document.body.innerText")
    assert "twin compare monday.mcap --ship tanker.toml" in said and "Nothing was diagnosed yet" in said
    assert not tab.said


def test_the_button_gives_what_the_command_writes(compared, serve, tab):
    served = serve(compared.folder, "--read-only")
    try:
        tab.size(1400, 900)
        tab.open(served.links[0])
        tab.wait("!!document.getElementById('report')", 30)
        link = tab.value("document.getElementById('report').getAttribute('href')")
        page = tab.value(f"fetch({json.dumps(link)}).then((r) => r.text())")
        command = tab.value(
            "document.getElementById('report').closest('section').querySelector('code').textContent"
        )
    finally:
        served.stop()
    assert command == "twin studio . --report project.html"
    shown = data_of(page)
    assert reported(compared.folder).returncode == 0
    typed = data_of((compared.folder / "project.html").read_text())
    for one in (shown, typed):  # the page itself is a file of the project, younger each time it is written
        one["files"] = [f for f in one["files"] if f["kind"] != "page"]
    assert shown == typed


def test_an_answer_whose_ship_file_was_changed_since_says_so(compared):
    assert content(compared)["now"]["changed"] == []
    ship = compared.folder / "tanker.toml"
    time.sleep(1.1)
    ship.write_text(ship.read_text() + "\n# touched\n")
    told = content(compared)
    assert told["now"]["changed"] == ["tanker.toml"] and told["comparisons"][0]["changed"] == ["tanker.toml"]


def test_what_cannot_be_told_is_one_line(tmp_path):
    done = reported(tmp_path, "--demo")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and not list(tmp_path.iterdir())
    (tmp_path / "bad.toml").write_text('[particulars]\nL_pp = "long"\n')
    done = reported(tmp_path)
    assert done.returncode == 5 and done.stderr.count("\n") == 1 and "Traceback" not in done.stderr
    assert not (tmp_path / "project.html").exists()
