"""What is hidden in the truth is there, is what the truth says, and is nowhere else."""

import numpy as np
import pytest

from bench.reference import HULLS, SeaCase, simulate
from bench.reference.hidden_catalogue import CATALOGUE, DECOYS, EFFECTS, OUTSIDE

HULL = HULLS["usv"]
POSITION, SPEED, HEADING, RATE, LOG = HULL.noise
NOISE = {
    "north_m": POSITION,
    "east_m": POSITION,
    "surge_velocity_mps": SPEED,
    "sway_velocity_mps": SPEED,
    "heading_true_north_deg": HEADING,
    "yaw_rate_degps": RATE,
    "surge_velocity_through_water_mps": LOG,
    "sway_velocity_through_water_mps": LOG,
}


@pytest.fixture(scope="module")
def voyages():
    """One voyage for each effect, and the same voyage with nothing hidden: same seed, same noise."""
    cases = [SeaCase("usv", "mixed", seed=11, duration_s=40.0)]
    cases += [SeaCase("usv", "mixed", hidden=((name, 1.0),), seed=11, duration_s=40.0) for name in EFFECTS]
    cases += [SeaCase("usv", "mixed", decoys=(name,), seed=11, duration_s=40.0) for name in DECOYS]
    reference, *others = simulate(cases)
    return reference, dict(zip([*EFFECTS, *DECOYS], others, strict=True))


def change(voyage, reference, name):
    """Root mean square change of a column, in units of its sensor's noise."""
    difference = voyage.columns[name] - reference.columns[name]
    if name.endswith("_deg"):
        difference = (difference + 180) % 360 - 180
    return np.sqrt(np.nanmean(difference**2)) / NOISE[name]


def test_the_names_are_those_of_the_catalogue():
    assert len(CATALOGUE) == 24 and len(OUTSIDE) == 5
    assert {"Wind", "Loading", "SteeringLag", "SpeedLogMisalignment", "GyroBias"} <= set(CATALOGUE)


@pytest.mark.parametrize("effect", EFFECTS)
def test_each_effect_changes_the_voyage_by_more_than_its_noise(effect, voyages):
    reference, others = voyages
    assert max(change(others[effect], reference, name) for name in NOISE) > 2
    assert all(np.isfinite(others[effect].truth[n]).all() for n in ("north", "psi", "u", "v", "r", "phi"))


def test_nothing_hidden_means_nothing_hidden(voyages):
    reference = voyages[0]
    assert reference.hidden == {} and not reference.truth["forces"]["hidden"]["N_Nm"].any()
    assert not reference.known_forces["Y_N"].any()
    wind = np.abs(reference.truth["forces"]["wind"]["X_N"]).max()
    assert wind < 0.05 * np.abs(reference.truth["forces"]["hull"]["X_N"]).max()


@pytest.mark.parametrize(
    "effect", ["Wind", "WaveDrift", "HullFouling", "TowForce", "RudderWear", "PropellerWear", "Bank"]
)
def test_a_hidden_force_has_its_size_on_record(effect, voyages):
    size = voyages[1][effect].hidden[effect]["typical_force"]
    assert set(size) == {"X_N", "Y_N", "N_Nm"} and max(size.values()) > 0


def test_sensor_faults_leave_the_ship_alone(voyages):
    reference, others = voyages
    for effect in (
        "SpeedLogBias",
        "SpeedLogScale",
        "SpeedLogMisalignment",
        "AntennaOffset",
        "SensorDelay",
        "GyroBias",
    ):
        assert others[effect].truth["north"].tobytes() == reference.truth["north"].tobytes(), effect


