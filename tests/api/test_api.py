"""The Python interface: what a scientist types in a notebook, on the bundled voyages."""

import inspect
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import twin
from twin.api.json_key import absent_keys, unknown_paths
from twin.api.json_keys import KEYS
from twin.commands.story import MONDAY, SHIP, TUESDAY
from twin.errors import DataError, SettingsError, UsageError
from twin.physics.effect import Force as ForceEffect
from twin.physics.effect import param
from twin.physics.state import Force

pandas = pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def tanker():
    return twin.Ship.load(SHIP)


@pytest.fixture(scope="module")
def monday():
    return twin.read_voyage(MONDAY)


@pytest.fixture(scope="module")
def compared(tanker, monday):
    return twin.compare(tanker, monday)


def test_importing_twin_loads_nothing():
    """Test: `import twin` in a process of its own. Expected: neither numpy nor any room is loaded."""
    code = "import sys, twin; print(*(m for m in sys.modules if m.startswith(('twin.', 'numpy', 'pandas'))))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stdout.split() == [], done.stderr


@pytest.mark.parametrize("name", twin.PUBLIC)
def test_every_public_name_is_there_and_says_what_it_is(name):
    thing = getattr(twin, name)
    assert inspect.getdoc(thing)
    if inspect.isfunction(thing):
        assert all(p.annotation is not p.empty for p in inspect.signature(thing).parameters.values())


@pytest.mark.parametrize(
    "name", ["instruments", "calibrate", "compare", "diagnose", "add", "simulate", "remove"]
)
def test_the_ship_comes_first_and_what_is_optional_has_a_name(name):
    first, *rest = inspect.signature(getattr(twin, name)).parameters.values()
    assert first.name == "ship"
    assert all(p.default is p.empty for p in rest if p.kind is not p.KEYWORD_ONLY)


def test_a_name_that_is_not_there_is_answered_with_those_that_are():
    with pytest.raises(AttributeError, match=r"no attribute 'compair'.*compare"):
        twin.compair  # noqa: B018


def test_a_comparison_is_the_commands_json_a_table_a_line_and_a_page(compared):
    data = compared.to_dict()
    assert [h["horizon_s"] for h in data["horizons"]] == [10.0, 60.0, 120.0]
    assert list(compared.errors["horizon_s"]) == [10.0, 60.0, 120.0]
    assert list(compared.to_dataframe()["position_mae_m"]) == [h["position_mae_m"] for h in data["horizons"]]
    assert len(repr(compared)) < 200 and "120 s" in repr(compared)
    assert compared._repr_html_().startswith("<iframe srcdoc=")
    data["horizons"].clear()
    assert compared.to_dict()["horizons"]


def test_a_comparison_is_drawn_beside_another(compared):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = compared.plot(beside=compared)
    assert len(axes.lines) == 4


def test_a_voyage_goes_into_a_table_and_comes_back(monday):
    back = twin.Voyage.from_dataframe(monday.to_dataframe(), name="monday")
    assert back.name == "monday" and len(back) == len(monday)
    for column in ("north_m", "rudder_angle_deg", "surge_velocity_mps"):
        np.testing.assert_allclose(back[column], monday[column], rtol=0, atol=1e-9)


def test_a_table_with_a_column_that_is_no_channel_is_refused_with_the_nearest(monday):
    table = monday.to_dataframe().rename(columns={"rudder_angle_deg": "rudder_angel_deg"})
    with pytest.raises(DataError, match=r"'rudder_angel_deg'.*rudder_angle_deg"):
        twin.Voyage.from_dataframe(table)


def test_a_pattern_that_matches_nothing_is_said(tmp_path):
    with pytest.raises(DataError, match="no file has such a name"):
        twin.read_voyages(f"{tmp_path}/*.mcap")


def test_a_file_whose_own_name_looks_like_a_pattern_is_read(tmp_path):
    copy = tmp_path / "monday [1].mcap"
    copy.write_bytes(MONDAY.read_bytes())
    assert [len(v) for v in twin.read_voyages(copy)] == [len(twin.read_voyage(MONDAY))]


def test_without_a_voyage_nothing_is_asked_and_a_name_is_no_voyage(tanker):
    for ask in (
        lambda of: twin.compare(tanker, of),
        lambda of: twin.calibrate(tanker, of),
        lambda of: twin.instruments(tanker, of),
        lambda of: twin.add(tanker, "Wind", of),
        lambda of: twin.tube(tanker, of),
    ):
        with pytest.raises(DataError, match="no voyage was given"):
            ask([])
        with pytest.raises(UsageError, match="is no voyage"):
            ask("monday.mcap")


@pytest.mark.parametrize("horizons_s", [[], [0.0], [-5.0], [float("nan")], [60.0, float("inf")]])
def test_a_horizon_lies_ahead(tanker, monday, horizons_s):
    with pytest.raises(UsageError, match="horizons_s"):
        twin.compare(tanker, monday, horizons_s=horizons_s)


