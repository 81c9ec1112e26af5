"""What arrives on board: messages into the decoder, and a whole voyage into the loop that the service builds,
with certificate, residual and adaptation, over pauses, uneven ticks and clocks that are set."""

import os
from collections.abc import Iterator
from copy import deepcopy
from math import hypot, isfinite
from pathlib import Path
from tempfile import gettempdir
from typing import Any

from bench.fuzz.stepped_voyage import CHANNELS, STEP_S, SteppedVoyage
from bench.fuzz.take import Take
from bench.promised_bound import promised_bound
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.keelson import messages, topics
from twin.live.keelson.decode import Decoder, Result
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.channels import BY_NAME
from twin.live.signals.chart import Chart
from twin.live.signals.config import Settings
from twin.live.signals.geodesy import datum
from twin.live.signals.readings import Reading

SHIP, BEGIN_S, WALL, WARM = "kvlcc2", 1000.0, 1.7e9, 150  # warm: ticks before the first decision
TICKS = 60  # at most, for one input
PAUSES = (2, 3, 5, 9, 10, 15, 29, 30, 31, 33, 40, 100, 299, 600, 18000)  # steps of 0.1 s
CLOCKS = (-7200.0, -30.0, -2.5, -1.9, -1.2, -0.4, 0.4, 0.8, 1.2, 1.9, 2.5, 31.0, 3600.0)
SUBJECTS = tuple(t for t in topics.INPUTS)
STAMPS = (0.0, 0.0, 0.0, -0.1, -0.5, -1.2, -5.0, 0.2, 4000.0, -1e9, 1e12)


class Watched(AssertionError):
    """A promise of the loop that was broken."""


class MessageTarget:
    """Key and bytes into the decoder: what comes out is finite, in range, or a refusal with words."""

    def __init__(self) -> None:
        self.keys = [topics.key("twin", "ship", t.subject, "x") for t in SUBJECTS]

    def one(self, data: bytes) -> None:
        take, decoder = Take(data), Decoder(Chart(datum(57.7, 11.9)))
        while take:
            key = take.one_of(self.keys) if take.byte() else take.bytes(60).decode("utf-8", "replace")
            payload = take.bytes(take.byte())
            envelope = messages.wrap(payload, 1_750_000_000_000_000_000) if take.byte() else payload
            for result in decoder.decode(key, envelope, 1.0):
                if not isinstance(result, Reading):
                    _demand(bool(result.why), "a refusal without words")
                    continue
                limits = BY_NAME[result.channel]
                _demand(isfinite(result.value) and limits.low <= result.value <= limits.high, str(result))
                _demand(isfinite(result.time_s), str(result))


class LoopTarget:
    """Decisions into a loop that has sailed for a while; everything it says is looked through."""

    def __init__(self, certificate: Path | None = None) -> None:
        certificate = certificate or Path(gettempdir()) / f"shiptwin-fuzz-{os.getuid()}.json"
        settings = Settings({"ship.file": SHIP, "observer.certificate": str(certificate)})
        self.loop = loop_of(settings, Played([]), Outbox(Publisher(), "twin", "ship"), None)
        tube = self.loop.stabilizer.tube
        assert tube and tube.certificate.ok and self.loop.learned.residual and self.loop.learned.adaptation
        self.sailed, self.shared = SteppedVoyage(self.loop.ship), (self.loop.ship, self.loop.learned.residual)
        sailing = FuzzedVoyage(self, self.loop)
        for _ in range(WARM):
            sailing.tick()
        _demand(sailing.inside > 0, "nothing was promised on a healthy voyage")

    def one(self, data: bytes) -> None:
        loop = deepcopy(self.loop, {id(thing): thing for thing in self.shared})
        sailing = FuzzedVoyage(self, loop, WARM)
        take = Take(data)
        while take and sailing.ticks < TICKS:
            DECISIONS[take.byte() % len(DECISIONS)](sailing, take)
            sailing.tick()


