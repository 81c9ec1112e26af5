"""A small craft with azimuths that sails by its own equations, and the loop that the service builds for it."""

import random
from dataclasses import dataclass, field
from math import degrees, pi, radians, sin

from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Inbox, Played
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.messages import encode_fix, encode_float, wrap
from twin.live.keelson.topics import key
from twin.live.observer.controls import actuator_channels, controls_of
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.channels import BY_NAME
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.physics.actuators.helm import actuator_orders
from twin.physics.model import Model
from twin.physics.ship import Ship, from_table, load, to_table
from twin.physics.state import Situation

STEP_S, WALL = 0.1, 1.7e9
POD = {"kind": "azimuth", "channels": ["rate_rpm", "angle_deg"], "diameter_m": 0.12}
PODS = [
    POD | {"name": name, "x_m": x, "y_m": y}
    for name, x, y in (("fore", 0.8, 0.0), ("port", -0.8, -0.2), ("starboard", -0.8, 0.2))
]
SIDES = [
    {
        "name": name,
        "kind": "fixed_thruster",
        "channels": ["pwm_us"],
        "y_m": y,
        "ahead_n": 30.0,
        "astern_n": 15.0,
    }
    for name, y in (("port", -0.3), ("starboard", 0.3))
]
NOISE = {
    "north_m": 0.02,
    "east_m": 0.02,
    "heading_true_north_deg": 0.1,
    "surge_velocity_mps": 0.01,
    "sway_velocity_mps": 0.01,
    "yaw_rate_degps": 0.1,
}


def craft(*tables, **effects) -> Ship:
    """The 2 m boat with these actuators in the place of its propeller and rudder."""
    numbers = {name: {k: {"value": v} for k, v in p.items()} for name, p in effects.items()}
    return from_table(
        to_table(load("usv")) | {"name": "craft", "actuators": list(tables), "effects": numbers}
    )


@dataclass
class Afloat:
    """The true craft; what it is told swings, so that it weaves."""

    ship: Ship
    true: Ship | None = None  # where it is another than the twin's
    noise: float = 1.0
    seed: int = 1
    t: float = 0.0
    state: tuple[float, ...] = field(default=(), init=False)

    def __post_init__(self):
        self.random = random.Random(self.seed)
        self.model = Model.of(self.true or self.ship)
        self.state = (0.0, 0.0, radians(40.0), 0.8 * self.ship.U_0, 0.0, 0.0)
        self.channels = controls_of(self.ship)

    def orders(self) -> dict[str, float]:
        return actuator_orders(self.ship, radians(9.0) * sin(2.0 * pi * self.t / 40.0), 0.75)

    def advance(self):
        self.state = self.model.step(self.state, Situation(orders=self.orders()), STEP_S)
        self.t += STEP_S

    def says(self) -> dict[str, float]:
        """Every channel of motion and actuators, border units."""
        x, y, psi, u, v, r = self.state
        motion = dict(zip(NOISE, (x, y, degrees(psi), u, v, degrees(r)), strict=True))
        motion = {k: w + self.noise * self.random.gauss(0.0, NOISE[k]) for k, w in motion.items()}
        motion["heading_true_north_deg"] %= 360.0
        own = {self.channels[a]: w / BY_NAME[self.channels[a]].to_si for a, w in self.orders().items()}
        return motion | own


class Service:
    """The loop that the service builds; fed with readings, or by bus with Keelson's messages."""

    def __init__(self, path, afloat: Afloat, settings=None, by_bus=False, log=None):
        self.afloat, self.bus = afloat, MemoryBus()
        ears = Inbox(self.bus, log) if by_bus else Played([])
        voice = Outbox(Publisher(), "twin", "ship", self.bus if by_bus else None, log)
        self.loop = loop_of(Settings({"ship.file": str(path)} | (settings or {})), ears, voice)
        if by_bus:
            ears.listen_to(actuator_channels(self.loop.ship))
        self.ears, self.by_bus, self.now_s, self.number = ears, by_bus, 1000.0, 0
        self.ticks = []

    def run(self, seconds, alter=lambda said: said):
        """`alter` is given what is said, by channel, and gives what arrives."""
        for _ in range(round(seconds / STEP_S)):
            said = alter(self.afloat.says())
            if self.by_bus:
                self._speak(said)
            else:
                self.ears.next = [
                    Reading(c, x, WALL + self.now_s, self.now_s, c.partition(".")[0]) for c, x in said.items()
                ]
            self.ticks.append(self.loop.tick(Instant(self.number, self.now_s, WALL + self.now_s)))
            self.truth = self.afloat.state
            self.afloat.advance()
            self.number, self.now_s = self.number + 1, self.now_s + STEP_S
        return self.ticks[-1]

    def _speak(self, said):
        ns = round((WALL + self.now_s) * 1e9)
        for channel, value in said.items():
            name, _, last = channel.rpartition(".")
            if channel == "north_m":
                data = encode_fix(57.6 + value / 111e3, 11.6 + said["east_m"] / 60e3, ns)
                self.put("location_fix", "gnss", data, ns)
            elif channel != "east_m":
                self.put(
                    f"actuator_{last}" if name else channel,
                    f"{name}/drive" if name else "sensor",
                    encode_float(value, ns),
                    ns,
                )

    def put(self, subject, source, data, ns):
        self.bus.put(key("twin", "ship", subject, source), wrap(data, ns))


def shown(tick) -> dict:
    """The actuators of a tick by channel."""
    return {a.name: a for a in tick.actuators}
