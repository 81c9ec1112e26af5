"""Instruments that lie to the loop that the service builds: how soon it is said, and how often the promise
stood while an error was beyond it."""

import math
from collections.abc import Sequence
from copy import deepcopy
from typing import Any, NamedTuple

import numpy as np

from bench import bench_output
from bench.assumptions import BEGIN_S, STEP_S, WALL
from bench.instrument_lies import rows_of
from bench.lie_kinds import LIES, Lie, Row
from bench.promised_bound import promised_bound
from bench.reference import SeaCase, simulate
from bench.sea_disturbance import sailed
from twin.live.build import loop_of
from twin.live.clock import Instant
from twin.live.inbox import Played
from twin.live.loop import Loop
from twin.live.outbox import Outbox
from twin.live.publish import Publisher
from twin.live.signals.config import Settings
from twin.live.signals.readings import Reading
from twin.study.reference.split import low_frequency, window

SECONDS, LIE_AT_S = 500.0, 180.0


def _off(name: str, by: float) -> Lie:
    return Lie(f"{name} {by:+g}", 120.0, lambda row, since_s, memory: row.update({name: row[name] + by}))


def _times(name: str, factor: float, words: str) -> Lie:
    return Lie(words, 120.0, lambda row, since_s, memory: row.update({name: row[name] * factor}))


def _frozen(row: Row, since_s: float, memory: dict[str, float]) -> None:
    for name in ("north_m", "east_m"):
        if row[name] == row[name]:
            row[name] = memory.setdefault(name, row[name])


OTHERS = (
    _off("yaw_rate_degps", 0.2),
    _off("sway_velocity_mps", 0.5),
    _off("heading_true_north_deg", 10.0),
    _off("north_m", 200.0),
    Lie("positions frozen", 10.0, _frozen),
    _times("propeller_rate_rpm", 1.2, "shaft feedback 20 % too high"),
    _times("rudder_angle_deg", -1.0, "rudder feedback of the other sign"),
    _times("surge_velocity_mps", 1.943844, "speed over ground in knots"),
    _times("yaw_rate_degps", 57.29578, "rate of turn 57 times too large"),
)


class LieNoticed(NamedTuple):
    """One lie: seconds to the first new word (None: none came), the word, the share of the ticks since with a
    promise, the share of all ticks since with a promise that was wrong, the greatest error over its bound in
    a tick with a promise."""

    lie: str
    said_s: float | None
    word: str
    inside: float
    wrong: float
    worst: float


def lies(hull: str, weather: str, only: Sequence[Lie] = (*LIES, *OTHERS)) -> list[LieNoticed]:
    """Every lie on one voyage of the reference sea; the first part of it is sailed once."""
    (recording,) = simulate([SeaCase(hull, "zigzag_10", weather, seed=23, duration_s=SECONDS)], STEP_S)
    rows, voyage = list(rows_of(recording)), sailed(recording)
    n = window(voyage.T_p, STEP_S) if voyage.H_s > 1e-3 else 1  # without waves all motion is the ship's own
    truth, first = low_frequency(voyage.nu, n), round(LIE_AT_S / STEP_S)
    loop = loop_of(Settings({"ship.file": hull}), Played([]), Outbox(Publisher(), "twin", "ship"), None)
    before = set[str]()
    for k in range(first):
        tick = heard(loop, rows[k], k)
        if k > first - 300:
            before |= {_kind(reason) for reason in tick.reasons}
    last = truth.shape[1] - 2 * n
    made = []
    for lie in (None, *only):
        copied = deepcopy(loop, {id(x): x for x in (loop.ship, loop.learned.residual)})
        made.append(one(copied, lie, rows, truth, first, last, before))
        bench_output.tell(str(made[-1]))
    return made


def one(
    loop: Loop,
    lie: Lie | None,
    rows: list[Row],
    truth: np.ndarray,
    first: int,
    last: int,
    before: set[str],
) -> LieNoticed:
    """The rest of the voyage under one lie."""
    memory, said_s, word = dict[str, float](), None, ""
    begins_s = 0.0 if not lie or lie.since is None else math.nan
    ticks = inside = wrong = 0
    worst = 0.0
    for k in range(first, last):
        row, t = dict(rows[k]), (k - first) * STEP_S
        if lie:
            lie.tell(row, t, memory)
            if begins_s != begins_s and _begun(lie, row, rows[k]):
                begins_s = t
        tick = heard(loop, row, k)
        new = [reason for reason in tick.reasons if _kind(reason) not in before]
        if lie is None:  # what is said of true instruments tells nothing of a lie
            before |= {_kind(reason) for reason in new}
        if new and said_s is None:
            said_s, word = (t - begins_s if begins_s == begins_s else 0.0), new[0]
        e = loop.observer.estimate
        error = np.abs(np.array((e.u, e.v, e.r)) - truth[:, k]) / promised_bound(loop)
        ticks += 1
        if tick.certificate.inside:
            inside += 1
            wrong += bool(np.any(error > 1.0))
            worst = max(worst, float(np.max(error)))
    return LieNoticed(lie.name if lie else "none", said_s, word, inside / ticks, wrong / ticks, worst)


def _begun(lie: Lie, row: Row, true: Row) -> bool:
    """Whether the lie is as large as from which it counts."""
    return lie.since is not None and abs(row[lie.since[0]] - true[lie.since[0]]) > lie.since[1]


def heard(loop: Loop, row: Row, k: int) -> Any:
    """One tick on one row."""
    now_s = BEGIN_S + k * STEP_S
    loop.ears.next = [  # type: ignore[attr-defined]
        Reading(name, x % 360.0 if name == "heading_true_north_deg" else x, WALL + now_s, now_s, "ship")
        for name, x in row.items()
        if x == x and name in loop.sensors.gates
    ]
    return loop.tick(Instant(k, now_s, WALL + now_s))


def _kind(reason: str) -> str:
    """A reason without its numbers."""
    return "".join(c for c in reason if not c.isdigit())[:40]
