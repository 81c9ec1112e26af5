"""`twin effects --check`: is an effect of one's own fit for the loop, for whole voyages, for the training and
for the certificate?

Each question is asked alone and answered with what is wrong in one line, so that all of them can be mended at
once."""

import importlib.metadata
import importlib.util
import sys
from collections.abc import Callable, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from twin.errors import SettingsError
from twin.num import as_given
from twin.physics.effect import Effect
from twin.physics.effects import BUILT_IN, UNNAMED
from twin.physics.interval import Interval
from twin.physics.plugin import GROUP, KINDS, MOMENT, READ, Refused, answer, declared, said
from twin.physics.ship import Ship, load
from twin.physics.state import Situation

# change sign in a mirror
ATHWART = {"y", "psi", "v", "r", "v_r", "delta", "wind_to", "wave_to", "phi", "p", "v_dot", "r_dot"}
SIGNS = {
    "Force": (1, -1, -1),
    "Flow": (1, -1, 1, 1, 1, 1, 1, 1),
    "Lag": (-1, 1),
    "SensorFault": tuple(-1 if n in ATHWART else 1 for n in READ),
}
MOMENT_AT_REST = dict.fromkeys(MOMENT, 0.0) | {
    "depth": 40.0,
    "T_p": 8.0,
    "draught": 18.0,
    "bank_port": 200.0,
    "bank_starboard": 150.0,
}


class Answer(NamedTuple):
    """One question: `ok` None when it could not be asked."""

    question: str
    ok: bool | None
    text: str

    def line(self) -> str:
        """The answer as a line for a terminal."""
        mark = "?" if self.ok is None else "ok" if self.ok else "WRONG"
        return f"  {mark:6}{self.question}{': ' * bool(self.text)}{self.text}"


def find_to_check(name: str) -> type[Effect]:
    """A built-in effect, an installed one however broken, or the one effect of a file NAME.py; SettingsError
    when there is none."""
    if name.endswith(".py"):
        return of_file(Path(name))
    known = {e.__name__: e for e in (*BUILT_IN, *UNNAMED)}
    if name in known:
        return known[name]
    points = [p for p in importlib.metadata.entry_points(group=GROUP) if p.name == name]
    if not points:
        raise SettingsError(
            f"--check {name}: no effect of that name is installed, and it is no file NAME.py."
        )
    return _read(name, points[0].load)  # type: ignore[no-any-return]


