"""What a docstring owes its reader, found by reading the code: shapes, units, errors.

A shape is a bracket of sizes: (N, 3), (3,), (..., 8), (N + 1, 2 P). A size is a whole number from 1, or a letter
that counts; so (u, v, r) and (name,) are none. A unit is a bracket of SI or nautical units: [m], [m/s], [N m],
[1/s], [-]. What has none says so by a word of `NO_UNIT`, or leaves it to where each is told: "in the units of".
"""

import ast
import re
from dataclasses import dataclass

SIZE = r"(?:\.\.\.|[1-9]\d*(?: [A-Z])?|[A-Z]|[nmkpqc])(?: ?[-+*] ?(?:[A-Z]|[1-9]\d*)){0,2}"
SHAPE = re.compile(rf"\((?:{SIZE},|{SIZE}(?:, {SIZE})+)\)")
BASES = "m|mm|km|s|ms|us|ns|min|h|d|kg|t|N|kN|MN|Nm|J|W|kW|Pa|kPa|hPa|K|degC|C|A|V|rad|deg|Hz|rpm|kn|nm|NM|bytes|B|%"
POWER = rf"(?:{BASES})[2-6]?"
UNIT = re.compile(rf"\[(?:-|(?:1|{POWER})(?:(?: |/| / |/\()(?:{POWER})\)?)*)(?:[,;] [^\]]*)?\]")
NO_UNIT = re.compile(
    r"\b(?:bool|int|masks?|index|indices|integers?|counts?|weights?|probabilit(?:y|ies)|shares?|dimensionless|SI|"
    r"(?:in|of) (?:[\w']+ ){1,3}units?|in units|units? of|radians|standard deviations?|prior widths?|grid steps?)\b",
    re.I,
)
ARRAY = re.compile(r"\b(ndarray|NDArray|ArrayLike)\b")
DEFS = (ast.FunctionDef, ast.AsyncFunctionDef)


@dataclass(frozen=True)
class Asked:
    """A public function, or a method of a public class."""

    where: str  # twin/a/b.py:Class.method
    node: ast.FunctionDef | ast.AsyncFunctionDef
    doc: str  # its own, or that of the method of a base that it is a case of
    around: str  # the class's docstring and the module's
    arrays: bool  # it takes or returns arrays


class House:
    """The classes, kinds of error and names of array types of many files."""

    def __init__(self, files):
        """`files`: place -> text."""
        self.trees = {where: ast.parse(text) for where, text in files.items()}
        self.classes = {}
        for tree in self.trees.values():
            for node in (n for n in ast.walk(tree) if isinstance(n, ast.ClassDef)):
                self.classes.setdefault(node.name, []).append(node)
        self.errors = {name for name in self.classes if "TwinError" in self.lineage(name)}

    def lineage(self, name):
        """A class's name, and those of all that it is a case of."""
        bases = {bare(base) for node in self.classes.get(name, ()) for base in node.bases} - {name}
        return [name, *(n for base in sorted(bases) for n in self.lineage(base))]

    def asked(self, where):
        """The public functions of a file, and the methods of its public classes."""
        tree = self.trees[where]
        module, types = ast.get_docstring(tree) or "", array_names(tree)
        for node in public(tree.body, DEFS):
            yield asked(f"{where}:{node.name}", node, ast.get_docstring(node) or "", module, types)
        for held in public(tree.body, ast.ClassDef):
            around = f"{module}\n{ast.get_docstring(held) or ''}"
            for node in public(held.body, DEFS):
                if not ({bare(d) for d in node.decorator_list} & {"setter", "overload"}):
                    doc = self.doc(held.name, node)
                    yield asked(f"{where}:{held.name}.{node.name}", node, doc, around, types)

    def doc(self, name, method):
        """A method's docstring, or the first of that name in the classes its own is a case of."""
        own = ast.get_docstring(method)
        above = (
            ast.get_docstring(node)
            for base in self.lineage(name)[1:]
            for held in self.classes.get(base, ())
            for node in held.body
            if isinstance(node, DEFS) and node.name == method.name
        )
        return own or next(filter(None, above), "")


def bare(node):
    """The last name of an expression: `a.b.C[T](...)` is C."""
    while isinstance(node, (ast.Call, ast.Subscript)):
        node = node.func if isinstance(node, ast.Call) else node.value
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def public(body, kinds):
    return [node for node in body if isinstance(node, kinds) and not node.name.startswith("_")]


def array_names(tree):
    """Names of a file that stand for arrays: `Columns = dict[str, np.ndarray]`."""
    return {
        node.targets[0].id
        for node in tree.body
        if isinstance(node, ast.Assign)
        and isinstance(node.targets[0], ast.Name)
        and isinstance(node.value, (ast.Subscript, ast.Attribute))
        and not ast.unparse(node.value).startswith("Callable")
        and ARRAY.search(ast.unparse(node.value))
    }


def asked(where, node, doc, around, types):
    arguments = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs, node.args.vararg]
    annotated = [a.annotation for a in arguments if a is not None and a.annotation] + [node.returns]
    said = [re.sub(r"Callable\[.*\]", "", ast.unparse(a)) for a in annotated if a is not None]
    arrays = any(ARRAY.search(a) or types & set(re.findall(r"\w+", a)) for a in said)
    return Asked(where, node, doc, around, arrays)


def raised(node):
    """Names of the errors that a function's own body raises, those of functions inside it left out."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Raise) and child.exc is not None:
            yield bare(child.exc)
        if not isinstance(child, (*DEFS, ast.Lambda, ast.ClassDef)):
            yield from raised(child)


def owed(asked, errors):
    """What one docstring leaves out, in words."""
    if not asked.doc.strip():
        yield "docstring"
        return
    if asked.arrays:
        if not SHAPE.search(asked.doc):
            yield "shape"
        if not any(pattern.search(asked.doc + asked.around) for pattern in (UNIT, NO_UNIT)):
            yield "unit"
    for name in sorted(set(raised(asked.node)) & errors):
        if not re.search(rf"\b{name}\b", asked.doc):
            yield name
