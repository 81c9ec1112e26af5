"""A stored log always replays to the same numbers: each ship's are on file, and only a change that is meant
changes them.

    python tests/live/test_replayed_states.py      writes them anew; say in the commit why they changed
"""

import json
from pathlib import Path

import pytest

from bench.arm64.states import digest, lines
from twin import voyages
from twin.live.signals.config import Settings

STORED = Path(__file__).with_name("replayed_states.json")
LOG = Path(voyages.__file__).with_name("monday.mcap")
SHIPS = {"tanker": str(LOG.with_name("tanker.toml")), "container": "container", "usv": "usv"}
SECONDS = 20.0


def has_fma() -> bool:
    """Whether this processor multiplies and adds with one rounding, as libm does where it can."""
    about = Path("/proc/cpuinfo")
    text = about.read_text() if about.exists() else ""
    return " fma " in text or "asimd" in text


def states(ship: str, folder: Path) -> str:
    settings = Settings({"ship.file": SHIPS[ship], "observer.certificate": str(folder / f"{ship}.json")})
    return digest(lines(LOG, settings, SECONDS))


@pytest.mark.skipif(
    not has_fma(), reason="a libm without FMA rounds some functions otherwise in the last digit"
)
@pytest.mark.parametrize("ship", SHIPS)
def test_a_stored_log_replays_to_the_numbers_on_file(ship, tmp_path):
    assert states(ship, tmp_path) == json.loads(STORED.read_text())[ship]


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        STORED.write_text(json.dumps({ship: states(ship, Path(folder)) for ship in SHIPS}, indent=2) + "\n")
