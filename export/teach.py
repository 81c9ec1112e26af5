"""The training itself: Table 1's protocol on single moments, then roll-outs; resumable, and the same for the
same seed."""

import time
from dataclasses import dataclass
from pathlib import Path

import torch

from export.batches import TrainingSamples, input_names, samples, windows, zeta_of
from export.data import TrainingLeg, check_stretches
from export.residual_network import ResidualNetwork, names_for
from export.settings import STAGES, Progress, Set, TrainingSettings
from export.training_course import TrainingCourse
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.physics.zeta import inputs


def device() -> torch.device:
    """Where to train: the GPU when there is one."""
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")


@dataclass
class Taught:
    """The network and how its training went: (stage, epoch, loss, validation loss) for each epoch."""

    network: ResidualNetwork
    curve: list[tuple[str, int, float, float]]
    seconds: float
    diagnostics: dict[str, float]
    samples: TrainingSamples  # what it was taught with
    validation: float  # the best loss of the last stage on the validation part


def prepared(parts: dict[str, list[TrainingLeg]], model: Model, settings: TrainingSettings) -> dict[str, Set]:
    """Training and validation data as tensors. DataError: a part has nothing that the loss could judge."""
    names = input_names([leg for legs in parts.values() for leg in legs])
    length_s = float(model.ship.scale("time"))
    horizon = settings.rollout_lengths * length_s
    data = {
        part: Set(samples(parts[part], model, names), windows(parts[part], names, horizon, 0.5 * horizon))
        for part in ("train", "validation")
    }
    for part, one in data.items():
        check_stretches(
            part, len(one.windows) if "rollout" in STAGES[settings.loss] else len(one.samples), horizon
        )
    return data


def teach(
    parts: dict[str, list[TrainingLeg]],
    model: Model,
    settings: TrainingSettings,
    progress: Progress | None = None,
    keep: Path | None = None,
) -> Taught:
    """Train a residual for the model; `keep` is a checkpoint file, continued when it belongs to the same
    training."""
    torch.set_num_threads(1)
    torch.manual_seed(settings.seed)
    data = prepared(parts, model, settings)
    legs = [leg for some in parts.values() for leg in some]
    names = names_for(legs, model)
    with torch.no_grad():
        probe = _probe(model, names, data["train"].samples)
    network = ResidualNetwork(model.ship, names, probe.numpy())
    there = device()  # it begins with the same weights anywhere: they are drawn before
    moved = {part: one.on(there) for part, one in data.items()}
    course = TrainingCourse(network.to(there), model, settings, moved, progress or (lambda *_: None), keep)
    began = time.monotonic()
    for stage in STAGES[settings.loss]:
        course.run(stage)
    network.cpu()
    network.bind(zeta_of(network, data["train"].samples))
    return Taught(
        network,
        course.curve,
        time.monotonic() - began,
        course.diagnostics,
        data["train"].samples,
        course.best,
    )


def _probe(model: Model, names: tuple[str, ...], data: TrainingSamples) -> torch.Tensor:
    """(N, inputs) the training data as the network will see them."""
    return torch.stack(torch.broadcast_tensors(*inputs(names, Situation(**data.fields), model.ship)), -1)
