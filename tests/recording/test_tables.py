"""Parquet, Feather, Excel, packed and several tables hold the same voyage as a CSV."""

import gzip
import zipfile
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from twin.errors import DataError
from twin.recording.formats import fast_csv, recognised
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage

START = datetime(2026, 11, 25, 12, 0, tzinfo=UTC)


def columns(m):
    return {
        "time_s": m["t"],
        "north_m": m["place"].real,
        "east_m": m["place"].imag,
        "heading_true_north_deg": m["psi"],
        "yaw_rate_degps": m["rate"],
        "rudder_angle_deg": m["rudder"],
        "propeller_rate_rpm": m["rpm"],
    }


def csv(c):
    return (
        "\n".join(
            [",".join(c), *(",".join(f"{x:.10g}" for x in row) for row in zip(*c.values(), strict=True))]
        )
        + "\n"
    )


def is_the_voyage(v, m):
    np.testing.assert_allclose(v["heading_true_north_deg"], m["psi"], atol=1e-6)
    np.testing.assert_allclose(v["north_m"], m["place"].real, atol=1e-4)
    return True


def test_parquet_and_feather_with_moments_for_time(tmp_path, sailed):
    import pyarrow as pa
    from pyarrow import feather, parquet

    c = columns(sailed)
    moments = pa.array([START + timedelta(seconds=float(t)) for t in c.pop("time_s")], pa.timestamp("us"))
    table = pa.table({"time_utc": moments} | {n: pa.array(x) for n, x in c.items()})
    parquet.write_table(table, tmp_path / "v.parquet")
    feather.write_feather(table, tmp_path / "v.feather", compression="zstd")
    for name in ("v.parquet", "v.feather"):
        v = read_voyage(tmp_path / name)
        assert is_the_voyage(v, sailed) and v.meta["start_time_utc"] == "2026-11-25T12:00:00Z"


def test_an_excel_workbook(tmp_path, sailed):
    import openpyxl

    book = openpyxl.Workbook()
    book.active.append(list(columns(sailed)))
    for row in zip(*columns(sailed).values(), strict=True):
        book.active.append([float(x) for x in row])
    book.save(tmp_path / "v.xlsx")
    assert recognised(tmp_path / "v.xlsx").name == "excel" and is_the_voyage(
        read_voyage(tmp_path / "v.xlsx"), sailed
    )


def test_gz_and_zip(tmp_path, sailed):
    with gzip.open(tmp_path / "v.csv.gz", "wt") as out:
        out.write(csv(columns(sailed)))
    with zipfile.ZipFile(tmp_path / "v.zip", "w") as out:
        out.writestr("folder/v.csv", csv(columns(sailed)))
    for name in ("v.csv.gz", "v.zip"):
        assert is_the_voyage(read_voyage(tmp_path / name), sailed)


def test_several_tables_are_joined_on_their_clocks(tmp_path, sailed):
    """Test: navigation twice as often as rudder and shaft, each in its own file. Expected: one voyage, empty
    cells between."""
    c = columns(sailed)
    nav = {n: c[n] for n in ("time_s", "north_m", "east_m", "heading_true_north_deg")}
    act = {n: c[n][::2] for n in ("time_s", "rudder_angle_deg", "propeller_rate_rpm")}
    (tmp_path / "nav.csv").write_text(csv(nav))
    (tmp_path / "act.csv").write_text(csv(act))
    for given in (tmp_path, [tmp_path / "nav.csv", tmp_path / "act.csv"]):
        v = read_voyage(given)
        assert is_the_voyage(v, sailed) and np.count_nonzero(np.isfinite(v["rudder_angle_deg"])) == 60


def test_a_map_says_in_which_file_a_column_stands(tmp_path, sailed):
    c = columns(sailed)
    for name, off in (("a", 0.0), ("b", 5.0)):
        (tmp_path / f"{name}.csv").write_text(
            csv(
                {
                    "t": c["time_s"],
                    "h": c["heading_true_north_deg"] + off,
                    **{n: c[n] for n in ("north_m", "east_m")}
                    | ({"d": c["rudder_angle_deg"], "n": c["propeller_rate_rpm"]} if name == "a" else {}),
                }
            )
        )
    entries = {
        "heading_true_north_deg": {"column": "h", "file": "b.csv"},
        "north_m": {"column": "north_m", "file": "a.csv"},
        "east_m": {"column": "east_m", "file": "a.csv"},
        "rudder_angle_deg": "d",
        "propeller_rate_rpm": "n",
    }
    v = read_voyage(tmp_path, parse_map({"time": {"column": "t"}, "columns": entries}, "m"))
    np.testing.assert_allclose(v["heading_true_north_deg"], sailed["psi"] + 5.0, atol=1e-6)
    entries["heading_true_north_deg"] = "h"
    with pytest.raises(DataError, match=r"stands in 2 files.*one at a time"):
        read_voyage(tmp_path, parse_map({"time": {"column": "t"}, "columns": entries}, "m"))


def test_a_large_table_is_read_the_same_by_both_readers(tmp_path, sailed, monkeypatch):
    m = {n: np.tile(x, 400) for n, x in sailed.items()} | {"t": np.arange(48_000.0)}
    path = tmp_path / "large.csv"
    text = csv(columns(m)).replace(",84\n", ",\n", 7)  # a few empty cells
    path.write_text(text)
    assert path.stat().st_size > fast_csv.LEAST_BYTES
    quick = read_voyage(path)
    monkeypatch.setattr("twin.recording.table.LEAST_BYTES", 1 << 40)
    careful = read_voyage(path)
    for name in careful.columns:
        np.testing.assert_array_equal(quick[name], careful[name])


def test_a_large_table_with_a_bad_cell_says_where(tmp_path, sailed):
    m = {n: np.tile(x, 400) for n, x in sailed.items()} | {"t": np.arange(48_000.0)}
    lines = csv(columns(m)).splitlines()
    lines[30_000] = lines[30_000].replace(",84", ",8x4")
    (tmp_path / "large.csv").write_text("\n".join(lines) + "\n")
    with pytest.raises(DataError, match=r"line 30001, column 'propeller_rate_rpm': '8x4' is not a number"):
        read_voyage(tmp_path / "large.csv")


def test_a_very_long_table_keeps_one_row_in_some(tmp_path, sailed, monkeypatch):
    m = {n: np.tile(x, 400) for n, x in sailed.items()} | {"t": np.arange(48_000.0)}
    (tmp_path / "large.csv").write_text(csv(columns(m)))
    monkeypatch.setattr(fast_csv, "MOST_CELLS", 70_000)
    monkeypatch.setattr(fast_csv, "BLOCK", 1 << 19)
    v = read_voyage(tmp_path / "large.csv")
    assert len(v) == 6000 and v.step_s == 8.0
    assert any("one row in 8 was kept" in note for note in v.meta["notes"])
    np.testing.assert_allclose(v["heading_true_north_deg"], m["psi"][::8], atol=1e-6)


def test_a_table_that_is_none_of_its_kind_is_one_line(tmp_path):
    (tmp_path / "v.parquet").write_bytes(b"PAR1" + bytes(200))
    (tmp_path / "v.xlsx").write_bytes(b"PK\x03\x04" + b"[Content_Types].xml" + bytes(100))
    (tmp_path / "v.zip").write_bytes(b"PK\x03\x04" + bytes(100))
    for name in ("v.parquet", "v.xlsx", "v.zip"):
        with pytest.raises(DataError, match=name) as caught:
            read_voyage(tmp_path / name)
        assert "\n" not in str(caught.value)
