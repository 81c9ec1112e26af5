"""The house: imports go one way, the loop's process stays light, and every verb is documented.

physics <- live <- recording <- study; export -> all three; nothing in twin imports export, bench or
deploy
"""

import ast
import importlib.util
import os
import subprocess
import sys

import pytest

from bench.cli import BENCHES
from tests.sources import ROOT, called, imports, sources
from twin.cli import VERBS, main

ROOMS = (
    "twin.physics",
    "twin.live",
    "twin.recording",
    "twin.study",
    "twin.report",
    "export",
    "bench",
    "deploy",
)
ASHORE = {"twin.physics", "twin.live", "twin.recording", "twin.study", "twin.report"}
MAY_IMPORT = {
    "twin.physics": {"twin.physics"},
    "twin.live": {"twin.physics", "twin.live"},
    "twin.recording": {"twin.physics", "twin.live", "twin.recording"},
    "twin.study": ASHORE - {"twin.report"},
    "twin.report": ASHORE,
    "export": {*ASHORE, "export"},
}
ORDER = (
    "twin.physics",
    "twin.live.signals",
    "twin.live.keelson",
    "twin.live.log",
    "twin.live.observer",
    "twin.live.gates",
    "twin.live.learning",
    "twin.live.prediction",
    "twin.live.certificate",
    "twin.live.injection",
    "twin.live",
    "twin.recording",
    "twin.study.track",
    "twin.study.estimation",
    "twin.study.reference",
    "twin.study.instruments",
    "twin.study.prediction",
    "twin.study.calibration",
    "twin.study.diagnosis",
    "twin.study.update",
    "twin.study.first_model",
    "twin.study.fleet",
    "twin.study",
    "twin.report",
    "twin.api",
    "twin.studio",
    "twin.commands",
)
ONLY_IN_EXPORT = {"torch"}
NOT_ON_BOARD = {
    "torch",
    "scipy",
    "matplotlib",
    "pydantic",
    "pandas",
    "filterpy",
    "sympy",
    "numpy",
    "tomlkit",
    "pyarrow",
    "dask",
    "distributed",
    "twin.study",
    "twin.recording",
}


def inner_room_of(module):
    """The innermost room of ORDER that holds a module."""
    held = [room for room in ORDER if module == room or module.startswith(room + ".")]
    return max(held, key=len, default=None)


def room_of(module):
    return next((room for room in ROOMS if module == room or module.startswith(room + ".")), None)


@pytest.mark.parametrize("room", MAY_IMPORT)
def test_imports_go_one_way(room):
    """Test: every import statement of a room. Expected: only rooms it may know."""
    wrong = [
        f"{path.relative_to(ROOT)} imports {module}"
        for path in sources(room)
        for module in imports(path)
        if room_of(module) not in (None, *MAY_IMPORT[room])
    ]
    assert not wrong


def test_nothing_in_twin_imports_export_bench_or_deploy():
    outer = {"export", "bench", "deploy"}
    wrong = [(str(p), m) for p in sources("twin") for m in imports(p) if m.split(".")[0] in outer]
    assert not wrong


@pytest.mark.parametrize("room", ORDER)
def test_a_room_imports_only_rooms_that_stand_before_it(room):
    """Test: every import of a room's own files. Expected: rooms that stand before it in ORDER, or itself."""
    before = ORDER[: ORDER.index(room) + 1]
    wrong = [
        f"{path.relative_to(ROOT)} imports {module}"
        for path in sources(room)
        if inner_room_of(".".join(path.relative_to(ROOT).with_suffix("").parts)) == room
        for module in imports(path)
        if inner_room_of(module) not in (None, *before)
    ]
    assert not wrong


def test_no_import_goes_round():
    """Test: every import of twin, export and bench, those in functions and for a type checker too. Expected:
    from no module a way leads back to it."""
    paths = [p for room in ("twin", "export", "bench") for p in sources(room)]
    names = {".".join(p.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): p for p in paths}
    knows = {
        name: {m for i in imports(p) if (m := _module(i, names)) not in (None, name)}
        for name, p in names.items()
    }
    while leaves := [name for name, known in knows.items() if not known & knows.keys()]:
        for name in leaves:
            del knows[name]
    assert not {name: sorted(known & knows.keys()) for name, known in knows.items()}


