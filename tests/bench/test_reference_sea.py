"""The reference sea as a witness: independent, repeatable, and the same for one ship or many."""

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bench.reference
from bench.reference import HULLS, Change, Sea, SeaCase, Weather, simulate
from bench.reference.sensor_suite import COLUMNS
from bench.reference.trial_legs import MANOEUVRES, RUDDER, ZIGZAG, Leg

FOLDER = Path(bench.reference.__file__).parent
STILL = Weather()


def test_the_witness_imports_nothing_but_numpy_and_the_standard_library():
    allowed = {"numpy", "dataclasses", "math", "types", "argparse", "json", "pathlib", "os"}
    for path in FOLDER.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module] if isinstance(node, ast.ImportFrom) and node.level == 0 else []
            strange = {n for n in names if not n.startswith("bench.reference")}
            assert {n.split(".")[0] for n in strange} <= allowed, path.name


def rough(seed, **more):
    hidden = (("Current", 1.0), ("SteeringLag", 0.5), ("SensorDelay", 1.0))
    return SeaCase("usv", "mixed", "TS-02", hidden, seed=seed, duration_s=20.0, **more)


def test_a_ship_sails_the_same_voyage_alone_and_in_company():
    alone = simulate([rough(3)])[0]
    others = [
        rough(1),
        SeaCase("usv", "turning_circle", hidden=(("Wind", 1.0), ("Loading", 1.0)), duration_s=20.0),
        rough(3),
    ]
    company = simulate(others)[2]
    for name in COLUMNS:
        assert alone.columns[name].tobytes() == company.columns[name].tobytes(), name
    assert alone.hidden == company.hidden


