"""`twin calibrate`: fits the core to reference voyages, and learns what a model of this kind still leaves unexplained."""

import argparse
import datetime
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from twin.physics.effect import Effect
from twin.physics.effects import catalogue
from twin.physics.model import Model
from twin.physics.ship import Ship, load, save

from .columns import Unknown, core_unknowns
from .doubts import doubts
from .fit import Fit, fit
from .import_voyage import write_json
from .innovations import Floor, innovate, linearise
from .jsonable import plain
from .nuisance import TEMPER, from_references, instruments, nuisance_unknowns, temper_of
from .openloop import HORIZONS_S, predict
from .rollout import rolled_out
from .sailed import Sailed, fed, read_all
from .structure import floor_beside, structural_floor
from .track import Track

SCHEMA_VERSION = 1
FITTED_BY = ("steps", "paths")  # one step ahead through a filter, or several lengths ahead without (rollout.py)
BETTER = 0.05  # share by which paths must be better than steps: a diagnosis judges by steps
LAST = "the last third of the voyages; the ship that is written was then fitted to all"
UNEXCITED = 0.1  # a derivative of whose prior variance the voyages took away less than this keeps its prior
EPILOG = """Reference voyages are ones on which nothing was wrong and the weather was calm: zigzags, circles, speed changes. Without --held-out
the last third of the voyages (or of a single voyage) is held back to measure the error. The standard errors, and the structural
error that remains, are stored in the ship file: they keep an imperfect model from being called a missing effect.
Exit code 4: a voyage cannot be used; 5: the ship file is not valid.
"""


@dataclass(frozen=True)
class Calibrated:
    """The calibrated ship, and the numbers of how it came about."""

    ship: Ship
    result: dict[str, Any]


def calibrate(
    fitted: Sequence[Sailed], held_out: Sequence[tuple[Track, int]], ship: Ship, progress: Callable[[str], None] = lambda text: None,
    by: str | None = None,
) -> Calibrated:  # fmt: skip
    """Fit the core to the tracks; `held_out`: tracks with the first grid step that was not used for the fit. `by`: one of FITTED_BY;
    None: the one that predicts what was held out better."""
    model, known = Model.of(ship), catalogue()
    unknowns = tuple(_prior(u, ship) for u in (*core_unknowns(model), *instruments(model, known)))
    tracks = [s.track for s in fitted]
    progress("fitting the core")
    found = fit(tracks, model, unknowns, known, Floor(), temper=TEMPER, rounds=4)
    progress("finding the structural floor")
    floor = structural_floor(found.lines, unknowns)
    temper = temper_of(found.normal, unknowns)
    progress("fitting again above the floor")
    found = fit(tracks, found.model, unknowns, known, floor, temper=temper, rounds=4)
    ships = {"steps": _calibrated(ship, found, floor, temper, [s.provenance() for s in fitted])}
    excited = [u for u, g in zip(unknowns, found.gained, strict=True) if u.owner == "core" and g >= UNEXCITED]
    if by != "steps" and excited:
        progress("fitting to where she went")
        ships["paths"] = _led(ships["steps"], rolled_out(tracks, Model.of(ships["steps"]), excited, known).ship)
    errors = {name: _errors(Model.of(s), held_out) for name, s in ships.items()}
    by = by if by in ships else min(ships, key=lambda name: _size(errors[name]) - BETTER * (name == "steps"))
    after, behind, before = ships[by], errors[by], _errors(model, held_out)
    progress("learning what is usual on this ship")
    usual = _usual(after, tracks, known, floor)
    after.notes["structural"].update(usual)  # type: ignore[attr-defined]
    regimes = _by_regime(Model.of(after), held_out)
    after.notes["structural"]["held_out"] = behind  # type: ignore[index]
    after.notes["structural"]["by_regime"] = regimes  # type: ignore[index]
    unexcited = [u.name for u, g in zip(unknowns, found.gained, strict=True) if u.owner == "core" and g < UNEXCITED]
    result = {
        "schema_version": SCHEMA_VERSION,
        "ship": ship.name,
        "derivatives": [
            {"name": u.name, "before": float(getattr(ship.derivatives, u.name)), "value": float(getattr(after.derivatives, u.name)),
             "sd": float(s), "excited": bool(g >= UNEXCITED)}
            for u, s, g in zip(unknowns, found.sd, found.gained, strict=True) if u.owner == "core"
        ],
        "unexcited": unexcited,
        "fitted_by": by,
        "usual": _told_usual(after, usual), "between_voyages": usual["between_voyages"],
        "floor": asdict(floor), "temper": temper, "by_regime": regimes,
        "held_out": [b | {"before_m": a["position_m"], "before_deg": a["heading_deg"]} for a, b in zip(before, behind, strict=True)],
    }  # fmt: skip
    return Calibrated(after, plain(result))


