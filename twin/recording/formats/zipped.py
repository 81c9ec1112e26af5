"""A .zip: its tables or its log, unpacked aside for as long as they are read."""

import zipfile
from pathlib import Path

from twin.errors import DataError

MOST_BYTES, MOST_FILES = 8 << 30, 200
PIECE = 1 << 20


def is_zip(path: Path) -> bool:
    """Whether a path is a .zip."""
    return path.suffix.lower() == ".zip" and path.is_file()


def unpacked(path: Path, folder: Path) -> list[Path]:
    """The files in a .zip, written under their own names into `folder`; DataError for one that is damaged or
    far too large."""
    out: list[Path] = []
    left = MOST_BYTES
    try:
        with zipfile.ZipFile(path) as packed:
            members = [
                m
                for m in packed.infolist()
                if not m.is_dir() and not Path(m.filename).name.startswith((".", "__"))
            ]
            if not members or len(members) > MOST_FILES:
                raise DataError(
                    f"{path}: holds {len(members)} files; 1 to {MOST_FILES} can be read. Unpack it and "
                    "choose."
                )
            for number, member in enumerate(members):
                place = (
                    folder / str(number) if any(p.name == Path(member.filename).name for p in out) else folder
                )
                place.mkdir(exist_ok=True)
                to = place / Path(member.filename).name
                with packed.open(member) as source, open(to, "wb") as aside:
                    while piece := source.read(PIECE):
                        left -= len(piece)
                        if left < 0:
                            raise DataError(
                                f"{path}: unpacks to more than {MOST_BYTES >> 30} GB. Unpack it and cut it "
                                "into shorter voyages."
                            )
                        aside.write(piece)
                out.append(to)
    except (zipfile.BadZipFile, OSError, RuntimeError, NotImplementedError, EOFError, ValueError) as error:
        raise DataError(f"{path}: this is a .zip that cannot be unpacked: {str(error)[:120]}.") from None
    return out
