"""A small network through ONNX Runtime's C interface: floats in, floats out, buffers owned here, no numpy.

The Python binding of ONNX Runtime imports numpy and costs 14 MB more; on board one vector goes in and one
comes out. The C interface is a table of functions that is only ever appended to (its first 102 entries are
those of version 1), so the indices below hold for every release. One thread, no arena, no telemetry.
"""

import ctypes
import os
from collections.abc import Callable
from contextlib import suppress
from ctypes import POINTER, byref, c_char_p, c_float, c_int, c_int64, c_size_t, c_uint32, c_void_p
from functools import lru_cache
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any

from twin.errors import TwinError

_API_VERSION = 1
_INDEX = {
    "GetErrorMessage": 2,
    "CreateEnv": 3,
    "DisableTelemetryEvents": 6,
    "CreateSessionFromArray": 8,
    "Run": 9,
    "CreateSessionOptions": 10,
    "DisableMemPattern": 17,
    "DisableCpuMemArena": 19,
    "SetSessionGraphOptimizationLevel": 23,
    "SetIntraOpNumThreads": 24,
    "SetInterOpNumThreads": 25,
    "CreateTensorWithDataAsOrtValue": 49,
    "CreateCpuMemoryInfo": 69,
    "ReleaseStatus": 93,
    "ReleaseMemoryInfo": 94,
    "ReleaseSession": 95,
    "ReleaseValue": 96,
    "ReleaseSessionOptions": 100,
}
_FLOAT_TENSOR, _DEVICE_ALLOCATOR, _DEFAULT_MEMORY, _ALL_OPTIMIZATIONS, _ERROR = 1, 0, 0, 99, 3


class NetworkError(TwinError):
    """ONNX Runtime refuses a model, or is not installed."""


class _Base(ctypes.Structure):
    _fields_ = (
        ("get_api", ctypes.CFUNCTYPE(POINTER(c_void_p), c_uint32)),
        ("version", ctypes.CFUNCTYPE(c_char_p)),
    )


class _Runtime:
    """The functions of ONNX Runtime, and its one environment."""

    def __init__(self) -> None:
        library = _load()
        library.OrtGetApiBase.restype = POINTER(_Base)
        base = library.OrtGetApiBase().contents
        self.version = base.version().decode()
        self._table = base.get_api(_API_VERSION)
        self._message = self.function("GetErrorMessage", c_char_p, c_void_p)
        self.env = c_void_p()
        self.call("CreateEnv", c_int(_ERROR), c_char_p(b"shiptwin"), byref(self.env))
        self.call("DisableTelemetryEvents", self.env)

    def function(self, name: str, result: Any, *arguments: Any) -> Any:
        return ctypes.CFUNCTYPE(result, *arguments)(self._table[_INDEX[name]])

    def call(self, name: str, *arguments: Any) -> None:
        """Call a function that returns a status; a bad one becomes a NetworkError."""
        # byref() gives a CArgObject
        types = [c_void_p if type(a).__name__ == "CArgObject" else type(a) for a in arguments]
        self.check(self.function(name, c_void_p, *types)(*arguments))

    def check(self, status: int | None) -> None:
        if status:
            text = self._message(status).decode(errors="replace")
            self.release("ReleaseStatus", c_void_p(status))
            raise NetworkError(" ".join(text.split())[:300])

    def release(self, name: str, thing: c_void_p) -> None:
        self.function(name, None, c_void_p)(thing)


