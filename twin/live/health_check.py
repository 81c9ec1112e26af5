"""`twin health`: is the twin on this computer alive and well? Listens for a moment to what it says."""

import argparse
import json
import time
from typing import Any

from google.protobuf.message import DecodeError

from twin import whole
from twin.errors import UsageError
from twin.live.guard import HYBRID, PHYSICS
from twin.live.keelson import messages
from twin.live.keelson.topics import OWN_SOURCE, key
from twin.live.signals import config
from twin.live.signals.config import Settings
from twin.num import as_given

SCHEMA_VERSION = 1


def ask(args: argparse.Namespace) -> int:
    """Listen, judge, tell; the exit code. UsageError: a timeout that is out of range."""
    if not 0.0 < args.timeout <= 3600.0:
        raise UsageError(f"--timeout {as_given(args.timeout)}: more than 0 and at most 3600 s.")
    tick = hear(config.load(args.config), args.timeout)
    code, said = health(tick)
    _tell(said, tick, code, args.json)
    return code


def hear(settings: Settings, timeout_s: float) -> Any:
    """The newest tick that comes within the time, None when none does."""
    import zenoh

    from twin.live.keelson.zenoh_config import BusSettings, beside

    try:
        session = zenoh.open(beside(BusSettings.of(settings)))
    except zenoh.ZError:
        return None
    ring: Any = zenoh.handlers.RingChannel(1)
    topic = key(settings["bus.base"], settings["bus.entity"], "twin_tick", OWN_SOURCE)
    ears = session.declare_subscriber(topic, ring)
    until = time.monotonic() + timeout_s
    while time.monotonic() < until:
        sample = ears.try_recv()
        if sample is not None:
            try:
                return messages.Tick.FromString(messages.unwrap(sample.payload.to_bytes())[1])
            except DecodeError:
                continue
        time.sleep(0.02)
    return None


def health(tick: Any) -> tuple[int, str]:
    """(exit code, one line): 0 when the twin runs on measurements, 1 when it does not or is not heard."""
    if tick is None:
        return 1, "not heard: is it running, and does it use these settings? See: systemctl status shiptwin"
    reasons = "; ".join(tick.reasons) or "all well"
    lost = f", {tick.log_dropped} messages not logged" if tick.log_dropped else ""
    said = (
        f"{tick.mode}, {as_given(tick.rate_hz)} Hz, {skipped(tick)}, {tick.rejected} samples refused{lost}: "
        f"{reasons}"
    )
    return (0 if tick.mode in (HYBRID, PHYSICS) else 1), said


def skipped(tick: Any) -> str:
    """Periods that the loop had to skip since its start, and their share."""
    share = tick.overruns / max(tick.index + 1 + tick.overruns, 1)
    return f"{tick.overruns} periods skipped" + (f" ({100.0 * share:.1f} %)" if tick.overruns else "")


def _tell(said: str, tick: Any, code: int, path: str | None) -> None:
    if path is None:
        print(said)
        return
    table = {
        "schema_version": SCHEMA_VERSION,
        "healthy": code == 0,
        "mode": tick.mode if tick else "",
        "text": said,
    }
    if tick:
        table |= {
            "reasons": list(tick.reasons),
            "overruns": tick.overruns,
            "rejected": tick.rejected,
            "log_dropped": tick.log_dropped,
            "rate_hz": tick.rate_hz,
        }
    text = json.dumps(table, indent=2)
    if path == "-":
        print(text)
    else:
        whole.write(path, text + "\n", "--json")
