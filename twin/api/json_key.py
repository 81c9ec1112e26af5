"""What a key of a verb's JSON is, the keys that verbs share, and how a result is held against a table.

A path is written with `.` between keys, `[]` for the entries of a list and `*` for any name (a channel, an
effect, a parameter). Keys that are not in every answer say when they are.
"""

import re
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple


class JsonKey(NamedTuple):
    """One key: its path, the unit of its number ("" where it has none), its meaning, and when it is there
    ("" always)."""

    path: str
    unit: str
    meaning: str
    when: str = ""


CLI = "written by the command"
NAMED = "something is named"
FACTS = "with the table of facts"
PROOF = "with the proof by likelihood"

ABOUT = (
    JsonKey("schema_version", "", "version of this format"),
    JsonKey("ship", "", "name of the ship"),
)
CHECKS = (
    JsonKey("data_checks[].check", "", "name of a check of the data, as in docs/import.md"),
    JsonKey("data_checks[].ok", "", "whether the data passes, or could not tell"),
    JsonKey("data_checks[].proved", "", "whether the check proves a mistake"),
    JsonKey("data_checks[].told", "", "whether the data could tell at all"),
    JsonKey("data_checks[].text", "", "the answer in a sentence"),
    JsonKey("data_checks[].voyage", "", "which voyage", "more than one voyage was given"),
)
WAVES_AND_JUMPS = (  # on the voyages
    JsonKey("waves[]", "", "voyages on which waves move the ship", "there are some"),
    JsonKey("waves[].*", "", "such a voyage, with the waves' period", "there are some"),
    JsonKey("jumps[]", "", "stretches whose readings do not count", "there are some"),
    JsonKey("jumps[].voyage", "", "of this voyage", "there are some"),
    JsonKey("jumps[].start_s", "s", "where it begins", "there are some"),
    JsonKey("jumps[].end_s", "s", "where it ends", "there are some"),
    JsonKey("jumps[].readings[]", "", "place or heading", "there are some"),
)
COMMAND = (
    JsonKey("command", "", "the command that made it", CLI),
    JsonKey("files.ship", "", "the ship file that was given", CLI),
    JsonKey("files.voyages[]", "", "the voyages that were given", CLI),
    JsonKey("files.judged[]", "", "the voyages that the change was judged by", CLI),
    JsonKey("output", "", "the ship file that was written", CLI),
)
ERRORS = (
    JsonKey("position_mae_m", "m", "mean absolute error in place"),
    JsonKey("lateral_mae_m", "m", "mean absolute error across the course"),
    JsonKey("heading_mae_deg", "deg", "mean absolute error in heading"),
)
ESTIMATE = (
    JsonKey("value", "of the number", "its estimate"),
    JsonKey("low95", "of the number", "lower end of its 95 % interval"),
    JsonKey("high95", "of the number", "upper end"),
    JsonKey("unit", "", "its unit"),
)
STREAM = (
    JsonKey("voyage", "", "a moment of a stream: its voyage", "it is a stream"),
    JsonKey("time_s", "s", "time since the voyage began", "it is a stream"),
    JsonKey("speed_mps", "m/s", "how fast the water moves then", "it is a stream"),
    JsonKey("toward_deg", "deg", "toward where, from true north", "it is a stream"),
)
TYPICAL_FORCE = (
    JsonKey("typical_force.X_N", "N", "root mean square of its force ahead"),
    JsonKey("typical_force.Y_N", "N", "root mean square of its side force"),
    JsonKey("typical_force.N_Nm", "N m", "root mean square of its yaw moment"),
)


def when(condition: str, keys: tuple[JsonKey, ...]) -> tuple[JsonKey, ...]:
    """The keys of what is not always there."""
    return tuple(k._replace(when=k.when or condition) for k in keys)


def under(path: str, keys: tuple[JsonKey, ...], what: str = "") -> tuple[JsonKey, ...]:
    """The keys below a path; `what` is put before their meanings."""
    return tuple(k._replace(path=f"{path}.{k.path}", meaning=f"{what}{k.meaning}") for k in keys)


def provenance(path: str, what: str) -> tuple[JsonKey, ...]:
    """Where a voyage came from."""
    return (
        JsonKey(f"{path}[].name", "", f"{what}: name of the voyage"),
        JsonKey(f"{path}[].sha256", "", "hash of its file, or of its samples"),
        JsonKey(f"{path}[].start_time_utc", "", "when it began", "the file says it"),
        JsonKey(f"{path}[].part", "", "which part of it", "a part was kept from the fit"),
    )


EXPECTED = (
    *under("horizons[].noise_floor", ERRORS, "expected of this ship: "),
    JsonKey(
        "horizons[].noise_floor.of",
        "",
        "what it rests on: sensors, sensors and structure, or reference voyages",
    ),
    JsonKey(
        "horizons[].noise_floor.limit95",
        "-",
        "times the expected error that 95 % of healthy voyages stay below",
        PROOF,
    ),
    JsonKey(
        "horizons[].noise_floor.widened",
        "-",
        "factor by which these voyages leave what the references sailed",
        PROOF,
    ),
)


def paths(value: Any, path: str = "") -> Iterator[str]:
    """The paths of a JSON value's leaves; an empty list or object is none."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from paths(inner, f"{path}.{key}".lstrip("."))
    elif isinstance(value, list):
        for inner in value:
            yield from paths(inner, f"{path}[]")
    else:
        yield path


def unknown_paths(keys: tuple[JsonKey, ...], result: Mapping[str, Any]) -> list[str]:
    """Paths of a result that a table does not have."""
    known = re.compile("|".join(_pattern(k.path) for k in keys))
    return sorted({p for p in paths(result) if not known.fullmatch(p)})


def absent_keys(keys: tuple[JsonKey, ...], result: Mapping[str, Any]) -> list[str]:
    """Keys that every result should have and this one lacks."""
    there = set(paths(result))
    every = [k.path for k in keys if not k.when]
    return [p for p in every if not any(re.fullmatch(_pattern(p), path) for path in there)]


def _pattern(path: str) -> str:
    """A path with `*` for a name; a last `*` stands for all that is below."""
    body = re.escape(path).replace(r"\*", r"[^.\[\]]+")
    return body[: -len(r"[^.\[\]]+")] + ".+" if path.endswith(".*") else body
