"""Messages with a fault in them: how a channel's number sits in a Keelson scalar, a position and a voyage's
row."""

import random
from collections.abc import Callable
from math import cos, isfinite, radians
from typing import Any, NamedTuple

from google.protobuf.message import DecodeError

from twin.errors import UsageError, did_you_mean
from twin.live.injection.inject import KINDS, NEEDS_AMOUNT, InjectedFault, Injector, Report
from twin.live.keelson import messages
from twin.live.keelson.topics import FIX, POSITION, Topic, address, is_own, topic_of
from twin.live.signals.channels import BY_NAME

ROW = "shiptwin.Row"
METRES = 111_320.0  # of a degree of latitude, near enough to be wrong by
SHORT = {
    "position": POSITION,
    "gps": POSITION,
    "heading": ("heading_true_north_deg",),
    "compass": ("heading_true_north_deg",),
    "rudder": ("rudder_angle_deg",),
    "shaft": ("propeller_rate_rpm",),
    "propeller": ("propeller_rate_rpm",),
    "gyro": ("yaw_rate_degps",),
    "speed": ("surge_velocity_mps",),
    "log": ("surge_velocity_through_water_mps",),
    "wind": ("true_wind_speed_mps",),
    "depth": ("water_depth_m",),
}
EVERYTHING = ("bus", "clock")


class Sample(NamedTuple):
    """A message without its envelope, and when it arrives."""

    at_s: float
    key: str
    type_name: str
    payload: bytes


def channels_of(word: str) -> tuple[str, ...]:
    """The channels a word means: a channel's own name, or a short one. UsageError: there is no such word."""
    found = SHORT.get(word) or ((word,) if word in BY_NAME else None)
    if found is None:
        raise UsageError(
            f"no channel is called {word!r}.{did_you_mean(word, [*SHORT, *EVERYTHING, 'pause', 'disk'])}"
        )
    return POSITION if found[0] in POSITION else found


class Faulty:
    """A stream of messages in, the stream with the fault out; everything that is not the channel's passes as
    it is."""

    def __init__(self, what: str, fault: InjectedFault, row_class: Any = messages.Row):
        self.channels = () if what in EVERYTHING else channels_of(what)
        if what not in EVERYTHING:
            if not fault.kind:
                raise UsageError(f"which fault of {what!r}?{did_you_mean('', KINDS)}")
            if fault.kind not in KINDS:
                raise UsageError(f"no fault is called {fault.kind!r}.{did_you_mean(fault.kind, KINDS)}")
            if fault.kind in NEEDS_AMOUNT and not fault.by:
                raise UsageError(
                    f"{fault.kind}: by how much? --by takes a number in the unit of the channel ({what})."
                )
        self.what, self.fault, self._row_class = what, fault, row_class
        self.changed = 0  # messages that are not as they were
        self._random = random.Random(fault.seed)
        self._injectors: dict[str, Injector] = {}  # by key, and in rows by channel
        self._held: dict[str, Callable[[Report], Sample]] = {}

    def feed(self, sample: Sample) -> list[Sample]:
        """What arrives by the time of this message, in order."""
        come = [
            self._held[key](report)
            for key, one in self._injectors.items()
            if key in self._held
            for report in one.due(sample.at_s)
        ]
        if self.what in EVERYTHING:
            return [*come, *self._everything(sample)]
        if sample.type_name == ROW:
            return [self._row(sample)]
        place = address(sample.key)
        topic = topic_of(place) if place and not is_own(place.source) else None
        if topic is None or not set(topic.channels) & set(self.channels):
            return [*come, sample]
        return [*come, *self._message(sample, topic)]

    def _message(self, sample: Sample, topic: Topic) -> list[Sample]:
        opened = _opened_fix(sample.payload) if topic.type_name == FIX else _opened_scalar(sample.payload)
        if opened is None:
            return [sample]
        stamp_s, values, closed = opened
        injector = self._injectors.setdefault(sample.key, Injector(self.fault))

        def said(report: Report) -> Sample:
            payload = (
                self._random.randbytes(len(sample.payload))
                if report.values is None
                else closed(report.stamp_s, report.values)
            )
            return sample._replace(at_s=report.at_s, payload=payload)

        self._held[sample.key] = said
        reports = injector.feed(sample.at_s, stamp_s, values)
        if reports == [Report(sample.at_s, stamp_s, values)]:
            return [sample]
        self.changed += 1
        return [said(report) for report in reports]

    def _row(self, sample: Sample) -> Sample:
        """A row is one sample of all channels: of the reports that have come, the newest stands in it."""
        row = _parsed(self._row_class, sample.payload)
        if row is None:
            return sample
        touched = False
        for name in self.channels:
            field = messages.field_name(name)
            if field not in row.DESCRIPTOR.fields_by_name or not row.HasField(field):
                continue
            true = getattr(row, field)
            injector = self._injectors.setdefault(
                name, Injector(self.fault._replace(seed=self.fault.seed + len(self._injectors)))
            )
            reports = injector.feed(sample.at_s, row.time_s, (true,))
            if reports and reports[-1].values == (true,):
                continue
            touched = True
            row.ClearField(field)
            if reports:
                values = reports[-1].values
                setattr(row, field, self._anything(name) if values is None else values[0])
        self.changed += touched
        return sample._replace(payload=row.SerializeToString()) if touched else sample

    def _anything(self, name: str) -> float:
        channel = BY_NAME[name]
        return self._random.uniform(2.0 * channel.low, 2.0 * channel.high)

    def _everything(self, sample: Sample) -> list[Sample]:
        """Nobody is heard (bus), or every source's clock is off (clock)."""
        if (
            not self.fault.start_s <= sample.at_s < self.fault.start_s + self.fault.seconds
            or sample.type_name == "shiptwin.Tick"
        ):
            return [sample]
        self.changed += 1
        return [] if self.what == "bus" else [sample._replace(payload=self._restamped(sample))]

    def _restamped(self, sample: Sample) -> bytes:
        if sample.type_name == ROW:
            row = _parsed(self._row_class, sample.payload)
            if row is None:
                return sample.payload
            row.time_s += self.fault.by
            return bytes(row.SerializeToString())
        opened = _opened_fix(sample.payload) if sample.type_name == FIX else _opened_scalar(sample.payload)
        if opened is None:
            return sample.payload
        stamp_s, values, closed = opened
        return closed(stamp_s + self.fault.by, values)


