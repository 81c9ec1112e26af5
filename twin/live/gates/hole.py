"""When a tick came so late that the instruments' blocks of time end."""

HOLE_S, HOLE_PERIODS = 1.0, 1.5


def is_hole(dt: float, period_s: float) -> bool:
    """Whether a tick [s after the last] came so late that what the instruments would have said in between
    is lost: over a second, and over one and a half of the loop's periods."""
    return not 0.0 < dt <= max(HOLE_S, HOLE_PERIODS * period_s)
