"""python -m bench.boats.onboard ferry2 ferry2-calibrated.toml: what the loop on board learns of the loss of
each actuator's thrust, with nothing hidden and with the first of them worn by 18 %."""

import argparse
import tempfile
from pathlib import Path

from bench.reference.boats import CRAFT, BoatCase, BoatSea
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.physics.effects import find
from twin.physics.ship import load, save

WALL_S, HZ, SHOWN_S = 1.7e9, 10.0, 60.0


def learned(name: str, ship_file: str, seconds: float, worn: float) -> list[dict[str, float]]:
    """The losses that are published, once a minute; the ship file has each at none."""
    base = load(ship_file)
    own = [a.name for a in base.actuators if a.kind != "tunnel_thruster"]
    hidden = ((f"worn.{own[0]}", worn),) if worn else ()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "ship.toml"
        save(base.with_effects(*(find(f"ThrusterWear.{a}")(loss=0.0) for a in own)), path)
        loop = loop_of(Settings({"ship.file": str(path)}), Played([]), Outbox(Publisher(), "twin", "ship"))
    sea, rows = BoatSea(BoatCase(name, "mixed", hidden, 31), 1.0 / HZ), []
    for k in range(round(seconds * HZ)):
        t = k / HZ
        loop.ears.next = [  # type: ignore[attr-defined]
            Reading(c, x, WALL_S + t, t, "sea") for c, x in sea.readings().items() if x == x and c != "time_s"
        ]
        tick = loop.tick(Instant(k, t, WALL_S + t))
        sea.step()
        if tick.parameters and t % SHOWN_S < 1.0:
            rows.append({p.name: p.value for p in tick.parameters if p.name.startswith("ThrusterWear")})
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m bench.boats.onboard", description=__doc__)
    parser.add_argument("craft", choices=list(CRAFT))
    parser.add_argument("ship", metavar="SHIP.toml")
    parser.add_argument("--seconds", type=float, default=900.0)
    args = parser.parse_args()
    for worn in (0.0, 0.18):
        print(f"worn by {worn:g}:")
        for row in learned(args.craft, args.ship, args.seconds, worn):
            print("  " + ", ".join(f"{name.partition('.')[2]} {x:+.2f}" for name, x in row.items()))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
