"""Is the residual worth having? Free runs on the part that no training saw, physics alone beside physics and
residual."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from export.batches import TrainingWindows, input_names, windows
from export.data import TrainingLeg, check_stretches
from export.residual_network import ResidualNetwork
from export.training_loss import free_run
from twin.num import num
from twin.physics.model import Model
from twin.physics.state import Situation

LEADS_S = (10.0, 60.0, 120.0)  # at which the errors are told apart, as far as the horizon goes
LENGTHS = 3.0  # the horizon, in ship lengths sailed: 120 s for KVLCC2
RESAMPLES = 2000
RUNAWAY = 1e6


Pair = tuple[float, float]
NAMES = ("physics", "with_residual")


@dataclass(frozen=True)
class Worth:
    """Mean errors over the horizon without and with the residual, and the 95 % interval of the ratio of
    places; `leads`: the mean errors after so many seconds (s, [m] without and with, [deg] without and
    with)."""

    horizon_s: float
    windows: int
    blocks: int
    position_m: tuple[float, float]
    heading_deg: tuple[float, float]
    ratio_low95: float
    ratio_high95: float
    leads: tuple[tuple[float, Pair, Pair], ...] = ()

    @property
    def proved(self) -> bool:
        """The place is predicted better beyond chance, and the heading at most 2 % worse."""
        return self.ratio_high95 < 1.0 and self.heading_deg[1] <= 1.02 * self.heading_deg[0]

    def sentence(self) -> str:
        """The verdict in words, with its numbers."""
        (p, q), (a, b) = self.position_m, self.heading_deg
        said = "is worth having" if self.proved else "is not worth having"
        return (
            f"the residual {said}: over {self.horizon_s:.0f} s on {self.windows} held-out free runs the "
            f"place is off by {num(q, 3)} m with it, {num(p, 3)} m without (ratio {self.ratio_low95:.2f} to "
            f"{self.ratio_high95:.2f}), the heading by {num(b, 3)} deg, {num(a, 3)} deg without"
        )

    def as_json(self) -> dict[str, Any]:
        """The same for the JSON."""
        return {
            "horizon_s": self.horizon_s,
            "windows": self.windows,
            "blocks": self.blocks,
            "worth_having": self.proved,
            "position_mae_m": dict(zip(NAMES, self.position_m, strict=True)),
            "heading_mae_deg": dict(zip(NAMES, self.heading_deg, strict=True)),
            "position_ratio_95": [self.ratio_low95, self.ratio_high95],
            "by_horizon": [
                {
                    "horizon_s": s,
                    "position_m": dict(zip(NAMES, place, strict=True)),
                    "heading_deg": dict(zip(NAMES, heading, strict=True)),
                }
                for s, place, heading in self.leads
            ],
        }


def errors(network: ResidualNetwork | None, model: Model, w: TrainingWindows) -> np.ndarray:
    """(K, W, 2) position error [m] and heading error [deg] at each step along each free run."""
    with torch.no_grad():
        off = torch.nan_to_num(
            free_run(network, model, w.start, w.inputs, w.h) - w.wanted, nan=RUNAWAY
        ).clamp(-RUNAWAY, RUNAWAY)
    place, heading = off[..., :2].norm(dim=-1), torch.rad2deg(off[..., 2].abs())
    return torch.stack([place, heading], -1).double().numpy()


def worth(network: ResidualNetwork, model: Model, legs: Sequence[TrainingLeg], seed: int = 0) -> Worth:
    """The verdict on these legs; whole blocks are resampled, because neighbouring windows are not
    independent. DataError: they hold no free run."""
    length_s = float(model.ship.scale("time"))
    horizon = min(LENGTHS * length_s, 0.3 * max(len(leg) * leg.h for leg in legs))
    w = windows(legs, input_names(legs), horizon, 0.5 * length_s)
    check_stretches("test", len(w), horizon)
    course = errors(None, model, w), errors(network, model, w)
    before, after = (run.mean(0) for run in course)
    h, told = float(w.h.mean()), [s for s in LEADS_S if s <= horizon]
    told += [horizon] * all(horizon - s >= h for s in told)
    low, high = ratio(before[:, 0], after[:, 0], w.group, seed)
    return Worth(
        horizon,
        len(w),
        len(set(w.group.tolist())),
        (float(before[:, 0].mean()), float(after[:, 0].mean())),
        (float(before[:, 1].mean()), float(after[:, 1].mean())),
        low,
        high,
        tuple(_at(s, course, h) for s in told),
    )


def _at(lead_s: float, course: tuple[np.ndarray, np.ndarray], h: float) -> tuple[float, Pair, Pair]:
    """The mean errors `lead_s` after the start; both courses (K, W, 2) in steps of h [s], the first h after
    it."""
    k = min(max(round(lead_s / h) - 1, 0), len(course[0]) - 1)
    without, with_it = (run[k].mean(0) for run in course)
    place, heading = ((float(without[i]), float(with_it[i])) for i in (0, 1))
    return lead_s, place, heading


def ratio(before: np.ndarray, after: np.ndarray, group: np.ndarray, seed: int) -> tuple[float, float]:
    """The 95 % interval of mean(after)/mean(before) by the bootstrap over blocks. All (N,): errors of each
    run in one unit, and the block that it is of."""
    blocks, index = np.unique(group, return_inverse=True)
    a, b = (np.bincount(index, x, blocks.size) for x in (before, after))
    drawn = np.random.default_rng(seed).integers(blocks.size, size=(RESAMPLES, blocks.size))
    low, high = np.quantile(b[drawn].sum(1) / a[drawn].sum(1), (0.025, 0.975))
    return float(low), float(high)


def share(network: ResidualNetwork, model: Model, s: Situation) -> float:
    """How much of the force the network gives: the mean size of f over that of f and the known forces, in
    units of the force scale."""
    with torch.no_grad():
        known = [
            torch.stack([torch.as_tensor(x) + torch.zeros_like(s.u) for x in f], -1)
            for f in model.forces(s, model.water(s))
        ]
        scale = torch.tensor(network.S)
        f = network.f(network.zeta(s)).abs().sum(-1).mean()
        total = sum((k / scale).abs().sum(-1).mean() for k in known)
    return float(f / (f + total))
