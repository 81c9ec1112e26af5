"""A calibration on voyages that mislead it leaves no ship file, and says why, on the command line and in
Python alike."""

import json
from dataclasses import replace

from bench.small_boats import exchange, sailed, ship_of
from twin import cli
from twin.physics.ship import save
from twin.recording.write import write_voyage


def test_a_calibration_on_exchanged_sides_is_refused_where_the_held_out_run_has_them_right(tmp_path, capsys):
    """Test: two runs of a boat whose two thrusters are recorded each as the other; a third with them right.
    Expected: exit code 3, no ship file, the horizon with the error before and after, and the JSON says the
    same."""
    plant, paths = exchange("port", "starboard"), []
    for seed in (1, 2, 3):
        v = sailed("thrusters", seed, duration_s=90.0, boat_seed=0)
        v = v if seed == 3 else replace(v, columns=plant(dict(v.columns)))
        paths.append(str(tmp_path / f"{seed}.mcap"))
        write_voyage(v, paths[-1])
    ship, out, said = tmp_path / "boat.toml", tmp_path / "better.toml", tmp_path / "said.json"
    save(ship_of("thrusters"), ship)
    words = ["calibrate", *paths[:2], "--held-out", paths[2], "--ship", str(ship), "-o", str(out)]
    assert cli.main([*words, "--json", str(said)]) == 3
    assert not out.exists()
    told, result = capsys.readouterr().err, json.loads(said.read_text())
    assert not result["accepted"] and result["output"] is None and result["refused"] in told
    assert " m and " in result["refused"] and "uncalibrated numbers are kept" in result["refused"]
