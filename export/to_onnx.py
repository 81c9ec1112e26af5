"""The trained residual as the two files that the twin reads (docs/residual.md): trunk in ONNX, everything
else in the manifest."""

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import torch
from onnx import TensorProto, checker, helper, numpy_helper

from export.residual_network import WIDTH, ResidualNetwork
from twin import whole
from twin.live.learning.manifest import SCHEMA_VERSION, hashed
from twin.live.learning.residual import ship_hash
from twin.physics.zeta import ZETA

OPSET, COMPONENTS, GOLDEN = 17, 4, 8


def trunk(network: ResidualNetwork) -> bytes:
    """zeta, already scaled, float32 (1, n) -> phi (1, 64)."""
    nodes, weights, source = [], [], "zeta"
    for i, layer in enumerate(network.linear_layers()):
        out = "phi" if i == len(network.layers) - 1 else f"x{i}"
        weights += [
            numpy_helper.from_array(x.detach().numpy(), f"{n}{i}")
            for n, x in (("w", layer.weight), ("b", layer.bias))
        ]
        nodes += [
            helper.make_node("Gemm", [source, f"w{i}", f"b{i}"], [f"z{i}"], transB=1),
            helper.make_node("Sigmoid", [f"z{i}"], [f"s{i}"]),
            helper.make_node("Mul", [f"z{i}", f"s{i}"], [out]),
        ]
        source = out
    ends = [
        helper.make_tensor_value_info(n, TensorProto.FLOAT, [1, size])
        for n, size in (("zeta", len(network.names)), ("phi", WIDTH))
    ]
    graph = helper.make_graph(nodes, "trunk", ends[:1], ends[1:], weights)
    model = helper.make_model(
        graph, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=8, producer_name="shiptwin"
    )
    checker.check_model(model)
    return bytes(model.SerializeToString())


def manifest(
    network: ResidualNetwork, model: bytes, zeta: torch.Tensor, training: dict[str, Any]
) -> dict[str, Any]:
    """The manifest; `zeta` (N, inputs) is the training data as the network saw it."""
    W = network.last.weight.detach().numpy().astype(float)
    with torch.no_grad():
        phi = network.phi(zeta).numpy().astype(float)
        x = (
            torch.clamp(zeta[:: max(len(zeta) // GOLDEN, 1)][:GOLDEN], network.low, network.high)
            - network.offset
        ) / network.scale
        answers = network.trunk(x).numpy()
    return {
        "schema_version": SCHEMA_VERSION,
        "sha256": hashlib.sha256(model).hexdigest(),
        "onnx_opset": OPSET,
        "ship": {"name": network.ship.name, "hash": ship_hash(network.ship)},
        "inputs": _inputs(network),
        "features": WIDTH,
        "W": W.tolist(),
        "W_max": 1.5 * float(np.linalg.norm(W)) + 1e-6,
        **limits(network),
        "whitening": whitening(phi),
        "spectral_norms": [
            float(np.linalg.norm(layer.weight.detach().numpy(), 2)) for layer in network.linear_layers()
        ],
        "golden": {"inputs": x.tolist(), "outputs": answers.tolist()},
        "training": training,
    }


def limits(network: ResidualNetwork) -> dict[str, Any]:
    """The most that the network can say: its bound, in units of the scale of forces."""
    scale = {"X_N": float(network.S.X), "Y_N": float(network.S.Y), "N_Nm": float(network.S.N)}
    return {"force_scale": scale, "output_bound": float(network.bound)}


def bounds(network: ResidualNetwork) -> dict[str, Any]:
    """That, and the range of each input within which it is believed."""
    return {**limits(network), "inputs": _inputs(network)}


def _inputs(network: ResidualNetwork) -> list[dict[str, Any]]:
    columns = zip(
        *(getattr(network, name).tolist() for name in ("scale", "offset", "low", "high")), strict=True
    )
    return [
        {
            "name": n,
            "unit": _unit(n),
            "formula": ZETA[n].formula,
            "scale": s,
            "offset": o,
            "low": a,
            "high": b,
        }
        for n, (s, o, a, b) in zip(network.names, columns, strict=True)
    ]


def _unit(name: str) -> str:
    return "rad" if "[rad]" in ZETA[name].formula else "-"


def whitening(phi: np.ndarray) -> dict[str, Any]:
    """The features' mean and their strongest directions, each of deviation one. phi (N, 64),
    dimensionless."""
    mean = phi.mean(0)
    centred = phi - mean
    _, _, directions = np.linalg.svd(centred[:: max(len(centred) // 20_000, 1)], full_matrices=False)
    rows = directions[:COMPONENTS]
    deviations = (centred @ rows.T).std(0) + 1e-9
    return {"mean": mean.tolist(), "components": (rows / deviations[:, None]).tolist()}


def write(path: Path, model: bytes, table: dict[str, Any]) -> None:
    """Both files, each whole or not at all, the manifest last: the twin believes neither without the other.
    TwinError: one cannot be written."""
    whole.write_bytes(path, model)
    whole.write(path.with_suffix(".json"), json.dumps(hashed(table), indent=1) + "\n")
