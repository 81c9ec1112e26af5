"""A ship's file: there and back, and what it refuses, in words that say what to do."""

import pytest

from twin.errors import SettingsError
from twin.physics.effects import BUILT_IN, find
from twin.physics.ship import bundled, from_table, load, save, to_table
from twin.physics.ship_file import load_actuators

GOOD = "kvlcc2"


def test_it_survives_the_way_to_disk_and_back(ship, tmp_path):
    full = ship.with_effects(*(Kind.plausible(ship) for Kind in BUILT_IN))
    save(full, tmp_path / "a.toml")
    again = load(tmp_path / "a.toml")
    assert again == full
    save(again, tmp_path / "b.toml")
    assert (tmp_path / "a.toml").read_bytes() == (tmp_path / "b.toml").read_bytes()
    assert not list(tmp_path.glob(".*"))  # nothing is left of the file written aside


def test_what_was_noted_survives_too(ship, tmp_path):
    from dataclasses import replace

    notes = {
        "structural": {"surge": [0.1, 0.2], "why": 'a "quoted" word, and µ'},
        "history": [{"added": "Wind", "errors": {"before_m": 3.0}}, {"added": "Current"}],
        "remark": "calm sea",
    }
    save(replace(ship, notes=notes), tmp_path / "a.toml")
    kept = load(tmp_path / "a.toml").notes
    assert {k: kept[k] for k in notes} == notes


@pytest.mark.parametrize("name", bundled())
def test_a_bundled_ship_gives_a_source_for_every_number(name):
    ship = load(name)
    for section in ("particulars", "derivatives"):
        assert all(entry["source"] and entry["unit"] for entry in ship.notes[section].values())


def test_a_changed_number_loses_its_source():
    ship = load(GOOD)
    table = to_table(ship.with_derivatives(X_uu=-0.03))
    assert "source" not in table["derivatives"]["X_uu"] and "source" in table["derivatives"]["Y_uv"]


def refuse(change, *words):
    table = to_table(load(GOOD))
    change(table)
    with pytest.raises(SettingsError) as error:
        from_table(table, "my.toml: ")
    assert error.value.exit_code == 5
    for word in ("my.toml", *words):
        assert word in str(error.value), str(error.value)
    assert "\n" not in str(error.value)


def test_a_file_without_actuators_is_refused_with_what_to_add(tmp_path):
    (tmp_path / "hull.toml").write_text('name = "hull"\n')
    with pytest.raises(
        SettingsError, match=r"Add one table \[\[actuators\]\] for each propeller or thruster"
    ):
        load_actuators(tmp_path / "hull.toml")


def test_a_whole_number_too_long_for_a_float_is_refused():
    refuse(lambda t: t["particulars"].update(L_pp=10**400), "particulars.L_pp", "finite")


def test_an_unknown_effect_is_refused_with_the_nearest_name():
    refuse(lambda t: t["effects"].update(Winde={}), "Winde", "Did you mean 'Wind'", "Bank")


def test_an_unknown_parameter_is_refused_with_the_nearest_name():
    refuse(lambda t: t["effects"].update(Wind={"cx": 0.7}), "effects.Wind.cx", "c_x")


def test_a_parameter_outside_its_box_is_refused():
    refuse(
        lambda t: t["effects"].update(Wind={"c_x": {"value": 9.0, "unit": "-"}}),
        "effects.Wind.c_x",
        "9",
        "[0, 1.6]",
    )


def test_an_effect_that_lacks_a_particular_is_refused():
    refuse(
        lambda t: (t["particulars"].pop("A_L"), t["effects"].update(Wind={})),
        "effects.Wind needs A_L",
        "[particulars]",
    )


def test_a_missing_particular_is_refused():
    refuse(lambda t: t["particulars"].pop("L_pp"), "L_pp", "length between perpendiculars", "Add it")


def test_a_number_out_of_this_world_is_refused():
    refuse(
        lambda t: t["particulars"].update(T={"value": 2080.0, "unit": "m"}),
        "particulars.T",
        "2080",
        "Check its unit",
    )


def test_another_unit_is_refused():
    refuse(lambda t: t["particulars"].update(m={"value": 3.2e5, "unit": "t"}), "'t'", "'kg'", "Convert")


@pytest.mark.parametrize("bad", ["much", float("nan"), float("inf"), True, None, [1.0]])
def test_what_is_no_number_is_refused(bad):
    refuse(lambda t: t["particulars"].update(B=bad), "particulars.B", "finite number")


def test_a_file_that_is_not_a_ship_is_refused(tmp_path):
    for content in (b"", b"a = 1", b"\xff\xfe", b"name = [", b"name = 3\nparticulars = 4"):
        (tmp_path / "x.toml").write_bytes(content)
        with pytest.raises(SettingsError):
            load(tmp_path / "x.toml")
    with pytest.raises(SettingsError, match="Bundled ships"):
        load(tmp_path / "none.toml")


def test_the_catalogue_names_the_nearest_effect():
    with pytest.raises(SettingsError, match="Did you mean 'ShallowWater'"):
        find("ShalowWater")
