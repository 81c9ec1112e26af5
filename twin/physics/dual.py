"""A number with its slopes: forward differentiation through the physics, for floats, arrays and intervals
alike.

    (a, a') (b, b') = (a b, a' b + a b'),   f(a, a') = (f(a), f'(a) a')

Over intervals it encloses every slope the function has in the box. The slope of a length sqrt(x^2 + y^2 + c)
is recognised: each x / sqrt(...) lies in [-1, 1], also where the box holds the point of rest. `abs` has the
slope [-1, 1] across zero. Source: Griewank & Walther (2008) Evaluating Derivatives, ch. 3; Moore, Kearfott &
Cloud (2009), ch. 6.
"""

from typing import Any

from . import maths
from .interval import Interval, Unsure, hull


class Dual:
    """A value and its slopes along chosen directions; a slope of 0.0 (the float) is known to be nothing and
    costs nothing.
    """

    __slots__ = ("slopes", "squares", "value")
    _maths = "twin.physics.dual"
    __array_ufunc__ = None

    def __init__(self, value: Any, slopes: tuple[Any, ...], squares: tuple["Dual", ...] = ()) -> None:
        self.value, self.slopes, self.squares = value, slopes, squares

    def __repr__(self) -> str:
        return f"Dual({self.value}, {self.slopes})"

    def __neg__(self) -> "Dual":
        return Dual(-self.value, tuple(_times(-1.0, s) for s in self.slopes))

    def __add__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            length = self.squares if isinstance(other, float) and other >= 0.0 else ()
            return Dual(self.value + other, self.slopes, length)
        squares = self.squares + other.squares if self.squares and other.squares else ()
        return Dual(self.value + other.value, _sum(self.slopes, other.slopes), squares)

    __radd__ = __add__

    def __sub__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return Dual(self.value - other, self.slopes)
        return Dual(self.value - other.value, _sum(self.slopes, (-other).slopes))

    def __rsub__(self, other: Any) -> "Dual":
        return -self + other

    def __mul__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return Dual(self.value * other, tuple(_times(s, other) for s in self.slopes))
        if other is self:
            return Dual(self.value * self.value, _chain(2.0 * self.value, self.slopes), (self,))
        return Dual(
            self.value * other.value,
            _sum(_chain(other.value, self.slopes), _chain(self.value, other.slopes)),
        )

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return Dual(self.value / other, tuple(_times(s, 1.0 / other) for s in self.slopes))
        ratio = self.value / other.value
        slopes = _sum(self.slopes, _chain(-ratio, other.slopes))
        return Dual(ratio, tuple(s if _nothing(s) else s / other.value for s in slopes))

    def __rtruediv__(self, other: Any) -> "Dual":
        ratio = other / self.value
        return Dual(ratio, _chain(-ratio / self.value, self.slopes))

    def __pow__(self, p: float) -> "Dual":
        if p == 2:
            return self * self
        return Dual(self.value**p, _chain(p * self.value ** (p - 1), self.slopes))

    def __abs__(self) -> "Dual":
        return Dual(abs(self.value), _chain(_sign(self.value), self.slopes))

    def __lt__(self, other: Any) -> "Choice":
        return Choice(self.value < _value(other), self, other)

    def __le__(self, other: Any) -> "Choice":
        return Choice(self.value <= _value(other), self, other)

    def __gt__(self, other: Any) -> "Choice":
        return Choice(self.value > _value(other), other, self)

    def __ge__(self, other: Any) -> "Choice":
        return Choice(self.value >= _value(other), other, self)

    @staticmethod
    def where(condition: Any, yes: Any, no: Any) -> "Dual":
        """`where`, for `maths` to find."""
        return where(condition, yes, no)


