"""A ship: her particulars, derivatives and effects, frozen, and the TOML file that holds them.

Every number in a ship file is a table { value, unit, source } (a fitted one has its standard error `sd` too), so that an owner
can see where each came from. Effects stand under [effects.NAME]; what calibration found stands under [structural];
[[history]] is the ladder of what was added, on which voyages, and how far the error fell.
"""

import json
import os
import re
import tempfile
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from twin.errors import SettingsError, did_you_mean

from .core import Coefficients, coefficients
from .effect import Effect
from .state import Number

SCHEMA_VERSION = 1


def number(default: float | None, unit: str, lo: float, hi: float, doc: str, sd: float = 0.0) -> Any:
    """A number of the ship: value, unit, the range outside which it is a mistake, meaning, width of its prior."""
    return field(default=default, metadata=dict(unit=unit, lo=lo, hi=hi, doc=doc, sd=sd), kw_only=True)


@dataclass(frozen=True)
class Derivatives:
    """Hydrodynamic derivatives in prime form (see core.py); the defaults are those of a full, single-screw hull.

    `sd` in the metadata is the width of the prior: how far a published regression is usually off.
    """

    X_udot: Number = number(-0.022, "-", -0.2, 0.0, "added mass, surge", sd=0.01)
    Y_vdot: Number = number(-0.223, "-", -0.8, 0.0, "added mass, sway", sd=0.04)
    Y_rdot: Number = number(0.0, "-", -0.1, 0.1, "added mass, sway from yaw", sd=0.01)
    N_vdot: Number = number(0.0, "-", -0.1, 0.1, "added moment, yaw from sway", sd=0.01)
    N_rdot: Number = number(-0.011, "-", -0.1, 0.0, "added moment of inertia, yaw", sd=0.004)
    X_u: Number = number(0.0, "-", -0.05, 0.0, "resistance, linear part (made non-dimensional by sqrt(g L))", sd=0.0003)
    X_uu: Number = number(-0.022, "-", -0.4, -0.001, "resistance", sd=0.005)
    X_vv: Number = number(-0.04, "-", -1.0, 1.0, "resistance of drift", sd=0.05)
    X_vr: Number = number(0.0, "-", -1.0, 1.0, "resistance of drift while turning, beyond C(nu)", sd=0.07)
    X_rr: Number = number(0.011, "-", -0.3, 0.3, "resistance of turning", sd=0.02)
    Y_v: Number = number(0.0, "-", -0.3, 0.0, "sway damping, linear at rest (sqrt(g L))", sd=0.002)
    Y_uv: Number = number(-0.315, "-", -2.0, 0.0, "sway damping, lift of the hull", sd=0.08)
    Y_ur: Number = number(0.083, "-", -0.5, 0.6, "side force of turning", sd=0.04)
    Y_vv: Number = number(-0.7, "-", -6.0, 0.5, "sway damping, cross-flow", sd=0.4)
    Y_vr: Number = number(0.0, "-", -3.0, 3.0, "|v| r", sd=0.15)
    Y_rv: Number = number(-0.2, "-", -3.0, 3.0, "|r| v", sd=0.15)
    Y_rr: Number = number(0.02, "-", -1.5, 1.5, "|r| r", sd=0.04)
    N_r: Number = number(0.0, "-", -0.1, 0.0, "yaw damping, linear at rest (sqrt(g L))", sd=0.0005)
    N_uv: Number = number(0.0, "-", -0.6, 0.6, "yaw moment of drift, beyond the Munk moment in C(nu)", sd=0.05)
    N_ur: Number = number(-0.049, "-", -0.4, 0.1, "yaw damping, lift of the hull", sd=0.015)
    N_vv: Number = number(0.0, "-", -1.0, 1.0, "|v| v", sd=0.06)
    N_vr: Number = number(-0.15, "-", -1.5, 1.5, "|v| r", sd=0.08)
    N_rv: Number = number(0.0, "-", -1.5, 1.5, "|r| v", sd=0.06)
    N_rr: Number = number(-0.03, "-", -0.6, 0.3, "|r| r", sd=0.02)
    K_T0: Number = number(0.32, "-", 0.02, 1.5, "thrust coefficient at J = 0", sd=0.04)
    K_T1: Number = number(-0.32, "-", -1.5, 0.0, "slope of the thrust coefficient over J", sd=0.06)
    t: Number = number(0.2, "-", 0.0, 0.5, "thrust deduction fraction")
    w: Number = number(0.35, "-", 0.0, 0.6, "wake fraction at the propeller")
    epsilon: Number = number(1.05, "-", 0.4, 2.5, "rudder inflow over propeller inflow", sd=0.1)
    kappa: Number = number(0.5, "-", 0.0, 1.5, "share of the slipstream's gain that the rudder feels", sd=0.15)
    C_L: Number = number(2.6, "-", 0.5, 6.5, "slope of the rudder's normal force [1/rad]")
    t_R: Number = number(0.35, "-", -0.5, 0.9, "steering resistance deduction", sd=0.15)
    a_H: Number = number(0.3, "-", -0.2, 1.2, "increase of the side force by the hull", sd=0.1)
    x_R: Number = number(-0.5, "L", -0.65, 0.65, "rudder ahead of midship")
    x_H: Number = number(-0.46, "L", -0.7, 0.5, "where the hull's share of the side force acts", sd=0.1)
    gamma_v: Number = number(0.45, "-", -0.2, 1.5, "how much of the drift reaches the rudder", sd=0.12)
    gamma_r: Number = number(-0.35, "-", -1.2, 0.2, "how much of the turning reaches the rudder", sd=0.1)


