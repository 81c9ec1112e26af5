"""What is the paper's "F_D and F_theta do not meet" worth here? Angles between the core's columns and what
the network has learned.

Along every zigzag: the smallest principal angle of the span of phi to that of the core's columns, axis by
axis, and how much of the learned force lies inside the latter, where the core could have said it itself."""

from collections.abc import Sequence

import numpy as np
import torch

from bench.paper.lab import LabCourse
from export.residual_network import ResidualNetwork
from twin.physics.model import Model
from twin.physics.state import Situation
from twin.study.estimation.identifiability import Features, residual_angles


def apart(
    courses: Sequence[LabCourse], model: Model, network: ResidualNetwork
) -> dict[str, dict[str, float]]:
    """By axis, medians over the voyages."""
    W = network.last.weight.detach().numpy().astype(float)
    found = [residual_angles(c.floating, model, _features(network), W) for c in courses]
    return {
        axis: {
            n: float(np.median([f[axis][n] for f in found])) for n in ("smallest_deg", "force_inside_core")
        }
        for axis in found[0]
    }


def _features(network: ResidualNetwork) -> Features:
    def phi(s: Situation) -> np.ndarray:
        there = {
            n: torch.as_tensor(np.asarray(x), dtype=torch.float32)
            for n in s.__slots__
            if (x := getattr(s, n)) is not None
        }
        with torch.no_grad():
            zeta = network.zeta(Situation(**there))
            return (network.phi(zeta) * network.weight(zeta).unsqueeze(-1)).double().numpy()

    return phi
