"""The study's story on the voyages that come with the twin: it sails badly on Monday; by evening the twin
knows why."""

import json
import shlex
import tempfile
from pathlib import Path

from twin.errors import TwinError

FOLDER = Path(__file__).parent.parent / "voyages"
SHIP, MONDAY, TUESDAY = (FOLDER / name for name in ("tanker.toml", "monday.mcap", "tuesday.mcap"))


def story(folder: Path) -> None:
    """Compare, diagnose, add what the diagnosis names, compare again on a voyage that was not used; each
    command is shown first."""
    folder = Path(tempfile.mkdtemp(prefix="study-", dir=folder))
    answer, page, better = folder / "diagnosis.json", folder / "diagnosis.html", folder / "tanker-better.toml"
    print(
        "\nA tanker, calibrated on calm voyages. On Monday it is not where its twin expects it. How "
        "wrong, and where?"
    )
    _say(f"compare {_q(MONDAY)} --ship {_q(SHIP)}")
    print("\nWhich physical effect is missing?")
    _say(f"diagnose {_q(MONDAY)} --ship {_q(SHIP)} --json {_q(answer)} --report {_q(page)}")
    missing = json.loads(answer.read_text())["missing"]
    if not missing:
        raise TwinError(f"The diagnosis of {MONDAY.name} names nothing; it should. See {answer}.")
    print("\nAdd it, and prove it on Tuesday's voyage, which was not used:")
    _say(
        f"add {' '.join(missing)} --ship {_q(SHIP)} --voyage {_q(MONDAY)} --held-out {_q(TUESDAY)} -o "
        f"{_q(better)}"
    )
    print("\nTuesday again, with the better twin:")
    _say(f"compare {_q(TUESDAY)} --ship {_q(better)}")
    print(f"\nopen {page} in a browser: the same story with plots")


def _say(text: str) -> None:
    """Show a command, then run it."""
    from twin import cli

    print(f"\n$ twin {text}", flush=True)
    code = cli.main(shlex.split(text))
    if code:
        raise TwinError(f"`twin {text}` ended with exit code {code}.")


def _q(path: Path) -> str:
    return shlex.quote(str(path))
