"""The first residual's voyages on their grid, the force that a ship's core leaves over, and its two files."""

import json
import sys

import numpy as np
import pytest

from export import first
from export.first import COLUMNS, read
from tests.export.conftest import voyages
from twin.live.keelson.messages import Row
from twin.live.learning import residual
from twin.live.log.logfile import LogFile
from twin.physics.ship import load
from twin.recording.write import write_voyage


def test_a_shaft_that_starts_at_once_is_no_angle_that_wraps(tmp_path):
    """Test: a boat on a straight course through north whose shaft goes from stop to 1200 rpm between two samples.
    Expected: the network's propeller input before and after is n D_P/U_0, and its heading turns nowhere."""
    ship, path = load("usv"), tmp_path / "start.mcap"
    with LogFile(path) as log:
        for k in range(1200):
            values = dict.fromkeys(COLUMNS.values(), 0.0) | {
                "propeller_rate_rpm": 1200.0 * (k >= 600),
                "heading_true_north_deg": (359.5 + 0.001 * k) % 360.0,
                "surge_velocity_mps": 1.0,
            }
            row = Row(time_s=0.1 * k, **values)
            log.add("voyage", "shiptwin.Row", row.SerializeToString(), round(k * 1e8))
    run = read(path, ship)
    shaft = run.zeta[:, 4] * ship.U_0 / ship.D_P * 60.0
    assert shaft[5:50] == pytest.approx(0.0) and shaft[70:110] == pytest.approx(1200.0, rel=1e-6)
    assert np.isfinite(run.d).all()


def test_its_two_files_are_what_the_twin_reads(ship, tmp_path, monkeypatch):
    """Test: a training of two rounds. Expected: the twin takes its files, each input says its formula, and nothing
    lies beside them."""
    pytest.importorskip("onnx")
    paths = [tmp_path / f"v{i}.mcap" for i in range(3)]
    for path, voyage in zip(paths, voyages(ship, 3), strict=True):
        write_voyage(voyage, path)
    out = tmp_path / "out" / "first.onnx"
    out.parent.mkdir()
    monkeypatch.setattr(first, "ROUNDS", 2)
    monkeypatch.setattr(sys, "argv", ["first", *map(str, paths), "--ship", "kvlcc2", "-o", str(out)])
    assert first.main() == 0
    assert residual.load(out, load("kvlcc2")).manifest.inputs[3].name == "rudder"
    told = json.loads(out.with_suffix(".json").read_text())
    assert all(entry["formula"] for entry in told["inputs"])
    assert sorted(path.name for path in out.parent.iterdir()) == ["first.json", "first.onnx"]
