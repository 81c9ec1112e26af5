"""Which test reaches which line of what guards: each test of a part is run once with its lines watched, so
that a fault is shown only to the tests that come to it, those of its own line and the quickest first."""

import ast
import json
import os
import sys
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import pytest


class Reached(NamedTuple):
    """One test: how long it took, watched, and the lines it reached of each file."""

    test: str
    seconds: float
    lines: dict[str, list[int]]


class Watcher:
    """A plug-in of pytest that takes down the lines of some files while a test runs."""

    def __init__(self, root: Path, files: Sequence[str]):
        self._files = {str(root / file): file for file in files}
        self._seen: dict[str, set[int]] = {}
        self._failed = set[str]()
        self._all: list[Reached] = []

    @property
    def found(self) -> list[Reached]:
        """Of the tests that pass while they are watched (a few are about time, and watching takes some)."""
        return [test for test in self._all if test.test not in self._failed]

    def pytest_runtest_logreport(self, report: Any) -> None:
        if report.failed:
            self._failed.add(report.nodeid)

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: Any) -> Any:
        self._seen = {file: set() for file in self._files.values()}
        began = time.monotonic()
        threading.settrace(self._called)
        sys.settrace(self._called)
        try:
            yield
        finally:
            sys.settrace(None)
            threading.settrace(None)  # type: ignore[arg-type]
            lines = {file: sorted(seen) for file, seen in self._seen.items() if seen}
            if lines:
                self._all.append(Reached(item.nodeid, time.monotonic() - began, lines))

    def _called(self, frame: FrameType, event: str, arg: Any) -> Callable[..., Any] | None:
        file = self._files.get(frame.f_code.co_filename)
        if file is None:
            return None
        seen = self._seen[file]

        def line(frame: FrameType, event: str, arg: Any) -> Callable[..., Any]:
            seen.add(frame.f_lineno)
            return line

        return line(frame, event, arg)


def reached(root: Path, files: Sequence[str], tests: Sequence[str], kept: Path) -> list[Reached]:
    """What the tests reach, from file where it was watched before; in a process of its own."""
    if not kept.exists() and not (process := os.fork()):
        os.chdir(root)
        sys.path.insert(0, str(root))
        watcher = Watcher(root, files)
        pytest.main(["-q", "-p", "no:cacheprovider", *tests], plugins=[watcher])
        kept.write_text(json.dumps(watcher.found))
        os._exit(0)
    if not kept.exists():
        os.waitpid(process, 0)
    return [Reached(*row) for row in json.loads(kept.read_text())]


def reaching(found: Sequence[Reached], file: str, source: str, line: int, budget_s: float) -> list[str]:
    """The tests that come to the function of a line, those that come to the line itself first and the
    quickest of them first, for so long together; of a line outside of functions all that come to the file."""
    begin, end = _around(ast.parse(source), line)
    able = [
        (line not in test.lines[file], test.seconds, test.test)
        for test in found
        if any(begin <= at <= end for at in test.lines.get(file, ()))
    ]
    chosen, together_s = [], 0.0
    for _, seconds, test in sorted(able):
        if together_s + seconds <= budget_s or not chosen:
            chosen.append(test)
            together_s += seconds
    return chosen


def _around(tree: ast.AST, line: int) -> tuple[int, int]:
    """First and last line of the smallest function around a line."""
    spans = [
        (node.end_lineno - node.lineno, node.lineno, node.end_lineno)
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and node.lineno <= line <= (node.end_lineno or 0)
    ]
    return min(spans)[1:] if spans else (0, 10**9)
