"""The weather of a voyage, its presets, and its slow and gusty wandering."""

from dataclasses import dataclass, replace
from math import inf


@dataclass(frozen=True)
class Weather:
    """Means over the voyage; degrees from north (`from`: where it comes from, `to`: where it goes)."""

    wind_mps: float = 0.0
    wind_from_deg: float = 0.0
    gust_share: float = 0.12  # standard deviation of gusts / mean wind
    wave_height_m: float = 0.0  # significant
    wave_period_s: float = 8.0  # of the spectral peak
    wave_from_deg: float = 0.0
    current_mps: float = 0.0
    current_to_deg: float = 0.0
    current_spread_mps: float = 0.0  # standard deviation of each component about the mean
    current_time_s: float = 600.0  # its correlation time
    depth_m: float = inf
    depth_swing: float = 0.0  # share of depth by which the bottom rises and falls along the track
    bank_m: float = inf  # mean clearance hull to bank; > 0 starboard, < 0 port


CALM = Weather(wind_mps=0.5)

# The scenarios of Vychuzhanin & Vychuzhanin (2026), Table 2: wind speed, and direction relative to the first
# heading; sea states 0-1, 3 and 4 as Hs 0.05, 0.88, 1.88 m, current 0.1, 0.4, 0.8 m/s, peak periods: ours.
WEATHERS = {
    "calm": CALM,
    "TS-01": Weather(2.0, 0.0, 0.12, 0.05, 3.0, 0.0, 0.1, 0.0, 0.02),
    "TS-02": Weather(8.5, 45.0, 0.12, 0.88, 7.0, 45.0, 0.4, 225.0, 0.06),
    "TS-03": Weather(12.0, 90.0, 0.12, 1.88, 9.0, 90.0, 0.8, 270.0, 0.12),
}


def strong_wind(hull, strength, from_deg) -> dict:
    """15 m/s on a ship, 6 m/s on a boat, at strength 1."""
    return {"wind_mps": (15.0 if hull.L > 50 else 6.0) * strength, "wind_from_deg": from_deg}


def strong_waves(hull, strength, from_deg) -> dict:
    """3.5 m and 9.5 s on a ship, Hs/L no more than 0.04 on a boat; Tp = 5.1 sqrt(Hs), a sea half grown."""
    height = min(3.5, 0.04 * hull.L) * strength**0.5
    return {"wave_height_m": height, "wave_period_s": max(1.2, 5.1 * height**0.5), "wave_from_deg": from_deg}


def rotated(weather: Weather, by_deg: float) -> Weather:
    """The same weather for a ship whose first heading is `by_deg` instead of north."""
    bearings = ("wind_from_deg", "wave_from_deg", "current_to_deg")
    return replace(weather, **{name: (getattr(weather, name) + by_deg) % 360 for name in bearings})
