"""Legs as tensors: single samples for losses of one moment, windows for roll-outs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch

from export.data import TrainingLeg
from export.residual_network import ResidualNetwork
from export.training_loss import Inputs, left_over, span
from twin.live.learning.learned_force import scale_of
from twin.physics.model import Model
from twin.physics.state import Situation

STRIDE = 2  # grid steps in one step of a roll-out: a sixteenth of the time the ship takes to sail its length
STATE = ("x", "y", "psi", "u", "v", "r")
BLOCKS = 1000  # numbers of blocks kept for each voyage


@dataclass(frozen=True)
class TrainingSamples:
    """Single moments (N, ...): `d` is what physics leaves, `columns` the core's forces, both in units of the
    force scale; `voyage` (N,) is where each comes from."""

    fields: Inputs
    ahead: torch.Tensor  # (N, 3) speeds one grid step later
    h: torch.Tensor
    d: torch.Tensor
    columns: torch.Tensor
    voyage: torch.Tensor

    def __len__(self) -> int:
        return self.h.numel()

    def situation(self, k: torch.Tensor | slice) -> Situation:
        """The situations of the samples k."""
        return Situation(**{name: x[k] for name, x in self.fields.items()})

    def on(self, device: torch.device) -> "TrainingSamples":
        """The same where they are computed with; indices stay with the processor."""
        fields = {name: x.to(device) for name, x in self.fields.items()}
        rest = {name: getattr(self, name).to(device) for name in ("ahead", "h", "d", "columns")}
        return replace(self, fields=fields, **rest)


@dataclass(frozen=True)
class TrainingWindows:
    """Free runs side by side: start (W, 6), inputs (T + 1, W), wanted (T, W, 6); `group` (W,) is the block
    each comes from."""

    start: torch.Tensor
    inputs: Inputs
    wanted: torch.Tensor
    h: torch.Tensor
    group: np.ndarray

    def __len__(self) -> int:
        return self.h.numel()

    @property
    def voyage(self) -> torch.Tensor:
        """(W,) where each comes from."""
        return torch.tensor(self.group // BLOCKS)

    def on(self, device: torch.device) -> "TrainingWindows":
        """The same where they are computed with; indices stay with the processor."""
        inputs = {name: x.to(device) for name, x in self.inputs.items()}
        return TrainingWindows(
            self.start.to(device), inputs, self.wanted.to(device), self.h.to(device), self.group
        )

    def some(self, k: torch.Tensor) -> "TrainingWindows":
        """The windows k alone."""
        inputs = {name: x[:, k] for name, x in self.inputs.items()}
        return TrainingWindows(self.start[k], inputs, self.wanted[:, k], self.h[k], self.group[k.numpy()])


def samples(legs: Sequence[TrainingLeg], model: Model, names: Sequence[str]) -> TrainingSamples:
    """Every grid step with known controls and a step after it."""
    kept = [(leg, leg.starts(1, 1)) for leg in legs]
    fields = (
        {
            name: _tensor([leg.state[k, i] - (leg.state[k, i] if i < 2 else 0.0) for leg, k in kept])
            for i, name in enumerate(STATE)
        }
        | {name: _tensor([leg.inputs[name][k] for leg, k in kept]) for name in names}
        | {"t": _tensor([leg.t[k] for leg, k in kept])}
    )
    rate = torch.tensor(np.concatenate([leg.rate[k] for leg, k in kept]))
    exact = Situation(**fields)
    scale = torch.tensor(scale_of(model.ship), dtype=torch.float64)
    d, columns = left_over(model, exact, rate, scale), span(model, exact) / scale[:, None]
    ahead = torch.tensor(np.concatenate([leg.state[k + 1, 3:] for leg, k in kept]))
    h = _tensor([np.full(k.size, leg.h) for leg, k in kept])
    fields |= {"u_r": exact.u_r, "v_r": exact.v_r}
    voyage = torch.tensor(np.concatenate([np.full(k.size, i) for i, (_, k) in enumerate(kept)]))
    return TrainingSamples(
        {n: x.float() for n, x in fields.items()},
        ahead.float(),
        h.float(),
        d.float(),
        columns.float(),
        voyage,
    )


def windows(
    legs: Sequence[TrainingLeg],
    names: Sequence[str],
    horizon_s: float,
    stride_s: float,
    block_s: float = 300.0,
) -> TrainingWindows:
    """Free runs of `horizon_s` that begin every `stride_s`."""
    starts, wanted, h, group = [], [], [], []
    inputs: dict[str, list[np.ndarray]] = {name: [] for name in (*names, "t")}
    for i, leg in enumerate(legs):
        steps = max(1, round(horizon_s / (STRIDE * leg.h)))
        k = leg.starts(STRIDE * steps, max(1, round(stride_s / leg.h)))
        at = k + STRIDE * np.arange(steps + 1)[:, None]
        state = leg.state[at] - np.where(np.arange(6) < 2, leg.state[k], 0.0)
        starts.append(state[0])
        wanted.append(state[1:])
        h.append(np.full(k.size, STRIDE * leg.h))
        group.append(BLOCKS * i + (leg.t[k] // block_s).astype(int))
        for name in names:
            inputs[name].append(leg.inputs[name][at])
        inputs["t"].append(leg.t[at])
    return TrainingWindows(
        _tensor(starts).float(),
        {n: torch.tensor(np.concatenate(x, 1)).float() for n, x in inputs.items()},
        torch.tensor(np.concatenate(wanted, 1)).float(),
        _tensor(h).float(),
        np.concatenate(group),
    )


def input_names(legs: Sequence[TrainingLeg]) -> tuple[str, ...]:
    """Controls and the weather that every leg knows."""
    return tuple(sorted(set.intersection(*(set(leg.inputs) for leg in legs))))


def zeta_of(network: ResidualNetwork, data: TrainingSamples) -> torch.Tensor:
    """(N, inputs) the network's inputs at all samples."""
    return network.zeta(Situation(**data.fields))


def shuffled(count: int, batch: int, seed: int) -> Iterator[torch.Tensor]:
    """Batches of indices in an order that depends on the seed alone; a last batch of less than half is left
    out."""
    order = torch.randperm(count, generator=torch.Generator().manual_seed(seed))
    for part in order.split(batch):
        if part.numel() >= min(batch, count) / 2:
            yield part


def _tensor(parts: Sequence[np.ndarray]) -> torch.Tensor:
    return torch.tensor(np.concatenate(parts))
