"""A log that Keelson recorded: scalars by subject and source; two sources of one subject stay apart.

What the twin listens to live is decoded by the same gates; Keelson's other subjects that a motion follows
from (speed and course over ground, magnetic heading, engine) are read beside them.
"""

from pathlib import Path

from google.protobuf.message import DecodeError

from twin.live.keelson import messages
from twin.live.keelson.decode import EARLIEST_S, LATEST_S, Decoder
from twin.live.keelson.topics import BY_SUBJECT, FLOAT, KNOT, address, is_own
from twin.live.log.mcap_read import McapReader
from twin.live.signals.readings import WORDS, Reading
from twin.live.signals.sentinels import is_no_position
from twin.recording.formats.signals import Signals

SAYS = "a log that Keelson recorded"
BESIDE: dict[str, tuple[str, float]] = {
    "speed_over_ground_knots": ("speed_over_ground_mps", KNOT),
    "speed_over_ground_mps": ("speed_over_ground_mps", 1.0),
    "course_over_ground_deg": ("course_over_ground_deg", 1.0),
    "heading_magnetic_deg": ("heading_magnetic_deg", 1.0),
    "magnetic_variation_deg": ("magnetic_variation_deg", 1.0),
    "rate_of_turn_degpm": ("yaw_rate_degps", 1.0 / 60.0),
    "rate_of_turn_degps": ("yaw_rate_degps", 1.0),
    "engine_rate_rpm": ("engine_rate_rpm", 1.0),
    "propeller_pitch_pct": ("propeller_pitch_pct", 1.0),
    "propeller_pitch_rpm": ("propeller_pitch_pct", 1.0),
}


def read(path: Path) -> Signals:
    """Series named subject and source (`heading_true_north_deg/compass/0`)."""
    out, decoder, reader = Signals(path, SAYS), Decoder(), McapReader(path)
    other: dict[str, int] = {}
    for message in reader.messages():
        place = address(message.topic)
        if place is None or is_own(place.source):
            continue
        if place.subject == "location_fix":
            fix(out, place.source, message.data)
        elif place.subject in BY_SUBJECT:
            for result in decoder.decode_stripped(message.topic, message.data, 0.0):
                if isinstance(result, Reading):
                    out.put(
                        f"{result.channel}/{place.source}",
                        place.source,
                        result.channel,
                        result.time_s,
                        result.value,
                    )
                elif result.channel:
                    out.skipped[f"{result.channel}, {WORDS[result.quality]}"] += 1
        elif place.subject in BESIDE or message.type_name == FLOAT:
            scalar(out, place.subject, place.source, message.data)
        else:
            other[place.subject] = other.get(place.subject, 0) + 1
    out.notes += reader.problems
    out.notes += [f"subjects that are not read: {', '.join(sorted(other)[:12])}"] * bool(other)
    return out.finish()


def fix(out: Signals, source: str, data: bytes) -> None:
    """A position as it was sent: latitude and longitude."""
    try:
        message = messages.LocationFix.FromString(data)
    except DecodeError:
        out.skipped["location_fix that cannot be decoded"] += 1
        return
    t = message.timestamp.seconds + message.timestamp.nanos * 1e-9
    latitude, longitude = message.latitude, message.longitude
    if (
        not EARLIEST_S <= t <= LATEST_S
        or is_no_position(latitude, longitude)
        or abs(latitude) > 90.0
        or abs(longitude) > 180.0
    ):
        out.skipped["location_fix without a time stamp or a position"] += 1
        return
    out.put(f"location_fix/{source}.latitude", source, "latitude_deg", t, latitude)
    out.put(f"location_fix/{source}.longitude", source, "longitude_deg", t, longitude)


def scalar(out: Signals, subject: str, source: str, data: bytes) -> None:
    """One message of a subject that has no channel of its own; what cannot be decoded, or has no sound
    stamp, is counted."""
    quantity, scale = BESIDE.get(subject, ("", 1.0))
    try:
        message = messages.Float.FromString(data)
    except DecodeError:
        out.skipped[f"{subject} that cannot be decoded"] += 1
        return
    t = message.timestamp.seconds + message.timestamp.nanos * 1e-9
    if not EARLIEST_S <= t <= LATEST_S:
        out.skipped[f"{subject} without a time stamp"] += 1
        return
    out.put(f"{subject}/{source}", source, quantity, t, message.value * scale)
