"""Readings in, one `Measured` out: what the ship's instruments say now, in SI, with its age, and why some
of it is missing.

Every channel has its gate; what no instrument measures is derived where that is exact enough, and said to be
derived.
"""

from collections.abc import Iterable, Sequence
from math import degrees, inf, pi

from twin.live.gates.actuator_rates import gates_of
from twin.live.gates.frozen import Frozen
from twin.live.gates.gate import Gate
from twin.live.gates.noise import SEEN_TOO, NoiseWatch
from twin.live.gates.rivals import Rivals
from twin.live.keelson.stamps import Stamps
from twin.live.observer.estimate import HELD, Estimate
from twin.live.signals.channels import CHANNELS, Channel
from twin.live.signals.derive import CarriedHeading, RateFromHeading, SpeedFromPosition, true_wind
from twin.live.signals.measured import Measured
from twin.live.signals.readings import WORDS, Quality, Reading, Rejected
from twin.physics.ship import Ship

MOVING = ("north_m", "east_m", "heading_true_north_deg")  # a ship under way changes them for certain
NOISY = (
    "surge_velocity_mps",
    "sway_velocity_mps",
    "surge_velocity_through_water_mps",
    "sway_velocity_through_water_mps",
    "yaw_rate_degps",
    "true_wind_speed_mps",
    "true_wind_direction_deg",
    "apparent_wind_speed_mps",
    "apparent_wind_angle_deg",
)
FROM = {"wind_from": "wind_to", "wave_from": "wave_to"}  # physics says where wind and waves go
FAR = inf
SILENT_S = 10.0  # a source that the owner named and that has not spoken for so long since the start is named
FASTEST_SHAFT = 5.0  # of U_0/D_P: three times what drives a ship at its service speed