Opened = tuple[float, tuple[float, ...], Callable[[float, tuple[float, ...]], bytes]]


def _opened_scalar(payload: bytes) -> Opened | None:
    """(stamp [s], the number, how it is put back) of a Keelson scalar."""
    message = _parsed(messages.Float, payload)
    if message is None:
        return None
    return (
        _stamp_s(message),
        (message.value,),
        lambda stamp_s, values: messages.encode_float(values[0], _ns(stamp_s)),
    )


def _opened_fix(payload: bytes) -> Opened | None:
    """The same of a position, in metres north and east of latitude and longitude zero."""
    message = _parsed(messages.LocationFix, payload)
    if message is None:
        return None
    shrink = max(cos(radians(message.latitude)), 1e-6)

    def closed(stamp_s: float, values: tuple[float, ...]) -> bytes:
        return messages.encode_fix(values[0] / METRES, values[1] / METRES / shrink, _ns(stamp_s))

    return _stamp_s(message), (message.latitude * METRES, message.longitude * METRES * shrink), closed


def _parsed(message_class: Any, payload: bytes) -> Any:
    try:
        return message_class.FromString(payload)
    except DecodeError:
        return None


def _stamp_s(message: Any) -> float:
    return float(message.timestamp.seconds + message.timestamp.nanos * 1e-9)


def _ns(stamp_s: float) -> int:
    return max(round(stamp_s * 1e9), 0)


def fault_of_words(
    what: str, kind: str | None, by: float | None, start_s: float, seconds: float, seed: int
) -> InjectedFault:
    """The fault of these words, checked, its times counted from the start; UsageError where one does not
    fit. `kind` None: the only one that there is of `what`; `by` None: the kind's own."""
    chosen = kind or ("off" if what == "bus" else "wrong" if what == "clock" else "")
    usual = KINDS[chosen].by if chosen in KINDS else 0.0
    fault = InjectedFault(chosen, usual if by is None else by, start_s, seconds, seed)
    if not isfinite(fault.by):
        raise UsageError(f"--by {by}: a finite number is needed.")
    if what == "clock" and not fault.by:
        raise UsageError("clock: by how much? --by takes seconds.")
    if what in EVERYTHING and kind not in (None, "off", "wrong"):
        raise UsageError(f"{what} takes no kind {kind!r}.")
    Faulty(what, fault)  # says what is wrong with it, before anything is opened
    return fault
