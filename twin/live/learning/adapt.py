"""Slow learning on board: a few numbers on top of the trained last layer, kept small, unused when they do
not help; and the numbers of the named effects (`twin add`), inside their boxes.

    learned force_r = W_r phi + g a_r q_r
        q_r = [whitened components of phi | known forces of row r | 1]
    a_r = argmin  sum_k exp(-(t - t_k)/MEMORY) h (d_r - c_r x - a_r q_f)^2/(NOISE_S s_r^2) + |a_r/usual|^2

each row a ridge regression on fading evidence (filtered_regression.py): what nothing teaches fades back to
the trained weights. What usually changes are the known forces' sizes; features only fill in, else they
would explain the noise of ten minutes. x are the numbers of the named effects and c_r what they do
(effect_numbers.py): they explain first, and what the rows learned of the same force before is taken off
them as x moves. d_r is cut at three usual errors s_r from what is expected; A is projected on boxes and on
||A|| <= A_MAX. The gate g, one for all rows, opens as far as what the numbers of a while ago promised has
come true (skill.py).
"""

import json
from copy import copy, deepcopy
from math import isfinite, sqrt
from pathlib import Path
from typing import Any

from twin import whole
from twin.live.learning.adapted_row import BESIDE, COLUMNS, CORES, ROWS, SIZES, Parameter, Row
from twin.live.learning.effect_numbers import Named
from twin.live.learning.filtered_regression import Three
from twin.live.learning.ridge import HINDSIGHT, LARGEST, MEMORY, NOISE_S, SPREAD, deviations, factor, solve
from twin.live.learning.skill import Proof
from twin.live.observer.dynamics import Forces
from twin.physics.maths import dot, total
from twin.physics.ship import Ship
from twin.physics.state import Force

A_MAX = 1.0  # norm of all numbers together
BOX_COMPONENT, BOX_KNOWN, BOX_CONSTANT = 0.5, 0.3, 0.5
# how far a number is usually off: the prior's deviations
USUAL_COMPONENT, USUAL_KNOWN, USUAL_CONSTANT = 0.01, 0.2, 0.02
EXCITED = 0.02  # rms of the regressors' motion below which there is nothing to learn from