class Sensors:
    """All channels of one ship; `rejected` counts the samples that were refused."""

    def __init__(self, ship: Ship, sources: dict[str, str] | None = None, max_delay_s: float = 2.0):
        allowances = noise_allowances(ship)
        self._awaited = sources = dict(sources or {})  # channel: the source that should speak and has not yet
        self.gates = {
            c.name: Gate(c, allowances.get(c.name, FAR), _frozen(c, allowances), sources.get(c.name))
            for c in CHANNELS
        } | gates_of(ship, sources)
        if not ship.actuators:
            shaft = self.gates["propeller_rate_rpm"]
            shaft.low, shaft.high = (
                -FASTEST_SHAFT * ship.U_0 / ship.D_P * 60.0,
                FASTEST_SHAFT * ship.U_0 / ship.D_P * 60.0,
            )
        self._noise = NoiseWatch(allowances)
        self.stamps = Stamps(max_delay_s)
        self.rivals = Rivals()
        self.rejected = 0
        self.codes: dict[str, int] = {name: int(Quality.NEVER_SEEN) for name in self.gates}
        self._began_s: float | None = None
        self._waited_s = self._now_s = 0.0
        self._changes: list[tuple[str, float, float]] = []  # of this tick's samples, and over how long
        self._live: dict[str, Gate] = {}  # channels whose value may be used
        self._odd: set[str] = set()  # channels that were not well when last looked at
        self._losing: set[str] = set()
        self._now = Measured(0.0)  # kept up to date, copied out each tick
        self._names = tuple(self.gates)
        self._ticks = 0
        slow = ship.U_0 / ship.L_pp
        self._speed = SpeedFromPosition(min(max(12.0 * slow, 0.05), 2.0))
        self._turn = RateFromHeading(min(max(36.0 * slow, 0.2), 5.0))
        self._carried = CarriedHeading(0.2 * ship.U_0)
        self._motion: dict[str, float] = {}
        self._derived: dict[str, tuple[float, str]] = {}  # attribute: value, what it was derived from

    def read(
        self, arrived: Sequence[Reading | Rejected], now_s: float, wall_s: float, own: Estimate
    ) -> Measured:
        """Takes what arrived since the last tick; `own` is where the twin believes the ship to be."""
        step_s = self.stamps.observe(now_s, wall_s)
        self._began_s = now_s if self._began_s is None else self._began_s
        self._waited_s, self._now_s = now_s - self._began_s, now_s
        self._motion = motion_of(own)
        fresh: dict[str, float] = {}
        steps: dict[str, float] = {}
        for result in arrived:
            self._take(result, fresh, steps)
        for name, change, after_s in self._changes:
            self._weigh(name, change, after_s)
        self._changes.clear()
        for name in [name for name, gate in self._live.items() if now_s > gate.expires_s]:
            attribute = self._lose(name)
            fresh.pop(attribute, None)  # a sample may be too old when it comes
            steps.pop(attribute, None)
        measured = self._now.at(now_s, fresh, steps, step_s)
        self._derive(measured, own)
        self._judge(now_s)
        return measured

    def _take(self, result: Reading | Rejected, fresh: dict[str, float], steps: dict[str, float]) -> None:
        """One result through its gate."""
        name = result.channel
        gate = self.gates.get(name)
        if gate is None:
            self.rejected += 1
            return
        self._odd.add(name)
        if isinstance(result, Rejected):
            gate.refuse(result.quality, result.received_s)
            self.rejected += 1
            return
        t, quality = self.stamps.on_monotonic(result)
        before_s, before = gate.time_s, gate.value
        if quality is not Quality.OK:
            gate.refuse(quality, result.received_s)
        else:
            quality = gate.accept(result, t, self._motion.get(name, 0.0))
        if quality is not Quality.OK:
            if quality is Quality.CONFLICT:
                self.rivals.compare(gate, result, t, self._motion.get(name, 0.0))
            self.rejected += 1
            return
        self._put(name, gate)
        if before is not None:
            self._changes.append((name, gate.difference(gate.value or 0.0, before), t - before_s))
        attribute = gate.channel.attribute
        fresh[attribute] = fresh.get(attribute, 0.0) + (t - before_s if before_s > 0.0 else 0.0)
        if gate.step:
            steps[attribute] = gate.step * gate.channel.to_si

    def _weigh(self, name: str, change: float, dt: float) -> None:
        """A channel that is far noisier than it was weighs less; once all that arrived is taken, for some
        are held against others."""
        too = SEEN_TOO.get(name)
        self._noise.feed(name, change, dt, self.gates[too].value if too else None)
        weights, attribute = self._now.weights, self.gates[name].channel.attribute
        if name in self._noise.loud:
            weights[attribute] = self._noise.loud[name]
        elif attribute in weights:
            del weights[attribute]

    def _put(self, name: str, gate: Gate) -> None:
        channel, value, now = gate.channel, gate.value or 0.0, self._now
        attribute = channel.attribute
        self._live[name] = gate
        if self._awaited:
            self._awaited.pop(name, None)
        now.border[name], now.taken[name] = value, gate.time_s
        now.si[attribute] = value * channel.to_si
        now.time[attribute], now.heard[attribute] = gate.time_s, gate.received_s
        now.hold_s[attribute] = min(HELD * gate.interval_s, 2.0)
        if attribute in FROM:
            now.si[FROM[attribute]] = (value * channel.to_si + pi) % (2.0 * pi)

    def _lose(self, name: str) -> str:
        """The channel's last value is too old; returns its attribute."""
        now, attribute = self._now, self._live.pop(name).channel.attribute
        self._odd.add(name)
        del now.border[name], now.taken[name], now.si[attribute]
        now.si.pop(FROM.get(attribute, ""), None)
        self._noise.lose(name)
        now.weights.pop(attribute, None)
        return attribute

    def _derive(self, measured: Measured, own: Estimate) -> None:
        """Speed over ground, rate of turn and true wind, where no instrument gives them; the filters run
        along, ready to stand in."""
        si, fresh = measured.si, measured.fresh
        if "psi" in fresh:
            ready = self._turn.feed(si["psi"], measured.time["psi"])
            self._keep(ready, "psi", {"r": self._turn.r})
        self._carry_heading(measured, own)
        if "x" in fresh and "y" in fresh and "psi" in si:
            if measured.steps:
                self._speed = SpeedFromPosition(self._speed.omega)
            ready = self._speed.feed(si["x"], si["y"], si["psi"], measured.time["x"])
            self._keep(ready, "x", {"u": self._speed.u, "v": self._speed.v})
        for attribute, (value, of) in self._derived.items():
            if attribute not in si and of in si and of not in measured.derived:
                measured.derive(attribute, value, of)
        if "wind_speed" not in si and measured.has("apparent_wind_speed", "apparent_wind_from"):
            felt = si["apparent_wind_speed"], si["apparent_wind_from"]
            si["wind_speed"], si["wind_to"] = true_wind(*felt, own.psi, own.u, own.v)
            measured.derived.update(("wind_speed", "wind_to"))

    def _carry_heading(self, measured: Measured, own: Estimate) -> None:
        """The heading by gyro and course while the compass is lost; the gyro alone, the course alone where
        one is all there is."""
        si, of = measured.si, next((a for a in ("r", "x") if a in measured.si), "")
        if "psi" in si or not own.ready or not of:
            self._carried.stop()
            return
        place = (si["x"], si["y"]) if "x" in measured.fresh and "y" in si else None
        nu = si.get("u", own.u), si.get("v", own.v), si.get("r", own.r)
        measured.derive("psi", self._carried.feed(measured.now_s, own.psi, nu, place), of)

    def _keep(self, ready: bool, of: str, values: dict[str, float]) -> None:
        for attribute, value in values.items():
            if ready:
                self._derived[attribute] = (value, of)
            else:
                self._derived.pop(attribute, None)

    def _judge(self, now_s: float) -> None:
        """The codes of the channels that were touched or were not well, and one after the other which lose
        samples."""
        for name in tuple(self._odd):
            quality = self.gates[name].quality(now_s)
            self.codes[name] = int(quality)
            if quality is Quality.OK:
                self._odd.discard(name)
        self._ticks += 1
        name = self._names[self._ticks % len(self._names)]
        (self._losing.add if self.gates[name].losing(now_s) else self._losing.discard)(name)

    def reasons(self) -> list[str]:
        """What is wrong with the channels that were ever heard of, or should have been, in words."""
        said = [
            f"{name}: its source {source!r} has never been heard. Correct [sources], or start it"
            for name, source in (self._awaited.items() if self._waited_s > SILENT_S else ())
        ]
        for name in self._names if self._odd or self._losing else ():
            quality = self.codes[name]
            gate = self.gates[name]
            if quality == Quality.CONFLICT:
                said.append(
                    f"{name}: {gate.source} and {gate.rival} both publish it; {gate.source} is used. "
                    "Choose one under [sources]"
                )
            elif quality not in (Quality.OK, Quality.NEVER_SEEN):
                said.append(f"{name}: {WORDS[Quality(quality)]}")
            elif name in self._losing:
                said.append(f"{name}: samples are lost, less than 60 % of the usual rate arrives")
        return said + self.loud() + self.stamps.reasons(self._now_s)

    def loud(self) -> list[str]:
        """The channels that are much noisier than they used to be, in words."""
        return [f"{name}: far noisier than it was; it weighs less" for name in sorted(self._noise.loud)]

    def jumped(self, names: Iterable[str], now_s: float) -> str:
        """The first of these channels whose last sample was refused as a jump, in words: what is used is the
        one before; "" when there is none."""
        for name in names:
            if self.gates[name].quality(now_s) is Quality.JUMP:
                return f"{name} jumped, and is not believed yet"
        return ""


