"""The calibrated ships that `run` left in its folders, for fits that leave a family out."""

from collections.abc import Sequence
from pathlib import Path

from twin.errors import DataError


def of_families(folders: Sequence[Path]) -> list[Path]:
    """Their files, FAMILY-SEED.pickle. DataError: fewer than two families, of which none can be left out."""
    paths = [path for folder in folders for path in sorted((folder / "ships").glob("*.pickle"))]
    families = len({path.stem.rpartition("-")[0] for path in paths})
    if families < 2:
        raise DataError(f"{folders[0]}: ships of {families} families in ships/; two at least.")
    return paths
