"""The hybrid that goes on learning: the law of twin/live/learning/adapt.py beside the filter, one for each
voyage, every grid step.

    f = w [W phi + g A q],
        |f| <= bound           q = [whitened components of phi | known forces of the row | 1]

What is learned up to the start of a window is held while the window is predicted.
"""

from collections.abc import Callable, Sequence
from copy import copy

import numpy as np
import torch

from bench.paper.filter import EAST, NORTH, PSI, Filter, Tuning, from_states
from bench.paper.lab import LabCourse
from export.residual_network import ResidualNetwork
from export.to_onnx import whitening
from export.training_loss import known
from twin.live.learning.adapt import LARGEST, Adaptation
from twin.live.learning.adapted_row import BESIDE, CORES
from twin.live.learning.filtered_regression import Evidence
from twin.live.learning.movable import Columns, movable
from twin.live.observer.dynamics import KnownDynamics
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import Force, Rates, Situation
from twin.study.track.track import READINGS

Law = Callable[[Ship, Force, int], Adaptation]
SPEEDS = [READINGS.index(n) for n in ("u", "v", "r")]


class Acting:
    """The learned force of many ships at once: trained, and what each has learned on board (`A`, gates
    included)."""

    def __init__(self, network: ResidualNetwork, model: Model, zeta: torch.Tensor):
        self.network, self.model = network, model
        with torch.no_grad():
            table = whitening(network.phi(zeta).numpy().astype(float))
        self.mean, self.rows = (torch.tensor(table[n], dtype=torch.float32) for n in ("mean", "components"))
        self.A = torch.zeros(1, 3, len(self.rows) + BESIDE)

    def holding(self, A: np.ndarray, model: Model | None = None) -> "Acting":
        """The same network with other learned numbers (B, 3, width), on another state of the model if one is
        given."""
        other = object.__new__(Acting)
        other.__dict__.update(
            self.__dict__, A=torch.tensor(A, dtype=torch.float32), model=model or self.model
        )
        return other

    def parts(self, s: Situation) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        """Of B ships: how far the network is believed (B, 1), W phi (B, 3) and the regressors of every row
        (B, 3, width)."""
        forces, S = self.model.forces(s, self.model.water(s)), self.network.S
        zeta = self.network.zeta(s)
        phi = self.network.phi(zeta)
        components = torch.clamp((phi - self.mean) @ self.rows.T, -3.0, 3.0)
        rows = []
        for r, core in enumerate(CORES):
            sizes = [forces[i][r] for i in core]
            rows.append(
                torch.cat(
                    [
                        components,
                        torch.stack([_sized(x, S[r], phi) for x in sizes] + [torch.ones(len(phi))], -1),
                    ],
                    -1,
                )
            )
        return self.network.weight(zeta).unsqueeze(-1), self.network.last(phi), torch.stack(rows, 1)

    def f(self, s: Situation) -> torch.Tensor:
        """(B, 3) in units of the force scale; B is a multiple of the ships, in turns."""
        w, trained, q = self.parts(s)
        f = w * (trained + (self.A.repeat(len(q) // len(self.A), 1, 1) * q).sum(-1))
        return f * torch.clamp(self.network.bound / (f.norm(dim=-1, keepdim=True) + 1e-9), max=1.0)

    def __call__(self, s: Situation) -> Force:
        f, S = self.f(s), self.network.S
        return Force(f[:, 0] * S.X, f[:, 1] * S.Y, f[:, 2] * S.N)


def _sized(force: torch.Tensor | float, size: float, like: torch.Tensor) -> torch.Tensor:
    return torch.clamp((torch.as_tensor(force) / size).float() + torch.zeros(len(like)), -LARGEST, LARGEST)


class Learning(Filter):
    """Filters whose ships learn; `frozen(k, i)` may say why voyage i must not learn at step k."""

    def __init__(
        self,
        courses: Sequence[LabCourse],
        model: Model,
        acting: Acting,
        tuning: Tuning,
        law: Law = Adaptation,
    ):
        self.acting = acting
        super().__init__(courses, model, lambda s: self.acting(s), [tuning] * len(courses))
        ship, S, components = model.ship, acting.network.S, len(acting.rows)
        self.laws = [law(ship, S, components) for _ in courses]
        self.evidence = [Evidence(ship, S) for _ in courses]
        self.physics = KnownDynamics(model)
        self.probes = [probe for m in movable(model.effects, ship) if (probe := Columns.probe(model, m))]
        self.last: tuple[torch.Tensor, ...] | None = None
        self.numbers: list[np.ndarray] = []  # after each step, (V, 3, width)

    def tick(self, k: int) -> None:
        super().tick(k)
        self._learn(k)
        A = np.array([law.numbers() for law in self.laws])
        self.numbers.append(A)
        self.acting = self.acting.holding(A)

    def _learn(self, k: int) -> None:
        seen = self._seen(k)
        middle = [0.5 * (a + b) for a, b in zip(self.last or seen, seen, strict=True)]
        self.last = seen
        rates, trained, shadow, q, forces, columns = (x.tolist() for x in middle)
        measured = self.through_water(k)
        for i, (law, evidence) in enumerate(zip(self.laws, self.evidence, strict=True)):
            nu = tuple(measured[i])
            if not np.isfinite(nu).all():
                evidence.pause()
                continue
            evidence.feed(
                nu,
                Rates(*rates[i]),
                tuple(shadow[i]),
                tuple(trained[i]),
                [*q[i], *forces[i], *columns[i]],
                self.physics,
                self.h,
            )
            wanted = tuple(d - t for d, t in zip(evidence.unexplained, evidence.trained, strict=True))
            law.learn(wanted, evidence.regressors, self.h, "" if evidence.ready else "has just begun")

    def through_water(self, k: int) -> np.ndarray:
        """(V, 3) speeds and rate of turn as measured, the current taken off."""
        c, s = np.cos(self.x[:, PSI]), np.sin(self.x[:, PSI])
        north, east = self.x[:, NORTH], self.x[:, EAST]
        return self.measured[k][:, SPEEDS] - np.column_stack(
            [north * c + east * s, east * c - north * s, 0.0 * c]
        )

    def _seen(self, k: int) -> tuple[torch.Tensor, ...]:
        """Of each voyage: accelerations by known forces, W phi, the whole learned force, components, known
        forces, and columns of the named effects' numbers."""
        x, y, psi, u, v, r = torch.tensor(self.x[:, :6].T, dtype=torch.float32)
        now = {n: torch.tensor(a[k], dtype=torch.float32) for n, a in self.inputs.items()}
        s = Situation(x, y, psi, u, v, r, **now)
        with torch.no_grad():
            forces = known(self.model, s).T
            rates = torch.stack(list(_accelerations(self.model, forces)), -1)
            w, trained, q = self.acting.parts(s)
            shadow = self.acting.f(s)
            columns = [self._column(*probe, s, rates, shadow) for probe in self.probes]
        many = q.shape[-1] - BESIDE
        sizes = q[:, :, many:-1].reshape(len(q), -1)
        return tuple(
            t.double()
            for t in (
                rates,
                w * trained,
                shadow,
                q[:, 0, :many],
                sizes,
                torch.cat([sizes[:, :0], *columns], -1),
            )
        )

    def _column(
        self, probe: Model, share: float, s: Situation, rates: torch.Tensor, shadow: torch.Tensor
    ) -> torch.Tensor:
        """(V, 3) as movable.Columns has it."""
        S = torch.tensor([float(x) for x in self.acting.network.S])
        learned = shadow * S
        before = rates + torch.stack(list(_accelerations(self.model, learned.T)), -1)
        after = torch.stack(list(_accelerations(probe, (known(probe, copy(s)) + learned).T)), -1)
        push = torch.stack(list(self.physics.force_for(*(after - before).unbind(-1))), -1)
        return push / S / share


def _accelerations(model: Model, forces: torch.Tensor) -> tuple[torch.Tensor, ...]:
    from twin.physics import core

    return tuple(core.accelerations(*forces, model.c))  # type: ignore[arg-type]


def predict(
    courses: Sequence[LabCourse], model: Model, acting: Acting, tuning: Tuning, law: Law = Adaptation
) -> list[np.ndarray]:
    """(T, W, 3) for each course: filtered and learning up to each start, then free with what was learned by
    then."""
    learning = Learning(courses, model, acting, tuning, law)
    states = learning.run(int(max(c.starts[-1] for c in courses)))
    numbers = np.stack(learning.numbers)
    held = np.concatenate([numbers[c.starts, i] for i, c in enumerate(courses)])
    return from_states(
        courses, model, acting.holding(held), [states[c.starts, i] for i, c in enumerate(courses)]
    )
