"""The paper's LSTM: told the kinematics, 30 s to warm up, then free; trained by free runs on the same parts
as the hybrid."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from torch.optim.swa_utils import AveragedModel, get_ema_multi_avg_fn

from bench.paper.lab import LabCourse, grounded
from export.batches import STRIDE, shuffled
from export.data import TrainingLeg
from export.settings import TrainingSettings
from export.training_course import LEAST_VALIDATION

WARM, FREE, HIDDEN, BATCH = 12, 24, 64, 64  # steps of 2.5 s for KVLCC2: 30 s and 60 s
# in an epoch at least, as the hybrid has them: batches are smaller where there is less to learn from
STEPS = 30


class Lstm(torch.nn.Module):
    """(nu, controls, air) -> the change of nu in one step, all in deviations of the training data."""

    def __init__(self, mean: torch.Tensor, sd: torch.Tensor, jump: torch.Tensor):
        super().__init__()
        self.cell = torch.nn.LSTMCell(mean.numel(), HIDDEN)
        self.out = torch.nn.Linear(HIDDEN, 3)
        self.curve: list[float] = []  # validation loss by epoch
        for name, value in (("mean", mean), ("sd", sd), ("jump", jump)):
            self.register_buffer(name, value)

    def run(self, nu: torch.Tensor, psi: torch.Tensor, more: torch.Tensor, h: float) -> torch.Tensor:
        """(T, B, 4) psi, u, v, r after each free step.

        nu (WARM, B, 3) measured, psi (B,) at the end of it, more (WARM + T, B, 5): rudder, propeller, wind
        north and east, heading."""
        memory, kept, now = None, [], nu[0]
        for k in range(more.shape[0] - 1):
            now = nu[k] if k < WARM else now
            wind_n, wind_e = more[k, :, 2], more[k, :, 3]
            angle = more[k, :, 4] if k < WARM else psi
            air = (
                torch.stack(
                    [
                        wind_n * torch.cos(angle) + wind_e * torch.sin(angle),
                        wind_e * torch.cos(angle) - wind_n * torch.sin(angle),
                    ],
                    -1,
                )
                - now[:, :2]
            )
            x = torch.cat([now, more[k, :, :2], air], -1)
            memory = self.cell((x - self.mean) / self.sd, memory)
            after = now + self.jump * self.out(memory[0])
            if k >= WARM - 1:
                psi = psi + 0.5 * h * (now[:, 2] + after[:, 2])
                kept.append(torch.cat([psi[:, None], after], -1))
            now = after
        return torch.stack(kept)


def tensors(
    leg: TrainingLeg, starts: np.ndarray, free: int
) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor]:
    """nu, psi, inputs, wanted (T, B, 4); the free run begins at `starts`."""
    warm = starts + STRIDE * np.arange(1 - WARM, 1)[:, None]
    whole = starts + STRIDE * np.arange(1 - WARM, free + 1)[:, None]
    wind, to = (leg.inputs.get(n, np.zeros(len(leg))) for n in ("wind_speed", "wind_to"))
    more = np.stack(
        [leg.inputs["delta"], leg.inputs["n"], wind * np.cos(to), wind * np.sin(to), leg.state[:, 2]], -1
    )
    out = leg.state[warm][..., 3:], leg.state[starts, 2], more[whole], leg.state[whole[WARM:]][..., 2:]
    return tuple(torch.tensor(x, dtype=torch.float32) for x in out)  # type: ignore[return-value]


def _all(legs: Sequence[TrainingLeg]) -> tuple[torch.Tensor, ...]:
    parts = [tensors(leg, _late(leg), FREE) for leg in legs]
    return tuple(torch.cat(x, 1 if x[0].ndim > 1 else 0) for x in zip(*parts, strict=True))


def _late(leg: TrainingLeg) -> np.ndarray:
    k = leg.starts(STRIDE * FREE, 12)
    return k[k >= STRIDE * WARM]


def train(
    train_legs: Sequence[TrainingLeg],
    validation: Sequence[TrainingLeg],
    epochs: int,
    seed: int = 42,
    patience: int = 20,
    keep: Path | None = None,
) -> Lstm:
    """Adam at 3e-3, Huber of heading and speeds in deviations. Like the hybrid's, its weights are averaged,
    and the best on validation stay, or the last where few voyages validate. `keep`: a file of a finished
    training."""
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    data, held = _all(train_legs), _all(validation)
    state = torch.cat([torch.tensor(leg.state[:, 3:]) for leg in train_legs]).float()
    h = STRIDE * train_legs[0].h
    jump = (
        torch.cat([torch.tensor(leg.state[STRIDE:, 3:] - leg.state[:-STRIDE, 3:]) for leg in train_legs])
        .float()
        .std(0)
    )
    controls = torch.cat(
        [torch.tensor(np.stack([leg.inputs["delta"], leg.inputs["n"]], -1)) for leg in train_legs]
    ).float()
    air = torch.tensor([6.0, 6.0])
    model = Lstm(
        torch.cat([state.mean(0), controls.mean(0), torch.zeros(2)]),
        torch.cat([state.std(0), controls.std(0) + 1e-3, air]),
        jump,
    )
    size = torch.cat([torch.tensor([0.02]), state.std(0) * 0.2])
    optimiser = torch.optim.Adam(model.parameters(), lr=3e-3)
    if keep and keep.exists():
        kept = torch.load(keep, weights_only=True)
        model.load_state_dict(kept["network"])
        model.curve = kept["curve"]
        return model
    many = data[1].numel()
    batch = max(1, min(BATCH, many // STEPS))
    mean = AveragedModel(
        model,
        multi_avg_fn=get_ema_multi_avg_fn(
            1.0 - 1.0 / (1.0 + TrainingSettings.average * max(1, many // batch))
        ),
    )
    best, since, asked = (float("inf"), model.state_dict()), 0, len(validation) >= LEAST_VALIDATION
    for epoch in range(epochs):
        for k in shuffled(many, batch, 7919 * seed + epoch):
            loss = _loss(model, [x[..., k, :] if x.ndim > 1 else x[k] for x in data], h, size)
            optimiser.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(model.parameters(), 5.0)
            optimiser.step()
            mean.update_parameters(model)
        with torch.no_grad():
            value = float(_loss(mean.module, held, h, size))
        model.curve.append(value)
        best, since = (
            ((value, {n: x.clone() for n, x in mean.module.state_dict().items()}), 0)
            if value < best[0] or not asked
            else (best, since + 1)
        )
        if since >= patience:
            break
    model.load_state_dict(best[1])
    if keep:
        torch.save({"network": best[1], "curve": model.curve}, keep)
    return model


def _loss(model: Lstm, data: Sequence[torch.Tensor], h: float, size: torch.Tensor) -> torch.Tensor:
    nu, psi, more, wanted = data
    off = (model.run(nu, psi, more, h) - wanted) / size
    return torch.nn.functional.huber_loss(off, torch.zeros_like(off), delta=2.0)


def predict(model: Lstm, c: LabCourse) -> np.ndarray:
    """(T, W, 3) over ground."""
    view, h = c.water, STRIDE * c.water.h
    nu, psi, more, _ = tensors(view, c.starts, c.steps)
    with torch.no_grad():
        run = model.run(nu, psi, more, h).double().numpy()
    first = np.concatenate([view.state[c.starts][None, :, 2:], run])
    middle = 0.5 * (first[1:] + first[:-1])
    cos, sin = np.cos(middle[..., 0]), np.sin(middle[..., 0])
    north = np.cumsum((middle[..., 1] * cos - middle[..., 2] * sin) * h, 0)
    east = np.cumsum((middle[..., 1] * sin + middle[..., 2] * cos) * h, 0)
    return grounded(np.stack([north, east, run[..., 0]], -1), c, view)
