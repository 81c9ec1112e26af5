"""What a column may be of one of several actuators: `RPM PS`, `left_motor_pwm`, `azimuth 2 angle (deg)`.

The words of its name say whose it is (a side, a place, a number) and what (turns, pulse width, command,
thrust, angle, pitch); the range of its cells tells a pulse width from a share. A person confirms it.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from twin.recording.formats.name_words import words_of

SIDES = ("port", "starboard", "center")
ENDS = {"fore": "fore", "forward": "fore", "fwd": "fore", "front": "fore", "bow": "bow", "aft": "aft",
        "rear": "aft", "back": "aft", "stern": "stern"}  # fmt: skip
KINDS = ("azimuth", "azipod", "pod", "thruster", "waterjet", "jet", "outboard", "engine", "motor",
         "actuator", "propeller", "prop", "shaft", "esc", "servo", "screw", "channel", "output", "rudder",
         "tunnel")  # fmt: skip
ALIKE = {
    "prop": "propeller",
    "screw": "propeller",
    "esc": "motor",
    "azipod": "azimuth",
    "pod": "azimuth",
    "waterjet": "jet",
}
PLAIN = (
    "engine",
    "motor",
    "propeller",
    "shaft",
    "thruster",
    "actuator",
    "rudder",
)  # of a side: the side is name enough
NOT_IT = frozenset((
    "temperature", "temp", "voltage", "volt", "current", "amp", "amps", "power", "torque", "fuel", "load",
    "pressure", "oil", "battery", "charge", "error", "err", "dot", "acc", "zero", "point", "bias", "std",
    "cov", "status", "heading", "course", "latitude", "longitude", "wind", "distance", "bank", "time",
    "stamp", "timestamp", "hours", "alarm", "mode", "flag", "yaw", "roll", "pitch_deg", "seconds", "secs",
    "north", "east", "min", "max", "trim", "sigma", "capacity", "consumption", "coolant", "boost",
))  # fmt: skip
ORDERS = frozenset((
    "ref", "reference", "setpoint", "sp", "desired", "des", "target", "order", "cmd", "command", "goal",
    "demand", "soll", "throttle",
))  # fmt: skip
PWM, SHARE = (700.0, 2300.0), 1.5
PREFERRED = (
    "rate_rpm",
    "pwm_us",
    "command",
    "thrust_n",
)  # of what says how hard one pushes: the first that is there


class ActuatorGuess(NamedTuple):
    """Whose, which of its channels, the unit the name states, whether an order, how many words spoke."""

    owner: str
    last: str
    unit: str
    order: bool
    score: float

    @property
    def channel(self) -> str:
        """The channel's whole name."""
        return f"{self.owner}.{self.last}"


def guess_actuator(name: str, values: np.ndarray, stated: str = "") -> ActuatorGuess | None:
    """What a column may be of an actuator; None when its name says no owner or its cells suit no channel.
    `values` (N,) in the unit of the file."""
    words, unit = words_of(name)
    unit = unit or stated
    good = values[np.isfinite(values)]
    if not good.size or (set(words) & NOT_IT):
        return None
    owner, of_kind = owner_of(words)
    last, spoke = channel_of(words, unit, good)
    if not owner or not last or (spoke == 0 and not of_kind):
        return None
    return ActuatorGuess(owner, last, unit, bool(set(words) & ORDERS), spoke + of_kind - 0.05 * len(words))


def owner_of(words: Sequence[str]) -> tuple[str, int]:
    """(name of the actuator, 1 when a kind is among the words): ends, side, kind and number, as far as they
    are said; "" when neither a side, an end nor a number is."""
    side = next((w for w in words if w in SIDES), "")
    end = next((ENDS[w] for w in words if w in ENDS), "")
    kind, number = "", ""
    for i, w in enumerate(words):
        if w in KINDS:
            behind = next((x for x in words[i + 1 :] if x.isdigit()), "")
            if not kind or (behind and not number):
                kind, number = ALIKE.get(w, w), behind
    if not kind:
        number = next((w for w in words if w.isdigit()), "")
    if not side and not end and not number:
        return "", 0
    shown = "" if (side or end) and (kind in PLAIN or not kind) else kind
    return "_".join(
        x for x in (end, side, shown or ("" if side or end else "actuator"), number if not side else "") if x
    ), int(bool(kind))


def channel_of(words: Sequence[str], unit: str, good: np.ndarray) -> tuple[str, int]:
    """(last part of the channel, how many words said so) by words, unit and range; "" when nothing says it.
    `good` (N,) finite, in the unit of the file."""
    there, most = set(words), float(np.max(np.abs(good)))
    turning = {"azimuth", "angle", "steering", "nozzle", "rudder"} & there
    if {"rpm", "rps", "revs", "revolutions", "turns"} & there or unit in ("rpm", "1/min", "1/s", "Hz"):
        return "rate_rpm", 2
    if "pitch" in there and unit in ("%", ""):
        return "pitch_ratio", 1
    if (
        {"pwm", "pulse"} & there
        or unit == "us"
        or (PWM[0] <= float(good.min()) and most <= PWM[1] and "throttle" in there)
    ):
        return ("pwm_us", 2) if most > 100.0 else ("command", 1)
    if {"force", "thrust"} & there or unit in ("N", "kN"):
        return "thrust_n", 2
    if (
        unit in ("deg", "rad")
        or ("angle" in there)
        or ({"steering", "rudder"} & there and "speed" not in there)
    ):
        return "angle_deg", 1 + bool(turning)
    if "speed" in there and {"motor", "engine", "shaft", "propeller", "prop", "thruster", "screw"} & there:
        return "rate_rpm", 1
    driven = {
        "thruster",
        "throttle",
        "motor",
        "cmd",
        "command",
        "esc",
        "servo",
        "output",
        "control",
        "channel",
        "actuator",
        "propeller",
        "prop",
        "engine",
    } & there
    if driven and not turning:
        if PWM[0] <= float(good.min()) and most <= PWM[1] and most > 100.0:
            return "pwm_us", 1
        if most <= SHARE or unit == "%":
            return "command", 1
        if most <= 100.5 and "throttle" in there:
            return "command", 1
        if "thruster" in there and not unit:
            return "thrust_n", 0
    return ("angle_deg", 1) if turning else ("", 0)


def keys_of(found: ActuatorGuess, values: np.ndarray) -> dict[str, Any]:
    """Unit of a map's entry, where it is not the channel's own. `values` (N,) in the unit of the file."""
    most = float(np.nanmax(np.abs(values)))
    if found.last == "command" or found.last == "pitch_ratio":
        return {"unit": "%"} if found.unit == "%" or most > SHARE + 1.0 else {}
    if found.last == "rate_rpm" and found.unit in ("1/s", "Hz", "rad/s"):
        return {"unit": found.unit}
    if found.last == "thrust_n" and found.unit == "kN":
        return {"unit": "kN"}
    if found.last == "angle_deg" and (found.unit == "rad" or (not found.unit and 0.05 < most < 3.2)):
        return {"unit": "rad"}
    return {}
