"""twin.toml: the keys of one table (keys.py), read and checked, and nothing else is accepted.

The table is at once the check, the documentation and the example file (`example()`). Without a file the twin
runs on the bundled KVLCC2 and listens on this computer only.
"""

import re
import tomllib
from pathlib import Path
from typing import Any

from twin.errors import SettingsError, did_you_mean
from twin.live.signals.channels import BY_NAME
from twin.live.signals.keys import BY_KEY, KEYS, SOURCES, Key
from twin.num import as_given

MAX_BYTES = 1_000_000  # of a settings file
MAX_TEXT = 4096  # characters of a text
MAX_LIST = 64  # entries of a list


class Settings:
    """The values by key, as in `settings["loop.rate_hz"]`; `sources` says who may speak for which channel."""

    def __init__(
        self,
        values: dict[str, Any] | None = None,
        sources: dict[str, str] | None = None,
        where: str = "defaults",
    ):
        self._values = {key.name: key.default for key in KEYS} | (values or {})
        self.sources = sources or {}
        self.where = where

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def but(self, name: str, value: Any) -> "Settings":
        """The same settings with one value changed."""
        return Settings(self._values | {BY_KEY[name].name: value}, self.sources, self.where)


def load(path: str | Path | None) -> Settings:
    """The settings of a file, or the defaults without one; SettingsError names file, line, key and what to
    do."""
    if path is None:
        return Settings()
    text = _text(Path(path))
    try:
        table = tomllib.loads(text)
    # also a number of thousands of digits, or a thousand brackets
    except (ValueError, RecursionError) as error:
        raise SettingsError(f"{path}: not valid TOML: {_line(error)}. Correct that line.") from None
    return _settings(table, Lines(str(path), text))


def example() -> str:
    """A whole twin.toml with every key at its default."""
    lines, section = [], ""
    for key in KEYS:
        head, _, name = key.name.partition(".")
        if head != section:
            lines += [""] * bool(section) + [f"[{head}]"]
            section = head
        limits = f", {as_given(key.low)} to {as_given(key.high)}" if key.high != float("inf") else ""
        note = f"{key.doc}{f' [{key.unit}]' if key.unit else ''}{limits}"
        lines.append(f"{name} = {_toml(key.default)}  # {note}")
    return "\n".join(
        [
            *lines,
            "",
            f"[{SOURCES}]  # who may speak for a channel, when two do",
            '# heading_true_north_deg = "gyro"',
            "",
        ]
    )


class Lines:
    """Where in a file a key stands, for complaints."""

    def __init__(self, path: str, text: str):
        self.path = path
        self._at: dict[str, int] = {}
        section = ""
        for number, line in enumerate(text.splitlines(), start=1):
            if found := re.match(r"\s*\[+\s*([\w.\-]+)", line):
                section = found[1]
                self._at.setdefault(section, number)
            elif found := re.match(r"\s*([\w.\-]+)\s*=", line):
                self._at.setdefault(f"{section}.{found[1]}" if section else found[1], number)

    def say(self, key: str) -> str:
        """Where a key stands, for a message: file and line."""
        return f"{self.path}, line {self._at[key]}" if key in self._at else self.path