def motion_of(own: Estimate) -> dict[str, float]:
    """How fast the ship's motion changes position and heading [border units per s]."""
    if not own.ready:
        return {}
    north, east = own.velocity_ned()
    return {"north_m": north, "east_m": east, "heading_true_north_deg": degrees(own.r)}


def noise_allowances(ship: Ship) -> dict[str, float]:
    """What an instrument's noise may add to the change between two samples [border units], by the ship's
    own scale."""
    speed = max(0.15 * ship.U_0, 0.5)
    return {
        "north_m": 10.0,
        "east_m": 10.0,
        "heading_true_north_deg": 3.0,
        "surge_velocity_mps": speed,
        "sway_velocity_mps": speed,
        "surge_velocity_through_water_mps": speed,
        "sway_velocity_through_water_mps": speed,
        "yaw_rate_degps": max(degrees(0.4 * ship.U_0 / ship.L_pp), 0.5),
        "rudder_angle_deg": 3.0,
        "propeller_rate_rpm": 30.0,
        "roll_deg": 5.0,
    }


def _frozen(channel: Channel, allowances: dict[str, float]) -> Frozen | None:
    if channel.name in MOVING:
        return Frozen(least=0.5 * allowances[channel.name], wraps=channel.wraps)
    return Frozen(wraps=channel.wraps) if channel.name in NOISY else None
