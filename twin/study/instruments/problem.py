"""One voyage as a batch problem in continuous time: a smooth path, a slow stream and a wandering wind, and
what each instrument says of them.

The path (north, east, heading) is a cubic B-spline, so that a reading may be compared at any time, its
latency included [Furgale, Rehder & Siegwart (2013) Unified temporal and spatial calibration for multi-sensor
systems, IROS]. Priors, each with a size that the data choose: third derivative of the path, steps of stream
and wind, and the ship's speed aside through the water, which follows its rate of turn and is else a scatter
about nothing."""

from copy import copy
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.sparse import csr_array

from twin.study.instruments.instrument_samples import PER_MOTION, Readings, ReadingSamples
from twin.study.instruments.spline import Spline, Weights
from twin.study.instruments.unknowns import widths

MARGIN_S = 5.0  # the path goes on so long before and behind the readings, for what is late
STREAM_S = 60.0  # between two numbers of the stream, at least
WIND_S = 20.0  # and of the wind
TAIL = 6.0  # time constants of a smoothing that are integrated; what is older counts at its mean age


def _memory() -> tuple[np.ndarray, np.ndarray]:
    """Ages (in time constants) and weights by which int exp(-q) f(q) dq is a sum (Gauss-Legendre, and one
    point for the tail)."""
    x, w = np.polynomial.legendre.leggauss(9)
    q = 0.5 * TAIL * (x + 1.0)
    ages, shares = np.r_[q, TAIL + 1.0], np.r_[0.5 * TAIL * w * np.exp(-q), np.exp(-TAIL)]
    return ages, shares / shares.sum()


NODES, SHARES = _memory()
OUTLIER = 5.0  # scatters
MOST_MEMORY = 0.95
MOST_KNOTS = 2000.0  # of a voyage's path
KNOTS = 16.0  # of the path in the time in which the rate of turn changes


class Rows:
    """Rows of a sparse matrix, gathered piece by piece."""

    def __init__(self) -> None:
        # first row -> columns (n, m) and what stands there (n, m), of each piece that begins there
        self.pieces: dict[int, list[tuple[np.ndarray, np.ndarray]]] = {}

    def add(self, first_row: int, columns: np.ndarray, w: Weights, factor: np.ndarray | float = 1.0) -> None:
        """From `first_row` on, n rows, as many as any other piece that begins there: weights w, (n,) and
        (n, m), of the coefficients whose columns (K,) these are, times a factor for each row (n,) or one for
        all."""
        first, share = w
        n, m = share.shape
        self.pieces.setdefault(first_row, []).append(
            (
                columns[first[:, None] + np.arange(m)],
                share * np.broadcast_to(np.asarray(factor, float), n)[:, None],
            )
        )

    def matrix(self, size: int) -> Any:
        """All that was added, as a sparse matrix (N, S) of S = `size` columns, by rows; what fell on one
        place adds up."""
        beside = [tuple(map(np.hstack, zip(*here, strict=True))) for _, here in sorted(self.pieces.items())]
        lengths = np.concatenate([np.full(*column.shape) for column, _ in beside])
        column, value = (
            np.concatenate([part.ravel() for part in parts]) for parts in zip(*beside, strict=True)
        )
        out = csr_array((value, column, np.r_[0, lengths.cumsum()]), shape=(lengths.size, size))
        out.sum_duplicates()
        return out


def _to_earth(y: np.ndarray, psi: np.ndarray) -> np.ndarray:
    """(N, 2) to the north and east, of what is ahead and to starboard (N, 2) at these headings (N,) [rad]."""
    c, s = np.cos(psi), np.sin(psi)
    return np.column_stack([y[:, 0] * c - y[:, 1] * s, y[:, 0] * s + y[:, 1] * c])


def _differences(columns: np.ndarray, weights: np.ndarray) -> Rows:
    """These weights (m,) times each m coefficients in a row, of every direction: `columns` (K, d)."""
    n = columns.shape[0] - weights.size + 1
    rows, each = Rows(), (np.arange(n), np.broadcast_to(weights, (n, weights.size)))
    for j, column in enumerate(columns.T):
        rows.add(j * n, column, each)
    return rows


