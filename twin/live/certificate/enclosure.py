"""How steep the equations of motion can be: sure bounds of d(nu_dot)/d(u, v, r, psi) over a whole operating
set.

The set is cut into boxes, each box goes through the physics once as dual numbers over intervals, and the hull
of what comes out holds every slope and every acceleration in the set, not only those at sampled points.
Forces that share inputs are summed box by box; forces that do not (wind and rudder) are summed as ranges,
which is sure, and a little wide. A current is no box: seen from the water it only turns with the heading, r x
nu_c, and adds itself to the wind.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from twin.live.learning.movable import Movable, moved
from twin.physics import core
from twin.physics.dual import Dual
from twin.physics.effect import Effect
from twin.physics.interval import Interval, hull, of
from twin.physics.maths import total
from twin.physics.model import CORE, Model
from twin.physics.state import Situation

Ranges = Mapping[str, tuple[float, float]]
NU, STATES = ("u", "v", "r"), ("u", "v", "r", "psi")
WIDTH = 1 + len(STATES)  # a rate and its slopes
PIECES = {
    "u": 8, "v": 6, "r": 6, "delta": 6, "n": 6, "psi": 4, "wind_to": 8, "wind_speed": 2, "wave_to": 8,
    "H_s": 2, "T_p": 2, "bank_port": 3, "bank_starboard": 3, "phi": 2,
}  # fmt: skip
# What is cut together. A force belongs to the first line that names an input it needs; the core to the first.
GROUPS = (
    ("delta", "n"),
    ("psi", "wind_to", "wind_speed"),
    ("psi", "wave_to", "H_s", "T_p"),
    ("bank_port", "bank_starboard"),
    ("phi",),
)


@dataclass(frozen=True)
class Slopes:
    """Bounds over the set, SI: d(nu_dot_i)/d(u, v, r, psi)_j lies in [lo, hi][i][j], nu_dot_i itself in
    rate[i] = (least, greatest).
    """

    lo: tuple[tuple[float, ...], ...]
    hi: tuple[tuple[float, ...], ...]
    rate: tuple[tuple[float, float], ...]
    boxes: int
    # how far nu_dot can be from the ship file's, for the numbers that adaptation moves
    moved: tuple[float, ...] = (0.0, 0.0, 0.0)

    @property
    def most(self) -> tuple[float, ...]:
        """The greatest |nu_dot|."""
        return tuple(max(-a, b) for a, b in self.rate)

    @classmethod
    def of(cls, lo: list[float], hi: list[float], boxes: int, numbers: Sequence[Movable] = ()) -> "Slopes":
        """From rows of (value, four slopes, and one for each number that moves) for each of the three
        rates."""
        k = WIDTH + len(numbers)
        rows = [tuple(tuple(x[k * i + 1 : k * i + WIDTH]) for i in range(3)) for x in (lo, hi)]
        steep = [
            [
                max(-a, b)
                for a, b in zip(lo[k * i + WIDTH : k * i + k], hi[k * i + WIDTH : k * i + k], strict=True)
            ]
            for i in range(3)
        ]
        far = [max(m.high - m.start, m.start - m.low) for m in numbers]
        moved = tuple(total(a * b for a, b in zip(row, far, strict=True)) for row in steep)
        return cls(rows[0], rows[1], tuple((lo[k * i], hi[k * i]) for i in range(3)), boxes, moved)


def slopes(
    model: Model, ranges: Ranges, pieces: Mapping[str, int] = PIECES, numbers: Sequence[Movable] = ()
) -> Slopes:
    """Sure bounds of the slopes of the known physics (the learned residual is an input, not a slope).

    They hold as well while effects are switched off for want of an input, and wherever in their boxes
    `numbers` of the effects are."""
    k = WIDTH + len(numbers)
    found, boxes = _by_motion(model, ranges, pieces, numbers)
    total = _with_the_stream(found, ranges, k)
    lo, hi = [float(np.min(t.lo)) for t in total], [float(np.max(t.hi)) for t in total]
    return Slopes.of(lo, hi, boxes, numbers)


def slopes_by_cell(
    model: Model, ranges: Ranges, pieces: Mapping[str, int] = PIECES, numbers: Sequence[Movable] = ()
) -> tuple[tuple[np.ndarray, ...], np.ndarray, np.ndarray, tuple[float, ...]]:
    """The same in each cell of motions, without a current: edges of the cells along u, v, r in SI, each (n,)
    with n one more than its pieces; lo, hi (3, 5, N) of nu_dot [m/s2, m/s2, rad/s2] and of its slopes with
    (u, v, r, psi), N the cells, r runs fastest; `moved` all over them."""
    k = WIDTH + len(numbers)
    found, boxes = _by_motion(model, ranges, pieces, numbers)
    edges = tuple(_edges(*ranges[name], pieces.get(name, 1)) for name in NU)
    cells = int(np.prod([len(e) - 1 for e in edges]))
    lo = np.array([np.broadcast_to(of(x).lo, cells) for x in found]).reshape(3, k, cells)
    hi = np.array([np.broadcast_to(of(x).hi, cells) for x in found]).reshape(3, k, cells)
    least, most = lo.min(axis=2).ravel().tolist(), hi.max(axis=2).ravel().tolist()
    return edges, lo[:, :WIDTH], hi[:, :WIDTH], Slopes.of(least, most, boxes, numbers).moved


def _by_motion(
    model: Model, ranges: Ranges, pieces: Mapping[str, int], numbers: Sequence[Movable]
) -> tuple[list[Any], int]:
    """Rates and slopes (3 k) in each cell of motions, whatever the inputs, without a current; and of how many
    boxes."""
    model, ranges = _seen_from_the_water(model, ranges)
    model = anywhere(model, numbers)
    k = WIDTH + len(numbers)
    total: list[Any] = [0.0] * (3 * k)
    boxes = 0
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for group in GROUPS:
            names = _forces(model, group)
            if not names:
                continue
            s = boxed(ranges, group, pieces, len(numbers))
            parts = _flat(contribution(model, s, names), k)
            boxes += max(np.broadcast(of(p).lo).size for p in parts)
            parts = [Interval(np.min(p.lo, axis=1), np.max(p.hi, axis=1)) for p in map(_two_axes, parts)]
            total = [
                a + (p if group is GROUPS[0] else hull(p, 0.0)) for a, p in zip(total, parts, strict=True)
            ]
    return total, boxes


def anywhere(model: Model, numbers: Sequence[Movable]) -> Model:
    """The model whose effects' numbers are anywhere in their boxes, each with slope one along its own
    direction."""
    count = len(numbers)
    values = [
        Dual(Interval(m.low, m.high), tuple(1.0 if i == j else 0.0 for i in range(-len(STATES), count)))
        for j, m in enumerate(numbers)
    ]
    return Model(model.ship, moved(model.effects, numbers, values)) if numbers else model


def sampled(model: Model, ranges: Ranges, count: int = 20000, seed: int = 0) -> Slopes:
    """The same from random points and corners: what the sure bounds are compared with, never what is
    certified.
    """
    model, ranges = _seen_from_the_water(model, ranges)
    s = situation_of(points_of(ranges, count, seed))
    names = frozenset(name for group in GROUPS for name in _forces(model, group))
    parts = [np.broadcast_to(p, count) for p in _flat(contribution(model, s, names))]
    lo, hi = [float(p.min()) for p in parts], [float(p.max()) for p in parts]
    return Slopes.of(lo, hi, count)


def points_of(ranges: Ranges, count: int, seed: int) -> dict[str, np.ndarray]:
    """Each (N,), N the count, in the unit of its range: random points of the set; half of each coordinate
    lies on its ends."""
    rng = np.random.default_rng(seed)
    at = {}
    for name, (lo, hi) in ranges.items():
        share, corner = rng.random(count), rng.random(count) < 0.5
        at[name] = lo + (hi - lo) * np.where(corner, np.round(share), share)
    return at


def boxed(ranges: Ranges, group: tuple[str, ...], pieces: Mapping[str, int], more: int = 0) -> Situation:
    """The operating set as boxes: motions along the first axis, the inputs of one group along the second.
    `more`: directions of slopes beside the states."""
    axes = tuple(_cut(NU, ranges, pieces)), tuple(_cut(group, ranges, pieces))
    values = {name: Interval(lo, hi) for name, (lo, hi) in ranges.items()}
    values |= {name: Interval(lo[:, None], hi[:, None]) for name, lo, hi in axes[0]}
    values |= {name: Interval(lo[None, :], hi[None, :]) for name, lo, hi in axes[1]}
    return situation_of(values, more)


def contribution(model: Model, s: Situation, names: frozenset[str]) -> tuple[Any, Any, Any]:
    """What the named forces add to nu_dot; with the hull goes the turning of the water (Model.nu_dot)."""
    water = model.water(s)
    X = Y = N = 0.0
    for name, (x, y, n) in zip(model.names, model.forces(s, water), strict=True):
        if name in names:
            X, Y, N = X + x, Y + y, N + n
    u_dot, v_dot, r_dot = core.accelerations(X, Y, N, model.c, (water.k_m, water.k_j))
    if "hull" in names:
        u_dot, v_dot = u_dot + s.r * water.v, v_dot - s.r * water.u
    return u_dot, v_dot, r_dot


def _seen_from_the_water(model: Model, ranges: Ranges) -> tuple[Model, Ranges]:
    """The model without its currents, and a wind that may have the current on top."""
    calm = Model(model.ship, tuple(e for e in model.effects if not getattr(e, "stream", False)))
    lo, hi = ranges["wind_speed"]
    stream = ranges["stream"][1]
    return calm, {**ranges, "wind_speed": (max(lo - stream, 0.0), hi + stream)}


def _with_the_stream(total: list[Any], ranges: Ranges, k: int = WIDTH) -> list[Any]:
    """What a current adds: r x nu_c to the rates, itself to their slope with r, and with the heading what
    turning nu_c does.
    """
    c, r = ranges["stream"][1], max(abs(x) for x in ranges["r"])
    for i in range(3):
        value, by_u, by_v, by_r, by_psi = total[k * i : k * i + WIDTH]
        own = c if i < 2 else 0.0
        turned = c * (float(np.max(of(by_u).magnitude)) + float(np.max(of(by_v).magnitude))) + r * own
        total[k * i : k * i + WIDTH] = [
            value + _either_way(r * own),
            by_u,
            by_v,
            by_r + _either_way(own),
            by_psi + _either_way(turned),
        ]
    return total


def _either_way(x: float) -> Interval:
    return Interval(-x, x)


def situation_of(values: Mapping[str, Any], more: int = 0) -> Situation:
    """The situation at these values, each with its slope; the stream is no part of it."""
    return Situation(**{name: _seed(name, x, more) for name, x in values.items() if name != "stream"})


def _forces(model: Model, group: tuple[str, ...]) -> frozenset[str]:
    own = {type(e).__name__ for e in model.pushes if _group(e) == group}
    return frozenset(own.union(CORE) if group is GROUPS[0] else own)


def _group(effect: Effect) -> tuple[str, ...]:
    return next((g for g in GROUPS if set(g).intersection(effect.needs)), GROUPS[0])


def _seed(name: str, value: Any, more: int) -> Dual:
    """The value, with slope one along its own direction when it is one of the states."""
    return Dual(value, (*(1.0 if name == state else 0.0 for state in STATES), *(0.0,) * more))


def _cut(
    names: tuple[str, ...], ranges: Ranges, pieces: Mapping[str, int]
) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """(name, lo, hi) of every box of the grid over these names, flattened."""
    names = tuple(n for n in names if n in ranges)
    edges = [_edges(*ranges[n], pieces.get(n, 1)) for n in names]
    for i, name in enumerate(names):
        shape = [1] * len(names)
        shape[i] = -1
        size = [len(e) - 1 for e in edges]
        lo, hi = (np.broadcast_to(e.reshape(shape), size).ravel() for e in (edges[i][:-1], edges[i][1:]))
        yield name, lo, hi


def _edges(lo: float, hi: float, pieces: int) -> np.ndarray:
    """Equal steps; equal ratios where the range is positive (a speed counts by its logarithm)."""
    return np.geomspace(lo, hi, pieces + 1) if lo > 0.0 else np.linspace(lo, hi, pieces + 1)


def _flat(rates: tuple[Any, Any, Any], k: int = WIDTH) -> list[Any]:
    """Value and slopes of each of the three rates, in one row of 3 k."""
    row = []
    for rate in rates:
        row += [rate.value, *rate.slopes] if isinstance(rate, Dual) else [rate] + [0.0] * (k - 1)
    return [of(x) if not isinstance(x, (float, np.ndarray)) else x for x in row]


def _two_axes(x: Any) -> Interval:
    x = of(x)
    lo, hi = np.atleast_2d(x.lo), np.atleast_2d(x.hi)
    return Interval(lo, hi)
