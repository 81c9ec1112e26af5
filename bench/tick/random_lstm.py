"""An LSTM of the paper's kind (two layers of 128) in ONNX; weights drawn, for any cost the same."""

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

INPUTS, OUTPUTS, HIDDEN, LAYERS = 9, 6, 128, 2  # eta, nu, rudder, propeller, wind -> the next state


def lstm_bytes(carries_state: bool, seed: int = 1) -> bytes:
    """`x` (steps, 1, 9) -> `y` (1, 6); with `carries_state` h and c come in and go out: one step will do."""
    rng = np.random.default_rng(seed)
    nodes, weights, ins, outs = [], [], [_float("x", [None, 1, INPUTS])], [_float("y", [1, OUTPUTS])]
    source = "x"
    for layer in range(LAYERS):
        node, tensors = _layer(layer, source, INPUTS if layer == 0 else HIDDEN, carries_state, rng)
        nodes += node
        weights += tensors
        source = f"seq{layer}"
        if carries_state:
            ins += [_float(f"{s}{layer}", [1, 1, HIDDEN]) for s in "hc"]
            outs += [_float(f"{s}{layer}_out", [1, 1, HIDDEN]) for s in "hc"]
    last = f"h{LAYERS - 1}_out"
    weights += [_tensor("w_out", rng, OUTPUTS, HIDDEN), _tensor("b_out", rng, OUTPUTS)]
    nodes += [
        helper.make_node("Squeeze", [last, "axis0"], ["top"]),
        helper.make_node("Gemm", ["top", "w_out", "b_out"], ["y"], transB=1),
    ]
    weights.append(numpy_helper.from_array(np.array([0], np.int64), "axis0"))
    graph = helper.make_graph(nodes, "lstm", ins, outs, weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model)
    return model.SerializeToString()


def _layer(i, source, width, carries_state, rng):
    start = ["", f"h{i}", f"c{i}"] if carries_state else []
    outputs = [f"all{i}", f"h{i}_out", f"c{i}_out"]
    nodes = [
        helper.make_node("LSTM", [source, f"w{i}", f"r{i}", f"b{i}", *start], outputs, hidden_size=HIDDEN),
        helper.make_node("Squeeze", [f"all{i}", f"axis1_{i}"], [f"seq{i}"]),  # drop the axis of directions
    ]
    tensors = [
        _tensor(f"w{i}", rng, 1, 4 * HIDDEN, width),
        _tensor(f"r{i}", rng, 1, 4 * HIDDEN, HIDDEN),
        _tensor(f"b{i}", rng, 1, 8 * HIDDEN),
        numpy_helper.from_array(np.array([1], np.int64), f"axis1_{i}"),
    ]
    return nodes, tensors


def _float(name, shape):
    return helper.make_tensor_value_info(name, TensorProto.FLOAT, shape)


def _tensor(name, rng, *shape):
    return numpy_helper.from_array((0.1 * rng.standard_normal(shape)).astype(np.float32), name)
