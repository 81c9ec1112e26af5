"""Files that are there whole or not at all."""

import os
import tempfile
from contextlib import suppress
from pathlib import Path

from twin.errors import TwinError


def write(path: str | os.PathLike[str], text: str, option: str = "-o") -> None:
    """Write aside, to the disk, and rename into place; TwinError (exit code 1) when that cannot be done, and nothing is left behind.
    `option`: what names the file on the command line."""
    path, aside = Path(path), ""
    try:
        with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=f".{path.name}.", delete=False, encoding="utf-8") as file:
            aside = file.name
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(aside, 0o644)
        os.replace(aside, path)
    except OSError as error:
        with suppress(OSError):
            os.unlink(aside)
        raise TwinError(f"{path}: cannot be written ({error.strerror}). Choose another place with {option}.") from None
