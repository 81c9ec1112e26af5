"""Which ships and voyages a fleet has: a list, a folder, and what is wrong with either in one line."""

import shutil

import pytest

from tests.study.fleet.rows import copied
from twin.commands.story import MONDAY, SHIP, TUESDAY
from twin.errors import DataError, SettingsError
from twin.study.fleet.listing import read_fleet


@pytest.fixture
def yard(tmp_path):
    """Two ships, each in a folder of its own with two voyages."""
    for name in ("alma", "berta"):
        (tmp_path / name).mkdir()
        copied(SHIP, tmp_path / name / f"{name}.toml")
        for voyage in (MONDAY, TUESDAY):
            shutil.copy(voyage, tmp_path / name)
    return tmp_path


def listed(folder, text):
    path = folder / "fleet.toml"
    path.write_text(text)
    return path


def test_a_folder_of_folders_is_a_fleet(yard):
    (yard / "results").mkdir()
    (yard / "alma" / "notes.md").write_text("dry dock in May")
    ships = read_fleet(yard)
    assert [s.name for s in ships] == ["alma", "berta"]
    assert [v.path.name for v in ships[0].voyages] == ["monday.mcap", "tuesday.mcap"]


def test_a_map_in_a_ships_folder_is_that_of_its_voyages(yard):
    (yard / "alma" / "map.toml").write_text('[columns]\nheading_true_north_deg = "HDG"\n')
    assert {v.map for v in read_fleet(yard)[0].voyages} == {yard / "alma" / "map.toml"}


def test_a_list_names_ships_patterns_and_tags(yard):
    path = listed(
        yard,
        '[[ships]]\nname = "Alma"\nfile = "alma/alma.toml"\nvoyages = ["alma/t*.mcap", "alma/*.mcap"]\n'
        'tags = { route = "north" }\n'
        '[[ships]]\nfile = "berta/berta.toml"\n'
        'voyages = [{ files = "berta/monday.mcap", tags = { period = "June" } }, "berta/gone.mcap"]\n',
    )
    alma, berta = read_fleet(path)
    assert [v.path.name for v in alma.voyages] == ["tuesday.mcap", "monday.mcap"], "a file stands once"
    assert alma.voyages[0].tags == {"route": "north"}
    assert berta.name == "KVLCC2" and berta.voyages[0].tags == {"period": "June"}
    assert berta.voyages[1].path.name == "gone.mcap", "a plain name is kept: its row says that it is gone"


ALMA = '[[ships]]\nname = "Alma"\nfile = "alma/alma.toml"\nvoyages = "alma/*.mcap"\n'


@pytest.mark.parametrize(
    "text, error, said",
    [
        (ALMA + ALMA, SettingsError, "the name Alma stands there twice"),
        (ALMA + ALMA.replace('"Alma"', '"B"'), SettingsError, r"ship file .*alma.toml stands there twice"),
        (ALMA.replace("*.mcap", "*.csv"), DataError, r"no file is like 'alma/\*.csv'"),
        (ALMA.replace("voyages", "voyage"), SettingsError, "Did you mean 'voyages'"),
        (ALMA.replace("alma.toml", "elma.toml"), SettingsError, "elma.toml: cannot be read"),
        (ALMA + 'map = "none.toml"\n', SettingsError, "none.toml: cannot be read"),
        (ALMA + "tags = 3\n", SettingsError, "tags = 3 must be"),
        (ALMA.replace('"alma/*.mcap"', "[3]"), SettingsError, "files = 3 must be"),
        ("ships = 3\n", SettingsError, "lists no ship"),
        ("[[ships]\n", SettingsError, "not valid TOML"),
    ],
)
def test_what_is_wrong_with_a_list_is_one_line(yard, text, error, said):
    with pytest.raises(error, match=said) as raised:
        read_fleet(listed(yard, text))
    assert "\n" not in str(raised.value)


def test_a_ship_that_was_never_calibrated_is_refused_with_the_command_that_does_it(yard):
    ship = yard / "alma" / "alma.toml"
    ship.write_text(ship.read_text().partition("[structural]")[0])
    with pytest.raises(SettingsError, match=r"alma.toml: was never calibrated.*twin calibrate REFERENCE"):
        read_fleet(yard)


def test_a_folder_with_two_ship_files_or_none_is_refused(yard, tmp_path_factory):
    copied(SHIP, yard / "alma" / "second.toml")
    with pytest.raises(SettingsError, match=r"alma: holds 2 ship files \(alma.toml, second.toml\)"):
        read_fleet(yard)
    with pytest.raises(SettingsError, match="no folder in it holds a ship file"):
        read_fleet(tmp_path_factory.mktemp("empty"))


def test_a_project_of_the_workbench_is_a_ships_folder(yard):
    """Test: the settings of a project and the maps of its tables lie beside the ship file."""
    (yard / "alma" / "project.toml").write_text('[tags]\n"tuesday.mcap" = "held_out"\n')
    (yard / "alma" / "june-map.toml").write_text('[columns]\nheading_true_north_deg = "HDG"\n')
    assert [s.file.name for s in read_fleet(yard)] == ["alma.toml", "berta.toml"]
    (yard / "alma" / "alma.toml").write_text("name = \n")
    with pytest.raises(SettingsError, match=r"alma\.toml"):
        read_fleet(yard)
