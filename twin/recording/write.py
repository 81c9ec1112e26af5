"""A voyage as an MCAP file: one wide row a sample, and what is known about the file as a table of words."""

import json
from pathlib import Path

import numpy as np

from twin import __version__
from twin.live.keelson.messages import field_name, row_with
from twin.live.log.mcap_damage import EXTENT, extent
from twin.live.log.mcap_index import PROVENANCE
from twin.live.log.record import LogFile
from twin.live.signals.channels import of_actuators
from twin.recording.raw import ABOUT
from twin.recording.timebase import moment_of
from twin.recording.voyage import Voyage

TOPIC = "shiptwin/voyage/row"
NS = 1_000_000_000
LAST_NS = 2**63 - 1
ROWS_AT_ONCE = 50_000


def write_voyage(voyage: Voyage, path: str | Path) -> None:
    """Writes aside and renames: the file is whole or not there. Missing samples are left out of a row."""
    start_ns = round(moment_of(voyage.meta.get("start_time_utc")) * NS)
    names = sorted(voyage.columns)
    row_class = row_with(of_actuators(names))
    with LogFile(path, {"shiptwin.Row": row_class}) as log:
        log.describe(
            ABOUT, {key: json.dumps(value) for key, value in (*voyage.meta.items(), ("name", voyage.name))}
        )
        log.describe(PROVENANCE, {"software": "shiptwin", "version": __version__})
        if len(voyage):
            log.describe(EXTENT, extent(*(_log_ns(start_ns, float(t)) for t in voyage.time_s[[0, -1]])))
        for at in range(0, len(voyage), ROWS_AT_ONCE):
            rows = slice(at, at + ROWS_AT_ONCE)
            table = np.stack([voyage.columns[name][rows] for name in names], axis=1)
            for time_s, values, there in zip(
                voyage.time_s[rows].tolist(), table.tolist(), np.isfinite(table).tolist(), strict=True
            ):
                held = {n: x for n, x, ok in zip(names, values, there, strict=True) if ok}
                row = row_class(time_s=time_s, **{field_name(n): x for n, x in held.items()})
                log.add(TOPIC, "shiptwin.Row", row.SerializeToString(), _log_ns(start_ns, time_s))


def _log_ns(start_ns: int, time_s: float) -> int:
    """The log time of a row; the nearest that a log can hold, where the voyage's own stamps are no dates."""
    return min(max(start_ns + round(time_s * NS), 0), LAST_NS)
