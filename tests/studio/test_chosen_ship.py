"""The ship file that the pages of Data and Add speak of: the newest, and another when it is chosen."""

import json
import os

import pytest

from tests.live.actuators import PODS, craft
from tests.studio.by_mouse import go, opened

LOOKS = "twinStudio.state.jobs.filter((j) => j.verb === 'look' && j.asked.file === 'owner.csv')"
COMMANDS = "[...document.querySelectorAll('main .command code')].map((c) => c.textContent)"


@pytest.fixture(scope="module")
def page(tab, project, spoiled, served):
    """The tanker's project with a boat's file in it that is older, and last in the alphabet."""
    craft(*PODS).save(project.folder / "zz-boat.toml")
    os.utime(project.folder / "zz-boat.toml", (1e9, 1e9))
    return opened(tab, served)


def chosen(page, select, ship):
    page.value(
        f"""(() => {{ const s = document.getElementById({json.dumps(select)});
        s.value = {json.dumps(ship)}; s.dispatchEvent(new Event("change")); }})()"""
    )


def test_a_file_is_looked_at_with_the_newest_ship_file_and_with_another_when_it_is_chosen(page, project):
    """Expected: the command beside Import is of that ship and of what is accepted; of one file one look is kept."""
    go(page, "#/data/owner.csv")
    page.wait("!!document.getElementById('remedy-rudder_sign-0')", 60)
    assert page.value(f"{LOOKS}.map((j) => j.asked.ship)") == ["tanker.toml"]
    assert "another ship's file" not in page.value("document.querySelector('main').innerText")
    line = "twin import owner.csv --map owner-map.toml --ship tanker.toml -o owner.mcap"
    assert line in page.value(COMMANDS)
    page.value("document.getElementById('accept-0').click()")
    assert f"{line.partition(' -o')[0]} --accept rudder_sign -o owner.mcap" in page.value(COMMANDS)
    chosen(page, "data-ship", "zz-boat.toml")
    page.wait(f"{LOOKS}.some((j) => j.asked.ship === 'zz-boat.toml' && j.state === 'done')", 60)
    assert page.value(f"{LOOKS}.length") == 1
    assert [p.name for p in (project.folder / "jobs").iterdir() if p.name.endswith("-look")] == ["0002-look"]


def test_the_effects_to_add_are_those_of_the_ship_that_is_chosen(page):
    go(page, "#/add")
    names = "[...document.querySelectorAll('main label')].map((l) => l.textContent)"
    assert "PropellerWear" in page.value(names)
    chosen(page, "add-ship", "zz-boat.toml")
    page.wait(f"{names}.includes('ThrusterWear.port')", 30)
    assert "PropellerWear" not in page.value(names) and not page.said
