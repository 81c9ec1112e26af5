"""The catalogue of effects in words, formulas and numbers, for the terminal, for programs and for
docs/effects.md."""

import inspect
import os
import sys
import textwrap
from collections.abc import Sequence
from typing import Any

import numpy  # noqa: F401 (where it is loaded, an installed effect that does not work on arrays is left out)

from twin.num import as_given, percent
from twin.physics.effect import FORM, Effect, Param
from twin.physics.effects import OF_ACTUATORS, UNNAMED, OfActuator, catalogue, find, of_ship
from twin.physics.ship import Ship
from twin.recording.inputs import INPUTS

KINDS = {
    "Force": "pushes the ship, or changes its inertia",
    "Flow": "changes the water that hull, propeller and rudder feel",
    "Lag": "gives an actuator a state of its own",
    "SensorFault": "leaves the ship alone and changes what an instrument says of it",
}
SCALES = {"force": "F_0", "moment": "F_0 L", "speed": "U_0", "time": "L/U_0", "length": "L"}
SCALES_SAID = (
    "U_0: service speed, L: length between perpendiculars, F_0 = 0.005 rho L T U_0^2, about half "
    "of a ship's resistance."
)


def formula(effect: type[Effect]) -> str:
    """The head of its file: what it means, and the equation."""
    return inspect.cleandoc(sys.modules[effect.__module__].__doc__ or "")


CHANGE = "a diagnosis weighs only a change of it"


def inputs(effect: type[Effect]) -> list[str]:
    """The columns of a voyage without which it is switched off."""
    return [INPUTS.get(name, name) for name in effect.needs]


def _instead(effect: type[Effect]) -> str:
    """What may be recorded in the place of what it needs, in words."""
    return " (or the apparent wind, from which `twin import` finds them)" if "wind_to" in effect.needs else ""


def _attacks(effect: type[Effect]) -> str:
    """How well it is known where along the hull it attacks, in words."""
    return f"within {percent(effect.lever)} of its length of where the form has it (one standard deviation)"


def chosen(name: str | None, ship: Ship | None = None) -> list[type[Effect]]:
    """The effects of this name (a shape without a name and the families of actuators, too), or, without one,
    the catalogue: with a ship, that ship's. SettingsError when there is none."""
    named = [e for e in UNNAMED if e.__name__ == name] or [e for e in OF_ACTUATORS if e.__name__ == name]
    return named or ([find(name)] if name else list((of_ship(ship) if ship else catalogue()).values()))


def as_json(effects: Sequence[type[Effect]], ship: Ship | None = None) -> dict[str, Any]:
    """What is declared of each, as plain types."""
    return {"schema_version": 1, "effects": [as_table(e, ship) for e in effects]}


def as_table(effect: type[Effect], ship: Ship | None = None) -> dict[str, Any]:
    """Everything that is declared of it; with a ship, sizes in SI instead of multiples of the ship's own
    scales."""
    params = []
    for p in effect.params():
        k = p.scale(ship) if ship else 1.0
        sizes = {key: getattr(p, key) * k for key in ("default", "lo", "hi", "sd", "null")} | {"form": p.form}
        only_with = INPUTS.get(p.input) if p.input else None
        times = SCALES[p.of] if p.of and not ship else None
        params.append(
            {"name": p.name, "unit": p.unit, **sizes, "times": times, "input": only_with, "doc": p.doc}
        )
    return {
        "name": effect.__name__,
        "kind": effect.kind,
        "doc": effect.sentence(ship),
        "formula": formula(effect),
        "needs": inputs(effect),
        "needs_ship": list(effect.needs_ship),
        "lever": effect.lever,
        "size": effect.size or None,
        "source": effect.source,
        "parameters": params,
    }


def overview(effects: list[type[Effect]], width: int) -> str:
    """The catalogue on one screen, by kind."""
    lines = []
    name_width = max(len(e.__name__) for e in effects) + 2
    for kind, means in KINDS.items():
        lines += [bold(kind) + f"  {means}"]
        for effect in (e for e in effects if e.kind == kind):
            text = textwrap.wrap(effect.sentence(), width - name_width - 2)
            lines += [
                f"  {effect.__name__:{name_width}}{text[0]}",
                *(" " * (name_width + 2) + more for more in text[1:]),
            ]
        lines += [""]
    return "\n".join([*lines, f"{len(effects)} effects. One in full: twin effects {effects[0].__name__}"])


