"""Files go in as the world writes them; what cannot be used is one line with file, line, column, value."""

import tracemalloc

import numpy as np
import pytest

from twin.recording.read import read_voyage
from twin.recording.write import write_voyage


def text(tmp_path, content, name="v.csv"):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize(
    "writing",
    [
        {},
        {"separator": ";"},
        {"separator": ";", "decimal": ","},
        {"separator": "\t", "decimal": ","},
        {"separator": " "},
        {"encoding": "utf-8-sig"},
        {"encoding": "utf-16"},
    ],
    ids=str,
)
def test_separators_decimal_marks_and_encodings_are_found(columns, write_csv, writing):
    v = read_voyage(write_csv(columns, **writing))
    np.testing.assert_allclose(v["north_m"], columns["north_m"], rtol=1e-8)
    np.testing.assert_allclose(v.time_s, columns["time_s"])


def test_a_title_in_latin_1_and_excels_separator_line_are_no_obstacle(columns, write_csv, tmp_path):
    body = write_csv(columns | {"K\u00fcrs": columns["time_s"]}, separator=";").read_text()
    v = read_voyage(text(tmp_path, ("sep=;\n" + body).encode("latin-1")))
    assert len(v) == 600 and "'K\u00fcrs' is not used" in v.meta["notes"][0]


def test_iso_times_become_seconds_and_the_start_is_kept(columns, write_csv):
    stamps = [f"2024-05-17T23:59:{s:05.2f}Z" for s in columns["time_s"][:500]]
    columns = {"time_utc": stamps, **{n: x[:500] for n, x in columns.items() if n != "time_s"}}
    v = read_voyage(write_csv(columns))
    assert v.meta["start_time_utc"] == "2024-05-17T23:59:00Z" and v.time_s[10] == pytest.approx(1.0)


def test_seconds_since_1970_become_seconds_since_the_start(columns, write_csv):
    v = read_voyage(write_csv(columns | {"time_s": columns["time_s"] + 1.7e9}, digits=14))
    assert v.time_s[0] == 0.0 and v.meta["start_time_utc"].startswith("2023-11-14T22:13:20")


def test_empty_cells_and_words_for_nothing_are_missing_samples(columns, write_csv, tmp_path):
    body = write_csv(columns).read_text().splitlines()
    for row, cell in ((5, ""), (6, "NaN"), (7, "n/a"), (8, "-")):
        cells = body[row].split(",")
        body[row] = ",".join([*cells[:4], cell, *cells[5:]])
    v = read_voyage(text(tmp_path, "\n".join(body)))
    assert np.isnan(v["rudder_angle_deg"][4:8]).all() and np.isfinite(v["rudder_angle_deg"][8:]).all()


def test_values_no_ship_can_have_are_blanked_and_counted(columns, write_csv):
    rudder = columns["rudder_angle_deg"].copy()
    rudder[10:13] = -999.0
    turns = columns["propeller_rate_rpm"].copy()
    turns[20] = 1e7
    v = read_voyage(write_csv(columns | {"rudder_angle_deg": rudder, "propeller_rate_rpm": turns}))
    assert np.isnan(v["rudder_angle_deg"][10:13]).all() and np.isnan(v["propeller_rate_rpm"][20])
    assert any("3 samples blanked (first in line 12) for 'not available'" in n for n in v.meta["notes"])
    assert any("outside [-6000, 6000], the first 10000000" in n for n in v.meta["notes"])


def test_a_grids_numbers_are_counted_from_the_first_sample(columns, write_csv):
    v = read_voyage(write_csv(columns | {"north_m": columns["north_m"] + 6.4e6}, digits=12))
    assert v["north_m"][0] == 0.0 and any("map grid" in n for n in v.meta["notes"])


def test_an_imported_voyage_reads_back_to_the_last_bit(columns, write_csv, tmp_path):
    columns["rudder_angle_deg"][5:9] = np.nan
    v = read_voyage(write_csv(columns | {"time_s": columns["time_s"] + 1.7e9}, digits=14))
    write_voyage(v, tmp_path / "v.mcap")
    again = read_voyage(tmp_path / "v.mcap")
    assert again.name == v.name and again.meta == v.meta
    np.testing.assert_array_equal(again.time_s, v.time_s)
    for name in v.columns:
        np.testing.assert_array_equal(again[name], v[name])
    write_voyage(again, tmp_path / "w.mcap")
    assert (tmp_path / "v.mcap").read_bytes() == (tmp_path / "w.mcap").read_bytes()


def test_a_file_far_larger_than_a_piece_is_read_in_pieces(sail, write_csv, required):
    full = sail(60.0)
    columns = {name: np.tile(full[name], 150) for name in required}
    columns["time_s"] = np.arange(columns["north_m"].size) * 0.1
    path = write_csv(columns)
    tracemalloc.start()
    assert len(read_voyage(path)) == 90_000
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 60e6  # the text is 8 MB, the numbers 6.5 MB


# what cannot be used


def test_no_file_a_folder_an_empty_file_and_a_binary_one(tmp_path, refused):
    refused(tmp_path / "none.csv", "there is no such file")
    refused(tmp_path, "is a folder")
    refused(text(tmp_path, ""), "is empty (0 bytes)")
    refused(text(tmp_path, "\n\n \n"), "is empty")
    refused(text(tmp_path, b"PK\x03\x04\x00\x00"), "is not text", "CSV or an MCAP")


