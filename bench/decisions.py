"""A fixed set of voyages with a known truth, and what `twin diagnose` answers on each: `python -m
bench.decisions FOLDER`.

Ships are calibrated once and kept in FOLDER with the searches, so that a change of the decision alone is
asked again in seconds (`--decide`). Voyages: the reference sea on three hulls, the bundled ones, and folders
of others (`--others`: reference_*.csv, voyage_*.csv, ship.json with particulars, truth.json with
`expected_verdict`, `acceptable`), and a tanker's model in a pond (`--esso`)."""

import argparse
import json
import pickle
import re
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from bench.bundled import recorded
from bench.reference import Case, simulate
from twin.cli import main as main_of_twin
from twin.commands.story import MONDAY, SHIP, TUESDAY
from twin.physics.effects import find
from twin.physics.ship import Ship, load
from twin.recording.import_voyage import write_json
from twin.recording.read import read_voyage
from twin.recording.voyage import Voyage
from twin.study.calibration.calibrate import calibrate
from twin.study.diagnosis import diagnose as verb
from twin.study.diagnosis.consider import consider
from twin.study.diagnosis.decision import decide
from twin.study.diagnosis.verdict import weights
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
WEATHER = ("Wind", "WaveDrift", "Current", "VaryingCurrent", "ShallowWater", "Bank")
OUTSIDE = ("IceLike", "PassingShip", "RudderBacklash", "Sloshing", "Squall")


@dataclass(frozen=True)
class Asked:
    """One question: its name, what is truly there, and how ship and voyages are got."""

    name: str
    truth: dict[str, Any]
    get: Callable[[], tuple[Ship, list[Voyage]]]


