"""Worlds and independent checks for the planner's tests."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import GridSpec

COURSE_FOOTPRINT = (
    *(1.5, 0.5, 0.4, 0.5, 0.4, 0.7, -0.4, 0.7, -0.4, 0.5, -0.5, 0.5),
    *(-0.5, -0.5, -0.4, -0.5, -0.4, -0.7, 0.4, -0.7, 0.4, -0.5, 1.5, -0.5),
)
"""Chassis and wheels of the course's robot about its axle (m)."""

HARD_RUNS = (
    ((1, -12.9, 0), (-6, -12.9)),
    ((1, -12.9, 180), (1, -7.2)),
    ((6, -12.8, 90), (2.8, -6.5)),
    ((-12, -9, -110), (-13.2, -13.2)),
    ((-13.2, -13.2, -135), (-12, -9)),
    ((0, 12.6, 0), (4, 6)),
    ((11.5, 7.5, 180), (6, 4.5)),
    ((-3, 6, 180), (-5.3, 6)),
    ((-12, -1, 90), (-4.5, 9)),
    ((-11, 12.6, 0), (11, 12.6)),
)
"""Start (x, y, degrees) and goal (x, y) in the course's world."""

_BOXES = ((7, -6, 1.5), (-8, 6, 1.5), (4, 9, 1.5), (9, 3, 1.0), (1, -10, 1.0))
_CYLINDERS = ((0, 0, 3.0), (-7, -7, 2.0))
_WALL = 14.75


def course_distance(
    x: NDArray[np.float64], y: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Signed distance (m) to the nearest surface of the course's world."""
    distance = _WALL - np.maximum(np.abs(x), np.abs(y))
    for cx, cy, half in _BOXES:
        dx, dy = np.abs(x - cx) - half, np.abs(y - cy) - half
        outside = np.hypot(np.maximum(dx, 0), np.maximum(dy, 0))
        distance = np.minimum(distance, outside + np.minimum(np.maximum(dx, dy), 0))
    for cx, cy, radius in _CYLINDERS:
        distance = np.minimum(distance, np.hypot(x - cx, y - cy) - radius)
    return distance


def course_map(resolution: float = 0.1) -> tuple[NDArray[np.int8], GridSpec]:
    """The course's world as a lidar would leave it: surfaces one or two cells deep."""
    cells = round(32 / resolution)
    spec = GridSpec(resolution, cells, cells, Pose2(-16.0, -16.0, 0.0))
    centers = (np.arange(cells) + 0.5) * resolution - 16
    distance = course_distance(*np.meshgrid(centers, centers))
    surface = (distance <= 0) & (distance > -2 * resolution)
    return np.where(surface, 100, 0).astype(np.int8), spec


def course_clearance(poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """(N,) true distance (m) of the course robot's body from the world's surfaces."""
    outline = Footprint.from_flat(COURSE_FOOTPRINT).samples(0.02)
    moved = [Pose2(*pose).apply(outline) for pose in poses.tolist()]
    return np.array([course_distance(p[:, 0], p[:, 1]).min() for p in moved])


def empty_map(
    width_m: float, height_m: float, resolution: float = 0.1
) -> tuple[NDArray[np.int8], GridSpec]:
    """A free map with its corner at the origin."""
    spec = GridSpec(
        resolution, round(width_m / resolution), round(height_m / resolution)
    )
    return np.zeros(spec.shape, np.int8), spec


def fill(
    occupancy: NDArray[np.int8],
    spec: GridSpec,
    x: tuple[float, float],
    y: tuple[float, float],
    value: int = 100,
) -> None:
    """Set the cells of a rectangle (m, map frame, on the edges of cells)."""
    rows, columns = (
        slice(
            max(0, round((low - origin) / spec.resolution)),
            max(0, round((high - origin) / spec.resolution)),
        )
        for (low, high), origin in ((y, spec.origin.y), (x, spec.origin.x))
    )
    occupancy[rows, columns] = value


def distance_to_cells(
    footprint: Footprint, pose: Pose2, occupancy: NDArray[np.int8], spec: GridSpec
) -> float:
    """Distance (m) of the body from the nearest lethal cell's centre; −1 inside.

    Polygon against points, exact; shares nothing with the planner's own check.
    """
    cells = np.argwhere(occupancy == 100)
    if not len(cells):
        return math.inf
    points = pose.inverse().apply(spec.centers_of(cells))
    corners = np.array(footprint.vertices)
    ends = np.roll(corners, -1, axis=0)
    edges = ends - corners
    offsets = points[:, None] - corners[None]
    along = (offsets * edges).sum(-1) / (edges**2).sum(-1)
    nearest = offsets - np.clip(along, 0, 1)[..., None] * edges
    # Winding by crossings: an odd number to the right means inside.
    above = (corners[None, :, 1] > points[:, None, 1]) != (
        ends[None, :, 1] > points[:, None, 1]
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        x_cross = corners[:, 0] + offsets[..., 1] * edges[:, 0] / edges[:, 1]
    crossings = (above & (x_cross > points[:, :1])).sum(axis=1)
    if (crossings % 2 == 1).any():
        return -1.0
    return float(np.hypot(nearest[..., 0], nearest[..., 1]).min())
