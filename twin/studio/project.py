"""A project: one folder of plain files (logs, maps, ship files), the jobs done on them, and their tags."""

import os
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from twin import whole
from twin.errors import SettingsError, UsageError
from twin.recording.map_toml import toml

SETTINGS = "project.toml"  # the only file that the command line does not read: which voyage is kept for what
JOBS = "jobs"
TAGS = ("reference", "voyage", "held_out")
LONGEST_NAME = 120
NO_TEXT = re.compile("[\ud800-\udfff]")  # in a name on the disk that is not UTF-8
ODD = re.compile(rf"[\x00-\x1f/\\:]|{NO_TEXT.pattern}")
BUNDLED = Path(__file__).parent.parent / "voyages"
ARRAYS = re.compile(r"\.[0-9a-f]{8}\.json$")  # what a calibration found, beside its ship file
KINDS = (  # how a file's name ends, what it is here
    (".toml", "settings"),
    (".mcap", "voyage"),
    (".html", "page"),
    (".onnx", "learned"),
    (".json", "answer"),
)


class Project:
    """The files of one folder, by their bare names; no name leads out of it."""

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = Path(folder).resolve()
        if not self.folder.is_dir():
            raise UsageError(f"{folder}: is no folder. Make it first, or name another.")

    def path(self, name: str) -> Path:
        """The file of that name; SettingsError when it could be any other place than this folder."""
        if not name or ODD.search(name) or name.startswith((".", "-")) or len(name.encode()) > LONGEST_NAME:
            raise SettingsError(f"{name[:80]!r}: is no name of a file here. Use letters, digits, - and _.")
        if name in (SETTINGS, JOBS):
            raise SettingsError(f"{name}: is the project's own. Choose another name.")
        path = self.folder / name
        if path.is_symlink() and path.resolve().parent != self.folder:
            raise SettingsError(f"{name}: points out of the project's folder. Copy the file into it.")
        return path

    def existing(self, name: str) -> Path:
        """The same, when it is there."""
        path = self.path(name)
        if not path.is_file():
            raise SettingsError(f"{name}: is not in this project. Its files are listed under Data.")
        return path

    def new(self, name: str) -> Path:
        """The same, when it is not there yet: nothing is written over."""
        path = self.path(name)
        if path.exists():
            raise SettingsError(f"{name}: is there already and would be lost. Choose another name.")
        return path

    def files(self) -> Iterator[Path]:
        """All but hidden ones, the project's own, and those whose name is no text."""
        for path in sorted(self.folder.iterdir(), key=lambda p: p.name.lower()):
            own = path.name.startswith(".") or path.name == SETTINGS
            if path.is_file() and not own and not NO_TEXT.search(path.name):
                yield path

    def listing(self) -> list[dict[str, Any]]:
        """Every file: name, kind (ship, map, voyage, data ...), size, tag of a voyage."""
        tags = self.tags()
        out = []
        for path in self.files():
            kind = kind_of(path)
            seen = path.stat()
            row: dict[str, Any] = {"name": path.name, "kind": kind, "bytes": seen.st_size}
            row["changed_s"] = round(seen.st_mtime, 3)
            if kind in ("voyage", "data"):
                row["tag"] = tags.get(path.name, "voyage")
            out.append(row)
        return out

    def tags(self) -> dict[str, str]:
        """What each voyage is kept for, as `project.toml` says."""
        path = self.folder / SETTINGS
        try:
            said = tomllib.loads(path.read_text(encoding="utf-8")).get("tags", {}) if path.exists() else {}
        except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise SettingsError(f"{path}: cannot be read: {error}. Mend or remove it.") from None
        return {str(k): str(v) for k, v in said.items() if v in TAGS} if isinstance(said, dict) else {}

    def tag(self, name: str, tag: str) -> None:
        if tag not in TAGS:
            raise SettingsError(f"{tag!r}: a voyage is one of {', '.join(TAGS)}.")
        self.existing(name)
        lines = [f"{toml(k)} = {toml(v)}" for k, v in sorted((self.tags() | {name: tag}).items())]
        head = "# What each voyage of this project is kept for: reference, voyage or held_out.\n[tags]\n"
        whole.write(self.folder / SETTINGS, head + "\n".join(lines) + "\n")

    def take_demo(self) -> list[str]:
        """The bundled tanker and its two voyages, copied where they are not there yet."""
        bundled = sorted(p.name for p in BUNDLED.iterdir() if p.suffix in (".toml", ".mcap", ".json"))
        taken = [name for name in bundled if not self.path(name).exists()]
        for name in taken:
            whole.write_bytes(self.path(name), (BUNDLED / name).read_bytes())
        if "tuesday.mcap" in taken:
            self.tag("tuesday.mcap", "held_out")
        return taken


def kind_of(path: Path) -> str:
    """ship, map, settings, voyage, page, learned, answer, or data to be imported."""
    if ARRAYS.search(path.name):
        return "arrays of a ship"
    kind = next((kind for end, kind in KINDS if path.name.lower().endswith(end)), "data")
    if kind != "settings":
        return kind
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError):
        return "settings"
    return "ship" if "particulars" in tables else "map" if "columns" in tables else "settings"


def text_of(path: Path) -> str:
    """What a file says; SettingsError where it is no text in UTF-8."""
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise SettingsError(
            f"{path.name}: is no text in UTF-8 ({error.reason} at byte {error.start}). Save it as UTF-8."
        ) from None


def unchanged(path: Path, base: Any) -> None:
    """SettingsError when the map on the disk is not the one that a page began with: what another page, or
    another program, wrote meanwhile is not lost."""
    if base is not None and path.exists() and text_of(path) != base:
        raise SettingsError(
            f"{path.name}: was changed meanwhile, in another window or by another program. Look at the file "
            "again, and then change the map."
        )
