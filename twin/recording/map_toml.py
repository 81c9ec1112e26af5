"""A proposed map as TOML."""

from typing import Any

from twin.recording.mapping import FRAMED, HEADING

NEEDED = (HEADING, "rudder_angle_deg", "propeller_rate_rpm")


def quoted(channel: str) -> str:
    """A channel as a key of TOML: with its actuator's name it needs marks."""
    return f'"{channel}"' if "." in channel else channel


def lacking(columns: Any) -> list[str]:
    """A line that says what was not found and is needed; none when nothing is."""
    needed = NEEDED[:1] if any("." in name for name in columns) else NEEDED
    missing = [name for name in needed if name not in columns]
    place = any(
        all(n in columns for n in pair)
        for pair in (("latitude_deg", "longitude_deg"), ("north_m", "east_m"), FRAMED)
    )
    missing += [] if place else ["a position or a velocity"]
    return ["", f"# NOT FOUND, and needed: {', '.join(missing)}"] if missing else []


def toml(entry: Any) -> str:
    """An entry as TOML on one line: a name alone, or a table."""
    if not isinstance(entry, dict):
        return value(entry)
    if set(entry) == {"column"}:
        return value(entry["column"])
    return "{ " + ", ".join(f"{k} = {value(v)}" for k, v in entry.items()) + " }"


def value(v: Any) -> str:
    """A TOML value; JSON's strings are TOML's, but for the letters it escapes otherwise."""
    import json

    if isinstance(v, list | tuple):
        return "[" + ", ".join(value(x) for x in v) + "]"
    said = json.dumps(v, ensure_ascii=False) if isinstance(v, str | bool) else repr(v)
    return said.replace("\x7f", "\\u007f")