def _prior(unknown: Unknown, ship: Ship) -> Unknown:
    """A derivative that was calibrated before keeps the prior that it had then, so that no voyage counts twice."""
    entry = ship.notes.get("derivatives", {}).get(unknown.name, {}) if unknown.owner == "core" else {}
    centre = entry.get("prior_value") if isinstance(entry, dict) else None
    return unknown if centre is None else replace(unknown, centre=float(centre))


def _calibrated(ship: Ship, found: Fit, floor: Floor, temper: float, voyages: list[dict[str, Any]]) -> Ship:
    """The ship with the fitted derivatives, their standard errors and priors, and what remains."""
    values = {
        u.name: float(v) if g >= UNEXCITED else u.centre
        for u, v, g in zip(found.unknowns, found.value, found.gained, strict=True)
        if u.owner == "core"
    }
    today = datetime.date.today().isoformat()
    after = ship.with_derivatives(**values)
    notes = dict(ship.notes)
    notes["derivatives"] = dict(notes.get("derivatives", {})) | {
        u.name: {"value": values[u.name], "unit": u.unit, "sd": float(s), "prior_value": u.centre, "prior_sd": u.sd,
                 "source": f"calibrated {today}" if g >= UNEXCITED else "prior kept: the reference voyages do not excite it"}
        for u, s, g in zip(found.unknowns, found.sd, found.gained, strict=True) if u.owner == "core"
    }  # fmt: skip
    notes["structural"] = {
        "floor": plain(asdict(floor)), "temper": temper, "date": today, "voyages": voyages,
    }  # fmt: skip
    return replace(after, notes=notes)


def _led(ship: Ship, core: Ship) -> Ship:
    """The calibrated ship with the derivatives of another core."""
    values = {name: float(getattr(core.derivatives, name)) for name in ship.notes["derivatives"] if hasattr(core.derivatives, name)}
    notes = {name: entry | {"value": values[name]} if name in values else entry for name, entry in ship.notes["derivatives"].items()}
    return replace(ship.with_derivatives(**values), notes=dict(ship.notes) | {"derivatives": notes, "structural": dict(ship.notes["structural"])})


def _size(errors: Sequence[dict[str, float]]) -> float:
    """Held-out errors in place and heading over all horizons, as one number to compare: their mean logarithm."""
    numbers = [e[name] for e in errors if e["windows"] for name in ("position_m", "heading_deg")]
    return float(np.log(np.maximum(numbers, 1e-9)).mean()) if numbers else 0.0


def _usual(ship: Ship, tracks: Sequence[Track], known: dict[str, type[Effect]], floor: Floor) -> dict[str, Any]:
    """What is known after calibration of the core, of what it leaves out, of every lasting effect and of the instruments: offsets from the
    ship file and their covariance, in the unknowns' own units; and the floor `beside` all that. A diagnosis starts from here."""
    model = Model.of(ship)
    unknowns = nuisance_unknowns(model, known)
    lines = [linearise(t, fed(model, t)[0], unknowns, known) for t in tracks]
    beside = floor_beside(lines, unknowns, floor)
    temper = temper_of(innovate(lines, [beside])[0], unknowns)
    nuisance, between = from_references(lines, unknowns, beside, temper, np.array([_prior(u, ship).centre for u in unknowns]))
    sd = np.array([u.sd for u in unknowns])
    covariance = np.linalg.inv(nuisance.information)
    return {
        "labels": [u.label for u in unknowns],
        "offset": [float(v) for v in sd * (covariance @ nuisance.pull)],
        "covariance": [[float(c) for c in row] for row in covariance * np.outer(sd, sd)],
        "between_voyages": between,
        "beside": plain(asdict(beside)),
        "temper_beside": temper,
    }


