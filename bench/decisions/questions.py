"""The fixed set: the reference sea on three hulls, the bundled voyages, folders of others."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

from bench.bundled import recorded
from bench.decisions.pond import in_the_pond
from bench.decisions.question import KnownCase, begun, kept
from bench.reference import SeaCase, simulate
from twin.cli import main as main_of_twin
from twin.commands.story import MONDAY, SHIP, TUESDAY
from twin.physics.effects import find
from twin.physics.ship import Ship, load
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.study.calibration.core_fit import calibrate
from twin.study.reference.sailed import Sailed
from twin.study.track.track import track
from twin.study.update.adding import fitted

EVERY = {"usv": 2}  # of ten samples a second; the others are kept at one
CALM = ("zigzag_20", "speed_changes", "turning_circle", "course_changes", "mixed")  # the last is held out
DURATION_S = {"usv": 900.0}
TWENTY_MIN = 1200.0
DAY = (("Wind", 0.5), ("Current", 0.5))  # an ordinary day
TANKER = (
    (),
    (("HeadingBias", 1.0),),
    (("Current", 1.0),),
    (("RudderWear", 1.0),),
    (("SteeringLag", 1.0),),
    (("IceLike", 1.0),),
    (("Wind", 1.0),),
    (("RudderBacklash", 1.0),),
    (("Sloshing", 1.0),),
    (*DAY, ("HullFouling", 1.0)),
    DAY,
)
OTHERS = (
    (),
    DAY,
    (*DAY, ("PropellerWear", 1.0)),
    (*DAY, ("HeadingBias", 1.0)),
    (("RudderOffset", 1.0),),
    (("VaryingCurrent", 1.0),),
    (("SensorDelay", 1.0),),
    (("HullFouling", 0.5),),
    (("PassingShip", 1.0),),
    (("TowForce", 1.0),),
    (*DAY, ("PropellerWear", 1.0), ("RudderOffset", 1.0)),
    (("Loading", 1.0),),
)


def known_cases(folder: Path, others: Path | None, esso: Path | None) -> Iterator[KnownCase]:
    tanker = load(SHIP)
    yield KnownCase(
        "bundled monday", {"hidden": {"HullFouling": 1.0}}, lambda: (tanker, [read_voyage(MONDAY)])
    )
    yield KnownCase(
        "bundled both",
        {"hidden": {"HullFouling": 1.0}},
        lambda: (tanker, [read_voyage(MONDAY), read_voyage(TUESDAY)]),
    )
    for i, hidden in enumerate(TANKER):
        yield _sea(folder, "kvlcc2", "mixed", hidden, 900 + i)
    yield _sea(folder, "kvlcc2", "straight", (), 950)
    for i, hidden in enumerate(OTHERS):
        for hull in ("container", "usv"):
            yield _sea(folder, hull, ("mixed", "zigzag_20", "course_changes")[i % 3], hidden, 1400 + i)
    yield _sea(folder, "container", "mixed", DAY, 1420, knows="Wind")
    yield _sea(folder, "container", "zigzag_20", (*DAY, ("RudderWear", 1.0)), 1421, knows="Wind")
    for case in sorted(others.iterdir()) if others else ():
        if (case / "truth.json").exists():
            truth = json.loads((case / "truth.json").read_text())
            yield KnownCase(f"others {case.name}", truth, lambda case=case: _other(folder, case))  # type: ignore[misc]
    yield from in_the_pond(folder, esso) if esso else ()


def _sea(
    folder: Path, hull: str, manoeuvre: str, hidden: tuple[tuple[str, float], ...], seed: int, knows: str = ""
) -> KnownCase:
    what = "+".join(f"{n}:{s:g}" for n, s in hidden) or "nothing"
    name = f"{hull} {what} {manoeuvre} {seed}" + (f" knows {knows}" if knows else "")

    def get() -> tuple[Ship, list[Voyage]]:
        case = SeaCase(hull, manoeuvre, hidden=hidden, seed=seed, duration_s=DURATION_S.get(hull, TWENTY_MIN))
        return ships(folder, hull, knows), [_voyage(case, folder)]

    return KnownCase(name, {"hidden": dict(hidden), "knows": knows, "manoeuvre": manoeuvre}, get)


def _voyage(case: SeaCase, folder: Path) -> Voyage:
    name = re.sub(r"[^A-Za-z0-9.]+", "_", f"{case.hull} {case.manoeuvre} {case.hidden} {case.seed}")
    columns = kept(folder / "voyages" / name, lambda: simulate([case])[0].columns)
    return recorded(name, columns, EVERY.get(str(case.hull), 10))


def ships(folder: Path, hull: str, knows: str = "") -> Ship:
    """The bundled tanker, or a hull calibrated on calm voyages; with an effect fitted on two voyages that had
    it."""
    if hull == "kvlcc2":
        return load(SHIP)

    def calm() -> Ship:
        cases = [
            SeaCase(hull, m, seed=1300 + i, duration_s=DURATION_S.get(hull, TWENTY_MIN))
            for i, m in enumerate(CALM)
        ]
        voyages = [_voyage(c, folder) for c in cases]
        start = load(hull)
        *fit, last = [Sailed(v, track(v, start), v.name) for v in voyages]
        return calibrate(fit, [(last.track, 0)], start).ship

    def knowing() -> Ship:
        base = ships(folder, hull)
        cases = [
            SeaCase(hull, m, hidden=((knows, 1.0),), seed=1320 + i, duration_s=TWENTY_MIN)
            for i, m in enumerate(CALM[:2])
        ]
        tracks = [track(_voyage(c, folder), base) for c in cases]
        return base.with_effects(*fitted(base, [find(knows)], tracks)[0].effects)

    return kept(folder / "ships" / f"{hull} {knows}".strip(), knowing if knows else calm)


LEAST_FULL = 0.2


def _other(folder: Path, case: Path) -> tuple[Ship, list[Voyage]]:
    """A ship of others from its particulars, calibrated on its references (the last is also what is held
    out)."""
    references = sorted(case.glob("reference_*.csv"))
    key = json.loads((case / "truth.json").read_text())["reference_set"]

    def make() -> Ship:
        out, start = (folder / "ships" / f"{key}.{kind}" for kind in ("toml", "start.toml"))
        given = json.loads((case / "ship.json").read_text())
        volume = given["length_pp_m"] * given["beam_m"] * given["draught_m"] * 1025.0
        # a catamaran fills less than `twin init` takes
        given["mass_kg"] = max(given["mass_kg"], LEAST_FULL * volume)
        begun(given.pop("name"), given, start)
        if main_of_twin(["calibrate", *map(str, references), "--ship", str(start), "-o", str(out)]):
            raise RuntimeError(f"{case}: calibrate failed")
        return load(out)

    return kept(folder / "ships" / key, make), [read_voyage(p) for p in sorted(case.glob("voyage_*.csv"))]
