"""From bytes on a key to readings: parsing is not validation, so every sample must earn its place.

A protobuf with one flipped bit still parses more often than not, and the empty message parses always. A
sample counts only with a time stamp, of the right type, finite, in range and no sender's code for "not
available". These gates have no memory; those that need the sample before (jump, frozen, stale, duplicate ...)
are in `sensors.py`.
"""

from collections.abc import Collection
from math import hypot, inf, isfinite
from typing import Any, NamedTuple

from google.protobuf.message import DecodeError
from google.protobuf.unknown_fields import UnknownFieldSet

from twin.live.keelson import messages
from twin.live.keelson.topics import FIX, Topic, address, is_own, topic_of
from twin.live.signals.channels import BY_NAME
from twin.live.signals.chart import Chart
from twin.live.signals.geodesy import MAX_DISTANCE_M, MAX_LATITUDE_DEG, datum
from twin.live.signals.readings import Quality, Reading, Rejected
from twin.live.signals.sentinels import is_no_position, is_sentinel
from twin.num import as_given

EARLIEST_S = 946684800.0  # 2000-01-01: an earlier stamp is a clock that was never set
LATEST_S = 4102444800.0  # 2100-01-01: a later stamp is garbage
MAX_BYTES = 4096  # no sample the twin reads is longer
NEAR_M = 1000.0  # two positions this near confirm each other
FAR_S = 3600.0  # without a position nearer than MAX_DISTANCE_M, after which one that is farther counts
MAX_KEYS = 512  # how many keys are remembered: a hostile sender cannot fill the memory

Result = Reading | Rejected


class Taken(NamedTuple):
    """What a message gave, and its payload for the log (no type: there is nothing to keep)."""

    results: list[Result]
    type_name: str = ""
    payload: bytes = b""


class Refuse(Exception):
    """A sample that may not be used, with its code and the reason in words."""

    def __init__(self, quality: Quality, why: str):
        super().__init__(why)
        self.quality = quality


class Decoder:
    """Bytes in, readings or rejections out.

    Holds the voyage's chart: given, or begun at the first position that the next one agrees with (one wild
    first fix would otherwise put the whole voyage outside it). Who knows where the ship is moves it along.
    """

    def __init__(self, chart: Chart | None = None, actuators: Collection[str] | None = None):
        """actuators: channels of the ship's own; None where the ship is not known."""
        self.chart, self.actuators = chart, actuators
        self._first: tuple[float, float] | None = None
        self._near_s = inf  # when a position was last on the chart
        self._keys: dict[str, tuple[Topic | None, str]] = {}

    def decode(self, key: str, envelope: bytes, received_s: float) -> list[Result]:
        """What one message from the bus holds; the twin's own voice gives nothing."""
        return self.take(key, envelope, received_s).results

    def take(self, key: str, envelope: bytes, received_s: float) -> Taken:
        """The same, with what is to be logged of it."""
        topic, source = self._topic(key)
        if topic is None:
            unknown = Rejected("", Quality.UNKNOWN_KEY, f"key {key[:120]!r}", received_s, source)
            return Taken([] if is_own(source) else [unknown])
        if len(envelope) > MAX_BYTES:
            why = f"{len(envelope)} bytes, at most {MAX_BYTES} expected"
            return Taken(_reject(topic, Quality.GARBAGE, why, received_s, source))
        try:
            payload = messages.Envelope.FromString(envelope).payload
        except DecodeError as error:
            return Taken(_reject(topic, Quality.GARBAGE, f"no envelope: {error}", received_s, source))
        return Taken(self._payload(topic, source, payload, received_s), topic.type_name, payload)

    def decode_stripped(self, key: str, payload: bytes, received_s: float) -> list[Result]:
        """The same for a logged message, which has no envelope."""
        topic, source = self._topic(key)
        if topic is None:
            return []
        return self._payload(topic, source, payload, received_s)

    def _topic(self, key: str) -> tuple[Topic | None, str]:
        known = self._keys.get(key)
        if known is None:
            place = address(key)
            source = place.source if place else ""
            known = (topic_of(place, self.actuators) if place and not is_own(source) else None, source)
            if len(self._keys) < MAX_KEYS:
                self._keys[key] = known
        return known

    def _payload(self, topic: Topic, source: str, payload: bytes, received_s: float) -> list[Result]:
        fix = topic.type_name == FIX
        try:
            time_s, values = self._fix(topic, payload, received_s) if fix else _scalar(topic, payload)
        except Refuse as refusal:
            return _reject(topic, refusal.quality, str(refusal), received_s, source)
        if len(values) == 1:
            return [Reading(topic.channels[0], values[0], time_s, received_s, source)]
        return [
            Reading(channel, value, time_s, received_s, source)
            for channel, value in zip(topic.channels, values, strict=True)
        ]

    def _fix(self, topic: Topic, payload: bytes, received_s: float) -> tuple[float, tuple[float, ...]]:
        message = _parse(messages.LocationFix, payload)
        latitude, longitude = message.latitude, message.longitude
        unknown = {field.field_number for field in UnknownFieldSet(message)}
        if unknown and (min(unknown) <= 7 or not (latitude and longitude)):
            raise Refuse(Quality.WRONG_TYPE, f"field {min(unknown)} is not {topic.type_name}'s")
        time_s = _stamp(message)
        if not (isfinite(latitude) and isfinite(longitude)):
            raise Refuse(Quality.NOT_FINITE, f"latitude {latitude}, longitude {longitude}")
        if is_no_position(latitude, longitude):
            raise Refuse(Quality.SENTINEL, f"latitude {latitude}, longitude {longitude}: 'no position'")
        if not (-90.0 <= latitude <= 90.0 and -180.0 <= longitude <= 360.0):
            raise Refuse(Quality.OUT_OF_RANGE, f"latitude {latitude}, longitude {longitude}")
        return time_s, self._on_chart(latitude, longitude, received_s)

    def _on_chart(self, latitude: float, longitude: float, received_s: float) -> tuple[float, float]:
        if abs(latitude) > MAX_LATITUDE_DEG:
            raise Refuse(Quality.OUTSIDE_AREA, f"latitude {latitude}, beyond {MAX_LATITUDE_DEG}")
        chart = self.chart
        place = chart.place(latitude, longitude) if chart else None
        if place is None:
            if chart and not received_s - self._near_s > FAR_S:
                where = f"the ship's last place {chart.at.latitude_deg:.4f}, {chart.at.longitude_deg:.4f}"
                far = f"more than {MAX_DISTANCE_M / 1e3:.0f} km from {where}"
                raise Refuse(Quality.OUTSIDE_AREA, f"{latitude:.4f}, {longitude:.4f} is {far}")
            self.chart, place = self._begun(latitude, longitude)
        self._near_s = received_s
        return place

    def _begun(self, latitude: float, longitude: float) -> tuple[Chart, tuple[float, float]]:
        """A chart that touches the earth at the position before this one, and this one's place on it, when
        the two are near each other."""
        first, self._first = self._first, (latitude, longitude)
        if first is not None:
            chart = self.chart.afar(*first) if self.chart else Chart(datum(*first))
            place = chart.place(latitude, longitude)
            if place is not None and hypot(place[0] - chart.north_m, place[1] - chart.east_m) <= NEAR_M:
                return chart, place
        raise Refuse(
            Quality.UNCONFIRMED, f"{latitude:.4f}, {longitude:.4f} waits for a second position near it"
        )


