"""A ship for its form: particulars with units and sources, and the model's sea trials beside IMO's limits."""

import shlex
from collections.abc import Mapping
from dataclasses import fields
from math import isfinite
from typing import Any

import numpy as np

from twin.api.simulation import simulate
from twin.errors import SettingsError
from twin.num import as_given, readable
from twin.physics.ship import Derivatives, Ship
from twin.recording.jsonable import plain
from twin.recording.read import read_voyage
from twin.study.first_model.first_estimate import OPTIONS, REQUIRED, first_model
from twin.study.first_model.first_trial import IMO, sea_trial
from twin.study.first_model.first_trial import doubts as careful
from twin.study.update.ladder import ladder

UNITS = ("kgm2", "kg-m3", "mps", "rpm", "m2", "kg", "m")  # that the name of an option ends in
SHOWN = {"kgm2": "kg m2", "kg-m3": "kg/m3", "mps": "m/s", "rpm": "1/min"}
WORDS = {"x-g": "centre of gravity ahead of midship", "rho": "density of the water", "length-pp": "length pp"}
HELD_OVER = 0.6  # of the largest rudder angle: a rudder held over
LONGEST_S = 3600.0


def form() -> list[dict[str, Any]]:
    """The fields of the form: option of `twin init`, unit, bounds, whether it must be there."""
    out = []
    for option, doc, low, high in OPTIONS:
        unit = next((u for u in UNITS if option.endswith(f"-{u}")), "")
        name = option.removesuffix(f"-{unit}") if unit else option
        out.append(
            {
                "option": option,
                "name": WORDS.get(name, name.replace("-", " ")),
                "unit": SHOWN.get(unit, unit),
                "doc": doc,
                "low": low,
                "high": high,
                "required": option in REQUIRED,
            }
        )
    return out


def given(values: Any) -> dict[str, float | None]:
    """What was filled in, every other option None; SettingsError for what is no number."""
    if not isinstance(values, Mapping):
        raise SettingsError("the form's values must be named.")
    out: dict[str, float | None] = {option: None for option, *_ in OPTIONS}
    for name, value in values.items():
        if name not in out:
            raise SettingsError(f"--{str(name)[:40]}: is no option of twin init.")
        if value in (None, ""):
            continue
        if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
            raise SettingsError(f"--{name}: {value!r} is no number.")
        out[name] = float(value)
    for name in REQUIRED:
        if out[name] is None:
            raise SettingsError(f"--{name} is needed.")
    return out


def made(name: str, values: Any) -> tuple[Ship, list[str]]:
    """A first model, and what to be careful about."""
    ship, warnings = first_model(name, given(values))
    return ship, warnings + careful(sea_trial(ship), float(ship.C_b))


def command(name: str, values: Mapping[str, Any], output: str) -> str:
    """The command line that makes the same ship."""
    options = [w for k, v in values.items() if v not in (None, "") for w in (f"--{k}", as_given(v, 12))]
    return shlex.join(["twin", "init", name, *options, "-o", output])


def described(ship: Ship) -> dict[str, Any]:
    """What the ship's file says of it."""
    notes: Mapping[str, Any] = ship.notes
    return plain(
        {
            "ship": ship.name,
            "sources": notes.get("sources", {}),
            "effects": [_effect(e) for e in ship.effects],
            "particulars": _numbers(ship, notes.get("particulars", {})),
            "derivatives": _numbers(ship.derivatives, notes.get("derivatives", {})),
            "calibrated": "structural" in notes,
            "history": ladder(ship),
        }
    )


def shown(ship: Ship) -> dict[str, Any]:
    """Everything that the ship's page shows of it: its file, and how it sails."""
    return described(ship) | {"trial": plain(trial(ship))}


def _effect(effect: Any) -> dict[str, Any]:
    numbers = [
        readable({"name": p.name, "unit": p.unit, "value": getattr(effect, p.name)}) for p in effect.params()
    ]
    return {"name": type(effect).__name__, "numbers": numbers}


def _numbers(of: Ship | Derivatives, notes: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Each number with its unit, meaning, source, standard error and prior."""
    out = []
    for f in fields(of):
        if "unit" not in f.metadata or getattr(of, f.name) is None:
            continue
        note = notes.get(f.name, {})
        row = {
            "name": f.name,
            "value": getattr(of, f.name),
            "unit": f.metadata["unit"],
            "doc": f.metadata["doc"],
        }
        row |= {key: note.get(key) for key in ("source", "sd", "prior_value", "prior_sd")}
        out.append(row)
    return out


def trial(ship: Ship) -> dict[str, Any]:
    """Figures beside their limits, and the two manoeuvres as lines, in ship lengths and degrees."""
    figures, L = sea_trial(ship), float(ship.L_pp)
    time = L / float(ship.U_0)
    circle = simulate(ship, manoeuvre="circle_35", duration_s=14.0 * time).data["columns"]
    zigzag = simulate(ship, manoeuvre="zigzag_20", duration_s=25.0 * time).data["columns"]
    heading = np.degrees(np.unwrap(np.radians(zigzag["heading_true_north_deg"])))
    return {
        "figures": figures,
        "limits": [
            {"name": text, "unit": unit, "value": figures.get(key), "limit": limit}
            for key, text, unit, limit in IMO
        ],
        "circle": {
            "x": (np.array(circle["east_m"]) / L)[::4].tolist(),
            "y": (np.array(circle["north_m"]) / L)[::4].tolist(),
        },
        "zigzag": {"t": np.array(zigzag["time_s"])[::4].tolist(), "y": heading[::4].tolist()},
    }


def measured_turn(path: str, ship: Ship) -> dict[str, Any]:
    """The largest turn of a voyage with the rudder held over: its way in ship lengths from where it began,
    ahead upwards and to starboard to the right (a turn to port is mirrored), and its heading [deg]."""
    v = read_voyage(path)
    if not v.has("north_m", "east_m", "heading_true_north_deg", "rudder_angle_deg"):
        raise SettingsError(f"{v.name}: position, heading and rudder are needed to show a turn.")
    rudder, t = v["rudder_angle_deg"], v.time_s - v.time_s[0]
    side = np.where(np.abs(rudder) > HELD_OVER * np.nanmax(np.abs(rudder)), np.sign(rudder), 0.0)
    starts = np.flatnonzero(np.r_[True, np.diff(side) != 0.0])
    ends = np.r_[starts[1:], side.size]
    held = [(a, b) for a, b in zip(starts, ends, strict=True) if side[a] != 0.0]
    if not held:
        raise SettingsError(f"{v.name}: its rudder is never put over.")
    psi = np.unwrap(np.radians(v["heading_true_north_deg"]))
    a, b = max(held, key=lambda k: abs(psi[k[1] - 1] - psi[k[0]]))
    keep = slice(a, b)
    psi = psi[keep]
    north, east = v["north_m"][keep] - v["north_m"][a], v["east_m"][keep] - v["east_m"][a]
    ahead = north * np.cos(psi[0]) + east * np.sin(psi[0])
    aside = side[a] * (east * np.cos(psi[0]) - north * np.sin(psi[0]))
    L, every = float(ship.L_pp), max(1, (b - a) // 800)
    return plain(
        {
            "voyage": v.name,
            "rudder_deg": float(np.nanmean(np.abs(rudder[keep]))),
            "start_s": float(t[a]),
            "duration_s": float(t[b - 1] - t[a]),
            "x": (aside / L)[::every].tolist(),
            "y": (ahead / L)[::every].tolist(),
            "turned_deg": float(np.degrees(abs(psi[-1] - psi[0]))),
        }
    )
