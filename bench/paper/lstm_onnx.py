"""The trained LSTM as an ONNX file that carries its state: one step a call, as it would run on board."""

import numpy as np
import onnx
import torch
from onnx import TensorProto, helper, numpy_helper

from bench.paper.lstm import HIDDEN, Lstm
from bench.tick.ort import session

GATES = (0, 3, 1, 2)  # torch keeps input, forget, cell, output; ONNX wants input, output, forget, cell
AGREE = 1e-6


def to_onnx(model: Lstm) -> bytes:
    """x (1, 1, inputs) in deviations, h and c (1, 1, 64) -> y (1, 3) in deviations, h_out and c_out."""
    cell, ends = model.cell, [1, 1, HIDDEN]
    weights = {
        "W": _gates(cell.weight_ih)[None],
        "R": _gates(cell.weight_hh)[None],
        "B": torch.cat([_gates(cell.bias_ih), _gates(cell.bias_hh)])[None],
        "w": model.out.weight,
        "b": model.out.bias,
    }
    nodes = [
        helper.make_node(
            "LSTM", ["x", "W", "R", "B", "", "h", "c"], ["all", "h_out", "c_out"], hidden_size=HIDDEN
        ),
        helper.make_node("Squeeze", ["h_out", "axis"], ["top"]),
        helper.make_node("Gemm", ["top", "w", "b"], ["y"], transB=1),
    ]
    held = [numpy_helper.from_array(x.detach().numpy(), name) for name, x in weights.items()]
    held.append(numpy_helper.from_array(np.array([0], np.int64), "axis"))
    inputs = [_float("x", [1, 1, model.mean.numel()]), _float("h", ends), _float("c", ends)]
    graph = helper.make_graph(
        nodes, "lstm", inputs, [_float("y", [1, 3]), _float("h_out", ends), _float("c_out", ends)], held
    )
    made = helper.make_model(
        graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8, producer_name="shiptwin"
    )
    onnx.checker.check_model(made)
    return bytes(made.SerializeToString())


def disagreement(model: Lstm, file: bytes, steps: int = 50, seed: int = 0) -> float:
    """The greatest difference between torch and ONNX Runtime along a run of random inputs."""
    net, rng = session(file), np.random.default_rng(seed)
    h = c = np.zeros((1, 1, HIDDEN), np.float32)
    memory, worst = None, 0.0
    for _ in range(steps):
        x = rng.standard_normal((1, model.mean.numel())).astype(np.float32)
        y, h, c = net.run(["y", "h_out", "c_out"], {"x": x[None], "h": h, "c": c})
        with torch.no_grad():
            memory = model.cell(torch.tensor(x), memory)
            worst = max(worst, float(np.abs(y - model.out(memory[0]).numpy()).max()))
    return worst


def _gates(weight: torch.Tensor) -> torch.Tensor:
    return torch.cat([weight.chunk(4)[i] for i in GATES])


def _float(name: str, shape: list[int]) -> onnx.ValueInfoProto:
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)