def check(channel: str, value: float) -> Quality:
    """The gate without memory for one value in border units: finite, in range, no sentinel."""
    if not isfinite(value):
        return Quality.NOT_FINITE
    limits = BY_NAME[channel]
    outside = not limits.low <= value <= limits.high
    if is_sentinel(channel, value, outside):
        return Quality.SENTINEL
    return Quality.OUT_OF_RANGE if outside else Quality.OK


def from_row(row: Any, time_s: float, received_s: float, source: str) -> list[Result]:
    """Readings of a logged Row, with the same gate; `time_s` is their stamp [s, UTC or the voyage's own]."""
    results: list[Result] = []
    for field, value in row.ListFields():
        name = messages.channel_name(field.name)
        if name not in BY_NAME:
            continue
        quality = check(name, value)
        if quality is Quality.OK:
            results.append(Reading(name, value, time_s, received_s, source))
        else:
            results.append(Rejected(name, quality, _number(name, value), received_s, source))
    return results


def _scalar(topic: Topic, payload: bytes) -> tuple[float, tuple[float, ...]]:
    message = _parse(messages.Float, payload)
    if len(UnknownFieldSet(message)):
        raise Refuse(Quality.WRONG_TYPE, f"not a {topic.type_name}")
    time_s = _stamp(message)
    value = message.value * topic.factor
    quality = check(topic.channels[0], value)
    if quality is not Quality.OK:
        raise Refuse(quality, _number(topic.channels[0], value))
    return time_s, (value,)


def _parse(message_class: Any, payload: bytes) -> Any:
    try:
        return message_class.FromString(payload)
    except DecodeError as error:
        raise Refuse(Quality.GARBAGE, str(error)) from None


def _stamp(message: Any) -> float:
    """The source's time stamp, or a refusal: no stamp, one from before 2000, one from after 2100."""
    timestamp = message.timestamp
    seconds, nanos = timestamp.seconds, timestamp.nanos
    if seconds < EARLIEST_S:
        if not message.HasField("timestamp"):
            raise Refuse(Quality.NO_TIMESTAMP, "no time stamp")
        raise Refuse(Quality.NO_TIMESTAMP, f"stamped {seconds} s after 1970, before the year 2000")
    if seconds > LATEST_S or not 0 <= nanos < 1_000_000_000:
        raise Refuse(Quality.GARBAGE, f"stamped {seconds} s and {nanos} ns after 1970")
    return seconds + nanos * 1e-9


def _number(channel: str, value: float) -> str:
    limits = BY_NAME[channel]
    return f"{channel} = {as_given(value)}, expected {as_given(limits.low)} to {as_given(limits.high)}"


def _reject(topic: Topic, quality: Quality, why: str, received_s: float, source: str) -> list[Result]:
    return [Rejected(channel, quality, why, received_s, source) for channel in topic.channels]
