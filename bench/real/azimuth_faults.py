"""Faults of one actuator put into the record of a real voyage: what a diagnosis says of each.

A propeller that gives `share` of its thrust was recorded at its turns, so its record is raised by
1/sqrt(share)
over what its thrust is of; an azimuth that stands off by `degrees` was recorded that much the other way.

    python -m bench.real.azimuth_faults VOYAGE.mcap --ship CALIBRATED.toml --actuator aft_port
"""

import argparse
import json
from collections.abc import Iterator
from dataclasses import replace

import twin
from twin.physics.ship import load
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage

DEGREES, SHARE = 6.0, 0.8


def planted(voyage: Voyage, actuator: str) -> Iterator[tuple[str, str, Voyage]]:
    """(what is put in, which effect that is, the voyage with it); first the voyage as it is."""

    def with_column(name: str, factor: float, offset: float) -> Voyage:
        return replace(voyage, columns=dict(voyage.columns) | {name: factor * voyage[name] + offset})

    yield "nothing", "", voyage
    yield (
        f"{actuator} stands {DEGREES:g} deg from its feedback",
        f"AngleOffset.{actuator}",
        with_column(f"{actuator}.angle_deg", 1.0, -DEGREES),
    )
    yield (
        f"{actuator} gives {SHARE:g} of its thrust",
        f"ThrusterWear.{actuator}",
        with_column(f"{actuator}.rate_rpm", SHARE**-0.5, 0.0),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("voyage")
    parser.add_argument("--ship", required=True)
    parser.add_argument("--actuator", required=True)
    args = parser.parse_args()
    ship = load(args.ship)
    for words, wanted, voyage in planted(read_voyage(args.voyage), args.actuator):
        found = twin.diagnose(ship, voyage)
        row = {"put in": words, "wanted": wanted, "verdict": found.verdict, "named": found.effects}
        print(json.dumps(row | {"reason": found.reason, "sentence": found.sentence}), flush=True)


if __name__ == "__main__":
    main()
