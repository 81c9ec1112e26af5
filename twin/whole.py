"""Files that are there whole or not at all."""

import argparse
import errno
import json
import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from twin.errors import SettingsError, TwinError

# in what was asked: option
OUTPUTS = {"output": "-o", "json": "--json", "report": "--report", "markdown": "--markdown", "page": ""}
ASIDE = r"\.{name}\.[0-9a-f]{{12}}"  # pattern of the name that a file has while it is written


def promised(args: argparse.Namespace) -> None:
    """Before any work is done: TwinError (exit code 1) when a file that was asked for could not be written
    where it is to be."""
    for name, option in OUTPUTS.items():
        path = Path(getattr(args, name, None) or "-")
        if path == Path("-"):
            continue
        if why := _not_writable(path):
            raise _cannot(path, why, option or args.page_option)


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


def not_over(output: str, kept: Sequence[str], force: bool) -> None:
    """Before any work is done: SettingsError when `output` is there and is one of the files that are to be
    kept, unless forced: what a calibration found and what people noted in a ship file would be gone."""
    for path in kept if not force and os.path.exists(output) else ():
        if os.path.exists(path) and os.path.samefile(path, output):
            raise SettingsError(
                f"-o {output}: is there already and would be lost. Choose another name, or "
                "write over it with --force."
            )


def not_onto(output: str, sources: Sequence[str], what: str) -> None:
    """Before any work is done: SettingsError when `output` is one of the files that are read; `what` it
    is."""
    for path in sources if os.path.exists(output) else ():
        if os.path.exists(path) and os.path.samefile(path, output):
            raise SettingsError(f"-o {output}: is {what}. Choose another name.")


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
