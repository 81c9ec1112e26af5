"""The likeliest of a few numbers that are tried in order: slower gears, stronger waves."""

from collections.abc import Callable, Sequence


def likeliest_in_order(
    likely: Callable[[float], float], begun: tuple[float, float], others: Sequence[float]
) -> tuple[float, float]:
    """Log evidence of the likeliest, and it. `begun`: those of the one before `others`, which are tried as
    long as none is less likely than the one before it: evidence has one peak along them."""
    best = begun
    for value in others:
        if (score := likely(value)) < best[0]:
            break
        best = score, value
    return best
