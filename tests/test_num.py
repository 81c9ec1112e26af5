"""Numbers as they are told to a person: known zeros kept, no power of ten, one place that does it."""

import ast
import json
import shutil
import subprocess
from math import inf, nan
from pathlib import Path

import pytest

from twin.num import as_given, num, on_axis, percent, readable
from twin.study.calibration.calibration_lines import sizes_in_words
from twin.study.diagnosis.tell_diagnosis import candidate_lines, weather_lines
from twin.study.fleet.fleet_lines import size, slope
from twin.study.instruments.instrument_lines import amount
from twin.study.update.added import number_lines

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


MARKS = [
    ([57.690 + 0.001 * k for k in range(6)], ["57.69", "57.691", "57.692", "57.693", "57.694", "57.695"]),
    ([180.1, 180.15, 180.2], ["180.1", "180.15", "180.2"]),
    ([-2.5, -1.25, 0.0, 1.25], ["-2.5", "-1.25", "0", "1.25"]),
    ([0.0, 20000.0, 40000.0], ["0", "20000", "40000"]),
    ([6412345.5, 6412346.0], ["6412345.5", "6412346"]),
    ([1e-7, 2e-7], ["1e-7", "2e-7"]),
    ([0.001, 0.01, 0.1, 1.0, 10.0], ["0.001", "0.01", "0.1", "1", "10"]),
    ([3.0], ["3"]),
    ([], []),
]


@pytest.mark.parametrize("marks, said", MARKS)
def test_the_marks_of_an_axis_are_told_from_each_other(marks, said):
    assert on_axis(marks) == said


def test_a_share_is_told_in_whole_per_cent():
    assert (percent(0.854), percent(1.0), percent(-0.004)) == ("85 %", "100 %", "0 %")


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


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
def test_the_pages_tell_the_marks_of_an_axis_by_the_same_rule():
    script = (ROOT / "twin" / "report" / "number.js").read_text() + (
        f"console.log(JSON.stringify({[marks for marks, _ in MARKS]}.map(onAxis)));"
    )
    done = subprocess.run(["node", "-e", script], capture_output=True, text=True, timeout=60, check=True)
    told = [[text.replace("\u202f", "") for text in row] for row in json.loads(done.stdout)]
    assert told == [said for _, said in MARKS]


COMPASS = {  # by hand: 0.1 rad is 5.7296 deg
    "name": "bias", "value": 0.1, "low95": 0.08, "high95": 0.12, "sd": 0.01, "unit": "rad", "at_box_end": False,
}  # fmt: skip
GYRO = COMPASS | {"value": 0.01, "low95": 0.008, "high95": 0.012, "sd": 0.001, "unit": "rad/s"}


def test_an_angle_is_told_in_degrees_and_its_file_keeps_radians():
    told = readable(COMPASS)
    assert [round(told[k], 3) for k in ("value", "low95", "high95", "sd")] == [5.730, 4.584, 6.875, 0.573]
    assert (told["unit"], told["at_box_end"], COMPASS["value"]) == ("deg", False, 0.1)
    assert (readable({"value": 5.0, "unit": "-"}), readable({"value": 5.0, "unit": "N"})["unit"]) == (
        {"value": 5.0, "unit": ""},
        "N",
    )
    assert round(readable({"value": 0.2, "unit": "1/rad"})["value"], 5) == 0.00349


def candidate(number):
    force = {"X_N": 0.0, "Y_N": 0.0, "N_Nm": 0.0}
    return {
        "effect": "HeadingBias", "probability": 0.9, "together_with": [], "parameters": [number],
        "typical_force": force, "error_floor": None, "error_horizon_s": 120.0, "error_without": 9.0,
        "error_with": 3.0, "cannot_be_told_from": [], "says": "",
    }  # fmt: skip


def diagnosed_weather(number):
    path = {"horizon_s": 120.0, "error_without": None, "error_floor": None, "weather": []}
    return {"weather": [candidate(number)], "path": path, "candidates": [], "resembles": []}


@pytest.mark.parametrize("number, said", [(COMPASS, ("5.7", "deg")), (GYRO, ("0.57", "deg/s"))])
def test_every_text_of_an_effect_tells_its_angles_in_degrees(number, said):
    """Test: an angle of 0.1 rad and a rate of 0.01 rad/s in the texts of diagnose, add, fleet, calibrate and
    instruments. Expected: degrees, with their unit, and no radians in any line."""
    trend = {"slope": 0.1, "low95": 0.08, "high95": 0.12, "per": "month"}
    cause = {"trend": trend, "number": number, "sizes": []}
    texts = [
        *candidate_lines(candidate(number)),
        *weather_lines(diagnosed_weather(number)),
        *number_lines({"HeadingBias": {"bias": number}}),
        size(number),
        sizes_in_words({"bias": number}),
        amount(number["value"], number["unit"]),
    ]
    assert not any(" rad" in line for line in texts)
    assert sum(said[0] in line and f" {said[1]}" in line for line in texts) == 6
    assert slope(cause) == "+5.7 a month (+4.6 to +6.9)"


def told_with_its_unit(path):
    """Whether an f-string of the file tells the unit of a number of an effect or a ship."""
    told = {
        ast.unparse(v.value)
        for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.JoinedStr)
        for v in node.values if isinstance(v, ast.FormattedValue)
    }  # fmt: skip
    return any(text.endswith(("['unit']", ".unit")) for text in told)


def test_what_the_study_tells_with_a_unit_goes_through_the_one_table():
    """Expected: each file of the study that tells the unit of a number reads it through `readable`, but those
    that tell metres, newtons and a ship's particulars."""
    si = {"fall.py", "first_estimate.py", "first_trial.py"}
    files = [p for p in (ROOT / "twin" / "study").rglob("*.py") if told_with_its_unit(p)]
    assert len(files) > len(si)
    assert {p.name for p in files if "readable" not in p.read_text()} == si


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
def test_the_pages_tell_an_angle_by_the_same_table():
    numbers = [COMPASS, GYRO, {"value": 0.2, "unit": "1/rad"}, {"value": 2.0, "unit": "-"}]
    script = (ROOT / "twin" / "report" / "number.js").read_text() + (
        f"console.log(JSON.stringify({json.dumps(numbers)}.map(readable)));"
    )
    done = subprocess.run(["node", "-e", script], capture_output=True, text=True, timeout=60, check=True)
    for told, number in zip(json.loads(done.stdout), numbers, strict=True):
        expected = readable(number)
        assert told["unit"] == expected["unit"] and told["value"] == pytest.approx(expected["value"])
        assert all(told[k] == pytest.approx(expected[k]) for k in ("low95", "high95", "sd") if k in number)
