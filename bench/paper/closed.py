"""The paper's Fig. 5: a heading controller with the residual as corrector, tau_total = tau_analytic +
tau_corr, on the reference sea.

A step of 15 degrees through a critically damped reference of third order, a gust of 10 m/s from abeam seven
ship lengths later. The rudder is the one for which the model gives the yaw acceleration that is wanted,
    r_dot(nu_hat, delta) = r_dot_d + 2 w_c (r_d - r_hat) + w_c^2 e + k_i int e,        e = psi_d - psi
tau_analytic and tau_corr both in r_dot, nu_hat by the observer with gain K from log, gyro and compass as
measured, one tick late. Times are in ship lengths sailed: the paper's seconds are those of a model (Froude
scale 1:64 divides time by eight)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from bench.paper.paper_voyages import SCENARIOS
from bench.reference import Sea, SeaCase
from export.residual_network import ResidualNetwork
from twin.physics import core
from twin.physics.model import Model
from twin.physics.state import Situation

STEP_DEG, GUST_MPS = 15.0, 10.0
BEFORE, GUST_AT, GUST_LONG, END = 3.0, 7.0, 1.0, 12.0  # in L/U, of the step
REFERENCE, CONTROL, INTEGRAL, K = 1.4, 2.0, 0.25, 12.0  # w_r, w_c, k_i/w_c^2 and the observer's gain, in U/L
HARD_OVER = np.radians(35.0)
ORDER_S = 0.5  # between two orders
SETTLED, STEADY = 0.05, 0.02  # of the step
MODES = ("analytic alone", "with the residual", "with a hostile residual")
SPEEDS = ("surge_velocity_through_water_mps", "sway_velocity_through_water_mps")


class Steered(Sea):
    """The reference sea with another helmsman, and a gust from starboard abeam."""

    def __init__(self, cases: Sequence[SeaCase], helm: "ClosedLoopHelm", tick_s: float):
        self.helm = helm
        super().__init__(list(cases), tick_s)

    def _build(self) -> None:
        super()._build()
        self.unit = self.h.L / self.h.U0
        self.helm.begin(self)
        self.pilot = self.helm

    def _controls(self, t: float) -> None:
        env, since = self.env, t / self.unit - BEFORE
        blown = np.where((since >= GUST_AT) & (since < GUST_AT + GUST_LONG), GUST_MPS, 0.0)
        abeam = self.heading + np.radians(STEP_DEG + 90.0)
        north = env.wind_speed * np.cos(env.wind_from) + blown * np.cos(abeam)
        east = env.wind_speed * np.sin(env.wind_from) + blown * np.sin(abeam)
        env.wind_speed, env.wind_from = np.hypot(north, east), np.arctan2(east, north)
        super()._controls(t)


class ClosedLoopHelm:
    """Every ship's controller; `mode` (B,) is an index of MODES. `order` is what the sea asks of a
    helmsman."""

    def __init__(self, model: Model, network: ResidualNetwork, mode: np.ndarray, seed: int = 1):
        self.model, self.network, self.mode = model, network, mode
        self.time = float(model.ship.scale("time"))
        rng = np.random.default_rng(seed)
        self.period = self.time * rng.uniform(0.2, 2.0, mode.size)
        self.corner = rng.choice([-1.0, 1.0], (mode.size, 3))
        self.kept: list[np.ndarray] = []  # at each order: t, psi, r, rudder, e, r_d for each ship

    def begin(self, sea: Steered) -> None:
        self.sea, many = sea, self.mode.size
        self.n = sea.h.n0 * np.ones(many)
        self.seen = {name: np.zeros(many) for name in ("air_ahead", "air_aside")}
        self.nu = np.stack([sea.h.U0 * np.ones(many), np.zeros(many), np.zeros(many)])
        self.wanted = np.stack([sea.heading, np.zeros(many), np.zeros(many)])  # psi_d, r_d, r_dot_d
        self.sum, self.delta, self.tick = np.zeros(many), np.zeros(many), 0
        self.last = {
            "psi": sea.heading.copy(),
            "u": self.nu[0].copy(),
            "v": np.zeros(many),
            "r": np.zeros(many),
        }

    def order(
        self, t: float, psi: np.ndarray, r: np.ndarray, u: np.ndarray, dt: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Rudder order and propeller rate; truth is only kept for judging, the instruments of the last tick
        are what counts."""
        if self.tick:
            self._listen()
        if self.tick % round(ORDER_S / dt) == 0:
            self._decide(t, ORDER_S)
            self.kept.append(
                np.stack([np.full(psi.size, t), psi, r, self.sea.gear, self._error(psi), self.wanted[1]])
            )
        self.tick += 1
        return self.delta, self.n

    def _listen(self) -> None:
        row, last = self.sea.row, self.last
        heading = np.radians(row["heading_true_north_deg"])
        turned = (heading - last["psi"] + np.pi) % (2 * np.pi) - np.pi
        last["psi"] = np.where(np.isfinite(heading), last["psi"] + turned, last["psi"])
        for key, x in (
            ("u", row[SPEEDS[0]]),
            ("v", row[SPEEDS[1]]),
            ("r", np.radians(row["yaw_rate_degps"])),
        ):
            last[key] = np.where(np.isfinite(x), x, last[key])
        speed, angle = row["apparent_wind_speed_mps"], np.radians(row["apparent_wind_angle_deg"])
        for name, x in (("air_ahead", -speed * np.cos(angle)), ("air_aside", -speed * np.sin(angle))):
            self.seen[name] = np.where(np.isfinite(x), x, self.seen[name])

    def _error(self, psi: np.ndarray) -> np.ndarray:
        return (self.wanted[0] - psi + np.pi) % (2 * np.pi) - np.pi

    def _decide(self, t: float, h: float) -> None:
        self._guide(t, h)
        nu_dot = self._rates(self.delta)
        measured = np.stack([self.last[n] for n in "uvr"])
        self.nu = self.nu + h * (nu_dot + K / self.time * (measured - self.nu))
        e, w = self._error(self.last["psi"]), CONTROL / self.time
        self.sum = np.where(np.abs(e) < 0.05, self.sum + h * e, self.sum)
        aim = (
            self.wanted[2]
            + 2.0 * w * (self.wanted[1] - self.nu[2])
            + w**2 * (e + INTEGRAL / self.time * self.sum)
        )
        self.delta = self._rudder_for(aim)

    def _guide(self, t: float, h: float) -> None:
        """psi_d''' = w^3 (target - psi_d) - 3 w^2 psi_d' - 3 w psi_d''."""
        target = self.sea.heading + np.where(t / self.time >= BEFORE, np.radians(STEP_DEG), 0.0)
        w = REFERENCE / self.time
        psi, r, a = self.wanted
        jerk = w**3 * (target - psi) - 3.0 * w**2 * r - 3.0 * w * a
        self.wanted = np.stack([psi + h * r, r + h * a, a + h * jerk])

    def _rudder_for(self, aim: np.ndarray) -> np.ndarray:
        """Two steps of the secant method from where the rudder is."""
        a, b = self.delta, self.delta + 0.02
        fa, fb = self._rates(a)[2] - aim, self._rates(b)[2] - aim
        for _ in range(2):
            slope = (fb - fa) / np.where(np.abs(b - a) > 1e-9, b - a, 1e-9)
            new = b - fb / np.where(np.abs(slope) > 1e-9, slope, -1e-9)
            a, fa, b = b, fb, np.clip(new, -HARD_OVER, HARD_OVER)
            fb = self._rates(b)[2] - aim
        return b

    def _rates(self, delta: np.ndarray) -> np.ndarray:
        """(3, B) the model's accelerations, tau_corr by mode."""
        s = self._situation(delta)
        total = [sum(f) for f in zip(*self.model.forces(s, self.model.water(s)), strict=True)]
        corr = self._corrector(s)
        S = self.network.S
        return np.stack(
            core.accelerations(
                *[f + c * scale for f, c, scale in zip(total, corr.T, S, strict=True)], self.model.c
            )
        )

    def _situation(self, delta: np.ndarray) -> Situation:
        u, v, r = self.nu
        # the wind seen from the water, body axes
        north, east = self.seen["air_ahead"] + u, self.seen["air_aside"] + v
        psi = self.last["psi"]
        return Situation(
            psi=psi,
            u=u,
            v=v,
            r=r,
            delta=delta,
            n=self.n,
            wind_speed=np.hypot(north, east),
            wind_to=psi + np.arctan2(east, north),
        )

    def _corrector(self, s: Situation) -> np.ndarray:
        """(B, 3) in units of the force scale: nothing, what was learned, or whatever does harm within the
        bound."""
        fields = {
            n: torch.tensor(np.asarray(getattr(s, n)), dtype=torch.float32)
            for n in ("psi", "u", "v", "r", "delta", "n")
        }
        fields |= {
            n: torch.tensor(np.asarray(getattr(s, n)), dtype=torch.float32)
            for n in ("u_r", "v_r", "wind_speed", "wind_to")
        }
        t = Situation(**fields)
        with torch.no_grad():
            f = self.network.f(self.network.zeta(t)).double().numpy()
        against = np.sign(self._error(self.last["psi"]))[:, None] * np.ones(3)
        square = self.corner * np.sign(np.sin(2 * np.pi * self.sea.dt * self.tick / self.period))[:, None]
        hostile = (
            float(self.network.bound)
            / np.sqrt(3.0)
            * np.where((np.arange(self.mode.size) % 2 == 0)[:, None], against, square)
        )
        return np.where((self.mode == 0)[:, None], 0.0, np.where((self.mode == 1)[:, None], f, hostile))


