"""Effects that others install: a broken one is left out and named, never ends a verb, and `twin effects
--check` says what to mend."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from twin.cli import main
from twin.errors import SettingsError
from twin.physics.effects import BUILT_IN, UNNAMED
from twin.report.effect_contract import QUESTIONS, check, of_file

ROOT = Path(__file__).parents[2]
HEAD = '''"""A drag: X = -k u_r |u_r|."""
import math
from twin.physics.effect import Force, param
from twin.physics.maths import hypot, sqrt
from twin.physics.state import Force as ForceVector


class {name}(Force):
    """Something brakes the ship."""

    source = "a test"
    k: float = param(2.0, unit="m2", lo=0.0, hi=40.0, sd=3.0, doc="drag area")
'''
GOOD = """
    def force(self, s, ship):
        return ForceVector(X=-0.5 * ship.rho * self.k * s.u_r * hypot(s.u_r, s.v_r))
"""
BRANCHES = """
    def force(self, s, ship):
        return ForceVector(X=-self.k * s.u_r if s.u_r > 0.0 else 0.0)
"""
BROKEN = {  # name: (body of the file, what is said of it)
    "Absent": ("import no_such_package_at_all\n", "cannot be imported (ModuleNotFoundError"),
    "Ends": ("raise SystemExit(3)\n", "cannot be imported (SystemExit"),
    "Other": (
        (HEAD + GOOD).format(name="Another").replace("Another(", "Other_("),
        "cannot be imported (AttributeError",
    ),
    "NoEffect": ("NoEffect = 3\n", "no subclass of Force"),
    "BadBox": ((HEAD + GOOD).format(name="BadBox").replace("lo=0.0", "lo=5.0"), "must lie in its box"),
    "NoParam": (
        (HEAD + GOOD)
        .format(name="NoParam")
        .replace('param(2.0, unit="m2", lo=0.0, hi=40.0, sd=3.0, doc="drag area")', "2.0"),
        "param(...)",
    ),
    "BadNeeds": ((HEAD + "    needs = ('wind',)\n" + GOOD).format(name="BadNeeds"), "needs names wind"),
    "Silent": (
        (HEAD + GOOD).format(name="Silent").replace('    """Something brakes the ship."""\n', ""),
        "no docstring",
    ),
    "Branches": ((HEAD + BRANCHES).format(name="Branches"), "never branch on a value"),
    "Maths": (
        (HEAD + GOOD).format(name="Maths").replace("hypot(s.u_r, s.v_r)", "math.hypot(s.u_r, s.v_r)"),
        "twin.physics.maths",
    ),
    "Fails": (
        (HEAD + GOOD).format(name="Fails").replace("s.u_r *", "s.no_such_input *"),
        "fails at a moment",
    ),
}


def installed(folder: Path, files: dict[str, str]) -> dict[str, str]:
    """The environment of a Python that has these effects installed."""
    for name, body in files.items():
        (folder / f"p_{name.lower()}.py").write_text(body)
    info = folder / "strange-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: strange\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[twin.effects]\n" + "".join(f"{n} = p_{n.lower()}:{n}\n" for n in files)
    )
    return os.environ | {"PYTHONPATH": str(folder)}


def twin(env, *words):
    return subprocess.run(
        [sys.executable, "-m", "twin.cli", *words], capture_output=True, text=True, env=env, cwd=ROOT
    )


def test_broken_effects_are_left_out_with_a_line_each_and_the_others_work(tmp_path):
    """Fault: eleven installed effects, each broken in its own way, and one that is sound. Expected: `twin
    effects` ends well."""
    files = {name: body for name, (body, _) in BROKEN.items()} | {"Drag": (HEAD + GOOD).format(name="Drag")}
    env = installed(tmp_path, files)
    shown = twin(env, "effects")
    assert shown.returncode == 0 and "Drag" in shown.stdout, shown.stderr
    assert f"{len(BUILT_IN) + 1} effects" in shown.stdout
    lines = shown.stderr.strip().splitlines()
    assert len(lines) == len(BROKEN)
    for name, (_, words) in BROKEN.items():
        (line,) = (x for x in lines if f"effect {name} is left out" in x)
        assert words in line and f"--check {name}" in line, line


def test_a_broken_effect_ends_no_diagnosis_and_no_ship_file_but_its_own(tmp_path):
    """Expected: what a diagnosis asks for (the catalogue, arrays, unknowns) is the built-in one; a ship file
    that holds it gets one line."""
    env = installed(tmp_path, {name: BROKEN[name][0] for name in ("Absent", "Branches")})
    code = (
        "import numpy; from twin.physics.effects import catalogue; from twin.physics.model import Model; "
        "from twin.physics.ship import load; "
        "from twin.study.estimation.of_effect import effect_unknowns; m = Model.of(load('usv')); "
        "print(sum(len(effect_unknowns(e, m)) > 0 for e in catalogue().values()))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=env, cwd=ROOT)
    assert done.stdout.strip() == str(len(BUILT_IN)), done.stderr
    (tmp_path / "mine.toml").write_text(
        (ROOT / "twin/ships/usv.toml").read_text()
        + '\n[effects.Branches]\nk = { value = 3.5, unit = "m2" }\n'
    )
    loaded = twin(env, "history", str(tmp_path / "mine.toml"))
    assert loaded.returncode == 5 and "cannot be used" in loaded.stderr and "Traceback" not in loaded.stderr
    checked = twin(env, "effects", "--check", "Branches")
    assert (
        checked.returncode == 5
        and "WRONG whole voyages at once" in checked.stdout
        and "Traceback" not in checked.stderr
    )


@pytest.mark.parametrize("Kind", (*BUILT_IN, *UNNAMED), ids=lambda kind: kind.__name__)
def test_every_effect_of_the_catalogue_passes_its_own_check(Kind):
    assert [a for a in check(Kind) if not a.ok] == []


WRONG = {  # what is done to the good one: which question says so
    "finite at a usual moment": lambda t: t.replace("s.u_r *", "float('nan') * s.u_r *"),
    "null does nothing": lambda t: t.replace("self.k *", "(self.k + 1.0) *"),
    "whole voyages at once (arrays)": lambda t: t.replace("X=-0.5", "X=-(0.5 if s.u_r > 0.0 else 0.4)"),
    "training (tensors)": lambda t: t.replace("hypot(s.u_r, s.v_r)", "math.hypot(s.u_r, s.v_r)"),
    "certificate (intervals)": lambda t: t.replace("hypot(s.u_r, s.v_r)", "float(s.u_r)"),
    "a mirrored ship feels the mirrored force": lambda t: t.replace(
        "ForceVector(", "ForceVector(Y=self.k * s.u_r, "
    ),
    "finite slopes for a ship at rest": lambda t: t.replace(
        "hypot(s.u_r, s.v_r)", "sqrt(s.u_r * s.u_r + s.v_r * s.v_r)"
    ),
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_each_question_finds_the_effect_that_is_wrong_in_its_way(tmp_path, question, capsys):
    path, good = tmp_path / "drag.py", (HEAD + GOOD).format(name="Drag")
    path.write_text(good)
    assert main(["effects", "--check", str(path)]) == 0 and "WRONG" not in capsys.readouterr().out
    path.write_text(WRONG[question](good))
    wrong = {a.question: a.text for a in check(of_file(path)) if a.ok is False}
    assert wrong.get(question)
    assert main(["effects", "--check", str(path), "--json", str(tmp_path / "a.json")]) == 5
    told = capsys.readouterr()
    assert question in told.out and told.err.count("\n") == 1 and question in told.err
    assert {
        a["question"] for a in json.loads((tmp_path / "a.json").read_text())["answers"] if a["ok"] is False
    } == set(wrong)


@pytest.mark.parametrize(
    "name, body",
    [
        ("no.py", None),
        ("two.py", (HEAD + GOOD).format(name="A") + (HEAD + GOOD).format(name="B")),
        ("x.py", "1/0"),
    ],
)
def test_a_file_that_cannot_be_checked_is_one_line(tmp_path, monkeypatch, name, body):
    monkeypatch.chdir(tmp_path)
    if body is not None:
        Path(name).write_text(body)
    with pytest.raises(SettingsError, match=f"--check {name}"):
        of_file(Path(name))


def test_a_name_that_is_not_installed_is_one_line(capsys):
    assert main(["effects", "--check", "Nowhere"]) == 5
    assert capsys.readouterr().err.count("\n") == 1