@dataclass(frozen=True)
class Ship:
    """Everything the model knows of one ship; a file of it is read with `load` and written with `save`."""

    name: str
    L_pp: Number = number(None, "m", 0.2, 500.0, "length between perpendiculars")
    B: Number = number(None, "m", 0.05, 90.0, "beam")
    T: Number = number(None, "m", 0.01, 40.0, "mean draught")
    m: Number = number(None, "kg", 0.05, 1e9, "mass (displacement)")
    C_b: Number = number(None, "-", 0.05, 1.0, "block coefficient")
    x_G: Number = number(0.0, "m", -60.0, 60.0, "centre of gravity ahead of midship")
    I_z: Number = number(None, "kg m2", 1e-4, 1e14, "moment of inertia in yaw about midship")
    rho: Number = number(1025.0, "kg/m3", 900.0, 1100.0, "density of the water")
    U_0: Number = number(None, "m/s", 0.05, 40.0, "service speed")
    D_P: Number = number(None, "m", 0.005, 15.0, "propeller diameter")
    A_R: Number = number(None, "m2", 1e-5, 250.0, "rudder area (moveable)")
    A_F: Number | None = number(None, "m2", 1e-4, 5000.0, "frontal area above the water")
    A_L: Number | None = number(None, "m2", 1e-4, 20000.0, "lateral area above the water")
    derivatives: Derivatives = field(default_factory=Derivatives, kw_only=True)
    effects: tuple[Effect, ...] = field(default=(), kw_only=True)
    notes: Mapping[str, Any] = field(default_factory=dict, kw_only=True, compare=False)  # sources, sd, structural, history ...

    @cached_property
    def c(self) -> Coefficients:
        """Her derivatives with their units."""
        return coefficients(self)

    def scale(self, of: str) -> Number:
        """The ship's own size of a quantity: 'force' is 1 % of 1/2 rho L T U_0^2, about half of her resistance.

        'moment' = force L, 'speed' = U_0, 'length' = L, 'time' = L/U_0.
        """
        force = 0.005 * self.rho * self.L_pp * self.T * self.U_0**2
        return {
            "force": force, "moment": force * self.L_pp, "speed": self.U_0, "length": self.L_pp, "time": self.L_pp / self.U_0,
        }[of]  # fmt: skip

    def with_derivatives(self, **values: Number) -> "Ship":
        return replace(self, derivatives=replace(self.derivatives, **values))

    def with_effects(self, *effects: Effect) -> "Ship":
        """The ship with these effects added; one of the same name is replaced."""
        names = {type(e) for e in effects}
        return replace(self, effects=(*(e for e in self.effects if type(e) not in names), *effects))

    def without_effects(self, *names: str) -> "Ship":
        return replace(self, effects=tuple(e for e in self.effects if type(e).__name__ not in names))


PARTICULARS = tuple(f for f in fields(Ship) if f.metadata)
DERIVATIVES = fields(Derivatives)
SECTIONS = ("schema_version", "name", "particulars", "derivatives", "effects")


