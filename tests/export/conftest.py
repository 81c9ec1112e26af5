"""Voyages that the twin's own physics sails with a rudder weaker than the ship file says: there is something
to learn."""

import numpy as np
import pytest

from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation
from twin.recording.voyage import Voyage
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track

H, STEPS = 2.0, 600


def voyages(ship, count, current=(0.3, -0.2), seed=1):
    """`count` voyages of 20 min side by side, rudder thrown about, in water that moves; at 0.5 Hz with a
    little noise."""
    rng = np.random.default_rng(seed)
    model, (north, east) = Model.of(ship), current
    flip = rng.integers(40, 90, count)
    size = np.radians(rng.uniform(5, 20, count))
    state = tuple(np.full(count, x) for x in (0.0, 0.0, 0.5, 7.0, 0.0, 0.0))
    rows, n = [], np.full(count, 1.6)
    for k in range(STEPS):
        delta = size * np.where((k // (flip // 2)) % 2, 1.0, -1.0)
        rows.append([*state, delta])
        state = model.step(state, Situation(delta=delta, n=n), H)
    x, y, psi, u, v, r, delta = np.array(rows).transpose(1, 2, 0)
    t = H * np.arange(STEPS)

    def noisy(values, sd):
        return values + sd * rng.standard_normal(values.shape)

    over_u = u + north * np.cos(psi) + east * np.sin(psi)
    over_v = v + east * np.cos(psi) - north * np.sin(psi)
    columns = {
        "north_m": noisy(x + north * t, 0.3),
        "east_m": noisy(y + east * t, 0.3),
        "heading_true_north_deg": np.degrees(noisy(psi, 1e-3)) % 360,
        "yaw_rate_degps": np.degrees(noisy(r, 1e-5)),
        "surge_velocity_mps": noisy(over_u, 0.02),
        "sway_velocity_mps": noisy(over_v, 0.02),
        "surge_velocity_through_water_mps": noisy(u, 0.02),
        "sway_velocity_through_water_mps": noisy(v, 0.02),
        "rudder_angle_deg": np.degrees(delta),
        "propeller_rate_rpm": np.full_like(u, 96.0),
    }
    return [
        Voyage(
            f"v{i}",
            t,
            {name: x[i] for name, x in columns.items()},
            {"start_time_utc": f"2026-05-0{1 + i}T08:00:00Z"},
        )
        for i in range(count)
    ]


@pytest.fixture(scope="session")
def ship():
    return load("kvlcc2")


@pytest.fixture(scope="session")
def sailed(ship):
    weak = ship.with_derivatives(C_L=0.8 * ship.derivatives.C_L, Y_uv=1.2 * ship.derivatives.Y_uv)
    return [Sailed(v, track(v, ship), v.name) for v in voyages(weak, 6)]


@pytest.fixture(scope="session")
def parts(ship, sailed):
    from export.data import leg, model_of, split

    tracks = [s.track for s in sailed]
    model = model_of(ship, tracks)
    return split([leg(t, model) for t in tracks]), model
