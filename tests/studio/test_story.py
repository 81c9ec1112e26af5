"""The whole story in a real Chromium: data, compare, diagnose, add, compare; the numbers are those of the command
line to the last digit."""

import json
import os
import signal
import time

import pytest

from tests.studio.by_mouse import OVER, answer, ended, go, opened, press, shown, typed
from twin.studio.jobs import born


@pytest.fixture(scope="module")
def page(tab, served):
    return opened(tab, served)


def test_data_compare_diagnose_add_compare_with_the_numbers_of_the_command_line(page, project, tmp_path):
    """Test: the story by mouse. Expected: HullFouling named, the held-out error falls, every JSON is the command's."""
    go(page, "#/data/monday.mcap")
    page.wait("document.body.innerText.includes('have nothing against it')", 60)
    go(page, "#/compare")
    press(page, "Compare")
    first = answer(project, ended(page, "compare"))
    assert first["verdict"] in shown(page) and first["horizons"][-1]["position_mae_m"] > 10.0
    digits = page.value("[...document.querySelectorAll('main td span[title]')].map((s) => Number(s.title))")
    assert first["horizons"][-1]["position_mae_m"] in digits
    go(page, "#/diagnose")
    press(page, "Diagnose")
    found = answer(project, ended(page, "diagnose"))
    assert (
        found["missing"] == ["HullFouling"]
        and "against the motion" in shown(page)
        and "kn slower" in shown(page)
    )
    assert page.value(
        "[...document.querySelectorAll('figcaption')].some((f) => f.innerText.includes('with HullFouling'))"
    )
    assert found["p_value_sentence"] in shown(page) and not page.value(
        "!!document.getElementById('sail-next')"
    )
    page.value("document.getElementById('to-add').click()")
    page.wait("document.getElementById('effect-0')?.checked === true", 30)
    press(page, "Add and prove")
    added_job = ended(page, "add")
    added = answer(project, added_job)
    assert added["accepted"] and (project.folder / added["output"]).exists()
    assert "proved" in shown(page) and "+[effects.HullFouling]" in shown(page)
    page.value("document.getElementById('to-compare').click()")
    page.wait("!!document.querySelector('#compare-ship')", 30)
    press(page, "Compare")
    last = answer(project, ended(page, "compare"))
    assert last["files"] == {"ship": added["output"], "voyages": ["tuesday.mcap"]}
    assert last["horizons"][-1]["position_mae_m"] == pytest.approx(
        added["horizons"][-1]["after"]["position_mae_m"]
    )
    assert not page.said
    for mine in (first, found, last):
        assert typed(project, mine["command"], tmp_path / "typed.json") == mine
    os.rename(project.folder / added["output"], tmp_path / "the-page's.toml")
    theirs = typed(project, added["command"], tmp_path / "typed.json")
    assert (
        theirs == added
        and (project.folder / added["output"]).read_text() == (tmp_path / "the-page's.toml").read_text()
    )


def test_two_answers_are_seen_on_top_of_each_other_and_the_address_keeps_the_zoom(page):
    names = page.value("twinStudio.state.jobs.filter((j) => j.verb === 'compare').map((j) => j.name)")
    go(page, f"#/compare/{'+'.join(names)}?from=200&to=320.5")
    text = page.value("document.querySelector('figcaption .legend').innerText")
    assert "tanker on monday" in text and " on tuesday" in text
    page.wait("document.querySelector('.sticky [role=status]').textContent === '200 to 320.5 s'", 10)
    page.value("document.querySelector('[aria-label=\\'Show all time\\']').click()")
    page.wait("!location.hash.includes('from=2')", 5)


