"""Free runs on what was held out: how long they are, and what is too short for them."""

from dataclasses import replace

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="torch is not installed: pip install 'shiptwin[train]'")

from export.data import split  # noqa: E402
from export.settings import TrainingSettings  # noqa: E402
from export.teach import prepared  # noqa: E402
from export.worth import worth  # noqa: E402
from twin.errors import DataError  # noqa: E402


def test_a_voyage_too_short_for_a_roll_out_is_refused_in_words(parts):
    """Test: five minutes of one voyage, whose validation part is shorter than a roll-out."""
    split_parts, model = parts
    short = split([split_parts["train"][0].part(0, 150)])
    with pytest.raises(DataError, match=r"validation: no stretch of 60\.2 s"):
        prepared(short, model, TrainingSettings())
    prepared(short, model, TrainingSettings(loss="acceleration"))
    with pytest.raises(DataError, match="test: no stretch"):
        worth(None, model, [replace(one, whole=np.zeros(len(one), bool)) for one in short["test"]])


def test_no_two_of_the_horizons_that_are_told_are_a_step_apart(parts, monkeypatch):
    """Test: free runs of 120.4 s, as KVLCC2's are. Expected: their errors after 120 s stand there once."""
    split_parts, model = parts
    monkeypatch.setattr("export.worth.LENGTHS", 120.4 / float(model.ship.scale("time")))
    told = worth(None, model, split_parts["test"])
    assert [s for s, *_ in told.leads] == [10.0, 60.0, 120.0]
    monkeypatch.setattr("export.worth.LENGTHS", 90.0 / float(model.ship.scale("time")))
    assert [round(s) for s, *_ in worth(None, model, split_parts["test"]).leads] == [10, 60, 90]
