"""Zenoh's settings: locked down unless a Zenoh file says otherwise.

By default the twin listens on loopback only, finds nobody by itself (no multicast, no gossip), shares no
memory and takes no message larger than a sensor sends. With a router it is a client: two peers behind a
router without gossip exchange nothing, and nothing would say so.

Zenoh's own limit of a rate is not used: all sources of a subject share its clock, so that of two propellers
that speak at the same moment only one is heard. The rings of `zenoh_bus.py` bound what a loop takes.
"""

import json
import os
from typing import Any, NamedTuple

from twin.errors import SettingsError
from twin.live.keelson import endpoint
from twin.live.keelson.topics import OF_ACTUATORS, subjects
from twin.live.signals.config import Settings

MAX_BYTES = 4096  # of one sample
MAX_NAME = 200  # bytes of [bus] base and entity
RETRY = {"period_init_ms": 200, "period_increase_factor": 1.5, "period_max_ms": 1000}

LOCKED: dict[str, Any] = {
    "scouting/multicast/enabled": False,
    "scouting/gossip/enabled": False,
    "transport/shared_memory/enabled": False,
    "transport/unicast/accept_timeout": 2000,  # [ms]
    "transport/unicast/open_timeout": 2000,
    "transport/unicast/accept_pending": 20,
    "transport/unicast/max_sessions": 32,
    "transport/link/tx/lease": 2000,
    "transport/link/tx/batch_size": 16384,
    "transport/link/rx/buffer_size": 16384,
    "transport/link/rx/max_message_size": 262144,
    "connect/retry": RETRY,
    "connect/exit_on_failure": False,
}


class BusSettings(NamedTuple):
    """Where the twin listens and speaks; `router` makes it a client, `file` is a Zenoh file (TLS, access)."""

    base: str = "twin"
    entity: str = "ship"
    listen: str = "tcp/127.0.0.1:7447"
    connect: tuple[str, ...] = ()
    router: str = ""
    file: str = ""
    depth: int = 16  # newest samples kept for each subject between two drains

    @classmethod
    def of(cls, settings: Settings) -> "BusSettings":
        """What the section [bus] says."""
        values = {
            name: settings[f"bus.{name}"]
            for name in ("base", "entity", "listen", "connect", "router", "file")
        }
        return cls(**values | {"connect": tuple(values["connect"])})


def configuration(settings: BusSettings) -> Any:
    """The zenoh.Config for these settings; what a Zenoh file sets stays, the rest is locked down. A value
    that is Zenoh's own default counts as not set: Zenoh tells the two apart nowhere.
    SettingsError: Zenoh refuses a value, or a name or place cannot be one."""
    import zenoh

    _check_names(settings)
    _check_places(settings)
    plain, config = zenoh.Config(), _from_file(settings.file) if settings.file else zenoh.Config()
    for key, value in _wanted(settings, config).items():
        if config.get_json(key) == plain.get_json(key):
            try:
                config.insert_json5(key, json.dumps(value))
            except zenoh.ZError as failure:
                raise SettingsError(
                    f"[bus]: Zenoh refuses {key} = {str(value)[:120]}: {_said(failure)}"
                ) from None
    return config


def beside(settings: BusSettings) -> Any:
    """The zenoh.Config of another session on this computer that reaches the twin of these settings: it
    connects where the twin listens, by the same certificates, and listens nowhere."""
    config = configuration(settings)
    places = json.loads(config.get_json("listen/endpoints"))
    if places and not is_client(config):
        config.insert_json5("connect/endpoints", json.dumps([_here(place) for place in places]))
        config.insert_json5("listen/endpoints", "[]")
    config.insert_json5("access_control/enabled", "false")  # who may come in is the twin's to say
    return config


def _here(endpoint: str) -> str:
    """Where one reaches what listens on every address."""
    return endpoint.replace("/0.0.0.0:", "/127.0.0.1:").replace("/[::]:", "/[::1]:")


def is_client(config: Any) -> bool:
    """Whether the session is a client of a router."""
    return bool(json.loads(config.get_json("mode")) == "client")


def endpoints(config: Any) -> str:
    """Where a configuration listens and connects, for a message."""
    ways = ("connect",) if is_client(config) else ("listen", "connect")
    places = {way: json.loads(config.get_json(f"{way}/endpoints")) for way in ways}
    return ", ".join(f"{way} {' '.join(where)}" for way, where in places.items() if where) or "no endpoint"


def _wanted(settings: BusSettings, config: Any) -> dict[str, Any]:
    client = bool(settings.router) or is_client(config)
    places = [settings.router] if settings.router else list(settings.connect)
    wanted = {"mode": "client" if client else "peer", "connect/endpoints": places, **LOCKED}
    if not client:
        wanted["listen/endpoints"] = [settings.listen] if settings.listen else []
    pattern = f"{settings.base}/@v0/{settings.entity}/pubsub"
    wanted["low_pass_filter"] = [
        {
            "id": "size",
            "flows": ["ingress"],
            "messages": ["put"],
            "key_exprs": [f"{pattern}/{subject}/**" for subject in (*subjects(), *OF_ACTUATORS)],
            "size_limit": MAX_BYTES,
        }
    ]
    return wanted


def _check_names(settings: BusSettings) -> None:
    for field, name in (("base", settings.base), ("entity", settings.entity)):
        if (
            not name
            or name != name.strip("/")
            or "//" in name
            or set(name) & set("*$#?@")
            or not name.isprintable()
        ):
            said = f"[bus] {field} = {name[:80]!r} cannot be part of a key."
            raise SettingsError(f"{said} Use words parted by '/', as in 'a/b'.")
        if len(name.encode()) > MAX_NAME:
            said = f"[bus] {field} = {name[:40]!r}... has {len(name.encode())} bytes"
            raise SettingsError(f"{said}, at most {MAX_NAME} can be part of a key.")


def _check_places(settings: BusSettings) -> None:
    for field, places in (
        ("listen", [settings.listen]),
        ("router", [settings.router]),
        ("connect", settings.connect),
    ):
        for place in places:
            if place or field == "connect":
                endpoint.check(place, field)


def _from_file(path: str) -> Any:
    import zenoh

    if "\0" in path or not os.path.isfile(path):
        raise SettingsError(
            f"{path[:200]!r}: there is no such Zenoh file. Correct [bus] file, or leave it out."
        )
    try:
        return zenoh.Config.from_file(path)
    except zenoh.ZError as failure:
        raise SettingsError(f"{path}: not a Zenoh file: {_said(failure)}") from None
    except BaseException as failure:  # Zenoh is Rust: some files make it panic, which is no Exception here
        if isinstance(failure, (KeyboardInterrupt, SystemExit)):
            raise
        raise SettingsError(f"{path}: not a Zenoh file: {_said(failure)}") from None


def _said(failure: BaseException) -> str:
    """What Zenoh says, in one line and without the places in its sources."""
    return " ".join(str(failure).split(" at /")[0].split())[:300]
