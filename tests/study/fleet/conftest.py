"""Short voyages of the bundled tanker, with dates: ten minutes of Monday and of Tuesday, a sample every
three seconds."""

import pytest

import twin
from twin.commands.story import MONDAY, TUESDAY

START = {MONDAY: "2026-06-01T06:00:00", TUESDAY: "2026-07-02T06:00:00"}


@pytest.fixture(scope="session")
def short(tmp_path_factory):
    """Folder of monday.csv and tuesday.csv."""
    pandas = pytest.importorskip("pandas")
    folder = tmp_path_factory.mktemp("short")
    for path, start in START.items():
        table = twin.read_voyage(path).to_dataframe().loc[:600.0:3]
        stamps = pandas.Timestamp(start, tz="UTC") + pandas.to_timedelta(table.index, unit="s")
        table.insert(0, "time_utc", [t.isoformat() for t in stamps])
        table.to_csv(folder / f"{path.stem}.csv", index=False)
    return folder
