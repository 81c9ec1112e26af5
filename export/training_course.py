"""The course of a training, stage by stage and epoch by epoch; resumable, and the same for the same seed."""

import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import asdict
from math import cos, pi
from pathlib import Path
from typing import Any

import torch
from torch.optim.swa_utils import AveragedModel, get_ema_multi_avg_fn

from export import training_loss
from export.batches import shuffled, zeta_of
from export.residual_network import ResidualNetwork
from export.settings import STAGES, Progress, Set, TrainingSettings
from twin.physics.model import Model

DECAY_EPOCHS = 10
MAX_VALIDATED = 4096  # windows or moments that a validation looks at
EVEN = 10.0
# in an epoch of single moments at least: where there is less to learn from, batches are smaller, not the
# steps fewer
STEPS = 50
# validation voyages from which they may say when to stop; fewer are not like the rest, and all epochs are
# gone through
LEAST_VALIDATION = 5


class TrainingCourse:
    """One training: its network, the average of its weights over the last epochs, its optimiser, and where it
    stands."""

    def __init__(
        self,
        network: ResidualNetwork,
        model: Model,
        settings: TrainingSettings,
        data: dict[str, Set],
        progress: Progress,
        keep: Path | None,
    ):
        self.network, self.model, self.settings, self.data, self.progress, self.keep = (
            network,
            model,
            settings,
            data,
            progress,
            keep,
        )
        self.curve: list[tuple[str, int, float, float]] = []
        self.diagnostics: dict[str, float] = {}
        self.zeta = {part: zeta_of(network, s.samples) for part, s in data.items()}
        self.size = data["train"].samples.d.std(0)
        first = data["train"].samples
        nu = torch.stack([first.fields[n] for n in "uvr"], -1)
        self.jump = (first.ahead - nu).std(0)
        self.key = _key(settings, data)
        self.kept = self._kept()
        self.best = float("inf")
        self.asked = int(data["validation"].samples.voyage.max()) + 1 >= LEAST_VALIDATION
        self.weight = torch.ones(1)  # of each training voyage, while a stage runs

    def run(self, stage: str) -> None:
        """All epochs of a stage; of the averaged weights those of the best validation loss stay, or the last
        where it says too little."""
        c = self.settings
        epochs = c.rollout_epochs if stage == "rollout" else c.epochs
        rate = c.rollout_rate if stage == "rollout" else c.rate
        self.optimiser = torch.optim.Adam(self.network.parameters(), lr=rate, weight_decay=c.l2)
        self.mean = AveragedModel(
            self.network,
            multi_avg_fn=get_ema_multi_avg_fn(1.0 - 1.0 / (1.0 + c.average * self._batches(stage))),
        )
        best, since, first = (self._copy(), self.validation(stage)), 0, 0
        if self.kept and self.kept["stage"] == stage:
            best, since, first = self._resume()
        elif self.kept and stage in self.kept["done"]:
            return
        for epoch in range(first, epochs):
            if since >= c.patience and self.asked:
                break
            for group in self.optimiser.param_groups:
                group["lr"] = rate * (
                    0.5 + 0.5 * cos(pi * epoch / epochs)
                    if stage == "rollout"
                    else c.decay ** (epoch // DECAY_EPOCHS)
                )
            value = self._epoch(stage, epoch)
            validation = self.validation(stage)
            self.curve.append((stage, epoch, value, validation))
            self.progress(stage, epoch + 1, epochs, value, validation)
            best, since = (
                ((self._copy(), validation), 0)
                if validation < best[1] or not self.asked
                else (best, since + 1)
            )
            self._save(stage, epoch + 1, best, since)
        self.network.load_state_dict(best[0])
        self.best = best[1]

    def _epoch(self, stage: str, epoch: int) -> float:
        total, count = 0.0, 0
        self.weight = self._weights(stage)
        for value in self._losses(stage, 100_003 * self.settings.seed + epoch):
            self.optimiser.zero_grad()
            value.backward()
            torch.nn.utils.clip_grad_norm_(self.network.parameters(), 10.0)
            self.optimiser.step()
            self.mean.update_parameters(self.network)
            total, count = total + float(value.detach()), count + 1
        return total / max(count, 1)

    def _losses(self, stage: str, seed: int) -> Iterator[torch.Tensor]:
        """The loss of every batch of an epoch."""
        part = self.data["train"]
        for k in shuffled(*self._amount(stage), seed):
            value = self._loss(stage, "train", k)
            yield value + self._penalty(
                torch.randint(
                    len(part.samples), (self.settings.batch,), generator=torch.Generator().manual_seed(seed)
                )
            )

    def _amount(self, stage: str) -> tuple[int, int]:
        """What there is to learn from, and how much of it at once."""
        part, c = self.data["train"], self.settings
        if stage == "rollout":
            return len(part.windows), c.rollout_batch
        return len(part.samples), max(1, min(c.batch, len(part.samples) // STEPS))

    def _batches(self, stage: str) -> int:
        many, batch = self._amount(stage)
        return max(1, many // batch)

    def _loss(self, stage: str, part: str, k: torch.Tensor) -> torch.Tensor:
        """The loss of a batch; in training each voyage counts by its weight."""
        if stage == "paper":
            return self._literal(self.network, part, k)
        each = self._each(self.network, stage, part, k)
        return (self.weight[self._voyage(stage, part)[k]].to(each.device) * each).mean()

    def _each(self, network: ResidualNetwork, stage: str, part: str, k: torch.Tensor) -> torch.Tensor:
        """(B,) the loss of each window or moment."""
        data = self.data[part]
        if stage == "rollout":
            w = data.windows.some(k)
            return training_loss.rollout(network, self.model, w.start, w.inputs, w.wanted, w.h)
        return training_loss.acceleration(network, self.zeta[part][k], data.samples.d[k], self.size)

    def _literal(self, network: ResidualNetwork, part: str, k: torch.Tensor) -> torch.Tensor:
        one, c = self.data[part].samples, self.settings
        value, self.diagnostics = training_loss.paper(
            network,
            self.model,
            one.situation(k),
            one.ahead[k],
            one.h[k],
            self.jump,
            c.lambda_data,
            c.lambda_phys,
        )
        return value

    def _voyage(self, stage: str, part: str) -> torch.Tensor:
        return self.data[part].windows.voyage if stage == "rollout" else self.data[part].samples.voyage

    def _by_voyage(self, network: ResidualNetwork, stage: str, part: str) -> torch.Tensor:
        """The mean loss of every voyage of a part (over at most MAX_VALIDATED windows or moments)."""
        voyage = self._voyage(stage, part)
        k = torch.arange(0, voyage.numel(), max(1, voyage.numel() // MAX_VALIDATED))
        with torch.no_grad():
            each = torch.cat([self._each(network, stage, part, some) for some in k.split(1024)]).cpu()
        total = torch.zeros(int(voyage.max()) + 1).index_add(0, voyage[k], each)
        return total / torch.bincount(voyage[k], minlength=total.numel()).clamp(min=1)

    def _weights(self, stage: str) -> torch.Tensor:
        """The gradient of the geometric mean of the voyages' losses: a voyage in heavy sea, whose errors are
        mostly waves, counts no more than a calm one. No weight is more than EVEN times another."""
        if stage == "paper":
            return torch.ones(1)
        scatter = self._by_voyage(self.network, stage, "train")
        inverse = scatter.clamp(min=1e-12).pow(-1.0)
        inverse = inverse.clamp(max=EVEN * float(inverse.min()))
        return inverse / inverse.mean()

    def _penalty(self, k: torch.Tensor) -> torch.Tensor:
        c, zeta, total = self.settings, self.zeta["train"][k], torch.zeros(())
        if c.orthogonality:
            f, columns = self.network.f(zeta) / self.size, self.data["train"].samples.columns
            total = total + c.orthogonality * training_loss.orthogonal(f, columns[k])
        if c.mirror:
            total = total + c.mirror * training_loss.mirror(self.network, zeta)
        return total

    def validation(self, stage: str) -> float:
        """The loss of the averaged weights on the validation part: the geometric mean over its voyages."""
        network = self._averaged()
        if stage == "paper":
            many = len(self.data["validation"].samples)
            return float(
                self._literal(
                    network, "validation", torch.arange(0, many, max(1, many // MAX_VALIDATED))
                ).detach()
            )
        return float(self._by_voyage(network, stage, "validation").clamp(min=1e-12).log().mean().exp())

    def _averaged(self) -> ResidualNetwork:
        """The network with the averaged weights."""
        assert isinstance(self.mean.module, ResidualNetwork)
        return self.mean.module

    def _copy(self) -> dict[str, Any]:
        return {name: x.detach().clone() for name, x in self._averaged().state_dict().items()}

    def _kept(self) -> dict[str, Any] | None:
        if self.keep is None or not self.keep.exists():
            return None
        found = torch.load(self.keep, weights_only=True, map_location="cpu")
        return found if found.get("key") == self.key else None

    def _resume(self) -> tuple[tuple[dict[str, Any], float], int, int]:
        kept, self.kept = self.kept, None
        assert kept is not None
        self.network.load_state_dict(kept["network"])
        self.mean.load_state_dict(kept["mean"])
        self.optimiser.load_state_dict(kept["optimiser"])
        self.curve = [(str(a), int(b), float(c), float(d)) for a, b, c, d in kept["curve"]]
        return (kept["best"], kept["best_loss"]), kept["since"], kept["epoch"]

    def _save(self, stage: str, epoch: int, best: tuple[dict[str, Any], float], since: int) -> None:
        if self.keep is None:
            return
        stages = STAGES[self.settings.loss]
        aside = self.keep.with_name(f"{self.keep.name}.aside")
        torch.save(
            {
                "key": self.key,
                "stage": stage,
                "done": list(stages[: stages.index(stage)]),
                "epoch": epoch,
                "since": since,
                "network": self.network.state_dict(),
                "mean": self.mean.state_dict(),
                "optimiser": self.optimiser.state_dict(),
                "best": best[0],
                "best_loss": best[1],
                "curve": [list(row) for row in self.curve],
            },
            aside,
        )
        os.replace(aside, self.keep)


def _key(settings: TrainingSettings, data: dict[str, Set]) -> str:
    """Tells one training from another: its settings and its data."""
    digest = hashlib.sha256(json.dumps(asdict(settings)).encode())
    for part in data.values():
        digest.update(part.samples.d.cpu().numpy().tobytes())
    return digest.hexdigest()
