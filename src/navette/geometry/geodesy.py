"""WGS 84 coordinates: geodesic distance and a local tangent plane.

Geodesics are computed by geographiclib (Karney 2013, "Algorithms for geodesics", J.
Geodesy 87, 43-55), exact to nanometres. Not re-exported by :mod:`navette.geometry`, so
that geographiclib is loaded only by its users.
"""

import math
from typing import NamedTuple

from geographiclib.geodesic import Geodesic

from navette.errors import InvalidValueError

_MASK = Geodesic.DISTANCE
_MASK_WITH_AZIMUTH = Geodesic.DISTANCE | Geodesic.AZIMUTH


class GeoPoint(NamedTuple):
    """Degrees north and east, metres above the ellipsoid (NaN = unknown)."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float = math.nan

    @property
    def is_valid(self) -> bool:
        """Whether the coordinates are valid; the altitude may be NaN."""
        return (
            abs(self.latitude_deg) <= 90.0
            and math.isfinite(self.longitude_deg)
            and not math.isinf(self.altitude_m)
        )


def geodesic_distance(a: GeoPoint, b: GeoPoint) -> float:
    """Distance from ``a`` to ``b`` in metres, for points near each other.

    √(geodesic² + altitude difference²); the geodesic alone if an altitude is unknown.
    """
    along: float = Geodesic.WGS84.Inverse(
        a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg, _MASK
    )["s12"]
    up = b.altitude_m - a.altitude_m
    return along if math.isnan(up) else math.hypot(along, up)


class LocalPlane:
    """East and north in metres around an origin (azimuthal equidistant projection).

    Distance and direction from the origin are exact; between two points at ``d`` from
    it the relative error is about (d / Earth's radius)² / 6: 4 µm per km at 1 km,
    0.4 mm per km at 10 km.

    Raises:
        InvalidValueError: the origin's coordinates are invalid.
    """

    def __init__(self, origin: GeoPoint) -> None:
        if not origin.is_valid:
            raise InvalidValueError(
                f"{origin}: latitude must be within ±90° and longitude finite"
            )
        self.origin = origin

    def east_north(self, point: GeoPoint) -> tuple[float, float]:
        """Metres east and north of the origin."""
        line = Geodesic.WGS84.Inverse(
            self.origin.latitude_deg,
            self.origin.longitude_deg,
            point.latitude_deg,
            point.longitude_deg,
            _MASK_WITH_AZIMUTH,
        )
        azimuth = math.radians(line["azi1"])
        return line["s12"] * math.sin(azimuth), line["s12"] * math.cos(azimuth)

    def point_at(self, east: float, north: float, altitude_m: float) -> GeoPoint:
        """Return the point at metres east and north of the origin."""
        azimuth = math.degrees(math.atan2(east, north))
        found = Geodesic.WGS84.Direct(
            self.origin.latitude_deg,
            self.origin.longitude_deg,
            azimuth,
            math.hypot(east, north),
        )
        return GeoPoint(found["lat2"], found["lon2"], altitude_m)
