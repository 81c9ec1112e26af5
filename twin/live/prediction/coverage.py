"""Was the tube right on a voyage that is over? Share of predictions inside, its size, and both in one number:
the interval score (Gneiting & Raftery 2007), which neither a tube that is too narrow nor one that is too wide
makes small.

    score = w + (e - w)/a where e > w, else w        w: half width, e: error, a = 1 - level

Of a place w is the radius of the circle of the ellipse's area, e/w the error over the ellipse in its own
direction.
"""

from collections.abc import Sequence
from math import degrees, hypot, sqrt
from typing import NamedTuple

from twin.live.observer.predict import Region
from twin.live.prediction.judge import VerifiedPrediction
from twin.physics.maths import total


class Coverage(NamedTuple):
    """Predictions of one horizon with a promise, the helm held meanwhile. `voyages`: the fewest that a
    promise rested on; `level`: the lowest that was promised."""

    horizon_s: float
    level: float
    voyages: int
    judged: int
    place_inside: float
    heading_inside: float
    place_radius_m: float
    heading_deg: float
    place_score_m: float
    heading_score_deg: float


class RegionError(NamedTuple):
    """One prediction: half width and error of place [m] and of heading [rad], and what was promised."""

    radius: float
    error: float
    heading: float
    heading_error: float
    level: float
    voyages: int


def entry(j: VerifiedPrediction, region: Region) -> RegionError:
    """Of a prediction that was judged, and what was promised of it."""
    radius = sqrt(region.along_m * region.across_m)
    error = radius * hypot(j.along / region.along_m, j.across / region.across_m)
    return RegionError(radius, error, region.heading, abs(j.heading), region.level, region.voyages)


def coverage(horizon_s: float, entries: Sequence[RegionError]) -> Coverage:
    """The summary of at least one."""
    n, a = len(entries), 1.0 - min(e.level for e in entries)
    return Coverage(
        horizon_s,
        1.0 - a,
        min(e.voyages for e in entries),
        n,
        total([float(e.error <= e.radius) for e in entries]) / n,
        total([float(e.heading_error <= e.heading) for e in entries]) / n,
        total([e.radius for e in entries]) / n,
        degrees(total([e.heading for e in entries]) / n),
        total([score(e.radius, e.error, a) for e in entries]) / n,
        degrees(total([score(e.heading, e.heading_error, a) for e in entries]) / n),
    )


def score(width: float, error: float, a: float) -> float:
    """Interval score of a half-width for the level 1 - a: its size, and what an error exceeds it by over
    a; in their unit."""
    return width + max(error - width, 0.0) / a
