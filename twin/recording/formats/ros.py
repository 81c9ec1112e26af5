"""ROS 1 bags and ROS 2 recordings (mcap, db3, a folder of either), without ROS: the library is rosbags.

A series is named topic and part (`/imu.rate`), its source the topic. A message's own stamp is used where it
has one, else when it was recorded.
"""

import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from twin.errors import DataError
from twin.recording.formats.extra import library, one_line
from twin.recording.formats.nmea0183 import Nmea
from twin.recording.formats.ros_messages import MESSAGES, frame_of, numbers
from twin.recording.formats.signals import Signals

SAYS = "a ROS recording"
MOST_SERIES = 400
SENTENCE = "nmea_msgs/msg/Sentence"
Message = tuple[str, str, float, Any]  # topic, type, when recorded [s], the message


def looks(lines: list[str], start: bytes) -> bool:
    """Whether a file starts as a ROS 1 bag, or as a database of topics."""
    return start.startswith(b"#ROSBAG V") or (start.startswith(b"SQLite format 3") and b"topics" in start)


def is_folder(path: Path) -> bool:
    """Whether a folder holds a ROS 2 recording."""
    return path.is_dir() and (
        (path / "metadata.yaml").is_file() or any(path.glob("*.db3")) or any(path.glob("*.mcap"))
    )


def read(path: Path) -> Signals:
    """All messages of known types, and any sentences of NMEA 0183 among them. DataError: nothing of it can
    be read."""
    out = Signals(path, SAYS)
    sentences = Nmea(out)
    try:
        for topic, kind, recorded_s, message in messages(path, out):
            take(out, sentences, topic, kind, recorded_s, message)
    except (DataError, MemoryError):
        raise
    except Exception as error:
        if not out.series:
            mend = " `rosbag reindex` or `ros2 bag reindex` mends what was cut off." * (
                "index" in str(error).lower()
            )
            raise DataError(
                f"{path}: this is {SAYS}, and it cannot be read: {one_line(error)}.{mend}"
            ) from None
        out.notes.append(f"it is damaged and was read up to there: {one_line(error)}")
    return out.finish()


def messages(path: Path, out: Signals) -> Iterator[Message]:
    """The messages of a bag, a folder, or one file of a folder."""
    if path.suffix == ".db3" or path.suffix == ".mcap":
        yield from (of_db3 if path.suffix == ".db3" else of_mcap)(path, out)
    elif path.is_dir() and not (path / "metadata.yaml").is_file():
        for part in sorted([*path.glob("*.db3"), *path.glob("*.mcap")]):
            yield from messages(part, out)
    else:
        yield from of_bag(path, out)


def of_bag(path: Path, out: Signals) -> Iterator[Message]:
    """The messages of a ROS 1 bag or of a folder with its metadata; those that cannot be decoded are
    counted."""
    highlevel = library("rosbags.highlevel", path, SAYS)
    with highlevel.AnyReader([path], default_typestore=typestore(path)) as reader:
        for connection, recorded_ns, raw in reader.messages():
            try:
                message = reader.deserialize(raw, connection.msgtype)
            except Exception:
                out.skipped[f"messages of {connection.msgtype} that cannot be decoded"] += 1
                continue
            yield connection.topic, connection.msgtype, recorded_ns * 1e-9, message


def typestore(path: Path) -> Any:
    """The definitions of message types that come with rosbags."""
    typesys = library("rosbags.typesys", path, SAYS)
    return typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)


def of_db3(path: Path, out: Signals) -> Iterator[Message]:
    """The messages of a database, in order of time."""
    store = typestore(path)
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as db:
        topics = {row[0]: (row[1], row[2]) for row in db.execute("select id, name, type from topics")}
        for topic_id, recorded_ns, raw in db.execute(
            "select topic_id, timestamp, data from messages order by timestamp"
        ):
            topic, kind = topics[topic_id]
            yield from decoded(store, out, topic, kind, recorded_ns, raw)


def of_mcap(path: Path, out: Signals) -> Iterator[Message]:
    """The messages of an MCAP file, with the types that it defines itself."""
    typesys, store = library("rosbags.typesys", path, SAYS), typestore(path)
    with open(path, "rb") as stream:
        for schema, channel, message in (
            library("mcap.reader", path, SAYS).make_reader(stream).iter_messages()
        ):
            kind = schema.name if schema else ""
            if kind not in store.fielddefs and schema is not None and schema.encoding == "ros2msg":
                store.register(typesys.get_types_from_msg(schema.data.decode(), kind))
            if channel.message_encoding == "cdr":
                yield from decoded(store, out, channel.topic, kind, message.log_time, message.data)


def decoded(
    store: Any, out: Signals, topic: str, kind: str, recorded_ns: int, raw: bytes
) -> Iterator[Message]:
    """The message, decoded; one that cannot be is counted."""
    try:
        yield topic, kind, recorded_ns * 1e-9, store.deserialize_cdr(raw, kind)
    except Exception:
        out.skipped[f"messages of {kind} that cannot be decoded"] += 1


def take(out: Signals, sentences: Nmea, topic: str, kind: str, recorded_s: float, message: Any) -> None:
    """A message's values into their series, at its own stamp or the recorder's."""
    t = stamp(message, recorded_s)
    if kind == SENTENCE:
        sentences.sentence_at(str(message.sentence), t)
        return
    if kind.endswith("/Log"):
        return
    rank, parts = MESSAGES.get(kind, (9, lambda m, _: numbers(m)))
    for part, quantity, value in parts(message, frame_of(message)):
        name = f"{topic}.{part}"
        if name in out.series or len(out.series) < MOST_SERIES:
            out.put(name, topic, quantity, t, float(value), rank)


def stamp(message: Any, recorded_s: float) -> float:
    """The header's stamp when it was set, else when the message was recorded [s]."""
    at = getattr(getattr(message, "header", None), "stamp", None)
    own = at.sec + at.nanosec * 1e-9 if at is not None else 0.0
    return own if own > 1e8 or (own > 0.0 and recorded_s < 1e8) else recorded_s
