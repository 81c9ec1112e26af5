"""The one way in which a number is told to a person. No power of ten where digits will do.

`num`: what was measured or estimated, to so many significant digits, its known zeros included (2.0, 160).
`as_given`: what was declared, or read off a clock (a setting, a limit, a time), without further zeros (120).
`on_axis`: the marks of an axis, which are declared too.
`readable`: the unit in which a number is told: files and JSON hold radians, and a person reads degrees.
"""

from collections.abc import Mapping, Sequence
from math import floor, inf, isfinite, log10, pi
from typing import Any

LEAST_POWER, GREATEST_POWER = -4, 12  # powers of ten between which a number is told by its digits alone
READABLE = {  # unit in files and JSON -> unit that is told, and what the number is multiplied by
    "rad": ("deg", 180.0 / pi),
    "rad/s": ("deg/s", 180.0 / pi),
    "1/rad": ("1/deg", pi / 180.0),
}
IN_ITS_UNIT = (  # entries beside `unit` that are in that unit
    "value", "sd", "low95", "high95", "lo", "hi", "low", "high", "before", "in_ship_file", "slope",
    "unseen_below",
)  # fmt: skip


def num(value: float, digits: int = 2, sign: bool = False) -> str:
    """`value` to so many significant digits: 2.0 and 160, not 2 and 1.6e+02; `sign`: with its plus, too. What
    is smaller than 1e-4, or not below 1e12, keeps its power of ten."""
    if value == 0.0 or not isfinite(value):
        return "0" if value == 0.0 else str(float(value))
    plus = "+" if sign else ""
    mantissa, _, power = f"{value:{plus}.{digits - 1}e}".partition("e")
    tens = int(power)
    if not LEAST_POWER <= tens < GREATEST_POWER:
        return f"{mantissa}e{tens}"
    return f"{float(f'{mantissa}e{tens}'):{plus}.{max(digits - 1 - tens, 0)}f}"


def as_given(value: float, digits: int = 6) -> str:
    """A declared number as it was given, to at most so many significant digits, its whole part whole: 120,
    0.5, 1000000000."""
    whole = 10.0**digits <= abs(value) < 10.0**GREATEST_POWER
    head, point, power = (f"{value:.0f}" if whole else num(value, digits)).partition("e")
    return (head.rstrip("0").rstrip(".") if "." in head else head) + point + power


def on_axis(marks: Sequence[float]) -> list[str]:
    """The marks of an axis, evenly apart, each with as many digits as tell it from the next: 57.69, 57.7."""
    step = abs(marks[1] - marks[0]) if len(marks) > 1 else inf
    return [as_given(v, max(4, floor(log10(abs(v) / step or 1.0)) + 4)) for v in marks]


def percent(share: float) -> str:
    """A share or a probability, in whole per cent; one that rounds to nothing has no sign."""
    return f"{100.0 * share:z.0f} %"


def readable(number: Mapping[str, Any]) -> dict[str, Any]:
    """A number with its `unit`, its interval and what else is in that unit, as a person reads it: angles in
    degrees. `unit` is empty where there is none."""
    unit, k = READABLE.get(number["unit"], (number["unit"], 1.0))
    sizes = {key: k * number[key] for key in IN_ITS_UNIT if number.get(key) is not None}
    return dict(number) | sizes | {"unit": "" if unit == "-" else unit}


def clock(seconds: float) -> str:
    """Seconds since a voyage began as nobody takes them for a time of day: 9 min 32 s."""
    minutes, rest = divmod(int(seconds), 60)
    return f"{minutes} min {rest} s" if rest else f"{minutes} min"
