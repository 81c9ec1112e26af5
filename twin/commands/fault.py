"""`twin fault`: makes a fault on purpose, in a copy of a log, between sensors and a running twin, or in its
process.

    twin fault rudder stuck --log voyage.mcap -o faulty.mcap       then: twin replay faulty.mcap
    twin fault heading off --listen tcp/127.0.0.1:7448
        sensors connect there, the twin hears them through it
    twin fault pause --pid PID --for 4                             SIGSTOP, SIGCONT
"""

import argparse
import os
import resource
import signal
import sys
import time
from contextlib import suppress
from math import inf, isfinite
from typing import Any

from google.protobuf.message import DecodeError

from twin.cli import guarded
from twin.errors import DataError, UsageError
from twin.live.faulty import EVERYTHING, Faulty, Sample
from twin.live.inject import KINDS, InjectedFault
from twin.live.keelson import messages
from twin.live.keelson.bus import Bus
from twin.live.keelson.topics import OF_ACTUATORS, address, is_own, topic_of
from twin.live.log.logfile import LogFile
from twin.live.log.mcap_read import McapReader
from twin.live.log.own_row import ROW, own_row

OF_A_PROCESS = ("pause", "disk")
STEP_S = 0.005  # how often the proxy looks for messages


def add_arguments(parser: argparse.ArgumentParser) -> None:
    words = "\n".join(
        f"  {name:13} {kind.doc}{f' (--by, [{kind.unit}])' if kind.unit else ''}"
        for name, kind in KINDS.items()
    )
    parser.description = (
        f"{parser.description}\n\nkinds:\n{words}\n\nwhat else can be at fault: bus (nobody is heard), clock "
        "(every source's clock is off --by s),\n"
        "pause (--pid is stopped --for s), disk (no write of --pid succeeds --for s)"
    )
    parser.add_argument(
        "what",
        metavar="WHAT",
        help="a channel (rudder, heading, position, shaft, ... or its full name), bus, clock, pause, disk",
    )
    parser.add_argument("kind", nargs="?", metavar="KIND", help=f"for a channel: {', '.join(KINDS)}")
    parser.add_argument(
        "--by", type=float, metavar="X", help="how much, how many, how long or how often, by kind"
    )
    parser.add_argument(
        "--from",
        dest="start",
        type=float,
        default=0.0,
        metavar="S",
        help="when it begins, from the start (default: 0)",
    )
    parser.add_argument(
        "--for",
        dest="seconds",
        type=float,
        default=inf,
        metavar="S",
        help="how long it lasts (default: to the end)",
    )
    parser.add_argument("--seed", type=int, default=1, help="of what is random (default: 1)")
    parser.add_argument("--log", metavar="LOG.mcap", help="a log or a voyage to copy with the fault in it")
    parser.add_argument("-o", "--output", metavar="OUT.mcap", help="where the copy goes")
    parser.add_argument(
        "--listen", metavar="PLACE", help="live: where the sensors connect to, such as tcp/127.0.0.1:7448"
    )
    parser.add_argument(
        "--connect",
        metavar="PLACE",
        default="tcp/127.0.0.1:7447",
        help="live: where the twin listens (default: %(default)s)",
    )
    parser.add_argument("--base", default="twin", help="first part of every key (default: twin)")
    parser.add_argument("--entity", default="ship", help="the ship's name in every key (default: ship)")
    parser.add_argument(
        "--duration", type=float, default=inf, metavar="S", help="live: stop by itself after so many seconds"
    )
    parser.add_argument("--pid", type=int, metavar="PID", help="for pause and disk: the twin's process")


def run(args: argparse.Namespace) -> int:
    if not all(
        isfinite(x) and x >= 0.0 for x in (args.start, *((args.seconds,) if args.seconds != inf else ()))
    ):
        raise UsageError("--from and --for take seconds, 0 or more.")
    if args.what in OF_A_PROCESS:
        return of_a_process(args.what, args.pid, args.start, args.seconds)
    fault = asked(args)
    if args.log and args.output:
        return in_a_log(args.log, args.output, args.what, fault)
    if args.log or not args.listen:
        raise UsageError(
            "say where: --log LOG.mcap -o OUT.mcap for a copy with the fault, or --listen PLACE "
            "for a live bus."
        )
    return live(args, fault)


