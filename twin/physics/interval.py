"""An interval [lo, hi] that goes through the physics like a number and comes out enclosing every value it can
take.

Every operation widens its result by more than its rounding error, so the enclosure is a proof, not an
estimate; lo and hi may be arrays (many boxes at once; then the functions are those of the arrays' library).
Three forms that physics uses are recognised, because taking their parts apart loses too much: x*x (never
negative), min and max written with `where`, and x + sqrt(x*x + c) (`maths.positive`, increasing in x).
Source: Moore, Kearfott & Cloud (2009) Introduction to Interval Analysis, ch. 2 and 5.
"""

import math
from collections.abc import Callable
from functools import wraps
from math import pi
from typing import Any

from . import maths

INFINITY = float("inf")
ULP = 2.0**-52  # twice the rounding error of + - * / sqrt
LIBRARY = 1e-15  # sin, cos, exp, tanh, atan2, power of the C library and of numpy are good to 4 ulp
TINY = 5e-324


def _ours(operation: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    """An operation on intervals and numbers; what carries slopes answers for itself."""

    @wraps(operation)
    def operate(self: Any, other: Any) -> Any:
        return NotImplemented if hasattr(other, "slopes") else operation(self, other)

    return operate


class Interval:
    """All numbers from lo to hi; `square_of` = (x, c) when it was made as x*x + c, `root_of` when as sqrt(x*x
    + c).
    """

    __slots__ = ("hi", "lo", "root_of", "square_of")
    _maths = "twin.physics.interval"
    __array_ufunc__ = None  # array * Interval is ours to answer

    def __init__(self, lo: Any, hi: Any) -> None:
        self.lo, self.hi = lo, hi
        self.square_of: tuple[Interval, float] | None = None
        self.root_of: tuple[Interval, float] | None = None

    def __repr__(self) -> str:
        return f"Interval({self.lo}, {self.hi})"

    @property
    def magnitude(self) -> Any:
        """The greatest absolute value inside."""
        return _most(abs(self.lo), abs(self.hi))

    def __neg__(self) -> "Interval":
        return Interval(-self.hi, -self.lo)

    @_ours
    def __add__(self, other: Any) -> "Interval":
        o = of(other)
        for x, root in ((self, o), (o, self)):
            if root.root_of is not None and root.root_of[0] is x:
                return _with_its_root(x, root.root_of[1])
        total = _out(self.lo + o.lo, self.hi + o.hi)
        if self.square_of is not None and isinstance(other, float) and other >= 0.0:
            total.square_of = (self.square_of[0], self.square_of[1] + other)
        return total

    __radd__ = __add__

    @_ours
    def __sub__(self, other: Any) -> "Interval":
        o = of(other)
        return _out(self.lo - o.hi, self.hi - o.lo)

    @_ours
    def __rsub__(self, other: Any) -> "Interval":
        return -self + other

    @_ours
    def __mul__(self, other: Any) -> "Interval":
        if other is self:
            return self._squared()
        o = of(other)
        return _out(*_extremes(self.lo * o.lo, self.lo * o.hi, self.hi * o.lo, self.hi * o.hi))

    __rmul__ = __mul__

    @_ours
    def __truediv__(self, other: Any) -> "Interval":
        o = of(other)
        through_zero = (o.lo <= 0.0) & (o.hi >= 0.0)
        lo, hi = maths.where(through_zero, 1.0, o.lo), maths.where(through_zero, 1.0, o.hi)
        a, b = _extremes(self.lo / lo, self.lo / hi, self.hi / lo, self.hi / hi)
        return _out(maths.where(through_zero, -INFINITY, a), maths.where(through_zero, INFINITY, b))

    @_ours
    def __rtruediv__(self, other: Any) -> "Interval":
        return of(other) / self

    def __pow__(self, p: float) -> "Interval":
        """Whole powers of anything, other powers of what is not negative."""
        if p == 2:
            return self * self
        if p == int(p) and p < 0:
            return 1.0 / self**-p
        a, b = self.lo**p, self.hi**p
        if p == int(p) and p % 2 == 0:
            return _out(maths.where(self._holds_zero(), 0.0, _least(a, b)), _most(a, b), LIBRARY)
        return _out(_least(a, b), _most(a, b), LIBRARY)

    def __abs__(self) -> "Interval":
        a, b = abs(self.lo), abs(self.hi)
        return Interval(maths.where(self._holds_zero(), 0.0, _least(a, b)), _most(a, b))

    def _holds_zero(self) -> Any:
        return (self.lo <= 0.0) & (self.hi >= 0.0)

    @_ours
    def __lt__(self, other: Any) -> "Unsure":
        o = of(other)
        return Unsure(self.hi < o.lo, self.lo >= o.hi, less=self, more=other)

    @_ours
    def __le__(self, other: Any) -> "Unsure":
        o = of(other)
        return Unsure(self.hi <= o.lo, self.lo > o.hi, less=self, more=other)

    @_ours
    def __gt__(self, other: Any) -> "Unsure":
        o = of(other)
        return Unsure(self.lo > o.hi, self.hi <= o.lo, less=other, more=self)

    @_ours
    def __ge__(self, other: Any) -> "Unsure":
        o = of(other)
        return Unsure(self.lo >= o.hi, self.hi < o.lo, less=other, more=self)

    def _squared(self) -> "Interval":
        a = abs(self)
        square = _out(a.lo * a.lo, a.hi * a.hi)
        square.lo, square.square_of = _most(square.lo, 0.0), (self, 0.0)
        return square


class Unsure:
    """A comparison of intervals: surely true, surely false, or neither; and what was compared, for minimum
    and maximum.
    """

    __slots__ = ("less", "more", "no", "yes")
    _maths = "twin.physics.interval"

    def __init__(self, yes: Any, no: Any, less: Any = None, more: Any = None) -> None:
        self.yes, self.no, self.less, self.more = yes, no, less, more

    def __bool__(self) -> bool:
        raise TypeError("physics branched on a value: an effect uses maths.where, never `if`.")

    def __and__(self, other: "Unsure") -> "Unsure":
        return Unsure(self.yes & other.yes, self.no | other.no)

    def __or__(self, other: "Unsure") -> "Unsure":
        return Unsure(self.yes | other.yes, self.no & other.no)

    def __invert__(self) -> "Unsure":
        return Unsure(self.no, self.yes)


def of(x: Any) -> Interval:
    """A number as the interval of itself."""
    return x if isinstance(x, Interval) else Interval(x, x)


def hull(*parts: Any) -> Interval:
    """The smallest interval that holds all the others."""
    parts = tuple(map(of, parts))
    lo, hi = parts[0].lo, parts[0].hi
    for p in parts[1:]:
        lo, hi = _least(lo, p.lo), _most(hi, p.hi)
    return Interval(lo, hi)


def where(condition: Unsure, yes: Any, no: Any) -> Any:
    """`yes`, `no`, or, where the condition is not decided, all that lies between; min and max stay exact."""
    for side in (yes, no):
        if hasattr(side, "where"):
            return side.where(condition, yes, no)
    a, b = of(yes), of(no)
    if yes is condition.less and no is condition.more:
        return Interval(_least(a.lo, b.lo), _least(a.hi, b.hi))
    if yes is condition.more and no is condition.less:
        return Interval(_most(a.lo, b.lo), _most(a.hi, b.hi))
    both = hull(a, b)
    return Interval(
        maths.where(condition.yes, a.lo, maths.where(condition.no, b.lo, both.lo)),
        maths.where(condition.yes, a.hi, maths.where(condition.no, b.hi, both.hi)),
    )


def sqrt(x: Interval) -> Interval:
    """Encloses the root of all of x that is not negative."""
    root = _out(maths.sqrt(_most(x.lo, 0.0)), maths.sqrt(_most(x.hi, 0.0)))
    root.lo = _most(root.lo, 0.0)
    root.root_of = x.square_of
    return root


def exp(x: Interval) -> Interval:
    """Encloses e^x."""
    return _out(maths.exp(x.lo), maths.exp(x.hi), LIBRARY)


def tanh(x: Interval) -> Interval:
    """Encloses tanh x."""
    return _out(maths.tanh(x.lo), maths.tanh(x.hi), LIBRARY)


def cos(x: Interval) -> Interval:
    """Extremes at the ends, and at every multiple of pi inside."""
    x = _out(x.lo, x.hi, LIBRARY)  # so that a multiple of pi at the very end is not missed by rounding
    a, b = maths.cos(x.lo), maths.cos(x.hi)
    top, bottom = _multiple_inside(x.lo, x.hi), _multiple_inside(x.lo - pi, x.hi - pi)
    wide = _out(maths.where(bottom, -1.0, _least(a, b)), maths.where(top, 1.0, _most(a, b)), LIBRARY)
    return Interval(_most(wide.lo, -1.0), _least(wide.hi, 1.0))


def sin(x: Interval) -> Interval:
    """Encloses sin x [rad]."""
    return cos(x - 0.5 * pi)


def atan2(y: Any, x: Any) -> Interval:
    """Extremes at the corners; the whole circle when the box touches the origin or the cut behind it."""
    y, x = of(y), of(x)
    lo, hi = _extremes(*(maths.atan2(b, a) for a in (x.lo, x.hi) for b in (y.lo, y.hi)))
    cut = (x.lo <= 0.0) & y._holds_zero()
    return _out(maths.where(cut, -pi, lo), maths.where(cut, pi, hi), LIBRARY)


def _multiple_inside(lo: Any, hi: Any) -> Any:
    """True where a whole multiple of 2 pi lies between."""
    library = maths._library(lo, hi)
    return library.floor(hi / (2.0 * pi)) >= library.ceil(lo / (2.0 * pi))


def _with_its_root(x: Interval, c: float) -> Interval:
    """x + sqrt(x^2 + c), which increases with x and is never negative; its error is that of x, not of the
    small result.
    """
    lo, hi = (z + maths.sqrt(z * z + c) for z in (x.lo, x.hi))
    return Interval(_most(lo - 4.0 * ULP * (abs(x.lo) + c), 0.0), hi + 4.0 * ULP * (abs(x.hi) + c))


def _least(a: Any, b: Any) -> Any:
    library = maths._library(a, b)
    return min(a, b) if library is math else library.fmin(a, b)


def _most(a: Any, b: Any) -> Any:
    library = maths._library(a, b)
    return max(a, b) if library is math else library.fmax(a, b)


def _extremes(*corners: Any) -> tuple[Any, Any]:
    """Least and greatest of the corners; the NaN that 0 * inf leaves is passed over."""
    if maths._library(*corners) is math:
        real = [x for x in corners if x == x]
        return min(real), max(real)
    a, b, c, d = corners
    return _least(_least(a, b), _least(c, d)), _most(_most(a, b), _most(c, d))


def _out(lo: Any, hi: Any, relative: float = ULP) -> Interval:
    """Rounded outward by a relative error."""
    return Interval(lo - (abs(lo) * relative + TINY), hi + (abs(hi) * relative + TINY))
