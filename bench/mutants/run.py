"""`twin-bench mutants`: a fault at a time is planted in a file that guards, and the file's tests are run
until one fails. A fault that no test notices survives, and is listed. What was tried is kept on file, so that
a run goes on where the last one ended."""

import argparse
import hashlib
import importlib.util
import json
import os
import random
import signal
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from bench import bench_output
from bench.fleet.answer_score import Share
from bench.mutants.guarded import GUARDED, PARTS, Guarded
from bench.mutants.mutate import Mutant, mutants
from bench.mutants.reach import reached, reaching

ROOT = Path(__file__).parents[2]
KILLED, SURVIVED, HUNG = "killed", "survived", "hung"
BUDGET_S, SEED = 30.0, 33  # of the tests that one fault is shown to, by their time while watched


class TriedMutant(NamedTuple):
    """One mutant and what became of it; `hung` counts as noticed."""

    file: str
    line: int
    change: str
    fate: str


class PlantedMutant(MetaPathFinder, Loader):
    """Loads one module from another source."""

    def __init__(self, path: Path, source: str):
        self.name, self.source, self.path = ".".join(path.with_suffix("").parts), source, path

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        return importlib.util.spec_from_loader(fullname, self) if fullname == self.name else None

    def exec_module(self, module: ModuleType) -> None:
        exec(compile(self.source, str(ROOT / self.path), "exec"), module.__dict__)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--file", action="append", choices=GUARDED, help="only this one (repeat)")
    parser.add_argument("--part", action="append", choices=PARTS, help="the files of this part (repeat)")
    parser.add_argument(
        "--drawn", type=int, default=0, metavar="N", help="drawn by chance from all the files together"
    )
    parser.add_argument(
        "--most", type=int, default=0, metavar="N", help="of each file, drawn by chance (default: all)"
    )
    parser.add_argument(
        "--seconds", type=float, default=0.0, metavar="S", help="end after so long (default: when done)"
    )
    parser.add_argument(
        "--kept", type=Path, default=Path(".mutants"), metavar="DIR", help="what was tried (.mutants)"
    )
    bench_output.add_arguments(parser)


def run(args: argparse.Namespace) -> int:
    import numpy  # noqa: F401  (loaded once, for all that is forked)
    import pytest  # noqa: F401
    import scipy.linalg  # noqa: F401

    ends = time.monotonic() + (args.seconds or 1e9)
    args.kept.mkdir(exist_ok=True)
    rows: list[TriedMutant] = []
    names = args.file or [name for name in GUARDED if not args.part or GUARDED[name].part in args.part]
    drawn = drawn_of(names, args.drawn) if args.drawn else dict.fromkeys(names)
    for name, chosen in drawn.items():
        rows += of_file(name, args.most, args.kept, ends, chosen)
    bench_output.rows(args, rows, page(rows))
    return 0


def drawn_of(names: Sequence[str], count: int) -> dict[str, list[int]]:
    """Of all faults of these files so many, drawn by chance: the numbers of each file."""
    every = [(name, i) for name in names for i, _ in enumerate(mutants(_text(GUARDED[name].source)))]
    some = sorted(random.Random(SEED).sample(every, min(count, len(every))))
    return {name: [i for of, i in some if of == name] for name in names}


def of_file(
    name: str, most: int, kept: Path, ends: float, chosen: Sequence[int] | None = None
) -> list[TriedMutant]:
    """Every mutant of a file, or those chosen by their numbers, that is on file or can be tried in time."""
    guarded, source = GUARDED[name], _text(GUARDED[name].source)
    all_of = list(mutants(source))
    if chosen is None:
        chosen = list(range(len(all_of)))
        if 0 < most < len(all_of):
            chosen = sorted(random.Random(1).sample(chosen, most))
    tests = digest_of("".join(_text(path) for test in guarded.tests for path in python_files(test)))
    memory = kept / f"{name}-{digest_of(source)}.json"
    told: dict[str, Any] = (
        json.loads(memory.read_text()) if memory.exists() else {"tests": tests, "fates": {}}
    )
    fates: dict[str, str] = told["fates"]
    if told["tests"] != tests:  # what a test has noticed stays noticed; the rest is shown to the new ones
        fates = {i: fate for i, fate in fates.items() if fate != SURVIVED}
    left = [i for i in chosen if str(i) not in fates]
    shown = shown_to(name, guarded, source, kept, tests) if left and time.monotonic() < ends else None
    for i in left:
        if time.monotonic() > ends or not shown:
            break
        fates[str(i)] = tried(guarded.source, all_of[i].source, *shown(all_of[i].line))
        memory.write_text(json.dumps({"tests": tests, "fates": fates}))
        bench_output.tell(f"{name} {i} {fates[str(i)]} {all_of[i].line}: {all_of[i].change}")
    return [_row(guarded.source, all_of[i], fates[str(i)]) for i in chosen if str(i) in fates]


