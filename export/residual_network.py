"""The residual network of Table 1: four layers of 64, swish, and a last layer W kept apart; believed only
where it was trained.

    x = (clip(zeta, low, high) - offset)/scale,   phi = trunk(x),   f = weight W phi,  |f| <= bound,
        force = S f

`weight` falls to zero outside [low, high], as in twin/live/learning/residual.py, which must say the same of
the exported file."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import torch

from export.data import TrainingLeg
from twin.live.learning.learned_force import scale_of
from twin.live.learning.residual import MARGIN
from twin.physics.effects.wind import Wind
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import Force, Situation
from twin.physics.zeta import inputs

LAYERS, WIDTH = 4, 64
CALM = ("surge", "sway", "yaw", "rudder", "propeller")
AIR = ("air_ahead", "air_starboard")


class ResidualNetwork(torch.nn.Module):
    """zeta -> f; called with a Situation of tensors it gives the force in newtons."""

    # of each input: mean, spread, and the range in which the network is believed; the most that it may say
    offset: torch.Tensor
    scale: torch.Tensor
    low: torch.Tensor
    high: torch.Tensor
    bound: torch.Tensor

    def __init__(self, ship: Ship, names: Sequence[str], zeta: np.ndarray):
        super().__init__()
        self.ship, self.names, self.S = ship, tuple(names), scale_of(ship)
        sizes = [len(self.names)] + [WIDTH] * LAYERS
        self.layers = torch.nn.ModuleList(torch.nn.Linear(a, b) for a, b in pairwise(sizes))
        self.last = torch.nn.Linear(WIDTH, 3, bias=False)
        for layer in (*self.linear_layers(), self.last):
            torch.nn.init.xavier_uniform_(layer.weight)
        for layer in self.linear_layers():
            torch.nn.init.zeros_(layer.bias)
        low, high = zeta.min(0), zeta.max(0)
        wide = np.maximum(high - low, 0.05)  # what hardly varied in the data
        for name, value in (
            ("offset", zeta.mean(0)),
            ("scale", zeta.std(0) + 0.1 * wide),
            ("low", low - 0.02 * wide),
            ("high", high + 0.02 * wide),
            ("bound", np.float32(np.inf)),
        ):
            self.register_buffer(name, torch.tensor(value, dtype=torch.float32))

    def linear_layers(self) -> list[torch.nn.Linear]:
        """The trunk's layers, the first one first."""
        return [layer for layer in self.layers if isinstance(layer, torch.nn.Linear)]

    def trunk(self, x: torch.Tensor) -> torch.Tensor:
        """(..., inputs), scaled -> phi (..., 64)."""
        for layer in self.layers:
            z = layer(x)
            x = z * torch.sigmoid(z)
        return x

    def phi(self, zeta: torch.Tensor) -> torch.Tensor:
        """(..., 64) of zeta (..., inputs), kept within the range of the data and scaled."""
        return self.trunk((torch.clamp(zeta, self.low, self.high) - self.offset) / self.scale)

    def weight(self, zeta: torch.Tensor) -> torch.Tensor:
        """(...) how far zeta may be believed."""
        outside = torch.relu(torch.maximum(self.low - zeta, zeta - self.high)) / (self.high - self.low)
        return (torch.relu(1.0 - outside / MARGIN) ** 2).prod(-1)

    def f(self, zeta: torch.Tensor) -> torch.Tensor:
        """(..., 3) in units of the force scale."""
        f = self.last(self.phi(zeta)) * self.weight(zeta).unsqueeze(-1)
        if not torch.isfinite(self.bound):
            return f
        return f * torch.clamp(self.bound / (f.norm(dim=-1, keepdim=True) + 1e-9), max=1.0)

    def zeta(self, s: Situation) -> torch.Tensor:
        """(..., inputs); speeds through water of s must be set."""
        values = torch.broadcast_tensors(*inputs(self.names, s, self.ship))
        return torch.stack(values, -1)

    def forward(self, s: Situation) -> Force:
        """The learned force [N, N, N m]."""
        f = self.f(self.zeta(s))
        return Force(f[..., 0] * self.S.X, f[..., 1] * self.S.Y, f[..., 2] * self.S.N)

    def bind(self, zeta: torch.Tensor) -> None:
        """Set the output bound to what the data need, with a fifth to spare."""
        self.bound.fill_(float("inf"))
        with torch.no_grad():
            self.bound.fill_(1.2 * float(torch.quantile(self.f(zeta).norm(dim=-1), 0.999)) + 1e-3)


def names_for(legs: Sequence[TrainingLeg], model: Model) -> tuple[str, ...]:
    """Which inputs the voyages can feed: its motion and controls; the air too where every voyage measured it,
    unless the wind has its name in the model already (few voyages would teach the network their weathers by
    heart)."""
    measured = all("wind_speed" in leg.inputs for leg in legs)
    named = any(isinstance(effect, Wind) for effect in model.effects)
    return CALM + AIR if measured and not named else CALM
