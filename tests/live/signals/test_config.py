"""twin.toml: what is wrong is named with its line and what to do (F1, F2); the defaults need no file."""

import tomllib

import pytest

from twin.errors import SettingsError
from twin.live.signals import config
from twin.live.signals.config import example, load
from twin.live.signals.keys import KEYS
from twin.num import as_given


def write(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "twin.toml"
    path.write_bytes(text.encode(encoding) if isinstance(text, str) else text)
    return path


def complaint(tmp_path, text, **how):
    with pytest.raises(SettingsError) as error:
        load(write(tmp_path, text, **how))
    assert error.value.exit_code == 5
    return str(error.value)


def test_without_a_file_the_bundled_ship_listens_on_this_computer_only():
    settings = load(None)
    assert settings["ship.file"] == "kvlcc2" and settings["bus.listen"].startswith("tcp/127.0.0.1:")


def test_the_example_has_every_key_at_its_default_and_is_accepted(tmp_path):
    table = tomllib.loads(example())
    assert {f"{s}.{k}" for s, entries in table.items() for k in entries} == {key.name for key in KEYS}
    settings = load(write(tmp_path, example()))
    assert all(settings[key.name] == key.default for key in KEYS)


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.name)
def test_F1_a_typo_in_any_key_is_named_with_its_line_and_the_right_word(tmp_path, key):
    section, _, name = key.name.partition(".")
    wrong = name + "e" if not name.endswith("e") else name[:-1] + "ee"
    said = complaint(tmp_path, f"# first line\n[{section}]\n{wrong} = 1\n")
    assert "line 3" in said and repr(wrong) in said and name in said


@pytest.mark.parametrize("key", [k for k in KEYS if k.kind in (int, float)], ids=lambda key: key.name)
def test_F1_a_number_out_of_range_is_named_with_its_unit(tmp_path, key):
    section, _, name = key.name.partition(".")
    said = complaint(tmp_path, f"[{section}]\n{name} = 999999999\n")
    assert (
        "line 2" in said
        and f"outside {as_given(key.low)} to {as_given(key.high)}" in said
        and key.unit in said
    )


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.name)
def test_F1_a_value_of_the_wrong_kind_is_named(tmp_path, key):
    section, _, name = key.name.partition(".")
    value = '"10 Hz"' if key.kind is not str else "12"
    said = complaint(tmp_path, f"[{section}]\n{name} = {value}\n")
    assert "line 2" in said and key.name in said


def test_F1_a_key_in_another_unit_leads_to_the_one_that_exists(tmp_path):
    assert "Did you mean 'rate_hz'" in complaint(tmp_path, "[loop]\nrate_ms = 100\n")


def test_F1_an_unknown_section_leads_to_the_one_that_exists(tmp_path):
    said = complaint(tmp_path, "[lop]\nrate_hz = 10\n")
    assert "line 1" in said and "Did you mean 'loop'" in said


def test_F1_an_unknown_channel_in_sources_is_named(tmp_path):
    said = complaint(tmp_path, '[sources]\nheading_deg = "gyro"\n')
    assert "line 2" in said and "heading_true_north_deg" in said


def test_F1_broken_toml_names_the_line(tmp_path):
    assert "line 2" in complaint(tmp_path, "[loop]\nrate_hz == 10\n")


@pytest.mark.parametrize(
    "data, word",
    (
        (b"\xef\xbb\xbf[loop]\n", "byte-order mark"),
        ("[loop]\n".encode("utf-16"), "byte-order mark"),
        (b'[ship]\nfile = "M\xf6we"\n', "not UTF-8"),
        (b"", "empty"),
        (b"  \n", "empty"),
        (b"\x00\xff\x00", "not UTF-8"),
    ),
)
def test_F2_a_file_that_is_no_plain_text_is_named(tmp_path, data, word):
    assert word in complaint(tmp_path, data)


def test_F2_a_file_that_cannot_be_read_is_named(tmp_path):
    with pytest.raises(SettingsError, match="No such file"):
        load(tmp_path / "nowhere.toml")
    with pytest.raises(SettingsError, match="directory"):
        load(tmp_path)


def test_horizons_are_a_list_of_numbers(tmp_path):
    assert load(write(tmp_path, "[prediction]\nhorizons_s = [5, 30]\n"))["prediction.horizons_s"] == [
        5.0,
        30.0,
    ]
    assert "line 2" in complaint(tmp_path, "[prediction]\nhorizons_s = []\n")


def test_every_key_says_what_it_means():
    assert all(len(key.doc) > 8 for key in config.KEYS)
