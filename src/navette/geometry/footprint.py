"""The robot's outline on the floor, in its base frame."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError

_FARTHEST_M = 100.0  # tables and grids around a body grow with its size


@dataclass(frozen=True)
class Footprint:
    """A simple polygon around the base frame's origin.

    Args:
        vertices: corners (x, y) in metres, in order (either sense); the origin
            (the point that navigation steers) lies inside.

    Raises:
        InvalidValueError: fewer than three corners, not finite, farther than 100 m,
            or origin outside.
    """

    vertices: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        corners = self.vertices
        if len(corners) < 3 or not np.all(np.isfinite(corners)):
            raise InvalidValueError(
                f"footprint {corners}: wanted at least 3 finite corners (x, y)"
            )
        if np.abs(corners).max() > _FARTHEST_M:
            raise InvalidValueError(
                f"footprint {corners}: wanted corners within {_FARTHEST_M:g} m"
            )
        if not self._contains_origin():
            raise InvalidValueError(
                f"footprint {corners}: the base origin (0, 0) must lie inside"
            )

    @classmethod
    def from_flat(cls, values: tuple[float, ...]) -> "Footprint":
        """From ``x1, y1, x2, y2, …``, the form a parameter file carries."""
        if len(values) % 2:
            raise InvalidValueError(
                f"footprint: {len(values)} numbers; wanted pairs x, y"
            )
        return cls(tuple(zip(values[0::2], values[1::2], strict=True)))

    @classmethod
    def from_radius(cls, radius: float, corners: int = 24) -> "Footprint":
        """A regular polygon drawn around the circle of ``radius`` metres."""
        outer = radius / math.cos(math.pi / corners)
        angles = [math.tau * i / corners for i in range(corners)]
        return cls(tuple((outer * math.cos(a), outer * math.sin(a)) for a in angles))

    @cached_property
    def inscribed_radius(self) -> float:
        """Largest circle about the origin inside the outline, metres."""
        return min(_segment_distance(a, b) for a, b in self._edges())

    @cached_property
    def circumscribed_radius(self) -> float:
        """Smallest circle about the origin around the outline, metres."""
        return max(math.hypot(x, y) for x, y in self.vertices)

    def samples(self, spacing: float) -> NDArray[np.float64]:
        """Points (N, 2) on the outline, at most ``spacing`` metres apart."""
        points: list[NDArray[np.float64]] = []
        for a, b in self._edges():
            count = max(1, math.ceil(math.dist(a, b) / spacing))
            t = np.arange(count)[:, None] / count
            points.append((1 - t) * np.array(a) + t * np.array(b))
        return np.concatenate(points)

    def _edges(
        self,
    ) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        shifted = self.vertices[1:] + self.vertices[:1]
        return list(zip(self.vertices, shifted, strict=True))

    def _contains_origin(self) -> bool:
        # Ray casting along +x: an odd number of crossed edges means inside.
        inside = False
        for (ax, ay), (bx, by) in self._edges():
            if (ay > 0) != (by > 0) and ax + (0 - ay) * (bx - ax) / (by - ay) > 0:
                inside = not inside
        return inside


def _segment_distance(a: tuple[float, float], b: tuple[float, float]) -> float:
    """Distance from the origin to the segment a–b."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    length2 = dx * dx + dy * dy
    t = 0.0 if length2 == 0 else -(a[0] * dx + a[1] * dy) / length2
    t = min(1.0, max(0.0, t))
    return math.hypot(a[0] + t * dx, a[1] + t * dy)
