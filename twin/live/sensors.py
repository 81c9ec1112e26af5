"""Readings in, one `Measured` out: what the ship's instruments say now, in SI, each with its age, and why some of it is missing.

Every channel has its gate; what no instrument measures is derived where that is exact enough, and said to be derived.
"""

from dataclasses import dataclass, field
from math import degrees, inf, pi

from twin.live.channels import BY_NAME, CHANNELS
from twin.live.derive import RateFromHeading, SpeedFromPosition, true_wind
from twin.live.estimate import Estimate
from twin.live.frozen import Frozen
from twin.live.gate import Gate
from twin.live.readings import WORDS, Quality, Reading, Rejected
from twin.live.stamps import Stamps
from twin.physics.ship import Ship

MOVING = ("north_m", "east_m", "heading_true_north_deg")  # a ship under way changes them for certain
NOISY = (
    "surge_velocity_mps", "sway_velocity_mps", "surge_velocity_through_water_mps", "sway_velocity_through_water_mps",
    "yaw_rate_degps", "true_wind_speed_mps", "true_wind_direction_deg", "apparent_wind_speed_mps", "apparent_wind_angle_deg",
)  # fmt: skip
DERIVED_FROM = {"u": "x", "v": "x", "r": "psi"}
FROM = {"wind_from": "wind_to", "wave_from": "wave_to"}  # physics says where wind and waves go


@dataclass(slots=True)
class Measured:
    """What may be believed now: SI values by attribute of physics; an attribute that is not there is not measured.

    `fresh` has those with a new sample in this tick and the time since the one before [s]; `age_s` how old each value is;
    `steps` those that were reset because a step lasted; `derived` those that no instrument measured itself.
    """

    now_s: float
    si: dict[str, float] = field(default_factory=dict)
    fresh: dict[str, float] = field(default_factory=dict)
    age_s: dict[str, float] = field(default_factory=dict)
    since_s: dict[str, float] = field(default_factory=dict)  # time since the newest sample arrived
    hold_s: dict[str, float] = field(default_factory=dict)  # how long until the next one is due
    steps: dict[str, float] = field(default_factory=dict)
    derived: set[str] = field(default_factory=set)
    border: dict[str, float] = field(default_factory=dict)  # by channel, border units: what is logged and shown
    clock_step_s: float = 0.0

    def has(self, *attributes: str) -> bool:
        return all(a in self.si for a in attributes)

    def age_by_channel(self) -> dict[str, float]:
        return {name: self.age_s[BY_NAME[name].attribute] for name in self.border}


