"""A first residual for a ship, from calm-water voyages: what its core leaves over, learned without
differentiating a sensor.

    python -m export.first VOYAGE.mcap... --ship kvlcc2 -o twin/ships/kvlcc2.residual.onnx

The loss is the filtered regression the twin also uses on board (twin/live/learning/filtered_regression.py):
with (.)_f a first-order low-pass,
    d = S^-1 M [(d nu/dt)_f - (nu_dot_known)_f],   minimise |d - (W phi(zeta))_f|^2 + ridge |W phi|^2
The full training, with roll-outs and its protocol, is `twin train`; this one gives the loop something honest
to run on.
"""

import argparse
import hashlib
import itertools
import json
import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import torch

from twin.live.learning.learned_force import scale_of
from twin.live.learning.manifest import SCHEMA_VERSION, hashed
from twin.live.learning.residual import ship_hash
from twin.live.log.log_rows import read_rows
from twin.live.observer.dynamics import KnownDynamics
from twin.live.signals.channels import BY_NAME
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.physics.state import Force, Situation
from twin.physics.zeta import inputs

NAMES = ("surge", "sway", "yaw", "rudder", "propeller")
LAYERS, FEATURES, COMPONENTS, OPSET = 4, 64, 4, 17
STEP_S, LAM = 1.0, 0.15  # grid [s]; filter [1/s]
KERNEL = 64  # steps of the filter that are kept: the rest is below 1e-4
RIDGE, RATE, ROUNDS, BATCH = 2e-3, 2e-3, 1500, 8
HELD_OUT = 5  # every fifth voyage is not trained on


class Run(NamedTuple):
    """One voyage on the grid: zeta (T, 5), and d (T, 3) that is good from KERNEL on."""

    name: str
    zeta: np.ndarray
    d: np.ndarray


class Trunk(torch.nn.Module):
    """zeta -> phi -> W phi, in units of the force scale."""

    offset: torch.Tensor  # mean of each input
    scale: torch.Tensor  # and its spread

    def __init__(self, offset: np.ndarray, scale: np.ndarray):
        super().__init__()
        sizes = [len(NAMES)] + [FEATURES] * LAYERS
        self.layers = torch.nn.ModuleList(torch.nn.Linear(a, b) for a, b in itertools.pairwise(sizes))
        for layer in self.linear_layers():
            torch.nn.init.xavier_uniform_(layer.weight)
            torch.nn.init.zeros_(layer.bias)
        self.W = torch.nn.Parameter(torch.zeros(3, FEATURES))
        self.register_buffer("offset", torch.tensor(offset, dtype=torch.float32))
        self.register_buffer("scale", torch.tensor(scale, dtype=torch.float32))

    def linear_layers(self) -> list[torch.nn.Linear]:
        """The trunk's layers, the first one first."""
        return [layer for layer in self.layers if isinstance(layer, torch.nn.Linear)]

    def phi(self, zeta: torch.Tensor) -> torch.Tensor:
        """(..., 64) of zeta (..., inputs), not yet scaled."""
        x = (zeta - self.offset) / self.scale
        for layer in self.layers:
            z = layer(x)
            x = z * torch.sigmoid(z)
        return x

    def forward(self, zeta: torch.Tensor) -> torch.Tensor:
        """(..., 3) in units of the force scale."""
        return self.phi(zeta) @ self.W.T


def read(path: Path, ship: Ship) -> Run:
    """A voyage on the grid, and the force its core leaves over."""
    time_s, columns = read_rows(path)
    grid = np.arange(time_s[0], time_s[-1] - 1.0, STEP_S)
    si = {name: _on(grid, time_s, columns[column], BY_NAME[column].wraps) for name, column in COLUMNS.items()}
    psi, r, delta = (np.radians(si[name]) for name in ("psi", "r", "delta"))
    s = Situation(0.0, 0.0, psi, si["u"], si["v"], r, delta=delta, n=si["n"] / 60.0)
    known = KnownDynamics(Model.of(ship))
    rates = np.stack(known.rates(s, Force(0.0, 0.0, 0.0)), axis=1)
    nu = np.stack([s.u, s.v, s.r], axis=1)
    left = np.diff(nu, axis=0) / STEP_S - 0.5 * (rates[1:] + rates[:-1])
    force = known.force_for(*left.T)
    d = np.stack([f / scale for f, scale in zip(force, scale_of(ship), strict=True)], axis=1)
    zeta = np.stack([np.broadcast_to(z, grid.shape) for z in inputs(NAMES, s, ship)], axis=1)
    return Run(path.stem, 0.5 * (zeta[1:] + zeta[:-1]), low_passed(torch.tensor(d)).numpy())


