"""The catalogue as people and programs see it: terminal, JSON, page, and effects that others add."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from twin.cli import main
from twin.errors import SettingsError
from twin.physics.effects import BUILT_IN, UNNAMED, find
from twin.report.catalogue import overview, page

ROOT = Path(__file__).parents[2]
TUTORIAL = (ROOT / "docs" / "tutorials" / "own-effect.md").read_text(encoding="utf-8")


def test_the_page_is_current():
    assert (ROOT / "docs" / "effects.md").read_text(encoding="utf-8") == page(list(BUILT_IN)).rstrip(
        "\n"
    ) + "\n", "run: twin effects --markdown docs/effects.md"


@pytest.mark.parametrize("Kind", BUILT_IN, ids=lambda kind: kind.__name__)
def test_each_effect_is_shown_in_full(Kind, capsys):
    assert main(["effects", Kind.__name__]) == 0
    shown = capsys.readouterr().out
    assert Kind.__name__ in shown and all(p.name in shown and p.doc in shown for p in Kind.params())
    assert "twin add" in shown


def test_the_overview_fits_its_width():
    for width in (80, 100, 120):
        assert all(len(line) <= width for line in overview(list(BUILT_IN), width).splitlines())


def test_programs_read_it_as_json(capsys, tmp_path):
    assert main(["effects", "TowForce", "--ship", "kvlcc2", "--json", "-"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["schema_version"] == 1 and told["effects"][0]["parameters"][0]["unit"] == "N"
    assert told["effects"][0]["parameters"][0]["hi"] > 1e6  # in newtons of this ship
    assert main(["effects", "--json", str(tmp_path / "all.json")]) == 0
    assert len(json.loads((tmp_path / "all.json").read_text())["effects"]) >= len(BUILT_IN)


def test_a_wrong_name_gets_the_nearest_one_and_exit_code_5(capsys):
    assert main(["effects", "Winde"]) == 5
    said = capsys.readouterr().err
    assert "Did you mean 'Wind'" in said and said.count("\n") == 1
    assert main(["effects", "HullAsymetry"]) == 5
    assert "Did you mean 'HullAsymmetry'" in capsys.readouterr().err


def blocks():
    """File name -> content of the tutorial's files, and its last check."""
    files = dict(re.findall(r"^`(\S+)`\n```\w+\n(.*?)^```", TUTORIAL, re.M | re.S))
    check = re.findall(r"```python\n(.*?)```", TUTORIAL, re.S)[-1]
    return files, check


@pytest.mark.parametrize("Kind", UNNAMED)
def test_what_is_known_by_its_form_alone_is_told_but_never_added(Kind, capsys):
    assert main(["effects", Kind.__name__]) == 0
    said = capsys.readouterr().out
    assert Kind.sentence()[:30] in said and "twin add" not in said
    with pytest.raises(SettingsError, match=f"no part of a ship file.*twin effects {Kind.__name__}"):
        find(Kind.__name__)


def test_the_tutorial_runs(tmp_path):
    files, check = blocks()
    code = files["sea_anchor.py"].partition('"""\n\n')[2]
    assert sum(bool(line.strip()) for line in code.splitlines()) <= 20, "the tutorial promises twenty lines"
    for name, content in files.items():
        (tmp_path / name).write_text(content)
    pip = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "-q",
        "--no-build-isolation",
        "--no-deps",
        "--no-index",
        "--target",
        str(tmp_path / "site"),
    ]
    done = subprocess.run([*pip, str(tmp_path)], capture_output=True, text=True)
    if done.returncode and "setuptools" in done.stderr:
        pytest.skip("no setuptools here to build a package with")
    assert done.returncode == 0, done.stderr
    scenario = os.environ | {"PYTHONPATH": str(tmp_path / "site")}
    twin = [sys.executable, "-m", "twin.cli", "effects"]
    shown = subprocess.run([*twin, "SeaAnchor"], capture_output=True, text=True, env=scenario, cwd=ROOT)
    assert "drogue" in shown.stdout and "drag_area" in shown.stdout, shown.stderr
    subprocess.run([sys.executable, "-c", check], check=True, env=scenario, cwd=tmp_path / "site")
    ship = (ROOT / "twin" / "ships" / "usv.toml").read_text() + re.findall(
        r"```toml\n(\[effects.*?)```", TUTORIAL, re.S
    )[0]
    (tmp_path / "mine.toml").write_text(ship)
    load = f"from twin.physics.ship import load; print(load({str(tmp_path / 'mine.toml')!r}).effects)"
    loaded = subprocess.run(
        [sys.executable, "-c", load], capture_output=True, text=True, env=scenario, cwd=ROOT
    )
    assert "SeaAnchor(drag_area=3.5)" in loaded.stdout, loaded.stderr
