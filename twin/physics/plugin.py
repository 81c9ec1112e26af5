"""Effects that installed packages bring: a broken one is left out and named, and never ends what somebody
else asked for.

An effect that is let in must be declared in full and must work on floats, and on arrays where numpy is loaded
(the study works on whole voyages at once): an `if` on a value, or a function of the math module, does not.
"""

import sys
from dataclasses import fields
from math import isfinite
from typing import TYPE_CHECKING, Any

from twin.num import as_given

from .effect import Effect, Flow, Force, Lag, SensorFault
from .particulars import ShipNumbers
from .state import Situation

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint  # heavy, and never used on board

GROUP = "twin.effects"
KINDS = (Force, Flow, Lag, SensorFault)
MOMENT = {  # a moment at sea in which every field is filled and nothing is zero
    "x": 120.0,
    "y": -40.0,
    "psi": 0.6,
    "u": 4.2,
    "v": -0.5,
    "r": 0.012,
    "u_r": 4.0,
    "v_r": -0.4,
    "delta": 0.2,
    "n": 1.2,
    "t": 700.0,
    "wind_speed": 9.0,
    "wind_to": 2.0,
    "depth": 40.0,
    "H_s": 2.0,
    "T_p": 8.0,
    "wave_to": 1.5,
    "draught": 18.0,
    "bank_port": 200.0,
    "bank_starboard": 150.0,
    "phi": 0.05,
    "p": 0.01,
    "u_dot": 0.01,
    "v_dot": -0.02,
    "r_dot": 0.001,
}
TRIAL_SHIP = ShipNumbers(  # a full tanker of 320 m
    "a usual ship",
    L_pp=320.0,
    B=58.0,
    T=20.8,
    m=3.2e8,
    C_b=0.81,
    x_G=11.2,
    I_z=2.0e12,
    U_0=7.97,
    D_P=9.86,
    A_R=112.5,
    A_F=1160.0,
    A_L=3500.0,
)
READ = ("x", "y", "psi", "u", "v", "r", "u_r", "v_r", "wind_to")


class Refused(Exception):
    """Why an effect is left out, in words for who wrote it."""


def loaded(point: "EntryPoint") -> type[Effect]:
    """The effect of an entry point; Refused when it cannot be used."""
    try:
        effect = point.load()
    except (Exception, SystemExit) as error:  # whatever somebody else's file does when it is read
        raise Refused(f"{point.value} cannot be imported ({said(error)})") from None
    declared(effect, point.name)
    works(effect)
    return effect  # type: ignore[no-any-return]


def declared(effect: Any, name: str) -> None:
    """Refused when the declaration is not complete or contradicts itself."""
    if not (isinstance(effect, type) and issubclass(effect, KINDS)):
        raise Refused("it is no subclass of Force, Flow, Lag or SensorFault")
    if effect.__name__ != name:
        raise Refused(f"its class is called {effect.__name__}: class and entry point must have one name")
    # which a dataclass makes up
    if not (effect.__doc__ or "").strip() or (effect.__doc__ or "").startswith(f"{name}("):
        raise Refused("it has no docstring, which is its sentence in a report")
    unknown = sorted(set(effect.needs) - {f.name for f in fields(Situation)})
    if unknown:
        raise Refused(f"needs names {', '.join(unknown)}, which no Situation has")
    try:
        params = effect.params()
    except TypeError:
        raise Refused("a number of it is not declared with param(...)") from None
    if not params:
        raise Refused("it has no parameter, so that nothing can be fitted")
    for p in params:
        if not all(isinstance(x, int | float) and isfinite(x) for x in (p.default, p.lo, p.hi, p.sd, p.null)):
            raise Refused(f"{p.name}: default, lo, hi, sd and null must be finite numbers")
        if not (p.lo < p.hi and p.lo <= p.null <= p.hi and p.lo <= p.default <= p.hi):
            raise Refused(
                f"{p.name}: null {as_given(p.null)} and default {as_given(p.default)} must lie in its box "
                f"[{as_given(p.lo)}, {as_given(p.hi)}]"
            )
        if not p.sd > 0.0:
            raise Refused(f"{p.name}: the width of its prior, sd, must be positive (it is {as_given(p.sd)})")


def works(effect: type[Effect]) -> None:
    """Refused when it fails at a usual moment on a usual ship, for floats or for arrays."""
    ship = TRIAL_SHIP
    numpy = sys.modules.get("numpy")
    try:
        numbers = answer(effect.plausible(ship), Situation(**MOMENT), ship)
    except (Exception, SystemExit) as error:
        raise Refused(f"it fails at a moment with every input ({said(error)})") from None
    if not all(isinstance(x, int | float) and isfinite(x) for x in numbers):
        raise Refused(f"at a moment with every input it answers {numbers}, which are no finite numbers")
    if numpy is None or effect.kind == "Lag":  # which is stepped with one number after the other
        return
    try:
        many = answer(
            effect.plausible(ship),
            Situation(**{k: numpy.array([x, 0.9 * x]) for k, x in MOMENT.items()}),
            ship,
        )
        alike = all(
            abs(float(numpy.broadcast_to(a, 2)[0]) - x) <= 1e-9 * (1.0 + abs(x))
            for a, x in zip(many, numbers, strict=True)
        )
    except (Exception, SystemExit) as error:
        raise Refused(
            f"it does not work on arrays ({said(error)}): never branch on a value, and take "
            "functions from twin.physics.maths"
        ) from None
    if not alike:
        raise Refused("on arrays it answers otherwise than on the same numbers one by one")


def answer(effect: Any, s: Situation, ship: Any) -> tuple[Any, ...]:
    """What an effect makes of a moment: force, water, an actuator's next place, or what the instruments
    say."""
    if effect.kind == "Force":
        return tuple(effect.force(s, effect.alter(ship)))
    if effect.kind == "Flow":
        return tuple(effect.water(s, ship))
    if effect.kind == "Lag":
        return effect.step(s.delta, 2.0 * s.delta, 0.1), effect.dead_time()
    read = effect.read(s, ship)
    return tuple(getattr(read, name) for name in READ)


def said(error: BaseException) -> str:
    """An error in one short line."""
    return " ".join(f"{type(error).__name__}: {error}".split())[:160]