COLUMNS = {
    "u": "surge_velocity_mps",
    "v": "sway_velocity_mps",
    "r": "yaw_rate_degps",
    "psi": "heading_true_north_deg",
    "delta": "rudder_angle_deg",
    "n": "propeller_rate_rpm",
}


def low_passed(x: torch.Tensor) -> torch.Tensor:
    """(..., T, k) through the first-order filter, which starts from zero."""
    a = 1.0 - np.exp(-LAM * STEP_S)
    weights = a * (1.0 - a) ** torch.arange(KERNEL - 1, -1, -1, dtype=x.dtype)
    channels = x.shape[-1]
    rows = x.reshape(-1, x.shape[-2], channels).transpose(1, 2)
    padded = torch.nn.functional.pad(rows, (KERNEL - 1, 0))
    out = torch.nn.functional.conv1d(padded, weights.expand(channels, 1, KERNEL), groups=channels)
    return out.transpose(1, 2).reshape(x.shape)


def train(runs: list[Run], seed: int = 42) -> Trunk:
    """The trunk and its last layer on windows of the runs."""
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    rng = np.random.default_rng(seed)
    zeta = np.concatenate([run.zeta for run in runs])
    trunk = Trunk(zeta.mean(0), zeta.std(0) + 1e-3)
    size = torch.tensor(np.concatenate([run.d[KERNEL:] for run in runs]).std(0), dtype=torch.float32)
    optimiser = torch.optim.Adam(trunk.parameters(), lr=RATE, weight_decay=1e-5)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, ROUNDS)
    for _ in range(ROUNDS):
        windows = [_window(runs[rng.integers(len(runs))], rng) for _ in range(BATCH)]
        z, d = (torch.tensor(np.stack(x), dtype=torch.float32) for x in zip(*windows, strict=True))
        f = trunk(z)
        loss = (((low_passed(f) - d)[:, KERNEL:] / size) ** 2).mean() + RIDGE * ((f / size) ** 2).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    return trunk


def _window(run: Run, rng: np.random.Generator, steps: int = 4 * KERNEL) -> tuple[np.ndarray, np.ndarray]:
    start = rng.integers(max(len(run.zeta) - steps, 1))
    return run.zeta[start : start + steps], run.d[start : start + steps]


def _on(grid: np.ndarray, time_s: np.ndarray, values: np.ndarray, wraps: float) -> np.ndarray:
    """Means of what was measured around each point of the grid; what `wraps` is unwrapped first, and nothing
    else: a boat's shaft goes from 0 to 3000 rpm at once."""
    good = np.isfinite(values)
    t, x = time_s[good], values[good]
    if wraps:
        x = np.unwrap(x, period=wraps)
    total = np.concatenate([[0.0], np.cumsum(x)])
    first, last = np.searchsorted(t, grid - 0.5 * STEP_S), np.searchsorted(t, grid + 0.5 * STEP_S)
    many = last > first
    mean = (total[last] - total[first]) / np.maximum(last - first, 1)
    return np.where(many, mean, np.interp(grid, t, x))


def explained(trunk: Trunk, runs: list[Run]) -> list[float]:
    """Share of the mean square of d that the network takes away, by axis."""
    with torch.no_grad():
        pairs = [
            (low_passed(trunk(torch.tensor(run.zeta, dtype=torch.float32))).numpy()[KERNEL:], run.d[KERNEL:])
            for run in runs
        ]
    left = np.concatenate([d - f for f, d in pairs])
    whole = np.concatenate([d for _, d in pairs])
    return [float(x) for x in 1.0 - (left**2).mean(0) / (whole**2).mean(0)]


def trunk_onnx(trunk: Trunk) -> bytes:
    """The trunk as an ONNX file: zeta, already scaled, (1, 5) -> phi (1, 64)."""
    from onnx import TensorProto, checker, helper, numpy_helper

    nodes, weights, source = [], [], "zeta"
    for i, layer in enumerate(trunk.linear_layers()):
        out = "phi" if i == LAYERS - 1 else f"x{i}"
        w, b = layer.weight.detach().numpy(), layer.bias.detach().numpy()
        weights += [numpy_helper.from_array(w, f"w{i}"), numpy_helper.from_array(b, f"b{i}")]
        nodes += [
            helper.make_node("Gemm", [source, f"w{i}", f"b{i}"], [f"z{i}"], transB=1),
            helper.make_node("Sigmoid", [f"z{i}"], [f"s{i}"]),
            helper.make_node("Mul", [f"z{i}", f"s{i}"], [out]),
        ]
        source = out
    ends = [
        helper.make_tensor_value_info(n, TensorProto.FLOAT, [1, size])
        for n, size in (("zeta", len(NAMES)), ("phi", FEATURES))
    ]
    graph = helper.make_graph(nodes, "trunk", ends[:1], ends[1:], weights)
    model = helper.make_model(
        graph, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=8, producer_name="shiptwin"
    )
    checker.check_model(model)
    return bytes(model.SerializeToString())


