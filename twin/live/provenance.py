"""Who speaks, and what wrote a log: ship, hash of its model, settings, version."""

import json
from typing import Any

from twin import __version__
from twin.live.learning.residual import ship_hash
from twin.live.signals.config import Settings
from twin.live.signals.keys import KEYS, SOURCES
from twin.physics.ship import Ship

LIVE, REPLAY = "live", "replay"
PLACES = ("bus.listen", "bus.router", "bus.connect")  # settings that hold endpoints


def provenance(settings: Settings, ship: Ship) -> dict[str, str]:
    """The words at the head of each log: software, version, ship, ship_hash, ship_file, length_m, beam_m and
    the settings as JSON by key, without what stands behind the addresses of the bus (it may be a secret)."""
    return {
        "software": "shiptwin",
        "version": __version__,
        "ship": ship.name,
        "ship_hash": ship_hash(ship),
        "ship_file": str(settings["ship.file"]),
        "length_m": f"{ship.L_pp:.9g}",
        "beam_m": f"{ship.B:.9g}",
        "settings": json.dumps(_recorded(settings)),
    }


def identity(ship: Ship, origin: str = LIVE) -> str:
    """What the twin says of itself on the bus, as JSON; `origin` is live or replay."""
    said = {"software": "shiptwin", "version": __version__, "ship": ship.name, "ship_hash": ship_hash(ship)}
    return json.dumps(said | {"length_m": ship.L_pp, "beam_m": ship.B, "origin": origin})


def _recorded(settings: Settings) -> dict[str, Any]:
    """Every setting by its key, the addresses without what stands behind them."""
    values = {key.name: settings[key.name] for key in KEYS}
    for name in PLACES:
        value = values[name]
        values[name] = [_cut(place) for place in value] if isinstance(value, list) else _cut(value)
    return values | {SOURCES: settings.sources}


def _cut(place: str) -> str:
    return place.partition("#")[0].partition("?")[0]
