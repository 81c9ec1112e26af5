"""The few functions physics needs, for floats, arrays, tensors, symbols and intervals alike.

Each looks at its argument and calls the library that the argument came from, so that one file of physics
serves the loop, the study, the training and the certificate, and imports none of them."""

import math
import sys
from collections.abc import Iterable
from typing import Any

DEG = math.pi / 180.0  # one degree [rad]
RAD = 180.0 / math.pi  # one radian [deg]
_FLOATS = (float, int)


def _library(*values: Any) -> Any:
    """The module that owns the first value that is not a plain number."""
    for value in values:
        if type(value) not in _FLOATS:
            return sys.modules[
                type(value).__module__.partition(".")[0] if not hasattr(value, "_maths") else value._maths
            ]
    return math


def sin(x: Any) -> Any:
    """sin x [rad]."""
    return math.sin(x) if type(x) is float else _library(x).sin(x)


def cos(x: Any) -> Any:
    """cos x [rad]."""
    return math.cos(x) if type(x) is float else _library(x).cos(x)


def tanh(x: Any) -> Any:
    """tanh x."""
    return math.tanh(x) if type(x) is float else _library(x).tanh(x)


def exp(x: Any) -> Any:
    """e^x."""
    return math.exp(x) if type(x) is float else _library(x).exp(x)


def sqrt(x: Any) -> Any:
    """Square root; physics adds a floor under it wherever its argument can be zero (its gradient is infinite
    there)."""
    return math.sqrt(x) if type(x) is float else _library(x).sqrt(x)


def hypot(x: Any, y: Any, floor: float = 1e-9) -> Any:
    """sqrt(x^2 + y^2 + floor): a length whose gradient is finite at rest."""
    return sqrt(x * x + y * y + floor)


def atan2(y: Any, x: Any) -> Any:
    """The angle of (x, y) [rad], within -pi and pi."""
    library = _library(y, x)
    return library.atan2(y, x) if hasattr(library, "atan2") else library.arctan2(y, x)


def where(condition: Any, yes: Any, no: Any) -> Any:
    """`yes` where the condition holds, else `no`, element by element; both sides are evaluated, so both must
    be finite."""
    if isinstance(condition, bool):
        return yes if condition else no
    library = _library(condition)
    return (
        library.Piecewise((yes, condition), (no, True))
        if hasattr(library, "Piecewise")
        else library.where(condition, yes, no)
    )


def minimum(x: Any, y: Any) -> Any:
    """The smaller of both."""
    return where(x < y, x, y)


def maximum(x: Any, y: Any) -> Any:
    """The larger of both."""
    return where(x > y, x, y)


def clip(x: Any, low: Any, high: Any) -> Any:
    """x, within low and high."""
    return minimum(maximum(x, low), high)


def positive(x: Any, width: float = 1e-6) -> Any:
    """A smooth max(x, 0): differs from it by at most sqrt(width)/2, near zero."""
    return 0.5 * (x + sqrt(x * x + width))


def total(values: Iterable[Any]) -> Any:
    """The sum, strictly from left to right: the same bits on every machine and in every Python. (The built-in
    one carries a correction along since Python 3.12.)"""
    result = 0
    for x in values:
        result = result + x
    return result


def dot(a: Iterable[float], b: Iterable[float]) -> float:
    """The inner product, from left to right like `total`, as far as the shorter of the two goes."""
    result = 0.0
    for x, y in zip(a, b):  # noqa: B905 (the inner loop of the tick)
        result += x * y
    return result
