"""What the step would take on a Cortex-A72 at 1.5 GHz, the paper's board: the time here by a published ratio.

No board was at hand. By published single-thread results a current x86-64 server core is 2.6 to 6.8 times as
fast as that core; the geometric mean is taken and both ends are printed with it. Beside it stands one anchor
that was run on the board and is run here too (nbody.py).
"""

from math import sqrt
from pathlib import Path
from typing import Any

from bench.tick import nbody

FACTOR_LOW, FACTOR_HIGH = 2.6, 6.8
FACTOR = round(sqrt(FACTOR_LOW * FACTOR_HIGH), 2)
A72 = "0xd08"  # CPU part of a Cortex-A72 in /proc/cpuinfo
SOURCE = (
    "published single-thread ratios of x86-64 cores to a Cortex-A72 at 1.5 GHz, x2.6 to x6.8, and their "
    "geometric mean; no board was measured: the true value may lie anywhere in this range"
)


def is_cortex_a72(cpuinfo: str) -> bool:
    """Whether a /proc/cpuinfo is that of the target itself."""
    return any(line.startswith("CPU part") and line.rstrip().endswith(A72) for line in cpuinfo.splitlines())


def estimate(median_us: float, p999_us: float, cpuinfo: str | None = None) -> dict[str, Any]:
    """The `cortex_a72` part of `twin-bench --json`; on a Cortex-A72 itself the factors are 1."""
    here = is_cortex_a72(_cpuinfo() if cpuinfo is None else cpuinfo)
    low, mid, high = (1.0, 1.0, 1.0) if here else (FACTOR_LOW, FACTOR, FACTOR_HIGH)
    return {
        "factor_low": low,
        "factor": mid,
        "factor_high": high,
        "step_ms_median": round(median_us * mid * 1e-3, 3),
        "step_ms_median_range": [round(median_us * low * 1e-3, 3), round(median_us * high * 1e-3, 3)],
        "step_ms_p999": round(p999_us * mid * 1e-3, 3),
        "step_ms_p999_range": [round(p999_us * low * 1e-3, 3), round(p999_us * high * 1e-3, 3)],
        "source": "measured on this Cortex-A72" if here else SOURCE,
    }


def anchor() -> dict[str, float]:
    """One program run here and, by a published figure, on the board."""
    here = nbody.step_us()
    board = nbody.PI_4_US
    return {
        "nbody_us": round(here, 2),
        "nbody_us_cortex_a72": round(board, 2),
        "ratio": round(board / here, 2),
    }


def _cpuinfo() -> str:
    path = Path("/proc/cpuinfo")
    return path.read_text() if path.exists() else ""
