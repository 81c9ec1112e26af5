"""A log's series as tables, one for each topic: what its format does not name is guessed as columns are."""

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from twin.recording.columns_seen import SeenColumns
from twin.recording.formats.autopilot_settings import OUTPUT, THROTTLE
from twin.recording.formats.series_table import as_columns
from twin.recording.formats.signals import Signals

CLOCK = "time_s"  # the column of stamps that each topic gets
OWN = 9.0  # words that speak for what the format itself names
MOST_SAMPLES = 60_000  # samples of a topic that are looked at
SHAFT = re.compile(r"RPM\.shaft(\d+)$")
CONTROLS = ("rudder_angle_deg", "propeller_rate_rpm")
FULL_DEG = 35.0  # a rudder's full angle, where nobody said it
LISTED = re.compile(r"^/.*\.data_(\d+)$")  # of a topic of ROS that holds a list
INSTANCE = re.compile(r"^(?:actuator_)?([a-z_]+)\d+\.[a-z_]+\[?(\d+)\]?$")  # of a topic of PX4


def topics_seen(signals: Signals) -> list[SeenColumns]:
    """A table for each topic: what stands before the last point of its series' names."""
    topics: dict[str, list[str]] = defaultdict(list)
    for name in signals.series:
        topics[name.rpartition(".")[0]].append(name)
    return [topic_seen(signals, names) for names in topics.values()]


def topic_seen(signals: Signals, names: Sequence[str]) -> SeenColumns:
    """One topic's series with their stamps; what a number among outputs stands for is said beside it."""
    time_s, columns = as_columns(signals, names)
    cells: dict[str, Any] = {CLOCK: time_s[:MOST_SAMPLES]}
    cells |= {n: x[:MOST_SAMPLES] for n, x in columns.items()}
    seen = SeenColumns(signals.path, [CLOCK, *names], cells)
    for name in names:
        label = (
            output_label(name)
            if name in columns and np.nanmin(columns[name]) < np.nanmax(columns[name])
            else ""
        )
        if label := label or side_label(name, signals.series[name].quantity):
            seen.labels[name] = label
    return seen


def side_label(name: str, quantity: str) -> str:
    """A rudder or a shaft of which the name says the side or the number; odd shafts of NMEA 0183 stand to
    starboard, even ones to port. "" of another quantity."""
    if quantity not in CONTROLS:
        return ""
    kind = "shaft rpm" if quantity == CONTROLS[1] else "rudder angle"
    if found := SHAFT.search(name):
        return f"{('port', 'starboard')[int(found[1]) % 2]} {kind}" if int(found[1]) else ""
    side = next((w for w in ("port", "starboard") if w in re.split(r"[^a-z]+", name.lower())), "")
    return f"{side} {kind}" if side else ""


def output_label(name: str) -> str:
    """What an autopilot's output is called in words; "" where its name says it itself."""
    if found := OUTPUT.search(name):
        return f"servo {found[1]} pwm"
    if found := LISTED.match(name):
        return f"{name.rpartition('/')[2].partition('.')[0].removesuffix('s')} {found[1]}"
    found = INSTANCE.match(name)
    return f"{found[1].removesuffix('s')} {int(found[2]) + 1} command" if found else ""


def known_series(
    signals: Signals, columns: Mapping[str, Any], topics: Sequence[SeenColumns]
) -> Iterator[tuple[str, SeenColumns, str]]:
    """(channel, its topic, its series) of what the log's own map takes of position, heading and turning."""
    for channel, entry in columns.items():
        name = entry["column"] if isinstance(entry, dict) else entry
        seen = next((t for t in topics if name in t.names), None)
        if seen is not None and not isinstance(entry, dict) and np.isfinite(seen.numbers(name)).sum() > 10:
            yield channel, seen, name


def by_settings(signals: Signals) -> dict[str, tuple[dict[str, Any], str]]:
    """{channel: (entry, why)} of a steered boat's outputs, as its settings say what each does."""
    out: dict[str, tuple[dict[str, Any], str]] = {}
    for name, had in signals.settings.items():
        if had["function"] == THROTTLE:
            out["main.pwm_us"] = {"column": name}, "the throttle, as the boat's settings say"
        elif had["max"] > had["trim"]:
            by = FULL_DEG / (had["max"] - had["trim"])
            entry = {"column": name, "factor": round(by, 6), "offset": round(-had["trim"] * by, 4)}
            out["main.angle_deg"] = (
                entry,
                f"the steering; full is taken as {FULL_DEG:.0f} deg to starboard. CONFIRM",
            )
    return out if len(out) == 2 else {}
