"""The row of a log whose voyage has channels of a ship's actuators: as the log's own schema defines it."""

from typing import Any

from google.protobuf.message import DecodeError

from twin.live.keelson import messages
from twin.live.keelson.schema import classes_from_set
from twin.live.log.mcap_read import McapReader

ROW = "shiptwin.Row"


def own_row(reader: McapReader) -> dict[str, Any]:
    """{type name: class} where the rows read so far are no usual ones, else {}."""
    try:
        (own,) = classes_from_set(reader.schemas[ROW], [ROW])
    except (KeyError, TypeError, ValueError, DecodeError):
        return {}  # the rows are tried by the usual one
    of_actuators = any("." in messages.channel_name(field.name) for field in own.DESCRIPTOR.fields)
    return {ROW: own} if of_actuators else {}
