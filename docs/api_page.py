"""docs/api.md and docs/json.md, made of the signatures, docstrings and keys in the code:

python docs/api_page.py
"""

import dataclasses
import inspect
import re
from functools import cached_property
from pathlib import Path
from typing import Any

import twin
from twin.api.json_keys import KEYS
from twin.cli import VERBS

DOCS = Path(__file__).resolve().parent
HEAD = """# Python interface

Made by `python docs/api_page.py`; a test holds it current. Everything is a name of `twin` and loads when it
is first used. One order of arguments everywhere: ship, voyages, then keywords. Errors are `twin.errors`:
`DataError`, `SettingsError`, `UsageError`, each one line that says what, where and what to do. The whole
story in cells: [tutorials/notebook.py](tutorials/notebook.py). The JSON behind `to_dict()`:
[json.md](json.md). For tables and plots: `pip install 'shiptwin[notebook]'`.

```python
import twin

ship = twin.Ship.load("alma.toml")
calm = twin.read_voyages("calm/*.mcap")
june = twin.read_voyage("june.csv", map="map.toml")
fit = twin.calibrate(ship, calm)
found = twin.diagnose(fit.ship, june)
```
"""
JSON_HEAD = """# JSON of the verbs

Made by `python docs/api_page.py` of `twin/api/json_keys.py`; tests hold it against real answers. The same
object comes from `--json FILE` and from a result's `to_dict()`. In a path `[]` stands for the entries of a
list and `*` for a name: a channel, an effect, a parameter. Empty lists and objects are there although nothing
stands in them; numbers that are not known are null. A unit "of the channel" stands in the channel's name. A
key without a "when" is in every answer. `twin.simulate` has no command, so that its object comes from
`to_dict()` alone.
"""
GROUPS = {
    "Files": ("read_voyage", "read_voyages", "suggest_map"),
    "Verbs": (
        "first_model",
        "check_voyage",
        "instruments",
        "calibrate",
        "tube",
        "compare",
        "diagnose",
        "fleet",
        "add",
        "remove",
        "simulate",
        "catalogue",
        "check_effect",
    ),
    "Results": (
        "FirstModel",
        "VoyageCheck",
        "InstrumentCheck",
        "Calibration",
        "TubeCalibration",
        "Comparison",
        "Diagnosis",
        "Fleet",
        "Update",
        "Simulation",
        "EffectCheck",
    ),
    "Ship and voyage": ("Ship", "Voyage"),
}


def signature(thing: Any) -> str:
    """Its signature with short type names and without `self`."""
    text = re.sub(r"(: |-> )'([^']*)'", r"\1\2", str(inspect.signature(thing)))  # a name as text
    text = re.sub(r"\b(?:[a-z_]+\.)+(?=[A-Z])", "", text)
    return re.sub(r"\((self|cls)(, )?", "(", text)


def doc(thing: Any) -> str:
    return inspect.getdoc(thing) or ""


def members(owner: type) -> list[tuple[str, Any]]:
    """Public methods and properties that the class and its bases in twin declare, in their order."""
    found: dict[str, Any] = {}
    for base in reversed([b for b in owner.__mro__ if b.__module__.startswith("twin.")]):
        for name, member in vars(base).items():
            kinds = (property, cached_property, classmethod, staticmethod)
            if not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, kinds)):
                found[name] = member
    return [(name, found[name]) for name in found if doc(found[name])]


def entry(name: str, member: Any, owner: type) -> str:
    """One line of a class: name, signature, docstring."""
    if isinstance(member, property | cached_property):
        head = f"`.{name}`"
    else:
        head = f"`.{name}{signature(getattr(owner, name))}`"
    return f"* {head}: {' '.join(doc(member).split())}"


def section(name: str) -> list[str]:
    """One public name."""
    thing = getattr(twin, name)
    if not inspect.isclass(thing):
        call = f"twin.{name}{signature(thing)}"
        return [f"### {name}", "", f"```python\n{call}\n```", "", doc(thing), ""]
    fields = [f.name for f in dataclasses.fields(thing) if f.repr] if dataclasses.is_dataclass(thing) else []
    out = [f"### {name}", "", doc(thing), ""]
    if fields:
        out += [f"Fields: {', '.join(f'`{f}`' for f in fields)}.", ""]
    return [*out, *(entry(n, m, thing) for n, m in members(thing)), ""]


def api() -> str:
    """The whole of docs/api.md."""
    left = set(twin.PUBLIC) - {name for names in GROUPS.values() for name in names}
    if left:
        raise SystemExit(f"docs/api_page.py: no group has {', '.join(sorted(left))}")
    lines = [HEAD]
    for title, names in GROUPS.items():
        lines += [f"## {title}", "", *(line for name in names for line in section(name))]
    return "\n".join(lines).rstrip() + "\n"


def json() -> str:
    """The whole of docs/json.md."""
    lines = [JSON_HEAD]
    for verb, keys in KEYS.items():
        title = f"## twin {verb}" if verb in VERBS else f"## twin.{verb}"
        lines += [title, "", "| key | unit | meaning | when |", "|---|---|---|---|"]
        lines += [f"| `{k.path}` | {k.unit} | {k.meaning} | {k.when} |" for k in keys]
        lines.append("")
    return "\n".join(lines).rstrip() + "\n"


PAGES = {"api.md": api, "json.md": json}

if __name__ == "__main__":
    for name, made in PAGES.items():
        (DOCS / name).write_text(made())