def load(path: str | os.PathLike[str]) -> Ship:
    """Read a ship file (or a bundled ship by its bare name, such as `kvlcc2`); SettingsError says what is wrong and where."""
    path = _bundled(path)
    try:
        with open(path, "rb") as file:
            table = tomllib.load(file)
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read ({error.strerror}). Bundled ships: {', '.join(bundled())}.") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SettingsError(f"{path}: not a valid TOML file: {error}. Save it as plain UTF-8 text.") from None
    return from_table(table, f"{path}: ")


def bundled() -> list[str]:
    """Names of the ships that come with the twin."""
    return sorted(p.stem for p in (Path(__file__).parent.parent / "ships").glob("*.toml"))


def _bundled(path: str | os.PathLike[str]) -> str | os.PathLike[str]:
    inside = Path(__file__).parent.parent / "ships" / f"{path}.toml"
    return inside if not os.path.exists(path) and inside.exists() else path


def from_table(table: Mapping[str, Any], where: str = "") -> Ship:
    """A ship from the content of its file; `where` begins every complaint."""
    if not table.get("name"):
        raise SettingsError(f"{where}no `name`: this is not a ship file. `twin init` makes one from a ship's particulars.")
    if table.get("schema_version", SCHEMA_VERSION) != SCHEMA_VERSION:
        raise SettingsError(f"{where}schema_version {table['schema_version']}: this twin reads {SCHEMA_VERSION}. Update the twin.")
    particulars = _numbers(_section(table, "particulars", where), PARTICULARS, f"{where}particulars.")
    for f in PARTICULARS:
        if f.default is None and f.name not in particulars and f.name not in ("A_F", "A_L"):
            raise SettingsError(f"{where}particulars.{f.name} ({f.metadata['doc']}, {f.metadata['unit']}) is missing. Add it.")
    derivatives = Derivatives(**_numbers(_section(table, "derivatives", where), DERIVATIVES, f"{where}derivatives."))
    ship = Ship(str(table["name"]), **particulars, derivatives=derivatives, notes=dict(table))
    effects = _section(table, "effects", where)
    return replace(ship, effects=tuple(_effect(name, _section(effects, name, f"{where}effects."), ship, where) for name in effects))


def _section(table: Mapping[str, Any], name: str, where: str) -> Mapping[str, Any]:
    found = table.get(name, {})
    if not isinstance(found, Mapping):
        raise SettingsError(f"{where}{name} = {found!r}: a section of numbers is needed, under a line [{name}].")
    return found


def _effect(name: str, values: Mapping[str, Any], ship: Ship, where: str) -> Effect:
    """One effect of a ship file, checked; a parameter that is not given has its plausible value."""
    from .effects import find

    try:
        effect = find(name)
    except SettingsError as error:
        raise SettingsError(f"{where}effects.{name}: {error}") from None
    known, numbers = {p.name: p for p in effect.params()}, {}
    for key, entry in values.items():
        if key not in known and key not in ("source", "learned"):
            raise SettingsError(f"{where}effects.{name}.{key}: no such parameter.{did_you_mean(key, known)}")
        if key in known:
            numbers[key] = _value(entry, f"{where}effects.{name}.{key}")
            _same_unit(entry, known[key].unit, f"{where}effects.{name}.{key}")
    made = effect.plausible(ship).but(**numbers)
    made.check(ship, where)
    return made


def _same_unit(entry: Any, unit: str, where: str) -> None:
    given = entry.get("unit", unit) if isinstance(entry, Mapping) else unit
    if given != unit:
        raise SettingsError(f"{where}: unit {given!r}, but {unit!r} is expected. Convert the value.")


def _value(entry: Any, where: str) -> float:
    value = entry.get("value") if isinstance(entry, Mapping) else entry
    if isinstance(value, bool) or not isinstance(value, (int, float)) or value != value or abs(value) == float("inf"):
        raise SettingsError(f"{where} = {value!r}: a finite number is needed, as {{ value = 1.0, unit = \"...\" }}.")
    return float(value)


def _numbers(table: Mapping[str, Any], known: tuple[Any, ...], where: str) -> dict[str, float]:
    by_name = {f.name: f.metadata for f in known}
    out = {}
    for key, entry in table.items():
        if key not in by_name:
            raise SettingsError(f"{where}{key}: no such number.{did_you_mean(key, by_name)}")
        meta, value = by_name[key], _value(entry, where + key)
        if not meta["lo"] <= value <= meta["hi"]:
            raise SettingsError(
                f"{where}{key} = {value:g} {meta['unit']} lies outside [{meta['lo']:g}, {meta['hi']:g}] ({meta['doc']}). Check its unit."
            )
        _same_unit(entry, meta["unit"], where + key)
        out[key] = value
    return out


