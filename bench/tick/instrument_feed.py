"""The other end of the bus while the loop is measured: the sea's instruments, in step with the loop.

It listens to the loop's own records and, for each, sends everything that is due up to that record's time.
So the loop may run as fast as it can, or on time, and gets the same number of messages for a second of
its own clock.

    python -m bench.tick.instrument_feed ROWS.pickle ENDPOINT BASE ENTITY
"""

import os
import pickle
import sys
import time
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from bench.tick.mark import Mark
from twin.live.keelson.messages import Tick, encode_fix, encode_float, unwrap, wrap
from twin.live.keelson.topics import BY_SUBJECT, INPUTS, key
from twin.live.signals import geodesy

LATITUDE_DEG, LONGITUDE_DEG = 57.62, 11.58
HZ = 10.0  # of the reference sea


class FedRow(NamedTuple):
    """What is said at one instant: seconds since the start, and (subject, value or (north, east)); the
    subject of an actuator with its name behind it."""

    time_s: float
    said: list[tuple[str, float | tuple[float, float]]]


def prepare(path: Path, seconds: float, hull: str) -> None:
    """Sail the voyage that will be fed and keep it in a file."""
    from bench.reference import Sea, SeaCase
    from bench.reference.boats import CRAFT, BoatCase, BoatSea

    sea = (
        BoatSea(BoatCase(hull, "mixed", seed=7), 1.0 / HZ)
        if hull in CRAFT
        else Sea(SeaCase(hull, "mixed", "TS-01", seed=7, duration_s=None), 1.0 / HZ)
    )
    rows = []
    for _ in range(int(seconds * HZ)):
        rows.append(_row(sea.readings()))
        sea.step()
    path.write_bytes(pickle.dumps(rows))


def _row(readings: dict[str, float]) -> FedRow:
    said: list[tuple[str, float | tuple[float, float]]] = []
    for topic in INPUTS:
        values = tuple(readings.get(channel, float("nan")) for channel in topic.channels)
        if topic.factor == 1.0 and all(v == v for v in values):
            said.append((topic.subject, values[0] if len(values) == 1 else values))  # type: ignore[arg-type]
    for channel, value in readings.items():
        name, _, last = channel.rpartition(".")
        if name and value == value:
            said.append((f"actuator_{last}/{name}", value))
    return FedRow(readings["time_s"], said)


class TickFeed:
    """`follow(wall_s)` says what is due."""

    def __init__(self, session, base: str, entity: str, rows: Sequence[FedRow]):
        own = dict.fromkeys(s for row in rows for s, _ in row.said if "/" in s)
        places = {s: key(base, entity, s, "sea") for s in BY_SUBJECT}
        places |= {s: key(base, entity, *s.split("/")) for s in own}
        self.put = {s: session.declare_publisher(place).put for s, place in places.items()}
        self.datum = geodesy.datum(LATITUDE_DEG, LONGITUDE_DEG)
        self.rows, self.next, self.start_s = rows, 0, None

    def follow(self, wall_s: float) -> None:
        if self.start_s is None:
            self.start_s = wall_s
        while self.next < len(self.rows) and self.rows[self.next].time_s <= wall_s - self.start_s:
            self._say(self.rows[self.next])
            self.next += 1

    def _say(self, row: FedRow) -> None:
        wall_ns = int((self.start_s + row.time_s) * 1e9)
        for subject, value in row.said:
            place = isinstance(value, tuple)
            data = (
                encode_fix(*geodesy.from_chart(self.datum, *value), wall_ns)
                if place
                else encode_float(value, wall_ns)
            )
            self.put[subject](wrap(data, wall_ns))


def main(rows: str, endpoint: str, base: str, entity: str) -> None:
    import zenoh

    from twin.live.keelson.zenoh_config import BusSettings, configuration

    voyage = pickle.loads(Path(rows).read_bytes())
    session = zenoh.open(configuration(BusSettings(base, entity, "", (endpoint,))))
    newest = session.declare_subscriber(key(base, entity, "twin_tick", "twin"), zenoh.handlers.RingChannel(1))
    feed, parent = TickFeed(session, base, entity, voyage), os.getppid()
    mark = Mark(Path(rows).with_suffix(".mark"))
    while os.getppid() == parent:
        sample = newest.try_recv()
        if sample is None:
            time.sleep(2e-4)
        else:
            wall_s = Tick.FromString(unwrap(sample.payload.to_bytes())[1]).wall_s
            feed.follow(wall_s)
            mark.write(wall_s)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(0)