class FuzzedVoyage:
    """One voyage: the ship's step, the clocks, who is silent and who lies."""

    def __init__(self, target: LoopTarget, loop: Loop, k: int = 0):
        self.sailed, self.loop, self.k = target.sailed, loop, k
        self.ticks = self.inside = 0
        self.wall, self.silent, self.off, self.behind = WALL, set[str](), dict[str, float](), 0.0
        self.decoder, self.extra, self.honest = Decoder(Chart(datum(57.7, 11.9))), list[Result](), True
        self.made: list[Result] = []

    @property
    def now_s(self) -> float:
        return BEGIN_S + STEP_S * self.k

    def tick(self) -> None:
        now_s, wall_s = self.now_s, self.wall + self.now_s
        said = self.sailed.said(self.k)
        heard: list[Result] = [
            Reading(name, said[name] + self.off.get(name, 0.0), wall_s - self.behind, now_s, "ship")
            for name in CHANNELS
            if name not in self.silent
        ]
        self.loop.ears.next = heard + self.made  # type: ignore[attr-defined]
        self.made = []
        self._look(self.loop.tick(Instant(self.ticks, now_s, wall_s)))
        self.ticks, self.k = self.ticks + 1, self.k + 1

    def _look(self, tick: messages.Tick) -> None:
        """Finite, inside every bound; and where all instruments are true, the promise is kept."""
        _demand(all(isfinite(x) for x in numbers(tick)), "a number that is not finite")
        learned, e, c = tick.learned, self.loop.observer.estimate, tick.certificate
        _demand(hypot(learned.X_N, learned.Y_N) <= 2.0 * learned.bound_N + 1e-6, "the learned force")
        _demand(abs(learned.N_Nm) <= learned.bound_Nm + 1e-6, "the learned moment")
        _demand(hypot(e.current_north, e.current_east) <= 5.0 + 1e-9, "the current")
        _demand(all(p.horizon_s > 0.0 for p in tick.predictions), "a prediction of what is over")
        _demand(c.bound >= 0.0 and c.yaw_bound_degps >= 0.0, "a bound below zero")
        if c.inside:
            self.inside += 1
            (_, _, _, u, v, r), _ = self.sailed.truth(self.k)
            beta = promised_bound(self.loop)
            errors = abs(e.u - u), abs(e.v - v), abs(e.r - r)
            kept = all(x <= b for x, b in zip(errors, beta, strict=True))
            _demand(kept or not self.honest, f"a promise that is not kept: {errors} {beta}")


def _sail(sailing: FuzzedVoyage, take: Take) -> None:
    for _ in range(min(take.byte() % 20, TICKS - sailing.ticks)):
        sailing.tick()


def _pause(sailing: FuzzedVoyage, take: Take) -> None:
    sailing.k += take.one_of(PAUSES)


def _set_clock(sailing: FuzzedVoyage, take: Take) -> None:
    sailing.wall += take.one_of(CLOCKS)


def _sources_clock(sailing: FuzzedVoyage, take: Take) -> None:
    sailing.behind = take.one_of((0.0, *CLOCKS))


def _silence(sailing: FuzzedVoyage, take: Take) -> None:
    sailing.silent ^= {take.one_of(CHANNELS)}


def _all_silent(sailing: FuzzedVoyage, take: Take) -> None:
    sailing.silent = set() if sailing.silent else set(CHANNELS)


def _lie(sailing: FuzzedVoyage, take: Take) -> None:
    """One instrument is off by up to a quarter of its range."""
    channel = BY_NAME[take.one_of(CHANNELS)]
    sailing.honest = False
    sailing.off[channel.name] = (take.share() - 0.5) * 0.25 * min(channel.high - channel.low, 1e4)


def _message(sailing: FuzzedVoyage, take: Take) -> None:
    """A made-up sample, or anything at all under a true key."""
    topic, source = take.one_of(SUBJECTS), take.one_of(("ship", "b", "twin", "x" * 300))
    stamp_ns = round(max(sailing.wall + sailing.now_s + take.one_of(STAMPS), 0.0) * 1e9)
    kind = take.byte() % 3
    if kind == 0:
        payload = take.bytes(take.byte())
    elif topic.type_name == topics.FIX:
        payload = messages.encode_fix(take.number(), take.number(), stamp_ns)
    else:
        low, high = BY_NAME[topic.channels[0]].low, BY_NAME[topic.channels[0]].high
        payload = messages.encode_float(
            take.number() if kind == 1 else low + (high - low) * take.share(), stamp_ns
        )
    sailing.honest = False
    sailing.made += sailing.decoder.decode(
        topics.key("twin", "ship", topic.subject, source), messages.wrap(payload, stamp_ns), sailing.now_s
    )


DECISIONS = (_sail, _sail, _pause, _set_clock, _sources_clock, _silence, _all_silent, _lie, _message)


def numbers(message: Any) -> Iterator[float]:
    """Every number in a message, however deep."""
    for _, value in message.ListFields():
        plain = isinstance(value, (str, bytes, float, int)) or hasattr(value, "ListFields")
        for one in [value] if plain else value:
            if hasattr(one, "ListFields"):
                yield from numbers(one)
            elif isinstance(one, float):
                yield one


def _demand(kept: bool, what: str) -> None:
    if not kept:
        raise Watched(what)
