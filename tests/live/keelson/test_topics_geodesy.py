"""WGS84 to the flat chart and back (fault I20)."""

from itertools import pairwise
from math import atan2, cos, degrees, hypot, radians, sin, sqrt

import pytest

from twin.errors import SettingsError
from twin.live.signals.geodesy import E2, A, convergence_deg, datum, from_chart, to_chart


@pytest.mark.parametrize("latitude", [0.0, 35.0, 57.7, -55.0, 80.0, 89.4])
@pytest.mark.parametrize("longitude", [11.9, 179.99, -179.99])
@pytest.mark.parametrize("place", [(0.0, 0.0), (1e3, -2e3), (-7e4, 7e4), (2e4, 9.5e4)])
def test_there_and_back_within_a_millimetre(
    latitude: float, longitude: float, place: tuple[float, float]
) -> None:
    at = datum(latitude, longitude)
    position = from_chart(at, *place)
    if abs(position[0]) > 89.5:
        pytest.skip("beyond the chart")
    back = to_chart(at, *position)
    assert back is not None
    assert hypot(back[0] - place[0], back[1] - place[1]) < 1e-3


def test_a_small_step_by_hand() -> None:
    """One millidegree at 57.7 N: the radii of curvature give 111.352 m north and 59.607 m east."""
    s = sin(radians(57.7))
    normal = A / sqrt(1.0 - E2 * s * s)
    meridian = normal * (1.0 - E2) / (1.0 - E2 * s * s)
    at = datum(57.7, 11.9)
    north = to_chart(at, 57.701, 11.9)
    east = to_chart(at, 57.7, 11.901)
    assert north is not None and east is not None
    assert north == pytest.approx((radians(1e-3) * meridian, 0.0), abs=2e-3)
    assert east == pytest.approx((0.0, radians(1e-3) * normal * cos(radians(57.7))), abs=2e-3)


def test_at_100_km_a_distance_reads_four_metres_short_and_no_more() -> None:
    at = datum(0.0, 0.0)
    place = to_chart(at, 0.0, degrees(1e5 / A))
    assert place is not None
    assert 0.0 < 1e5 - place[1] < 4.2


def test_the_antimeridian_is_no_jump() -> None:
    at = datum(-17.0, 179.9995)
    east = [to_chart(at, -17.0, lon) for lon in (179.9990, 179.9999, -179.9999, -179.9990, 180.0010)]
    assert all(place is not None for place in east)
    steps = [b[1] - a[1] for a, b in pairwise(east[:4]) if a and b]
    assert steps == pytest.approx([95.86, 21.30, 95.86], abs=0.2)
    assert east[3] == pytest.approx(east[4])


def test_true_north_turns_against_the_chart_as_said() -> None:
    at = datum(55.0, 11.0)
    latitude, longitude = from_chart(at, 0.0, 1e5)
    here, ahead = to_chart(at, latitude, longitude), to_chart(at, latitude + 1e-3, longitude)
    assert here is not None and ahead is not None
    direction = degrees(atan2(ahead[1] - here[1], ahead[0] - here[0]))
    assert direction == pytest.approx(convergence_deg(at, longitude), abs=1e-3)
    assert direction == pytest.approx(-1.28, abs=0.01)


@pytest.mark.parametrize("latitude", [89.51, 90.0, -89.6, float("nan")])
def test_no_datum_near_a_pole(latitude: float) -> None:
    with pytest.raises(SettingsError):
        datum(latitude, 0.0)


@pytest.mark.parametrize("position", [(-57.7, -168.1), (57.7, 20.0), (89.9, 11.9), (57.7, 400.0)])
def test_far_away_and_the_far_side_of_the_earth_are_not_on_the_chart(position: tuple[float, float]) -> None:
    assert to_chart(datum(57.7, 11.9), *position) is None
