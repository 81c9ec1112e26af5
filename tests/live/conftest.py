"""A ship that sails by its own equations, instruments that read it, and a loop that listens: no clock, no
socket, no file."""

import random
from collections.abc import Callable
from dataclasses import dataclass, field
from math import degrees, pi, radians, sin

import pytest

from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.learning.learned_force import LearnedForce
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.physics.model import Model
from twin.physics.ship import Ship, load
from twin.physics.state import Situation

STEP_S = 0.1
WALL = 1.7e9  # wall clock less monotonic clock
NOISE = {
    "north_m": 0.3,
    "east_m": 0.3,
    "heading_true_north_deg": 0.05,
    "surge_velocity_mps": 0.03,
    "sway_velocity_mps": 0.03,
    "yaw_rate_degps": 0.003,
    "rudder_angle_deg": 0.05,
    "propeller_rate_rpm": 0.1,
}


@dataclass
class Sailing:
    """The true ship, and what its instruments say of it each 0.1 s."""

    ship: Ship
    model: Model
    helm_deg: Callable[[float], float] = lambda t: 15.0 * (1.0 if sin(2.0 * pi * t / 160.0) >= 0.0 else -1.0)
    noise: float = 1.0
    heading_deg: float = 40.0
    seed: int = 1
    t: float = 0.0
    source: str = "ship"
    H_s: float | None = None  # wave height that it reports [m], None: it has no wave sensor
    shaft: float = 0.0
    state: tuple[float, ...] = field(default=(), init=False)

    def __post_init__(self):
        self.random = random.Random(self.seed)
        self.state = (0.0, 0.0, radians(self.heading_deg), 0.8 * self.ship.U_0, 0.0, 0.0)
        self.shaft = self.shaft or 0.9 * self.ship.U_0 / (0.7 * self.ship.D_P)
        self.rudder = 0.0

    def advance(self):
        order = self.helm_deg(self.t)
        self.rudder += max(min(order - self.rudder, 0.25), -0.25)  # 2.5 deg/s
        s = Situation(delta=radians(self.rudder), n=self.shaft)
        self.state = self.model.step(self.state, s, STEP_S)
        self.t += STEP_S

    def true(self) -> dict[str, float]:
        x, y, psi, u, v, r = self.state
        return {
            "north_m": x,
            "east_m": y,
            "heading_true_north_deg": degrees(psi) % 360.0,
            "surge_velocity_mps": u,
            "sway_velocity_mps": v,
            "yaw_rate_degps": degrees(r),
            "rudder_angle_deg": self.rudder,
            "propeller_rate_rpm": 60.0 * self.shaft,
        }

    def readings(self, now_s: float) -> list[Reading]:
        said = []
        for name, value in self.true().items():
            value += self.noise * self.random.gauss(0.0, NOISE[name])
            said.append(
                Reading(
                    name, value % 360.0 if "north_deg" in name else value, WALL + now_s, now_s, self.source
                )
            )
        if self.H_s is not None:
            said.append(Reading("wave_height_significant_m", self.H_s, WALL + now_s, now_s, self.source))
        return said


class Bridge:
    """A loop on a sailing ship; `run` returns the ticks."""

    def __init__(self, ship: Ship, sailing: Sailing, **loop):
        self.sailing, self.ears = sailing, Played([])
        loop.setdefault("learned", LearnedForce(ship, None, "none in this test"))
        self.loop = Loop(ship, self.ears, Outbox(Publisher(), "twin", "ship"), **loop)
        self.now_s, self.number, self.wall_less_mono = 1000.0, 0, WALL
        self.ticks = []

    def run(self, seconds: float, alter=lambda readings, bridge: readings, skipped: int = 0):
        """`alter(readings, bridge)` is the fault: it gives back what arrives instead."""
        made = []
        for _ in range(round(seconds / STEP_S)):
            self.ears.next = list(alter(self.sailing.readings(self.now_s), self))
            instant = Instant(self.number, self.now_s, self.now_s + self.wall_less_mono, skipped=skipped)
            made.append(self.loop.tick(instant))
            self.truth = self.sailing.true()
            self.sailing.advance()
            self.number += 1
            self.now_s += STEP_S
        self.ticks += made
        return made

    def error(self, name: str) -> float:
        """The estimate of the last tick less the truth, the short way round for the heading."""
        gap = getattr(self.ticks[-1].estimate, name) - self.truth[name]
        return (gap + 180.0) % 360.0 - 180.0 if name == "heading_true_north_deg" else gap


@pytest.fixture(scope="session")
def kvlcc2() -> Ship:
    return load("kvlcc2")


@pytest.fixture
def sailing(kvlcc2) -> Sailing:
    return Sailing(kvlcc2, Model.of(kvlcc2))


@pytest.fixture
def bridge(kvlcc2, sailing) -> Bridge:
    return Bridge(kvlcc2, sailing)


@pytest.fixture
def make_bridge(kvlcc2):
    def make(ship=kvlcc2, loop=None, **sailing) -> Bridge:
        return Bridge(ship, Sailing(ship, Model.of(ship), **sailing), **(loop or {}))

    return make


@pytest.fixture(scope="session")
def certificate_file(tmp_path_factory):
    """Worked out once, by whoever asks first."""
    return tmp_path_factory.mktemp("state") / "certificate.json"


@pytest.fixture
def served(kvlcc2, certificate_file):
    """A bridge with the loop that `twin run` builds: certificate, residual and adaptation."""

    def made(**sailing) -> Bridge:
        bridge = Bridge(kvlcc2, Sailing(kvlcc2, Model.of(kvlcc2), **sailing))
        bridge.loop = loop_of(
            Settings({"observer.certificate": str(certificate_file)}),
            bridge.ears,
            Outbox(Publisher(), "twin", "ship"),
            None,
        )
        assert bridge.loop.stabilizer.tube and bridge.loop.learned.residual and bridge.loop.learned.adaptation
        return bridge

    return made


def every_number(message):
    for about, value in message.ListFields():
        many = (
            value if not isinstance(value, (str, float, int, bool)) and hasattr(value, "__len__") else [value]
        )
        for one in many:
            if hasattr(one, "ListFields"):
                yield from every_number(one)
            elif isinstance(one, (float, int)):
                yield about.name, one


@pytest.fixture(scope="session")
def numbers():
    """Every number in a message, however deep, with its name."""
    return every_number


@pytest.fixture(scope="session")
def on_file(tmp_path_factory):
    """A folder in which certificates are worked out once for all tests."""
    return tmp_path_factory.mktemp("certificates")


@pytest.fixture
def make_service(on_file):
    """The loop that the service builds: certificate, residual where the ship has one, and adaptation."""

    def make(name: str = "kvlcc2", settings=None, **sailing) -> Bridge:
        chosen = Settings(
            {"ship.file": name, "observer.certificate": str(on_file / f"{name}.json")} | (settings or {})
        )
        bridge = Bridge(load(name), Sailing(load(name), Model.of(load(name)), **{"H_s": 0.0} | sailing))
        bridge.loop = loop_of(chosen, bridge.ears, Outbox(Publisher(), "twin", "ship"), None)
        assert bridge.loop.stabilizer.tube and bridge.loop.stabilizer.tube.certificate.ok
        return bridge

    return make
