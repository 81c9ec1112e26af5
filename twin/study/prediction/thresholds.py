"""`--fail-above METRIC=VALUE`: a limit that a script holds the twin to."""

import argparse
import math
from collections.abc import Sequence
from typing import Any

from twin.errors import did_you_mean
from twin.num import as_given, num
from twin.study.prediction import score
from twin.study.track.track import MEASURED

AT_HORIZON = (*score.NAMES.values(), "noise_units")  # may have @SECONDS behind
METRICS = (
    *AT_HORIZON,
    *(f"unexplained_force.{axis}" for axis in ("surge", "sway", "yaw")),
    "learned_share",
    *(f"channels.{column}.mae" for column in MEASURED.values()),
)


def threshold(text: str) -> tuple[str, float]:
    """METRIC=VALUE, refused before any work when there is no such metric or the value is no finite number."""
    name, _, value = text.partition("=")
    bare, at, seconds = name.partition("@")
    try:
        limit = float(value)
        if at:
            positive(seconds)
        if not math.isfinite(limit):
            raise ValueError(value)
    except (ValueError, argparse.ArgumentTypeError):
        raise argparse.ArgumentTypeError(
            f"{text!r}: METRIC=VALUE is needed, such as position_mae_m=50"
        ) from None
    known = AT_HORIZON if at else METRICS
    if bare not in known:
        raise argparse.ArgumentTypeError(f"no metric is called {bare!r}.{did_you_mean(bare, known)}")
    return name, limit


def metric(result: dict[str, Any], name: str) -> float | None:
    """The number that --fail-above speaks of; None when these voyages do not give it."""
    name, _, at = name.partition("@")
    row = next(
        (r for r in result["horizons"] if at and r["horizon_s"] == float(at)),
        None if at else result["horizons"][-1],
    )
    if row is not None and name == "noise_units":
        return score.in_noise(row)
    value: Any = row if row is not None and name in score.NAMES.values() else result
    for part in name.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    return float(value) if isinstance(value, (int, float)) else None


def passed(result: dict[str, Any], limits: Sequence[tuple[str, float]]) -> list[str]:
    """Sentences about the thresholds that are not met."""
    out = []
    for name, limit in limits:
        value = metric(result, name)
        if value is None:
            out.append(f"{name} is not in the result (see twin compare --help)")
        elif value > limit:
            out.append(f"{name} = {num(value, 4)} is above {as_given(limit)}")
    return out


def positive(text: str) -> float:
    """Seconds from the command line; argparse says what is wrong with them."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < 86400.0:
        raise argparse.ArgumentTypeError(f"{text!r}: seconds between 0 and 86400 are needed")
    return value
