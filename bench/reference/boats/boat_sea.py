"""One craft at sea in real steps: drives with lags, hull, air, instruments. `BoatSea` has the face of
`bench.reference.Sea`: step() and readings()."""

import math
import random
from collections import deque
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from bench.reference.boats import drives
from bench.reference.boats.actuator_faults import SILENT_FROM_S, hidden_in
from bench.reference.boats.craft import CRAFT, Craft, Drive
from bench.reference.boats.helmsman import BoatHelmsman
from bench.reference.boats.hull import BoatHull

AIR = 1.225
STOP_US, SPAN_US = 1500.0, 400.0
DEAD = 0.03  # share of full up to which a motor stands still


@dataclass(frozen=True)
class BoatCase:
    """One voyage; `hidden`: pairs of effect and size (actuator_faults.py). wind [m/s] mean and from [deg],
    current [m/s] north and east."""

    craft: str = "catamaran"
    manoeuvre: str = "mixed"
    hidden: tuple[tuple[str, float], ...] = ()
    seed: int = 1
    wind: tuple[float, float] = (0.5, 0.0)
    current: tuple[float, float] = (0.0, 0.0)
    noisy: bool = True


@dataclass
class Turning:
    """A drive now: turns [1/s], angle [rad], and what it was ordered lately."""

    drive: Drive
    n: float = 0.0
    angle: float = 0.0
    order: tuple[float, float] = (0.0, 0.0)
    orders: deque = field(default_factory=lambda: deque(maxlen=256))


