"""What is wrong, since when, and whether somebody has acknowledged it.

An alarm stands while the twin says it; one that is over stays until it is acknowledged. A number in its words
may change and it is still the same alarm."""

import re
from collections.abc import Iterable
from typing import Any

KEPT = 40  # alarms that are over and not acknowledged; the oldest go first
HOLD_S = 3.0  # an alarm that comes and goes within this time is one
# no digit of a name, such as gyro2 or gnss/1: two instruments have two alarms
_NUMBER = re.compile(r"(?<![\w/'-])[-+]?\d[\d.]*(?:e[-+]?\d+)?")


def key_of(text: str) -> str:
    """What stays the same in an alarm's words."""
    return _NUMBER.sub("#", text)


class Alarms:
    """The alarms of one twin."""

    def __init__(self) -> None:
        self._known: dict[str, dict[str, Any]] = {}

    def observe(self, reasons: Iterable[str], now_s: float, wall_s: float) -> None:
        """What the twin says now; `wall_s` is its own UTC."""
        for text in reasons:
            name = key_of(text)
            alarm = self._known.get(name)
            if alarm is None or alarm["over"]:
                alarm = self._known[name] = {"key": name, "since_s": wall_s, "acknowledged": False}
            alarm.update(text=text, over=False, last_s=now_s)
        for name, alarm in list(self._known.items()):
            alarm["over"] = now_s - alarm["last_s"] > HOLD_S
            if alarm["over"] and alarm["acknowledged"]:
                del self._known[name]
        over = [name for name, alarm in self._known.items() if alarm["over"]]
        for name in over[: max(len(over) - KEPT, 0)]:
            del self._known[name]

    def acknowledge(self, name: str) -> bool:
        """Whether there was such an alarm; "" means all."""
        named = [a for a in self._known.values() if not name or a["key"] == name]
        for alarm in named:
            alarm["acknowledged"] = True
            if alarm["over"]:
                del self._known[alarm["key"]]
        return bool(named)

    def listed(self) -> list[dict[str, Any]]:
        """Those that stand and are not acknowledged first, the newest first."""
        wanted = sorted(self._known.values(), key=lambda a: (a["acknowledged"], a["over"], -a["since_s"]))
        return [{name: x for name, x in alarm.items() if name != "last_s"} for alarm in wanted]
