"""The twin's own loop against the same adversaries: `twin-bench stability` sails it beside the fleets.

What a Fleet's observer leaves out is all here: readings by channel, gates that refuse, samples that pull by
less than K, a heading that is estimated. Every other ship's instruments are half a sample late. Only the
network and the adaptation are off: the whole disturbance is the ship's. A tick counts when the loop itself
says that its certificate holds."""

from typing import NamedTuple

import numpy as np

from bench.stability.adversary_fleet import AdversaryFleet
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.physics.model import Model
from twin.physics.state import Situation

BEGIN_S, WALL = 500.0, 1.7e9  # the loop's clock at the first tick, and the wall's at its zero
# a rudder or a shaft that jumps is refused by the gates
STEERS = np.radians(2.5)  # rad/s
REVS_UP = 50.0  # 1/s2, half of what a gate takes
CHANNELS = (
    "north_m",
    "east_m",
    "heading_true_north_deg",
    "surge_velocity_mps",
    "sway_velocity_mps",
    "yaw_rate_degps",
    "rudder_angle_deg",
    "propeller_rate_rpm",
    "wave_height_significant_m",
)
SPEEDS = [CHANNELS.index(name) for name in ("surge_velocity_mps", "sway_velocity_mps", "yaw_rate_degps")]


class LoopCase(NamedTuple):
    """One line of the table: which ship, how often, how many runs; `H_s` [m]: in waves
    the ship is turned hard as well, so that it goes in and out of the usual set."""

    ship: str
    rate_hz: float
    runs: int
    dropouts: bool = False
    H_s: float = 0.0


CASES = (
    LoopCase("kvlcc2", 10.0, 40),
    LoopCase("kvlcc2", 10.0, 25, dropouts=True),
    LoopCase("container", 10.0, 10),
    LoopCase("container", 50.0, 10),
    LoopCase("usv", 50.0, 10),
    LoopCase("usv", 10.0, 10),
    LoopCase("kvlcc2", 10.0, 10, H_s=1.5),
    LoopCase("container", 10.0, 10, H_s=0.8),
)


class Loops(AdversaryFleet):
    """Ships as in a Fleet; estimate, bound and whether it holds (`alive`) are each one's own loop's."""

    def __init__(self, case: LoopCase, runs: int, seed: int) -> None:
        settings = Settings(
            {
                "ship.file": case.ship,
                "loop.rate_hz": case.rate_hz,
                "residual.file": "none",
                "adaptation.on": False,
            }
        )
        self.ears = [Played([]) for _ in range(runs)]
        self.loops = [
            loop_of(settings, ears, Outbox(Publisher(), "twin", "ship"), None) for ears in self.ears
        ]
        tube, self.rudder = self.loops[0].stabilizer.tube, np.zeros(runs)
        self.shaft: np.ndarray | None = None  # as first ordered
        assert tube is not None, self.loops[0].stabilizer.why_not
        model = Model.of(self.loops[0].ship)
        super().__init__(model, tube.certificate, runs, seed, case.H_s, case.dropouts)
        self.halfway, self.late = self.truth, np.arange(runs) % 2 == 1

    def step(self, k: int) -> np.ndarray:
        """One tick of all loops on what their ships' instruments say, then the ships sail on; (3, runs) the
        error at the tick. Rudder and shaft move before the tick: what they moved within a sample would be a
        force beyond the adversary's, which takes all of D."""
        self._helm()
        shaft, most = self.inputs["n"] if self.shaft is None else self.shaft, REVS_UP * self.h
        self.shaft = shaft + np.clip(self.inputs["n"] - shaft, -most, most)
        self.rudder += np.clip(self.inputs["delta"] - self.rudder, -STEERS * self.h, STEERS * self.h)
        self._tick(k)
        error = self.estimate - np.array(self.truth[3:])
        self.push = (
            -np.sign(self.inverse.T @ (self._against(k) / np.array(self.c.bound)[:, None])) * self.limit
        )
        at = Situation(delta=self.rudder, n=self.shaft)
        self.halfway = self.true.step(self.truth, at, 0.5 * self.h)
        self.truth = self.true.step(self.halfway, at, 0.5 * self.h)
        return error

    def _helm(self) -> None:
        super()._helm()
        if self.H_s:
            over = self.c.operating.ranges["delta"][1]
            self.inputs["delta"] = np.copysign(over, self.inputs["delta"])

    def _tick(self, k: int) -> None:
        now_s = BEGIN_S + k * self.h
        self.received = self._received()
        for i, (loop, ears, values) in enumerate(
            zip(self.loops, self.ears, self._instruments(k).T.tolist(), strict=True)
        ):
            said = zip(CHANNELS, values, strict=True)
            taken_s = now_s - 0.5 * self.h * float(self.late[i])
            ears.next = [
                Reading(channel, x, WALL + taken_s, now_s, "ship") for channel, x in said if np.isfinite(x)
            ]
            tick, e = loop.tick(Instant(k, now_s, WALL + now_s)), loop.observer.estimate
            self.estimate[:, i], self.tube[:, i], self.alive[i] = (
                (e.u, e.v, e.r),
                loop.stabilizer.tube.beta,
                tick.certificate.inside,
            )

    def _instruments(self, k: int) -> np.ndarray:
        """(9, runs) by channel, off by as much as the certificate allows; NaN where nothing comes."""
        side = self._against(k)
        x, y, psi, *nu = np.where(self.late, self.halfway, self.truth)
        u, v, r = np.array(nu) + self.noise * side
        heading = np.degrees(psi + self.heading_noise * side[2]) % 360.0
        assert self.shaft is not None
        said = np.array(
            [
                x,
                y,
                heading,
                u,
                v,
                np.degrees(r),
                np.degrees(self.rudder),
                60.0 * self.shaft,
                self.H_s + 0.0 * u,
            ]
        )
        said[SPEEDS] = np.where(self.received, said[SPEEDS], np.nan)
        return said
