"""A library of the extra `io`, loaded when a file of its format is opened; without it one line names the
extra."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from types import ModuleType

from twin.errors import SettingsError


def library(name: str, path: Path, says: str) -> ModuleType:
    """The module; SettingsError when it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        top = name.partition(".")[0]
        raise SettingsError(
            f'{path}: this is {says}; reading it needs {top}: pip install "shiptwin[io]".'
        ) from None


def one_line(error: Exception) -> str:
    """What a library says, on one line and not too long."""
    return " ".join(str(error).split())[:160] or type(error).__name__


@contextmanager
def silent() -> Iterator[None]:
    """While it lasts nothing goes to the standard error: a library prints each byte that it stumbles over,
    from C too."""
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
