"""A drawing of lines over one axis, as an SVG that needs no script: the same on a screen and on paper."""

from collections.abc import Sequence
from html import escape
from itertools import pairwise
from math import ceil, floor, isfinite, log10
from typing import NamedTuple

import numpy as np

from twin.num import on_axis

WIDE, HIGH, LOW = 640, 260, 170  # of the drawing; its height where it is one of many [px]
LEFT, RIGHT, TOP, BOTTOM = 64, 26, 26, 40  # room for numbers and words around it [px]
BINS = 300  # of a line that has more points than a drawing shows
STEPS = 5  # marks on an axis, about


class Curve(NamedTuple):
    """One line. `colour`: a variable of the page's style, such as "--model"; `points`: (x, y)."""

    name: str
    colour: str
    points: Sequence[tuple[float, float]]


class Curves(NamedTuple):
    """One drawing: `x` and `y` are what its axes say, with their units; `log`: y by powers of ten, where all
    of it is positive; `even`: a metre is as long to the right as upwards; `high`: its height [px]."""

    caption: str
    x: str
    y: str
    lines: Sequence[Curve]
    log: bool = False
    even: bool = False
    high: int = HIGH


class Drawings(NamedTuple):
    """Many small drawings beside each other, each under its own caption."""

    caption: str
    each: Sequence[Curves]


class _Axis(NamedTuple):
    low: float
    high: float
    marks: Sequence[float]
    log: bool = False

    def share(self, value: float) -> float:
        """Where a value stands between the ends, 0 to 1."""
        if self.log:
            return log10(value / self.low) / log10(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


def drawn(curves: Curves) -> str:
    """The drawing; "" where there is nothing to draw."""
    lines = [(c, [p for p in c.points if isfinite(p[0]) and isfinite(p[1])]) for c in curves.lines]
    every = [p for _, points in lines for p in points]
    if not every:
        return ""
    log = curves.log and all(y > 0.0 for _, y in every)
    few = 2 if curves.high <= LOW else STEPS
    across = _axis([x for x, _ in every])
    up = _decades([y for _, y in every]) if log else _axis([y for _, y in every], few)
    wide, high = float(WIDE - LEFT - RIGHT), float(curves.high - TOP - BOTTOM)
    if curves.even:
        wide = min(wide, high * (across.high - across.low) / (up.high - up.low))
        high = wide * (up.high - up.low) / (across.high - across.low)

    def at(x: float, y: float) -> tuple[float, float]:
        return LEFT + wide * across.share(x), TOP + high * (1.0 - up.share(y))

    out = [*_grid(across, up, at, curves)]
    for curve, points in lines:
        path = " ".join("{:.1f},{:.1f}".format(*at(x, y)) for x, y in points)
        shape = f'fill="none" stroke="var({curve.colour})" stroke-width="2" stroke-linejoin="round"'
        out.append(f'<polyline points="{path}" {shape}/>')
    said = escape(f"{curves.caption}: {', '.join(c.name for c in curves.lines)} over {curves.x or 'time'}")
    tall = TOP + high + BOTTOM
    begin = (
        f'<svg class="bars" viewBox="0 0 {WIDE} {tall:.0f}" font-size="13" role="img" aria-label="{said}">'
    )
    return f"{begin}{''.join(out)}</svg>"


def thinned(x: np.ndarray, y: np.ndarray) -> list[tuple[float, float]]:
    """The line with at most 2 BINS points that looks the same: the least and the greatest of each bin. x (N,)
    [s] ascending, y (N,) in whatever unit it has; what is not finite is left out."""
    there = np.isfinite(y)
    x, y = x[there], y[there]
    if x.size <= 2 * BINS:
        return list(zip(x.tolist(), y.tolist(), strict=True))
    edges = np.linspace(0, x.size, BINS + 1).astype(int)
    keep = [a + k for a, b in pairwise(edges) for k in sorted({int(y[a:b].argmin()), int(y[a:b].argmax())})]
    return list(zip(x[keep].tolist(), y[keep].tolist(), strict=True))


def legend(curves: Curves) -> str:
    """Which colour is which line; "" where there is one."""
    if len(curves.lines) < 2:
        return ""
    marks = "".join(
        f'<span><i style="border-color:var({c.colour})"></i>{escape(c.name)}</span>' for c in curves.lines
    )
    return f'<div class="legend">{marks}</div>'


def _grid(across: _Axis, up: _Axis, at, curves: Curves) -> list[str]:  # type: ignore[no-untyped-def]
    (left, bottom), (right, top) = at(across.low, up.low), at(across.high, up.high)
    out = []
    for y, said in zip(up.marks, on_axis(up.marks), strict=True):
        h = at(across.low, y)[1]
        out.append(f'<path d="M{left:.1f} {h:.1f}H{right:.1f}" stroke="var(--line)"/>')
        out.append(_text(left - 7, h + 4, said, "end"))
    for x, said in zip(across.marks, on_axis(across.marks), strict=True):
        v = at(x, up.low)[0]
        out.append(f'<path d="M{v:.1f} {top:.1f}V{bottom:.1f}" stroke="var(--faint)"/>')
        out.append(_text(v, bottom + 17, said, "middle"))
    out.append(_text(right, bottom + 34, curves.x, "end"))
    out.append(_text(left, top - 10, curves.y, "start"))
    return out


def _text(x: float, y: float, words: str, anchor: str) -> str:
    if not words:
        return ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="var(--soft)">{escape(words)}</text>'


def _axis(values: Sequence[float], most: int = STEPS) -> _Axis:
    """Round marks, and ends at marks."""
    low, high = min(values), max(values)
    if high - low <= 1e-12 * max(abs(high), abs(low)):
        low, high = low - (abs(low) or 1.0), high + (abs(high) or 1.0)
    power = 10.0 ** floor(log10((high - low) / most))
    step = next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power * most >= high - low)
    first, last = floor(low / step + 1e-9), ceil(high / step - 1e-9)
    return _Axis(first * step, last * step, [k * step for k in range(first, last + 1)])


def _decades(values: Sequence[float]) -> _Axis:
    """Powers of ten around the values; 1, 2 and 5 of them where they are few."""
    low, high = floor(log10(min(values)) + 1e-9), ceil(log10(max(values)) - 1e-9)
    high = max(high, low + 1)
    if high - low > 2:
        return _Axis(10.0**low, 10.0**high, [10.0**k for k in range(low, high + 1)], True)
    marks = [m * 10.0**k for k in range(low, high + 1) for m in (1.0, 2.0, 5.0)]
    least = max([m for m in marks if m <= min(values) * (1.0 + 1e-9)], default=10.0**low)
    most = min([m for m in marks if m >= max(values) * (1.0 - 1e-9)], default=10.0**high)
    most = most if most > least else 10.0 * least
    return _Axis(least, most, [m for m in marks if least <= m <= most], True)
