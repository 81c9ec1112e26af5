"""Files that are there whole or not at all."""

import argparse
import errno
import json
import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from twin.errors import SettingsError, TwinError

# in what was asked: option
OUTPUTS = {"output": "-o", "json": "--json", "report": "--report", "markdown": "--markdown", "page": ""}
# in what was asked: files that are read
READ = (
    *("voyages", "voyage", "held_out", "reference", "file", "log"),
    *("ship", "map", "residual", "config", "actuators", "fleet"),
)
ASIDE = r"\.{name}\.[0-9a-f]{{12}}"  # pattern of the name that a file has while it is written


def promised(args: argparse.Namespace) -> None:
    """Before any work is done: TwinError (exit code 1) when a file that was asked for could not be written
    where it is to be; SettingsError when it is one that is read, or that another output is written to."""
    told, outputs = vars(args), dict[str, str]()
    for name, option in OUTPUTS.items():
        path = str(told.get(name) or "-")
        if path == "-":
            continue
        option = option or args.page_option
        if why := _not_writable(Path(path)):
            raise _cannot(Path(path), why, option)
        if os.path.isfile(path) or not os.path.exists(path):  # what a device was told is not lost
            _alone(option, path, outputs, told)
            outputs[option] = path


def _alone(option: str, path: str, outputs: Mapping[str, str], told: Mapping[str, Any]) -> None:
    """SettingsError when the file is that of another output or one that is read. A better ship file may take
    the place of the ship file, where that is forced."""
    for other, written in outputs.items():
        if _shared(path, written):
            raise SettingsError(f"{option} {path}: {other} would be written there, too. Choose another name.")
    for name in READ:
        asked = told.get(name)
        better = (option, name) == ("-o", "ship") and "force" in told
        files = asked if isinstance(asked, list | tuple) else [asked]
        for kept in (str(file) for file in files if isinstance(file, str | Path)):  # a bench's are a number
            if os.path.exists(kept) and _shared(path, kept) and not (better and told["force"]):
                forced = ", or write over it with --force" * better
                raise SettingsError(
                    f"{option} {path}: is a file that is read and would be lost. Choose another name{forced}."
                )


def _shared(one: str, other: str) -> bool:
    """Whether two names are of one file, or of one that goes with it: the manifest of a learned residual."""
    return any(_same(a, b) for a in _together(one) for b in _together(other))


def _same(one: str, other: str) -> bool:
    there = os.path.exists(one) and os.path.exists(other)
    return os.path.samefile(one, other) if there else os.path.realpath(one) == os.path.realpath(other)


def _together(path: str) -> list[str]:
    return [path, path.removesuffix(".onnx") + ".json"] if path.endswith(".onnx") else [path]


def _not_writable(path: Path) -> str:
    """Why a file could not be written there; "" where it could. A device or a pipe (/dev/stdout, /dev/fd/63)
    is written into and needs nothing of its folder."""
    if path.is_dir():
        return "it is a folder"
    if path.exists() and not path.is_file():
        return "" if os.access(path, os.W_OK) else "it may not be written to"
    if not path.parent.is_dir():
        return "there is no such folder"
    return "" if os.access(path.parent, os.W_OK) else "its folder may not be written to"


def not_over(output: str, force: bool) -> None:
    """Before any work is done: SettingsError when `output` is there, unless forced: what a calibration found
    and what people noted in a ship file would be gone."""
    if os.path.exists(output) and not force:
        raise SettingsError(
            f"-o {output}: is there already and would be lost. Choose another name, or write over it with "
            "--force."
        )


def _cannot(path: Path, why: str | None, option: str) -> TwinError:
    return TwinError(f"{path}: cannot be written ({why}). Choose another place with {option}.")


def write(path: str | os.PathLike[str], text: str, option: str = "-o") -> None:
    """The same as `write_bytes`, of a text in UTF-8."""
    write_bytes(path, text.encode(), option)


def write_bytes(path: str | os.PathLike[str], data: bytes, option: str = "-o") -> None:
    """Write aside, to the disk, and rename into place; TwinError (exit code 1) when that cannot be done, and
    nothing is left behind.
    `option`: what names the file on the command line."""
    path = Path(path)
    if path.exists() and not path.is_file():  # a device or a pipe: a rename would put a file in its place
        _into(path, data, option)
        return
    aside = path.parent / f".{path.name}.{os.urandom(6).hex()}"  # ASIDE
    try:
        with open(aside, "xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(aside, 0o644)
        os.replace(aside, path)
    except OSError as error:
        with suppress(OSError):
            os.unlink(aside)
        raise _cannot(path, error.strerror, option) from None


def _into(path: Path, data: bytes, option: str) -> None:
    try:
        path.write_bytes(data)
    except OSError as error:
        raise _cannot(path, error.strerror, option) from None


def put(path: str, text: str, option: str) -> None:
    """To standard output for '-', else into a file, with one end of line at its end."""
    if path == "-":
        print(text)
        return
    write(path, text.rstrip("\n") + "\n", option)


def write_json(result: Any, path: str, option: str = "--json") -> None:
    """The same of what JSON can hold."""
    put(path, json.dumps(result, indent=2), option)


def read(path: str | os.PathLike[str], most: int) -> bytes:
    """The file's bytes; OSError when it cannot be read or is longer than `most` bytes (a device has no
    end)."""
    try:
        with open(path, "rb") as file:
            data = file.read(most + 1)
    except ValueError as error:  # a name with a zero byte in it
        raise OSError(errno.EINVAL, str(error), str(path)) from None
    if len(data) > most:
        raise OSError(errno.EFBIG, f"longer than {most} bytes", str(path))
    return data