def asked(args: argparse.Namespace) -> InjectedFault:
    """The fault of these words, checked; its times are still counted from the start."""
    kind = args.kind or ("off" if args.what == "bus" else "wrong" if args.what == "clock" else "")
    usual = KINDS[kind].by if kind in KINDS else 0.0
    fault = InjectedFault(kind, usual if args.by is None else args.by, args.start, args.seconds, args.seed)
    if not isfinite(fault.by):
        raise UsageError(f"--by {args.by}: a finite number is needed.")
    if args.what == "clock" and not fault.by:
        raise UsageError("clock: by how much? --by takes seconds.")
    if args.what in EVERYTHING and args.kind not in (None, "off", "wrong"):
        raise UsageError(f"{args.what} takes no kind {args.kind!r}.")
    Faulty(args.what, fault)  # says what is wrong with it, before anything is opened
    return fault


def in_a_log(path: str, output: str, what: str, fault: InjectedFault) -> int:
    """A copy of a log with the fault in it, whole or not at all."""
    if os.path.realpath(path) == os.path.realpath(output):
        raise UsageError(f"-o {output}: is the log itself. Give another name.")
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
    print(f"{output}: {faulty.changed} messages with {what} {fault.kind}")
    for problem in reader.problems:
        print(f"note: {problem}")
    print(f"next: twin replay {output}")
    return 0


def _at_s(type_name: str, payload: bytes, log_ns: int) -> float:
    """When a logged message arrived: a row by its own time, which no logger's clock disturbs."""
    if type_name == "shiptwin.Row":
        with suppress(DecodeError):
            return float(messages.Row.FromString(payload).time_s)
    return log_ns * 1e-9


def live(args: argparse.Namespace, fault: InjectedFault) -> int:
    """Between the sensors and the twin until it is told to stop; ends the process itself (an open Zenoh
    session may not)."""
    code = 1
    try:
        code = guarded(lambda: proxy(args, fault))
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def proxy(args: argparse.Namespace, fault: InjectedFault) -> int:
    """Hear at one place, say at the other, with the fault in between."""
    from twin.live.keelson.zenoh_bus import ZenohBus
    from twin.live.keelson.zenoh_config import BusSettings

    stop: list[int] = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda caught, _: stop.append(caught))
    between = ZenohBus(BusSettings(args.base, args.entity, args.listen, (args.connect,)))
    between.listen_to(list(OF_ACTUATORS))
    with between as bus:
        print(f"{args.listen} -> {args.connect}: {args.what} {fault.kind}. Stop it with Ctrl-C.", flush=True)
        began_s, faulty = time.monotonic(), None
        while not stop and time.monotonic() - began_s < args.duration:
            for key, envelope, now_s in bus.drain(time.monotonic()):
                faulty = faulty or Faulty(args.what, fault._replace(start_s=now_s + fault.start_s))
                _pass_on(bus, faulty, key, envelope, now_s)
            time.sleep(STEP_S)
        said = bus.state
        print(
            f"{said.received} messages heard, {said.published} passed on, "
            f"{faulty.changed if faulty else 0} with the fault"
        )
    return 0


def _pass_on(bus: Bus, faulty: Faulty, key: str, envelope: bytes, now_s: float) -> None:
    place = address(key)
    topic = topic_of(place) if place else None
    if place is None or topic is None or is_own(place.source):
        return
    try:
        wall_ns, payload = messages.unwrap(envelope)
    except DecodeError:
        bus.publish(key, envelope)
        return
    for sample in faulty.feed(Sample(now_s, key, topic.type_name, payload)):
        bus.publish(sample.key, messages.wrap(sample.payload, wall_ns))


def of_a_process(what: str, pid: int | None, start_s: float, seconds: float) -> int:
    """Stop a process, or let none of its writes succeed, for a while; it is as before afterwards, also when
    this is interrupted."""
    if pid is None or seconds == inf:
        raise UsageError(
            f"{what}: which process, and how long? --pid PID --for S. The twin's: systemctl "
            "show -p MainPID --value shiptwin"
        )
    try:
        os.kill(pid, 0)
    except (ProcessLookupError, OverflowError):
        raise UsageError(f"--pid {pid}: there is no such process.") from None
    except PermissionError:
        raise UsageError(f"--pid {pid}: it is another user's. Use sudo.") from None
    time.sleep(start_s)
    (_pause if what == "pause" else _no_writes)(pid, seconds)
    print(f"process {pid}: {'stopped' if what == 'pause' else 'no write succeeded'} for {seconds:g} s")
    return 0


def _pause(pid: int, seconds: float) -> None:
    os.kill(pid, signal.SIGSTOP)
    try:
        time.sleep(seconds)
    finally:
        os.kill(pid, signal.SIGCONT)


def _no_writes(pid: int, seconds: float) -> None:
    """The kernel cuts every write to a file at no bytes: what a full disk does to this process alone."""
    before = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        time.sleep(seconds)
    finally:
        resource.prlimit(pid, resource.RLIMIT_FSIZE, before)
