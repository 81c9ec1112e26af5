"""What the loop sees of the outside world: messages in without waiting, messages out without waiting.

`MemoryBus` is the bus of a test or a replay: two lists. `twin.live.keelson.zenoh_bus.ZenohBus` is the real
one."""

from typing import NamedTuple, Protocol

Incoming = tuple[str, bytes, float]  # key, bytes with their envelope, monotonic time it was taken [s]


class BusState(NamedTuple):
    """How the bus fares: the alarm in words ("" when there is none), who is connected, what it counted."""

    connected: bool
    alarm: str
    peers: int
    outages: int
    received: int
    published: int
    refused: int  # too large, or could not be sent


class Bus(Protocol):
    """The face every bus has."""

    def __enter__(self) -> "Bus": ...

    def __exit__(self, *_: object) -> None: ...

    def listen_to(self, subjects: list[str]) -> None:
        """Hear these subjects as well; before it is opened."""
        ...

    def drain(self, now_s: float) -> list[Incoming]:
        """Everything that came in since the last call; never waits. `now_s` is the monotonic time [s]."""
        ...

    def publish(self, key: str, data: bytes) -> None:
        """Sends one message (with its envelope); never waits, never raises: what fails is counted."""
        ...

    @property
    def state(self) -> BusState:
        """How the connection is, with its alarm and its counts."""


class MemoryBus:
    """A bus made of two lists: `put` what shall come in, read `sent` for what went out."""

    def __init__(self) -> None:
        self.waiting: list[tuple[str, bytes]] = []
        self.sent: list[tuple[str, bytes]] = []
        self._received = 0

    def __enter__(self) -> "MemoryBus":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def listen_to(self, subjects: list[str]) -> None:
        """It hears all that is put."""

    def put(self, key: str, data: bytes) -> None:
        """Let a message come in."""
        self.waiting.append((key, data))

    def drain(self, now_s: float) -> list[Incoming]:
        """What was put since the last call, received at `now_s` [s]."""
        taken, self.waiting = self.waiting, []
        self._received += len(taken)
        return [(key, data, now_s) for key, data in taken]

    def publish(self, key: str, data: bytes) -> None:
        """Keep one message in `sent`."""
        self.sent.append((key, data))

    @property
    def state(self) -> BusState:
        """Connected, with its counts."""
        return BusState(True, "", 1, 0, self._received, len(self.sent), 0)
