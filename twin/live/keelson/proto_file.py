"""A protobuf file description (FileDescriptorProto), read and written as bytes.

Google's own classes for it cost the loop 2 MB that it needs for a moment at the start only. Numbers of fields
are those of google/protobuf/descriptor.proto.
"""

from collections.abc import Iterator
from typing import NamedTuple

NAME, PACKAGE, DEPENDENCY, MESSAGE, SYNTAX = 1, 2, 3, 4, 12  # of a file; NAME of a message and a field too
FIELD, ONEOF = 2, 8  # of a message
NUMBER, LABEL, TYPE, TYPE_NAME, ONEOF_INDEX, OPTIONAL = 3, 4, 5, 6, 9, 17  # of a field
ONE, MANY = 1, 3  # labels
SCALARS = {"double": 1, "float": 2, "int64": 3, "int32": 5, "bool": 8, "string": 9, "bytes": 12}
MESSAGE_TYPE = 11
VARINT, BYTES = 0, 2  # protobuf's wire types


class File(NamedTuple):
    """What must be known of a file to add it to a pool: its bytes, and the files it needs first."""

    name: str
    package: str
    needs: list[str]
    messages: list[str]
    data: bytes


def files_of(file_set: bytes) -> list[File]:
    """The files of a FileDescriptorSet; ValueError when the bytes are none."""
    return [_file(data) for number, data in _fields(file_set) if number == 1]


def set_of(files: list[bytes]) -> bytes:
    """The FileDescriptorSet of these files."""
    return b"".join(_bytes(1, data) for data in files)


def file(name: str, package: str, imports: tuple[str, ...], messages: list[bytes]) -> bytes:
    """A proto3 file."""
    head = _bytes(NAME, name.encode()) + _bytes(PACKAGE, package.encode())
    needs = b"".join(_bytes(DEPENDENCY, path.encode()) for path in imports)
    return head + needs + b"".join(_bytes(MESSAGE, m) for m in messages) + _bytes(SYNTAX, b"proto3")


def message(name: str, fields: list[tuple[str, str]], package: str) -> bytes:
    """A message of fields (name, type), numbered from 1; "double?" is optional, "Name*" a list."""
    made, optional = [], [name for name, kind in fields if kind.endswith("?")]
    for number, (field, kind) in enumerate(fields, start=1):
        data = _field(number, field, kind, package)
        if kind.endswith("?"):
            data += _number(ONEOF_INDEX, optional.index(field)) + _number(OPTIONAL, 1)
        made.append(_bytes(FIELD, data))
    oneofs = [_bytes(ONEOF, _bytes(NAME, f"_{field}".encode())) for field in optional]
    return _bytes(NAME, name.encode()) + b"".join(made + oneofs)


def _field(number: int, name: str, kind: str, package: str) -> bytes:
    head = (
        _bytes(NAME, name.encode())
        + _number(NUMBER, number)
        + _number(LABEL, MANY if kind.endswith("*") else ONE)
    )
    kind = kind.rstrip("?*")
    if kind in SCALARS:
        return head + _number(TYPE, SCALARS[kind])
    full = f".{kind}" if "." in kind else f".{package}.{kind}"
    return head + _number(TYPE, MESSAGE_TYPE) + _bytes(TYPE_NAME, full.encode())


def _file(data: bytes) -> File:
    found: dict[int, list[bytes]] = {}
    for number, value in _fields(data):
        found.setdefault(number, []).append(value)
    names = [_name(dict(reversed(list(_fields(m))))) for m in found.get(MESSAGE, [])]
    package = found.get(PACKAGE, [b""])[0].decode()
    name = _name({number: values[0] for number, values in found.items()})
    return File(name, package, [need.decode() for need in found.get(DEPENDENCY, [])], names, data)


def _name(fields: dict[int, bytes]) -> str:
    if NAME not in fields:
        raise ValueError("it has no name")
    return fields[NAME].decode()


def _fields(data: bytes) -> Iterator[tuple[int, bytes]]:
    """(number, bytes) of each field; numbers are passed over."""
    at = 0
    while at < len(data):
        tag, at = _varint(data, at)
        length, at = _varint(data, at)
        if tag & 7 == BYTES:
            if at + length > len(data):
                raise ValueError("cut off")
            yield tag >> 3, data[at : at + length]
            at += length
        elif tag & 7 != VARINT:
            raise ValueError(f"wire type {tag & 7} has no place here")


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """(value, place behind it)."""
    value = shift = 0
    while at < len(data):
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at
    raise ValueError("cut off")


def _number(number: int, value: int) -> bytes:
    return _packed(number << 3 | VARINT) + _packed(value)


def _bytes(number: int, data: bytes) -> bytes:
    return _packed(number << 3 | BYTES) + _packed(len(data)) + data


def _packed(value: int) -> bytes:
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*out, value])