def asked(folder: Path, others: Path | None, esso: Path | None) -> Iterator[Asked]:
    tanker = load(SHIP)
    yield Asked("bundled monday", {"hidden": {"HullFouling": 1.0}}, lambda: (tanker, [read_voyage(MONDAY)]))
    yield Asked(
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
            yield Asked(f"others {case.name}", truth, lambda case=case: _other(folder, case))  # type: ignore[misc]
    yield from _esso(folder, esso) if esso else ()


def _sea(
    folder: Path, hull: str, manoeuvre: str, hidden: tuple[tuple[str, float], ...], seed: int, knows: str = ""
) -> Asked:
    what = "+".join(f"{n}:{s:g}" for n, s in hidden) or "nothing"
    name = f"{hull} {what} {manoeuvre} {seed}" + (f" knows {knows}" if knows else "")

    def get() -> tuple[Ship, list[Voyage]]:
        case = Case(hull, manoeuvre, hidden=hidden, seed=seed, duration_s=DURATION_S.get(hull, TWENTY_MIN))
        return ships(folder, hull, knows), [_voyage(case, folder)]

    return Asked(name, {"hidden": dict(hidden), "knows": knows, "manoeuvre": manoeuvre}, get)


def _voyage(case: Case, folder: Path) -> Voyage:
    name = re.sub(r"[^A-Za-z0-9.]+", "_", f"{case.hull} {case.manoeuvre} {case.hidden} {case.seed}")
    columns = _kept(folder / "voyages" / name, lambda: simulate([case])[0].columns)
    return recorded(name, columns, EVERY.get(str(case.hull), 10))


def _kept(path: Path, make: Callable[[], Any]) -> Any:
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(pickle.dumps(make()))
    return pickle.loads(path.read_bytes())


def ships(folder: Path, hull: str, knows: str = "") -> Ship:
    """The bundled tanker, or a hull calibrated on calm voyages; with an effect fitted on two voyages that had
    it."""
    if hull == "kvlcc2":
        return load(SHIP)

    def calm() -> Ship:
        cases = [
            Case(hull, m, seed=1300 + i, duration_s=DURATION_S.get(hull, TWENTY_MIN))
            for i, m in enumerate(CALM)
        ]
        voyages = [_voyage(c, folder) for c in cases]
        start = load(hull)
        *fit, last = [Sailed(v, track(v, start), v.name) for v in voyages]
        return calibrate(fit, [(last.track, 0)], start).ship

    def knowing() -> Ship:
        base = ships(folder, hull)
        cases = [
            Case(hull, m, hidden=((knows, 1.0),), seed=1320 + i, duration_s=TWENTY_MIN)
            for i, m in enumerate(CALM[:2])
        ]
        tracks = [track(_voyage(c, folder), base) for c in cases]
        return base.with_effects(*fitted(base, [find(knows)], tracks)[0].effects)

    return _kept(folder / "ships" / f"{hull} {knows}".strip(), knowing if knows else calm)


ESSO = {  # the model of FRT-DS-ESSO, 1/108.33
    "length_pp_m": 3.0,
    "beam_m": 0.489,
    "draught_m": 0.201,
    "block_coefficient": 0.83,
    "x_g_m": 0.094,
    "service_speed_mps": 0.4,
    "shaft_speed_rpm": 840.0,
    "propeller_diameter_m": 0.084,
    "pitch_ratio": 0.715,
    "rudder_area_m2": 0.0102,
}
LEAST_FULL = 0.2
CALMEST = ("13_04", "13_14", "13_29", "14_08_51", "14_17")
WINDY = ("13_22", "13_42", "13_57", "14_10", "14_29", "14_39", "15_06", "15_21")


def _esso(folder: Path, runs: Path) -> Iterator[Asked]:
    """Runs of a tanker's model in an open pond with measured wind, which the model does not know, or does (as
    calibration found it)."""
    paths = {
        run: next(p for p in sorted(runs.glob("*.csv")) if run in p.name and "random" not in p.name)
        for run in (*CALMEST, *WINDY)
    }

    def ship() -> Ship:
        voyages = [_pond(paths[run]) for run in CALMEST]
        start = _begun("Esso Osaka", ESSO, folder / "ships" / "esso.start.toml")
        sailed = [Sailed(v, track(v, start), v.name) for v in voyages]
        return calibrate(sailed, [(sailed[-1].track, 0)], start).ship

    def without() -> Ship:
        whole = _kept(folder / "ships" / "esso", ship)
        return replace(whole, effects=tuple(e for e in whole.effects if type(e).__name__ != "Wind"))

    for run in WINDY:
        for name, which in (("", without), (" knows Wind", lambda: _kept(folder / "ships" / "esso", ship))):
            truth = {"hidden": {"Wind": 1.0}, "knows": "Wind" if name else ""}
            yield Asked(
                f"esso {run}{name}", truth, lambda run=run, which=which: (which(), [_pond(paths[run])])
            )  # type: ignore[misc]


def _pond(path: Path) -> Voyage:
    head = [name.split(" ")[0] for name in path.read_text().split("\n", 1)[0].split(",")]
    c = dict(zip(head, np.genfromtxt(path, delimiter=",", skip_header=1).T, strict=True))
    columns = {
        "north_m": c["x_position_mid"],
        "east_m": c["y_position_mid"],
        "heading_true_north_deg": np.degrees(c["psi_hat"]) % 360.0,
        "surge_velocity_mps": c["u_velo"],
        "sway_velocity_mps": c["vm_velo"],
        "yaw_rate_degps": np.degrees(c["r_angvelo"]),
        "rudder_angle_deg": np.degrees(c["delta_rudder"]),
        "propeller_rate_rpm": 60.0 * c["n_prop"],
        "true_wind_speed_mps": c["wind_velo_true"],
        "true_wind_direction_deg": np.degrees(c["wind_dir_true"]) % 360.0,
    }
    return Voyage(path.stem, c["t"], columns, {"source": "FRT-DS-ESSO"})


def _begun(name: str, given: dict[str, float], path: Path) -> Ship:
    """A first model from main particulars."""
    words = [w for k, v in given.items() for w in ("--" + k.replace("_", "-"), str(v))]
    if main_of_twin(["init", name, *words, "-o", str(path)]):
        raise RuntimeError(f"{path}: init failed")
    return load(path)


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
        _begun(given.pop("name"), given, start)
        if main_of_twin(["calibrate", *map(str, references), "--ship", str(start), "-o", str(out)]):
            raise RuntimeError(f"{case}: calibrate failed")
        return load(out)

    return _kept(folder / "ships" / key, make), [read_voyage(p) for p in sorted(case.glob("voyage_*.csv"))]


def right(truth: dict[str, Any], answer: dict[str, Any]) -> bool:
    """Whether an answer is what the truth allows: names what is there and nothing else, or says that it
    cannot tell what."""
    named = set(answer["missing"])
    if "hidden" not in truth:
        there = {e["effect"] for e in truth["effects"] if e["effect"] != "outside"}
        return (
            there <= named and named - there <= set(WEATHER)
            if there
            else answer["verdict"] in truth["expected_verdict"]
        )
    hidden = {n for n in truth["hidden"] if n != truth.get("knows")}
    if truth.get("manoeuvre") == "straight":
        return answer["verdict"] == "undecided"
    if hidden & set(OUTSIDE):
        return not named and answer["verdict"] in ("unknown", "undecided")
    wanted = hidden - set(WEATHER)
    if not wanted:
        return named <= hidden and (answer["verdict"] == "nothing_missing" or bool(named))
    return wanted <= named <= hidden


def kept_answer(folder: Path, question: Asked, tag: str, again: bool) -> dict[str, Any]:
    """The answer, with what the search found kept beside it for a decision that is asked again."""
    path = folder / tag / _file(question, "json")
    if path.exists() and not again:
        return json.loads(path.read_text())
    store = folder / "searched" / tag / _file(question, "pickle")
    search = verb.search
    wall, cpu = time.perf_counter(), time.process_time()
    ship, voyages = question.get()
    ready, work = time.perf_counter(), time.process_time()

    def keeping(case: Any, progress: Any = None) -> Any:
        out = search(case)
        store.parent.mkdir(parents=True, exist_ok=True)
        store.write_bytes(pickle.dumps((case, out)))
        return out

    verb.search = keeping
    try:
        answer = verb.diagnose(voyages, ship).result
    finally:
        verb.search = search
    path.parent.mkdir(parents=True, exist_ok=True)
    answer |= {
        "truth": question.truth,
        "seconds": time.perf_counter() - ready,
        "cpu_s": time.process_time() - work,
    }
    write_json(answer, str(path))
    print(
        f"{question.name}: made ready in {ready - wall:.0f} s ({work - cpu:.0f} s of processor)",
        file=sys.stderr,
        flush=True,
    )
    return answer


def decided(folder: Path, question: Asked, tag: str) -> dict[str, Any]:
    """The facts and the decision again, of what a search of this tag found."""
    case, (weighed, found, seen) = pickle.loads(
        (folder / "searched" / tag / _file(question, "pickle")).read_bytes()
    )
    facts = consider(case, weighed, found, seen, weights(case, weighed, found)).facts
    answer = decide(facts)
    return {
        "truth": question.truth,
        "verdict": answer.verdict,
        "reason": answer.reason,
        "missing": answer.missing,
        "facts": facts.told(),
    }


def _file(question: Asked, kind: str) -> str:
    return re.sub(r"[^A-Za-z0-9.]+", "_", question.name) + "." + kind


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--others", type=Path, metavar="DIR")
    parser.add_argument("--esso", type=Path, metavar="DIR", help="runs of FRT-DS-ESSO")
    parser.add_argument("--tag", default="now", help="where in FOLDER these answers are kept")
    parser.add_argument("--only", default="", help="questions whose names match")
    parser.add_argument("--before", default="old", help="with --decide: the tag of answers to write beside")
    parser.add_argument("--again", action="store_true")
    parser.add_argument(
        "--decide",
        metavar="FILE.json",
        type=Path,
        help="only decide again, from the searches of this tag; write all facts here",
    )
    args = parser.parse_args()
    rows = {}
    for question in asked(args.folder, args.others, args.esso):
        if re.search(args.only, question.name):
            if args.decide:
                if (args.folder / "searched" / args.tag / _file(question, "pickle")).exists():
                    rows[question.name] = row = decided(args.folder, question, args.tag)
                    before = args.folder / args.before / _file(question, "json")
                    if before.exists():
                        row["before"] = {
                            k: v
                            for k, v in json.loads(before.read_text()).items()
                            if k in ("verdict", "missing")
                        }
                    print(row["verdict"], row["missing"], row["reason"], question.name, flush=True)
                continue
            try:
                a = kept_answer(args.folder, question, args.tag, args.again)
            except Exception as error:
                print(f"{question.name}: {type(error).__name__}: {error}", flush=True)
                continue
            mark = "right" if right(question.truth, a) else "WRONG"
            print(f"{mark} {question.name}: {a['verdict']} {a['missing']} {a['cpu_s']:.0f} s", flush=True)
    if args.decide:
        write_json(rows, str(args.decide))
    return 0


if __name__ == "__main__":
    sys.exit(main())
