"""What an ArduPilot boat's own settings say of its outputs: which is a thruster, of which side, which is
turned about."""

import re
from typing import Any

from twin.num import as_given
from twin.recording.formats.signals import Signals

SKID = {73: "port", 74: "starboard"}  # SERVOn_FUNCTION: throttle left and right
STEERING, THROTTLE = 26, 70
OUTPUT = re.compile(r"(?:RCOU|SERVO_OUTPUT_RAW)[\d.]*\.(?:C|servo)(\d+)$")


def setting(settings: dict[str, float], m: Any) -> None:
    """One of the boat's settings, as both kinds of log hold it."""
    name = getattr(m, "Name", None) or getattr(m, "param_id", "")
    value = getattr(m, "Value", getattr(m, "param_value", None))
    name = name.decode("latin-1") if isinstance(name, bytes) else str(name)
    if value is not None and name.startswith(("SERVO", "RC")):
        settings[name.strip("\0 ")] = float(value)


def by_function(out: Signals, settings: dict[str, float]) -> None:
    """The outputs that the boat's settings call left and right throttle become its thrusters; one whose
    setting says reversed is turned about its stop. Of a steered boat it is said which output does what."""
    for name, series in out.series.items():
        found = OUTPUT.search(name)
        if found is None:
            continue
        no = found[1]
        function, stop = int(settings.get(f"SERVO{no}_FUNCTION", 0)), settings.get(f"SERVO{no}_TRIM", 1500.0)
        if function not in (*SKID, THROTTLE, STEERING):
            continue
        if settings.get(f"SERVO{no}_REVERSED", 0.0) > 0.0:
            for i, pulse in enumerate(series.values):
                series.values[i] = 2.0 * stop - pulse if pulse else pulse
            out.notes.append(f"{name} is turned about {as_given(stop, 5)} us, for SERVO{no}_REVERSED is set")
        if function in SKID:
            series.quantity, series.rank = f"{SKID[function]}.pwm_us", 0
            off = as_given((stop - 1500.0) / 400.0, 4)
            zero = f"{name}: SERVO{no}_TRIM is {as_given(stop, 5)}: zero = {off} in the ship file"
            out.notes += [zero] * (stop != 1500.0)
        else:
            out.settings[name] = outputs_range(settings, no) | {"function": float(function)}


def outputs_range(settings: dict[str, float], no: str) -> dict[str, float]:
    """Least, stop and greatest pulse of an output [us]."""
    usual = {"MIN": 1100.0, "TRIM": 1500.0, "MAX": 1900.0}
    return {k.lower(): settings.get(f"SERVO{no}_{k}", v) for k, v in usual.items()}
