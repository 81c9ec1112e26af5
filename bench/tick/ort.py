"""ONNX Runtime through its Python binding, for the peers: one thread, no spinning, no telemetry."""

import os
from typing import Any


def session(model: bytes) -> Any:
    """An InferenceSession on these bytes."""
    os.environ["ORT_DISABLE_TELEMETRY"] = "1"
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    return onnxruntime.InferenceSession(model, options, providers=["CPUExecutionProvider"])
