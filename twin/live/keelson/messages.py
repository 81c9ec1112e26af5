"""What the twin says and logs: the wide record of one tick, the row of a voyage, and Keelson's envelope.

`Row` has one optional number for each channel of the table; `Tick` holds everything one tick knew. Both are
flat enough to plot by path in Lichtblick, Foxglove and PlotJuggler: `estimate.heading_true_north_deg`,
`known[0].X_N`.
"""

from typing import Any

from twin.live.keelson.schema import Field, apart, classes_from_table, descriptor_set, keelson_class
from twin.live.signals.channels import CHANNELS


def each_channel(kind: str) -> list[Field]:
    """A field of this kind for each channel."""
    return [(channel.name, kind) for channel in CHANNELS]


STATE: list[Field] = [
    ("north_m", "double?"),
    ("east_m", "double?"),
    ("heading_true_north_deg", "double?"),
    ("surge_velocity_mps", "double?"),  # over ground
    ("sway_velocity_mps", "double?"),
    ("yaw_rate_degps", "double?"),
    ("current_north_mps", "double?"),  # the flow the twin believes in, towards
    ("current_east_mps", "double?"),
]
FORCE: list[Field] = [("X_N", "double"), ("Y_N", "double"), ("N_Nm", "double")]

TABLE: dict[str, list[Field]] = {
    # one row of measurements, border units; what is absent was not measured
    "Row": [("time_s", "double"), *each_channel("double?")],
    "Ages": each_channel("double?"),  # [s] since the source's stamp
    "Codes": each_channel("int32?"),  # readings.Quality
    "State": STATE,
    "NamedForce": [("name", "string"), *FORCE],
    "LearnedForce": [
        *FORCE,
        ("bound_N", "double"),
        ("bound_Nm", "double"),
        ("weight", "double"),  # 0 switched off .. 1 inside its training envelope
        ("share", "double"),  # of the whole force, 0..1
    ],
    "Parameter": [
        ("name", "string"),
        ("value", "double"),
        ("low", "double"),
        ("high", "double"),
        ("sigma", "double?"),
        ("unit", "string"),
        ("status", "string"),  # unestimated | estimated | invalid
    ],
    "PredictionTube": [
        ("along_m", "double"),  # half axes of the ellipse around the predicted place
        ("across_m", "double"),
        ("course_deg", "double"),  # the axis "along"
        ("heading_deg", "double"),  # to either side
        ("level", "double"),  # share of errors inside that is promised, 0: no promise
        ("voyages", "int64"),  # that the promise rests on
        ("regime", "string"),
        ("status", "string"),  # calibrated | why not
    ],
    "Prediction": [
        ("horizon_s", "double"),
        ("state", "State"),
        ("sigma", "State"),
        ("age_s", "double"),  # of the estimate it started from
        ("status", "string"),  # of sigma: prior | learned
        ("tube", "PredictionTube"),  # where the ship file has a [tube]
    ],
    "Certificate": [
        ("margin", "double"),
        ("bound", "double"),
        ("inside", "bool"),
        ("yaw_bound_degps", "double"),
        ("step_margin", "double"),  # share of an error that one sample surely takes away, 0 when none does
        ("authority_margin", "double"),  # share of the rudder that the bounds leave, < 0: course not covered
    ],
    # one channel of one actuator of the ship
    "ActuatorChannel": [
        ("name", "string"),
        ("value", "double?"),  # the newest good sample, held until it is stale
        ("age_s", "double?"),
        ("quality", "int32"),  # readings.Quality
    ],
    "Tick": [
        ("index", "int64"),
        ("time_s", "double"),  # monotonic
        ("wall_s", "double"),  # UTC since 1970
        ("mode", "string"),
        ("reasons", "string*"),
        ("rate_hz", "double"),
        ("slack_us", "double?"),  # time left when the step was done; absent in a replay
        ("step_us", "double?"),
        ("overruns", "int64"),  # periods skipped since start
        ("rejected", "int64"),  # samples refused since start
        ("log_dropped", "int64"),  # messages the log had to drop since start
        ("measured", "Row"),  # the newest good sample of each channel, held until it is stale
        ("age_s", "Ages"),
        ("quality", "Codes"),
        ("estimate", "State"),
        ("sigma", "State"),
        ("known", "NamedForce*"),  # by effect, the core first
        ("learned", "LearnedForce"),
        ("parameters", "Parameter*"),
        ("predictions", "Prediction*"),
        ("certificate", "Certificate"),
        ("actuators", "ActuatorChannel*"),  # of a ship that lists its actuators, in the order of its file
    ],
}
Float: Any = keelson_class("keelson.TimestampedFloat")
LocationFix: Any = keelson_class("foxglove.LocationFix")
Vector: Any = keelson_class("keelson.Decomposed3DVector")
String: Any = keelson_class("keelson.TimestampedString")
_CLASSES = classes_from_table("shiptwin", TABLE)
Row: Any = _CLASSES["Row"]
Tick: Any = _CLASSES["Tick"]