class Choice:
    """A comparison of duals: what their values say, and which they were (so that min and max keep their
    values exact).
    """

    __slots__ = ("less", "more", "said")
    _maths = "twin.physics.dual"

    def __init__(self, said: Any, less: Any, more: Any) -> None:
        self.said, self.less, self.more = said, less, more

    def __and__(self, other: Any) -> "Choice":
        return Choice(self.said & getattr(other, "said", other), None, None)

    __rand__ = __and__

    def __or__(self, other: Any) -> "Choice":
        return Choice(self.said | getattr(other, "said", other), None, None)

    __ror__ = __or__

    def __invert__(self) -> "Choice":
        return Choice(~self.said, None, None)


def where(condition: Any, yes: Any, no: Any) -> Dual:
    """Value and slopes of the side that holds; over intervals, of both sides where the condition is not
    decided.
    """
    said = getattr(condition, "said", condition)
    value = maths.where(said, _value(yes), _value(no))
    if isinstance(said, Unsure):  # the slopes differ from the values: min and max must not be taken of them
        said = Unsure(said.yes, said.no)
    count = len((yes if isinstance(yes, Dual) else no).slopes)
    pairs = zip(_slopes(yes, count), _slopes(no, count), strict=True)
    return Dual(
        value, tuple(0.0 if _nothing(a) and _nothing(b) else maths.where(said, a, b) for a, b in pairs)
    )


def sqrt(x: Dual) -> Dual:
    """Half the slope over the root; for a length each component's share of it lies in [-1, 1]."""
    root = maths.sqrt(x.value)
    if not x.squares:
        return Dual(root, _chain(0.5 / root, x.slopes))
    slopes = tuple(0.0 for _ in x.slopes)
    for part in x.squares:
        slopes = _sum(slopes, _chain(maths.clip(part.value / root, -1.0, 1.0), part.slopes))
    return Dual(root, slopes)


def sin(x: Dual) -> Dual:
    """sin x, and its slopes."""
    return Dual(maths.sin(x.value), _chain(maths.cos(x.value), x.slopes))


def cos(x: Dual) -> Dual:
    """cos x, and its slopes."""
    return Dual(maths.cos(x.value), _chain(-maths.sin(x.value), x.slopes))


def tanh(x: Dual) -> Dual:
    """tanh x, and its slopes."""
    y = maths.tanh(x.value)
    return Dual(y, _chain(1.0 - y * y, x.slopes))


def exp(x: Dual) -> Dual:
    """e^x, and its slopes."""
    y = maths.exp(x.value)
    return Dual(y, _chain(y, x.slopes))


def atan2(y: Any, x: Any) -> Dual:
    """The angle of (x, y) [rad], and its slopes; either may be a plain number."""
    a, b = _value(y), _value(x)
    count = len((y if isinstance(y, Dual) else x).slopes)
    square = a * a + b * b
    slopes = _sum(_chain(b / square, _slopes(y, count)), _chain(-(a / square), _slopes(x, count)))
    return Dual(maths.atan2(a, b), slopes)


def _value(x: Any) -> Any:
    return x.value if isinstance(x, Dual) else x


def _slopes(x: Any, count: int) -> tuple[Any, ...]:
    return x.slopes if isinstance(x, Dual) else (0.0,) * count


def _nothing(slope: Any) -> bool:
    return type(slope) is float and slope == 0.0


def _times(slope: Any, factor: Any) -> Any:
    return 0.0 if _nothing(slope) else slope * factor


def _chain(outer: Any, slopes: tuple[Any, ...]) -> tuple[Any, ...]:
    return tuple(
        0.0 if _nothing(s) else outer if type(s) is float and s == 1.0 else outer * s for s in slopes
    )


def _sum(a: tuple[Any, ...], b: tuple[Any, ...]) -> tuple[Any, ...]:
    return tuple(y if _nothing(x) else x if _nothing(y) else x + y for x, y in zip(a, b, strict=True))


def _sign(x: Any) -> Any:
    """The slope of |x|; of a box that only touches zero, that of its inside."""
    if not isinstance(x, Interval):
        return maths.where(x >= 0.0, 1.0, -1.0)
    left, right = maths.where(x.lo >= 0.0, 1.0, -1.0), maths.where(x.hi <= 0.0, -1.0, 1.0)
    return hull(left, right)
