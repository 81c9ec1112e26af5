"""The same picture in a terminal: a page that is redrawn, or now and then a line where there is none."""

import time
from textwrap import wrap
from typing import Any, TextIO

from twin.live.terminal import BOLD, CLEAR_SCREEN, DIM, LINE_S, PAGE_S, PLAIN, WIDTH
from twin.num import as_given

OLD = "\x1b[7m"  # reversed
ORIGINS = {"live": "", "replay": "RECORDED, replayed", "log": "RECORDED"}


class Text:
    """`show(frame)` each frame; draws only when it is time."""

    def __init__(self, stream: TextIO, pages: bool | None = None):
        self.stream = stream
        self.pages = stream.isatty() if pages is None else pages
        self._next_s: float | None = None

    def show(self, frame: dict[str, Any], now_s: float) -> None:
        """Write the frame, when it is time for the next page or line."""
        if self._next_s is not None and now_s < self._next_s:
            return
        self._next_s = now_s + (PAGE_S if self.pages else LINE_S)
        self.stream.write(CLEAR_SCREEN + page(frame) + "\n" if self.pages else line(frame) + "\n")
        self.stream.flush()


def page(frame: dict[str, Any]) -> str:
    """Everything, for a terminal of 78 columns."""
    head = [f"{BOLD}{_title(frame)}{PLAIN}", "─" * WIDTH]
    if old := _old(frame["feed"]):
        head.append(f"{OLD} {old:<{WIDTH - 2}} {PLAIN}")
    if not frame["feed"]["heard"]:
        return "\n".join(head)
    mode = frame["mode"]
    blocks = [*head, f"{BOLD}{mode['name'].upper()}{PLAIN}: {mode['words']}", "", *_states(frame), ""]
    blocks += _actuators(frame["actuators"])
    blocks += [*_ahead(frame["ahead"]), "", *_forces(frame["forces"]), "", _water(frame), ""]
    blocks += [*_alarms(frame["alarms"]), "", *_instruments(frame["instruments"]), "", _pace(frame["pace"])]
    return "\n".join(blocks)


def line(frame: dict[str, Any]) -> str:
    """The same in one line."""
    old = _old(frame["feed"])
    if not frame["feed"]["heard"]:
        return old
    pairs = [f"{s['name']} {_pair(s)} {s['unit']}" for s in frame["states"][:4]]
    known, learned = frame["forces"]["rows"]
    unit = frame["forces"]["unit"]
    said = [
        clock(frame["wall_s"]),
        frame["mode"]["name"],
        *pairs,
        f"known {as_given(known['X'])}/{as_given(known['Y'])} {unit}",
    ]
    said += [
        f"learned {as_given(learned['X'])}/{as_given(learned['Y'])} {unit}",
        f"alarms {len(frame['alarms'])}",
    ]
    recorded = ORIGINS.get(frame["ship"]["origin"], "").partition(",")[0]
    return " | ".join([*filter(None, [recorded, old]), *said])


def clock(wall_s: float) -> str:
    """UTC of the twin's own clock."""
    try:
        return time.strftime("%H:%M:%S", time.gmtime(wall_s))
    except (OverflowError, ValueError, OSError):
        return "--:--:--"


def _old(feed: dict[str, Any]) -> str:
    """What stands over a picture that is not live, "" over one that is."""
    if feed["over"]:
        return f"THE LOG IS OVER: what stands here is {feed['silent_s']:.0f} s old"
    if not feed["heard"]:
        return f"NOTHING HEARD YET on {feed['name']} ({feed['silent_s']:.0f} s)"
    return f"NOTHING HEARD FOR {feed['silent_s']:.0f} s: what stands here is old" if feed["silent"] else ""


def _title(frame: dict[str, Any]) -> str:
    ship = frame["ship"]
    origin = ORIGINS.get(ship["origin"], ship["origin"])
    name = ship["ship"] or "unnamed ship"
    right = f"{origin}  {clock(frame['wall_s'])} UTC" if "wall_s" in frame else ""
    return f"{name}{right:>{max(WIDTH - len(name), 1)}}"


def _states(frame: dict[str, Any]) -> list[str]:
    rows = [f"{DIM}{'':<26}{'measured':>12}{'estimate':>12}{'1 sigma':>12}{'age':>10}{PLAIN}"]
    for state in frame["states"]:
        name = f"{state['name']} [{state['unit']}]"
        numbers = (_number(state[part], state["decimals"]) for part in ("measured", "estimate", "sigma"))
        age = "lost" if state["lost"] else f"{state['age']:.1f} s" if state["age"] is not None else "-"
        rows.append(f"{name:<26}" + "".join(f"{text:>12}" for text in numbers) + f"{age:>10}")
    return rows


