"""Faults of an instrument, made on purpose: what a channel says, and what arrives instead.

Pure: no clock, no socket, no file. `twin fault` puts it on a log or on a live bus, the tests on a loop's
    readings. The
words are PX4's (`failure`), with two more for what a receiver does when it is lied to: drift and noise.
"""

import random
from collections import deque
from collections.abc import Callable
from math import inf
from typing import NamedTuple

from twin.errors import UsageError


class FaultKind(NamedTuple):
    """One way to go wrong: what happens, what `by` means and is unless it is given."""

    doc: str
    unit: str = ""  # of `by`; "channel" for the channel's own
    by: float = 0.0


KINDS: dict[str, FaultKind] = {
    "off": FaultKind("nothing comes any more"),
    "stuck": FaultKind("the last value comes again and again, with fresh stamps"),
    "garbage": FaultKind("random bytes (in a voyage's rows: random numbers)"),
    "wrong": FaultKind("every value is off by so much", "channel"),
    "slow": FaultKind("only one sample in so many comes", "samples", 10.0),
    "delayed": FaultKind("every sample comes so much later, with its own stamp", "s", 3.0),
    "intermittent": FaultKind("so large a share of the samples is lost, at random", "0 to 1", 0.5),
    "drift": FaultKind("every value walks off so fast", "channel per s"),
    "noise": FaultKind("random numbers of this deviation are added", "channel"),
}
ELSE = (
    "what else can be at fault: bus (nobody is heard), clock (every source's clock is off --by s),\n"
    "pause (--pid is stopped --for s), disk (no write of --pid succeeds --for s)"
)
NEEDS_AMOUNT = tuple(name for name, kind in KINDS.items() if kind.unit.startswith("channel"))


def kinds_in_words() -> str:
    """A line for each kind of fault: what happens, and in which unit `by` is; and what else can be at
    fault."""
    lines = [
        f"  {name:13} {kind.doc}{f' (--by, [{kind.unit}])' if kind.unit else ''}"
        for name, kind in KINDS.items()
    ]
    return "\n".join(["kinds:", *lines, "", ELSE])


def check_times(start_s: float, seconds: float) -> None:
    """UsageError unless a fault that begins then and lasts so long [s] can be."""
    if not 0.0 <= start_s < inf or not seconds >= 0.0:
        raise UsageError("--from and --for take seconds, 0 or more.")


class InjectedFault(NamedTuple):
    """A fault of one channel, from `start_s` on for `seconds`, both by the clock that arrivals are told
    by."""

    kind: str
    by: float = 0.0
    start_s: float = 0.0
    seconds: float = inf
    seed: int = 1


class Report(NamedTuple):
    """What arrives: when, stamped when, and the numbers; None for bytes that hold none."""

    at_s: float
    stamp_s: float
    values: tuple[float, ...] | None


class Injector:
    """One channel with its fault. `feed` takes what the instrument said and gives what arrives by then; the
    same samples and the same seed give the same reports."""

    def __init__(self, fault: InjectedFault):
        self.fault = fault
        self._random = random.Random(fault.seed)
        self._held: deque[Report] = deque()
        self._last: tuple[float, ...] | None = None
        self._count, self._began_s = 0, 0.0

    def feed(self, at_s: float, stamp_s: float, values: tuple[float, ...]) -> list[Report]:
        """One sample goes in; the reports that have arrived by `at_s` come out."""
        true = Report(at_s, stamp_s, values)
        if not self.active(at_s):
            self._last = values
            return [*self.due(at_s), true]
        self._count += 1
        made = getattr(self, f"_{self.fault.kind}")(true)
        return [*self.due(at_s), *made]

    def active(self, at_s: float) -> bool:
        """Whether the fault acts on what arrives now."""
        return self.fault.start_s <= at_s < self.fault.start_s + self.fault.seconds

    def due(self, at_s: float) -> list[Report]:
        """Reports that were held back and have arrived by now."""
        come = []
        while self._held and self._held[0].at_s <= at_s:
            come.append(self._held.popleft())
        return come

    def _off(self, true: Report) -> list[Report]:
        return []

    def _stuck(self, true: Report) -> list[Report]:
        self._last = self._last or true.values
        return [true._replace(values=self._last)]

    def _garbage(self, true: Report) -> list[Report]:
        return [true._replace(values=None)]

    def _wrong(self, true: Report) -> list[Report]:
        return [_moved(true, lambda: self.fault.by)]

    def _drift(self, true: Report) -> list[Report]:
        self._began_s = true.at_s if self._count == 1 else self._began_s
        return [_moved(true, lambda: self.fault.by * (true.at_s - self._began_s))]

    def _noise(self, true: Report) -> list[Report]:
        return [_moved(true, lambda: self._random.gauss(0.0, self.fault.by))]

    def _slow(self, true: Report) -> list[Report]:
        return [true] if (self._count - 1) % max(round(self.fault.by), 1) == 0 else []

    def _delayed(self, true: Report) -> list[Report]:
        self._held.append(true._replace(at_s=true.at_s + self.fault.by))
        return []

    def _intermittent(self, true: Report) -> list[Report]:
        return [] if self._random.random() < self.fault.by else [true]


def _moved(true: Report, by: Callable[[], float]) -> Report:
    return true._replace(values=tuple(value + by() for value in true.values or ()))
