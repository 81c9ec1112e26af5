"""A copy of a log with a fault in it."""

from contextlib import suppress
from typing import Any

from google.protobuf.message import DecodeError

from twin.errors import DataError
from twin.live.injection.faulty import Faulty, Sample
from twin.live.injection.inject import InjectedFault
from twin.live.keelson import messages
from twin.live.log.logfile import LogFile
from twin.live.log.mcap_read import McapReader
from twin.live.log.own_row import ROW, own_row


def in_a_log(path: str, output: str, what: str, fault: InjectedFault) -> tuple[int, list[str]]:
    """A copy of a log with the fault in it, whole or not at all; how many messages it changed, and what
    was wrong with the log itself. `output`: another file. DataError: the fault changes nothing in it."""
    reader, faulty, own = McapReader(path), None, dict[str, Any]()
    with LogFile(output, own) as log:
        for message in reader.messages():
            at_s = _at_s(message.type_name, message.data, message.log_ns)
            if faulty is None:
                own |= own_row(reader)
                begins = fault._replace(start_s=at_s + fault.start_s)
                faulty = Faulty(what, begins, own.get(ROW, messages.Row))
            for sample in faulty.feed(Sample(at_s, message.topic, message.type_name, message.data)):
                shift_ns = round((sample.at_s - at_s) * 1e9) if sample.at_s > at_s else 0
                log.add(
                    sample.key,
                    sample.type_name,
                    sample.payload,
                    message.log_ns + shift_ns,
                    message.publish_ns + shift_ns,
                )
        for name, values in reader.metadata.items():
            log.describe(name, values)
        if faulty is None or not faulty.changed:
            raise DataError(
                f"{path}: nothing in it is changed by {what} {fault.kind}: the channel is not in "
                "it, or not at that time."
            )
    return faulty.changed, [f"note: {problem}" for problem in reader.problems]


def _at_s(type_name: str, payload: bytes, log_ns: int) -> float:
    """When a logged message arrived: a row by its own time, which no logger's clock disturbs."""
    if type_name == "shiptwin.Row":
        with suppress(DecodeError):
            return float(messages.Row.FromString(payload).time_s)
    return log_ns * 1e-9