def test_the_same_seed_gives_the_same_bytes_and_another_seed_does_not(tmp_path):
    for name, seed in (("a", 5), ("b", 5), ("c", 6)):
        simulate([rough(seed)])[0].write_csv(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes() != (tmp_path / "c").read_bytes()


def test_a_stepped_sea_reads_what_a_recording_holds():
    recording, sea = simulate([rough(2)])[0], Sea(rough(2))
    for i in (0, 1, 57):
        sea.advance((i - sea.tick) * 0.1)
        for name, value in sea.readings().items():
            assert value == pytest.approx(recording.columns[name][i], nan_ok=True, abs=0), name


def test_a_live_sea_sails_at_fifty_hertz_without_an_end():
    sea = Sea(SeaCase("kvlcc2", "mixed", duration_s=None), tick_s=0.02)
    for _ in range(30):
        sea.advance(0.02)
    assert sea.readings()["time_s"] == pytest.approx(0.6)
    assert np.isfinite(sea.readings()["heading_true_north_deg"])


@pytest.mark.parametrize("hull", ["container", "usv"])
def test_a_mirrored_manoeuvre_of_a_symmetric_hull_is_mirrored(hull):
    time = 7 * HULLS[hull].L / HULLS[hull].U0
    pair = [
        SeaCase(hull, (Leg(ZIGZAG, 99, a, 10),), STILL, heading_deg=0, duration_s=time, sensors="perfect")
        for a in (10, -10)
    ]
    port, starboard = (v.truth for v in simulate(pair, tick_s=0.25 if hull == "container" else 0.1))
    for name, sign in (("north", 1), ("u", 1), ("east", -1), ("psi", -1), ("v", -1), ("r", -1), ("phi", -1)):
        assert port[name] == pytest.approx(sign * starboard[name], abs=1e-9 * HULLS[hull].L)


def test_a_model_at_froude_scale_sails_the_same_voyage_in_lengths():
    """Only water density and the thicker wake of the small model may differ, so those are set equal."""
    big, small = (
        HULLS["kvlcc2"],
        replace(HULLS["kvlcc2_model"], rho=1025.0, w_P0=0.35, engine_time=12 * (7 / 320) ** 0.5),
    )
    ends = []
    for hull, tick in ((big, 0.5), (small, 0.5 * (7 / 320) ** 0.5)):
        case = SeaCase(
            hull, (Leg(RUDDER, 99, 20),), STILL, heading_deg=0, duration_s=150 * tick / 0.5, sensors="perfect"
        )
        true = simulate([case], tick_s=tick)[0].truth
        ends.append([true["north"][-1] / hull.L, true["east"][-1] / hull.L, true["psi"][-1]])
    assert ends[0] == pytest.approx(ends[1], rel=0.01)


@pytest.mark.parametrize("hull", HULLS)
def test_every_manoeuvre_is_sailed_by_every_hull(hull):
    time = (18 if hull == "usv" else 9) * HULLS[hull].L / HULLS[hull].U0
    tick = 0.5 if HULLS[hull].L > 100 else 0.1
    for voyage in simulate(
        [SeaCase(hull, name, seed=4, duration_s=time) for name in MANOEUVRES], tick_s=tick
    ):
        true = voyage.truth
        assert all(np.isfinite(true[name]).all() for name in true if name not in ("forces", "depth", "bank"))
        assert np.abs(true["u"]).max() < 1.2 * HULLS[hull].U0 and np.degrees(np.abs(true["phi"])).max() < 15
        assert np.nanmax(np.abs(voyage.columns["rudder_angle_deg"])) < 36
        steady = voyage.case.manoeuvre in ("straight", "reciprocal_runs", "square")  # which begin straight
        assert steady or np.ptp(true["n"]) + np.ptp(true["psi"]) > 0.1


def test_a_crash_stop_stops_her_within_fifteen_lengths():
    """The limit of IMO MSC.137(76)."""
    hull = HULLS["container"]
    case = SeaCase("container", "crash_stop", STILL, heading_deg=0, duration_s=17 * hull.L / hull.U0)
    true = simulate([case], tick_s=0.5)[0].truth
    stopped = np.argmax(true["u"] < 0.03 * hull.U0)
    assert stopped and 3 < true["north"][stopped] / hull.L - 4 < 15


@pytest.mark.parametrize(
    ("case", "word"),
    [
        (SeaCase("kvlcc3"), "kvlcc2"),
        (SeaCase(manoeuvre="zig"), "zigzag_10"),
        (SeaCase(weather="storm"), "calm"),
        (SeaCase(hidden=(("Winds", 1.0),)), "Wind"),
        (SeaCase(decoys=("fog",)), "wind_no_force"),
    ],
)
def test_a_wrong_name_is_answered_with_the_right_ones(case, word):
    with pytest.raises(ValueError, match=word):
        simulate([case])


CHANGED_AT_S, TICK_S = 60.0, 0.1
KVLCC2 = HULLS["kvlcc2"]
CHANGES = {
    "heavier": {"hull": replace(KVLCC2, m=1.05 * KVLCC2.m)},
    "fouled": {"hull": replace(KVLCC2, R0=1.3 * KVLCC2.R0)},
    "windage": {"hull": replace(KVLCC2, A_L=2 * KVLCC2.A_L)},
    "wind": {"wind": 2.0},
}


@pytest.fixture(scope="module")
def changed():
    """A zigzag as it is, and with each change in its middle."""
    plain = SeaCase("kvlcc2", "zigzag_20", "TS-02", seed=7, duration_s=120.0)
    cases = [plain, *(replace(plain, change=Change(CHANGED_AT_S, **c)) for c in CHANGES.values())]
    return dict(zip(("as it is", *CHANGES), simulate(cases, TICK_S), strict=True))


@pytest.mark.parametrize("name", CHANGES)
def test_a_change_is_not_felt_before_its_time_and_is_felt_after(changed, name):
    """Test: another hull or another wind from 60 s on. Expected: the same bytes before; another speed in the
    end."""
    at, plain, other = round(CHANGED_AT_S / TICK_S), changed["as it is"], changed[name]
    for column in COLUMNS:
        assert plain.columns[column][:at].tobytes() == other.columns[column][:at].tobytes(), column
    for state in ("north", "east", "psi", "u", "v", "r", "phi"):  # at the instant itself only forces differ
        assert plain.truth[state][: at + 1].tobytes() == other.truth[state][: at + 1].tobytes(), state
    assert abs(plain.truth["u"][-1] - other.truth["u"][-1]) > 1e-4


@pytest.mark.parametrize("name", CHANGES)
def test_speeds_do_not_jump_at_a_change(changed, name):
    """Expected: from tick to tick no more than three times what they moved before, in the same waves."""
    at = round(CHANGED_AT_S / TICK_S)
    for state in "uvr":
        steps = np.abs(np.diff(changed[name].truth[state]))
        assert steps[at : at + 20].max() < 3 * steps[:at].max(), state


def test_a_step_of_wind_leaves_waves_and_current_as_they_were(changed):
    at, plain, blown = round(CHANGED_AT_S / TICK_S), changed["as it is"].truth, changed["wind"].truth
    assert blown["wind_speed"][at:] == pytest.approx(2 * plain["wind_speed"][at:])
    assert blown["current_north"].tobytes() == plain["current_north"].tobytes()
    waves = [t["forces"]["waves"]["Y_N"] for t in (plain, blown)]
    assert waves[0][: at + 1].tobytes() == waves[1][: at + 1].tobytes()


def test_who_changes_at_once_sails_like_who_was_so_from_the_beginning():
    heavy = CHANGES["heavier"]["hull"]
    cases = [
        SeaCase(heavy, seed=7, duration_s=30.0),
        SeaCase("kvlcc2", seed=7, duration_s=30.0, change=Change(0.0, heavy)),
    ]
    first, second = simulate(cases)
    assert first.truth["u"].tobytes() == second.truth["u"].tobytes()


def test_a_ship_cannot_change_her_length():
    with pytest.raises(ValueError, match="of its length"):
        simulate([SeaCase("kvlcc2", duration_s=5.0, change=Change(1.0, "container"))])