def _actuators(channels: list[dict[str, Any]]) -> list[str]:
    """A line for each channel of an actuator, "" behind the last."""
    rows = []
    for c in channels:
        value = c["words"] if c["value"] is None else f"{c['value']:.1f} {c['unit'].replace('-', '')}".strip()
        age = "-" if c["age"] is None else f"{c['age']:.1f} s"
        rows.append(f"{c['name'][:30]:<32}{value:>36}{age:>10}")
    return [*rows, ""] if rows else []


def _ahead(ahead: dict[str, Any] | None) -> list[str]:
    if not ahead:
        return ["no prediction"]
    old = f" OLD, said {ahead['age']:.0f} s ago" if ahead["old"] else ""
    return [
        f"in {p['horizon']:.0f} s: heading {p['psi']:.0f}°, {p['distance']:.0f} m off towards "
        f"{p['bearing']:03.0f}°, {_surely(p)}{old}"
        for p in ahead["shown"]
    ]


def _surely(p: dict[str, Any]) -> str:
    """What reference voyages promise, else one sigma."""
    tube = p["tube"]
    if tube and tube["level"]:
        return (
            f"± {tube['along']:.0f} m along, ± {tube['across']:.0f} m across, ± {tube['heading']:.1f}° "
            f"({tube['level']} %, on {tube['voyages']} voyages, helm held)"
        )
    if tube and p["sn"] is None:
        return f"no promise, {tube['words']}"
    why = f"; no promise, {tube['words']}" if tube else ""
    return f"± {_number(p['sn'], 0)} m north, ± {_number(p['se'], 0)} m east ({p['status']}{why})"


def _forces(forces: dict[str, Any]) -> list[str]:
    unit, moment = forces["unit"], forces["moment_unit"]
    heads = (f"ahead [{unit}]", f"starb. [{unit}]", f"turn [{moment}]")
    rows = [f"{DIM}{'force':<26}" + "".join(f"{h:>16}" for h in heads) + PLAIN]
    for row in forces["rows"]:
        share = f"  {forces['share']} %" if row["name"] == "learned" else ""
        rows.append(f"{row['name']:<26}{row['X']:>+16.1f}{row['Y']:>+16.1f}{row['N']:>+16.1f}{share}")
    return rows


def _water(frame: dict[str, Any]) -> str:
    wind, stream = frame["wind"], frame["stream"]
    blows = f"wind {wind['speed']:.1f} m/s from {wind['from']:03.0f}°" if wind else "wind not measured"
    flows = f"stream {stream['speed']:.2f} kn towards {stream['to']:03.0f}°" if stream else "stream not known"
    return f"{blows}   {flows}"


def _alarms(alarms: list[dict[str, Any]]) -> list[str]:
    rows = []
    for alarm in alarms[:6]:
        state = "over" if alarm["over"] else "    "
        state += ", seen" if alarm["acknowledged"] else ""
        text = f"{clock(alarm['since_s'])} {state:<10} {alarm['text']}"
        rows += wrap(text, WIDTH, max_lines=2, placeholder=" ...", subsequent_indent=" " * 20)
    return [*(rows or ["no alarms"]), *([f"and {len(alarms) - 6} more"] if len(alarms) > 6 else [])]


def _instruments(instruments: list[dict[str, Any]]) -> list[str]:
    words = [f"{i['name']} {_age(i)}" for i in instruments]
    return wrap("ages: " + ", ".join(words), WIDTH, subsequent_indent="      ", break_on_hyphens=False)


def _age(instrument: dict[str, Any]) -> str:
    age = "?" if instrument["age"] is None else f"{instrument['age']:.1f} s"
    return age if instrument["level"] == "good" else f"{age} ({instrument['words']})"


def _pace(pace: dict[str, Any]) -> str:
    slack = "no deadline" if pace["slack_ms"] is None else f"{pace['slack_ms']:.0f} ms left of each period"
    counts = f"skipped {pace['overruns']}, refused {pace['rejected']}, log lost {pace['log_dropped']}"
    return f"{DIM}{as_given(pace['rate'])} Hz, {slack}; {counts}{PLAIN}"


def _pair(state: dict[str, Any]) -> str:
    return "/".join(_number(state[part], state["decimals"]) for part in ("measured", "estimate"))


def _number(value: float | None, decimals: int) -> str:
    return "-" if value is None else f"{value:.{decimals}f}"
