"""Does ONNX Runtime say of the exported trunk what torch says of the trained one? And does the twin take the
two files?

python -m export.check RESIDUAL.onnx --ship SHIP.toml
"""

import argparse
import sys
from pathlib import Path

import numpy as np
import torch

from export.residual_network import ResidualNetwork
from twin.cli import guarded
from twin.errors import TwinError
from twin.live.learning.residual import load as load_residual
from twin.num import as_given, num
from twin.physics.ship import load

AGREE = 1e-6  # of the larger of 1 and the feature's size


def answers(model: bytes, x: np.ndarray) -> np.ndarray:
    """(N, 64) phi of scaled inputs (N, n) by ONNX Runtime, one row at a time as on board. Both are
    dimensionless."""
    import onnxruntime as ort

    options = ort.SessionOptions()
    options.intra_op_num_threads = 1
    session = ort.InferenceSession(model, options, providers=["CPUExecutionProvider"])
    name = session.get_inputs()[0].name
    return np.concatenate([session.run(None, {name: row[None]})[0] for row in x.astype(np.float32)])


def disagreement(network: ResidualNetwork, model: bytes, count: int = 256, seed: int = 0) -> float:
    """The greatest difference over inputs drawn from the whole envelope, relative to the larger of 1 and
    |phi|."""
    rng = np.random.default_rng(seed)
    low, high = network.low.numpy(), network.high.numpy()
    zeta = torch.tensor(low + (high - low) * rng.random((count, low.size)), dtype=torch.float32)
    with torch.no_grad():
        wanted = network.phi(zeta).numpy()
        x = ((zeta - network.offset) / network.scale).numpy()
    return float((np.abs(answers(model, x) - wanted) / np.maximum(1.0, np.abs(wanted))).max())


def agree(network: ResidualNetwork, model: bytes) -> float:
    """The disagreement; TwinError when it is more than AGREE."""
    worst = disagreement(network, model)
    if not worst <= AGREE:
        raise TwinError(
            f"torch and ONNX Runtime disagree by {num(worst, 2)} (at most {as_given(AGREE)}); nothing was "
            "written."
        )
    return worst


def main() -> int:
    """`python -m export.check`: load the files as the twin does, and say what is in them; the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m export.check", description="Would the twin take this residual for this ship?"
    )
    parser.add_argument("residual", metavar="RESIDUAL.onnx", type=Path)
    parser.add_argument("--ship", metavar="SHIP.toml", required=True)
    args = parser.parse_args()
    found = load_residual(args.residual, load(args.ship))
    print(
        f"{args.residual}: whole, and made for {found.manifest.ship_name}; inputs "
        f"{', '.join(i.name for i in found.manifest.inputs)}"
    )
    return 0


if __name__ == "__main__":
    sys.exit(guarded(main))
