"""The voyages that come with the twin, for `twin demo` and the tutorial: `python -m bench.bundled` makes them
again.

A tanker is calibrated on calm reference voyages of the reference sea; then something happens to it that
nobody tells the twin. Two voyages are kept at 1 Hz, one to find it on and one to prove it on."""

import sys
from pathlib import Path

import numpy as np

import twin
from bench.reference import SeaCase, simulate
from twin.physics.ship import load, save
from twin.recording.voyage import Voyage
from twin.recording.write import write_voyage
from twin.study.calibration.core_fit import calibrate
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track

FOLDER = Path(twin.__file__).parent / "voyages"
REFERENCES = ("zigzag_20", "turning_circle", "speed_changes", "course_changes", "zigzag_10", "mixed")
HIDDEN = (("HullFouling", 1.0),)
KEPT = {"monday": ("mixed", 71), "tuesday": ("course_changes", 72)}


def recorded(name: str, columns: dict[str, np.ndarray], every: int = 1) -> Voyage:
    """A recording of the reference sea as a voyage, every so many samples."""
    columns = {k: v[::every] for k, v in columns.items()}
    return Voyage(name, columns.pop("time_s"), columns, {"source": "reference sea, python -m bench.bundled"})


def main() -> int:
    cases = [SeaCase("kvlcc2", m, seed=50 + i) for i, m in enumerate(REFERENCES)]
    cases += [SeaCase("kvlcc2", m, seed=seed, hidden=HIDDEN) for m, seed in KEPT.values()]
    sailed = simulate(cases)
    ship = load("kvlcc2")
    calm = [recorded(f"calm-{c.manoeuvre}", r.columns) for c, r in zip(cases, sailed, strict=False)][
        : len(REFERENCES)
    ]
    references = [Sailed(v, track(v, ship), "") for v in calm]
    done = calibrate(references, [(references[-1].track, 0)], ship, lambda text: print(text, file=sys.stderr))
    FOLDER.mkdir(exist_ok=True)
    save(done.ship, FOLDER / "tanker.toml")
    for name, recording in zip(KEPT, sailed[len(REFERENCES) :], strict=True):
        write_voyage(recorded(name, recording.columns, every=10), FOLDER / f"{name}.mcap")
        print(FOLDER / f"{name}.mcap")
    return 0


if __name__ == "__main__":
    sys.exit(main())
