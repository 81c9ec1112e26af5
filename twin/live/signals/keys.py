"""Every key of twin.toml: `section.name`, its kind, default, range, unit and meaning."""

from typing import Any, NamedTuple


class Key(NamedTuple):
    """One setting; `kind` is bool, int, float, str or list (of texts, or of numbers when the default holds
    numbers)."""

    name: str
    kind: type
    default: Any
    doc: str
    unit: str = ""
    low: float = float("-inf")
    high: float = float("inf")


KEYS: tuple[Key, ...] = (
    Key("ship.file", str, "kvlcc2", "ship file, or the name of a bundled ship"),
    Key("loop.rate_hz", float, 10.0, "ticks per second", "Hz", 1.0, 100.0),
    Key("loop.priority", int, 20, "real-time priority (SCHED_FIFO), 0 for none", "", 0, 90),
    Key("loop.cpu", int, -1, "processor the loop is bound to, -1 for any", "", -1, 1023),
    Key("loop.lock_memory", bool, True, "keep the process in memory (mlockall) where allowed"),
    Key(
        "loop.drop_pages",
        bool,
        True,
        "give back clean pages of the libraries after the start (saves about 15 MB)",
    ),
    Key("bus.base", str, "twin", "first part of every key"),
    Key("bus.entity", str, "ship", "the ship's name in every key"),
    Key("bus.listen", str, "tcp/127.0.0.1:7447", 'where the twin listens as a peer, "" for nowhere'),
    Key("bus.connect", list, [], "peers to connect to"),
    Key("bus.router", str, "", "a Zenoh router: makes the twin its client"),
    Key(
        "bus.file",
        str,
        "",
        "a Zenoh file (TLS, access control); what it sets is kept, but for Zenoh's own defaults",
    ),
    Key("log.folder", str, "logs", 'where the logs go, "" for no log'),
    Key("log.segment_mb", float, 256.0, "a new file after this size", "MB", 1.0, 4096.0),
    Key("log.segment_s", float, 900.0, "a new file after this time", "s", 10.0, 86400.0),
    Key(
        "log.keep_days",
        float,
        0.0,
        "finished files older than this are deleted, 0 for never",
        "days",
        0.0,
        36500.0,
    ),
    Key(
        "log.max_mb",
        float,
        20000.0,
        "all files together, the oldest are deleted first, 0 for no limit",
        "MB",
        0.0,
        1e8,
    ),
    Key("log.free_mb", float, 200.0, "what the log leaves free on the disk, 0 for nothing", "MB", 0.0, 1e7),
    Key(
        "sensors.max_delay_s", float, 2.0, "a sample stamped longer ago than this is refused", "s", 0.1, 60.0
    ),
    Key("observer.gain", float, 0.0, "K, 0 for 12 U_0/L or what its certificate asks for", "1/s", 0.0, 20.0),
    Key(
        "observer.inner_steps",
        int,
        0,
        "steps of the model in a period, more than one: samples correct their own time; 0 for the ship's own",
        "",
        0,
        100,
    ),
    Key(
        "observer.oldest_s",
        float,
        0.0,
        "oldest measurement the certificate allows for, 0 for the ship's own",
        "s",
        0.0,
        10.0,
    ),
    Key(
        "observer.certificate",
        str,
        "",
        'where the certificate is kept, "" for state.folder, or without one ~/.cache/shiptwin',
    ),
    Key(
        "residual.file",
        str,
        "",
        'ONNX file of the learned residual, "" for the ship\'s bundled one, "none" for none',
    ),
    Key("residual.required", bool, False, "do not start without a usable residual"),
    Key("adaptation.on", bool, True, "learn slowly on board"),
    Key("adaptation.save_s", float, 60.0, "how often learned numbers are kept", "s", 1.0, 86400.0),
    Key("prediction.horizons_s", list, [10.0, 60.0, 120.0], "how far ahead", "s", 1.0, 3600.0),
    Key("prediction.refresh_s", float, 2.0, "how often, at best", "s", 0.1, 600.0),
    Key(
        "guard.reckoning_s", float, 60.0, "how long the model may run without measurements", "s", 1.0, 3600.0
    ),
    Key("state.folder", str, "", 'where learned numbers are kept between starts, "" for nowhere'),
)
BY_KEY = {key.name: key for key in KEYS}
SOURCES = "sources"  # [sources] channel = "source id": who may speak for a channel
