"""One name, one meaning: no module of the tree bears the name of another one, and a constant says of what it is
the limit."""

import ast
import re
from collections import defaultdict
from fnmatch import fnmatch

from tests.sources import ROOT, sources
from twin.cli import VERBS

SHARED = {  # files that may bear a name that stands elsewhere too -> why
    **{
        verb.module.replace(".", "/") + ".py": "a verb's file bears the verb's name"
        for verb in VERBS.values()
    },
    "bench/cli.py": "the two programs, `twin` and `twin-bench`, begin alike",
    "bench/*/run.py": "a benchmark is asked for by its folder's `run`",
    "bench/*/page.py": "and writes its page in its folder's `page`",
}


def modules():
    """Name of a module -> the files of twin, export and bench that bear it, but for those of SHARED."""
    places = defaultdict(list)
    for path in (p for room in ("twin", "export", "bench") for p in sources(room)):
        where = str(path.relative_to(ROOT))
        if not path.stem.startswith("__") and not any(fnmatch(where, pattern) for pattern in SHARED):
            places[path.stem].append(where)
    return places


def test_no_module_of_twin_export_and_bench_has_the_name_of_another_one():
    assert not {name: where for name, where in modules().items() if len(where) > 1}


def test_every_name_that_may_be_shared_is_in_use():
    """Expected: each row of SHARED names a file that is there, so that none outlives its reason."""
    assert not [pattern for pattern in SHARED if not list(ROOT.glob(pattern))]


BARE = {  # words that are no name of a constant, for they say neither of what it is nor in what unit
    "APART",
    "FEWEST",
    "FULL",
    "LEAST",
    "MOST",
    "SEEN",
    "STEP",
    "STILL",
}
ONCE = {  # words of which one constant has the meaning -> the file that has it
    "SURE": "twin/study/diagnosis/criteria.py",
    "CLEAR": "twin/study/diagnosis/criteria.py",
    "USUAL": "twin/study/diagnosis/criteria.py",
    "NEARLY": "twin/study/diagnosis/criteria.py",
    "CERTAIN": "twin/study/diagnosis/criteria.py",
    "LOST": "twin/study/diagnosis/criteria.py",
    "SIGNIFICANT": "twin/study/diagnosis/criteria.py",
}


def constants():
    """Name of a constant at the top of a module -> the files that give it."""
    places = defaultdict(set)
    for path in (p for room in ("twin", "export", "bench") for p in sources(room)):
        for node in ast.parse(path.read_text()).body:
            targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            for name in (n for t in targets if t is not None for n in ast.walk(t) if isinstance(n, ast.Name)):
                if re.fullmatch("[A-Z][A-Z0-9_]+", name.id):
                    places[name.id].add(str(path.relative_to(ROOT)))
    return places


def test_no_constant_is_called_by_a_word_that_says_neither_of_what_it_is_nor_in_what_unit():
    assert {name: where for name, where in constants().items() if name in BARE} == {}


def test_a_word_that_decides_has_its_meaning_in_one_file():
    """Expected: what `SURE` is, or `USUAL`, stands once, where docs/diagnosis.md reads it."""
    found = constants()
    assert {name: found[name] for name in ONCE} == {name: {where} for name, where in ONCE.items()}
