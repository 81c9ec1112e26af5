"""The one table of formats: how a file is recognised, what it is called, and what reads it.

A `series` format is read into named series with their own stamps, and its own map says which is which channel
(`choose`). A `table` format has columns, which are the channels' own names or go through a map.
"""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from twin.errors import DataError
from twin.recording.formats import (
    ais,
    autopilots,
    binary_tables,
    canboat_json,
    iso19848,
    json_records,
    keelson,
    nmea0183,
    nmea2000,
    px4,
    ros,
    signalk,
)
from twin.recording.formats.lines import head, head_lines
from twin.recording.formats.other_files import refuse_others
from twin.recording.formats.signals import Signals

MCAP = b"\x89MCAP0\r\n"


class Format(NamedTuple):
    """What a file may be: `looks` at its first lines and bytes; one of `series` and `table` reads it."""

    name: str
    says: str
    looks: Callable[[list[str], bytes], bool]
    series: Callable[[Path], Signals] | None = None
    table: type[binary_tables.Packed] | None = None


def never(lines: list[str], start: bytes) -> bool:
    """No: this format is not recognised by its head."""
    return False


FORMATS: tuple[Format, ...] = (
    Format("parquet", binary_tables.PARQUET, binary_tables.looks_parquet, table=binary_tables.Parquet),
    Format("feather", binary_tables.FEATHER, binary_tables.looks_feather, table=binary_tables.Feather),
    Format("excel", binary_tables.EXCEL, binary_tables.looks_excel, table=binary_tables.Excel),
    Format("ros", ros.SAYS, ros.looks, ros.read),
    Format("ulog", px4.ULOG, px4.looks_ulog, px4.read_ulog),
    Format("dataflash", autopilots.FLASH, autopilots.looks_flash, autopilots.read_flash),
    Format("tlog", autopilots.TLOG, autopilots.looks_tlog, autopilots.read_tlog),
    Format("nmea2000", "an NMEA 2000 log", nmea2000.looks, nmea2000.read),
    Format("canboat_json", canboat_json.SAYS, canboat_json.looks, canboat_json.read),
    Format("signalk", signalk.SAYS, signalk.looks, signalk.read),
    Format("iso19848", iso19848.SAYS, iso19848.looks, iso19848.read),
    Format("ais", ais.SAYS, ais.looks, ais.read),
    Format("nmea0183", nmea0183.SAYS, nmea0183.looks, nmea0183.read),
    Format("json", json_records.JSON, json_records.looks_json, table=json_records.JsonRecords),
    Format("keelson", keelson.SAYS, never, keelson.read),  # an MCAP: told by what it holds
)
BY_NAME = {f.name: f for f in FORMATS}


def recognised(path: Path) -> Format | None:
    """The format of a file; None: text columns, or the twin's own log. DataError: it is of a kind that is
    known and not read."""
    if ros.is_folder(path):
        return BY_NAME["ros"]
    if path.is_dir():
        return None
    start = head(path)
    if start.startswith(MCAP):
        return of_mcap(path)
    if start.startswith(b"SQLite format 3"):
        return BY_NAME["ros"]
    lines = head_lines(start)
    found = next((f for f in FORMATS if f.looks(lines, start)), None)
    if found is None:
        refuse_others(path, start)
    return found


def of_mcap(path: Path) -> Format | None:
    """A ROS 2 recording, Keelson's, or (None) the twin's own; DataError for another's."""
    from twin.live.keelson.topics import address
    from twin.live.log.mcap_read import McapReader

    topics: dict[str, str] = {}
    for n, message in enumerate(McapReader(path).messages()):
        topics.setdefault(message.topic, message.type_name)
        if message.type_name in ("shiptwin.Row", "shiptwin.Tick"):
            return None
        if n > 5000:
            break
    if any("/msg/" in kind for kind in topics.values()):
        return BY_NAME["ros"]
    if topics and not any(address(topic) for topic in topics):
        held = ", ".join(f"{topic} ({kind or 'no type'})" for topic, kind in list(topics.items())[:6])
        raise DataError(
            f"{path}: this is an MCAP log of neither Keelson nor ROS 2: {held}. Export it as a table (CSV)."
        )
    return BY_NAME["keelson"]
