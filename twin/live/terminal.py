"""What one tick knew, for a terminal: a page that is redrawn, or now and then a line where there is none."""

from textwrap import wrap
from typing import Any, TextIO

from twin.num import as_given, num
from twin.physics.maths import total

WIDTH = 78
PAGE_S, LINE_S = 0.25, 5.0  # between two pages, between two lines
CLEAR_SCREEN, BOLD, DIM, PLAIN = "\x1b[H\x1b[J", "\x1b[1m", "\x1b[2m", "\x1b[0m"
STATES = (  # name on the page, field of Row and State, unit, decimals
    ("heading", "heading_true_north_deg", "deg", 1),
    ("turning", "yaw_rate_degps", "deg/s", 2),
    ("speed ahead", "surge_velocity_mps", "m/s", 2),
    ("speed aside", "sway_velocity_mps", "m/s", 2),
    ("north", "north_m", "m", 1),
    ("east", "east_m", "m", 1),
)


class View:
    """`show(tick)` each tick; draws only when it is time. `total_s` is how long the demo lasts."""

    def __init__(self, stream: TextIO, title: str, total_s: float, log: str, pages: bool | None = None):
        self.stream, self.title, self.total_s, self.log = stream, title, total_s, log
        self.pages = stream.isatty() if pages is None else pages
        self.ticks, self.ahead = 0, list[str]()
        self._start_s: float | None = None
        self._next_s = 0.0

    def show(self, tick: Any) -> None:
        """Count a tick, and write it when it is time for the next page or line."""
        self.ticks += 1
        if self._start_s is None:
            self._start_s = tick.time_s
        self.ahead = ahead(tick) or self.ahead
        if tick.time_s < self._next_s:
            return
        self._next_s = tick.time_s + (PAGE_S if self.pages else LINE_S)
        seconds = tick.time_s - self._start_s
        if self.pages:
            self.stream.write(
                CLEAR_SCREEN + page(tick, self.title, seconds, self.total_s, self.log, self.ahead) + "\n"
            )
        else:
            self.stream.write(line(tick, seconds) + "\n")
        self.stream.flush()


def page(tick: Any, title: str, seconds: float, total_s: float, log: str, before: list[str]) -> str:
    """Everything a newcomer should see of one tick; `before`: the newest prediction, which few ticks hold."""
    right = f"{seconds:.0f} of {total_s:.0f} s"
    head = f"{BOLD}{title}{PLAIN}{right:>{WIDTH - len(title)}}"
    blocks = [head, "─" * WIDTH, _pace(tick), "", *_states(tick), "", *_forces(tick), ""]
    blocks += [*before, "", f"{BOLD}{tick.mode}{PLAIN}", *_because(tick)]
    return "\n".join([*blocks, f"{DIM}log: {log}{PLAIN}"])


def line(tick: Any, seconds: float) -> str:
    """The same in one line."""
    known = _sum(tick.known)
    pairs = [f"{name} {_pair(tick, field, n)} {unit}" for name, field, unit, n in STATES[:3]]
    said = [f"{seconds:5.0f} s", tick.mode, f"{as_given(tick.rate_hz)} Hz", _time(tick), *pairs]
    said += [f"known {_three(known)}", f"learned {_three(_force(tick.learned))}", f"refused {tick.rejected}"]
    return " | ".join(said)


def _pace(tick: Any) -> str:
    counts = f"skipped {tick.overruns}   refused {tick.rejected}   log lost {tick.log_dropped}"
    return f"{as_given(tick.rate_hz)} Hz   {_time(tick)}   {counts}"


def _time(tick: Any) -> str:
    if not tick.HasField("step_us"):
        return "first step"
    return f"step {tick.step_us / 1e3:.1f} ms, {tick.slack_us / 1e3:.0f} ms left"


def _states(tick: Any) -> list[str]:
    rows = [f"{DIM}{'':<24}{'measured':>12}{'estimate':>12}{'1 sigma':>12}{PLAIN}"]
    for name, field, unit, n in STATES:
        numbers = (_number(part, field, n) for part in (tick.measured, tick.estimate, tick.sigma))
        rows.append(f"{name + ' [' + unit + ']':<24}" + "".join(f"{text:>12}" for text in numbers))
    return rows


def _forces(tick: Any) -> list[str]:
    rows = [f"{DIM}{'force':<24}{'ahead [N]':>12}{'aside [N]':>12}{'turn [N m]':>12}{PLAIN}"]
    rows += [_force_row(f"known: {force.name}", _force(force)) for force in tick.known]
    rows.append(_force_row("known, all", _sum(tick.known)))
    share = f"  {100 * tick.learned.share:.0f} % of all"
    return [*rows, f"{BOLD}{_force_row('learned', _force(tick.learned))}{PLAIN}{share}"]


def _force_row(name: str, force: tuple[float, ...]) -> str:
    return f"{name:<24}" + "".join(f"{num(x, 4, sign=True):>12}" for x in force)


def ahead(tick: Any) -> list[str]:
    """Where it will be; a round of predictions is done only now and then."""
    return [
        f"in {p.horizon_s:.0f} s: heading {_number(p.state, 'heading_true_north_deg', 0)} deg, "
        f"{_number(p.state, 'north_m', 0)} m north, {_number(p.state, 'east_m', 0)} m east "
        f"(± {_number(p.sigma, 'north_m', 1)} m, {p.status})"
        for p in tick.predictions
    ]


def _because(tick: Any) -> list[str]:
    """Why this mode, and what is not as it should be; four reasons at most, two lines each."""
    rows = [wrap(why, WIDTH - 4, max_lines=2, placeholder=" ...") for why in tick.reasons[:4]]
    return [("  " if i else "- ") + text for row in rows for i, text in enumerate(row)]


def _pair(tick: Any, field: str, decimals: int) -> str:
    return f"{_number(tick.measured, field, decimals)}/{_number(tick.estimate, field, decimals)}"


def _number(message: Any, field: str, decimals: int) -> str:
    return f"{getattr(message, field):.{decimals}f}" if message.HasField(field) else "-"


def _force(message: Any) -> tuple[float, float, float]:
    return message.X_N, message.Y_N, message.N_Nm


def _sum(forces: Any) -> tuple[float, ...]:
    return tuple(total(parts) for parts in zip((0.0, 0.0, 0.0), *map(_force, forces), strict=True))


def _three(force: tuple[float, ...]) -> str:
    return "/".join(num(x, 3, sign=True) for x in force)