class Sensors:
    """All channels of one ship."""

    def __init__(self, ship: Ship, sources: dict[str, str] | None = None, max_delay_s: float = 2.0):
        floors = noise_floors(ship)
        sources = sources or {}
        self.gates = {
            c.name: Gate(c, floors.get(c.name, inf), _frozen(c.name, floors), sources.get(c.name)) for c in CHANNELS
        }
        self.stamps = Stamps(max_delay_s)
        self.rejected = 0
        slow = ship.U_0 / ship.L_pp
        self._speed = SpeedFromPosition(min(max(12.0 * slow, 0.05), 2.0))
        self._turn = RateFromHeading(min(max(36.0 * slow, 0.2), 5.0))
        self._motion: dict[str, float] = {}
        self._last: dict[str, float] = {}  # attribute: when its newest used sample was measured
        self._derived: dict[str, tuple[float, float]] = {}  # attribute: value, time

    def read(self, arrived: list[Reading | Rejected], now_s: float, wall_s: float, own: Estimate) -> Measured:
        """Takes what arrived since the last tick; `own` is where the twin believes the ship to be."""
        measured = Measured(now_s, clock_step_s=self.stamps.observe(now_s, wall_s))
        self._motion = motion_of(own)
        touched: dict[str, Gate] = {}
        for result in arrived:
            gate = self._take(result)
            if gate is not None:
                touched[gate.channel.name] = gate
                if gate.step:
                    measured.steps[gate.channel.attribute] = gate.step * gate.channel.to_si
        for name, gate in self.gates.items():
            if gate.value is not None and not gate.lost(now_s):
                self._put(measured, gate, name in touched)
        self._derive(measured, own)
        return measured

    def _take(self, result: Reading | Rejected) -> Gate | None:
        """One result through its gate; the gate, if it took the sample."""
        gate = self.gates.get(result.channel)
        if isinstance(result, Rejected) or gate is None:
            self.rejected += 1
            if gate is not None:
                gate.refuse(result.quality if isinstance(result, Rejected) else Quality.UNKNOWN_KEY, result.received_s)
            return None
        t, quality = self.stamps.on_monotonic(result)
        if quality is not Quality.OK:
            gate.refuse(quality, result.received_s)
        else:
            quality = gate.accept(result, t, self._motion.get(result.channel, 0.0))
        if quality is Quality.OK:
            return gate
        self.rejected += 1
        return None

    def _put(self, measured: Measured, gate: Gate, touched: bool) -> None:
        channel, value = gate.channel, gate.value or 0.0
        attribute = channel.attribute
        measured.border[channel.name] = value
        measured.age_s[attribute] = measured.now_s - gate.time_s
        measured.since_s[attribute] = measured.now_s - gate.received_s
        measured.hold_s[attribute] = min(1.2 * gate.interval_s, 2.0)
        measured.si[attribute] = value * channel.to_si
        if attribute in FROM:
            measured.si[FROM[attribute]] = (value * channel.to_si + pi) % (2.0 * pi)
        if touched:
            measured.fresh[attribute] = gate.time_s - self._last.get(attribute, gate.time_s)
            self._last[attribute] = gate.time_s

    def _derive(self, measured: Measured, own: Estimate) -> None:
        """Speed over ground, rate of turn and true wind, where no instrument gives them."""
        si, fresh = measured.si, measured.fresh
        if "r" not in si and "psi" in fresh:
            self._keep(measured, self._turn.feed(si["psi"], self._last["psi"]), "psi", {"r": self._turn.r})
        if not ("u" in si and "v" in si) and "x" in fresh and "y" in fresh and measured.has("psi"):
            if measured.steps:
                self._speed = SpeedFromPosition(self._speed.omega)
            ready = self._speed.feed(si["x"], si["y"], si["psi"], self._last["x"])
            self._keep(measured, ready, "x", {"u": self._speed.u, "v": self._speed.v})
        for attribute, (value, t) in self._derived.items():
            if attribute not in si and DERIVED_FROM[attribute] in si:
                si[attribute], measured.age_s[attribute] = value, measured.now_s - t
                of = DERIVED_FROM[attribute]
                measured.since_s[attribute], measured.hold_s[attribute] = measured.since_s[of], measured.hold_s[of]
                measured.derived.add(attribute)
        if "wind_speed" not in si and measured.has("apparent_wind_speed", "apparent_wind_from"):
            felt = si["apparent_wind_speed"], si["apparent_wind_from"]
            si["wind_speed"], si["wind_to"] = true_wind(*felt, own.psi, own.u, own.v)
            measured.derived.update(("wind_speed", "wind_to"))

    def _keep(self, measured: Measured, ready: bool, of: str, values: dict[str, float]) -> None:
        if not ready:
            return
        for attribute, value in values.items():
            if attribute not in measured.si:
                self._derived[attribute] = (value, self._last[of])
                measured.fresh[attribute] = measured.fresh[of]

    def qualities(self, now_s: float) -> dict[str, int]:
        """The quality code of each channel."""
        return {name: gate.quality(now_s) for name, gate in self.gates.items()}

    def reasons(self, now_s: float) -> list[str]:
        """What is wrong with the channels that were ever heard of, in words."""
        said = []
        for name, gate in self.gates.items():
            quality = gate.quality(now_s)
            if quality is Quality.CONFLICT:
                said.append(f"{name}: {gate.source} and {gate.rival} both publish it; {gate.source} is used. Choose one under [sources]")
            elif quality not in (Quality.OK, Quality.NEVER_SEEN):
                said.append(f"{name}: {WORDS[quality]}")
            elif gate.losing(now_s):
                said.append(f"{name}: samples are lost, less than 60 % of the usual rate arrives")
        return said


def motion_of(own: Estimate) -> dict[str, float]:
    """How fast the ship's motion changes position and heading [border units per s]."""
    if not own.ready:
        return {}
    north, east = own.velocity_ned()
    return {"north_m": north, "east_m": east, "heading_true_north_deg": degrees(own.r)}


def noise_floors(ship: Ship) -> dict[str, float]:
    """What an instrument's noise may add to the change between two samples [border units], by the ship's own scale."""
    speed = max(0.15 * ship.U_0, 0.5)
    return {
        "north_m": 10.0, "east_m": 10.0, "heading_true_north_deg": 3.0,
        "surge_velocity_mps": speed, "sway_velocity_mps": speed,
        "surge_velocity_through_water_mps": speed, "sway_velocity_through_water_mps": speed,
        "yaw_rate_degps": max(degrees(0.4 * ship.U_0 / ship.L_pp), 0.5),
        "rudder_angle_deg": 3.0, "propeller_rate_rpm": 30.0, "roll_deg": 5.0,
    }  # fmt: skip


def _frozen(name: str, floors: dict[str, float]) -> Frozen | None:
    if name in MOVING:
        return Frozen(least=0.5 * floors[name])
    return Frozen() if name in NOISY else None


assert all(name in BY_NAME for name in (*MOVING, *NOISY))
