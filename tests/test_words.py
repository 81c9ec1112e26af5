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
def test_no_file_gives_a_private_name_or_says_a_private_word(path):
    tree = ast.parse(path.read_text())
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


def test_a_class_of_the_twin_has_its_name_alone():
    """Expected: within twin no class name twice, but for Force, the kind of effect, and Force, the vector it
    returns: plug-ins import both."""
    places = {}
    for path in FILES:
        if path.is_relative_to(ROOT / "twin"):
            for node in ast.walk(ast.parse(path.read_text())):
                if isinstance(node, ast.ClassDef):
                    places.setdefault(node.name, []).append(str(path.relative_to(ROOT)))
    assert not {name: where for name, where in places.items() if len(where) > 1 and name != "Force"}
