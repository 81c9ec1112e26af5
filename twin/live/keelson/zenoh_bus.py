"""Keelson over Zenoh: subscriptions the loop drains, publishers that drop rather than wait.

No Python callback is registered anywhere: with one, an uncaught exception hangs the interpreter for ever.
Each subject has a ring of its own, so that a flood on one leaves the others alone and what is handed out is
the newest.
"""

import time
from contextlib import suppress
from threading import Event, Thread
from typing import Any

from twin.errors import SettingsError
from twin.live.keelson.bus import BusState, Incoming
from twin.live.keelson.endpoint import may_come
from twin.live.keelson.topics import OWN_SOURCE, key, liveliness_key, subjects
from twin.live.keelson.zenoh_config import MAX_BYTES, BusSettings, configuration, endpoints, is_client

RETRY_S, LONGEST_RETRY_S = 0.5, 2.0  # between two tries to open what is not there yet: first, and at most
NAMESAKE_S = 3.0  # how long another twin that was heard under our name is said
CAUSES = (
    "Possible causes: nobody listens there (is the router running?), a firewall, TLS on one side only, "
    "a wrong or expired certificate or a name that does not match it, a wrong user or password"
)


class ZenohBus:
    """A session that opens at once, or as soon as its router answers, its address is up or its port is free;
    the loop never waits. SettingsError when it can never open."""

    def __init__(self, settings: BusSettings, wanted: list[str] | None = None):
        self._settings = settings
        self._subjects = subjects(wanted)
        self._config = configuration(settings)
        self._client = is_client(self._config)
        self._link: Link | None = None
        self._closing = Event()
        self._why = ""
        self._opened = False  # whether Zenoh ever opened: then it may again
        self._thread: Thread | None = None
        self._received = self._published = self._refused = 0

    def listen_to(self, subjects: list[str]) -> None:
        """Subscribe to these as well; before the bus is opened."""
        self._subjects += [subject for subject in subjects if subject not in self._subjects]

    def __enter__(self) -> "ZenohBus":
        self._try_to_open()
        may_open = self._opened or self._client or may_come(self._why)
        if self._link is None and not may_open:
            raise SettingsError(self._cannot_open())
        if self._link is None:
            self._thread = Thread(target=self._keep_trying, name="bus", daemon=True)
            self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._closing.set()
        if self._thread:
            self._thread.join(1.0)
        if self._link:
            self._link.close()

    def drain(self, now_s: float) -> list[Incoming]:
        """What came in since the last call, received at `now_s` [s]; none while it is not open."""
        if self._link is None:
            return []
        messages, refused = self._link.drain(now_s)
        self._received += len(messages)
        self._refused += refused
        return messages

    def publish(self, key: str, data: bytes) -> None:
        """Send one message; what cannot be sent is counted."""
        if self._link is not None and self._link.publish(key, data):
            self._published += 1
        else:
            self._refused += 1

    @property
    def state(self) -> BusState:
        """How the connection is, with its alarm and its counts."""
        counts = (self._received, self._published, self._refused)
        if self._link is None:
            return BusState(
                False, f"bus: {self._cannot_open()}; trying on, the twin runs without it", 0, 0, *counts
            )
        alarm = self._link.alarm(self._client)
        return BusState(self._link.peers > 0, alarm, self._link.peers, self._link.outages, *counts)

    def _try_to_open(self) -> None:
        import zenoh

        session = None
        try:
            session = zenoh.open(self._config)
            self._opened = True
            self._link = Link(session, self._settings, self._subjects)
        except zenoh.ZError as failure:
            self._why = " ".join(str(failure).split(" at /")[0].split())
        except BaseException as failure:  # Zenoh is Rust: a panic in it is no Exception here
            if isinstance(failure, (KeyboardInterrupt, SystemExit)):
                raise
            self._why = f"{type(failure).__name__}: {' '.join(str(failure).split())}"
        if session is not None and self._link is None:
            with suppress(zenoh.ZError):
                session.close()

    def _keep_trying(self) -> None:
        wait_s = RETRY_S
        while self._link is None and not self._closing.wait(wait_s):
            self._try_to_open()
            wait_s = min(1.5 * wait_s, LONGEST_RETRY_S)

    def _cannot_open(self) -> str:
        where, why = endpoints(self._config), self._why.rstrip("[]!. ") or "no answer yet"
        if "in use" in why:
            return (
                f"cannot open Zenoh ({where}): {why}. Another twin or router has that port: stop it, or "
                "choose another"
            )
        if "assign requested" in why:
            return (
                f"cannot open Zenoh ({where}): {why}. No network card has that address (yet): correct "
                "[bus] listen, or wait"
            )
        return f"cannot open Zenoh ({where}): {why}. {CAUSES}"


