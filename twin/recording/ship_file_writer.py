"""A ship file written from another one: what a person noted in it, and the order in which it stands, stay.

Only what changed is changed: a number within its line, an effect or a step of the history at the end. It is
read again before it is written; where that would not give the same ship, the plain text is written instead.
"""

import os
import re
import tomllib
from collections.abc import Mapping, MutableMapping
from pathlib import Path
from typing import Any

from twin.physics.ship import Ship, from_table, text, to_table
from twin.physics.ship_text import in_degrees
from twin.physics.ship_text import save as written

DEGREES = re.compile(r"-?[0-9][-+.0-9e]* deg(?:/s)?\b")
OF_A_PERSON = ("source", "learned")  # of an effect, beside its numbers


def save(ship: Ship, path: str | os.PathLike[str], like: str | os.PathLike[str]) -> None:
    """Write the ship file as `Ship.save` does, with the comments and the order of the file `like`, from which
    the ship came."""
    try:
        before = Path(like).read_bytes().decode()
    except (OSError, ValueError):  # a bundled ship's bare name
        before = ""
    written(ship, path, lambda table: kept(before, table) or text(table))


def kept(before: str, table: Mapping[str, Any]) -> str:
    """The content `table` in the words of the file `before`; "" where they do not fit, and where tomlkit (of
    the extra `study`) is not installed."""
    try:
        import tomlkit
        from tomlkit.exceptions import TOMLKitError
    except ModuleNotFoundError:
        return ""
    plain = text(table)
    try:
        document, fresh = tomlkit.parse(before), tomlkit.parse(plain)
        if not document.get("name"):
            return ""
        _merge(document, fresh)
        now = tomlkit.dumps(document)
        same = _content(now) == _content(plain)
    except (TOMLKitError, KeyError, TypeError, ValueError):
        return ""
    return now if same else ""


def _content(words: str) -> dict[str, Any]:
    """What a ship file says, without its long arrays."""
    return to_table(from_table(tomllib.loads(words)))


def _merge(old: MutableMapping[str, Any], new: Mapping[str, Any], where: tuple[str, ...] = ()) -> None:
    """Make `old` say what `new` says, line by line."""
    for key in [k for k in old if k not in new and not (where[:1] == ("effects",) and k in OF_A_PERSON)]:
        del old[key]
    for key, value in new.items():
        if key not in old:
            old[key] = value
        elif not _same(old[key], value):
            _change(old, key, value, (*where, key))


def _change(old: MutableMapping[str, Any], key: str, value: Any, where: tuple[str, ...]) -> None:
    """One entry that is not the same any more."""
    there = old[key]
    if isinstance(there, Mapping) and isinstance(value, Mapping):
        _merge(there, value, where)  # type: ignore[arg-type]
        _turned(there, value)
    elif isinstance(there, list) and isinstance(value, list) and _begins(value, there):
        for item in value[len(there) :]:
            there.append(item)
    else:
        old[key] = value


def _same(there: Any, value: Any) -> bool:
    """Whether a person's entry says this already; a bare number is one without a source."""
    if isinstance(value, Mapping) and set(value) == {"value", "unit"} and not isinstance(there, Mapping):
        return bool(there == value["value"])
    return bool(there == value)


def _begins(value: list[Any], there: list[Any]) -> bool:
    return len(value) > len(there) and value[: len(there)] == there


def _turned(there: Any, value: Mapping[str, Any]) -> None:
    """Degrees in the comment behind a number in radians follow the number."""
    trivia, degrees = getattr(there, "trivia", None), in_degrees(value)
    if trivia is not None and degrees:
        if not trivia.comment:
            there.comment(degrees)
        else:
            trivia.comment = DEGREES.sub(degrees, trivia.comment, count=1)
