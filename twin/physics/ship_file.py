"""The TOML file that holds a ship, read and checked.

Every number in a ship file is a table { value, unit, source } (a fitted one has its standard error `sd` too),
so that an owner can see where each came from. Effects stand under [effects.NAME]; what calibration found
stands under [structural]; [[history]] is the ladder of what was added, on which voyages, and how far the
error fell."""

import os
import sys
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

from twin.errors import SettingsError, did_you_mean
from twin.num import as_given

from . import ship_arrays
from .actuators import Actuator
from .actuators.file import read as read_actuators
from .effect import Effect
from .effects import find
from .particulars import DERIVATIVES, ONE_SCREW, PARTICULARS, Derivatives, ShipNumbers
from .ship_pair import MAX_BYTES
from .ship_text import SCHEMA_VERSION, SECTIONS

S = TypeVar("S", bound=ShipNumbers)


def load(kind: type[S], path: str | os.PathLike[str], arrays: bool) -> S:
    """The ship, of this class, of a file (see `ship.load`). SettingsError: it cannot be read or is no ship
    file."""
    path = _bundled(path)
    try:
        with open(path, "rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a name with a zero byte in it
        why = getattr(error, "strerror", None) or error
        raise SettingsError(
            f"{str(path)[:300]}: cannot be read ({why}). Bundled ships: {', '.join(bundled())}."
        ) from None
    if len(data) > MAX_BYTES:
        raise SettingsError(
            f"{path}: more than {MAX_BYTES // 10**6} MB cannot be a ship file. Check the path."
        )
    try:
        table = tomllib.loads(data.decode())
    # no TOML, no UTF-8, a number of thousands of digits, a thousand brackets
    except (ValueError, RecursionError) as error:
        said = " ".join(str(error).split())[:200]
        raise SettingsError(f"{path}: not a valid TOML file: {said}. Save it as plain UTF-8 text.") from None
    if arrays:
        ship_arrays.said_of_old(table, SECTIONS, Path(path))
        table = ship_arrays.joined(table, Path(path))
    return from_table(kind, table, f"{path}: ")


def load_actuators(path: str | os.PathLike[str]) -> tuple[Actuator, ...]:
    """The [[actuators]] of a TOML file; SettingsError says what is wrong and where."""
    try:
        with open(path, "rb") as file:
            table = tomllib.load(file)
    except (OSError, ValueError, RecursionError) as error:
        why = getattr(error, "strerror", None) or " ".join(str(error).split())[:200]
        raise SettingsError(f"{path}: cannot be read as TOML ({why}).") from None
    if not table.get("actuators"):
        raise SettingsError(
            f"{path}: holds no [[actuators]]. Add one table [[actuators]] for each propeller or thruster."
        )
    return read_actuators(table["actuators"], f"{path}: ", value_of)[0]


def bundled() -> list[str]:
    """Names of the ships that come with the twin."""
    return sorted(p.stem for p in (Path(__file__).parent.parent / "ships").glob("*.toml"))


def _bundled(path: str | os.PathLike[str]) -> str | os.PathLike[str]:
    name = os.fspath(path)
    return (
        Path(__file__).parent.parent / "ships" / f"{name}.toml"
        if not os.path.exists(name) and name in bundled()
        else path
    )


def from_table(kind: type[S], table: Mapping[str, Any], where: str) -> S:
    """A ship, of this class, from the content of its file; `where` begins every complaint. SettingsError:
    it is not one."""
    if not table.get("name"):
        raise SettingsError(
            f"{where}no `name`: this is not a ship file. `twin init` makes one from a ship's particulars."
        )
    if table.get("schema_version", SCHEMA_VERSION) != SCHEMA_VERSION:
        raise SettingsError(
            f"{where}schema_version {table['schema_version']}: this twin reads "
            f"{SCHEMA_VERSION}. Update the twin."
        )
    particulars = _numbers(_section(table, "particulars", where), PARTICULARS, f"{where}particulars.")
    actuators, noted = (
        read_actuators(table["actuators"], where, value_of) if "actuators" in table else ((), {})
    )
    optional = ("A_F", "A_L", *(ONE_SCREW if actuators else ()))
    for f in PARTICULARS:
        if f.default is None and f.name not in particulars and f.name not in optional:
            raise SettingsError(
                f"{where}particulars.{f.name} ({f.metadata['doc']}, {f.metadata['unit']}) is missing. Add it."
            )
    derivatives = Derivatives(
        **_numbers(_section(table, "derivatives", where), DERIVATIVES, f"{where}derivatives.")
    )
    notes = dict(table)
    if noted:
        notes["derivatives"] = {**notes.get("derivatives", {}), **noted}
    ship = replace(
        kind(str(table["name"]), **particulars),  # type: ignore[arg-type]
        derivatives=derivatives,
        actuators=actuators,
        notes=notes,
    )
    effects = _section(table, "effects", where)
    return replace(
        ship,
        effects=tuple(
            _effect(name, _section(effects, name, f"{where}effects."), ship, where) for name in effects
        ),
    )


def _section(table: Mapping[str, Any], name: str, where: str) -> Mapping[str, Any]:
    found = table.get(name, {})
    if not isinstance(found, Mapping):
        raise SettingsError(
            f"{where}{name} = {found!r}: a section of numbers is needed, under a line [{name}]."
        )
    return found


def _effect(name: str, values: Mapping[str, Any], ship: ShipNumbers, where: str) -> Effect:
    """One effect of a ship file, checked; a parameter that is not given has its plausible value."""
    try:
        effect = find(name)
    except SettingsError as error:
        raise SettingsError(f"{where}effects.{name}: {error}") from None
    known, numbers = {p.name: p for p in effect.params()}, {}
    for key, entry in values.items():
        if key not in known and key not in ("source", "learned"):
            raise SettingsError(f"{where}effects.{name}.{key}: no such parameter.{did_you_mean(key, known)}")
        if key in known:
            numbers[key] = value_of(entry, f"{where}effects.{name}.{key}", known[key].unit)
    made = effect.plausible(ship).but(**numbers)
    made.check(ship, where)
    return made


def value_of(entry: Any, where: str, unit: str) -> float:
    """A number of a ship file, a table or plain, in this unit. SettingsError: it is not finite, no number, or
    of another unit."""
    told = entry if isinstance(entry, Mapping) else {"value": entry}
    value, given = told.get("value"), told.get("unit", unit)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= sys.float_info.max:
        raise SettingsError(
            f'{where} = {value!r:.60}: a finite number is needed, as {{ value = 1.0, unit = "..." }}.'
        )
    if given != unit:
        raise SettingsError(f"{where}: unit {given!r}, but {unit!r} is expected. Convert the value.")
    return float(value)


def _numbers(table: Mapping[str, Any], known: tuple[Any, ...], where: str) -> dict[str, float]:
    by_name = {f.name: f.metadata for f in known}
    out = {}
    for key, entry in table.items():
        if key not in by_name:
            raise SettingsError(f"{where}{key}: no such number.{did_you_mean(key, by_name)}")
        meta = by_name[key]
        value = value_of(entry, where + key, meta["unit"])
        if not meta["lo"] <= value <= meta["hi"]:
            raise SettingsError(
                f"{where}{key} = {as_given(value)} {meta['unit']} lies outside [{as_given(meta['lo'])}, "
                f"{as_given(meta['hi'])}] ({meta['doc']}). Check its unit."
            )
        out[key] = value
    return out
