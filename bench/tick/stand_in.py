"""A residual with drawn weights for a ship that has none: it costs what a trained one does, and says nothing.

Four layers of 64 with swish, 64 features, four whitened components, as in training; the last layer is tiny.
"""

import hashlib
import json
from pathlib import Path

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from bench.tick.ort import session
from twin.live.learning.learned_force import scale_of
from twin.live.learning.manifest import SCHEMA_VERSION, hashed
from twin.live.learning.residual import ship_hash
from twin.physics.ship import Ship

INPUTS = ("surge", "sway", "yaw", "rudder", "propeller", "air_ahead", "air_starboard")
FEATURES, LAYERS, COMPONENTS, OPSET = 64, 4, 4, 17


def write(path: Path, ship: Ship, seed: int = 1) -> Path:
    """The network at `path` and its manifest beside it."""
    rng = np.random.default_rng(seed)
    model = network(rng)
    zeta = rng.uniform(-1.0, 1.0, (3, len(INPUTS))).astype(np.float32)
    run = session(model).run
    phi = [run(["phi"], {"zeta": row[None]})[0][0] for row in zeta]
    force = scale_of(ship)
    table = {
        "schema_version": SCHEMA_VERSION,
        "sha256": hashlib.sha256(model).hexdigest(),
        "onnx_opset": OPSET,
        "ship": {"name": ship.name, "hash": ship_hash(ship)},
        "inputs": [{"name": n, "scale": 3.0, "offset": 0.0, "low": -50.0, "high": 50.0} for n in INPUTS],
        "features": FEATURES,
        "W": (1e-6 * rng.standard_normal((3, FEATURES))).tolist(),
        "W_max": 1.0,
        "force_scale": {"X_N": force.X, "Y_N": force.Y, "N_Nm": force.N},
        "output_bound": 1.0,
        "golden": {"inputs": zeta.tolist(), "outputs": [row.tolist() for row in phi]},
        "whitening": {
            "mean": np.mean(phi, axis=0).tolist(),
            "components": (0.1 * rng.standard_normal((COMPONENTS, FEATURES))).tolist(),
        },
        "training": {"what": "not trained: drawn weights, to measure time and memory"},
    }
    path.write_bytes(model)
    path.with_suffix(".json").write_text(json.dumps(hashed(table)))
    return path


def network(rng: np.random.Generator) -> bytes:
    """`zeta` (1, 7) -> `phi` (1, 64)."""
    nodes, weights, source, width = [], [], "zeta", len(INPUTS)
    for i in range(LAYERS):
        out = "phi" if i == LAYERS - 1 else f"x{i}"
        weight = (rng.standard_normal((FEATURES, width)) / np.sqrt(width)).astype(np.float32)
        bias = (0.1 * rng.standard_normal(FEATURES)).astype(np.float32)
        weights += [numpy_helper.from_array(weight, f"w{i}"), numpy_helper.from_array(bias, f"b{i}")]
        nodes += [
            helper.make_node("Gemm", [source, f"w{i}", f"b{i}"], [f"z{i}"], transB=1),
            helper.make_node("Sigmoid", [f"z{i}"], [f"s{i}"]),
            helper.make_node("Mul", [f"z{i}", f"s{i}"], [out]),
        ]
        source, width = out, FEATURES
    ins = [helper.make_tensor_value_info("zeta", TensorProto.FLOAT, [1, len(INPUTS)])]
    outs = [helper.make_tensor_value_info("phi", TensorProto.FLOAT, [1, FEATURES])]
    graph = helper.make_graph(nodes, "stand_in", ins, outs, weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=8)
    onnx.checker.check_model(model)
    return model.SerializeToString()