def test_a_header_without_rows(tmp_path, refused, required):
    refused(text(tmp_path, ",".join(required) + "\n"), "has a header but no rows")


def test_a_misspelt_column_names_the_nearest(columns, write_csv, refused):
    columns["heading_true_nort_deg"] = columns.pop("heading_true_north_deg")
    refused(write_csv(columns), "'heading_true_nort_deg'", "Did you mean 'heading_true_north_deg'")


def test_a_column_by_another_name_is_said_to_be_missing_with_a_guess(columns, write_csv, refused):
    columns["rudder"] = columns.pop("rudder_angle_deg")
    refused(
        write_csv(columns),
        "needs rudder_angle_deg",
        "'rudder' is not used (did you mean 'rudder_angle_deg'?)",
        "--map",
    )


def test_every_required_column_is_asked_for(columns, write_csv, refused):
    for name in ("heading_true_north_deg", "rudder_angle_deg", "propeller_rate_rpm"):
        refused(write_csv({n: x for n, x in columns.items() if n != name}), name)
    refused(write_csv({n: x for n, x in columns.items() if n != "time_s"}), "no column time_s or time_utc")
    nowhere = {n: x for n, x in columns.items() if n not in ("north_m", "surge_velocity_mps")}
    refused(write_csv(nowhere), "north_m and east_m", "latitude_deg", "surge_velocity_mps")


def test_a_column_without_a_single_sample_is_not_there(columns, write_csv, refused):
    refused(
        write_csv(columns | {"rudder_angle_deg": columns["time_s"] * np.nan}),
        "rudder_angle_deg: no usable sample",
    )


def test_a_duplicated_header(columns, write_csv, tmp_path, refused):
    body = write_csv(columns).read_text().replace("east_m", "north_m", 1)
    refused(text(tmp_path, body), "'north_m' 2 times (columns [2, 3])")


def test_a_header_of_numbers(tmp_path, refused):
    refused(
        text(tmp_path, "0,1,2\n1,2,3\n"), "line 1 has numbers where column names should be", "header = false"
    )


def test_a_word_in_a_column_of_numbers(columns, write_csv, tmp_path, refused):
    body = write_csv(columns).read_text().splitlines()
    body[41] = body[41].replace(body[41].split(",")[4], "hard over", 1)
    refused(text(tmp_path, "\n".join(body)), "line 42", "'rudder_angle_deg'", "'hard over' is not a number")


def test_decimal_commas_between_commas(columns, write_csv, refused):
    refused(write_csv(columns, decimal=","), "Decimal commas?")


def test_a_short_line_in_the_middle_and_one_cut_off_at_the_end(columns, write_csv, tmp_path, refused):
    body = write_csv(columns).read_text()
    v = read_voyage(text(tmp_path, body[:-40]))
    assert len(v) == 599 and "line 601 is cut off" in v.meta["lost"][0]
    lines = body.splitlines(keepends=True)
    lines[99] = "9.8,1.2\n"
    refused(text(tmp_path, "".join(lines)), "line 100 has 2 cells")


def test_time_that_goes_back_and_time_that_passes_midnight(columns, write_csv, refused):
    back = columns["time_s"].copy()
    back[300:] -= 10.0
    refused(
        write_csv(columns | {"time_s": back}), "line 302: time goes back from 29.9 s to 20 s", "Split or sort"
    )
    midnight = np.mod(columns["time_s"] + 86380.0, 86400.0)
    refused(write_csv(columns | {"time_s": midnight}, digits=14), "passes midnight")


def test_a_time_that_is_no_time(columns, write_csv, tmp_path, refused):
    body = "time_utc" + write_csv(columns).read_text()[len("time_s") :]
    refused(text(tmp_path, body.replace("\n0.3,", "\n12.3.2024,", 1)), "line", "ISO 8601", "format")


def test_an_mcap_that_is_none_one_cut_short_and_one_without_measurements(
    columns, write_csv, tmp_path, refused
):
    refused(text(tmp_path, "time_s,north_m\n", "v.mcap"))
    whole = tmp_path / "whole.mcap"
    write_voyage(read_voyage(write_csv(columns)), whole)
    data = whole.read_bytes()
    refused(text(tmp_path, data[:300], "cut.mcap"))
    cut = read_voyage(text(tmp_path, data[:-20], "tail.mcap"))
    assert len(cut) == 600 and any("cut off" in n and "is there" in n for n in cut.meta["lost"])


@pytest.mark.parametrize("stamp", ["2026-05-17", "2026-05-17T08:30:00Z"])
def test_a_clock_that_stands_still_is_refused(columns, write_csv, refused, stamp):
    """Test: a date without its time of day as the clock. Expected: one line that says so, no voyage."""
    refused(
        write_csv({"time_utc": [stamp] * 600} | {n: x for n, x in columns.items() if n != "time_s"}),
        "all 600 rows have the same time",
        "date without its time of day",
    )


def test_a_heading_that_is_no_number_is_blanked_without_a_word_of_numpy(columns, write_csv, recwarn):
    columns["heading_true_north_deg"][7] = np.inf
    v = read_voyage(write_csv(columns))
    assert np.isnan(v["heading_true_north_deg"][7]) and np.isfinite(v["heading_true_north_deg"][8])
    assert not [w for w in recwarn if issubclass(w.category, RuntimeWarning)]
