"""The field's words: none of the private ones that once stood for them is in a name or in what a user reads."""

import ast
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NAMES = frozenset(
    [
        "luxury",
        "led",
        "tossed",
        "unrest",
        "acquitted",
        "accused",
        "blamed",
        "nats",
        "leftover",
        "stranger",
        "strangers",
        "climb",
        "world",
        "worlds",
        "stirred",
        "spoils",
        "misled",
        "hers",
        "she",
    ]
)
GIVEN_ONCE = frozenset(["told", "asked", "judged", "floor", "floors", "clear", "clearly"])
FIELDS = frozenset(["told", "floor", "floors"])
ONE_MEANING = {  # a name at the top of a file that may bear one of GIVEN_ONCE -> why
    "CLEAR": "the one odds by which the decision calls something clear (criteria.py, docs/diagnosis.md)",
    "CLEAR_SCREEN": "what a terminal is told",
    "AskedKinematics": "in kept searches of `python -m bench.decisions`, which are read again by this name",
}
READ = re.compile(
    r"\b(she|her|hers|herself|nats|luxury|acquitted|accused|blamed|leftover|tossed|unrest|"
    r"about (?:its|their) own size|reckoned with)\b",
    re.I,
)
FILES = sorted(
    path
    for room in ("twin", "export", "bench", "deploy")
    for path in (ROOT / room).rglob("*.py")
    if "__pycache__" not in path.parts
)


@pytest.fixture(scope="module")
def trees():
    """Every file as it is parsed, once."""
    return {path: ast.parse(path.read_text()) for path in FILES}


def names(tree):
    """Every name that is given in a file."""
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr


def texts(tree):
    """Every piece of text of a file: messages, help, docstrings."""
    return [n.value for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)]


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_file_gives_a_private_name_or_says_a_private_word(path, trees):
    tree = trees[path]
    given = {part for name in (*names(tree), path.stem) for part in re.split(r"_+", name.lower())}
    assert not given & NAMES
    assert not [found.group() for text in texts(tree) for found in READ.finditer(text)]


def test_no_page_of_the_documentation_says_one():
    pages = subprocess.run(
        ["git", "ls-files", "*.md"], cwd=ROOT, capture_output=True, text=True
    ).stdout.split()
    read = [page for page in pages if not page.startswith(("docs/history/", "CHANGELOG"))]
    wrong = {page: set(READ.findall((ROOT / page).read_text())) for page in read}
    assert read and not {page: words for page, words in wrong.items() if words}


def at_top(tree):
    """Every function, class and constant of a module."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            yield from names(node)


def test_no_module_gives_a_name_that_has_had_several_meanings(trees):
    """Expected: what a line, an order, a noise model, a result or a limit is says its name, not that somebody
    told, asked or judged it; each constant says of what it is the limit."""
    given = {}
    for path, tree in trees.items():
        for name in (path.stem, *at_top(tree)):
            words = {word.lower() for word in re.findall(r"[A-Z][a-z]+|[a-z]+|[A-Z]+", name)}
            if words & GIVEN_ONCE:
                given.setdefault(name, []).append(str(path.relative_to(ROOT)))
    assert {name: where for name, where in given.items() if name not in ONE_MEANING} == {}
    assert all(len(given[name]) == 1 for name in ONE_MEANING)


def of_classes(tree):
    """Every field and method of the classes of a module."""
    for node in ast.walk(tree):
        for part in node.body if isinstance(node, ast.ClassDef) else ():
            if isinstance(part, ast.AnnAssign):
                yield part.target.id
            elif isinstance(part, (ast.FunctionDef, ast.AsyncFunctionDef)):
                yield part.name
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr


def test_no_field_and_no_method_says_told_or_floor(trees):
    """Expected: a field is a noise model, an expected error, an allowance, orders, information; a record is put
    down `as_json`. (Keys of JSON and of ship files that are read outside stay: they are no names of fields.)"""
    given = {str(path.relative_to(ROOT)): set(of_classes(tree)) for path, tree in trees.items()}
    assert {path: names & FIELDS for path, names in given.items() if names & FIELDS} == {}


def test_a_class_has_its_name_alone(trees):
    """Expected: within twin, export, bench and deploy no class name twice, but for Force, the kind of effect,
    and Force, the vector it returns: plug-ins import both."""
    places = {}
    for path, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                places.setdefault(node.name, []).append(str(path.relative_to(ROOT)))
    assert not {name: where for name, where in places.items() if len(where) > 1 and name != "Force"}