def _told_usual(ship: Ship, usual: dict[str, Any]) -> list[dict[str, Any]]:
    """What this ship clearly shows of lasting effects: not wrong, but part of her. What no ship can show (a rudder ahead of its order)
    stands in for something else, and is kept in mind without being told."""
    can = {u.label: (u.lo - u.centre, u.hi - u.centre) for u in nuisance_unknowns(Model.of(ship), catalogue())}
    sd = np.sqrt(np.diag(np.array(usual["covariance"])))
    return [
        {"name": label, "value": float(v), "sd": float(s)}
        for label, v, s in zip(usual["labels"], usual["offset"], sd, strict=True)
        if not label.startswith(("core.", "form.")) and abs(v) > 4.0 * s and can[label][0] <= v <= can[label][1]
    ]


def _errors(model: Model, held_out: Sequence[tuple[Track, int]]) -> list[dict[str, float]]:
    """Mean open-loop errors by horizon on what was held out."""
    out = []
    for horizon in HORIZONS_S:
        position, heading = [], []
        for track, first in held_out:
            windows = predict(track, fed(model, track)[0], [horizon], leads=1)
            k = windows.at(horizon)
            ok = windows.valid[k] & (windows.start >= first)
            errors = windows.errors()
            position.append(errors["position"][k][ok])
            heading.append(errors["heading"][k][ok])
        some = sum(p.size for p in position)
        mean = [float(np.concatenate(e).mean()) if some else float("nan") for e in (position, heading)]
        out.append({"horizon_s": float(horizon), "windows": some, "position_m": mean[0], "heading_deg": float(np.degrees(mean[1]))})
    return out


def _by_regime(model: Model, held_out: Sequence[tuple[Track, int]]) -> list[dict[str, Any]]:
    """Position error after the middle horizon while sailing straight, turning, and turning hard."""
    horizon, time = HORIZONS_S[1], float(model.ship.scale("time"))
    pairs = []
    for track, first in held_out:
        windows = predict(track, fed(model, track)[0], [horizon], leads=1)
        k = windows.at(horizon)
        ok = windows.valid[k] & (windows.start >= first)
        pairs.append(np.column_stack([np.abs(track.state[windows.start, 5]) * time, windows.errors()["position"][k]])[ok])
    all_ = np.concatenate(pairs) if pairs else np.empty((0, 2))
    bands = (("straight", 0.0, 0.1), ("turning", 0.1, 0.4), ("turning hard", 0.4, np.inf))
    out = []
    for name, lo, hi in bands:
        e = all_[(all_[:, 0] >= lo) & (all_[:, 0] < hi), 1]
        if e.size:
            out.append({"regime": name, "horizon_s": float(horizon), "windows": int(e.size), "position_m": float(e.mean())})
    return out


