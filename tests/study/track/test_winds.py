"""Which of two recorded winds a track takes."""

from pathlib import Path

import numpy as np
import pytest

import twin
from twin.study.track.track import track

BUNDLED = Path(twin.__file__).parent / "voyages"
TRUE = ("true_wind_speed_mps", "true_wind_direction_deg")


def test_one_sample_of_true_wind_does_not_take_the_place_of_a_whole_apparent_wind():
    """Test: an apparent wind all the time, and a true one all the time, once, or never. Expected: once as
    never."""
    voyage, ship = twin.read_voyage(BUNDLED / "monday.mcap"), twin.Ship.load(BUNDLED / "tanker.toml")

    def wind(samples: int) -> np.ndarray:
        cut = {name: x.copy() for name, x in voyage.columns.items()}
        for name in TRUE:
            cut[name][samples:] = np.nan
        return np.asarray(track(voyage.with_rows(voyage.time_s, cut), ship).weather["wind_speed"])

    assert wind(1) == pytest.approx(wind(0))
    assert np.ptp(wind(1)) > 0.0
    assert wind(len(voyage)) != pytest.approx(wind(0))
