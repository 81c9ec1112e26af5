"""What no file of a room does: know an effect by its name, print, be more than a page of a verb."""

import ast
import re

import pytest

from tests.sources import ROOT, called, imports, sources, strings
from twin.physics.effects import BUILT_IN, OF_ACTUATORS, UNNAMED

EFFECT_NAMED = {  # file of the study -> why the name of an effect stands in it
    "twin/study/first_model/first_estimate.py": "the help of two areas says which effect asks for them",
}


def test_the_study_knows_no_effect_by_its_name():
    """Test: every string and every import of the study. Expected: effects are asked for by what they declare
    (owner, kind, role, needs), so that one of an installed package counts for as much as ours."""
    names = {e.__name__ for e in (*BUILT_IN, *UNNAMED, *OF_ACTUATORS)}
    wrong = []
    for path in sources("twin.study"):
        where = str(path.relative_to(ROOT))
        said = {word for text in strings(path) for word in re.findall(r"\w+", text)} & names
        taken = {m for m in imports(path) if m.rpartition(".")[2] in names}
        if (said or taken) and where not in EFFECT_NAMED:
            wrong.append(f"{where}: {', '.join(sorted(said | taken))}")
    assert not wrong
    assert all((ROOT / where).exists() for where in EFFECT_NAMED)


TELLERS = {  # outside of twin/commands: who prints, and what
    "twin/cli.py": "what went wrong, in one line",
    "twin/whole.py": "what was asked for as `-`",
    "twin/live/bridge/serve.py": "`twin view`: the link, and that it listens",
    "twin/live/build.py": "the certificate as JSON, for the process that asked for it",
    "twin/live/demonstration.py": "the part on board of `twin demo`",
    "twin/live/health_check.py": "`twin health`: its answer",
    "twin/live/injection/on_bus.py": "`twin fault`, live: from where to where",
    "twin/live/onto_bus.py": "`twin replay --to-bus`: where it is, and its keys",
    "twin/live/log_replay.py": "`twin replay`: how far it is",
    "twin/live/service.py": "`twin run`: its greeting, for the journal",
    "twin/studio/local_server.py": "`twin studio`: the link",
}


def test_the_library_prints_nothing():
    """Expected: `print(` in the verbs and in the tellers of the table alone; all else says what it does by
    `progress=` and to the log `twin`."""
    printing = {str(p.relative_to(ROOT)) for p in sources("twin") if "print" in map(called, _nodes(p))}
    verbs = {where for where in printing if where.startswith("twin/commands/")}
    assert printing - verbs == set(TELLERS)


def _nodes(path):
    return ast.walk(ast.parse(path.read_text()))


VERB_LINES = 60


@pytest.mark.parametrize("path", sources("twin.commands"), ids=lambda path: path.stem)
def test_a_verb_is_a_page_of_arguments_over_the_interface(path):
    """Expected: no more than sixty lines; what it does is a function that others can call."""
    assert len(path.read_text().splitlines()) <= VERB_LINES


def test_a_test_imports_no_private_name():
    """Expected: what a test asks for is an idea of its own, and public."""
    private = [
        f"{path.relative_to(ROOT)}: {name}"
        for path in sources("tests")
        for name in imports(path)
        if name.partition(".")[0] in ("twin", "bench", "export")
        and name.rpartition(".")[2].startswith("_")
        and not name.rpartition(".")[2].startswith("__")
    ]
    assert not private
