"""Each mistake that a check proves is mended by its button: the edited map is read, and the check is quiet."""

import tomllib

import numpy as np
import pytest

from twin.recording.checks import run_checks
from twin.recording.map_file import parse_map
from twin.recording.read import read_voyage
from twin.studio.project import BUNDLED
from twin.studio.remedies import edited, remedies_of

COLUMNS = (
    "north_m",
    "east_m",
    "heading_true_north_deg",
    "surge_velocity_mps",
    "sway_velocity_mps",
    "yaw_rate_degps",
    "rudder_angle_deg",
    "propeller_rate_rpm",
)

# what its owner believes: a proposed map would mend some of the mistakes by itself
AS_NAMED = '[time]\ncolumn = "time_s"\n\n[columns]\n' + "".join(f'{name} = "{name}"\n' for name in COLUMNS)


def table(path, mistake):
    """Tuesday's voyage as an owner's table with a mistake in it."""
    v = read_voyage(BUNDLED / "tuesday.mcap")
    columns = {name: v[name].copy() for name in COLUMNS}
    mistake(columns)
    rows = zip(v.time_s, *columns.values(), strict=True)
    lines = [",".join(["time_s", *columns])]
    lines += [",".join("" if np.isnan(x) else f"{x:.10g}" for x in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    return path


def mend(path):
    """(checks before, remedies taken, checks after): every first remedy is written into the map, until none is left."""
    text, taken, first = AS_NAMED, [], None
    for _ in range(4):
        voyage = read_voyage(path, parse_map(tomllib.loads(text), "map"))
        checks = run_checks(voyage)
        first = first or checks
        found = [(c, r) for c in checks for r in remedies_of(c, voyage.columns)[:1] if c.unusable]
        if not found:
            return first, taken, checks
        check, remedy = found[0]
        taken.append((check.name, remedy["says"]))
        text = edited(text, remedy["edit"])
    return first, taken, checks


def scaled(name, k):
    return lambda c: c.update({name: k * c[name]})


def swapped(one, other):
    return lambda c: c.update({one: c[other], other: c[one]})


MISTAKES = {
    "rudder to port": (scaled("rudder_angle_deg", -1.0), "rudder_sign"),
    "rudder in radians": (scaled("rudder_angle_deg", np.pi / 180.0), "rudder_unit"),
    "rate of turn to port": (scaled("yaw_rate_degps", -1.0), "yaw_rate"),
    "shaft astern": (scaled("propeller_rate_rpm", -1.0), "propeller_rate"),
    "sway to port": (scaled("sway_velocity_mps", -1.0), "velocity_frame"),
    "east to the west": (scaled("east_m", -1.0), "velocity_frame"),
    "north and east swapped": (swapped("north_m", "east_m"), "velocity_frame"),
    "surge and sway swapped": (swapped("surge_velocity_mps", "sway_velocity_mps"), "velocity_frame"),
    "heading by 180": (
        lambda c: c.update({"heading_true_north_deg": (c["heading_true_north_deg"] + 180.0) % 360.0}),
        "velocity_frame",
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_proved_mistake_is_mended_by_its_button(tmp_path, mistake):
    spoil, name = MISTAKES[mistake]
    first, taken, last = mend(table(tmp_path / "owner.csv", spoil))
    assert [c.name for c in first if c.unusable], "the mistake was not seen"
    assert taken and taken[0][0] == name
    assert not [c.text for c in last if c.unusable]


def test_a_remedy_counts_from_what_the_map_says_already():
    text = '[time]\ncolumn = "t"\n\n[columns]\nrudder_angle_deg = { column = "R", sign = -1, offset = 2.0 }  # note\n'
    again = edited(text, {"rudder_angle_deg": {"sign": -1}})
    assert tomllib.loads(again)["columns"]["rudder_angle_deg"] == {"column": "R", "offset": -2.0}
    assert "# note" in again
    clock = edited(text, {"time": {"unit": "ms"}})
    assert tomllib.loads(clock)["time"] == {"column": "t", "unit": "ms"}


def test_a_quiet_check_has_no_remedy():
    voyage = read_voyage(BUNDLED / "monday.mcap")
    assert not [r for c in run_checks(voyage) for r in remedies_of(c, voyage.columns)]
