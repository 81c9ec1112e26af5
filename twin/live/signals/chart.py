"""The chart of a voyage of any length: north_m and east_m as the ship sails them, north always true north.

    d(north_m) = distance toward true north,   d(east_m) = departure (distance toward true east)

It is a plane that touches the earth (geodesy.py), and it goes along with the ship: once true north turns by
TURN_RAD against the plane's north, or the ship is CHART_REACH_M from where the plane touches, it touches at
the ship's place instead. That place keeps its north_m and east_m, so nothing that remembers places need be
told: what is remembered `d` metres away is off by TURN_RAD d, 0.1 m at 1 km. Along a parallel north_m creeps
by some half of TURN_RAD: 27 m in 500 km. Beyond MAX_DISTANCE_M there is no plane, and a ship that turns up
there is counted by middle latitude: d north = R d lat, d east = R cos(mean lat) d lon, within a hundredth.

This is the plane sailing of a nautical almanac: no map of the earth. Who sails round an area A comes back to
other numbers, by about A tan(latitude)/R, R the earth's radius.
"""

from collections import deque
from math import cos, degrees, radians

from twin.errors import SettingsError
from twin.live.signals.geodesy import MAX_DISTANCE_M, A, Datum, datum, from_chart, to_chart

TURN_RAD = 1e-4  # 0.006 deg: a tenth of a good compass' noise
RECENT = 5  # places of which two may be wild
CHART_REACH_M = 10e3  # near the equator, where north hardly turns: a distance reads 4 mm short there


class Chart:
    """A plane that touches the earth at `at`, where the ship has come to (north_m, east_m) of its datum."""

    __slots__ = ("_square", "at", "east_m", "north_m")

    def __init__(self, at: Datum, north_m: float = 0.0, east_m: float = 0.0):
        self.at, self.north_m, self.east_m = at, north_m, east_m
        self._square = reach_m(at) ** 2

    def place(self, latitude_deg: float, longitude_deg: float) -> tuple[float, float] | None:
        """(north_m, east_m) of a WGS84 position; None where the plane may not be used."""
        local = to_chart(self.at, latitude_deg, longitude_deg)
        return local and (self.north_m + local[0], self.east_m + local[1])

    def position(self, north_m: float, east_m: float) -> tuple[float, float]:
        """(latitude_deg, longitude_deg) of a place; near a pole, or where no ship can be, no true one."""
        north, east = north_m - self.north_m, east_m - self.east_m
        if north * north + east * east <= MAX_DISTANCE_M**2:
            return from_chart(self.at, north, east)
        latitude = self.at.latitude_deg + degrees(north / A)
        shrunk = self._shrunk(latitude)
        return latitude, (self.at.longitude_deg + degrees(east / (A * shrunk)) + 180.0) % 360.0 - 180.0

    def afar(self, latitude_deg: float, longitude_deg: float) -> "Chart":
        """The chart with which a ship goes on that has turned up beyond this one. SettingsError: near a
        pole."""
        turn = (longitude_deg - self.at.longitude_deg + 180.0) % 360.0 - 180.0
        north = A * radians(latitude_deg - self.at.latitude_deg)
        east = A * self._shrunk(latitude_deg) * radians(turn)
        return Chart(datum(latitude_deg, longitude_deg), self.north_m + north, self.east_m + east)

    def _shrunk(self, latitude_deg: float) -> float:
        """cos(middle latitude) between here and there."""
        return max(cos(radians(0.5 * (latitude_deg + self.at.latitude_deg))), 1e-3)

    def near(self, north_m: float, east_m: float) -> "Chart":
        """The chart with which a ship at this place goes on: this one, or one that touches the earth there.
        This one also where no plane is drawn: near a pole, or at no place."""
        north, east = north_m - self.north_m, east_m - self.east_m
        if not self._square < north * north + east * east:
            return self
        try:
            return Chart(datum(*self.position(north_m, east_m)), north_m, east_m)
        except SettingsError:
            return self


class RecentPlaces:
    """The last places of a recording, where nobody estimates the ship's: their median is where it is."""

    def __init__(self) -> None:
        self._places: deque[tuple[float, float]] = deque(maxlen=RECENT)

    def carry(self, chart: Chart, place: tuple[float, float]) -> Chart:
        """The chart with which the recording goes on behind this place (north_m, east_m); one or two that
        stand out move it nowhere."""
        self._places.append(place)
        if len(self._places) < RECENT or chart.near(*place) is chart:
            return chart
        north, east = (sorted(axis)[RECENT // 2] for axis in zip(*self._places, strict=True))
        return chart.near(north, east)


def reach_m(at: Datum) -> float:
    """How far from here [m] the plane is used: TURN_RAD R/tan(latitude), at most CHART_REACH_M."""
    return min(TURN_RAD * A * at.cos_lat / max(abs(at.sin_lat), 1e-9), CHART_REACH_M)
