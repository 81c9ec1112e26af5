"""A receiver that is late by what an agile boat needs to sail its own length."""

import numpy as np
import pytest

from tests.thorough import one_of, thorough
from twin.physics.effects import catalogue
from twin.physics.effects.sensor_delay import SensorDelay
from twin.physics.maths import RAD
from twin.physics.model import Model
from twin.physics.ship import load
from twin.physics.state import Situation
from twin.recording.voyage import Voyage
from twin.study.diagnosis.assemble import assemble
from twin.study.diagnosis.refine import refine
from twin.study.estimation.fit import fit
from twin.study.estimation.innovations import NoiseModel
from twin.study.estimation.of_effect import effect_unknowns
from twin.study.prediction.trial import shaft_speed
from twin.study.track.track import track

STEP_S, STEPS, SEED = 0.1, 2400, 3
DAMPING = ("X_uu", "Y_uv", "N_ur", "Y_vv", "N_uv")


@pytest.fixture(scope="module")
def boat():
    return Model.of(load("usv"))


@pytest.fixture(scope="module")
def late_by(boat):
    """A voyage with a receiver that shows what was so many seconds ago, by these: four minutes of rudder to either side for some seconds each, at a speed that changes; noise as of good
    instruments."""
    rng, turns = np.random.default_rng(SEED), float(shaft_speed(boat, float(boat.ship.scale("speed"))))
    rudder = np.repeat(rng.choice([-0.35, -0.2, 0.0, 0.2, 0.35], STEPS), rng.integers(20, 60, STEPS))[:STEPS]
    n = turns * np.repeat(rng.choice([0.6, 1.0, 1.2], STEPS), 130)[:STEPS]
    rows, state = [], (0.0, 0.0, 0.3, 1.0, 0.0, 0.0)
    for k in range(STEPS):
        rows.append(state)
        state = boat.step(state, Situation(delta=rudder[k], n=n[k], t=k * STEP_S), STEP_S)
    noise = rng.normal(size=(STEPS, 6)) * [0.01, 0.01, 2e-3, 0.02, 0.02, 2e-3]
    x, y, psi, u, v, r = (np.array(rows) + noise).T
    over = (u + 1j * v) * np.exp(1j * np.array(rows)[:, 2])  # as a receiver has it, turned by the compass
    t = STEP_S * np.arange(STEPS)

    def voyage(late_s):
        shown = np.interp(t - late_s, t, over) * np.exp(-1j * psi)
        columns = {
            "north_m": np.interp(t - late_s, t, x),
            "east_m": np.interp(t - late_s, t, y),
            "heading_true_north_deg": np.mod(psi * RAD, 360.0),
            "surge_velocity_mps": shown.real,
            "sway_velocity_mps": shown.imag,
            "yaw_rate_degps": r * RAD,
            "rudder_angle_deg": rudder * RAD,
            "propeller_rate_rpm": n * 60.0,
        }
        return Voyage("agile", t, columns, {"velocity_frame": "course"})

    return voyage


@pytest.mark.parametrize(
    ("stronger", "least_s"), [(1.0, 0.9), (1.4, 0.6)], ids=["right model", "damping two fifths too strong"]
)
def test_a_receiver_that_is_late_for_an_agile_boat_is_found_to_be_late(boat, late_by, stronger, least_s):
    """Expected: what the receiver showed a second late is found to be late, although the boat turned by
    twenty degrees meanwhile and accelerated otherwise than the model has it, which costs some of that
    second."""
    own = {n: stronger * float(getattr(boat.ship.derivatives, n)) for n in DAMPING}
    model = Model.of(boat.ship.with_derivatives(**own))
    unknowns = effect_unknowns(SensorDelay, model)
    found = fit([track(late_by(1.0), model.ship)], model, unknowns, catalogue(), NoiseModel())
    delay, sd = found.value[0], found.sd[0]
    assert unknowns[0].name == "delay" and least_s < delay < 1.05
    assert 1e-3 < sd < 0.03


@thorough
@pytest.mark.parametrize("late_s", one_of([0.35, 0.75]))
def test_how_late_a_receiver_is_is_found_between_two_steps_of_the_grid(boat, late_by, late_s):
    """Expected: as late as it is, by what the estimate knows of it, though what it shows seems less likely
    half a step from any, and the boat was never calibrated."""
    case = assemble([late_by(late_s)], boat.ship)
    found, _ = refine(case, ("SensorDelay",), "usual", np.zeros(len(case.effects)), ())
    (i,) = (i for i, u in enumerate(case.effects) if u.label == "SensorDelay.delay")
    delay, sd = case.effects[i].sd * np.array([found.posterior.z[i], found.posterior.covariance[i, i] ** 0.5])
    assert 0.05 < sd < 0.2 and abs(delay - late_s) < 1.5 * sd
