"""Instruments that speak for hours, in step with a loop, and keep nothing of what they said."""

from dataclasses import replace
from math import degrees, radians
from random import Random

from bench.fuzz.stepped_voyage import CHANNELS, SIZES
from twin.live.keelson.bus import BusState, Incoming
from twin.live.keelson.messages import encode_fix, encode_float, wrap
from twin.live.keelson.topics import BY_SUBJECT, key
from twin.live.learning.learned_force import LearnedForce
from twin.live.signals import geodesy
from twin.physics.model import Model
from twin.physics.ship import Ship
from twin.physics.state import Force, Situation

UTC_LESS_MONOTONIC_S, SEED = 1.7e9, 33
LEGS_S, RUDDER_DEG, RUDDER_DEGPS = (100.0, 60.0), 15.0, 2.5  # to starboard, to port: it stays in one place


class SteadyFeed:
    """A bus on which every instrument speaks at each tick and nobody listens. It keeps nothing."""

    def __init__(self, ship: Ship, period_s: float):
        self.model, self.shaft, self.period_s = Model.of(ship), 0.9 * ship.U_0 / (0.7 * ship.D_P), period_s
        self._held: Force | None = None
        self.ship_state: tuple[float, ...] = (0.0, 0.0, radians(40.0), 0.8 * ship.U_0, 0.0, 0.0)
        self.rudder, self.heard, self.random = 0.0, 0, Random(SEED)
        self.datum = geodesy.datum(57.62, 11.58)
        self.keys = {s: key("twin", "ship", s, "steady") for s in BY_SUBJECT}

    def __enter__(self) -> "SteadyFeed":
        return self

    def __exit__(self, *_: object) -> None: ...

    def listen_to(self, subjects: list[str]) -> None: ...

    def publish(self, key: str, data: bytes) -> None: ...

    @property
    def state(self) -> BusState:
        return BusState(True, "", 1, 0, self.heard, 0, 0)

    def drain(self, now_s: float) -> list[Incoming]:
        """What the instruments say now; the ship sails on by one period."""
        self._sail(now_s)
        x, y, psi, u, v, r = self.ship_state
        true = (x, y, degrees(psi), u, v, degrees(r), self.rudder, 60.0 * self.shaft, 0.0)
        said = {c: value + self.random.gauss(0.0, SIZES[c]) for c, value in zip(CHANNELS, true, strict=True)}
        said["heading_true_north_deg"] %= 360.0
        wall_ns = round((UTC_LESS_MONOTONIC_S + now_s) * 1e9)
        place = geodesy.from_chart(self.datum, said.pop("north_m"), said.pop("east_m"))
        made = {name: encode_float(value, wall_ns) for name, value in said.items()}
        made["location_fix"] = encode_fix(*place, wall_ns)
        self.heard += len(made)
        return [(self.keys[name], wrap(data, wall_ns), now_s) for name, data in made.items()]

    def pushed_by(self, learned: LearnedForce) -> None:
        """From now on the ship has the force that its network was taught, so that the guard lets it act."""

        def force(s: Situation) -> Force:
            self._held = self._held or learned.at(s, ()).force  # once a step
            return self._held

        self.model = replace(self.model, residual=force)

    def _sail(self, now_s: float) -> None:
        order = RUDDER_DEG if now_s % sum(LEGS_S) < LEGS_S[0] else -RUDDER_DEG
        most = RUDDER_DEGPS * self.period_s
        self.rudder += max(min(order - self.rudder, most), -most)
        situation = Situation(delta=radians(self.rudder), n=self.shaft)
        self._held = None
        self.ship_state = tuple(self.model.step(self.ship_state, situation, self.period_s))
