"""`twin fault`: makes a fault on purpose, in a copy of a log, on a live bus, or in a process.

twin fault heading off --listen tcp/127.0.0.1:7448             sensors connect there, the twin hears them
"""

import argparse
import shlex
from math import inf

from twin.cli import guarded
from twin.commands import arguments
from twin.errors import UsageError
from twin.live import ending
from twin.live.injection.faulty import fault_of_words
from twin.live.injection.in_log import in_a_log
from twin.live.injection.inject import KINDS, check_times, kinds_in_words
from twin.live.injection.of_process import OF_A_PROCESS, of_a_process
from twin.num import as_given

BUS = "tcp/127.0.0.1:7447"
WHAT = "a channel (rudder, heading, position, shaft, ... or its full name), bus, clock, pause, disk"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.description = f"{parser.description}\n\n{kinds_in_words()}"
    add = parser.add_argument
    add("what", metavar="WHAT", help=WHAT)
    add("kind", nargs="?", metavar="KIND", help=f"for a channel: {', '.join(KINDS)}")
    add("--by", type=float, metavar="X", help="how much, how many, how long or how often, by kind")
    arguments.seconds(parser, "--from", "start", 0.0, "when it begins, from the start (default: 0)")
    arguments.seconds(parser, "--for", "seconds", inf, "how long it lasts (default: to the end)")
    add("--seed", type=int, default=1, help="of what is random (default: 1)")
    add("--log", metavar="LOG.mcap", help="a log or a voyage to copy with the fault in it")
    arguments.output(parser, "OUT.mcap", "where the copy goes", required=False)
    add("--listen", metavar="PLACE", help="live: where the sensors connect to, such as tcp/127.0.0.1:7448")
    add("--connect", metavar="PLACE", default=BUS, help=f"live: where the twin listens (default: {BUS})")
    add("--base", default="twin", help="first part of every key (default: twin)")
    add("--entity", default="ship", help="the ship's name in every key (default: ship)")
    arguments.seconds(parser, "--duration", "duration", inf, "live: stop by itself after so many seconds")
    add("--pid", type=int, metavar="PID", help="for pause and disk: the twin's process")


def run(args: argparse.Namespace) -> int:
    check_times(args.start, args.seconds)
    if args.what in OF_A_PROCESS:
        of_a_process(args.what, args.pid, args.start, args.seconds)
        print(f"process {args.pid}: {OF_A_PROCESS[args.what]} for {as_given(args.seconds)} s")
        return 0
    fault = fault_of_words(args.what, args.kind, args.by, args.start, args.seconds, args.seed)
    if args.log and args.output:
        changed, problems = in_a_log(args.log, args.output, args.what, fault)
        said = [f"{args.output}: {changed} messages with {args.what} {fault.kind}", *problems]
        print("\n".join([*said, f"next: {shlex.join(['twin', 'replay', args.output])}"]))
        return 0
    if args.log or not args.listen:
        raise UsageError("say where: --log LOG.mcap -o OUT.mcap for a copy, --listen PLACE for a live bus.")
    from twin.live.injection.on_bus import proxy  # loads Zenoh

    place, lasts = (args.listen, args.connect, args.base, args.entity), args.duration
    ending.ends_the_process(lambda: guarded(lambda: proxy(args.what, fault, *place, duration_s=lasts)))
