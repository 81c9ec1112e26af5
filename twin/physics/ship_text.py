"""A ship as text: the TOML that a person can read, with its sources, and that `load` reads back the same."""

import json
import math
import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from twin import whole
from twin.num import as_given

from . import ship_arrays, ship_pair
from .actuators import KINDS
from .actuators.file import tables as actuator_tables
from .particulars import DERIVATIVES, ONE_SCREW, PARTICULARS, ShipNumbers

SCHEMA_VERSION = 1
SECTIONS = ("schema_version", "name", "particulars", "derivatives", "effects", "actuators")


def to_table(ship: ShipNumbers) -> dict[str, Any]:
    """What the ship's file holds; sources and standard errors are kept for the numbers that did not
    change."""
    notes = ship.notes

    def entry(section: str, meta: Mapping[str, Any], name: str, value: float) -> dict[str, Any]:
        old = notes.get(section, {}).get(name, {})
        old = old if isinstance(old, Mapping) else {"value": old}
        kept = dict(old) if old.get("value") == value else {k: v for k, v in old.items() if k != "source"}
        return {"value": float(value), "unit": meta["unit"]} | {
            k: v for k, v in kept.items() if k not in ("value", "unit")
        }

    table: dict[str, Any] = {"schema_version": SCHEMA_VERSION, "name": ship.name}
    table["particulars"] = {
        f.name: entry("particulars", f.metadata, f.name, getattr(ship, f.name))
        for f in PARTICULARS
        if getattr(ship, f.name) is not None
    }
    table["derivatives"] = {
        f.name: entry("derivatives", f.metadata, f.name, getattr(ship.derivatives, f.name))
        for f in DERIVATIVES
    }
    table["effects"] = {
        type(e).__name__: {
            p.name: {"value": float(getattr(e, p.name)), "unit": p.unit}
            | {k: v for k, v in _noted(notes, type(e).__name__, p.name).items() if k not in ("value", "unit")}
            for p in e.params()
        }
        for e in ship.effects
    }
    if ship.actuators:
        table["actuators"] = actuator_tables(ship.actuators, notes.get("derivatives", {}))
    return table | {k: v for k, v in notes.items() if k not in SECTIONS}


def _noted(notes: Mapping[str, Any], effect: str, name: str) -> Mapping[str, Any]:
    entry = notes.get("effects", {}).get(effect, {}).get(name, {})
    return entry if isinstance(entry, Mapping) else {}


def text(table: Mapping[str, Any]) -> str:
    """A ship's table as TOML, one line for each number with its meaning behind it; what else was noted
    follows."""
    meaning = {"particulars": PARTICULARS, "derivatives": DERIVATIVES}
    docs = {f"{section}.{f.name}": f.metadata["doc"] for section, known in meaning.items() for f in known}
    own = _of_actuators(table["actuators"]) if table.get("actuators") else ()
    rest = {k: v for k, v in table.items() if k not in SECTIONS}
    lists = {
        k: v
        for k, v in rest.items()
        if isinstance(v, list) and v and all(isinstance(item, Mapping) for item in v)
    }
    tables = {k: v for k, v in rest.items() if isinstance(v, Mapping)}
    plain = {k: v for k, v in rest.items() if k not in lists and k not in tables}
    lines = [
        f"{_key(k)} = {_inline(v)}"
        for k, v in ({k: table[k] for k in ("schema_version", "name")} | plain).items()
    ]
    sections = {key: table[key] for key in ("particulars", "derivatives")}
    sections |= {f"effects.{_key(name)}": numbers for name, numbers in table["effects"].items()}
    for section, entries in (sections | {_key(k): v for k, v in tables.items()}).items():
        lines += ["", f"[{section}]"]
        for name, entry in entries.items():
            idle = "not used: the actuators have their own" if name in own else ""
            words = [w for w in (docs.get(f"{section}.{name}"), in_degrees(entry), idle) if w]
            lines.append(f"{_key(name)} = {_inline(entry)}" + (f"  # {'; '.join(words)}" if words else ""))
    lists = ({"actuators": table["actuators"]} if table.get("actuators") else {}) | lists
    for name, items in lists.items():
        for item in items:
            lines += ["", f"[[{_key(name)}]]"]
            for k, v in item.items():
                degrees = in_degrees(v)
                lines.append(f"{_key(k)} = {_inline(v)}" + (f"  # {degrees}" if degrees else ""))
    return "\n".join(lines) + "\n"


def _of_actuators(tables: list[Mapping[str, Any]]) -> set[str]:
    """The ship's numbers of one propeller and rudder that no force reads where it has such actuators."""
    read = {name for kind in KINDS.values() for name in kind.reads}
    return {*ONE_SCREW, "K_T0", "K_T1", "x_R"} | read.difference(*(KINDS[t["kind"]].reads for t in tables))


def in_degrees(entry: Any) -> str:
    """What a person reads beside an angle in radians (or a rate in rad/s): the same in degrees; else ""."""
    unit = entry.get("unit") if isinstance(entry, Mapping) else None
    if unit not in ("rad", "rad/s") or not isinstance(entry.get("value"), (int, float)):
        return ""
    return f"{as_given(math.degrees(entry['value']), 4)} {unit.replace('rad', 'deg')}"


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name, ensure_ascii=False)


def _inline(value: Any) -> str:
    """One value in TOML."""
    if isinstance(value, Mapping):
        return (
            "{ " + ", ".join(f"{_key(k)} = {_inline(v)}" for k, v in value.items()) + " }" if value else "{}"
        )
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_inline(v) for v in value) + "]"
    if hasattr(value, "isoformat"):
        return value.isoformat()
    value = value.item() if hasattr(value, "item") else value
    return str(value).lower() if isinstance(value, bool) else repr(value)


def save(
    ship: ShipNumbers, path: str | os.PathLike[str], said: Callable[[Mapping[str, Any]], str] = text
) -> None:
    """Write the ship file aside and rename it into place, so that no half file is ever seen; its long arrays
    go to a file beside it (`ship_arrays`), which is written first (`ship_pair`). `said`: how the rest is
    told."""
    place, table = Path(path), to_table(ship)
    if place.exists() and not place.is_file():  # a device or a pipe, which has nothing beside it
        whole.write(place, said(table))
        return
    table, long = ship_arrays.divided(table, SECTIONS)
    with ship_pair.writing(place):
        if long:
            table[ship_arrays.SECTION] = ship_arrays.write(place, long)
        whole.write(place, said(table))
