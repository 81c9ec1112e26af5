"""One small fault in a source file: another comparison, number, sign or connective, a statement left out."""

import ast
import copy
from collections.abc import Iterator
from typing import NamedTuple

COMPARED = {
    ast.Lt: ast.LtE,
    ast.LtE: ast.Lt,
    ast.Gt: ast.GtE,
    ast.GtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.Is: ast.IsNot,
    ast.IsNot: ast.Is,
    ast.In: ast.NotIn,
    ast.NotIn: ast.In,
}
TURNED = {ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt}
REPLACED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.Pow: ast.Mult}
CALLED = {"min": "max", "max": "min", "any": "all", "all": "any", "ceil": "floor", "floor": "ceil"}


class Mutant(NamedTuple):
    """What was changed where, and the file with it."""

    line: int
    change: str
    source: str


def mutants(source: str) -> Iterator[Mutant]:
    """Every fault of the table, one at a time, in the order of the file."""
    tree = ast.parse(source)
    sites = [node for node in ast.walk(tree) if hasattr(node, "lineno") and not _of_types(node)]
    for at, node in sorted(enumerate(sites), key=lambda site: (site[1].lineno, site[1].col_offset)):
        for change in range(len(list(_faults(copy.deepcopy(node))))):
            whole = copy.deepcopy(tree)
            target = [n for n in ast.walk(whole) if hasattr(n, "lineno") and not _of_types(n)][at]
            before = ast.unparse(target)
            made = list(_faults(target))[change]
            _swap(whole, target, made)
            after = "(left out)" if isinstance(made, ast.Pass) else ast.unparse(made)
            changed = ast.unparse(ast.fix_missing_locations(whole))
            yield Mutant(node.lineno, f"{_short(before)} -> {_short(after)}", changed)


def _faults(node: ast.AST) -> Iterator[ast.AST]:
    """What may stand in a node's place."""
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        for table in (COMPARED, TURNED):
            if other := table.get(type(node.ops[0])):  # type: ignore[attr-defined]
                yield ast.Compare(node.left, [other()], node.comparators)
    elif isinstance(node, ast.BoolOp):
        yield ast.BoolOp(ast.And() if isinstance(node.op, ast.Or) else ast.Or(), node.values)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.Not, ast.USub)):
        yield node.operand
    elif isinstance(node, ast.BinOp) and type(node.op) in REPLACED:
        if not any(isinstance(x, (ast.JoinedStr, ast.Tuple, ast.List)) for x in (node.left, node.right)):
            yield ast.BinOp(node.left, REPLACED[type(node.op)](), node.right)
    elif isinstance(node, ast.Constant) and isinstance(node.value, (bool, int, float)):
        yield ast.Constant(not node.value if isinstance(node.value, bool) else _other(node.value))
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in CALLED:
        yield ast.Call(ast.Name(CALLED[node.func.id], ast.Load()), node.args, node.keywords)
    elif _can_go(node):
        yield ast.Pass()


def _can_go(node: ast.AST) -> bool:
    """A statement that changes something, or calls something, and gives nothing back."""
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], (ast.Attribute, ast.Subscript))
    return isinstance(node, ast.AugAssign) or (
        isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    )


def _other(value: float) -> float:
    """Another number of the same kind, far enough to matter."""
    return value + 1 if value in (0, 1) else 2 * value


def _of_types(node: ast.AST) -> bool:
    return isinstance(node, (ast.Import, ast.ImportFrom, ast.arg, ast.FormattedValue, ast.JoinedStr))


def _swap(tree: ast.AST, old: ast.AST, new: ast.AST) -> None:
    for parent in ast.walk(tree):
        for name, value in ast.iter_fields(parent):
            if value is old:
                setattr(parent, name, new)
                return
            if isinstance(value, list) and any(item is old for item in value):
                value[[item is old for item in value].index(True)] = new
                return


def _short(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= 60 else text[:57] + "..."