def manifest(
    trunk: Trunk, model: bytes, ship: Ship, runs: list[Run], about: dict[str, Any]
) -> dict[str, Any]:
    """The manifest of docs/residual.md."""
    zeta = np.concatenate([run.zeta for run in runs])
    low, high = zeta.min(0), zeta.max(0)
    with torch.no_grad():
        phi = trunk.phi(torch.tensor(zeta, dtype=torch.float32)).numpy().astype(float)
        force = phi @ trunk.W.numpy().T.astype(float)
    centred = phi - phi.mean(0)
    _, _sizes, directions = np.linalg.svd(centred[:: max(len(centred) // 20000, 1)], full_matrices=False)
    deviations = (centred @ directions[:COMPONENTS].T).std(0)
    offset, scale = trunk.offset.numpy(), trunk.scale.numpy()
    golden = (zeta[:: len(zeta) // 5][:5] - offset) / scale
    with torch.no_grad():
        answers = trunk.phi(torch.tensor(golden * scale + offset, dtype=torch.float32)).numpy()
    W, S = trunk.W.detach().numpy(), scale_of(ship)
    return {
        "schema_version": SCHEMA_VERSION,
        "sha256": hashlib.sha256(model).hexdigest(),
        "onnx_opset": OPSET,
        "ship": {"name": ship.name, "hash": ship_hash(ship)},
        "inputs": [
            {"name": n, "unit": "-", "scale": float(s), "offset": float(o), "low": float(a), "high": float(b)}
            for n, s, o, a, b in zip(NAMES, scale, offset, low, high, strict=True)
        ],
        "features": FEATURES,
        "W": [[float(x) for x in row] for row in W],
        "W_max": float(1.5 * np.linalg.norm(W)),
        "force_scale": {"X_N": float(S.X), "Y_N": float(S.Y), "N_Nm": float(S.N)},
        "output_bound": float(1.2 * np.quantile(np.linalg.norm(force, axis=1), 0.999)),
        "whitening": {
            "mean": [float(x) for x in phi.mean(0)],
            "components": [[float(x) for x in row] for row in directions[:COMPONENTS] / deviations[:, None]],
        },
        "spectral_norms": [
            float(np.linalg.norm(layer.weight.detach().numpy(), 2)) for layer in trunk.linear_layers()
        ],
        "golden": {
            "inputs": [[float(x) for x in row] for row in golden],
            "outputs": [[float(x) for x in row] for row in answers],
        },
        "training": about,
    }


def main() -> int:
    """`python -m export.first`: train, judge on held-out voyages, write; the exit code."""
    parser = argparse.ArgumentParser(prog="python -m export.first", description=__doc__.split("\n")[0])
    parser.add_argument("voyages", nargs="+", type=Path, metavar="VOYAGE.mcap")
    parser.add_argument("--ship", default="kvlcc2")
    parser.add_argument("--seed", type=int, default=42)
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="RESIDUAL.onnx")
    args = parser.parse_args()
    ship = load(args.ship)
    runs = [read(path, ship) for path in sorted(args.voyages)]
    held_out, used = runs[::HELD_OUT], [run for i, run in enumerate(runs) if i % HELD_OUT]
    trunk = train(used, args.seed)
    about = {
        "what": "first residual: calm water, filtered regression, no roll-out",
        "seed": args.seed,
        "voyages": [run.name for run in used],
        "held_out": [run.name for run in held_out],
        "explained": dict(zip(("surge", "sway", "yaw"), explained(trunk, used), strict=True)),
        "explained_held_out": dict(zip(("surge", "sway", "yaw"), explained(trunk, held_out), strict=True)),
    }
    model = trunk_onnx(trunk)
    for path, data in (
        (
            args.output.with_suffix(".json"),
            json.dumps(hashed(manifest(trunk, model, ship, used, about)), indent=1).encode(),
        ),
        (args.output, model),
    ):
        aside = path.with_name(f".{path.name}.part")
        aside.write_bytes(data)
        os.replace(aside, path)
    print(json.dumps({key: about[key] for key in ("explained", "explained_held_out")}))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
