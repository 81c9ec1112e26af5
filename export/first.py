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
import json
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch

from export.residual_network import CALM, ResidualNetwork
from twin.live.learning.learned_force import scale_of
from twin.live.log.log_rows import read_rows
from twin.live.observer.dynamics import KnownDynamics
from twin.live.signals.channels import BY_NAME
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.physics.state import Force, Situation
from twin.physics.zeta import inputs

STEP_S, LAM = 1.0, 0.15  # grid [s]; filter [1/s]
KERNEL = 64  # steps of the filter that are kept: the rest is below 1e-4
RIDGE, RATE, ROUNDS, BATCH = 2e-3, 2e-3, 1500, 8
HELD_OUT = 5  # every fifth voyage is not trained on


class Run(NamedTuple):
    """One voyage on the grid: zeta (T, 5), and d (T, 3) that is good from KERNEL on."""

    name: str
    zeta: np.ndarray
    d: np.ndarray


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
    zeta = np.stack([np.broadcast_to(z, grid.shape) for z in inputs(CALM, s, ship)], axis=1)
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


def train(runs: list[Run], ship: Ship, seed: int = 42) -> ResidualNetwork:
    """The network on windows of the runs, its last layer from nothing; its bound is what the runs need."""
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    rng = np.random.default_rng(seed)
    network = ResidualNetwork(ship, CALM, np.concatenate([run.zeta for run in runs]))
    torch.nn.init.zeros_(network.last.weight)
    size = torch.tensor(np.concatenate([run.d[KERNEL:] for run in runs]).std(0), dtype=torch.float32)
    optimiser = torch.optim.Adam(network.parameters(), lr=RATE, weight_decay=1e-5)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, ROUNDS)
    for _ in range(ROUNDS):
        windows = [_window(runs[rng.integers(len(runs))], rng) for _ in range(BATCH)]
        z, d = (torch.tensor(np.stack(x), dtype=torch.float32) for x in zip(*windows, strict=True))
        f = network.f(z)
        loss = (((low_passed(f) - d)[:, KERNEL:] / size) ** 2).mean() + RIDGE * ((f / size) ** 2).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
    network.bind(zeta_of(runs))
    return network


def zeta_of(runs: list[Run]) -> torch.Tensor:
    """(N, 5), dimensionless: the inputs of all runs."""
    return torch.tensor(np.concatenate([run.zeta for run in runs]), dtype=torch.float32)


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


def explained(network: ResidualNetwork, runs: list[Run]) -> list[float]:
    """Share of the mean square of d that the network takes away, by axis, within its range and bound."""
    with torch.no_grad():
        pairs = [(low_passed(network.f(zeta_of([run]))).numpy()[KERNEL:], run.d[KERNEL:]) for run in runs]
    left = np.concatenate([d - f for f, d in pairs])
    whole = np.concatenate([d for _, d in pairs])
    return [float(x) for x in 1.0 - (left**2).mean(0) / (whole**2).mean(0)]


def main() -> int:
    """`python -m export.first`: train, judge on held-out voyages, write; the exit code."""
    from export import to_onnx  # needs onnx, which reading and training do not

    parser = argparse.ArgumentParser(prog="python -m export.first", description=__doc__.split("\n")[0])
    parser.add_argument("voyages", nargs="+", type=Path, metavar="VOYAGE.mcap")
    parser.add_argument("--ship", default="kvlcc2")
    parser.add_argument("--seed", type=int, default=42)
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="RESIDUAL.onnx")
    args = parser.parse_args()
    ship = load(args.ship)
    runs = [read(path, ship) for path in sorted(args.voyages)]
    held_out, used = runs[::HELD_OUT], [run for i, run in enumerate(runs) if i % HELD_OUT]
    network = train(used, ship, args.seed)
    about = {
        "what": "first residual: calm water, filtered regression, no roll-out",
        "seed": args.seed,
        "voyages": [run.name for run in used],
        "held_out": [run.name for run in held_out],
        "explained": dict(zip(("surge", "sway", "yaw"), explained(network, used), strict=True)),
        "explained_held_out": dict(zip(("surge", "sway", "yaw"), explained(network, held_out), strict=True)),
    }
    model = to_onnx.trunk(network)
    to_onnx.write(args.output, model, to_onnx.manifest(network, model, zeta_of(used), about))
    print(json.dumps({key: about[key] for key in ("explained", "explained_held_out")}))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
