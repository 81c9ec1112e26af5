"""The source files of a room, and what stands in them."""

import ast
from pathlib import Path

ROOT = Path(__file__).parents[1]


def sources(room):
    return sorted((ROOT / room.replace(".", "/")).rglob("*.py"))


def imports(path):
    """Full names of what a file imports, relative ones resolved: at its top, in a function, or for a type
    checker alone."""
    package = path.relative_to(ROOT).with_suffix("").parts[:-1]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*above, *(node.module or "").split("."))).strip(".")
            yield from (f"{module}.{alias.name}" for alias in node.names)


def strings(path):
    """The strings of a file that are no docstrings."""
    tree = ast.parse(path.read_text())
    holders = (ast.Module, ast.ClassDef, ast.FunctionDef)
    bodies = [node.body[0] for node in ast.walk(tree) if isinstance(node, holders) and node.body]
    docs = {id(first.value) for first in bodies if isinstance(first, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            yield node.value


def called(node):
    """The bare name of a built-in or a function of `math` that is used here (called, or handed on), else
    ""."""
    if isinstance(node, ast.Name):
        return node.id
    return (
        node.attr
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "math"
        else ""
    )