class BoatSea:
    """A craft between two ticks; everything comes from the case's seed."""

    def __init__(self, case: BoatCase, tick_s: float = 0.1):
        self.case, self.dt, self.tick = case, tick_s, 0
        self.craft: Craft = CRAFT[case.craft]
        self.hull = BoatHull(self.craft)
        self.hidden = hidden_in(self.craft, case.hidden)
        self.helmsman = BoatHelmsman(self.craft, case.manoeuvre, case.seed)
        self.random = random.Random(case.seed * 7919 + 1)
        grips = [d.grip * (1.0 - self.hidden[d.name].screw) for d in self.craft.drives]
        self.turning = [
            Turning(replace(d, grip=grip)) for d, grip in zip(self.craft.drives, grips, strict=True)
        ]
        psi = math.radians(self.random.uniform(0.0, 360.0))
        self.state = (0.0, 0.0, psi, 0.6 * self.craft.U0, 0.0, 0.0)  # u, v, r through the water
        self.gust = 0.0
        self.substeps = max(round(tick_s / (0.02 if self.craft.L < 20 else 0.05)), 1)
        self._past: deque = deque(maxlen=64)
        self._look()

    def step(self) -> None:
        """A tick on."""
        h = self.dt / self.substeps
        for _ in range(self.substeps):
            for one in self.turning:
                self._turn(one, h)
            self.state = self._along(h)
        self.tick += 1
        self._look()

    def _look(self) -> None:
        t = self.tick * self.dt
        for one in self.turning:
            one.order = self.helmsman.orders(t, self.state[2])[one.drive.name]
            one.orders.append((t, one.order))
        self.gust += self.dt / 4.0 * -self.gust + 0.15 * math.sqrt(self.dt / 2.0) * self.random.gauss(
            0.0, 1.0
        )
        self._past.append(self._over_ground())
        self.row = self._read(t)

    def _turn(self, one: Turning, h: float) -> None:
        """Motor and servo, by what was ordered when its hidden delay says."""
        d, state = one.drive, self.hidden[one.drive.name]
        due = self.tick * self.dt - state.late
        share, angle = next((o for t, o in reversed(one.orders) if t <= due + 1e-9), one.orders[0][1])
        share = share - state.zero
        wanted = 0.0 if abs(share) < DEAD else d.n_max * math.copysign(abs(share) ** 0.75, share)
        one.n += h / (d.lag + h) * (wanted - one.n)
        most = d.servo * h
        one.angle += min(max(angle - one.angle, -most), most)

    def _along(self, h: float) -> tuple[float, ...]:
        a = self._rates(self.state)
        b = self._rates(tuple(x + 0.5 * h * k for x, k in zip(self.state, a, strict=True)))
        return tuple(x + h * k for x, k in zip(self.state, b, strict=True))

    def _rates(self, s: tuple[float, ...]) -> tuple[float, ...]:
        _, _, psi, u, v, r = s
        c, hull = self.craft, self.hull
        X, Y, N = hull.force(u, v, r)
        for one in self.turning:
            d, state = one.drive, self.hidden[one.drive.name]
            ahead, aside = drives.KINDS[d.kind](
                d, one.n, one.angle + state.turned, u - d.y * r, v + d.x * r, c.rho
            )
            left = 1.0 - state.worn
            X, Y, N = X + left * ahead, Y + left * aside, N + left * (d.x * aside - d.y * ahead)
        cs, sn = math.cos(psi), math.sin(psi)
        north, east = self.case.current
        blow = self._blow()
        along = blow[0] * cs + blow[1] * sn - u - (north * cs + east * sn)
        across = blow[1] * cs - blow[0] * sn - v - (east * cs - north * sn)
        speed = math.hypot(along, across)
        X, Y = X + 0.4 * AIR * c.air[0] * speed * along, Y + 0.45 * AIR * c.air[1] * speed * across
        X += (c.m + hull.m_y) * v * r + c.m * c.x_G * r * r
        Y -= (c.m + hull.m_x) * u * r
        N -= c.m * c.x_G * u * r
        a, b, e = c.m + hull.m_y, c.m * c.x_G + hull.a_y, hull.I_z + hull.J_z
        det = a * e - b * b
        return (
            (u + north * cs + east * sn) * cs - (v + east * cs - north * sn) * sn,
            (u + north * cs + east * sn) * sn + (v + east * cs - north * sn) * cs,
            r,
            X / (c.m + hull.m_x),
            (e * Y - b * N) / det,
            (a * N - b * Y) / det,
        )

    def _blow(self) -> tuple[float, float]:
        """The air over ground, towards north and east."""
        speed, come = self.case.wind[0] * (1.0 + self.gust), math.radians(self.case.wind[1])
        return -speed * math.cos(come), -speed * math.sin(come)

    def _over_ground(self) -> tuple[float, ...]:
        x, y, psi, u, v, r = self.state
        c, s = math.cos(psi), math.sin(psi)
        north, east = self.case.current
        return x, y, psi, u + north * c + east * s, v + east * c - north * s, r, u, v

    def _read(self, t: float) -> dict[str, float]:
        """What the instruments say at this tick, NaN where there is no sample."""
        noise = self.craft.noise if self.case.noisy else (0.0,) * 5
        g = self.random.gauss
        row = dict.fromkeys(columns_of(self.craft), math.nan)
        row["time_s"] = t
        *_, psi, u, v, r, u_r, v_r = self._past[-1]
        row["heading_true_north_deg"] = (math.degrees(psi) + g(0.0, noise[2])) % 360.0
        row["yaw_rate_degps"] = math.degrees(r) + g(0.0, noise[3])
        if self.tick % 2 == 0:  # a satellite receiver, one tick late
            x, y, _, u, v, *_ = self._past[-2 if len(self._past) > 1 else -1]
            row["north_m"], row["east_m"] = x + g(0.0, noise[0]), y + g(0.0, noise[0])
            row["surge_velocity_mps"], row["sway_velocity_mps"] = u + g(0.0, noise[1]), v + g(0.0, noise[1])
        if self.tick % 5 == 0:
            row["surge_velocity_through_water_mps"] = u_r + g(0.0, noise[4])
            row["sway_velocity_through_water_mps"] = v_r + g(0.0, noise[4])
        if self.tick % 10 == 0:
            row["true_wind_speed_mps"] = math.hypot(*self._blow())
            row["true_wind_direction_deg"] = self.case.wind[1]
        for one in self.turning:
            if not (self.hidden[one.drive.name].silent and t >= SILENT_FROM_S):
                row |= self._of_drive(one)
        return row

    def _of_drive(self, one: Turning) -> dict[str, float]:
        """Its feedback; of one that is late, and of what has no feedback, the order."""
        d = one.drive
        late = self.hidden[d.name].late > 0.0
        share, angle = one.order
        n = d.n_max * math.copysign(abs(share) ** 0.75, share) if late else one.n
        full = {
            "pwm_us": STOP_US + SPAN_US * share,
            "command": share,
            "rate_rpm": 60.0 * n,
            "angle_deg": math.degrees(angle if late else one.angle),
        }
        return {f"{d.name}.{what}": full[what] for what in d.records}

    def readings(self) -> dict[str, float]:
        return dict(self.row)


def columns_of(craft: Craft) -> list[str]:
    """The columns of a voyage of this craft."""
    usual = (
        "time_s",
        "north_m",
        "east_m",
        "heading_true_north_deg",
        "surge_velocity_mps",
        "sway_velocity_mps",
        "surge_velocity_through_water_mps",
        "sway_velocity_through_water_mps",
        "yaw_rate_degps",
        "true_wind_speed_mps",
        "true_wind_direction_deg",
    )
    return [*usual, *(f"{d.name}.{what}" for d in craft.drives for what in d.records)]


def sail(case: BoatCase, seconds: float, tick_s: float = 0.1) -> dict[str, np.ndarray]:
    """A whole voyage as columns."""
    sea, rows = BoatSea(case, tick_s), []
    for _ in range(round(seconds / tick_s)):
        rows.append(sea.readings())
        sea.step()
    return {name: np.array([row[name] for row in rows]) for name in columns_of(sea.craft)}


def write_csv(columns: dict[str, np.ndarray], path: Path) -> None:
    """The measured columns, empty where there was no sample."""
    with open(path, "w") as out:
        out.write(",".join(columns) + "\n")
        for row in zip(*(x.tolist() for x in columns.values()), strict=True):
            out.write(",".join("" if x != x else f"{x:.10g}" for x in row) + "\n")
