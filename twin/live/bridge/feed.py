"""Where the picture comes from: the twin's own words on the bus, or a log of it that is played."""

import json
from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from google.protobuf.message import DecodeError

from twin.errors import DataError, TwinError, UsageError
from twin.live.keelson import messages
from twin.live.keelson.topics import OWN_SOURCE, key
from twin.live.log.mcap_index import PROVENANCE
from twin.live.log.mcap_read import McapReader
from twin.live.provenance import LIVE
from twin.live.signals.config import Settings
from twin.num import as_given

TICK = "shiptwin.Tick"
FIRST = 5000  # messages of a log within which the first tick stands
JUMP_S = 60.0  # a longer hole in a log is jumped over
LOG = "log"
LARGEST = 1e15  # of a number that can be shown
MANY = 200  # entries of a list in a record


class About(NamedTuple):
    """Who speaks; a size of 0 is not known. `origin` is live, replay or log."""

    ship: str = ""
    length_m: float = 0.0
    beam_m: float = 0.0
    version: str = ""
    origin: str = LIVE

    @classmethod
    def of(cls, said: Any, origin: str = "") -> "About":
        """From what a twin or a log says of itself; what is not as it should be is left out."""
        said = said if isinstance(said, dict) else {}
        words = {name: str(said.get(name, ""))[:80] for name in ("ship", "version")}
        sizes = {name: _size(said.get(name)) for name in ("length_m", "beam_m")}
        return cls(**words, **sizes, origin=origin or str(said.get("origin", LIVE))[:20])  # type: ignore[arg-type]


def _size(value: Any) -> float:
    try:
        size = float(value)
    except (TypeError, ValueError):
        return 0.0
    return size if isfinite(size) and 0.0 < size < 1000.0 else 0.0


def sound(message: Any) -> bool:
    """Whether every number in a record is finite and can be shown: the twin says no other, so what holds one
    is not the twin's."""
    for field, value in message.ListFields():
        if field.type == field.TYPE_DOUBLE:
            if not abs(value) < LARGEST:
                return False
            continue
        many = [value] if hasattr(value, "ListFields") or not hasattr(value, "append") else value
        if len(many) > MANY or (field.type == field.TYPE_MESSAGE and not all(map(sound, many))):
            return False
    return True


class BridgeFeed(Protocol):
    """The face every source has."""

    name: str
    about: About
    over: bool  # nothing more can come

    def poll(self, now_s: float) -> list[Any]:
        """The ticks since the last call, the oldest first; never waits. `now_s` is the monotonic time [s]."""
        ...

    def close(self) -> None:
        """Gives back what it holds; no call comes after it."""
        ...


class BusFeed:
    """The twin of these settings on the bus, heard through rings that keep the newest; no callbacks."""

    def __init__(self, settings: Settings):
        import zenoh

        from twin.live.keelson.zenoh_config import BusSettings, beside, endpoints

        config = beside(BusSettings.of(settings))
        self.name, self.about, self.over = endpoints(config).removeprefix("connect "), About(), False
        try:
            self._session = zenoh.open(config)
        except zenoh.ZError as failure:
            said = " ".join(str(failure).split(" at /")[0].split())
            raise TwinError(f"cannot open Zenoh ({self.name}): {said}. Correct --connect or [bus].") from None
        self._ticks, self._identity = (
            self._session.declare_subscriber(
                key(settings["bus.base"], settings["bus.entity"], subject, OWN_SOURCE),
                zenoh.handlers.RingChannel(depth),
            )
            for subject, depth in (("twin_tick", 16), ("configuration_json", 1))
        )

    def poll(self, now_s: float) -> list[Any]:
        """The ticks that the bus brought since the last call; what cannot be decoded or shown is left out."""
        ticks: list[Any] = []
        while (sample := self._identity.try_recv()) is not None:
            self.about = _identity(sample.payload.to_bytes()) or self.about
        while (sample := self._ticks.try_recv()) is not None:
            try:
                tick = messages.Tick.FromString(messages.unwrap(sample.payload.to_bytes())[1])
            except DecodeError:
                continue
            if sound(tick):
                ticks.append(tick)
        return ticks

    def close(self) -> None:
        """Leaves the bus."""
        self._session.close()


def _identity(envelope: bytes) -> About | None:
    try:
        text = messages.String.FromString(messages.unwrap(envelope)[1]).value
        return About.of(json.loads(text))
    except (DecodeError, ValueError, RecursionError):
        return None


class LogFeed:
    """A log of the twin, played `speed` times as fast as it was written."""

    def __init__(self, path: str | Path, speed: float = 1.0):
        if not 0.1 <= speed <= 100.0:
            raise UsageError(f"--speed {as_given(speed)}: 0.1 to 100 times the voyage's own.")
        self.name, self.speed, self.over = Path(path).name, speed, False
        self._reader = McapReader(path)
        self._source = self._reader.messages()
        self._left = self._ticks()
        self._next = next(self._left, None)
        if self._next is None:
            raise DataError(
                f"{path}: no tick of a twin in it. Make one of it: twin replay {path} -o ticks.mcap, "
                "or show it on the bus: twin replay --to-bus."
            )
        self.about = About.of(self._reader.metadata.get(PROVENANCE), LOG)
        self._now_s: float | None = None  # of the last call
        self._time_s = self._next.time_s  # of the voyage

    def poll(self, now_s: float) -> list[Any]:
        """The ticks of the log up to the time that it is played to."""
        self._time_s += self.speed * (now_s - self._now_s) if self._now_s is not None else 0.0
        self._now_s = now_s
        ticks: list[Any] = []
        while (tick := self._next) is not None:
            if not -JUMP_S <= tick.time_s - self._time_s <= JUMP_S:
                self._time_s = tick.time_s
            if tick.time_s > self._time_s:
                break
            ticks.append(tick)
            self._next = next(self._left, None)
        self.over = self._next is None
        return ticks

    def close(self) -> None:
        """Lets the log go, and so its file."""
        self._next, self._left, self._source = None, iter(()), iter(())

    def _ticks(self) -> Iterator[Any]:
        found = False
        for number, message in enumerate(self._source):
            if not found and number > FIRST:
                return
            if message.type_name == TICK:
                try:
                    tick = messages.Tick.FromString(message.data)
                except DecodeError:
                    continue
                if sound(tick):
                    found = True
                    yield tick
