"""`twin replay --to-bus`: a recorded voyage through the loop, and what the twin says of it onto a bus, for
viewers.

The sensors' own messages are not sent: no other twin on that bus may take a recording for the sea."""

import sys
from pathlib import Path

from twin.errors import TwinError, UsageError
from twin.live.keelson.zenoh_bus import ZenohBus
from twin.live.keelson.zenoh_config import BusSettings
from twin.live.log_replay import Summary, replay
from twin.live.paced import FASTEST, KEYS, SLOWEST, Player
from twin.live.replay_record import ReplayRecord
from twin.live.signals.config import Settings
from twin.num import as_given


def replay_onto_bus(
    log: str | Path,
    settings: Settings,
    output: str | Path | None = None,
    speed: float = 1.0,
    record: ReplayRecord | None = None,
) -> Summary:
    """The voyage on the bus of these settings; TwinError when that bus cannot be opened now. UsageError: a
    speed that is out of range."""
    if not SLOWEST <= speed <= FASTEST:
        raise UsageError(
            f"--speed {as_given(speed)}: {as_given(SLOWEST)} to {as_given(FASTEST)} times the voyage's own."
        )
    with ZenohBus(BusSettings.of(settings), []) as bus:
        if (alarm := bus.state.alarm) and not settings["bus.router"]:
            raise TwinError(alarm.partition("; trying on")[0])
        where = settings["bus.router"] or settings["bus.listen"] or " ".join(settings["bus.connect"])
        _say(f"{Path(log).name} on {where}, {as_given(speed)} times as fast. {KEYS}; watch it: twin view")
        if alarm:
            _say(alarm)
        with Player(speed, _say).attended() as player:
            return replay(log, settings, output, bus=bus, player=player, record=record)


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
