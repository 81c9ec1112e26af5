"""What is packed in a .zip is told of as the .zip, not as the folder in which it was unpacked for a moment."""

import zipfile

import pytest

from twin.errors import SettingsError
from twin.recording.formats.choose import sources_of
from twin.recording.read import read_voyage
from twin.recording.write import write_voyage


@pytest.fixture
def packed(tmp_path):
    """Packs files into a .zip; gives its path."""

    def pack(*files):
        path = tmp_path / "june.zip"
        with zipfile.ZipFile(path, "w") as out:
            for file in files:
                out.write(file, f"logs/{file.name}")
        return path

    return pack


def test_a_voyage_out_of_a_zip_remembers_the_zip(packed, columns, write_csv):
    path = packed(write_csv(columns))
    assert read_voyage(path).meta["source"] == str(path)


def test_tables_out_of_a_zip_are_named_without_the_folder_they_were_unpacked_into(packed, columns, write_csv):
    controls = ("rudder_angle_deg", "propeller_rate_rpm")
    a = write_csv({n: x for n, x in columns.items() if n not in controls}, "a.csv")
    b = write_csv({n: columns[n] for n in ("time_s", *controls)}, "b.csv")
    path = packed(a, b)
    meta = read_voyage(path).meta
    assert meta["source"] == str(path) and meta["files"] == ["a.csv", "b.csv"]


def test_an_imported_voyage_out_of_a_zip_remembers_what_it_was_imported_from(
    packed, columns, write_csv, tmp_path
):
    """Test: a voyage of one table, and one of two. Expected: their own source and files, wherever they lie."""
    controls = ("rudder_angle_deg", "propeller_rate_rpm")
    a = write_csv({n: x for n, x in columns.items() if n not in controls}, "a.csv")
    b = write_csv({n: columns[n] for n in ("time_s", *controls)}, "b.csv")
    for source in (write_csv(columns), [a, b]):
        voyage = read_voyage(source)
        write_voyage(voyage, tmp_path / "v.mcap")
        meta = read_voyage(packed(tmp_path / "v.mcap")).meta
        assert meta["source"] == voyage.meta["source"] and meta.get("files") == voyage.meta.get("files")


def test_a_wrong_setting_of_what_is_packed_names_the_zip(packed, columns, write_csv):
    path = packed(write_csv(columns))
    with pytest.raises(SettingsError) as caught:
        read_voyage(path, sources=sources_of(["GP"]))
    assert f"{path}/voyage.csv" in str(caught.value)
