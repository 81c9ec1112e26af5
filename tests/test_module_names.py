"""One name, one meaning: no module of the tree bears the name of another one."""

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
