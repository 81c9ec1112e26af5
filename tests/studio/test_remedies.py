"""Each mistake that a check proves is mended by its button: the edited map is read, and the check is quiet."""

import tomllib

import numpy as np
import pytest

from twin.recording.checks import run_checks, wind_triangle
from twin.recording.map_file import parse_map
from twin.recording.mapping import GROUND
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


WINDS = tuple(name for pair in wind_triangle.WINDS for name in pair)


def table(path, mistake):
    """Tuesday's voyage as an owner's table with a mistake in it."""
    v = read_voyage(BUNDLED / "tuesday.mcap")
    columns = {name: v[name].copy() for name in COLUMNS}
    mistake(columns)
    return written(path, v, columns)


def written(path, v, columns):
    rows = zip(v.time_s, *columns.values(), strict=True)
    lines = [",".join(["time_s", *columns])]
    lines += [",".join("" if np.isnan(x) else f"{x:.10g}" for x in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    return path


def mend(path, text=AS_NAMED):
    """(checks before, remedies taken, checks after): every first remedy is written into the map, until none is left."""
    taken, first = [], None
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


def windy():
    """Tuesday's voyage with a wind of 12 m/s from 30 deg, both winds recorded."""
    v = read_voyage(BUNDLED / "tuesday.mcap")
    columns = {name: v[name].copy() for name in COLUMNS}
    psi = np.radians(columns["heading_true_north_deg"])
    motion = columns["surge_velocity_mps"] + 1j * columns["sway_velocity_mps"]
    apparent = 12.0 * np.exp(1j * (np.radians(30.0) - psi)) + motion
    true = np.full(psi.size, 12.0), np.full(psi.size, 30.0)
    seen = np.abs(apparent), np.degrees(np.angle(apparent)) % 360.0
    return v, columns | dict(zip(WINDS, (*true, *seen), strict=True)), np.degrees(psi)


WIND_MISTAKES = {  # each row of the table -> (T, theta, A, alpha, psi) as it is then recorded
    "the true wind is given as where it blows to": lambda t, h, a, b, p: (t, h + 180.0, a, b),
    "the apparent wind is given as where it blows to": lambda t, h, a, b, p: (t, h, a, b + 180.0),
    "both winds are given as where they blow to": lambda t, h, a, b, p: (t, h + 180.0, a, b + 180.0),
    "the apparent angle is positive to port": lambda t, h, a, b, p: (t, h, a, -b),
    "the true direction is in radians": lambda t, h, a, b, p: (t, np.radians(h), a, b),
    "the apparent angle is in radians": lambda t, h, a, b, p: (t, h, a, np.radians(b)),
    "both directions are in radians": lambda t, h, a, b, p: (t, np.radians(h), a, np.radians(b)),
    "the true direction counts from the bow": lambda t, h, a, b, p: (t, h - p, a, b),
    "the apparent angle counts from north": lambda t, h, a, b, p: (t, h, a, b + p),
    "the apparent wind speed is in knots": lambda t, h, a, b, p: (t, h, a / 0.514444, b),
    "the true wind speed is in knots": lambda t, h, a, b, p: (t / 0.514444, h, a, b),
    "both wind speeds are in knots": lambda t, h, a, b, p: (t / 0.514444, h, a / 0.514444, b),
    "true and apparent wind are swapped": lambda t, h, a, b, p: (a, b, t, h),
}
BY_HAND = ("counts from the bow", "counts from north")  # no entry of a map turns one into the other


@pytest.mark.parametrize("mistake", [text for text, _, _ in wind_triangle.MISTAKES if text])
def test_a_proved_mistake_of_the_wind_is_mended_by_its_button(tmp_path, mistake):
    v, columns, psi = windy()
    recorded = WIND_MISTAKES[mistake](*(columns[name] for name in WINDS), psi)
    path = written(tmp_path / "owner.csv", v, columns | dict(zip(WINDS, recorded, strict=True)))
    first, taken, last = mend(path, AS_NAMED + "".join(f'{name} = "{name}"\n' for name in WINDS))
    assert [c.name for c in first if c.unusable] == ["wind"], "the mistake was not seen"
    if mistake.endswith(BY_HAND):
        assert not taken
    else:
        assert len(taken) == 1
        assert not [c.text for c in last if c.unusable]


OVER_GROUND = {
    "a speed over ground in knots": ("course", lambda w: (np.abs(w) / 0.514444, np.degrees(np.angle(w)))),
    "a course over ground in radians": ("course", lambda w: (np.abs(w), np.angle(w))),
    "velocities north and east in knots": ("earth", lambda w: (w.real / 0.514444, w.imag / 0.514444)),
    "velocities north and east swapped": ("earth", lambda w: (w.imag, w.real)),
    "a velocity to the west": ("earth", lambda w: (w.real, -w.imag)),
}


@pytest.mark.parametrize("mistake", OVER_GROUND)
def test_a_remedy_of_the_velocity_mends_the_line_of_a_speed_over_ground(tmp_path, mistake):
    v = read_voyage(BUNDLED / "tuesday.mcap")
    columns = {name: v[name].copy() for name in COLUMNS}
    motion = columns.pop("surge_velocity_mps") + 1j * columns.pop("sway_velocity_mps")
    frame, spoil = OVER_GROUND[mistake]
    ground = spoil(motion * np.exp(1j * np.radians(columns["heading_true_north_deg"])))
    columns |= dict(zip(GROUND[frame], ground, strict=True))
    path = written(tmp_path / "owner.csv", v, columns)
    lines = "".join(f'{name} = "{name}"\n' for name in columns)
    first, taken, last = mend(path, f'[time]\ncolumn = "time_s"\n\n[columns]\n{lines}')
    assert [c.name for c in first if c.unusable], "the mistake was not seen"
    assert taken
    assert not [c.text for c in last if c.unusable]


@pytest.mark.parametrize(
    ("text", "edit", "line"),
    [
        ('[columns]\nsurge_velocity_mps = "u"\n', {"time": {"rebuild": True}}, "rebuild = true"),
        ('[time]  # note\ncolumn = "t"\n', {"time": {"rebuild": True}}, "rebuild = true"),
        (
            '[columns]\n"port.pwm_us" = "l"  # note\n',
            {"port.pwm_us": {"sign": -1}},
            '"port.pwm_us" = { column = "l", sign = -1 }  # note',
        ),
        (
            '[columns]   # mine\nrudder_angle_deg = "r"\n',
            {"yaw_rate_degps": {"column": "x"}},
            'yaw_rate_degps = "x"',
        ),
    ],
)
def test_a_map_is_edited_however_its_owner_wrote_it(text, edit, line):
    again = edited(text, edit)
    assert line in again.splitlines()
    assert all(part in again for part in text.splitlines() if "#" in part and "=" not in part)


@pytest.mark.parametrize(
    "edit", [{"rudder_angle_deg": {"sign": -1}}, {"swap": [["north_m", "east_m"]]}, {"time": {"unit": "s"}}]
)
def test_a_remedy_that_changes_nothing_says_so(edit):
    with pytest.raises(ValueError, match=r"no line for (rudder_angle_deg|north_m)|says this already"):
        edited('[time]\nunit = "s"\n\n[columns]\nyaw_rate_degps = "r"\n', edit)


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
