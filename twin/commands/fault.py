"""`twin fault`: makes a fault on purpose, in a copy of a log, between sensors and a running twin, or in its
process.

    twin fault rudder stuck --log voyage.mcap -o faulty.mcap       then: twin replay faulty.mcap
    twin fault heading off --listen tcp/127.0.0.1:7448
        sensors connect there, the twin hears them through it
    twin fault pause --pid PID --for 4                             SIGSTOP, SIGCONT
"""

import argparse
from math import inf, isfinite

from twin.cli import guarded
from twin.errors import UsageError
from twin.live import ending
from twin.live.injection.faulty import asked
from twin.live.injection.in_log import in_a_log
from twin.live.injection.inject import KINDS, InjectedFault
from twin.live.injection.of_process import OF_A_PROCESS, of_a_process
from twin.num import as_given


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
        of_a_process(args.what, args.pid, args.start, args.seconds)
        done = "stopped" if args.what == "pause" else "no write succeeded"
        print(f"process {args.pid}: {done} for {as_given(args.seconds)} s")
        return 0
    fault = asked(args.what, args.kind, args.by, args.start, args.seconds, args.seed)
    if args.log and args.output:
        changed, problems = in_a_log(args.log, args.output, args.what, fault)
        print(f"{args.output}: {changed} messages with {args.what} {fault.kind}")
        print("\n".join([*(f"note: {problem}" for problem in problems), f"next: twin replay {args.output}"]))
        return 0
    if args.log or not args.listen:
        raise UsageError(
            "say where: --log LOG.mcap -o OUT.mcap for a copy with the fault, or --listen PLACE "
            "for a live bus."
        )
    ending.ends_the_process(lambda: guarded(lambda: _on_the_bus(args, fault)))


def _on_the_bus(args: argparse.Namespace, fault: InjectedFault) -> int:
    from twin.live.injection.on_bus import proxy

    return proxy(
        args.what, fault, args.listen, args.connect, args.base, args.entity, duration_s=args.duration
    )