def one(effect: type[Effect], ship: Ship | None, width: int) -> str:
    """One effect in full."""
    lines = [
        f"{bold(effect.__name__)}  {effect.kind}: {KINDS[effect.kind]}",
        "",
        *textwrap.wrap(effect.sentence(ship), width),
        "",
    ]
    lines += [f"  {line}".rstrip() for line in formula(effect).splitlines()] + [""]
    rows = [
        ("parameter", "unit", "plausible", "box", "prior sd", "meaning"),
        *(row(p, ship) for p in effect.params()),
    ]
    widths = [max(len(r[i]) for r in rows) + 2 for i in range(5)]
    lines += [
        "  " + "".join(f"{cell:{w}}" for cell, w in zip(r, (*widths, 0), strict=True)).rstrip() for r in rows
    ]
    if ship is None and any(p.of for p in effect.params()):
        lines += ["", *(f"  {line}" for line in textwrap.wrap(SCALES_SAID, width - 2))]
    needs = (", ".join(inputs(effect)) or "nothing beyond the ship's own motion") + _instead(effect)
    lines += ["", f"needs     {needs}"] + (
        [f"of a ship {', '.join(effect.needs_ship)}"] if effect.needs_ship else []
    )
    lines += [f"attacks   {_attacks(effect)}"] if effect.lever else []
    lines += [f"found by  twin instruments; {CHANGE}"] if effect.suspected_first else []
    lines += [textwrap.fill(f"source    {effect.source}", width, subsequent_indent=" " * 10)]
    name = effect.__name__ + ".NAME" * (issubclass(effect, OfActuator) and not effect.actuator)
    add = f"next: twin add {name} --ship SHIP.toml --voyage VOYAGE.mcap -o SHIP2.toml"
    mend = "next: mend it, or calibrate again where it is to stay; no ship file holds it"
    return "\n".join([*lines, "", mend if effect in UNNAMED else add])


def row(p: Param, ship: Ship | None) -> tuple[str, str, str, str, str, str]:
    """A parameter in a table: name, unit, plausible size, box, prior width, meaning."""
    k, times = (p.scale(ship), "") if ship else (1.0, f" {SCALES[p.of]}" if p.of else "")
    says = lambda x: as_given(x * k, 4) + (times if x else "")  # noqa: E731
    form = "" if p.form == FORM else f" (its form may be off by {percent(p.form)})"
    return p.name, p.unit, says(p.default), f"{says(p.lo)} .. {says(p.hi)}", says(p.sd), p.doc + form


def bold(text: str) -> str:
    """The text, bold on a terminal."""
    return f"\033[1m{text}\033[0m" if sys.stdout.isatty() and "NO_COLOR" not in os.environ else text


def page(effects: list[type[Effect]]) -> str:
    """docs/effects.md."""
    lines = [
        "# The catalogue of effects",
        "",
        "Made by `twin effects --markdown docs/effects.md`; a test holds it current. Symbols: "
        "[notation](notation.md). "
        "To add one of your own: [tutorial](tutorials/own-effect.md).",
        "",
        f"A size that stands with a letter is a multiple of the ship's own. {SCALES_SAID} Plausible: what "
        "one would "
        "expect where the effect is clearly there (what `twin effects NAME` and a ship file that gives no "
        "number take). Prior sd: how far a "
        "parameter may lie from none before it counts as unlikely; the prior is normal about none, and "
        "one-sided where the box ends there. None "
        "is the ship as `twin calibrate` found it: what acted on the reference voyages alike is part of it, "
        "and not missing.",
        "",
    ]
    for kind, means in KINDS.items():
        lines += [f"## {kind}", "", f"{means.capitalize()}.", ""]
        for effect in (e for e in effects if e.kind == kind):
            lines += _entry(effect)
    lines += [
        "## Known by their form alone",
        "",
        "No members of the catalogue, and not to be added to a ship file: what a repair mends is no part of "
        "a ship, and what is to stay is found by calibrating again. `twin diagnose` asks for them, "
        "so that nothing else is named in their place; where one explains the voyages best the answer is "
        "`unknown`, and what it resembles.",
        "",
    ]
    for effect in UNNAMED:
        lines += _entry(effect)
    return "\n".join(lines)


def _entry(effect: type[Effect]) -> list[str]:
    needs = (
        ", ".join(f"`{name}`" for name in inputs(effect)) or "nothing beyond the ship's own motion"
    ) + _instead(effect)
    if effect.needs_ship:
        needs += f"; of the ship {', '.join(effect.needs_ship)}"
    needs += f". Attacks {_attacks(effect)}" if effect.lever else ""
    needs += f". `twin instruments` looks for it; {CHANGE}" if effect.suspected_first else ""
    rows = [
        f"| `{name}` | {unit} | {size} | {box} | {sd} | {doc.replace('|', '/')} |"
        for name, unit, size, box, sd, doc in (row(p, None) for p in effect.params())
    ]
    return [
        f"### {effect.__name__}",
        "",
        effect.sentence(),
        "",
        "```text",
        formula(effect),
        "```",
        "",
        "| parameter | unit | plausible | box | prior sd | meaning |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        f"Needs {needs}. Source: {effect.source}.",
        "",
    ]