def test_sensor_faults_are_as_large_as_the_truth_says(voyages):
    reference, others = voyages
    shift = {name: others[name].columns for name in others}

    def mean(effect, column):
        return np.nanmean(shift[effect][column] - reference.columns[column])

    assert mean("GyroBias", "yaw_rate_degps") == pytest.approx(
        others["GyroBias"].hidden["GyroBias"]["bias_degps"]
    )
    bias = others["SpeedLogBias"].hidden["SpeedLogBias"]["surge_bias_mps"]
    assert mean("SpeedLogBias", "surge_velocity_through_water_mps") == pytest.approx(bias, rel=0.1)
    scale = others["SpeedLogScale"].hidden["SpeedLogScale"]["scale_share"]
    u = np.nanmean(reference.truth["u_r"])
    assert mean("SpeedLogScale", "surge_velocity_through_water_mps") == pytest.approx(scale * u, rel=0.1)
    off = others["AntennaOffset"].hidden["AntennaOffset"]
    lever = np.hypot(*(shift["AntennaOffset"][c] - reference.columns[c] for c in ("north_m", "east_m")))
    assert np.nanmedian(lever) == pytest.approx(np.hypot(off["x_m"], off["y_m"]), rel=0.01)


def test_a_biased_compass_reads_too_much(voyages):
    voyage = voyages[1]["HeadingBias"]
    error = voyage.columns["heading_true_north_deg"] - np.degrees(voyage.truth["psi"])
    bias = voyage.hidden["HeadingBias"]["bias_deg"]
    assert np.nanmedian((error + 180) % 360 - 180) == pytest.approx(bias, abs=0.5)


def test_a_lagging_gear_records_its_order(voyages):
    true = voyages[1]["SteeringLag"].truth
    assert np.array_equal(true["rudder_recorded"], true["rudder_order"])
    assert np.abs(true["rudder_recorded"] - true["rudder"]).max() > 0.1
    assert np.array_equal(voyages[0].truth["rudder_recorded"], voyages[0].truth["rudder_feedback"])


def test_a_current_is_where_the_truth_says(voyages):
    voyage = voyages[1]["Current"]
    facts = voyage.hidden["Current"]
    assert voyage.truth["current_north"].mean() == pytest.approx(facts["north_mps"], abs=0.03)
    assert voyage.truth["current_east"].mean() == pytest.approx(facts["east_mps"], abs=0.03)


def test_decoys_are_seen_and_either_known_or_powerless(voyages):
    others = voyages[1]
    for name, column, least in (
        ("wind", "true_wind_speed_mps", 4.0),
        ("waves", "wave_height_significant_m", 0.05),
    ):
        acting, powerless = others[name], others[f"{name}_no_force"]
        assert np.nanmean(acting.columns[column]) > least and np.nanmean(powerless.columns[column]) > least
        assert np.abs(acting.known_forces["Y_N"]).max() > 0 and acting.hidden == {}
        origin = "wind" if name == "wind" else "waves"
        assert not powerless.truth["forces"][origin]["Y_N"].any() and not powerless.known_forces["Y_N"].any()
    force = others["wind"].truth["forces"]["wind"]
    assert np.array_equal(others["wind"].known_forces["N_Nm"], force["N_Nm"])


def test_strength_scales_an_effect():
    cases = [
        SeaCase("usv", "straight", hidden=(("RudderOffset", s),), seed=2, duration_s=5.0) for s in (0.5, 1.0)
    ]
    half, whole = (v.hidden["RudderOffset"]["offset_deg"] for v in simulate(cases))
    assert whole == pytest.approx(2 * half) and abs(whole) == pytest.approx(1.94)


def test_two_effects_can_be_hidden_at_once():
    case = SeaCase("usv", "mixed", hidden=(("HullFouling", 1.0), ("Current", 0.5)), duration_s=5.0)
    assert set(simulate([case])[0].hidden) == {"HullFouling", "Current"}


def test_a_voyage_is_the_same_whoever_sails_beside_it(voyages):
    """All voyages are sailed side by side; a squall over one ship once let the wind blow on another that was
    to feel none."""
    for name in ("wind_no_force", "waves_no_force"):
        alone = simulate([SeaCase("usv", "mixed", decoys=(name,), seed=11, duration_s=40.0)])[0]
        assert np.array_equal(alone.truth["v"], voyages[1][name].truth["v"]), name
    alone = simulate([SeaCase("usv", "mixed", hidden=(("ExternalForce", 1.0),), seed=11, duration_s=40.0)])[0]
    assert np.array_equal(alone.truth["v"], voyages[1]["ExternalForce"].truth["v"])
