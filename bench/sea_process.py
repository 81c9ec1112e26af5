"""The reference sea as a process: a ship that sails in real time and whose instruments speak Keelson.

twin-bench sea --hull usv --manoeuvre zigzag_20 --connect tcp/127.0.0.1:7447
twin-bench sea --hull ferry4 --hidden worn.aft_port:0.18 --connect tcp/127.0.0.1:7447
"""

import argparse
import math
import os
import signal
import sys
import time
import traceback
from dataclasses import replace
from pathlib import Path

import zenoh

from bench.reference import HULLS, WEATHERS, Sea, SeaCase, simulate
from bench.reference.boats import CRAFT, BoatCase, BoatSea, builders_sheet, sail
from bench.reference.boats.actuator_faults import FAULT_SIZES, hidden_in
from bench.reference.boats.boat_sea import write_csv
from bench.reference.boats.helmsman import PLANS
from bench.reference.trial_legs import MANOEUVRES
from twin import whole
from twin.cli import guarded
from twin.errors import SettingsError, UsageError, did_you_mean
from twin.live.keelson.messages import encode_fix, encode_float, wrap
from twin.live.keelson.topics import INPUTS, OWN_SOURCE, key
from twin.live.keelson.zenoh_config import BusSettings, configuration
from twin.live.signals import geodesy

SOURCE = "sea"
LISTENER_S = 30.0  # the longest wait for a twin that listens


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--connect", metavar="ENDPOINT", help="where the twin listens: tcp/127.0.0.1:7447")
    parser.add_argument("--listen", default="", metavar="ENDPOINT", help="or where the sea listens")
    parser.add_argument("--base", default="twin", help="first part of the keys (default: twin)")
    parser.add_argument("--entity", default="ship", help="the ship's name in the keys (default: ship)")
    parser.add_argument(
        "--hull",
        default="usv",
        help=f"one of {', '.join(HULLS)} (default: usv, 2 m long), or with several actuators "
        f"{', '.join(CRAFT)}",
    )
    parser.add_argument("--manoeuvre", default="mixed", help="what the helmsman does (default: mixed)")
    parser.add_argument(
        "--sheet",
        metavar="FILE.toml",
        help="write what a builder's sheet says of the actuators of this hull there, and stop",
    )
    parser.add_argument("--weather", default="TS-01", help=f"one of {', '.join(WEATHERS)} (default: TS-01)")
    parser.add_argument(
        "--hidden",
        metavar="EFFECT",
        action="append",
        default=[],
        help="what happens to it that nobody tells (repeat): HullFouling, ...; of a hull with several "
        f"actuators WHAT.ACTUATOR or WHAT.ACTUATOR:SIZE, WHAT one of {', '.join(FAULT_SIZES)}",
    )
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--hz", type=float, default=10.0, help="how often the sea moves on (default: 10)")
    parser.add_argument(
        "--duration", type=float, default=math.inf, metavar="S", help="how long (default: until stopped)"
    )
    parser.add_argument(
        "--after", type=float, default=0.0, metavar="S", help="let it sail so long before anybody hears it"
    )
    parser.add_argument("--csv", metavar="FILE", help="write the voyage there at once, and speak to nobody")
    parser.add_argument(
        "--latitude-deg", type=float, default=57.62, help="of the chart's origin (default: off Vinga)"
    )
    parser.add_argument("--longitude-deg", type=float, default=11.58)


