"""The number with which a falling function has a value."""

from collections.abc import Callable


def matching(falling: Callable[[float], float], target: float, lo: float, hi: float) -> float:
    """Where a falling function meets its target, by halving."""
    for _ in range(40):
        middle = 0.5 * (lo + hi)
        lo, hi = (middle, hi) if falling(middle) > target else (lo, middle)
    return 0.5 * (lo + hi)