def _split(fitted: list[Sailed], held_out: list[Sailed]) -> tuple[list[Sailed], list[tuple[Track, int]], str]:
    """What is fitted, what is held out, and how to say so."""
    if held_out:
        return fitted, [(s.track, 0) for s in held_out], "the voyages given with --held-out"
    if len(fitted) > 2:
        keep = len(fitted) - max(1, len(fitted) // 3)
        return fitted[:keep], [(s.track, 0) for s in fitted[keep:]], LAST
    parts, rest = [], []
    for s in fitted:
        cut = int(0.7 * len(s.track))
        parts.append(replace(s, track=s.track.part(0, cut)))
        rest.append((s.track, cut))
    return parts, rest, "the last 30 % of each voyage"


def _with_all(measured: Calibrated, final: Calibrated) -> Calibrated:
    """The ship that every voyage was used for, with the errors as they were measured before the last ones were."""
    for key in ("held_out", "by_regime"):
        final.result[key] = measured.result[key]
        final.ship.notes["structural"][key] = measured.ship.notes["structural"][key]
    return final


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = f"{parser.epilog or ''}\n\n{EPILOG}"
    parser.add_argument("voyages", metavar="VOYAGE", nargs="+", help="reference voyages: calm, nothing wrong, manoeuvring")
    parser.add_argument("--ship", metavar="SHIP.toml", required=True, help="the ship file to start from, or a bundled ship's name")
    parser.add_argument("-o", "--output", metavar="SHIP2.toml", required=True, help="the calibrated ship file")
    parser.add_argument("--held-out", metavar="VOYAGE", nargs="+", default=[], help="voyages on which the error is measured")
    parser.add_argument("--json", metavar="FILE", help="the result as JSON ('-': standard output)")


def run(args: argparse.Namespace) -> int:
    ship = load(args.ship)
    fitted, held_out, words = _split(read_all(args.voyages, ship), read_all(args.held_out, ship))

    def tell(text: str) -> None:
        print(f"{text} ...", file=sys.stderr)

    done = calibrate(fitted, held_out, ship, tell)
    if words == LAST:
        tell("once more, with every voyage")
        done = _with_all(done, calibrate(read_all(args.voyages, ship), held_out, ship, tell, done.result["fitted_by"]))
    save(done.ship, args.output)
    r = done.result
    found = doubts(r["derivatives"], r["held_out"], r["floor"]["share"], r["usual"], r["between_voyages"])
    result = r | {"held_out_is": words, "output": str(args.output), "doubts": found}
    if args.json:
        write_json(result, args.json)
    page = sys.stderr if args.json == "-" else sys.stdout
    print("\n".join(told(result)), file=page)
    print(f"\nwrote {args.output}\nnext: twin compare VOYAGE.mcap --ship {args.output} --report compare.html", file=page)
    return 0


def told(result: dict[str, Any]) -> list[str]:
    """Lines for the terminal: the error first."""
    lines = [f"{result['ship']}: open-loop error on what was not used for the fit ({result['held_out_is']})"]
    for e in result["held_out"]:
        if e["position_m"] is not None:
            lines.append(
                f"  {e['horizon_s']:>4.0f} s   {e['before_m']:>8.3g} m -> {e['position_m']:<8.3g} m    "
                f"{e['before_deg']:>7.3g} deg -> {e['heading_deg']:<7.3g} deg   ({e['windows']} windows)"
            )
    lines += [
        f"  after {r['horizon_s']:.0f} s while {r['regime']}: {r['position_m']:.3g} m ({r['windows']} windows)" for r in result["by_regime"]
    ]
    lines.append("  fitted to " + ("where she went, three lengths ahead" if result["fitted_by"] == "paths" else "each next reading"))
    share = ", ".join(f"{100 * s:.2g} %" for s in result["floor"]["share"])
    lines += ["", f"what remains unexplained of the forces at work, in surge, sway, yaw: {share}"]
    lines += [f"usual on this ship: {i['name']} {i['value']:.3g} +- {i['sd']:.1g} (kept in mind by diagnose)" for i in result["usual"]]
    lines += ["", f"{'derivative':<10}{'before':>11}{'now':>11}{'+-':>9}"]
    lines += [f"{d['name']:<10}{d['before']:>11.4g}{d['value']:>11.4g}{d['sd']:>9.2g}" for d in result["derivatives"] if d["excited"]]
    if result["unexcited"]:
        lines.append(f"not excited by these voyages, prior kept: {', '.join(result['unexcited'])}")
    return lines + [f"careful: {text}" for text in result["doubts"]]