class Adaptation:
    """Learns from the unexplained force; `correction(regressors)` is what the rows add, in units of the force
    scale, and `named.effects` are the ship's effects with the numbers that act. `rows` False: no network, so
    the effects alone."""

    def __init__(self, ship: Ship, scale: Force, components: int, rows: bool = True):
        self.time_s = ship.L_pp / ship.U_0
        self.scale, self.components = scale, components
        self.width = components + BESIDE
        self.named = Named(ship, scale)
        self.frozen = "nothing measured yet"
        self.notes: list[str] = []  # what was wrong with saved numbers
        self.updates = 0
        self._boxes = [BOX_COMPONENT] * components + [BOX_KNOWN] * SIZES + [BOX_CONSTANT]
        self._usual = [USUAL_COMPONENT] * components + [USUAL_KNOWN] * SIZES + [USUAL_CONSTANT]
        self._prior = [u**-2 for u in self._usual]
        self._rows = [self._blank() for _ in ROWS] if rows else []
        self._proof = Proof()
        self._slow: list[float] = []
        self._excited = 0.0
        self._turn = 0
        self._since = [0.0, 0.0, 0.0]
        self._remembered: tuple[list[Row], Proof, Named] | None = None

    def regressors(self, components: list[float], forces: Forces) -> list[float]:
        """The whitened components, then for each row its known forces; `learn` wants those of the named
        effects' numbers after them."""
        sizes = []
        for r, (scale, core) in enumerate(zip(self.scale, CORES, strict=True)):
            sizes += [forces[i][r] / scale for i in core]
        return [
            *(components or [0.0] * self.components),
            *[-LARGEST if x < -LARGEST else LARGEST if x > LARGEST else x for x in sizes],
        ]

    def correction(self, regressors: list[float]) -> Three:
        """g A q, in units of the force scale."""
        gate, rows = self._proof.gate, enumerate(self._rows)
        return tuple([gate * dot(row.a, self._of_row(r, regressors)) for r, row in rows])  # type: ignore[return-value]

    def learn(self, wanted: Three, regressors: list[float], dt: float, frozen: str) -> None:
        """What is missing beside the ship file's model and the trained force (low-passed, like the
        regressors), the time since the last call, why not to learn, or ""."""
        self._watch(regressors, dt)
        self.frozen = frozen or (
            "" if self._excited > EXCITED else "waits for a manoeuvre: nothing moves that could teach it"
        )
        if self.frozen:
            self._since = [0.0, 0.0, 0.0]
            return
        self._since = [s + dt for s in self._since]
        self._turn = r = (self._turn + 1) % 3  # one row at a time keeps the tick short
        columns = regressors[self.components + 3 * SIZES + r :: 3] if self.named else []
        if columns:
            self.named.learn(r, wanted[r], columns, self._since[r] / self.time_s)
        if self._rows:
            self._update(r, wanted[r], self._of_row(r, regressors), columns)
        self._since[r] = 0.0

    def _of_row(self, r: int, regressors: list[float]) -> list[float]:
        """q of one row: the components, its known forces and effects, 1."""
        p = self.components
        return [*regressors[:p], *regressors[p + SIZES * r : p + SIZES * (r + 1)], 1.0]

    def _watch(self, regressors: list[float], dt: float) -> None:
        """How much the regressors move about their slow means."""
        a = min(dt / (3.0 * self.time_s), 0.5)
        self._slow = (
            [m + a * (x - m) for m, x in zip(self._slow, regressors, strict=True)]
            if self._slow
            else regressors
        )
        motion = total([(x - m) ** 2 for x, m in zip(regressors, self._slow, strict=True)])
        self._excited = sqrt(max(self._excited**2 + a * (motion - self._excited**2), 0.0))

    def _update(self, r: int, wanted: float, q: list[float], c: list[float]) -> None:
        row, h = self._rows[r], self._since[r] / self.time_s  # in L/U_0
        limit, named = 3.0 * sqrt(row.spread), dot(c, self.named.acting())
        error = min(max(wanted - named - dot(row.a, q), -limit), limit)
        if not (isfinite(error) and h > 0.0):
            return
        self.updates += 1
        row.spread += min(h / SPREAD, 0.2) * (error * error + 1e-5 - row.spread)
        self._proof.weigh(r, wanted - named, dot(row.then, q), row.spread, h)
        self._keep(row, h)
        self._fit(row, q, error, h)
        if c:
            self._fit_beside(row, q, c, named, h)
        self._project(row)

    def _keep(self, row: Row, h: float) -> None:
        """The numbers of now, for a while later: today's were fitted to what they would be asked about."""
        row.age += h
        if row.age > HINDSIGHT:
            row.then, row.next, row.age = row.next, list(row.a), 0.0
            row.sigma = deviations(row.L)

    def _fit(self, row: Row, q: list[float], error: float, h: float) -> None:
        """The ridge regression on evidence that fades over MEMORY."""
        keep, weight = 1.0 - min(h / MEMORY, 0.5), h / (NOISE_S * row.spread)
        y = weight * (dot(row.a, q) + error)
        row.I = [
            [keep * i + wx * x for i, x in zip(line, q)]  # noqa: B905 (the inner loop of the tick)
            for line, wx in zip(row.I, [weight * x for x in q], strict=True)
        ]
        row.b = [keep * b + y * x for b, x in zip(row.b, q, strict=True)]
        row.L = factor(row.I, self._prior)
        row.a = solve(row.L, row.b)

    def _fit_beside(self, row: Row, q: list[float], c: list[float], named: float, h: float) -> None:
        """The same with the named effects' part in the evidence, and taken off as it is known now."""
        keep, weight, x = 1.0 - min(h / MEMORY, 0.5), h / (NOISE_S * row.spread), self.named.acting()
        row.b = [b + weight * named * y for b, y in zip(row.b, q, strict=True)]
        row.B = [
            [keep * b + weight * z * y for b, y in zip(line, q, strict=True)]
            for line, z in zip(row.B, c, strict=True)
        ]
        row.a = solve(
            row.L,
            [b - total([z * line[i] for z, line in zip(x, row.B, strict=True)]) for i, b in enumerate(row.b)],
        )

    def _project(self, row: Row) -> None:
        """On the boxes, then on the ball of all three rows."""
        inside = [min(max(x, -b), b) if isfinite(x) else 0.0 for x, b in zip(row.a, self._boxes, strict=True)]
        row.a = inside
        norm = sqrt(total(dot(other.a, other.a) for other in self._rows))
        if norm > A_MAX:
            for other in self._rows:
                other.a = [x * A_MAX / norm for x in other.a]

    def remember(self) -> None:
        """What is known now, in case the lessons to come turn out to be none."""
        self._remembered = [copy(row) for row in self._rows], deepcopy(self._proof), self.named.held()

    def take_back(self) -> None:
        """As it was when last remembered; nothing where that was taken back already."""
        if self._remembered:
            self._rows, self._proof, self.named = self._remembered
            self._remembered = None

    def held(self) -> "Adaptation":
        """A copy whose rows do not learn on; it is only asked for corrections."""
        other = copy(self)
        other._rows, other._proof = deepcopy(self._rows), copy(self._proof)
        return other

    def numbers(self) -> list[list[float]]:
        """g a of each row: what acts."""
        return [[self._proof.gate * x for x in row.a] for row in self._rows]

    @property
    def open(self) -> bool:
        """Whether anything of what was learned acts."""
        return self._proof.gate > 0.0

    def norm(self) -> float:
        """Euclidean norm of all adapted numbers."""
        return sqrt(total(dot(row.a, row.a) for row in self._rows))

    def parameters(self) -> list[Parameter]:
        """All numbers with their bounds and status."""
        out, pressed = [], self.norm() > 0.999 * A_MAX
        for r, row in enumerate(self._rows):
            names = [*(f"feature {i + 1}" for i in range(self.components)), *COLUMNS[r], "constant"]
            for name, value, box, sigma, usual in zip(
                names, row.a, self._boxes, row.sigma, self._usual, strict=True
            ):
                known = sigma < 0.7 * usual and self._proof.gate > 0.3
                status = (
                    "invalid" if pressed or abs(value) >= box else "estimated" if known else "unestimated"
                )
                out.append(Parameter(f"{ROWS[r]} {name}", value, -box, box, sigma, "-", status))
        return out + self._of_effects()

    def _of_effects(self) -> list[Parameter]:
        """The numbers of the named effects, each in its own unit."""
        out, named = [], self.named
        for m, value, sigma in zip(named.numbers, named.values(), named.sigma, strict=True):
            pressed, known = value != m.start and not m.low < value < m.high, sigma < 0.7 and named.gate > 0.3
            status = "invalid" if pressed else "estimated" if known else "unestimated"
            out.append(Parameter(m.label, value, m.low, m.high, sigma * m.sd, m.unit, status))
        return out

    def saved(self, mark: str) -> str:
        """The numbers as a text to keep; `mark` names ship and network they belong to."""
        effects = dict(zip([m.label for m in self.named.numbers], self.named.values(), strict=True))
        return json.dumps(
            {"mark": mark, "rows": [{"a": row.a} for row in self._rows]}
            | ({"effects": effects} if effects else {})
        )

    def restore(self, path: str | Path, mark: str) -> None:
        """Read the numbers back, clamped; what cannot be used is left out, and `notes` says why."""
        try:
            table = json.loads(whole.read(path, 1_000_000))
            if table["mark"] != mark:
                self.notes.append(f"{path}: learned for another ship or network, left out")
                return
            self._restore(table["rows"])
            if self.named:
                self.named.begin(table["effects"])
        except FileNotFoundError:
            return
        except (OSError, ValueError, KeyError, TypeError, OverflowError, RecursionError) as error:
            self.notes.append(f"{path}: cannot be used ({type(error).__name__}), learning begins anew")

    def _restore(self, rows: list[Any]) -> None:
        fresh = []
        for entry, box in zip(rows, (self._boxes,) * len(self._rows), strict=True):
            values = [float(x) for x in entry["a"]]
            if len(values) != self.width or not all(map(isfinite, values)):
                raise ValueError("numbers that are not finite or too many")
            fresh.append([min(max(x, -b), b) for x, b in zip(values, box, strict=True)])
        for row, values in zip(self._rows, fresh, strict=True):
            row.a = values  # the gate stays shut: old numbers must prove themselves again
            self._project(row)
            row.b = [x * p for x, p in zip(row.a, self._prior, strict=True)]
            row.then, row.next = list(row.a), list(row.a)

    def _blank(self) -> Row:
        n = self.width
        blank = [[0.0] * n for _ in range(n)]
        beside = [[0.0] * n for _ in self.named.numbers]
        return Row(
            [0.0] * n,
            blank,
            [0.0] * n,
            factor(blank, self._prior),
            list(self._usual),
            [0.0] * n,
            [0.0] * n,
            beside,
        )
