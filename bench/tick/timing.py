"""Quantiles of step times, and a hot loop to measure in. Standard library only: the loop measures itself."""

import gc
import time
from collections.abc import Callable, Sequence

QUANTILES = {"median": 0.5, "p99": 0.99, "p999": 0.999, "max": 1.0}


def quantiles(samples: Sequence[float], names: Sequence[str] = tuple(QUANTILES)) -> dict[str, float]:
    """The named quantiles (nearest rank: a value that was measured, never one in between)."""
    ordered = sorted(samples)
    last = len(ordered) - 1
    return {name: round(float(ordered[min(last, int(QUANTILES[name] * len(ordered)))]), 2) for name in names}


def hot_us(function: Callable[[], object], repeats: int, warm_up: int = 20) -> list[float]:
    """Microseconds of each of `repeats` calls, one after the other, without garbage collection."""
    for _ in range(warm_up):
        function()
    gc.collect()
    gc.disable()
    now, times = time.perf_counter_ns, []
    try:
        for _ in range(repeats):
            start = now()
            function()
            times.append((now() - start) * 1e-3)
    finally:
        gc.enable()
    return times
