"""The instruments are tested on the ship of kinematics alone."""

from tests.recording.conftest import sail_fixture, write_csv

__all__ = ["sail_fixture", "write_csv"]
