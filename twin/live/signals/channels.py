"""The one table of channels: what a ship can measure, its name, unit, plausible range and how fast it grows
old.

A channel's name is its CSV column, its field in the wide log record and, where Keelson has one, its subject.
"""

import re
from dataclasses import dataclass
from math import inf
from typing import Any

from twin.physics.actuators.actuator_channels import CHANNELS_OF, attribute_of
from twin.physics.maths import DEG


@dataclass(frozen=True, slots=True)
class Channel:
    """One measured quantity.

    `attribute` is its name inside physics, `to_si` the factor there; a sample outside [low, high] (border
    units) is not a measurement. `max_rate` is the fastest plausible change per second (border units),
    `stale_s` the age after which the channel counts as lost."""

    name: str
    attribute: str
    to_si: float
    low: float
    high: float
    max_rate: float = inf
    stale_s: float = 5.0
    wraps: float = 0.0  # period of a direction, 0 for a number on the line
    turn: float = 0.0  # period of an actuator's angle: shown on any turn, and kept on the one that is shown
    doc: str = ""

    @property
    def period(self) -> float:
        """By how much two readings of one angle may differ; 0 for a number on the line."""
        return self.wraps or self.turn


CHANNELS: tuple[Channel, ...] = (
    Channel("north_m", "x", 1.0, -1e9, 1e9, 60.0, doc="position north of the voyage's datum"),
    Channel("east_m", "y", 1.0, -1e9, 1e9, 60.0, doc="position east of the voyage's datum"),
    Channel(
        "heading_true_north_deg", "psi", DEG, -360.0, 720.0, 60.0, wraps=360.0, doc="heading from true north"
    ),
    Channel("surge_velocity_mps", "u", 1.0, -40.0, 40.0, 10.0, doc="speed ahead over ground"),
    Channel("sway_velocity_mps", "v", 1.0, -20.0, 20.0, 10.0, doc="speed to starboard over ground"),
    Channel(
        "surge_velocity_through_water_mps", "u_r", 1.0, -40.0, 40.0, 10.0, doc="speed ahead through water"
    ),
    Channel(
        "sway_velocity_through_water_mps",
        "v_r",
        1.0,
        -20.0,
        20.0,
        10.0,
        doc="speed to starboard through water",
    ),
    Channel("yaw_rate_degps", "r", DEG, -90.0, 90.0, 180.0, doc="rate of turn, positive to starboard"),
    Channel(
        "rudder_angle_deg",
        "delta",
        DEG,
        -90.0,
        90.0,
        200.0,
        doc="rudder, positive turns the ship to starboard",
    ),
    Channel(
        "propeller_rate_rpm", "n", 1.0 / 60.0, -6000.0, 6000.0, 6000.0, doc="shaft speed, positive ahead"
    ),
    Channel("true_wind_speed_mps", "wind_speed", 1.0, 0.0, 90.0, stale_s=15.0, doc="wind over ground"),
    Channel(
        "true_wind_direction_deg",
        "wind_from",
        DEG,
        -360.0,
        720.0,
        stale_s=15.0,
        wraps=360.0,
        doc="wind from, true",
    ),
    Channel(
        "apparent_wind_speed_mps",
        "apparent_wind_speed",
        1.0,
        0.0,
        110.0,
        stale_s=15.0,
        doc="wind on the moving ship",
    ),
    Channel(
        "apparent_wind_angle_deg",
        "apparent_wind_from",
        DEG,
        -360.0,
        720.0,
        stale_s=15.0,
        wraps=360.0,
        doc="apparent wind from, off the bow, positive to starboard",
    ),
    Channel("water_depth_m", "depth", 1.0, 0.05, 12000.0, stale_s=60.0, doc="surface to bottom"),
    Channel(
        "wave_height_significant_m", "H_s", 1.0, 0.0, 25.0, stale_s=3600.0, doc="significant wave height"
    ),
    Channel("wave_period_peak_s", "T_p", 1.0, 0.2, 40.0, stale_s=3600.0, doc="peak wave period"),
    Channel(
        "wave_direction_deg",
        "wave_from",
        DEG,
        -360.0,
        720.0,
        stale_s=3600.0,
        wraps=360.0,
        doc="waves from, true",
    ),
    Channel("draught_mean_m", "draught", 1.0, 0.01, 40.0, stale_s=3600.0, doc="mean draught"),
    Channel("bank_distance_port_m", "bank_port", 1.0, 0.0, 1e5, stale_s=60.0, doc="side to bank, port"),
    Channel(
        "bank_distance_starboard_m",
        "bank_starboard",
        1.0,
        0.0,
        1e5,
        stale_s=60.0,
        doc="side to bank, starboard",
    ),
    Channel("roll_deg", "phi", DEG, -90.0, 90.0, 90.0, doc="heel, starboard side down positive"),
)
ACTUATOR_CHANNEL = re.compile(rf"[a-z][a-z0-9_]{{0,30}}\.({'|'.join(CHANNELS_OF)})")


class ByName(dict[str, Channel]):
    """The table's channels by name, and those of a ship's actuators (`port.rate_rpm`) as they are asked
    for."""

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or (
            isinstance(name, str) and bool(ACTUATOR_CHANNEL.fullmatch(name))
        )

    def __missing__(self, name: str) -> Channel:
        if not (isinstance(name, str) and ACTUATOR_CHANNEL.fullmatch(name)):
            raise KeyError(name)
        owner, _, last = name.rpartition(".")
        c = CHANNELS_OF[last]
        doc = f"{owner}: {c.doc}"
        return Channel(name, attribute_of(name), c.to_si, c.low, c.high, turn=c.turn, doc=doc)

    def get(self, name: str, default: Any = None) -> Any:
        """The channel of that name, else `default`."""
        return self[name] if name in self else default  # noqa: SIM401 (this is that get)


BY_NAME = ByName({c.name: c for c in CHANNELS})


def of_actuators(names: Any) -> list[str]:
    """Those among these names that are channels of actuators."""
    return [n for n in names if ACTUATOR_CHANNEL.fullmatch(n)]
