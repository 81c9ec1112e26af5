"""Numbers as they are told to a person: known zeros kept, no power of ten, one place that does it."""

import ast
import json
import shutil
import subprocess
from math import inf, nan
from pathlib import Path

import pytest

from twin.num import as_given, num, percent

ROOT = Path(__file__).parents[1]
FILES = sorted(
    path
    for room in ("twin", "export")
    for path in (ROOT / room).rglob("*.py")
    if "__pycache__" not in path.parts
)
KEYS = {  # names of table entries in files, and what is recorded: read by programs
    "twin/live/prediction/calibrated.py",
    "twin/live/provenance.py",
    "twin/study/estimation/form.py",
    "twin/study/reference/tube_calibration.py",
    "twin/study/reference/tube_doubts.py",
}


@pytest.mark.parametrize("value, digits, said", [
    (2.0, 2, "2.0"), (1.3, 2, "1.3"), (9.99, 2, "10"), (99.6, 2, "100"), (159.6, 2, "160"), (613240.0, 3, "613000"),
    (0.05, 2, "0.050"), (-2.0, 3, "-2.00"), (0.0, 3, "0"), (1e9, 2, "1000000000"), (3.2e-5, 2, "3.2e-5"),
    (4e12, 2, "4.0e12"), (inf, 2, "inf"), (nan, 2, "nan"),
])  # fmt: skip
def test_a_number_that_was_measured_keeps_its_known_zeros(value, digits, said):
    assert num(value, digits) == said


def test_a_difference_is_told_with_its_sign():
    assert (num(2.0, 2, sign=True), num(-0.31, 1, sign=True), num(0.0, 2, sign=True)) == ("+2.0", "-0.3", "0")


@pytest.mark.parametrize("value, said", [
    (120.0, "120"), (0.5, "0.5"), (1e9, "1000000000"), (1234567.0, "1234567"), (0.1 + 0.2, "0.3"), (-0.0, "0"),
    (1e-7, "1e-7"), (3, "3"), (inf, "inf"), (100.0, "100"),
])  # fmt: skip
def test_a_declared_number_stands_as_it_was_given(value, said):
    assert as_given(value) == said


def test_a_share_is_told_in_whole_per_cent():
    assert (percent(0.854), percent(1.0)) == ("85 %", "100 %")


def by_general_format(path):
    """Lines of f-strings that format a number with `g`, but for those that are turned into a number again."""
    tree = ast.parse(path.read_text())
    back = {
        id(n.args[0]) for n in ast.walk(tree)
        if isinstance(n, ast.Call) and isinstance(n.func, ast.Name) and n.func.id == "float" and n.args
    }  # fmt: skip
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr) and id(node) not in back:
            texts = "".join(v.value for v in node.values if isinstance(v, ast.Constant))
            for v in node.values:
                if (
                    isinstance(v, ast.FormattedValue)
                    and v.format_spec
                    and ast.unparse(v.format_spec).endswith(("g'", 'g"'))
                ):
                    yield node.lineno, texts


def test_the_script_finds_what_it_looks_for(tmp_path):
    (tmp_path / "a.py").write_text('f"{x:.3g} m"; float(f"{x:.3g}"); f"{x:.3f} m"; f"{x:>+12.4g}"\n')
    assert list(by_general_format(tmp_path / "a.py")) == [(1, " m"), (1, "")]


def test_every_number_that_a_user_sees_goes_through_the_one_place():
    """Expected: no `g` in an f-string outside num.py, but in names of table entries (no space in them) of the
    files that make or read such tables."""
    wrong = {}
    for path in FILES:
        name = str(path.relative_to(ROOT))
        found = [line for line, text in by_general_format(path) if name not in KEYS or " " in text]
        if found:
            wrong[name] = found
    assert not wrong


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
def test_the_pages_tell_a_number_by_the_same_rule():
    """Test: the script of the pages. Expected: what num and as_given say, with thin spaces between thousands."""
    values = [
        0.0,
        2.0,
        9.99,
        99.6,
        0.05,
        -2.0,
        613240.0,
        1e9,
        3.2e-5,
        4e12,
        120.0,
        1234567.0,
        0.3,
        1e-7,
        12345.6,
    ]
    script = (ROOT / "twin" / "report" / "number.js").read_text() + (
        f"console.log(JSON.stringify({values}.map((x) => [num(x, 3), num(x, 2), asGiven(x)])));"
    )
    done = subprocess.run(["node", "-e", script], capture_output=True, text=True, timeout=60, check=True)
    told = [[text.replace("\u202f", "") for text in row] for row in json.loads(done.stdout)]
    assert told == [[num(x, 3), num(x, 2), as_given(x)] for x in values]
