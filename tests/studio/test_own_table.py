"""An owner's own bad table in an empty project: decimal commas between semicolons, a heading in radians, a log in knots
that says m/s, names that nobody guesses, gaps, a name that is a formula. Everything by mouse in a real Chromium."""

import json

import numpy as np
import pytest

from tests.studio.by_mouse import go, opened, shown
from twin.commands.story import MONDAY
from twin.recording.read import read_voyage

KNOT = 1852.0 / 3600.0
FORMULA = "=cmd|' /C calc'!A0"
BUSY = "twinStudio.state.jobs.some((j) => ['waiting', 'running'].includes(j.state))"


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """Path of the table, and of the same without its line of names."""
    v, folder = read_voyage(MONDAY), tmp_path_factory.mktemp("owner")
    columns = {
        "Time": v.time_s - v.time_s[0],
        "N": v["north_m"],
        "E": v["east_m"],
        "Heading": np.radians(v["heading_true_north_deg"]),
        "STW": v["surge_velocity_through_water_mps"] / KNOT,
        "ROT": 60.0 * v["yaw_rate_degps"],
        "Rudder": v["rudder_angle_deg"],
        "RPM": v["propeller_rate_rpm"],
        FORMULA: 0.0 * v.time_s,
    }
    rows = [
        ";".join("" if x != x else f"{x:.5f}".replace(".", ",") for x in row)
        for row in zip(*columns.values(), strict=True)
    ]
    named, bare = folder / "log.csv", folder / "bare.csv"
    named.write_text("\n".join([";".join(columns), *rows]) + "\n")
    bare.write_text("\n".join(rows) + "\n")
    return named, bare


@pytest.fixture(scope="module")
def page(tab, serve, tmp_path_factory):
    served = serve(tmp_path_factory.mktemp("empty"))
    yield opened(tab, served)
    served.stop()


def drop(page, path):
    """The file chosen under Data, as a person does."""
    go(page, "#/data")
    root = page.ask("DOM.getDocument")["root"]["nodeId"]
    node = page.ask("DOM.querySelector", nodeId=root, selector="#files")["nodeId"]
    page.ask("DOM.setFileInputFiles", files=[str(path)], nodeId=node)
    page.wait(f"location.hash === {json.dumps(f'#/data/{path.name}')}", 30)
    looked_at(page, path.name)


def looked_at(page, name):
    """Until what was found of the file is shown."""
    page.wait(
        f"!{BUSY} && document.querySelector('main h1')?.textContent === {json.dumps(name)}"
        " && /Recognised/.test(document.querySelector('main').innerText)",
        60,
    )


def pressed(page, selector):
    before = page.value("twinStudio.drawn")
    page.value(f"document.querySelector({json.dumps(selector)}).click()")
    page.wait(f"twinStudio.drawn > {before}", 30)
    looked_at(page, "log.csv")


def take(page, column, channel):
    page.value(
        f"""(() => {{ const s = document.querySelector('[aria-label="What {column} is"]');
        s.value = {json.dumps(channel)}; s.dispatchEvent(new Event("change")); }})()"""
    )
    pressed(page, f'[aria-label="Take {column}"]')


def test_a_part_that_lacks_something_says_what_and_where_it_is_made(page):
    for part in ("compare", "diagnose", "calibrate", "add"):
        go(page, f"#/{part}")
        assert "A ship file: make a first model" in shown(page) and "A voyage: drop a log" in shown(page)


def test_a_table_without_names_says_what_to_write_and_where_to_drop_it_again(page, tables):
    drop(page, tables[1])
    said = shown(page)
    assert "line 1 has numbers where the names of the 9 columns should be" in said
    assert "drop it here again" in said and "The map: which column is what" not in said


def test_an_owners_bad_table_becomes_a_voyage_by_buttons_alone(page, tables):
    """Expected: what no name says is chosen from lists, what a check proves is mended by its button; the voyage is
    Monday's, number for number; the formula is text."""
    drop(page, tables[0])
    assert "decimal commas" in shown(page) and "needs north_m and east_m" in shown(page)
    assert page.value(
        f"[...document.querySelectorAll('main th')].some((e) => e.textContent === {json.dumps(FORMULA)})"
    )
    take(page, "N", "north_m")
    take(page, "E", "east_m")
    assert "it is believed to be in kn" in shown(page)
    pressed(page, "#remedy-speed_log-0")
    assert "24 have nothing against it" in shown(page)
    page.value(
        "[...document.querySelectorAll('main button')].find((b) => b.textContent === 'Import').click()"
    )
    page.wait("twinStudio.state.project.files.some((f) => f.name === 'log.mcap')", 60)
    page.wait("document.querySelector('#next')?.textContent.startsWith('Make a first model')", 30)
    folder = page.value("twinStudio.state.project.folder")
    mine, monday = read_voyage(f"{folder}/log.mcap"), read_voyage(MONDAY)
    for name in ("north_m", "surge_velocity_through_water_mps", "yaw_rate_degps", "rudder_angle_deg"):
        assert mine[name] == pytest.approx(monday[name], abs=1e-4, nan_ok=True)
    off = (mine["heading_true_north_deg"] - monday["heading_true_north_deg"] + 180.0) % 360.0 - 180.0
    assert np.nanmax(np.abs(off)) < 1e-3
    assert not page.said


def test_a_unit_is_chosen_anew_in_the_table_of_the_map(page, tables):
    go(page, "#/data/log.csv")
    looked_at(page, "log.csv")
    page.value(
        """(() => { const s = document.querySelector('[aria-label="Unit of yaw rate in the file"]');
        s.value = "deg/s"; s.dispatchEvent(new Event("change")); })()"""
    )
    page.wait("!!document.querySelector('#remedy-yaw_rate-0')", 60)
    folder = page.value("twinStudio.state.project.folder")
    with open(f"{folder}/log-map.toml") as file:
        assert 'yaw_rate_degps = { column = "ROT", unit = "deg/s" }' in file.read()


def test_two_windows_do_not_write_over_each_other(page, tables):
    """Test: the map is changed in another window, or by an editor, and then in this one. Expected: one line, the
    other's map is as it was; after another look this window's change is taken."""
    folder = page.value("twinStudio.state.project.folder")
    path = f"{folder}/log-map.toml"
    with open(path) as file:
        other = "# mine\n" + file.read()
    with open(path, "w") as file:
        file.write(other)
    page.value("document.querySelector('#remedy-yaw_rate-0').click()")
    page.wait("/changed meanwhile/.test(document.body.innerText)", 30)
    with open(path) as file:
        assert file.read() == other
    go(page, "#/data")
    go(page, "#/data/log.csv")
    page.wait("!!document.querySelector('#remedy-yaw_rate-0')", 60)
    pressed(page, "#remedy-yaw_rate-0")
    with open(path) as file:
        text = file.read()
    assert text.startswith("# mine\n") and 'yaw_rate_degps = { column = "ROT", unit = "deg/min" }' in text