def to_table(ship: Ship) -> dict[str, Any]:
    """What the ship's file holds; sources and standard errors are kept for the numbers that did not change."""
    notes = ship.notes

    def entry(section: str, meta: Mapping[str, Any], name: str, value: float) -> dict[str, Any]:
        old = notes.get(section, {}).get(name, {})
        old = old if isinstance(old, Mapping) else {"value": old}
        kept = dict(old) if old.get("value") == value else {k: v for k, v in old.items() if k != "source"}
        return {"value": float(value), "unit": meta["unit"]} | {k: v for k, v in kept.items() if k not in ("value", "unit")}

    table: dict[str, Any] = {"schema_version": SCHEMA_VERSION, "name": ship.name}
    table["particulars"] = {
        f.name: entry("particulars", f.metadata, f.name, getattr(ship, f.name))
        for f in PARTICULARS
        if getattr(ship, f.name) is not None
    }
    table["derivatives"] = {f.name: entry("derivatives", f.metadata, f.name, getattr(ship.derivatives, f.name)) for f in DERIVATIVES}
    table["effects"] = {
        type(e).__name__: {
            p.name: {"value": float(getattr(e, p.name)), "unit": p.unit}
            | {k: v for k, v in _noted(notes, type(e).__name__, p.name).items() if k not in ("value", "unit")}
            for p in e.params()
        }
        for e in ship.effects
    }
    return table | {k: v for k, v in notes.items() if k not in SECTIONS}


def _noted(notes: Mapping[str, Any], effect: str, name: str) -> Mapping[str, Any]:
    entry = notes.get("effects", {}).get(effect, {}).get(name, {})
    return entry if isinstance(entry, Mapping) else {}


def text(table: Mapping[str, Any]) -> str:
    """A ship's table as TOML, one line for each number with its meaning behind it; what else was noted follows."""
    meaning = {"particulars": PARTICULARS, "derivatives": DERIVATIVES}
    docs = {f"{section}.{f.name}": f.metadata["doc"] for section, known in meaning.items() for f in known}
    rest = {k: v for k, v in table.items() if k not in SECTIONS}
    lists = {k: v for k, v in rest.items() if isinstance(v, list) and v and all(isinstance(item, Mapping) for item in v)}
    tables = {k: v for k, v in rest.items() if isinstance(v, Mapping)}
    plain = {k: v for k, v in rest.items() if k not in lists and k not in tables}
    lines = [f"{_key(k)} = {_inline(v)}" for k, v in ({k: table[k] for k in ("schema_version", "name")} | plain).items()]
    sections = {key: table[key] for key in ("particulars", "derivatives")}
    sections |= {f"effects.{name}": numbers for name, numbers in table["effects"].items()}
    for section, entries in (sections | {_key(k): v for k, v in tables.items()}).items():
        lines += ["", f"[{section}]"]
        for name, entry in entries.items():
            doc = docs.get(f"{section}.{name}")
            lines.append(f"{_key(name)} = {_inline(entry)}" + (f"  # {doc}" if doc else ""))
    for name, items in lists.items():
        for item in items:
            lines += ["", f"[[{_key(name)}]]", *(f"{_key(k)} = {_inline(v)}" for k, v in item.items())]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name, ensure_ascii=False)


def _inline(value: Any) -> str:
    """One value in TOML."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_inline(v)}" for k, v in value.items()) + " }" if value else "{}"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_inline(v) for v in value) + "]"
    if hasattr(value, "isoformat"):
        return value.isoformat()
    value = value.item() if hasattr(value, "item") else value
    return str(value).lower() if isinstance(value, bool) else repr(value)


def save(ship: Ship, path: str | os.PathLike[str]) -> None:
    """Write the ship file aside and rename it into place, so that no half file is ever seen."""
    path, content = Path(path), text(to_table(ship))
    try:
        with tempfile.NamedTemporaryFile("w", dir=path.parent, prefix=f".{path.name}.", delete=False, encoding="utf-8") as file:
            file.write(content)
        os.chmod(file.name, 0o644)
        os.replace(file.name, path)
    except OSError as error:
        raise SettingsError(f"{path}: cannot be written ({error.strerror}). Choose another place with -o.") from None
