"""What is counted in instructions: a step of the equations, a run of the network, a tick without bus and log.

Each function prepares its program and gives the step that is repeated; nothing hangs on a clock or on chance.
"""

from collections.abc import Callable
from copy import deepcopy
from math import cos, degrees, sin

from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Inbox
from twin.live.keelson.bus import MemoryBus
from twin.live.keelson.messages import encode_fix, encode_float, wrap
from twin.live.keelson.topics import key
from twin.live.learning.residual import bundled
from twin.live.learning.residual import load as load_residual
from twin.live.loop import Loop, measured_nu
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation

SHIP, RATE_HZ, WALL_S = "kvlcc2", 50.0, 1.7e9
EVERY = 5  # ticks: the instruments speak ten times a second
MAX_TICKS = 100  # ticks for which there are messages
Step = Callable[[], object]


def analytic() -> Step:
    """One Runge-Kutta step of the equations."""
    ship = load(SHIP)
    model, s = Model.of(ship), Situation(u=ship.U_0, delta=0.1, n=1.5, wind_speed=8.0, wind_to=0.7)
    state = (0.0, 0.0, 0.0, ship.U_0, 0.1, 0.002)
    return lambda: model.step(state, s, 0.1)


def network() -> Step:
    """One run of the learned residual's network."""
    ship = load(SHIP)
    residual = load_residual(bundled(ship) or "", ship)
    zeta = [0.1] * len(residual.manifest.inputs)
    return lambda: residual.network.run(zeta)


def tick() -> Step:
    """One whole tick at 50 Hz: decode, gates, observer, forces, adaptation, prediction, certificate,
    records."""
    return _ticks(MAX_TICKS)[1]


def hybrid(most: int = MAX_TICKS) -> Step:
    """What a peer does too, on the measurements of `most` such ticks: correct, known force, learned force,
    adapt, one step on."""
    (before, step), (loop, _) = _ticks(most), _ticks(0)
    taken = []
    for _ in range(most):
        step()
        taken.append(deepcopy(before.last.measured))
    seen, period_s = iter(taken), loop.period_s

    def compute() -> object:
        measured = next(seen)
        e = loop.observer.correct(measured)
        s, physics, forces = loop.dynamics.known(e, measured)
        learned = loop.learned.at(s, forces)
        loop.learned.learn(measured_nu(measured), s, forces, learned, physics, period_s, "")
        loop.observer.steer(loop.dynamics.ahead(s, forces, learned.force, period_s))
        return e

    return compute


def _ticks(most: int) -> tuple[Loop, Step]:
    """A loop, and what ticks it with the next messages."""
    settings = Settings().but("ship.file", SHIP).but("loop.rate_hz", RATE_HZ)
    bus, count = MemoryBus(), iter(range(most))
    voice = Outbox(Publisher(), settings["bus.base"], settings["bus.entity"], bus, _forget)
    loop = loop_of(settings, Inbox(bus, _forget), voice)
    said = [_messages(i / RATE_HZ) if i % EVERY == 0 else [] for i in range(most)]

    def step() -> object:
        i = next(count)
        for topic, data in said[i]:
            bus.put(topic, data)
        return loop.tick(Instant(i, i / RATE_HZ, WALL_S + i / RATE_HZ))

    return loop, step


PROGRAMS: dict[str, Callable[[], Step]] = {"analytic": analytic, "network": network, "tick": tick}


def _messages(t: float) -> list[tuple[str, bytes]]:
    """What the instruments of a ship say that weaves its way north, with a little waver on it."""
    speed, swing, pace, ns = 7.0, 0.1, 0.06, int((WALL_S + t) * 1e9)  # heading swing sin(pace t) [rad]
    waver = sin(7.0 * t) + 0.3 * cos(31.0 * t)
    psi, r = swing * sin(pace * t), swing * pace * cos(pace * t)
    north = speed * (t * (1.0 - 0.25 * swing**2) + 0.125 * swing**2 / pace * sin(2.0 * pace * t))
    east = speed * swing / pace * (1.0 - cos(pace * t))
    values = {
        "heading_true_north_deg": (degrees(psi) + 0.05 * waver) % 360.0,
        "yaw_rate_degps": degrees(r) + 0.003 * waver,
        "surge_velocity_mps": speed + 0.02 * waver,
        "sway_velocity_mps": -40.0 * r + 0.02 * waver,
        "rudder_angle_deg": 10.0 * cos(pace * t + 0.5) + 0.05 * waver,
        "propeller_rate_rpm": 85.0 + 0.1 * waver,
    }
    fix = encode_fix(57.62 + north / 111e3, 11.58 + east / 59e3, ns)
    said = {"location_fix": fix} | {name: encode_float(value, ns) for name, value in values.items()}
    return [(key("twin", "ship", subject, "sea"), wrap(data, ns)) for subject, data in said.items()]


def _forget(topic: str, type_name: str, payload: bytes, wall_ns: int) -> None:
    """A log that keeps nothing: files are not counted."""
