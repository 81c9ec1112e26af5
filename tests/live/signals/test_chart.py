"""The chart of a voyage of any length, by hand: the plane goes along, and places stay where they are."""

from itertools import pairwise
from math import cos, degrees, hypot, nan, radians, sin, sqrt, tan

import pytest

from twin.live.signals.chart import CHART_REACH_M, TURN_RAD, Chart, RecentPlaces, reach_m
from twin.live.signals.geodesy import E2, A, convergence_deg, datum


def parallel_m(latitude_deg: float) -> float:
    """The radius of a parallel on the ellipsoid."""
    s = sin(radians(latitude_deg))
    return A / sqrt(1.0 - E2 * s * s) * cos(radians(latitude_deg))


def meridian_m(first_deg: float, last_deg: float, parts: int = 2000) -> float:
    """The length of a meridian on the ellipsoid, by midpoints."""
    step = (last_deg - first_deg) / parts
    s = [sin(radians(first_deg + (k + 0.5) * step)) for k in range(parts)]
    return sum(A * (1.0 - E2) / (1.0 - E2 * x * x) ** 1.5 * radians(step) for x in s)


def sailed(positions: list[tuple[float, float]]) -> list[tuple[Chart, tuple[float, float]]]:
    """The chart at each position and the ship's place on it; the chart goes along after each."""
    chart, made = Chart(datum(*positions[0])), []
    for position in positions:
        place = chart.place(*position)
        assert place is not None
        made.append((chart, place))
        chart = chart.near(*place)
    return made


def eastward(latitude: float, start: float, distance_m: float, step_m: float) -> list[tuple[float, float]]:
    turn = degrees(step_m / parallel_m(latitude))
    return [
        (latitude, (start + k * turn + 180.0) % 360.0 - 180.0) for k in range(round(distance_m / step_m) + 1)
    ]


@pytest.mark.parametrize("latitude", [60.0, -60.0, 10.0])
def test_500_km_along_a_parallel_across_the_antimeridian_are_500_km_east(latitude: float) -> None:
    """Expected: by hand, radius of the parallel times the turn; north creeps by some half of TURN_RAD, and
    north of the plane is nowhere farther than TURN_RAD and a step from true north."""
    made = sailed(eastward(latitude, 176.0, 500e3, 50.0))
    north, east = made[-1][1]
    assert east == pytest.approx(500e3, abs=0.1)
    assert abs(north) < 0.6 * TURN_RAD * 500e3
    assert len({id(chart) for chart, _ in made}) > 40
    for (chart, place), (_, after) in pairwise(made):
        assert hypot(after[0] - place[0], after[1] - place[1]) == pytest.approx(50.0, abs=0.01)
        longitude = chart.position(*place)[1]
        assert abs(radians(convergence_deg(chart.at, longitude))) < TURN_RAD * 1.15


def test_200_km_along_a_meridian_are_200_km_north() -> None:
    made = sailed([(58.0 + 0.0005 * k, 11.0) for k in range(3601)])
    north, east = made[-1][1]
    assert north == pytest.approx(meridian_m(58.0, 59.8), abs=0.05)
    assert abs(east) < 1e-6


def test_a_chart_that_goes_along_leaves_the_ship_where_it_is_and_turns_what_is_near_by_no_more_than_said() -> (
    None
):
    chart = Chart(datum(60.0, 179.999), 3e5, -7e5)
    ship = (3e5 + 100.0, -7e5 + 1.1 * reach_m(chart.at))
    moved = chart.near(*ship)
    assert moved is not chart
    assert moved.place(*chart.position(*ship)) == pytest.approx(ship, abs=1e-6)
    for north, east in ((1000.0, 0.0), (0.0, -1000.0), (-700.0, 700.0)):
        place = ship[0] + north, ship[1] + east
        after = moved.place(*chart.position(*place))
        assert after is not None
        assert 0.05 < hypot(after[0] - place[0], after[1] - place[1]) < 1.2 * TURN_RAD * 1000.0


