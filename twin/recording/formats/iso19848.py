"""ISO 19848 (time series of ship equipment) as JSON: data channels by their identifiers, each with its
stamps."""

import json
from pathlib import Path
from typing import Any

from twin.errors import DataError
from twin.recording.formats.lines import opened
from twin.recording.formats.recorder_stamps import from_iso
from twin.recording.formats.signals import QUANTITIES, Signals

SAYS = "an ISO 19848 package"
LARGEST = 200 << 20  # bytes; JSON is read whole


def looks(lines: list[str], start: bytes) -> bool:
    """Whether a file starts with the names that the standard's JSON uses."""
    return b'"TimeSeriesData"' in start or (b'"Package"' in start and b'"DataChannel' in start)


def read(path: Path) -> Signals:
    """Series named by their data channel; one whose name ends in a channel of the twin is taken for it.
    DataError: it is too large, or no JSON."""
    out = Signals(path, SAYS)
    with opened(path) as stream:
        text = stream.read(LARGEST + 1)
    if len(text) > LARGEST:
        raise DataError(
            f"{path}: this is {SAYS} of more than {LARGEST >> 20} MB. Cut it into shorter packages."
        )
    try:
        package = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise DataError(f"{path}: this is {SAYS}, and it is no JSON: {str(error)[:120]}.") from None
    for series in found(package, "TimeSeriesData"):
        for table in found(series, "TabularData"):
            tabular(out, table)
        for event in found(series, "EventData"):
            events(out, event)
    return out.finish()


def found(tree: Any, key: str, depth: int = 6) -> list[dict[str, Any]]:
    """Every object under a key, wherever it stands."""
    if isinstance(tree, list):
        return [hit for branch in tree for hit in found(branch, key, depth)]
    if not isinstance(tree, dict) or not depth:
        return []
    here = tree.get(key)
    hits = [x for x in (here if isinstance(here, list) else [here]) if isinstance(x, dict)]
    return hits or [hit for branch in tree.values() for hit in found(branch, key, depth - 1)]


def tabular(out: Signals, table: dict[str, Any]) -> None:
    """The samples of a table: a row for each time stamp, a value for each data channel."""
    names, rows = table.get("DataChannelID", []), table.get("DataSet", [])
    for row in rows if isinstance(rows, list) else ():
        t = from_iso(str(row.get("TimeStamp", ""))) if isinstance(row, dict) else None
        values = row.get("Value") if t is not None else None
        if t is None or not isinstance(values, list):
            out.skipped["rows without a time stamp"] += 1
            continue
        for name, value in zip(names, values, strict=False):
            sample(out, str(name), t, value)


def events(out: Signals, event: dict[str, Any]) -> None:
    """The samples of events, each with its own data channel and time stamp."""
    for row in found(event, "DataSet") or [event]:
        t = from_iso(str(row.get("TimeStamp", "")))
        if t is not None and "DataChannelID" in row:
            sample(out, str(row["DataChannelID"]), t, row.get("Value"))


def sample(out: Signals, name: str, t: float, value: Any) -> None:
    """One value of a data channel at `t` [s since 1970]; what is no number is counted."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        out.skipped["values that are no numbers"] += 1
        return
    last = name.rstrip("/").rpartition("/")[2]
    out.put(name, "", last if last in QUANTITIES else "", t, number)