def test_a_killed_worker_is_said_and_the_work_can_be_done_again_through_a_reload(page, project):
    """Test: kill -9 in the middle; then, in the middle of the same work done again, a reload. Expected: the
    page says what happened, the project is whole, one button begins anew, and the reload loses nothing."""
    go(page, "#/diagnose")
    press(page, "Diagnose")
    page.wait("location.hash.startsWith('#/diagnose/0')", 30)
    name = page.value("location.hash.split('/')[2]")
    page.wait(f"{OVER.format(name=json.dumps(name))} === 'running'", 60)
    pid = json.loads((project.folder / "jobs" / name / "worker.json").read_text())["pid"]
    os.kill(pid, signal.SIGKILL)
    page.wait("document.body.innerText.includes('The process that worked on this is gone')", 30)
    assert not born(pid)
    page.value("document.getElementById('retry').click()")
    page.wait(f"location.hash.startsWith('#/diagnose/0') && !location.hash.includes({json.dumps(name)})", 30)
    again = page.value("location.hash.split('/')[2].split('?')[0]")
    page.wait(
        f"{OVER.format(name=json.dumps(again))} === 'running' && !!document.querySelector('#work progress')",
        60,
    )
    page.value("location.reload()")
    time.sleep(0.3)
    page.wait("window.twinStudio?.drawn > 0", 30)
    page.wait(
        f"!!document.querySelector('#work [data-job=\"{again}\"]') || {OVER.format(name=json.dumps(again))} === 'done'",
        30,
    )
    assert ended(page, "diagnose") == again
    asked = [
        json.loads((project.folder / "jobs" / n / "job.json").read_text())["asked"] for n in (name, again)
    ]
    assert asked[0] == asked[1] and answer(project, again)["files"]["voyages"] == asked[1]["voyages"]
    assert answer(project, again)["missing"] == ["HullFouling"]


def test_what_to_sail_next_stands_beside_a_verdict_that_is_open(page, project):
    """Test: the answer about Monday, had two causes looked alike. Expected: the manoeuvre that parts them."""
    name = page.value("twinStudio.state.jobs.find((j) => j.verb === 'diagnose').name")
    kept = project.folder / "jobs" / name / "result.json"
    whole = kept.read_text()
    sail = {
        "separates": ["HullFouling", "PropellerWear"],
        "shows": [],
        "manoeuvre": "square",
        "why": "odds 90 to 1",
    }
    kept.write_text(json.dumps(json.loads(whole) | {"next_manoeuvre": sail}))
    page.value("location.reload()")
    time.sleep(0.3)
    page.wait("window.twinStudio?.drawn > 0", 30)
    go(page, f"#/diagnose/{name}")
    page.wait("!!document.getElementById('sail-next')", 30)
    said = page.value("document.getElementById('sail-next').innerText")
    assert said == "To tell HullFouling from PropellerWear, sail: square (odds 90 to 1)."
    kept.write_text(whole)


def test_an_owners_bad_table_is_mended_by_the_button_and_imported(page, project, spoiled):
    """Test: a rudder that is positive to port. Expected: refused, mended by the remedy, imported, compared."""
    go(page, "#/data/owner.csv")
    page.wait("!!document.getElementById('remedy-rudder_sign-0')", 60)
    assert "Refused while rudder_sign" in shown(page)
    assert page.value("[...document.querySelectorAll('article')][0].querySelectorAll('canvas').length") == 2
    page.value("document.getElementById('remedy-rudder_sign-0').click()")
    page.wait("/\\d have nothing against it/.test(document.body.innerText)", 60)
    assert "sign = -1" in (project.folder / "owner-map.toml").read_text()
    press(page, "Import")
    page.wait("twinStudio.state.project.files.some((f) => f.name === 'owner.mcap')", 60)
    assert not page.said


def test_a_file_with_a_hostile_name_and_a_hostile_ship_are_text(page, project):
    (project.folder / "evil.toml").write_text(
        (project.folder / "tanker.toml")
        .read_text()
        .replace('name = "KVLCC2"', 'name = "<img src=x onerror=alert(1)><script>alert(2)</script>"', 1)
    )
    (project.folder / "<img src=x onerror=alert(3)>.csv").write_text("a,b\n1,2\n")
    page.value("location.reload()")
    time.sleep(0.3)
    page.wait("window.twinStudio?.drawn > 0", 30)
    go(page, "#/ship/evil.toml")
    page.wait("document.querySelector('h1').textContent.includes('<script>')", 30)
    go(page, "#/data")
    page.wait("document.body.innerText.includes('<img src=x onerror=alert(3)>.csv')", 30)
    assert page.value("document.querySelectorAll('main img, main script').length") == 0
    assert not page.said


def test_without_the_network_every_part_is_drawn_from_this_computer_alone(page, served):
    """Expected: the page and its parts name no other place."""
    page.value("performance.clearResourceTimings()")
    for part in ("data", "ship", "calibrate", "compare", "diagnose", "add", "live"):
        go(page, f"#/{part}")
    places = page.value("performance.getEntriesByType('resource').map((e) => new URL(e.name).host)")
    assert places and set(places) == {f"127.0.0.1:{served.port}"}