class Network:
    """One input vector, one output vector: `run(values) -> list[float]` writes and reads buffers that stay
    where they are."""

    def __init__(self, model: bytes, input_name: str, inputs: int, output_name: str, outputs: int):
        self._runtime = _runtime()
        self._model = model
        self._session = self._open(model)
        self._in, self._out = (c_float * inputs)(), (c_float * outputs)()
        self._slice_in, self._slice_out = slice(0, inputs), slice(0, outputs)
        self._values = ((c_void_p * 1)(self._tensor(self._in)), (c_void_p * 1)(self._tensor(self._out)))
        self._names = ((c_char_p * 1)(input_name.encode()), (c_char_p * 1)(output_name.encode()))
        pointers = (c_void_p, c_void_p, POINTER(c_char_p), POINTER(c_void_p), c_size_t)
        self._run = self._runtime.function(
            "Run", c_void_p, *pointers, POINTER(c_char_p), c_size_t, POINTER(c_void_p)
        )
        self._arguments = (
            self._session,
            None,
            self._names[0],
            self._values[0],
            1,
            self._names[1],
            1,
            self._values[1],
        )

    def run(self, values: list[float]) -> list[float]:
        """The network's output; the caller has checked that the values are finite."""
        self._in[self._slice_in] = values  # type: ignore[assignment]
        status = self._run(*self._arguments)
        if status:
            self._runtime.check(status)
        return self._out[self._slice_out]

    def close(self) -> None:
        """Gives the memory back; the network must not be run afterwards."""
        for (value,) in self._values:
            self._runtime.release("ReleaseValue", c_void_p(value))
        self._runtime.release("ReleaseSession", self._session)

    def _open(self, model: bytes) -> c_void_p:
        options, session = c_void_p(), c_void_p()
        call = self._runtime.call
        call("CreateSessionOptions", byref(options))
        call("SetIntraOpNumThreads", options, c_int(1))
        call("SetInterOpNumThreads", options, c_int(1))
        call("DisableCpuMemArena", options)
        call("DisableMemPattern", options)
        call("SetSessionGraphOptimizationLevel", options, c_int(_ALL_OPTIMIZATIONS))
        call(
            "CreateSessionFromArray",
            self._runtime.env,
            c_char_p(model),
            c_size_t(len(model)),
            options,
            byref(session),
        )
        self._runtime.release("ReleaseSessionOptions", options)
        return session

    def _tensor(self, buffer: Any) -> int:
        info, value = c_void_p(), c_void_p()
        self._runtime.call(
            "CreateCpuMemoryInfo", c_int(_DEVICE_ALLOCATOR), c_int(_DEFAULT_MEMORY), byref(info)
        )
        shape = (c_int64 * 2)(1, len(buffer))
        data = ctypes.cast(buffer, c_void_p)
        size, kind = c_size_t(ctypes.sizeof(buffer)), c_int(_FLOAT_TENSOR)
        shape_at = ctypes.cast(shape, c_void_p)
        self._runtime.call(
            "CreateTensorWithDataAsOrtValue", info, data, size, shape_at, c_size_t(2), kind, byref(value)
        )
        self._runtime.release("ReleaseMemoryInfo", info)
        return value.value or 0


def open_library(breathe: Callable[[], object]) -> None:
    """Load ONNX Runtime now, if it is there; `breathe` is called between its steps (it may give memory
    back)."""
    with suppress(NetworkError):
        _load()
        breathe()
        _runtime()
        breathe()


@lru_cache(maxsize=1)
def _load() -> ctypes.CDLL:
    # before the library is loaded: a thread and a database otherwise
    os.environ["ORT_DISABLE_TELEMETRY"] = "1"
    return ctypes.CDLL(str(_library()))


@lru_cache(maxsize=1)
def _runtime() -> _Runtime:
    return _Runtime()


def _library() -> Path:
    """The shared library that comes with the onnxruntime package, found without importing the package."""
    spec = PathFinder.find_spec("onnxruntime")
    folders = list(spec.submodule_search_locations or []) if spec else []
    for folder in folders:
        for pattern in ("libonnxruntime.so*", "libonnxruntime*.dylib", "onnxruntime.dll"):
            for path in sorted((Path(folder) / "capi").glob(pattern)):
                return path
    raise NetworkError("ONNX Runtime's library is not there. Run: pip install onnxruntime")