@dataclass
class Problem:
    """A voyage's readings, its states as they are now, and the scatter of each kind of reading and prior."""

    readings: Readings
    length: float
    own: bool
    by: dict[str, ReadingSamples] = field(init=False)
    sd: dict[str, float] = field(init=False, default_factory=dict)
    # how many readings in a row err together
    lasts: dict[str, float] = field(init=False, default_factory=dict)
    # share of what drift does beside its formula that is there a grid step later
    memory: float = field(init=False, default=0.5)
    beside: np.ndarray = field(init=False, repr=False)  # and that itself, as last worked out [m/s]

    # of each prior: what a unit of each state (S) does to its rows, wherever the states are
    priors: dict[str, Any] = field(init=False, repr=False)
    # the path at the times of the readings, while the states stay where they are (here.py)
    met: dict[Any, Any] | None = field(init=False, default=None, repr=False)

    def __post_init__(self) -> None:
        read = self.readings
        start, end = read.span
        width = read.time / PER_MOTION
        self.by = {
            k: s.thinned(width) for k, s in read.by.items() if k not in ("velocity", "heading at velocity")
        }
        if "velocity" in read.by:
            self.by["velocity"] = self._velocity(read).thinned(width)
        h = max(
            read.time / KNOTS, (end - start) / MOST_KNOTS, float(np.median(np.diff(self.by["heading"].t)))
        )
        slow = max(STREAM_S, 4.0 * read.time)
        self.path = Spline.over(start - MARGIN_S, end + MARGIN_S, h)
        self.stream = Spline.over(start, end, slow, 1)
        self.wind = Spline.over(start, end, max(WIND_S, read.time), 1) if "wind" in self.by else None
        self.grid = np.arange(start, end, max(read.time / 3.0, 2.0 * h, 0.3 * self.length / read.speed))
        self._columns()
        self.priors = self._priors()
        self._begin()

    def _velocity(self, read: Readings) -> ReadingSamples:
        s = read.by["velocity"]
        if self.own:
            return s
        return ReadingSamples(s.t, _to_earth(s.y, read.by["heading at velocity"].y[:, 0]))

    def _columns(self) -> None:
        """Every state's column: the path's, knot by knot, then the few of stream and wind."""
        grids = [(self.path, 3), (self.stream, 2), *([(self.wind, 2)] if self.wind else [])]
        ends = np.cumsum([s.size * d for s, d in grids])
        self.at = [
            part.reshape(-1, d)
            for part, (_, d) in zip(np.split(np.arange(ends[-1]), ends[:-1]), grids, strict=True)
        ]
        self.size, self.fast = int(ends[-1]), int(ends[0])

    def _priors(self) -> dict[str, Any]:
        """Third slopes of the path, steps of stream and wind; the stream does not walk in the middle of the
        voyage."""
        third, step = np.array([-1.0, 3.0, -3.0, 1.0]) / self.path.h**3, np.array([-1.0, 1.0])
        rows = {
            "jerk": _differences(self.at[0][:, :2], third),
            "twist": _differences(self.at[0][:, 2:], third),
            "stream": _differences(self.at[1], step),
            "tie": _differences(self.at[1][self.stream.size // 2][None], np.ones(1)),
        }
        if self.wind is not None:
            rows["air"] = _differences(self.at[2], step)
        return {name: own.matrix(self.size) for name, own in rows.items()}

    def _begin(self) -> None:
        """States near the readings, and a first guess of every scatter."""
        read, x = self.readings, np.zeros(self.size)
        heading, t = self.by["heading"], self.path.times
        inside = np.clip(t, *read.span)
        x[self.at[0][:, 2]] = np.interp(inside, heading.t, heading.y[:, 0])
        place = (self.by["place"].t, self.by["place"].y) if "place" in self.by else self._reckoned()
        for j in (0, 1):
            x[self.at[0][:, j]] = (
                np.interp(inside, place[0], place[1][:, j])
                + (t - inside) * np.gradient(place[1][:, j], place[0])[np.where(t < inside, 0, -1)]
            )
        if self.wind is not None:
            wind = self.by["wind"]
            comes_from = _to_earth(wind.y, np.interp(wind.t, heading.t, heading.y[:, 0]))
            x[self.at[2]] = -comes_from.mean(0) + np.array(
                [np.gradient(p, place[0]).mean() for p in place[1].T]
            )
        self.x = x
        U, T = read.speed, read.time
        first = {
            "place": 1.0,
            "velocity": 0.05 * U,
            "heading": 0.005,
            "rate": 0.1 / T,
            "log": 0.05 * U,
            "log aside": 0.05 * U,
            "wind": 1.0,
        }
        self.sd = {k: v for k, v in first.items() if k in self.by}
        self.sd |= {
            "drift": 0.05 * U,
            # far above what a path has: from there they come down in a few rounds, from below in a hundred
            "jerk": 3.0 * U / T**2,
            "twist": 10.0 / T**3,
            "stream": 0.003 * U,
            "tie": 1e-4 * U,
        }
        self.sd |= {"air": 0.1 * U} if self.wind is not None else {}
        self.usual = {"stream": 0.003 * U, "drift": 0.02 * U}
        self.least = {k: 1e-4 * v for k, v in self.sd.items()} | {
            "stream": 5e-4 * U,
            "drift": 1e-2 * U,
            "heading": 5e-5,
            "rate": 1e-4 / T,
        }
        self.least |= {"twist": 3e-3 / T**3, "jerk": 1e-2 * U / T**2}
        self.widths = widths(U, self.length, T)

    def as_it_is(self) -> "Problem":
        """The same voyage with the path and the scatters as they are now, which then go their own way."""
        other = copy(self)
        other.sd, other.lasts = dict(self.sd), dict(self.lasts)
        return other

    def worth(self) -> dict[str, float]:
        """Each scatter as large as the readings' own errors, that err together, make it."""
        return {name: sd * float(np.sqrt(self.lasts.get(name, 1.0))) for name, sd in self.sd.items()}

    def remember(self) -> None:
        """`memory` as what drift does beside its formula shows it."""
        x = self.beside
        share = float(x[1:] @ x[:-1]) / max(float(x @ x), 1e-12)
        self.memory = float(np.clip(share, 0.0, MOST_MEMORY))

    def _reckoned(self) -> tuple[np.ndarray, np.ndarray]:
        v = self.by["velocity"]
        y = v.y
        if self.own:
            y = _to_earth(y, np.interp(v.t, self.by["heading"].t, self.by["heading"].y[:, 0]))
        steps = np.diff(v.t)[:, None] * 0.5 * (y[1:] + y[:-1])
        return v.t, np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])

    @property
    def tied(self) -> bool:
        """Whether velocity in the receiver's own axes, or a log of two, ties compass and gyro to the place.
        Else only how the ship drifts in a turn would, and an age told by that is no instrument's business."""
        return self.own or "log aside" in self.by

    def coefficients(self) -> tuple[np.ndarray, np.ndarray]:
        """(K, 3) of the path, north and east [m] and heading [rad]; (M, 2) of how the stream, toward north
        and east, differs from that in the middle of the voyage [m/s]."""
        return self.x[self.at[0]], self.x[self.at[1]]