def field_name(channel: str) -> str:
    """A channel as a field of a message: `port.rate_rpm` -> `port__rate_rpm`."""
    return channel.replace(".", "__")


def channel_name(field: str) -> str:
    """The other way round."""
    return field.replace("__", ".")


def row_with(channels: list[str]) -> Any:
    """The class of a row that holds these channels of actuators too; Row itself when there are none."""
    if not channels:
        return Row
    fields = [*TABLE["Row"], *((field_name(c), "double?") for c in channels)]
    return apart("shiptwin", {"Row": fields})["Row"]


_TIMESTAMP = "google.protobuf.Timestamp"
Envelope: Any = classes_from_table(
    "core",
    {"Envelope": [("enclosed_at", _TIMESTAMP), ("payload", "bytes")]},
    imports=("google/protobuf/timestamp.proto",),
)["Envelope"]
CLASSES: dict[str, Any] = {c.DESCRIPTOR.full_name: c for c in (Row, Tick, Float, LocationFix, Vector, String)}


def schema_bytes(type_name: str) -> bytes:
    """The FileDescriptorSet of a message type, for the log's schema record."""
    return descriptor_set(CLASSES[type_name] if type_name in CLASSES else keelson_class(type_name))


def wrap(payload: bytes, wall_ns: int) -> bytes:
    """Keelson's envelope around a payload; `wall_ns` is UTC in nanoseconds since 1970."""
    envelope = Envelope(payload=payload)
    stamp(envelope.enclosed_at, wall_ns)
    return envelope.SerializeToString()


def unwrap(data: bytes) -> tuple[int, bytes]:
    """(enclosed at [ns since 1970], payload) of an envelope; raises protobuf's DecodeError on garbage."""
    envelope = Envelope.FromString(data)
    at = envelope.enclosed_at
    return at.seconds * 1_000_000_000 + at.nanos, envelope.payload


def stamp(timestamp: Any, wall_ns: int) -> None:
    """Sets a protobuf Timestamp; faster than its own method."""
    timestamp.seconds, timestamp.nanos = divmod(wall_ns, 1_000_000_000)


def encode_float(value: float, wall_ns: int) -> bytes:
    """keelson.TimestampedFloat."""
    message = Float(value=value)
    stamp(message.timestamp, wall_ns)
    return message.SerializeToString()


def encode_string(value: str, wall_ns: int) -> bytes:
    """keelson.TimestampedString."""
    message = String(value=value)
    stamp(message.timestamp, wall_ns)
    return message.SerializeToString()


def encode_fix(latitude_deg: float, longitude_deg: float, wall_ns: int) -> bytes:
    """foxglove.LocationFix, WGS84."""
    message = LocationFix(latitude=latitude_deg, longitude=longitude_deg)
    stamp(message.timestamp, wall_ns)
    return message.SerializeToString()


def encode_vector(x: float, y: float, z: float, wall_ns: int) -> bytes:
    """keelson.Decomposed3DVector."""
    message = Vector()
    message.vector.x, message.vector.y, message.vector.z = x, y, z
    stamp(message.timestamp, wall_ns)
    return message.SerializeToString()


def fill(message: Any, values: dict[str, float]) -> None:
    """Sets the named fields of a Row, Ages, Codes or State; what is not in `values` stays absent."""
    for name, value in values.items():
        setattr(message, name, value)