def _module(imported, names):
    """The module that `from MODULE import NAME` takes from, or that it takes; None: none of ours."""
    return next((m for m in (imported, imported.rpartition(".")[0]) if m in names), None)


def test_every_module_stands_in_a_room():
    """Test: the files of twin that are not on its own floor. Expected: each has a room in ORDER."""
    floor = {"twin", "twin.ships", "twin.voyages"}
    modules = [p.relative_to(ROOT).with_suffix("").parts for p in sources("twin")]
    lost = [
        ".".join(m) for m in modules if inner_room_of(".".join(m)) is None and ".".join(m[:-1]) not in floor
    ]
    assert not lost


def test_physics_loads_no_library():
    """Expected: the standard library and the twin's own errors, nothing else."""
    known = sys.stdlib_module_names | {"twin"}
    wrong = [(p.name, m) for p in sources("twin.physics") for m in imports(p) if m.split(".")[0] not in known]
    assert not wrong


def test_torch_is_loaded_in_export_only():
    wrong = [(str(p), m) for p in sources("twin") for m in imports(p) if m.split(".")[0] in ONLY_IN_EXPORT]
    assert not wrong


SERVE = """
import socket, sys
from twin.live import service
from twin.live.signals.config import Settings
with socket.socket() as probe:
    probe.bind(("127.0.0.1", 0))
    port = probe.getsockname()[1]
settings = Settings().but("bus.listen", f"tcp/127.0.0.1:{port}").but("loop.priority", 0)
service.serve(settings, 1.0)
print(*sys.modules)
"""


def test_the_loops_process_stays_light(tmp_path):
    """Test: serve for a second in a process of its own. Expected: no library of training or study loaded."""
    command = [sys.executable, "-c", SERVE]
    env = os.environ | {"HOME": str(tmp_path)}
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, text=True, timeout=90)
    loaded = set(done.stdout.split())
    assert "twin.live.loop" in loaded, done.stderr
    assert not loaded & NOT_ON_BOARD


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_shows_an_example_in_its_help(name, capsys):
    verb = VERBS[name]
    if importlib.util.find_spec(verb.module) is None:
        pytest.skip(f"{verb.module} is not in this version")
    assert verb.example.startswith(f"twin {name}")
    with pytest.raises(SystemExit) as ended:
        main([name, "--help"])
    assert ended.value.code == 0
    _, found, example = capsys.readouterr().out.partition("example:")
    assert found and example.split()[:2] == ["twin", name]


@pytest.mark.parametrize("name", VERBS)
def test_every_verb_is_in_the_documents(name):
    documents = "".join(p.read_text() for p in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))))
    assert f"twin {name}" in documents


@pytest.mark.parametrize("name", BENCHES)
def test_every_benchmark_is_typed_as_its_example_says(name):
    assert BENCHES[name].example.startswith("twin-bench")


@pytest.mark.parametrize("room", ["twin.physics", "twin.live"])
def test_nothing_on_the_way_of_a_replay_is_summed_by_the_built_in_sum(room):
    """Expected: `maths.total` and `maths.dot` instead, whose bits are those of every Python; the built-in
    one, fsum and sumprod correct."""
    wrong = [
        f"{path.relative_to(ROOT)}, line {node.lineno}: {name}"
        for path in sources(room)
        for node in ast.walk(ast.parse(path.read_text()))
        if (name := called(node)) in ("sum", "fsum", "sumprod")
    ]
    assert not wrong


LONG = 300  # lines of a file; the method fits on a page, or it is two ideas


def test_no_file_is_longer_than_three_hundred_lines():
    files = [p for room in ("twin", "export", "bench", "deploy", "tests", "docs") for p in sources(room)]
    assert not [str(p.relative_to(ROOT)) for p in files if len(p.read_text().splitlines()) > LONG]
