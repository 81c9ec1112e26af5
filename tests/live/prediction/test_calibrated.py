"""The [tube] of a ship file is read as it was written, or refused in one line."""

import pytest

from tests.live.prediction.tube_tables import N, with_tube
from twin.errors import SettingsError
from twin.live.prediction.calibrated import calibrated_of
from twin.physics.ship import load, save


@pytest.mark.parametrize(
    "changes",
    [
        {"levels": [0.9, 0.8]},
        {"along_60s": [0.0]},
        *({"level": value} for value in (1.5, float("nan"))),
        *(
            {"cell_60s_all": {"voyages": 3, "place": row, "heading": [1.0] * len(row)}}
            for row in ([0.0], [2.0, 1.0])
        ),
        {"cell_60s_all": {"voyages": 3, "place": [], "heading": []}},
        {"cell_60s_all": {"voyages": 3, "place": [float("nan")], "heading": [1.0]}},
        {"along_60s": [1000.0] * N},
        {"lowest": "none"},
        {"lowest": [9.0] * (N + 2)},
        {"horizons_s": []},
    ],
)
def test_a_table_that_cannot_be_used_is_one_line(kvlcc2, changes):
    with pytest.raises(SettingsError, match=r"\[tube\].*twin tube") as error:
        calibrated_of(with_tube(kvlcc2, **changes))
    assert "\n" not in str(error.value)


def test_a_tube_is_read_from_the_file_as_it_was_written(kvlcc2, tmp_path):
    ship = with_tube(kvlcc2)
    save(ship, tmp_path / "ship.toml")
    # no array goes astray from what is read on board
    assert [p.name for p in tmp_path.iterdir()] == ["ship.toml"]
    assert calibrated_of(load(tmp_path / "ship.toml", arrays=False)) == calibrated_of(ship)
