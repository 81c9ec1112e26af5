"""A project with the bundled tanker and the beginnings of its two voyages, a server of it, and a real Chromium."""

import os
import re
import subprocess
import sys

import pytest

from twin.recording.read import read_voyage
from twin.recording.write import write_voyage
from twin.studio.project import Project

# of half an hour: the fouled hull is named and proved all the same; pictures are of the whole
ENOUGH_S = float("inf") if os.environ.get("STUDIO_PICTURES") else 800.0


class Served:
    """`twin studio` on a folder, in a process of its own, as a person starts it."""

    def __init__(self, folder, *more):
        command = [sys.executable, "-m", "twin", "studio", str(folder), "--port", "0", "--no-browser", *more]
        self.folder = folder
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.links = [self.process.stdout.readline().split()[-1]]
        self.port = int(re.search(r":(\d+)/", self.links[0])[1])

    def stop(self):
        self.process.terminate()
        assert self.process.wait(20) is not None
        self.process.stdout.close()


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """One for all tests of a file."""
    folder = tmp_path_factory.mktemp("project") / "voyages"
    folder.mkdir()
    project = Project(folder)
    project.take_demo()
    for name in ("monday.mcap", "tuesday.mcap"):
        write_voyage(read_voyage(folder / name).between(0.0, ENOUGH_S), folder / name)
    return project


@pytest.fixture(scope="module")
def served(project):
    served = Served(project.folder)
    yield served
    served.stop()


@pytest.fixture(scope="session")
def serve():
    return Served


@pytest.fixture(scope="module")
def spoiled(project):
    """An owner's table in the project, with the owner's own map: Tuesday's voyage with the rudder positive to
    port, of which the map says nothing."""
    v = read_voyage(project.folder / "tuesday.mcap")
    names = [
        "north_m",
        "east_m",
        "heading_true_north_deg",
        "surge_velocity_mps",
        "sway_velocity_mps",
        "yaw_rate_degps",
    ]
    columns = {n: v[n] for n in names} | {"rudder_angle_deg": -v["rudder_angle_deg"]}
    columns |= {"propeller_rate_rpm": v["propeller_rate_rpm"]}
    rows = zip(v.time_s, *columns.values(), strict=True)
    lines = [",".join(["time_s", *columns])]
    lines += [",".join("" if x != x else f"{x:.10g}" for x in row) for row in rows]
    (project.folder / "owner.csv").write_text("\n".join(lines) + "\n")
    by = ['[time]\ncolumn = "time_s"\n\n[columns]', *(f'{name} = "{name}"' for name in columns)]
    (project.folder / "owner-map.toml").write_text("\n".join(by) + "\n")
    return project.folder / "owner.csv"
