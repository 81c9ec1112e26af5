"""A map that was typed or mended in the page, written when it is a valid one."""

import tempfile
from pathlib import Path

from twin import whole
from twin.errors import SettingsError
from twin.recording.map_file import read_map


def write_map(path: Path, text: str) -> None:
    """The map in its place, whole or not at all. SettingsError where it is none, by the name of its place."""
    with tempfile.NamedTemporaryFile("w", suffix=".toml", encoding="utf-8") as trial:
        trial.write(text)
        trial.flush()
        try:
            read_map(Path(trial.name))
        except SettingsError as error:
            raise SettingsError(str(error).replace(trial.name, path.name)) from None
    whole.write(path, text)