@dataclass(frozen=True)
class Closed:
    """All runs: arrays (T, B) with time in L/U since the step, angles in degrees; which scenario and mode
    each is."""

    lengths: np.ndarray
    heading: np.ndarray  # since the step, from the old course
    rate: np.ndarray
    rudder: np.ndarray
    error: np.ndarray  # from the new course
    scenario: np.ndarray
    mode: np.ndarray
    length_s: float
    hard_over_deg: float


def sail(model: Model, network: ResidualNetwork, seeds: int, tick_s: float = 0.1) -> Closed:
    """Every scenario, mode and seed side by side; a seed's sea is the same in all modes."""
    cases = [
        SeaCase("kvlcc2", "straight", ts, seed=70_000 + 10 * k + j, duration_s=None)
        for _ in MODES
        for j, ts in enumerate(SCENARIOS)
        for k in range(seeds)
    ]
    mode = np.repeat(np.arange(len(MODES)), len(SCENARIOS) * seeds)
    helm = ClosedLoopHelm(model, network, mode)
    sea = Steered(cases, helm, tick_s)
    for _ in range(round((BEFORE + END) * float(sea.unit[0]) / tick_s)):
        sea.step()
    t, psi, r, rudder, _, _ = np.array(helm.kept).transpose(1, 0, 2)
    heading = np.degrees((psi - sea.heading + np.pi) % (2 * np.pi) - np.pi)
    return Closed(
        t[:, 0] / float(sea.unit[0]) - BEFORE,
        heading,
        np.degrees(r),
        np.degrees(rudder),
        heading - STEP_DEG,
        np.tile(np.repeat(np.arange(len(SCENARIOS)), seeds), len(MODES)),
        mode,
        float(sea.unit[0]),
        float(np.max(sea.h.rudder_max)),
    )


