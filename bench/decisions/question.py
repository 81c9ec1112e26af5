"""One question of the fixed set, and what is kept of it between runs."""

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from twin.cli import main as main_of_twin
from twin.physics.ship import Ship, load
from twin.recording.voyage import Voyage


@dataclass(frozen=True)
class KnownCase:
    """One question: its name, what is truly there, and how ship and voyages are got."""

    name: str
    truth: dict[str, Any]
    get: Callable[[], tuple[Ship, list[Voyage]]]


def kept(path: Path, make: Callable[[], Any]) -> Any:
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(pickle.dumps(make()))
    return pickle.loads(path.read_bytes())


def begun(name: str, given: dict[str, float], path: Path) -> Ship:
    """A first model from main particulars."""
    words = [w for k, v in given.items() for w in ("--" + k.replace("_", "-"), str(v))]
    if main_of_twin(["init", name, *words, "-o", str(path)]):
        raise RuntimeError(f"{path}: init failed")
    return load(path)
