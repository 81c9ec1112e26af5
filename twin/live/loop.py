"""The page to read first: one tick of the twin, from what came in to what goes out.

Each object takes messages and gives messages; none of them knows a clock, a file or a socket. So the same
objects run live, in a replay and in a test, and the same messages give the same states.
"""

from collections.abc import Callable, Iterable
from typing import Any, Protocol

from twin.live.clock import Instant
from twin.live.gates.crosscheck import CrossChecks
from twin.live.gates.faults import KnownFaults
from twin.live.gates.lacking import CorrectedTick
from twin.live.gates.sensors import Sensors
from twin.live.guard import CONTROLS, INVALID, NO_HEADING, Guard
from twin.live.keelson.decode import Decoder, Result
from twin.live.learning.filtered_regression import Three
from twin.live.learning.learned_force import LearnedForce
from twin.live.observer.controls import actuator_channels
from twin.live.observer.dynamics import Dynamics
from twin.live.observer.estimate import Estimate
from twin.live.observer.observer import Observer
from twin.live.observer.predict import LearnedAt, Predictor
from twin.live.outbox import Outbox
from twin.live.prediction.prediction_tube import PredictionTube
from twin.live.provenance import identity
from twin.live.seen import Pace, Seen, Standing
from twin.live.signals.channels import BY_NAME
from twin.live.signals.measured import Measured, Numbers
from twin.live.stabilizer import Stabilizer
from twin.live.stopwatch import Parts
from twin.num import as_given
from twin.physics.ship import Ship

PARAMETERS_EVERY = 10  # ticks between two lists of adapted numbers


class Ears(Protocol):
    """Where results come from, and who puts positions on the chart."""

    decoder: Decoder

    def read(self, instant: Instant) -> list[Result]:
        """What came in since the last tick."""