def table(c: Closed) -> list[dict[str, Any]]:
    """A row for each mode and scenario."""
    rows = []
    for m, mode in enumerate(MODES):
        for j, scenario in enumerate(SCENARIOS):
            rows.append(
                {"mode": mode, "scenario": scenario}
                | _row(c, np.flatnonzero((c.mode == m) & (c.scenario == j)))
            )
    return rows


def _row(c: Closed, k: np.ndarray) -> dict[str, Any]:
    """Worst of all seeds but for the mean settling time."""
    x, error = c.lengths, c.error[:, k]
    calm = (x >= 0) & (x < GUST_AT)
    out = np.abs(error[calm]) > SETTLED * STEP_DEG
    settle = np.array([x[calm][o][-1] if o.any() else 0.0 for o in out.T])
    late = (x >= GUST_AT - 2.0) & (x < GUST_AT)
    gust = (x >= GUST_AT) & (x < GUST_AT + 3.0)
    steady = np.abs(error[late].mean(0)) / STEP_DEG
    rate = np.abs(np.diff(c.rudder[:, k], axis=0)).max() / ORDER_S
    row = {
        "runs": int(k.size),
        "settle_lengths_mean": float(settle.mean()),
        "settle_lengths_max": float(settle.max()),
        "overshoot_percent": float(100 * np.maximum(error[calm].max(0), 0.0).max() / STEP_DEG),
        "steady_error_max": float(steady.max()),
        "gust_deg": float(np.abs(error[gust]).max()),
        "rudder_deg": float(np.abs(c.rudder[:, k]).max()),
        "rudder_degps": float(rate),
    }
    row["settle_s_full_scale"] = row["settle_lengths_mean"] * c.length_s
    row["settle_s_model_1_64"] = row["settle_s_full_scale"] / 8.0
    row["met"] = bool(
        settle.max() <= 5.0
        and row["overshoot_percent"] <= 8.0
        and steady.max() <= STEADY
        and row["rudder_deg"] < c.hard_over_deg - 0.5
    )
    return row
