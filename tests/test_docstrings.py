"""Every public function of the inner rooms says what it does, with shapes, units and the errors it raises."""

import pytest

from tests.docstrings import House, owed
from tests.sources import ROOT, sources

ROOMS = ("twin.physics", "twin.live", "twin.recording", "twin.study", "twin.report", "twin.api", "export")
FILES = [path.relative_to(ROOT).as_posix() for room in ROOMS for path in sources(room)]


@pytest.fixture(scope="module")
def house():
    """All that the inner rooms may be cases of."""
    return House(
        {
            path.relative_to(ROOT).as_posix(): path.read_text()
            for room in ("twin", "export")
            for path in sources(room)
        }
    )


@pytest.mark.parametrize("where", FILES)
def test_a_public_function_says_what_it_takes_gives_and_raises(where, house):
    """Test: every public function, and method of a public class. Expected: a docstring (a case of another
    class may leave it to that one); where it takes or gives arrays, a shape and a unit; where its body raises
    an error of the twin, that error's name."""
    left_out = {asked.where: list(owed(asked, house.errors)) for asked in house.asked(where)}
    assert not {name: words for name, words in left_out.items() if words}


HEAD = '''
import numpy as np
class TwinError(Exception): ...
class DataError(TwinError): ...
class Own(DataError): ...
class Base:
    def told(self) -> int:
        """How many."""
'''


def left_out(source):
    house = House({"a.py": HEAD + source})
    return {a.where.partition(":")[2]: list(owed(a, house.errors)) for a in house.asked("a.py")}


TOOK = "def f(x: np.ndarray) -> float:\n    '''{}'''\n"


@pytest.mark.parametrize(
    "said, missing",
    [
        ("(N, 3) velocities [m/s].", []),
        ("x (..., 8), in SI.", []),
        ("A share of each row (N + 1, 2 P).", []),
        ("Velocities [m/s].", ["shape"]),
        ("The (ahead, aside) of a velocity [m/s].", ["shape"]),
        ("Motion (u, v, r) [m/s], see (name,) and (0, 1).", ["shape"]),
        ("(N, 3) velocities.", ["unit"]),
        ("(N, 3) velocities [fast], on [0, 360).", ["unit"]),
        ("All of them.", ["shape", "unit"]),
        ("", ["docstring"]),
    ],
)
def test_empty_words_are_neither_shape_nor_unit(said, missing):
    assert left_out(TOOK.format(said))["f"] == missing


def test_an_error_is_named_by_the_function_that_raises_it():
    """Expected: also one that is a case of an error of the twin; not those of other libraries, nor what a
    function inside raises."""
    raised = "def f(x):\n    '''It.{}'''\n    if x:\n        raise {}('no')\n"
    assert left_out(raised.format("", "DataError"))["f"] == ["DataError"]
    assert left_out(raised.format("", "Own"))["f"] == ["Own"]
    assert left_out(raised.format(" DataErrors.", "DataError"))["f"] == ["DataError"]
    assert left_out(raised.format(" DataError: when.", "DataError"))["f"] == []
    assert left_out(raised.format("", "ValueError"))["f"] == []
    assert (
        left_out("def f():\n    '''It.'''\n    def g():\n        raise DataError('no')\n    return g\n")["f"]
        == []
    )


def test_a_case_of_a_class_may_leave_the_docstring_to_it():
    found = left_out("class Case(Base):\n    def told(self): ...\n    def other(self): ...\n")
    assert found["Case.told"] == [] and found["Case.other"] == ["docstring"]


def test_a_name_of_an_array_type_is_one():
    assert left_out("Columns = dict[str, np.ndarray]\ndef f(c: Columns):\n    '''It.'''\n")["f"] == [
        "shape",
        "unit",
    ]


def test_what_is_private_owes_nothing():
    assert not [n for n in left_out("def _f(): ...\nclass _C:\n    def f(self): ...\n") if "_" in n]