def run(args: argparse.Namespace) -> int:
    if args.sheet:
        return _sheet(args)
    if args.csv:
        return _write(args)
    sea = _boat(args) if args.hull in CRAFT else Sea(_case(args), 1.0 / args.hz)
    for _ in range(round(args.after * args.hz)):
        sea.step()
    signal.signal(signal.SIGTERM, lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    place = BusSettings(args.base, args.entity, args.listen, (args.connect,) if args.connect else ())
    session = zenoh.open(configuration(place))
    try:
        voice = Voice(session, args)
        print("under way", flush=True)
        voice.wait_for_twin()
        _sail(sea, voice, args)
    except KeyboardInterrupt:
        pass
    finally:
        session.close()
    return 0


class Voice:
    """One publisher for each subject the ship's instruments speak on."""

    def __init__(self, session: zenoh.Session, args: argparse.Namespace):
        self.datum = geodesy.datum(args.latitude_deg, args.longitude_deg)
        self.scalars, self.fix = {}, None
        tick = key(args.base, args.entity, "twin_tick", OWN_SOURCE)
        self.twin = session.declare_subscriber(tick, zenoh.handlers.RingChannel(1))
        for topic in INPUTS:
            publisher = session.declare_publisher(key(args.base, args.entity, topic.subject, SOURCE))
            if topic.subject == "location_fix":
                self.fix = publisher
            elif topic.factor == 1.0:
                self.scalars[topic.channels[0]] = publisher
        for drive in CRAFT[args.hull].drives if args.hull in CRAFT else ():
            for last in drive.records:
                place = key(args.base, args.entity, f"actuator_{last}", f"{drive.name}/{SOURCE}")
                self.scalars[f"{drive.name}.{last}"] = session.declare_publisher(place)

    def wait_for_twin(self) -> None:
        """Until a twin ticks: slow instruments speak once a minute, their first word must not be lost."""
        until = time.monotonic() + LISTENER_S
        while self.twin.try_recv() is None and time.monotonic() < until:
            time.sleep(0.02)

    def say(self, row: dict[str, float], wall_ns: int) -> int:
        """Publish what has a new sample, stamped now; how many messages that was."""
        said = 0
        for channel, publisher in self.scalars.items():
            value = row.get(channel, math.nan)
            if value == value:
                publisher.put(wrap(encode_float(value, wall_ns), wall_ns))
                said += 1
        if row["north_m"] == row["north_m"]:
            place = geodesy.from_chart(self.datum, row["north_m"], row["east_m"])
            self.fix.put(wrap(encode_fix(*place, wall_ns), wall_ns))
            said += 1
        return said


def _sail(sea: Sea, voice: Voice, args: argparse.Namespace) -> None:
    """In real time by absolute deadlines; ends when the process that started it is gone."""
    start, parent, tick = time.monotonic(), os.getppid(), 0
    while tick / args.hz < args.duration and os.getppid() == parent:
        voice.say(sea.readings(), time.time_ns())
        sea.step()
        tick += 1
        time.sleep(max(0.0, start + tick / args.hz - time.monotonic()))


def _write(args: argparse.Namespace) -> int:
    """The voyage as a file of measurements, as fast as it can be sailed."""
    if not math.isfinite(args.duration):
        raise UsageError("--csv needs an end: add --duration with the seconds to sail.")
    path = Path(args.csv)
    if not path.parent.is_dir():
        raise UsageError(f"--csv {path}: there is no folder {path.parent}.")
    aside = path.with_name(f".{path.name}.part")
    if args.hull in CRAFT:
        write_csv(sail(_boat_case(args), args.duration, 1.0 / args.hz), aside)
    else:
        (voyage,) = simulate([replace(_case(args), duration_s=args.duration)], 1.0 / args.hz)
        voyage.write_csv(aside)
    aside.replace(path)
    print(
        f"{path}: {args.duration:g} s of {args.hull}. Next: twin import {path} -o {path.with_suffix('.mcap')}"
    )
    return 0


def _sheet(args: argparse.Namespace) -> int:
    """The tables of actuators that `twin init` takes."""
    if args.hull not in CRAFT:
        raise UsageError(f"--sheet is for a hull with several actuators: {', '.join(CRAFT)}.")
    whole.write(args.sheet, builders_sheet.text(args.hull), "--sheet")
    print(builders_sheet.command(args.hull, args.sheet))
    return 0


def _boat(args: argparse.Namespace) -> BoatSea:
    return BoatSea(_boat_case(args), 1.0 / args.hz)


def _boat_case(args: argparse.Namespace) -> BoatCase:
    """Wind and current of the weather; these boats feel no waves."""
    for what, known in (("manoeuvre", PLANS), ("weather", WEATHERS)):
        value = getattr(args, what)
        if value not in known:
            raise SettingsError(f"--{what} {value}: a {args.hull} has none.{did_you_mean(value, known)}")
    hidden, weather = tuple(map(_sized, args.hidden)), WEATHERS[args.weather]
    to = math.radians(weather.current_to_deg)
    case = BoatCase(
        args.hull,
        args.manoeuvre,
        hidden,
        args.seed,
        (weather.wind_mps, weather.wind_from_deg),
        (weather.current_mps * math.cos(to), weather.current_mps * math.sin(to)),
    )
    try:
        hidden_in(CRAFT[args.hull], hidden)
    except ValueError as error:
        raise SettingsError(f"--hidden {error}") from None
    return case


def _sized(text: str) -> tuple[str, float]:
    """`worn.port:0.18`, or without a size the usual one."""
    name, _, size = text.partition(":")
    try:
        return name, float(size) if size else FAULT_SIZES.get(name.partition(".")[0], 1.0)
    except ValueError:
        raise UsageError(f"--hidden {text}: {size!r} is no number.") from None


def _case(args: argparse.Namespace) -> SeaCase:
    for what, known in (("hull", [*HULLS, *CRAFT]), ("manoeuvre", MANOEUVRES), ("weather", WEATHERS)):
        value = getattr(args, what)
        if value not in known:
            raise SettingsError(f"--{what} {value}: the reference sea has none.{did_you_mean(value, known)}")
    hidden = tuple((name, 1.0) for name in args.hidden)
    return SeaCase(args.hull, args.manoeuvre, args.weather, hidden, seed=args.seed, duration_s=None)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    add_arguments(parser)
    return run(parser.parse_args())


if __name__ == "__main__":
    code = 1
    try:
        code = guarded(main)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)  # an open session must never hold up the end