def test_how_far_a_chart_reaches() -> None:
    """By hand: 1e-4 6 378 137 m/tan(60 deg) = 368 m; at the equator what its curvature allows."""
    assert reach_m(datum(60.0, 11.0)) == pytest.approx(368.2, abs=0.1)
    assert reach_m(datum(-60.0, 11.0)) == pytest.approx(368.2, abs=0.1)
    assert reach_m(datum(0.0, 11.0)) == CHART_REACH_M


def test_a_ship_that_lies_at_the_edge_of_a_chart_moves_it_once() -> None:
    """Test: to and fro by 20 m about the edge, as a ship at anchor. Expected: one move, for the edge is then far."""
    chart, seen = Chart(datum(60.0, 11.0)), list[Chart]()
    for k in range(200):
        chart = chart.near(0.0, reach_m(datum(60.0, 11.0)) + (20.0 if k % 2 else -20.0))
        seen += [] if chart in seen else [chart]
    assert len(seen) == 2


def test_round_an_area_the_numbers_are_others_by_its_share_of_the_earth() -> None:
    """By hand: 20 km east, north, back to the same meridian and south at 60 deg north: A tan(latitude)/R."""
    first, side = 60.0, 20e3
    north = degrees(side / (meridian_m(60.0, 60.1) / radians(0.1)))
    east = degrees(side / parallel_m(60.0))
    n = 400
    corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]
    way = [
        (first + north * (a[0] + (b[0] - a[0]) * k / n), 11.0 + east * (a[1] + (b[1] - a[1]) * k / n))
        for a, b in pairwise(corners)
        for k in range(n)
    ]
    place = sailed([*way, (first, 11.0)])[-1][1]
    assert place[1] == pytest.approx(side * side * tan(radians(60.0)) / A, rel=0.02)


@pytest.mark.parametrize("place", [(nan, 0.0), (0.0, nan), (-1e12, 0.0), (1e300, 1e300)])
def test_no_chart_is_drawn_where_no_ship_can_be(place: tuple[float, float]) -> None:
    chart = Chart(datum(60.0, 11.0))
    assert chart.near(*place) is chart


@pytest.mark.parametrize("there", [(55.0, -160.0), (62.0, 175.0), (-10.0, 170.0)])
def test_a_ship_that_turns_up_far_away_is_counted_by_middle_latitude(there: tuple[float, float]) -> None:
    """Expected: by hand, and the same position again from a chart that was left behind."""
    chart = Chart(datum(58.0, 179.0), 1e3, -2e3)
    assert chart.place(*there) is None
    far = chart.afar(*there)
    turn = radians((there[1] - 179.0 + 180.0) % 360.0 - 180.0)
    assert far.north_m == pytest.approx(1e3 + A * radians(there[0] - 58.0))
    assert far.east_m == pytest.approx(-2e3 + A * turn * cos(radians(0.5 * (there[0] + 58.0))))
    assert far.position(far.north_m, far.east_m) == pytest.approx(there)
    assert chart.position(far.north_m, far.east_m) == pytest.approx(there)
    back = chart.near(far.north_m, far.east_m)
    assert (back.at.latitude_deg, back.at.longitude_deg) == pytest.approx(there)


def test_no_chart_is_drawn_at_a_pole_and_the_last_one_stays() -> None:
    chart = Chart(datum(89.4, 11.0))
    assert chart.near(20e3, 0.0) is chart
    assert chart.near(-20e3, 0.0) is not chart


def test_two_wild_places_of_a_recording_move_its_chart_nowhere_and_a_way_does() -> None:
    """Expected: after five places the third largest of each axis, north and east, is where the plane touches."""
    chart, recent = Chart(datum(60.0, 11.0)), RecentPlaces()
    wild = (0.0, 90e3), (-90e3, 90e3)
    for place in ((0.0, 0.0), *wild, (0.0, 300.0), (10.0, 350.0), (0.0, 360.0), (20.0, 400.0), (30.0, 450.0)):
        assert recent.carry(chart, place) is chart
    moved = recent.carry(chart, (40.0, 500.0))
    assert (moved.north_m, moved.east_m) == (20.0, 400.0)