class Loop:
    """A ship's twin between two ticks; `watched` adds alarms of bus and log to the reasons, `dropped` what
    the log lost."""

    def __init__(
        self,
        ship: Ship,
        ears: Ears,
        voice: Outbox,
        learned: LearnedForce,
        rate_hz: float = 10.0,
        gain: float = 0.0,
        stabilizer: Stabilizer | None = None,
        predictor: Predictor | None = None,
        sensors: Sensors | None = None,
        guard: Guard | None = None,
        observer: Observer | None = None,
    ):
        self.ship, self.rate_hz, self.period_s = ship, rate_hz, 1.0 / rate_hz
        self.ears, self.voice, self.learned = ears, voice, learned
        self.sensors = sensors or Sensors(ship)
        self.dynamics, self.faults = Dynamics(ship), KnownFaults(ship)
        self.observer = observer or Observer(ship, gain, self.dynamics.first_current)
        self.guard = guard or Guard(ship, learned, period_s=self.period_s)
        self.checks = CrossChecks(ship, self.period_s)
        self.predictor = predictor or Predictor(ship, rate_hz=rate_hz)
        self.tube = PredictionTube(ship)
        self.stabilizer = stabilizer or Stabilizer()
        self.publisher = voice.publisher
        self.publisher.identity, self.publisher.actuators = identity(ship), actuator_channels(ship)
        self.pace = Pace(rate_hz)
        self.overruns = 0
        self.notes: list[str] = []  # said once, at the start: files left out, rights not granted
        self.logged: list[str] = []  # the same with paths and hashes, for the log and nobody's alarm
        self.watched: Callable[[], list[str]] = list
        self.dropped: Callable[[], int] = int
        self.last: Seen | None = None
        self._last_s: float | None = None

    def tick(self, instant: Instant) -> Any:
        """One tick: the wide record of everything that was known in it."""
        dt = self._elapsed(instant)
        arrived = self.ears.read(instant)
        measured = self.sensors.read(arrived, instant.time_s, instant.wall_s, self.observer.estimate)
        estimate = self.observer.correct(
            self.faults.undo(measured, self.observer.estimate, self.observer.rates)
        )
        situation, physics, forces = self.dynamics.known(estimate, measured)
        self.checks.feed(CorrectedTick(measured, self.observer, situation, physics, forces, dt))
        verdict = self.guard.judge(
            measured, estimate, self.sensors.reasons(), dt, self._doubts(instant.time_s)
        )
        learned = self.learned.at(situation, forces, verdict.use_learned)
        self.guard.note(learned, dt, self.stabilizer.broken)
        self.learned.learn(self._nu(measured), situation, forces, learned, physics, dt, verdict.frozen)
        self.dynamics.adopt(self.learned.effects)
        self.observer.steer(self.dynamics.ahead(situation, forces, learned.force, self.period_s))
        self.observer.remember(self.dynamics.now, situation, learned.force)
        foretold = self.predictor.advance(
            instant.time_s,
            estimate,
            situation,
            physics,
            self.learned_at(verdict.use_learned),
            verdict.mode != INVALID,
            self.dynamics.steering,
        )
        ahead = self.tube.around(instant.time_s, measured, estimate, foretold, verdict.mode != INVALID)
        certified = self.stabilizer.step(
            self.observer,
            measured,
            situation,
            dt,
            verdict.odd or self._doubt(measured),
            learned.weight > 0.0,
        )
        self.last = Seen(
            instant, measured, estimate, situation, physics, forces, verdict, learned, ahead, certified
        )
        tick = self.publisher.tick(self.last, self._standing(self.last))
        self.voice.send(tick, self.ears.decoder.chart)
        self._carry_chart(measured.si, estimate)
        return tick

    def _carry_chart(self, si: Numbers, e: Estimate) -> None:
        """From the next tick on the chart touches the earth near the ship: where it is measured, or else
        believed, to be."""
        decoder = self.ears.decoder
        if decoder.chart is not None and e.ready:
            decoder.chart = decoder.chart.near(si.get("x", e.x), si.get("y", e.y))

    def _doubts(self, now_s: float) -> list[str]:
        """Which instruments contradict each other, in words: nothing is learned from them."""
        return [*self.checks.reasons, *self.sensors.rivals.reasons(now_s)]

    def _doubt(self, measured: Measured) -> str:
        """Why the certificate may not believe what is measured; "" when it may."""
        if "psi" in measured.derived:
            return NO_HEADING
        return (
            self.learned.helm.stuck
            or next(iter(self._doubts(measured.now_s)), "")
            or next(iter(self.sensors.loud()), "")
            or self.sensors.stamps.unsure(measured.now_s)
            or self.sensors.jumped(CONTROLS.values(), measured.now_s)
        )

    def measure_parts(self) -> Parts:
        """Stop-watches around every part from now on (the bench asks)."""
        parts = Parts()
        for part, thing, method in (
            ("read", self.ears, "read"),
            ("sensors", self.sensors, "read"),
            ("correct", self.observer, "correct"),
            ("known", self.dynamics, "known"),
            ("checks", self.checks, "feed"),
            ("guard", self.guard, "judge"),
            ("learned", self.learned, "at"),
            ("step", self.dynamics, "ahead"),
            ("adapt", self.learned, "learn"),
            ("predict", self.predictor, "advance"),
            ("tube", self.tube, "around"),
            ("certificate", self.stabilizer, "step"),
            ("publish", self.publisher, "tick"),
            ("record", self.voice, "send"),
            ("tick", self, "tick"),
        ):
            parts.watch(part, thing, method)
        return parts

    def _elapsed(self, instant: Instant) -> float:
        dt = instant.time_s - (self._last_s if self._last_s is not None else instant.time_s)
        self._last_s = instant.time_s
        self.overruns += instant.skipped
        self.pace = self.pace._replace(overruns=self.overruns)
        return dt

    def _nu(self, measured: Measured) -> Three | None:
        return measured_nu(measured, self.guard.controls)

    def learned_at(self, allowed: bool = True) -> LearnedAt:
        """The learned force as the predictor carries it ahead."""
        return lambda s, forces: self.learned.at(s, forces, allowed).force

    def _standing(self, seen: Seen) -> Standing:
        adaptation = self.learned.adaptation
        parameters = (
            adaptation.parameters() if adaptation and seen.instant.number % PARAMETERS_EVERY == 0 else []
        )
        share = self.learned.share(seen.learned, seen.forces)
        return Standing(
            self.pace,
            self._reasons(seen),
            self.sensors.codes,
            share,
            parameters,
            self.sensors.rejected,
            self.dropped(),
        )

    def _reasons(self, seen: Seen) -> list[str]:
        said = [*seen.verdict.reasons, *self.watched()]
        for attribute, value in self.dynamics.held.items():
            channel = BY_NAME[self.guard.controls[attribute]]
            said.append(
                f"{channel.name} is lost: its last value, {as_given(value / channel.to_si, 4)}, is held and "
                "may no longer be so"
            )
        if self.stabilizer.outside:
            said.append(f"certificate: {self.stabilizer.outside}")
        if self.tube.beyond:
            said.append(f"prediction tube: no promise, {self.tube.beyond}")
        if self.dynamics.off:
            said.append(
                f"effects without their inputs: {', '.join(type(e).__name__ for e in self.dynamics.off)}"
            )
        if seen.instant.number < 10.0 * self.rate_hz:
            said += [note for note in self.notes if note not in said]
        return said


def measured_nu(measured: Measured, controls: Iterable[str] = CONTROLS) -> Three | None:
    """What the adaptation learns from: speed over ground and rate of turn, measured, with controls; else
    None."""
    si = measured.si
    if measured.derived & {"u", "psi"} or not measured.has("u", "v", "r", "psi", *controls):
        return None
    return si["u"], si["v"], si["r"]
