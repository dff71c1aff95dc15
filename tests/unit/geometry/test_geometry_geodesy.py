import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import InvalidValueError
from navette.geometry.geodesy import GeoPoint, LocalPlane, geodesic_distance

latitudes = st.floats(-80.0, 80.0)
longitudes = st.floats(-180.0, 180.0)


def test_a_known_distance() -> None:
    """Vincenty's test line (1975): Flinders Peak to Buninyong, on GRS 80."""
    flinders = GeoPoint(-37.95103341666667, 144.42486788888888)
    buninyong = GeoPoint(-37.65282113888889, 143.92649552777777)
    assert geodesic_distance(flinders, buninyong) == pytest.approx(54972.271, abs=1e-3)


def test_altitude_counts_if_both_are_known() -> None:
    low, high = GeoPoint(45.0, 7.0, 100.0), GeoPoint(45.0, 7.0, 130.0)
    assert geodesic_distance(low, high) == 30.0
    assert geodesic_distance(low, GeoPoint(45.0, 7.0)) == 0.0


@given(latitudes, longitudes, st.floats(-0.005, 0.005), st.floats(-0.005, 0.005))
def test_distances_near_the_origin_are_preserved(lat, lon, north, east) -> None:
    plane = LocalPlane(GeoPoint(lat, lon))
    a, b = GeoPoint(lat + north, lon), GeoPoint(lat, lon + east)
    assert plane.east_north(plane.origin) == (0.0, 0.0)
    straight = math.dist(plane.east_north(a), plane.east_north(b))
    assert straight == pytest.approx(geodesic_distance(a, b), rel=1e-6, abs=1e-6)


def test_east_is_x_and_north_is_y() -> None:
    plane = LocalPlane(GeoPoint(48.0, 11.0))
    east, north = plane.east_north(GeoPoint(48.0, 11.001))
    assert east > 70.0
    assert abs(north) < 0.001
    assert plane.east_north(GeoPoint(48.001, 11.0))[1] > 100.0


@pytest.mark.parametrize("point", [(91.0, 0.0), (math.nan, 0.0), (0.0, math.inf)])
def test_invalid_coordinates_are_refused(point) -> None:
    assert not GeoPoint(*point).is_valid
    with pytest.raises(InvalidValueError, match="within ±90°"):
        LocalPlane(GeoPoint(*point))