def shown_to(
    name: str, guarded: Guarded, source: str, kept: Path, tests: str
) -> Callable[[int], tuple[Sequence[str], float]]:
    """For the line of a fault: the tests that it is shown to, and after how long [s] they hang."""
    if not guarded.part:
        began = time.monotonic()
        fate = tried(guarded.source, source, guarded.tests, 600.0)
        assert fate == SURVIVED, f"the tests of {name} fail without any fault: {fate}"
        limit_s = 4.0 * (time.monotonic() - began) + 10.0
        return lambda line: (guarded.tests, limit_s)
    files = [g.source for g in GUARDED.values() if g.part == guarded.part]
    sources = digest_of("".join(map(_text, files)))
    found = reached(ROOT, files, guarded.tests, kept / f"reach-{guarded.part}-{sources}-{tests}.json")
    return lambda line: (reaching(found, guarded.source, source, line, BUDGET_S), 4.0 * BUDGET_S)


def python_files(test: str) -> list[str]:
    """A test file, or those of a folder."""
    path = ROOT / test
    return [test] if path.is_file() else sorted(str(p.relative_to(ROOT)) for p in path.glob("test_*.py"))


def digest_of(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def _text(path: str) -> str:
    return (ROOT / path).read_text()


def _row(path: str, mutant: Mutant, fate: str) -> TriedMutant:
    return TriedMutant(path, mutant.line, mutant.change, fate)


def tried(path: str, source: str, tests: Sequence[str], limit_s: float) -> str:
    """The tests in a process of their own that loads this source."""
    process = os.fork()
    if process == 0:
        os.setpgid(0, 0)
        os._exit(_child(path, source, tests))
    ends = time.monotonic() + limit_s
    while time.monotonic() < ends:
        done, status = os.waitpid(process, os.WNOHANG)
        if done:
            return SURVIVED if status == 0 else KILLED
        time.sleep(0.02)
    with suppress(ProcessLookupError):
        os.killpg(process, signal.SIGKILL)
    os.waitpid(process, 0)
    return HUNG


def _child(path: str, source: str, tests: Sequence[str]) -> int:
    """0 when no test noticed."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    try:
        import pytest

        for loaded in [m for m in sys.modules if m.split(".")[0] == "twin"]:
            del sys.modules[loaded]
        os.chdir(ROOT)
        sys.path.insert(0, str(ROOT))
        sys.meta_path.insert(0, PlantedMutant(Path(path), source))
        return int(pytest.main(["-x", "-q", "-p", "no:cacheprovider", *tests]))
    except BaseException:
        return 1


def shares(rows: Sequence[TriedMutant]) -> dict[str, Share]:
    """By part, and of all together, how many faults were noticed of those tried."""
    part_of = {guarded.source: guarded.part or "others" for guarded in GUARDED.values()}
    fates: dict[str, list[bool]] = {}
    for row in rows:
        for part in (part_of.get(row.file, "others"), "all"):
            fates.setdefault(part, []).append(row.fate != SURVIVED)
    return {part: Share(sum(fates[part]), len(fates[part])) for part in sorted(fates, key="all".__eq__)}


def page(rows: Sequence[TriedMutant]) -> str:
    """The page."""
    lines = bench_output.begun(
        "Mutants of what guards", __doc__, "file", "mutants", "noticed", "of them by hanging", "survived"
    )
    for file in dict.fromkeys(row.file for row in rows):
        fates = [row.fate for row in rows if row.file == file]
        survived, hung = fates.count(SURVIVED), fates.count(HUNG)
        lines.append(f"| `{file}` | {len(fates)} | {len(fates) - survived} | {hung} | {survived} |")
    lines += ["", "| part | tried | noticed, with 95 % interval |", "|---|---|---|"]
    lines += [f"| {part} | {share.n} | {share} |" for part, share in shares(rows).items()]
    lines += ["", "## Survivors", "", "| file | line | change |", "|---|---|---|"]
    lines += [
        f"| `{row.file.rpartition('/')[2]}` | {row.line} | `{row.change.replace('|', '/')}` |"
        for row in rows
        if row.fate == SURVIVED
    ]
    return "\n".join(lines)
