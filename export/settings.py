"""What a training is asked to do, and its data as tensors."""

from collections.abc import Callable
from dataclasses import dataclass

import torch

from export.batches import TrainingSamples, TrainingWindows

Progress = Callable[[str, int, int, float, float], None]  # stage, epoch, epochs, loss, validation loss


@dataclass(frozen=True)
class TrainingSettings:
    """Table 1 of the paper, and what it leaves open; horizons in ship lengths sailed (1.5 lengths of KVLCC2
    are 60 s)."""

    seed: int = 42
    loss: str = "rollout"
    epochs: int = 150
    patience: int = 20
    batch: int = 512
    rate: float = 1e-3
    decay: float = 0.98  # of the rate, every DECAY_EPOCHS
    l2: float = 1e-5
    lambda_data: float = 1.0
    lambda_phys: float = 0.1
    rollout_epochs: int = 40
    rollout_batch: int = 64
    rollout_lengths: float = 1.5
    rollout_rate: float = 1e-3
    orthogonality: float = 0.0
    mirror: float = 0.0
    average: float = 3.0  # epochs: what is judged and kept are weights averaged over about so many


@dataclass
class Set:
    """One part of the data as tensors."""

    samples: TrainingSamples
    windows: TrainingWindows

    def on(self, device: torch.device) -> "Set":
        """The same where it is computed with."""
        return Set(self.samples.on(device), self.windows.on(device))


STAGES = {"paper": ("paper",), "acceleration": ("acceleration",), "rollout": ("acceleration", "rollout")}
