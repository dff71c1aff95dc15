"""Footprint: the robot's outline on the floor, in its base frame."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError

Point = tuple[float, float]

_FARTHEST_M = 100.0  # the size of tables and grids around a body grows with it


@dataclass(frozen=True)
class Footprint:
    """A simple polygon around the origin of the base frame.

    Args:
        vertices: corners (x, y) in metres, in order (either sense); the origin, the
            point that the controller steers, lies inside.

    Raises:
        InvalidValueError: fewer than three corners, not finite, farther than 100 m,
            or origin outside.
    """

    vertices: tuple[Point, ...]

    def __post_init__(self) -> None:
        corners = self.vertices
        if len(corners) < 3 or not np.all(np.isfinite(corners)):
            raise InvalidValueError(
                f"footprint {corners}: at least 3 finite corners (x, y) required"
            )
        if np.abs(corners).max() > _FARTHEST_M:
            raise InvalidValueError(
                f"footprint {corners}: corners must be within {_FARTHEST_M:g} m"
            )
        if not self.contains(np.zeros((1, 2)))[0]:
            raise InvalidValueError(
                f"footprint {corners}: the base origin (0, 0) must lie inside"
            )

    @classmethod
    def from_flat(cls, values: tuple[float, ...]) -> "Footprint":
        """Make a footprint from ``x1, y1, x2, y2, …``, the form of parameter files.

        Raises:
            InvalidValueError: an odd number of values, or an invalid polygon.
        """
        if len(values) % 2:
            raise InvalidValueError(
                f"footprint: {len(values)} numbers are not pairs x, y"
            )
        return cls(tuple(zip(values[0::2], values[1::2], strict=True)))

    @cached_property
    def inscribed_radius(self) -> float:
        """Radius of the largest circle about the origin inside the outline, m."""
        return min(_segment_distance(a, b) for a, b in self._edges())

    @cached_property
    def circumscribed_radius(self) -> float:
        """Radius of the smallest circle about the origin around the outline, m."""
        return max(math.hypot(x, y) for x, y in self.vertices)

    def contains(
        self, points: NDArray[np.float64], *, depth_m: float = 0.0
    ) -> NDArray[np.bool_]:
        """Return which points (N, 2) lie inside, at least ``depth_m`` from the outline.

        Ray casting along +x: an odd number of crossed edges means inside.
        """
        inside = np.zeros(len(points), np.bool_)
        nearest = np.full(len(points), np.inf)
        corners = np.array(self.vertices)
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            edge, to_point = b - a, points - a
            length2 = edge @ edge
            t = np.clip(to_point @ edge / length2, 0, 1) if length2 else np.zeros(1)
            gap = to_point - t[:, None] * edge
            nearest = np.minimum(nearest, np.hypot(gap[:, 0], gap[:, 1]))
            spans = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
            # An edge that spans the point's y has edge[1] != 0.
            slope = edge[0] / edge[1] if edge[1] else 0.0
            inside ^= spans & (a[0] + to_point[:, 1] * slope > points[:, 0])
        return np.asarray(inside & (nearest >= depth_m))

    def samples(self, spacing_m: float) -> NDArray[np.float64]:
        """Points (N, 2) on the outline, at most ``spacing_m`` apart."""
        points: list[NDArray[np.float64]] = []
        for a, b in self._edges():
            count = max(1, math.ceil(math.dist(a, b) / spacing_m))
            t = np.arange(count)[:, None] / count
            points.append((1 - t) * np.array(a) + t * np.array(b))
        return np.concatenate(points)

    def _edges(self) -> list[tuple[Point, Point]]:
        shifted = self.vertices[1:] + self.vertices[:1]
        return list(zip(self.vertices, shifted, strict=True))


def _segment_distance(a: Point, b: Point) -> float:
    """Distance from the origin to the segment a–b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    t = 0.0 if length2 == 0 else -(a[0] * dx + a[1] * dy) / length2
    t = min(1.0, max(0.0, t))
    return math.hypot(a[0] + t * dx, a[1] + t * dy)
