"""A log's series as tables, one for each topic, so that what its format does not name is guessed as columns are."""

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from twin.recording.columns_seen import SeenColumns
from twin.recording.formats.series_table import as_columns
from twin.recording.formats.signals import Signals

CLOCK = "time_s"  # the column of stamps that each topic gets
OWN = 9.0  # words that speak for what the format itself names
MOST = 60_000  # samples of a topic that are looked at
OUTPUT = re.compile(r"(?:RCOU|SERVO_OUTPUT_RAW)[\d.]*\.(?:C|servo)(\d+)$")
INSTANCE = re.compile(r"^([a-z_]+)\d+\.([a-z_]+)\[?(\d+)\]?$")  # of a topic of PX4


def topics_seen(signals: Signals) -> list[SeenColumns]:
    """A table for each topic: what stands before the last point of its series' names."""
    topics: dict[str, list[str]] = defaultdict(list)
    for name in signals.series:
        topics[name.rpartition(".")[0]].append(name)
    return [topic_seen(signals, names) for names in topics.values()]


def topic_seen(signals: Signals, names: Sequence[str]) -> SeenColumns:
    """One topic's series with their stamps; what a number among outputs stands for is said beside it."""
    time_s, columns = as_columns(signals, names)
    cells: dict[str, Any] = {CLOCK: time_s[:MOST], **{n: x[:MOST] for n, x in columns.items()}}
    seen = SeenColumns(signals.path, [CLOCK, *names], cells)
    seen.labels |= {n: label for n in names if (label := output_label(n))}
    return seen


def output_label(name: str) -> str:
    """What an autopilot's output is called in words; "" where its name says it itself."""
    if found := OUTPUT.search(name):
        return f"servo {found[1]} pwm"
    found = INSTANCE.match(name)
    return f"{found[1]} {found[2]} {int(found[3]) + 1}" if found else ""


def known_series(
    signals: Signals, columns: Mapping[str, Any], topics: Sequence[SeenColumns]
) -> Iterator[tuple[str, SeenColumns, str]]:
    """(channel, its topic, its series) of what the log's own map takes of position, heading and turning."""
    for channel, entry in columns.items():
        name = entry["column"] if isinstance(entry, dict) else entry
        seen = next((t for t in topics if name in t.names), None)
        if seen is not None and not isinstance(entry, dict) and np.isfinite(seen.numbers(name)).sum() > 10:
            yield channel, seen, name
