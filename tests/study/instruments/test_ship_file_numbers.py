"""What is as the ship file has it is no fault to write."""

from dataclasses import replace

import numpy as np
import pytest

import twin
from tests.study.instruments.test_instruments import EVERY, KEPT, LOG, RATE, voyage
from twin.cli import main
from twin.physics.effects.gyro_bias import GyroBias
from twin.physics.ship import load
from twin.recording.ship_file_writer import save
from twin.study.instruments.instrument_lines import terminal_lines

BIAS = 0.001  # of the gyro [rad/s]


@pytest.fixture
def biased(sail):
    """{column: (N,)} of twelve minutes of zigzags twice a second, whose gyro shows BIAS too much."""
    columns = {name: column[::EVERY] for name, column in sail(720.0, seed=3).items() if name in KEPT}
    return columns | {RATE: columns[RATE] + np.degrees(BIAS)}


def ship_with(bias):
    """A tanker whose file has this bias of its gyro [rad/s]."""
    return replace(load("kvlcc2"), effects=(*load("kvlcc2").effects, GyroBias(bias=bias)))


@pytest.mark.parametrize("log_mps, next_voyage", [(0.0, "twin compare"), (0.7, "twin instruments")])
def test_what_the_ship_file_has_as_the_voyage_tells_it_is_one_line_and_no_file(
    log_mps, next_voyage, biased, write_csv, tmp_path, capsys
):
    """Test: a gyro that is off as the ship file says; with it a log that is off, by its scale or by a bias.
    Expected: exit code 3, no file, the gyro in one line; next the comparison with that ship file, or another voyage
    that tells what the log has."""
    ship, out = tmp_path / "ship.toml", tmp_path / "corrected.toml"
    save(ship_with(BIAS), ship, "kvlcc2")
    path = str(write_csv(biased | {LOG: biased[LOG] + log_mps}))
    assert main(["instruments", path, "--ship", str(ship), "-o", str(out)]) == 3
    said = capsys.readouterr().out.splitlines()
    assert not out.exists() and not any(x.startswith("wrote") for x in said)
    (line,) = (x for x in said if x.startswith("rate gyro bias"))
    assert line.startswith(
        "rate gyro bias (GyroBias): as the ship file has it within 95 % (bias 0.0573 deg/s)"
    )
    (why,) = (x for x in said if x.startswith(f"{out} was not written: "))
    assert "rate gyro bias is as the ship file has it" in why and ("and neither is written" in why) == (
        log_mps > 0
    )
    assert said[0].startswith(
        "speed log" if log_mps else "No instrument disagrees with the others beyond its noise, but"
    )
    assert said[-1].startswith(f"next: {next_voyage} ") and str(out) not in said[-1].split(" -o ")[0]


def test_what_the_ship_file_has_otherwise_is_written_and_its_old_number_said(biased):
    ship = ship_with(2.0 * BIAS)
    found = twin.instruments(ship, voyage(biased))
    known = "  in the ship file already: bias 0.115 deg/s"
    assert found.as_filed == [] and known in found.text() and known not in terminal_lines(found.found)
    (gyro,) = (e for e in found.corrected(ship).effects if type(e).__name__ == "GyroBias")
    assert gyro.bias == pytest.approx(BIAS, rel=0.1)


def test_of_a_fault_that_the_ship_file_has_the_page_says_nothing_new(biased):
    found = twin.instruments(ship_with(BIAS), voyage(biased))
    assert found.faults == found.as_filed == ["gyro_bias"]
    assert "beyond its noise, but for what the ship file has." in found.page()