def _text(path: Path) -> str:
    try:
        with open(path, "rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a name with a zero byte in it
        why = getattr(error, "strerror", None) or error
        raise SettingsError(
            f"{str(path)!r}: cannot be read ({why}). Check the path and its permissions."
        ) from None
    if len(data) > MAX_BYTES:
        raise SettingsError(f"{path}: more than {MAX_BYTES} bytes cannot be settings. Check the path.")
    if data.startswith((b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff")):
        raise SettingsError(f"{path}: begins with a byte-order mark. Save it as plain UTF-8 without BOM.")
    try:
        text = data.decode()
    except UnicodeDecodeError as error:
        raise SettingsError(
            f"{path}: byte {error.start} is not UTF-8. Save it as plain UTF-8 text."
        ) from None
    if not text.strip():
        raise SettingsError(
            f"{path}: is empty. Leave out --config for the defaults, or write at least [ship] file = ..."
        )
    return text


def _settings(table: dict[str, Any], lines: Lines) -> Settings:
    values: dict[str, Any] = {}
    sections = sorted({name.partition(".")[0] for name in BY_KEY} | {SOURCES})
    for section, entries in table.items():
        if section not in sections or not isinstance(entries, dict):
            raise SettingsError(
                f"{lines.say(section)}: no section is called "
                f"[{_short(section)}].{did_you_mean(section[:60], sections)}"
            )
        if section == SOURCES:
            continue
        for name, value in entries.items():
            key = BY_KEY.get(f"{section}.{name}")
            if key is None:
                known = [k.partition(".")[2] for k in BY_KEY if k.startswith(f"{section}.")]
                raise SettingsError(
                    f"{lines.say(f'{section}.{name}')}: [{section}] has no key "
                    f"{_short(name)}.{did_you_mean(name[:60], known)}"
                )
            values[key.name] = _value(key, value, lines)
    return Settings(values, _sources(table.get(SOURCES, {}), lines), lines.path)


def _value(key: Key, value: Any, lines: Lines) -> Any:
    """The value in its kind and range."""
    where = f"{lines.say(key.name)}: {key.name}"
    if key.kind is list:
        if not isinstance(value, list) or len(value) > MAX_LIST:
            like = _toml(key.default or ["tcp/10.0.0.2:7447"])
            raise SettingsError(
                f"{where} = {_short(value)}: a list of at most {MAX_LIST} is needed, as in {like}."
            )
        number = bool(key.default) and isinstance(key.default[0], float)
        values = [_number(key, v, where) if number else _word(v, where) for v in value]
        if number and not values:
            raise SettingsError(f"{where} is empty: give at least one number, as in {_toml(key.default)}.")
        return values
    if key.kind is bool:
        if not isinstance(value, bool):
            raise SettingsError(f"{where} = {_short(value)}: true or false is needed.")
        return value
    return _word(value, where) if key.kind is str else _number(key, value, where)


def _number(key: Key, value: Any, where: str) -> Any:
    unit = f" in {key.unit}" if key.unit else ""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SettingsError(
            f"{where} = {_short(value)}: a plain number{unit} is needed, as in {_toml(key.default)}."
        )
    if key.kind is int and not isinstance(value, int):
        raise SettingsError(f"{where} = {_short(value)}: a whole number is needed.")
    if not key.low <= value <= key.high:
        raise SettingsError(
            f"{where} = {_short(value)}{f' {key.unit}' if key.unit else ''} lies outside {as_given(key.low)} "
            f"to {as_given(key.high)} ({key.doc})."
        )
    return value if key.kind is int else float(value)


def _word(value: Any, where: str) -> str:
    if not isinstance(value, str):
        raise SettingsError(f'{where} = {_short(value)}: a text in quotes is needed, as in "...".')
    if len(value) > MAX_TEXT or not value.isprintable():
        raise SettingsError(
            f"{where} = {_short(value)}: a text of one line, with at most {MAX_TEXT} characters, is needed."
        )
    return value


def _short(value: Any) -> str:
    """A value as it can stand in a message: one line, not longer than a few words."""
    if isinstance(value, int) and not isinstance(value, bool) and abs(value) >= 10**18:
        return f"a whole number of about {round(value.bit_length() * 0.30103)} digits"
    said = as_given(value) if isinstance(value, float) else repr(value)
    return said if len(said) <= 60 else f"{said[:56]} ..."


def _line(error: BaseException) -> str:
    return " ".join(str(error).split())[:200]


def _sources(table: dict[str, Any], lines: Lines) -> dict[str, str]:
    if not isinstance(table, dict):
        raise SettingsError(f"{lines.path}: [{SOURCES}] must be a table of channels.")
    for channel, source in table.items():
        where = lines.say(f"{SOURCES}.{channel}")
        if channel not in BY_NAME:
            raise SettingsError(
                f"{where}: no channel is called {_short(channel)}.{did_you_mean(channel[:60], BY_NAME)}"
            )
        _word(source, f"{where}: {channel}")
    return dict(table)


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return (
        '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
        if isinstance(value, str)
        else f"{value!r}"
    )
