"""True wind, apparent wind and the ship's own motion make a triangle. Directions say where the wind comes
from.

A e^{i alpha} = T e^{i (theta - psi)} + (u + i v)
"""

from collections.abc import Callable

import numpy as np

from twin.recording.checks.check_result import Check, cannot_tell, doubtful, good, wrong
from twin.recording.checks.voyage_view import VoyageView, fit, rms
from twin.recording.units import DEG_PER_RAD, KNOT_MPS

# share of the wind by which the triangle may stay open (gusts, mast height, flow around the ship)
AGREES = 0.35
EXPLAINS = 0.5
LIGHT_MPS = 2.0
WINDS = (
    ("true_wind_speed_mps", "true_wind_direction_deg"),
    ("apparent_wind_speed_mps", "apparent_wind_angle_deg"),
)
Pair = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def turn(speed: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """(N,) a speed and an angle [rad], as a complex number in the speed's unit."""
    return speed * np.exp(1j * angle)


# (T, theta, A, alpha, psi) -> (apparent, true), both in the ship's axes, as they read under each mistake
MISTAKES: tuple[tuple[str, str, Callable[..., tuple[np.ndarray, np.ndarray]]], ...] = (
    ("", "", lambda t, h, a, b, p: (turn(a, b), turn(t, h - p))),
    (
        "the true wind is given as where it blows to",
        'direction = "to" for true_wind_direction_deg',
        lambda t, h, a, b, p: (turn(a, b), -turn(t, h - p)),
    ),
    (
        "the apparent wind is given as where it blows to",
        'direction = "to" for apparent_wind_angle_deg',
        lambda t, h, a, b, p: (-turn(a, b), turn(t, h - p)),
    ),
    (
        "both winds are given as where they blow to",
        'direction = "to" for both directions',
        lambda t, h, a, b, p: (-turn(a, b), -turn(t, h - p)),
    ),
    (
        "the apparent angle is positive to port",
        "sign = -1 for apparent_wind_angle_deg",
        lambda t, h, a, b, p: (turn(a, -b), turn(t, h - p)),
    ),
    (
        "the true direction is in radians",
        'unit = "rad" for true_wind_direction_deg',
        lambda t, h, a, b, p: (turn(a, b), turn(t, h * DEG_PER_RAD - p)),
    ),
    (
        "the apparent angle is in radians",
        'unit = "rad" for apparent_wind_angle_deg',
        lambda t, h, a, b, p: (turn(a, b * DEG_PER_RAD), turn(t, h - p)),
    ),
    (
        "both directions are in radians",
        'unit = "rad" for both directions',
        lambda t, h, a, b, p: (turn(a, b * DEG_PER_RAD), turn(t, h * DEG_PER_RAD - p)),
    ),
    (
        "the true direction counts from the bow",
        "give it from north (heading + angle)",
        lambda t, h, a, b, p: (turn(a, b), turn(t, h)),
    ),
    (
        "the apparent angle counts from north",
        "give it from the bow (direction - heading)",
        lambda t, h, a, b, p: (turn(a, b - p), turn(t, h - p)),
    ),
    (
        "the apparent wind speed is in knots",
        'unit = "kn" for apparent_wind_speed_mps',
        lambda t, h, a, b, p: (turn(a, b) * KNOT_MPS, turn(t, h - p)),
    ),
    (
        "the true wind speed is in knots",
        'unit = "kn" for true_wind_speed_mps',
        lambda t, h, a, b, p: (turn(a, b), turn(t, h - p) * KNOT_MPS),
    ),
    (
        "both wind speeds are in knots",
        'unit = "kn" for both speeds',
        lambda t, h, a, b, p: (turn(a, b) * KNOT_MPS, turn(t, h - p) * KNOT_MPS),
    ),
    (
        "true and apparent wind are swapped",
        "swap their columns",
        lambda t, h, a, b, p: (turn(t, h), turn(a, b - p)),
    ),
)


def wind(view: VoyageView) -> Check:
    """The triangle, when both winds were recorded; else what one of them says alone."""
    name = "wind"
    true, apparent = (view.voyage.has(*pair) for pair in WINDS)
    if not true and not apparent:
        return cannot_tell(name, none_whole(view))
    return triangle(name, view) if true and apparent else alone(name, view, true)


def none_whole(view: VoyageView) -> str:
    """What is lacking of the wind: all of it, or the other half of a speed or an angle that stands alone."""
    for pair in WINDS:
        for half, other in (pair, pair[::-1]):
            if view.voyage.has(half):
                return (
                    f"{half} was recorded without {other}, so an effect of wind cannot be judged. True and "
                    "apparent wind are two pairs: look in the map whether one column is given as the other's."
                )
    return "no wind was recorded, so an effect of wind cannot be judged."


def triangle(name: str, view: VoyageView) -> Check:
    """Whether the true wind, the apparent wind and the ship's own motion make a triangle, and which
    mistake would explain it if not."""
    t, h, a, b = (
        view.si(c)
        for c in (
            "true_wind_speed_mps",
            "true_wind_direction_deg",
            "apparent_wind_speed_mps",
            "apparent_wind_angle_deg",
        )
    )
    if relative_taken_as_true(t, h, a, b, view):
        return wrong(
            name,
            "the true wind is the apparent wind, only turned: the ship's own speed was not taken away. In "
            "the map: leave the true wind out (it is computed from the apparent one), or give the "
            "corrected one.",
        )
    tried = []
    for text, fix, reading in MISTAKES:
        seen, made = reading(t, h, a, b, view.psi)
        tried.append((rms(seen - made - view.velocity) / max(rms(seen), 1e-9), text, fix))
    off = tried[0][0]
    left, text, fix = min(tried[1:])
    saw = f"true wind, apparent wind and ship's speed miss each other by {100 * off:.0f} % of the wind"
    if left < EXPLAINS * off and off > 0.2 and left < AGREES:
        return wrong(name, f"{saw}, by {100 * left:.0f} % if {text}: that is believed. In the map: {fix}.")
    if off <= AGREES:
        return good(name, f"{saw}.")
    return doubtful(
        name, f"{saw}, and no mistake that is known explains it. Look at units, signs and the anemometer."
    )


def relative_taken_as_true(
    t: np.ndarray, h: np.ndarray, a: np.ndarray, b: np.ndarray, view: VoyageView
) -> bool:
    """Both columns hold the same wind (as it is, or turned by the heading) though the ship makes way. All
    (N,): true speed [m/s] and direction [rad], apparent speed [m/s] and angle [rad]."""
    size = max(rms(a), 1e-9)
    same = min(rms(turn(a, b) - turn(t, h)), rms(turn(a, b) - turn(t, h - view.psi))) / size
    return same < 0.1 and view.speed > 0.3 * size


def alone(name: str, view: VoyageView, true: bool) -> Check:
    """One wind only: a true direction that turns with the bow was measured from it; radians stay small."""
    column = "true_wind_direction_deg" if true else "apparent_wind_angle_deg"
    raw = view.voyage[column]
    raw = raw[np.isfinite(raw)]
    if raw.max() <= 2.0 * np.pi and np.std(raw) > 1.0:
        return wrong(
            name, f'{column} stays within 0 and {raw.max():.2f}: radians. In the map: unit = "rad" for it.'
        )
    if not true:
        return cannot_tell(
            name, "only the apparent wind was recorded; the true wind follows from it and the ship's motion."
        )
    if np.degrees(np.nanstd(view.psi)) < 15.0:
        return cannot_tell(name, "only the true wind was recorded, and the ship hardly turns.")
    if np.nanmedian(view.si("true_wind_speed_mps")) < LIGHT_MPS:
        return cannot_tell(name, "only a true wind was recorded, so light that it comes from anywhere.")
    followed, sure = follows_heading(view.si(column), view.psi, view.even.time_s)
    if followed < -0.7 and sure:
        return wrong(
            name,
            f"the wind direction turns {followed:.2f} times as the heading does: it is counted from the "
            "bow. In the map call it apparent_wind_angle_deg (and its speed apparent_wind_speed_mps), or "
            "add the heading.",
        )
    return good(
        name,
        f"the wind direction does not turn with the heading ({followed:.2f}). From or to, only the apparent "
        "wind beside it would show.",
    )


def follows_heading(direction: np.ndarray, psi: np.ndarray, time_s: np.ndarray) -> tuple[float, bool]:
    """(d(direction)/d(psi): 0 for a true direction, -1 for one counted from the bow; whether no veering wind
    explains it).

    A wind may veer while the ship circles one way: only where the heading also comes back does it tell, so
    the steady veering is fitted beside it, and both halves of the voyage must say the same. `direction`
    and `psi` (N,) [rad], `time_s` (N,)."""
    whole = slope_on(direction, psi, time_s)
    half = psi.size // 2
    halves = [
        slope_on(direction[rows], psi[rows], time_s[rows]) for rows in (slice(0, half), slice(half, None))
    ]
    sure = whole[1] and sum(ok and abs(k + 1.0) < 0.3 for k, ok in halves) == 2
    return whole[0], sure


def slope_on(direction: np.ndarray, psi: np.ndarray, time_s: np.ndarray) -> tuple[float, bool]:
    """(slope on the heading beside a steady veering, whether it stands by itself). `direction` and `psi`
    (N,) [rad], `time_s` (N,)."""
    t = time_s - time_s.mean()
    x, error, left = fit([psi - np.nanmean(psi), t, np.ones(psi.size)], direction - np.nanmean(direction))
    k, own = float(x[0]), float(error[0])
    alone = (
        np.nanstd(psi - np.polyval(np.polyfit(t[np.isfinite(psi)], psi[np.isfinite(psi)], 1), t))
        > np.radians(10.0)
        if np.isfinite(psi).sum() > 10
        else False
    )
    own *= np.sqrt(max(60.0 / max(float(np.median(np.diff(time_s))), 1e-9), 1.0))
    if not np.isfinite(k) or left > 0.5 or own > 0.3:
        return 0.0 if not np.isfinite(k) or left > 0.5 else k, False
    return k, bool(alone and own < 0.1)