def of_file(path: Path) -> type[Effect]:
    """The one effect that a file declares itself. SettingsError: it is no such file, or declares none or
    several."""
    if not path.is_file():
        raise SettingsError(f"--check {path}: there is no such file.")
    spec = importlib.util.spec_from_file_location(f"checked_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise SettingsError(f"--check {path}: is no Python file.")
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    loader = spec.loader
    _read(str(path), lambda: loader.exec_module(module))
    mine = [
        x
        for x in vars(module).values()
        if isinstance(x, type) and issubclass(x, KINDS) and x.__module__ == module.__name__
    ]
    if len(mine) != 1:
        raise SettingsError(
            f"--check {path}: declares {len(mine)} effects "
            f"({', '.join(e.__name__ for e in mine) or 'none'}); one a file."
        )
    return mine[0]


def _read(name: str, action: Callable[[], Any]) -> Any:
    try:
        return action()
    except (Exception, SystemExit) as error:
        raise SettingsError(f"--check {name}: cannot be imported ({said(error)}). Mend that first.") from None


def check(effect: type[Effect], ship: Ship | None = None) -> list[Answer]:
    """Every question of QUESTIONS on a usual ship; where the declaration is wrong nothing else can be
    asked."""
    ship = ship or load("kvlcc2")
    try:
        declared(effect, getattr(effect, "__name__", "?"))
    except Refused as why:
        return [Answer("declared in full", False, str(why))]
    return [
        Answer("declared in full", True, ""),
        *(_answer_to(words, question, effect, ship) for words, question in QUESTIONS.items()),
    ]


def answers_as_json(effect: type[Effect], answers: Sequence[Answer]) -> dict[str, Any]:
    """The answers as plain types."""
    return {"schema_version": 1, "effect": effect.__name__, "answers": [a._asdict() for a in answers]}


def _answer_to(
    words: str, question: Callable[[type[Effect], Ship], str | None], effect: type[Effect], ship: Ship
) -> Answer:
    try:
        wrong = question(effect, ship)
    except ImportError as error:
        return Answer(words, None, f"{error.name} is not installed")
    except (Exception, SystemExit) as error:
        return Answer(words, False, said(error))
    return Answer(words, not wrong, wrong or "")


def busy(effect: type[Effect], ship: Ship) -> Effect:
    """The effect with every number away from where it does nothing."""
    return effect(
        **{
            p.name: (p.default if p.default != p.null else p.null + 0.7 * p.sd) * p.scale(ship)
            for p in effect.params()
        }
    )


def null(effect: type[Effect], ship: Ship) -> str | None:
    """Does it do nothing at the value that is declared so? What is wrong in words; None: nothing."""
    absent, s = effect.absent(ship), Situation(**MOMENT)
    if effect.kind == "SensorFault":
        shown = absent.read(s, ship)  # type: ignore[attr-defined]
        other = [
            f.name
            for f in fields(Situation)
            if getattr(shown, f.name) != getattr(Situation(**MOMENT), f.name)
        ]
        return f"at null it changes {', '.join(other)}" if other else None
    if effect.kind == "Lag":
        got = absent.step(0.1, 0.3, 0.1), absent.dead_time()  # type: ignore[attr-defined]
        return (
            None
            if abs(got[0] - 0.3) < 1e-12 and got[1] == 0.0
            else (f"at null the order 0.3 rad gives {as_given(got[0])} rad after {as_given(got[1])} s")
        )
    got = answer(absent, s, ship)
    if effect.kind == "Force" and absent.alter(ship) != ship:  # type: ignore[attr-defined]
        return "at null it alters the ship"
    return (
        None
        if all(x == 0.0 for x in got)
        else (f"at null it gives {tuple(float(x) for x in got)} instead of zeros")
    )


def finite(effect: type[Effect], ship: Ship) -> str | None:
    """Does it give numbers? The same."""
    got = answer(busy(effect, ship), Situation(**MOMENT), ship)
    return None if np.isfinite(np.array(got, float)).all() else f"it gives {got}"


def _moments() -> tuple[list[Situation], dict[str, list[float]]]:
    states = [
        {**MOMENT, "u": MOMENT["u"] + d, "r": MOMENT["r"] * (1.0 + d), "delta": d, "psi": MOMENT["psi"] + d}
        for d in (0.0, 0.1, -0.7)
    ]
    return [Situation(**m) for m in states], {k: [m[k] for m in states] for k in MOMENT}


def _as_floats(effect: type[Effect], ship: Ship, made: Callable[[list[float]], Any]) -> str | None:
    one, (moments, stacked) = busy(effect, ship), _moments()
    floats = np.array([answer(one, s, ship) for s in moments], float)
    many = answer(one, Situation(**{k: made(v) for k, v in stacked.items()}), ship)
    wide = np.stack([np.broadcast_to(np.asarray(x, float), len(moments)) for x in many], 1)
    off = np.abs(wide - floats) > 1e-9 * np.abs(floats).max() + 1e-15
    return (
        (f"it answers {as_given(wide[off][0])} where one by one it answers {as_given(floats[off][0])}")
        if off.any()
        else None
    )


def arrays(effect: type[Effect], ship: Ship) -> str | None:
    """Does it give arrays what it gives floats? The same."""
    return _as_floats(effect, ship, np.array)


def tensors(effect: type[Effect], ship: Ship) -> str | None:
    """Does it give tensors what it gives floats? The same."""
    torch = importlib.import_module("torch")
    return _as_floats(effect, ship, lambda v: torch.tensor(v, dtype=torch.float64))


def intervals(effect: type[Effect], ship: Ship) -> str | None:
    """Do intervals enclose what it gives a number? The same."""
    if effect.kind not in ("Force", "Flow"):
        return None  # no force for the certificate to bound
    one, point = busy(effect, ship), Situation(**MOMENT)
    boxes = answer(
        one, Situation(**{k: Interval(x - 0.01 * abs(x), x + 0.01 * abs(x)) for k, x in MOMENT.items()}), ship
    )
    for box, x in zip(boxes, answer(one, point, ship), strict=True):
        low, high = (box.lo, box.hi) if isinstance(box, Interval) else (box, box)
        if not low <= x <= high:
            return f"the box [{as_given(low)}, {as_given(high)}] does not hold the number {as_given(x)}"
    return None


def mirrored(effect: type[Effect], ship: Ship) -> str | None:
    """Does the mirrored ship feel the mirrored force? The same."""
    mirror = {k: -x if k in ATHWART else x for k, x in MOMENT.items()}
    mirror |= {"bank_port": MOMENT["bank_starboard"], "bank_starboard": MOMENT["bank_port"]}
    signs = np.array(SIGNS[effect.kind])

    def off(one: Effect, turned: frozenset[str]) -> float:
        wanted = signs * np.array(answer(one, Situation(**MOMENT), ship), float)
        other = one.but(**{n: -getattr(one, n) for n in turned})
        return float(np.abs(np.array(answer(other, Situation(**mirror), ship), float) - wanted).max())

    whole, absent = busy(effect, ship), effect.absent(ship)
    either = [p.name for p in effect.params() if p.lo < 0.0 < p.hi]
    # first each number by itself: a heading changes sign, a length does not
    alone = {n: absent.but(**{n: getattr(whole, n)}) for n in either}
    best = frozenset(n for n, one in alone.items() if off(one, frozenset((n,))) < off(one, frozenset()))
    while either and off(
        whole, nearer := min((best ^ {n} for n in either), key=lambda t: off(whole, t))
    ) < off(whole, best):
        best = nearer
    enough = 1e-9 * np.abs(np.array(answer(whole, Situation(**MOMENT), ship), float)).max() + 1e-15
    return (
        None
        if off(whole, best) <= enough
        else ("what acts to port is not what acts to starboard, whatever signs its numbers have")
    )


def gradient(effect: type[Effect], ship: Ship) -> str | None:
    """Has it a finite gradient at rest? The same."""
    torch = importlib.import_module("torch")
    inputs = {k: torch.tensor(x, dtype=torch.float64, requires_grad=True) for k, x in MOMENT_AT_REST.items()}
    values = {
        p.name: torch.tensor(p.null * p.scale(ship), dtype=torch.float64, requires_grad=True)
        for p in effect.params()
    }
    got = [
        x
        for x in answer(effect(**values), Situation(**inputs), ship)
        if torch.is_tensor(x) and x.requires_grad
    ]
    if not got:
        return None
    slopes = torch.autograd.grad(sum(got), [*inputs.values(), *values.values()], allow_unused=True)
    bad = [
        n
        for n, g in zip([*inputs, *values], slopes, strict=True)
        if g is not None and not bool(torch.isfinite(g))
    ]
    return (
        (
            f"its slope by {', '.join(bad)} is not finite (hypot and positive of twin.physics.maths are "
            "finite there)"
        )
        if bad
        else None
    )


QUESTIONS: dict[str, Callable[[type[Effect], Ship], str | None]] = {
    "finite at a usual moment": finite,
    "null does nothing": null,
    "whole voyages at once (arrays)": arrays,
    "training (tensors)": tensors,
    "certificate (intervals)": intervals,
    "a mirrored ship feels the mirrored force": mirrored,
    "finite slopes for a ship at rest": gradient,
}
