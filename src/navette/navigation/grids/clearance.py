"""Clearance between a body and the nearest obstacle, from a distance field."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.geometry import Footprint
from navette.navigation.grids.checks import grid_array, kernel_array
from navette.navigation.grids.distance_levels import DistanceLevels, level_type
from navette.navigation.grids.spec import GridFrame, GridSpec, grid_frame

# Of a cell, in cells: an obstacle may fill its cell to the corners.
HALF_DIAGONAL = math.sqrt(0.5)


class DistanceGrid(NamedTuple):
    """A distance field for kernels.

    Attributes:
        distances: to the obstacles.
        frame: :func:`~navette.navigation.grids.spec.grid_frame` of its spec.
        outside_m: distance of points outside the grid.
    """

    distances: DistanceLevels
    frame: GridFrame
    outside_m: float


class Body(NamedTuple):
    """A body for kernels.

    Attributes:
        points: (K, 2) x, y or (K, 3) x, y, disc radius in the base frame, m.
        reach_m: largest distance of a point from the base origin.
    """

    points: NDArray[np.float64]
    reach_m: float


def make_body(points: NDArray[np.float64]) -> Body:
    """Return the body with the given points, see :func:`body_points`."""
    return Body(points, float(np.hypot(points[:, 0], points[:, 1]).max()))


def body_points(footprint: Footprint, spacing_m: float) -> NDArray[np.float64]:
    """Points that represent a body: its outline, and discs that fill it.

    The outline alone would miss a thin post inside the body. Each inner point therefore
    carries the radius of the largest disc about it inside the outline; this radius is
    subtracted from its distance, which never lowers the clearance to anything outside.

    Args:
        footprint: the outline in the base frame.
        spacing_m: between neighbouring points of the outline, about one cell.

    Returns:
        (K, 3) x, y, disc radius in metres; the outline first (radius 0).
    """
    outline = footprint.samples(spacing_m)
    step = max(spacing_m, footprint.inscribed_radius / 2)
    low, high = outline.min(axis=0), outline.max(axis=0)
    xs = np.arange(low[0] + step / 2, high[0], step)
    ys = np.arange(low[1] + step / 2, high[1], step)
    inner = np.array([(0.0, 0.0), *((x, y) for x in xs for y in ys)])
    inner = inner[footprint.contains(inner)]
    gaps = inner[:, None, :] - outline[None, :, :]
    # Outline samples are up to half a spacing away from the outline's nearest point.
    radii = np.hypot(gaps[..., 0], gaps[..., 1]).min(axis=1) - spacing_m / 2
    discs = np.column_stack([inner, radii])[radii > spacing_m / 2]
    rim = np.column_stack([outline, np.zeros(len(outline))])
    return np.ascontiguousarray(np.concatenate([rim, discs]))


def body_clearance(
    distances: DistanceLevels,
    spec: GridSpec,
    body: NDArray[np.float64],
    poses: NDArray[np.float64],
    *,
    outside_m: float = 0.0,
    enough_m: float = math.inf,
) -> NDArray[np.float64]:
    """Clearance between a body and the nearest obstacle at each pose.

    The least distance at the body's points (bilinear between the centres of four
    cells), less half a cell's diagonal: an obstacle may fill its cell.

    Args:
        distances: (H, W) to the obstacles.
        spec: geometry of that grid.
        body: (K, 2) x, y or (K, 3) x, y, disc radius in the base frame, metres;
            see :func:`body_points`.
        poses: (N, 3) x, y, yaw of the base in the grid's frame, metres and radians.
        outside_m: distance of points outside the grid.
        enough_m: a pose whose centre alone proves this clearance gets that lower
            bound; infinite = always evaluate every point.

    Returns:
        (N,) float64 metres; negative = the body touches an obstacle's cell.

    Raises:
        InvalidValueError: an array of a wrong type or shape.
    """
    level = grid_array("level", distances.level, level_type(distances.metres), spec)
    points = kernel_array("body", body, np.float64)
    if points.shape[0] < 1 or points.shape[1] not in (2, 3):
        raise InvalidValueError(
            f"body: shape {points.shape}, expected (K, 2) or (K, 3)"
        )
    at = kernel_array("poses", poses, np.float64, allow_empty=True)
    if at.shape[1] != 3:
        raise InvalidValueError(f"poses: shape {at.shape}, expected (N, 3)")
    clearance = np.empty(len(at))
    field = DistanceLevels(level, distances.metres)
    grid = DistanceGrid(field, grid_frame(spec), float(outside_m))
    _clearances(grid, make_body(points), at, float(enough_m), clearance)
    return clearance


@kernel(allocates=False)
def distance_at(grid: DistanceGrid, x: float, y: float) -> float:
    """Distance (m) at a point of the grid's frame, bilinear between cell centres.

    Beyond the outermost centres the border cell's value applies, outside the grid
    ``grid.outside_m``.
    """
    u, v, _, _ = _to_cells(grid.frame, x, y, 0.0)
    metres: float = _interpolate(grid.distances, u, v, grid.outside_m)
    return metres


@kernel(allocates=False)
def pose_clearance(
    grid: DistanceGrid, body: Body, x: float, y: float, yaw: float, enough_m: float
) -> float:
    """:func:`body_clearance` at one pose, for other kernels."""
    distances, outside_m = grid.distances, grid.outside_m
    margin: float = HALF_DIAGONAL * grid.frame.resolution
    u, v, cos, sin = _to_cells(grid.frame, x, y, yaw)
    if enough_m < np.inf:
        bound: float = _interpolate(distances, u, v, outside_m) - body.reach_m - margin
        if bound >= enough_m:
            return bound
    points = body.points
    least: float = np.inf
    for k in range(points.shape[0]):
        bx, by = points[k, 0], points[k, 1]
        pu, pv = u + cos * bx - sin * by, v + sin * bx + cos * by
        here: float = _interpolate(distances, pu, pv, outside_m)
        if points.shape[1] > 2:
            here -= points[k, 2]
        least = min(least, here)
    return least - margin


@kernel(allocates=False)
def pose_is_clear(
    grid: DistanceGrid, body: Body, x: float, y: float, yaw: float, needed_m: float
) -> bool:
    """Whether :func:`pose_clearance` is at least ``needed_m``; stops early."""
    distances, outside_m = grid.distances, grid.outside_m
    needed = needed_m + HALF_DIAGONAL * grid.frame.resolution
    u, v, cos, sin = _to_cells(grid.frame, x, y, yaw)
    if _interpolate(distances, u, v, outside_m) - body.reach_m >= needed:
        return True
    points = body.points
    for k in range(points.shape[0]):
        bx, by = points[k, 0], points[k, 1]
        pu, pv = u + cos * bx - sin * by, v + sin * bx + cos * by
        here: float = _interpolate(distances, pu, pv, outside_m)
        if points.shape[1] > 2:
            here -= points[k, 2]
        if here < needed:
            return False
    return True


@kernel(inline="always")
def _to_cells(
    frame: GridFrame, x: float, y: float, yaw: float
) -> tuple[float, float, float, float]:
    """A pose in cells: u (columns), v (rows), and cos, sin in cells per metre."""
    per_metre = 1.0 / frame.resolution
    dx, dy = (x - frame.x) * per_metre, (y - frame.y) * per_metre
    u = frame.cos * dx + frame.sin * dy
    v = frame.cos * dy - frame.sin * dx
    cos, sin = math.cos(yaw) * per_metre, math.sin(yaw) * per_metre
    return (u, v, frame.cos * cos + frame.sin * sin, frame.cos * sin - frame.sin * cos)


@kernel(allocates=False)
def _interpolate(
    distances: DistanceLevels, u: float, v: float, outside_m: float
) -> float:
    """Bilinear distance at the point (u columns, v rows) from the grid's corner."""
    level, metres = distances.level, distances.metres
    height, width = level.shape
    # In this form a point that is not finite counts as outside.
    if not (0.0 <= u < width and 0.0 <= v < height):
        return outside_m
    u = min(max(u - 0.5, 0.0), width - 1.0)
    v = min(max(v - 0.5, 0.0), height - 1.0)
    # Unsigned indices avoid the check for negative ones.
    c, r = np.uint32(u), np.uint32(v)
    c1 = np.uint32(min(c + 1, width - 1))
    r1 = np.uint32(min(r + 1, height - 1))
    fu, fv = u - c, v - r
    low: float = (1.0 - fu) * metres[level[r, c]] + fu * metres[level[r, c1]]
    high: float = (1.0 - fu) * metres[level[r1, c]] + fu * metres[level[r1, c1]]
    return (1.0 - fv) * low + fv * high


@kernel(allocates=False)
def _clearances(
    grid: DistanceGrid,
    body: Body,
    poses: NDArray[np.float64],
    enough_m: float,
    clearance: NDArray[np.float64],
) -> None:
    for n in range(poses.shape[0]):
        x, y, yaw = poses[n, 0], poses[n, 1], poses[n, 2]
        clearance[n] = pose_clearance(grid, body, x, y, yaw, enough_m)