def test_a_simulated_zigzag_turns_back_when_the_heading_passes_the_angle(tanker):
    run = twin.simulate(tanker, manoeuvre="zigzag_20", duration_s=1200.0)
    heading = (run.to_dataframe()["heading_true_north_deg"] + 180.0) % 360.0 - 180.0
    assert 20.0 < heading.max() < 60.0 and -60.0 < heading.min() < -20.0
    assert run.to_dataframe()["time_s"].iloc[-1] == pytest.approx(1200.0, abs=1.0)


def test_the_json_of_a_simulation_has_the_keys_of_the_table(tanker):
    result = twin.simulate(tanker, manoeuvre="straight", duration_s=60.0).to_dict()
    assert unknown_paths(KEYS["simulate"], result) == [] and absent_keys(KEYS["simulate"], result) == []


def test_a_simulated_circle_to_port_turns_to_port(tanker):
    run = twin.simulate(tanker, manoeuvre="circle_-35", duration_s=300.0)
    assert run.to_dataframe()["yaw_rate_degps"].iloc[-1] < -0.1


def test_still_water_has_no_input_of_a_plug_ins_effect_either(tanker):
    """Test: an effect that needs the draught of the day. Expected: it is switched off, as wind is."""

    class Ballast(ForceEffect):
        """A ship in ballast is pushed aside."""

        needs = ("draught",)
        source = "a test"
        push: float = param(1e6, unit="N/m", lo=-1e8, hi=1e8, sd=1e6, doc="push by missing draught")

        def force(self, s, ship):
            return Force(Y=self.push * (ship.T - s.draught))

    both = (replace(tanker, effects=(*tanker.effects, *more)) for more in ((), (Ballast(),)))
    without, with_it = (twin.simulate(ship, duration_s=60.0).to_dict()["columns"] for ship in both)
    assert with_it == without


def test_what_cannot_be_simulated_is_refused(tanker):
    with pytest.raises(UsageError, match="no manoeuvre is called 'loop'"):
        twin.simulate(tanker, manoeuvre="loop")
    with pytest.raises(UsageError, match="duration_s"):
        twin.simulate(tanker, duration_s=-1.0)
    for speed in (0.0, -3.0, float("nan"), 1e9):
        with pytest.raises(UsageError, match="speed_mps"):
            twin.simulate(tanker, speed_mps=speed)


def test_a_ship_is_not_written_over_a_file_without_force(tanker, tmp_path):
    path = tmp_path / "tanker.toml"
    tanker.save(path)
    with pytest.raises(SettingsError, match="is there already"):
        tanker.save(path)
    tanker.save(path, force=True)
    assert twin.Ship.load(path).name == tanker.name


def test_the_story_of_monday_in_four_lines(tanker, monday):
    """Test: diagnose, add, compare on the first 800 s of the bundled voyages. Expected: growth is named and the
    error falls."""
    monday, tuesday = monday.between(0.0, 800.0), twin.read_voyage(TUESDAY).between(0.0, 800.0)
    steps: list[str] = []
    found = twin.diagnose(tanker, monday, progress=steps.append)
    assert found.verdict == "missing" and found.effects == ["HullFouling"] and steps
    assert found.reason == found.to_dict()["reason"] == "named" and found.sentence.startswith(
        "Missing: HullF"
    )
    assert len(repr(found)) < 600 and 0.0 < found.probabilities["HullFouling"] <= 1.0
    better = twin.add(tanker, found.effects, monday, held_out=tuesday)
    assert better.accepted and better.error_after_m < better.error_before_m
    assert twin.compare(better.ship, tuesday).to_dict()["horizons"][-1]["position_mae_m"] < 10.0
    assert "HullFouling" not in [type(e).__name__ for e in twin.remove(better.ship, "HullFouling").effects]


@pytest.mark.parametrize(
    "ask",
    [
        lambda ship, v: twin.calibrate(ship, v, held_out=v),
        lambda ship, v: twin.add(ship, "HullFouling", v, held_out=v),
        lambda ship, v: twin.compare(ship, [v, v]),
    ],
)
def test_a_voyage_given_twice_is_refused_and_so_is_one_that_is_fitted_and_held_out(tanker, monday, ask):
    with pytest.raises(DataError, match=r"is the same voyage as monday\. Give each voyage once"):
        ask(tanker, monday.between(0.0, 800.0))


def test_the_packages_type_marker_is_there():
    assert (Path(twin.__file__).parent / "py.typed").is_file()


def test_a_map_of_no_file_is_refused():
    with pytest.raises(UsageError, match="no file"):
        twin.suggest_map([])


@pytest.mark.parametrize("manoeuvre", ["circle_9999", "circle_-90.5", "zigzag_270", "zigzag_0"])
def test_a_rudder_stands_where_one_can_stand(tanker, manoeuvre):
    with pytest.raises(UsageError, match=f"{manoeuvre}: .* deg"):
        twin.simulate(tanker, manoeuvre=manoeuvre, duration_s=10.0)