class Link:
    """An open session: a ring for each subject, a publisher for each key, a watch on who is connected."""

    def __init__(self, session: Any, settings: BusSettings, wanted: list[str]):
        import zenoh

        self._session = session
        self.outages = 0
        self._lost_at = 0.0
        self._peers: set[str] = set()
        self._publishers: dict[str, Any] = {}
        self._drop = zenoh.CongestionControl.DROP
        self._put = zenoh.SampleKind.PUT
        self._error = zenoh.ZError
        ring = zenoh.handlers.RingChannel
        pattern = f"{settings.base}/@v0/{settings.entity}/pubsub"
        self._depth = settings.depth
        self._rings = [
            session.declare_subscriber(
                f"{pattern}/{subject}/**", ring(settings.depth), allowed_origin=zenoh.Locality.REMOTE
            )
            for subject in wanted
        ]
        own = key(settings.base, settings.entity, "twin_tick", OWN_SOURCE)
        self._namesake = session.declare_subscriber(own, ring(1), allowed_origin=zenoh.Locality.REMOTE)
        self._namesake_until = 0.0
        self._own = f"{settings.base}/@v0/{settings.entity}"
        self._events = session.info.declare_transport_events_listener(ring(64), history=True)
        self._token = session.liveliness().declare_token(liveliness_key(settings.base, settings.entity))

    @property
    def peers(self) -> int:
        """Transports open now."""
        self._watch()
        return len(self._peers)

    def drain(self, now_s: float) -> tuple[list[Incoming], int]:
        """(messages, how many were too large); of each ring what it holds, however fast more comes in."""
        messages: list[Incoming] = []
        refused = 0
        for ring in self._rings:
            for _ in range(self._depth):
                if (sample := ring.try_recv()) is None:
                    break
                payload = sample.payload
                if len(payload) > MAX_BYTES or sample.kind != self._put:
                    refused += 1
                else:
                    messages.append((str(sample.key_expr), payload.to_bytes(), now_s))
        return messages, refused

    def publish(self, key: str, data: bytes) -> bool:
        """Send one message; whether Zenoh took it."""
        try:
            publisher = self._publishers.get(key)
            if publisher is None:
                publisher = self._session.declare_publisher(key, congestion_control=self._drop)
                self._publishers[key] = publisher
            publisher.put(data)
        except self._error:
            return False
        return True

    def alarm(self, client: bool) -> str:
        """What is wrong with the connection, in words."""
        now_s = time.monotonic()
        if self._namesake.try_recv() is not None:
            self._namesake_until = now_s + NAMESAKE_S
        if now_s < self._namesake_until:
            return (
                f"bus: another twin speaks as {self._own}. Stop one of the two, or give it another [bus] "
                "entity"
            )
        if self.peers or not (self.outages or client):
            return ""
        since = f"for {now_s - self._lost_at:.0f} s" if self._lost_at else "since the start"
        who = "the router" if client else "everybody"
        return f"bus: {who} out of reach {since}; it comes back by itself, the twin goes on meanwhile"

    def close(self) -> None:
        """Close the session."""
        with suppress(self._error):
            self._session.close()

    def _watch(self) -> None:
        """Transport events: the only sign of an outage, for put() raises nothing while the router is dead."""
        while (event := self._events.try_recv()) is not None:
            peer = str(event.transport.zid)
            if event.kind == self._put:
                self._peers.add(peer)
                continue
            self._peers.discard(peer)
            if not self._peers:
                self.outages += 1
                self._lost_at = time.monotonic()
