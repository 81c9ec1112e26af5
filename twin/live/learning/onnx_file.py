"""What an ONNX file holds, read without running it: operators, opset, inputs, outputs, and anything that
must not be there.

ONNX Runtime loads most corrupted files without complaint, follows paths to other files, and a model of 91
bytes can ask for 16 GiB. So the file is looked through before it is given to it. The wire format is
protobuf's; the field numbers are those of onnx.proto3 (https://github.com/onnx/onnx, onnx/onnx.proto).
"""

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

Field = tuple[int, int, int | bytes]  # number, wire type, value
GRAPH, OPSETS, FUNCTIONS = 7, 8, 25  # of ModelProto
NODES, INITIALIZERS, INPUTS, OUTPUTS, SPARSE = 1, 5, 11, 12, 15  # of GraphProto
FLOAT = 1


class OnnxError(ValueError):
    """The bytes are not an ONNX model the twin can read."""


@dataclass
class OnnxModel:
    """The parts of a model that are checked. `inputs` and `outputs`: (name, element type, shape; 0 for a
    free dimension)."""

    opsets: dict[str, int] = field(default_factory=dict)
    operators: list[str] = field(default_factory=list)
    inputs: list[tuple[str, int, list[int]]] = field(default_factory=list)
    outputs: list[tuple[str, int, list[int]]] = field(default_factory=list)
    oddities: list[str] = field(default_factory=list)


def look(data: bytes) -> OnnxModel:
    """The parts of a model file; OnnxError when it is not one."""
    try:
        model = OnnxModel()
        for number, _, value in _fields(data):
            if number == GRAPH:
                _graph(_bytes(value), model)
            elif number == OPSETS:
                opset = {n: v for n, _, v in _fields(_bytes(value))}
                model.opsets[_text(opset.get(1, b""))] = int(opset.get(2, 0))  # type: ignore[arg-type]
            elif number == FUNCTIONS:
                model.oddities.append("functions of its own")
        return model
    except (IndexError, UnicodeDecodeError, TypeError, RecursionError) as error:
        raise OnnxError(f"not an ONNX model ({error})") from None


def with_rows(
    model: bytes, source: str, rows: Sequence[Sequence[float]], offsets: Sequence[float], output: str
) -> bytes:
    """The model with one more output, rows (R, n) times `source` (1, n) plus offsets (R): products that
    Python is slow at.

    Protobuf merges a message that is written in two pieces, so the new node, weights and output are simply
    written behind.
    """
    size, width = len(rows), len(rows[0])
    names = [f"{output}_weights", f"{output}_offsets"]
    node = (
        b"".join(_field(1, name.encode()) for name in (source, *names))
        + _field(2, output.encode())
        + _field(4, b"Gemm")
    )
    node += _field(5, _field(1, b"transB") + _number(3, 1) + _number(20, 2))
    weights = _tensor(names[0], (size, width), [x for row in rows for x in row])
    added = (
        _field(NODES, node)
        + _field(INITIALIZERS, weights)
        + _field(INITIALIZERS, _tensor(names[1], (size,), offsets))
    )
    shape = b"".join(_field(1, _number(1, n)) for n in (1, size))
    kind = _field(1, _number(1, FLOAT) + _field(2, shape))
    return model + _field(GRAPH, added + _field(OUTPUTS, _field(1, output.encode()) + _field(2, kind)))


def _tensor(name: str, shape: Sequence[int], values: Sequence[float]) -> bytes:
    data = struct.pack(f"<{len(values)}f", *values)
    return (
        b"".join(_number(1, n) for n in shape)
        + _number(2, FLOAT)
        + _field(8, name.encode())
        + _field(9, data)
    )


def _field(number: int, data: bytes) -> bytes:
    return _varint_of(number << 3 | 2) + _varint_of(len(data)) + data


def _number(number: int, value: int) -> bytes:
    return _varint_of(number << 3) + _varint_of(value)


def _varint_of(value: int) -> bytes:
    out = b""
    while value > 0x7F:
        out += bytes((value & 0x7F | 0x80,))
        value >>= 7
    return out + bytes((value,))


def _graph(data: bytes, model: OnnxModel) -> None:
    for number, _, value in _fields(data):
        if number == NODES:
            _node(_bytes(value), model)
        elif number == INITIALIZERS:
            if any(n in (13, 14) for n, _, _ in _fields(_bytes(value))):
                model.oddities.append("weights outside the file")
        elif number == SPARSE:
            model.oddities.append("sparse weights")
        elif number in (INPUTS, OUTPUTS):
            (model.inputs if number == INPUTS else model.outputs).append(_value_info(_bytes(value)))


def _node(data: bytes, model: OnnxModel) -> None:
    operator = domain = ""
    for number, _, value in _fields(data):
        if number == 4:
            operator = _text(value)
        elif number == 7:
            domain = _text(value)
        elif number == 5 and any(n in (6, 11) for n, _, _ in _fields(_bytes(value))):  # attribute g, graphs
            model.oddities.append("a graph inside a node")
    model.operators.append(f"{domain}::{operator}" if domain not in ("", "ai.onnx") else operator)


def _value_info(data: bytes) -> tuple[str, int, list[int]]:
    name, kind = "", 0
    shape: list[int] = []
    for number, _, value in _fields(data):
        if number == 1:
            name = _text(value)
        elif number == 2:
            for n, _, tensor in _fields(_bytes(value)):
                if n == 1:
                    kind, shape = _tensor_type(_bytes(tensor))
    return name, kind, shape


def _tensor_type(data: bytes) -> tuple[int, list[int]]:
    kind = 0
    shape: list[int] = []
    for number, _, value in _fields(data):
        if number == 1:
            kind = int(value)  # type: ignore[arg-type]
        elif number == 2:
            for _, _, dimension in _fields(_bytes(value)):
                sizes = [v for n, _, v in _fields(_bytes(dimension)) if n == 1]
                shape.append(int(sizes[0]) if sizes else 0)  # type: ignore[arg-type]
    return kind, shape


def _fields(data: bytes) -> Iterator[Field]:
    at, size = 0, len(data)
    while at < size:
        tag, at = _varint(data, at)
        wire = tag & 7
        if wire == 0:
            value, at = _varint(data, at)
            yield tag >> 3, wire, value
            continue
        length = {1: 8, 5: 4}.get(wire)
        if wire == 2:
            length, at = _varint(data, at)
        if length is None or at + length > size:
            raise OnnxError(f"not an ONNX model (it breaks off at byte {at})")
        yield tag >> 3, wire, data[at : at + length]
        at += length


def _varint(data: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
        shift += 7
        if shift > 63:
            raise OnnxError("not an ONNX model (a number that does not end)")


def _bytes(value: int | bytes) -> bytes:
    if not isinstance(value, bytes):
        raise OnnxError("not an ONNX model (a number where a message belongs)")
    return value


def _text(value: int | bytes) -> str:
    return _bytes(value).decode()
