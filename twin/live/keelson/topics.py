"""The one table between channels and the bus: which subject carries which channel, and what the twin says.

Keys are Keelson's: {base}/@v0/{entity}/pubsub/{subject}/{source_id}. A channel's subject is Keelson's where
Keelson has one; the twin's own subjects follow its naming rule (quantity, frame, unit).
"""

from collections.abc import Collection
from typing import NamedTuple

from twin.errors import SettingsError, did_you_mean
from twin.live.signals.channels import BY_NAME, CHANNELS
from twin.physics.actuators.actuator_channels import CHANNELS_OF

OWN_SOURCE = "twin"  # what the twin says carries this source id; it never listens to it
KNOT = 1852.0 / 3600.0  # [m/s]


class Topic(NamedTuple):
    """A subject the twin listens to, and the channels it fills (value x `factor` = border unit)."""

    subject: str
    type_name: str
    channels: tuple[str, ...]
    factor: float = 1.0


class Output(NamedTuple):
    """A subject the twin publishes; `every_s` 0 means each tick, else the least time between two messages."""

    subject: str
    type_name: str
    source: str
    every_s: float
    doc: str


FLOAT, FIX, VECTOR = "keelson.TimestampedFloat", "foxglove.LocationFix", "keelson.Decomposed3DVector"
STRING = "keelson.TimestampedString"
SUBJECT_OF = {"wave_direction_deg": "wave_true_direction_deg"}  # Keelson's name, not the column's
POSITION = ("north_m", "east_m")

INPUTS: tuple[Topic, ...] = (
    Topic("location_fix", FIX, POSITION),
    *(Topic(SUBJECT_OF.get(c.name, c.name), FLOAT, (c.name,)) for c in CHANNELS if c.name not in POSITION),
    Topic("speed_through_water_knots", FLOAT, ("surge_velocity_through_water_mps",), KNOT),
)
BY_SUBJECT: dict[str, Topic] = {topic.subject: topic for topic in INPUTS}
# of a ship's actuators, by the last part of the channel's name; which of them begins the source id
OF_ACTUATORS: dict[str, str] = {f"actuator_{last}": last for last in CHANNELS_OF}
# Keelson's own, heard as well where the source id begins with the name of one of the ship's actuators
ALIKE = {"propeller_rate_rpm": "rate_rpm", "rudder_angle_deg": "angle_deg"}

OUTPUTS: tuple[Output, ...] = (
    Output("twin_tick", "shiptwin.Tick", "twin", 0.0, "everything one tick knew"),
    Output("location_fix", FIX, "twin/estimate", 1.0, "estimated position, WGS84"),
    Output("heading_true_north_deg", FLOAT, "twin/estimate", 0.5, "estimated heading"),
    Output("surge_velocity_mps", FLOAT, "twin/estimate", 0.5, "estimated speed ahead over ground"),
    Output("sway_velocity_mps", FLOAT, "twin/estimate", 0.5, "estimated speed to starboard over ground"),
    Output("yaw_rate_degps", FLOAT, "twin/estimate", 0.5, "estimated rate of turn"),
    Output("force_newton", VECTOR, "twin/known", 1.0, "sum of the known forces, body axes (X, Y, 0)"),
    Output("moment_newton_meter", VECTOR, "twin/known", 1.0, "sum of the known moments (0, 0, N)"),
    Output("force_newton", VECTOR, "twin/learned", 1.0, "learned force, body axes (X, Y, 0)"),
    Output("moment_newton_meter", VECTOR, "twin/learned", 1.0, "learned moment (0, 0, N)"),
    Output("twin_status", STRING, "twin", 1.0, "mode and reasons in words"),
    Output("configuration_json", STRING, "twin", 1.0, "who speaks: ship, hash, size, version, origin"),
)


class Address(NamedTuple):
    """The parts of a key."""

    base: str
    entity: str
    subject: str
    source: str


def key(base: str, entity: str, subject: str, source: str) -> str:
    """The key of a subject from one source."""
    return f"{base}/@v0/{entity}/pubsub/{subject}/{source}"


def liveliness_key(base: str, entity: str, source: str = OWN_SOURCE) -> str:
    """The key of the token that says a source is alive."""
    return f"{base}/@v0/{entity}/pubsub/*/{source}"


def address(text: str) -> Address | None:
    """The parts of a Keelson key, or None when it is not one."""
    head, found, tail = text.partition("/pubsub/")
    base, versioned, entity = head.partition("/@v0/")
    subject, has_source, source = tail.partition("/")
    if not (found and versioned and has_source and base and entity and subject and source):
        return None
    return Address(base, entity, subject, source)


def topic_of(place: Address, actuators: Collection[str] | None = None) -> Topic | None:
    """What a key carries. `actuators`: the channels of the ship's own, beside which there are none; None
    where the ship is not known, so that any name may be one's."""
    name = place.source.partition("/")[0]
    if last := OF_ACTUATORS.get(place.subject):
        channel = f"{name}.{last}"
        known = channel in (BY_NAME if actuators is None else actuators)
        return Topic(place.subject, FLOAT, (channel,)) if known else None
    if actuators and (channel := f"{name}.{ALIKE.get(place.subject)}") in actuators:
        return Topic(place.subject, FLOAT, (channel,))
    return BY_SUBJECT.get(place.subject)


def actuator_subjects(channels: Collection[str]) -> list[str]:
    """Subjects that carry these channels of actuators, beside those that every ship's twin listens to."""
    lasts = {channel.rpartition(".")[2] for channel in channels}
    return [subject for subject, last in OF_ACTUATORS.items() if last in lasts]


def subjects(wanted: list[str] | None = None) -> list[str]:
    """Subjects to subscribe to: all the twin knows, or those that fill the `wanted` channels.
    SettingsError: no topic fills one of these."""
    if wanted is None:
        return [topic.subject for topic in INPUTS]
    known = {channel for topic in INPUTS for channel in topic.channels}
    for name in wanted:
        if name not in known:
            raise SettingsError(f"No topic fills the channel {name!r}.{did_you_mean(name, known)}")
    return [topic.subject for topic in INPUTS if set(topic.channels) & set(wanted)]


def is_own(source: str) -> bool:
    """Whether a source id is the twin's own voice (an estimate taken for a measurement feeds on itself)."""
    return source == OWN_SOURCE or source.startswith(OWN_SOURCE + "/")
