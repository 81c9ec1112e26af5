"""Actuators in a ship file: the tables under [[actuators]], checked, and written back."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from twin.errors import SettingsError, did_you_mean
from twin.num import as_given

from .actuator import NUMBERS, Actuator
from .actuator_channels import CHANNELS_OF, DRIVES
from .kinds import KINDS

KEYS = {f.metadata.get("key", f.name): f for f in NUMBERS.values()}
WORDS = ("name", "kind", "channels")
MAX_ACTUATORS = 16  # actuators of one ship
NAME = r"[a-z][a-z0-9_]{0,30}"


ValueOf = Callable[[Any, str, str], float]  # of an entry, in its unit, or a SettingsError that says where


def read(tables: Any, where: str, value: ValueOf) -> tuple[tuple[Actuator, ...], dict[str, Any]]:
    """The actuators, and by `name.number` what the file notes of each number (its standard error ...).
    SettingsError: they are no such tables, two have one name, or a number has another unit."""
    if (
        not isinstance(tables, list)
        or len(tables) > MAX_ACTUATORS
        or not all(isinstance(t, Mapping) for t in tables)
    ):
        raise SettingsError(
            f"{where}actuators: up to {MAX_ACTUATORS} tables are needed, each under [[actuators]]."
        )
    found, notes = list[Actuator](), dict[str, Any]()
    for i, table in enumerate(tables, 1):
        made = _one(table, f"{where}actuators {i}", value, notes)
        if made.name in (a.name for a in found):
            raise SettingsError(f"{where}actuators {i}: two are called {made.name!r}. Rename one.")
        found.append(made)
    return tuple(found), notes


def _one(table: Mapping[str, Any], where: str, value: ValueOf, notes: dict[str, Any]) -> Actuator:
    name, kind, channels = (table.get(word) for word in WORDS)
    if not isinstance(name, str) or not re.fullmatch(NAME, name):
        raise SettingsError(f"{where}: name = {name!r} must be small letters, digits and _, such as port.")
    where = f"{where} ({name})"
    if kind not in KINDS:
        sail = " A sailing vessel is none that this twin models." * ("sail" in str(kind).lower())
        raise SettingsError(f"{where}: kind = {kind!r} is not known.{sail}{did_you_mean(str(kind), KINDS)}")
    if not isinstance(channels, list) or not channels:
        raise SettingsError(f'{where}: channels = ["rate_rpm", ...] is missing: what is recorded of it.')
    for c in channels:
        if c not in CHANNELS_OF:
            raise SettingsError(f"{where}: no channel is called {c!r}.{did_you_mean(str(c), CHANNELS_OF)}")
    numbers: dict[str, Any] = {}
    for key, entry in table.items():
        if key in WORDS:
            continue
        if key not in KEYS:
            raise SettingsError(f"{where}: no number is called {key!r}.{did_you_mean(key, (*WORDS, *KEYS))}")
        f = KEYS[key]
        numbers[f.name] = number = value(entry, f"{where}.{key}", f.metadata["unit"])
        lo, hi = f.metadata["lo"], f.metadata["hi"]
        if not lo <= number <= hi:
            raise SettingsError(
                f"{where}.{key} = {as_given(number)} {f.metadata['unit']} lies outside [{as_given(lo)}, "
                f"{as_given(hi)}] ({f.metadata['doc']}). Check its unit."
            )
        if isinstance(entry, Mapping):
            notes[f"{name}.{f.name}"] = dict(entry)
    made = Actuator(name, str(kind), tuple(channels), **numbers)
    _fits(made, where)
    return made


def _fits(a: Actuator, where: str) -> None:
    """The channels fit the kind, and the numbers fit the channels."""
    has, kind = a.attributes, KINDS[a.kind]
    drives = [x for x in has if x in DRIVES]
    if len(drives) != 1 or len(set(has)) < len(has):
        raise SettingsError(
            f"{where}: channels {', '.join(a.channels)}: exactly one must say how hard it pushes "
            "(command, pwm_us, rate_rpm, rate_rev_s or thrust_n)."
        )
    for need in kind.needs:
        if need not in has:
            raise SettingsError(f"{where}: a {a.kind} needs its {need} among its channels. Add it.")
    for extra in set(has) - {*DRIVES, *kind.needs, *kind.may}:
        raise SettingsError(f"{where}: a {a.kind} has no {extra}. Remove it from its channels.")
    pushes = {"rate": ("D",), "command": ("ahead", "astern"), "pwm": ("ahead", "astern"), "thrust": ()}
    behind = ("D",) if a.kind in ("propeller", "controllable_pitch") else ()
    blade = ("A_R",) if behind and "angle" in has else ()
    for n in (*pushes[drives[0]], *behind, *blade):
        if getattr(a, n) is None:
            key = next(k for k, f in KEYS.items() if f.name == n)
            doc = KEYS[key].metadata
            raise SettingsError(f"{where}: {key} ({doc['doc']}, {doc['unit']}) is missing. Add it.")
    if a.kind == "controllable_pitch" and drives != ["rate"]:
        raise SettingsError(f"{where}: a controllable_pitch needs its rate: rate_rpm or rate_rev_s.")


def tables(actuators: Sequence[Actuator], notes: Mapping[str, Any]) -> list[dict[str, Any]]:
    """What the ship file holds of them; a number that stands at its default and was never noted is left
    out."""
    out = []
    for a in actuators:
        table: dict[str, Any] = {"name": a.name, "kind": a.kind, "channels": list(a.channels)}
        for key, f in KEYS.items():
            value, noted = getattr(a, f.name), notes.get(f"{a.name}.{f.name}", {})
            if value is None or (value == f.default and not noted):
                continue
            kept = {k: v for k, v in noted.items() if k not in ("value", "unit")}
            if noted.get("value") != value:
                kept.pop("source", None)
            table[key] = {"value": float(value), "unit": f.metadata["unit"], **kept}
        out.append(table)
    return out
