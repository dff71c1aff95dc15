"""How far a body is from the nearest obstacle, read from a distance field."""

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Footprint
from navette.grids.checks import grid_array, kernel_array
from navette.grids.spec import GridSpec

# Of a cell, in cells: an obstacle may fill its cell to the corners.
HALF_DIAGONAL = math.sqrt(0.5)

GridFrame = tuple[float, float, float, float, float]


def grid_frame(spec: GridSpec) -> GridFrame:
    """(x, y, cos yaw, sin yaw, resolution) of a grid: what kernels take of a spec."""
    yaw = spec.origin.yaw
    return (
        float(spec.origin.x),
        float(spec.origin.y),
        math.cos(yaw),
        math.sin(yaw),
        float(spec.resolution),
    )


def body_points(footprint: Footprint, spacing: float) -> NDArray[np.float64]:
    """Points that stand for a body: its outline, and discs that fill it.

    An outline alone does not see a thin post inside the body. Each inner point
    therefore carries the radius of the largest disc about it inside the outline;
    its distance counts less that radius, which never lowers the clearance to
    anything outside.

    Args:
        footprint: the outline in the base frame.
        spacing: between neighbouring points of the outline, m; a cell is right.

    Returns:
        (K, 3) x, y, disc radius in metres; the outline first (radius 0).
    """
    outline = footprint.samples(spacing)
    step = max(spacing, footprint.inscribed_radius / 2)
    low, high = outline.min(axis=0), outline.max(axis=0)
    xs = np.arange(low[0] + step / 2, high[0], step)
    ys = np.arange(low[1] + step / 2, high[1], step)
    inner = np.array([(0.0, 0.0), *((x, y) for x in xs for y in ys)])
    inner = inner[[_contains(footprint, x, y) for x, y in inner]]
    gaps = inner[:, None, :] - outline[None, :, :]
    # Outline samples are up to half a spacing away from the outline's nearest point.
    radii = np.hypot(gaps[..., 0], gaps[..., 1]).min(axis=1) - spacing / 2
    discs = np.column_stack([inner, radii])[radii > spacing / 2]
    rim = np.column_stack([outline, np.zeros(len(outline))])
    return np.ascontiguousarray(np.concatenate([rim, discs]))


def body_clearance(
    distance_m: NDArray[np.float32],
    spec: GridSpec,
    body: NDArray[np.float64],
    poses: NDArray[np.float64],
    *,
    outside_m: float = 0.0,
    enough_m: float = math.inf,
) -> NDArray[np.float64]:
    """Clearance between a body and the nearest obstacle at each pose.

    The least distance at the body's points (between the centres of four cells,
    interpolated), less half a cell's diagonal: an obstacle may fill its cell.

    Args:
        distance_m: (H, W) float32 from :func:`navette.grids.distance_field`.
        spec: where that grid lies.
        body: (K, 2) x, y or (K, 3) x, y, disc radius in the base frame, metres;
            see :func:`body_points`.
        poses: (N, 3) x, y, yaw of the base in the grid's frame, metres and radians.
        outside_m: the distance that holds for points outside the grid.
        enough_m: a pose whose centre alone proves this clearance gets that lower
            bound; infinite = always look at every point.

    Returns:
        (N,) float64 metres; negative = the body touches an obstacle's cell.
    """
    field = grid_array("distance_m", distance_m, np.float32, spec)
    points = kernel_array("body", body, np.float64)
    if points.shape[0] < 1 or points.shape[1] not in (2, 3):
        raise InvalidValueError(f"body: shape {points.shape}, wanted (K, 2) or (K, 3)")
    at = kernel_array("poses", poses, np.float64, allow_empty=True)
    if at.shape[1] != 3:
        raise InvalidValueError(f"poses: shape {at.shape}, wanted (N, 3)")
    reach = float(np.hypot(points[:, 0], points[:, 1]).max())
    clearance = np.empty(len(at))
    _clearances(
        field,
        grid_frame(spec),
        points,
        reach,
        at,
        float(outside_m),
        float(enough_m),
        clearance,
    )
    return clearance


@njit(cache=True)
def distance_at(
    distance_m: Any, frame: Any, x: float, y: float, outside_m: float
) -> float:
    """Distance (m) at a point of the grid's frame, bilinear between cell centres.

    Beyond the outermost centres the border cell's value holds; outside the grid
    ``outside_m`` does. ``frame`` is :func:`grid_frame` of the grid's spec.
    """
    u, v, _, _ = _to_cells(frame, x, y, 0.0)
    metres: float = _interpolate(distance_m, u, v, outside_m)
    return metres


@njit(cache=True)
def pose_clearance(
    distance_m: Any,
    frame: Any,
    body: Any,
    reach_m: float,
    x: float,
    y: float,
    yaw: float,
    outside_m: float,
    enough_m: float,
) -> float:
    """:func:`body_clearance` at one pose; for use inside other kernels.

    ``body`` is (K, 2) or (K, 3) float64, ``reach_m`` the largest distance of its
    points from the base origin (the circumscribed radius).
    """
    margin: float = HALF_DIAGONAL * frame[4]
    u, v, cos, sin = _to_cells(frame, x, y, yaw)
    if enough_m < np.inf:
        bound: float = _interpolate(distance_m, u, v, outside_m) - reach_m - margin
        if bound >= enough_m:
            return bound
    least: float = np.inf
    for k in range(body.shape[0]):
        bx, by = body[k, 0], body[k, 1]
        pu, pv = u + cos * bx - sin * by, v + sin * bx + cos * by
        here: float = _interpolate(distance_m, pu, pv, outside_m)
        if body.shape[1] > 2:
            here -= body[k, 2]
        least = min(least, here)
    return least - margin


@njit(cache=True)
def pose_is_clear(
    distance_m: Any,
    frame: Any,
    body: Any,
    reach_m: float,
    x: float,
    y: float,
    yaw: float,
    outside_m: float,
    needed_m: float,
) -> bool:
    """Whether :func:`pose_clearance` is at least ``needed_m``; stops when it knows."""
    needed = needed_m + HALF_DIAGONAL * frame[4]
    u, v, cos, sin = _to_cells(frame, x, y, yaw)
    if _interpolate(distance_m, u, v, outside_m) - reach_m >= needed:
        return True
    for k in range(body.shape[0]):
        bx, by = body[k, 0], body[k, 1]
        pu, pv = u + cos * bx - sin * by, v + sin * bx + cos * by
        here: float = _interpolate(distance_m, pu, pv, outside_m)
        if body.shape[1] > 2:
            here -= body[k, 2]
        if here < needed:
            return False
    return True


@njit(cache=True, inline="always")
def _to_cells(
    frame: Any, x: float, y: float, yaw: float
) -> tuple[float, float, float, float]:
    """A pose in cells: u (columns), v (rows), and cos, sin in cells per metre."""
    per_metre = 1.0 / frame[4]
    dx, dy = (x - frame[0]) * per_metre, (y - frame[1]) * per_metre
    u = frame[2] * dx + frame[3] * dy
    v = frame[2] * dy - frame[3] * dx
    cos, sin = math.cos(yaw) * per_metre, math.sin(yaw) * per_metre
    return (
        u,
        v,
        frame[2] * cos + frame[3] * sin,
        frame[2] * sin - frame[3] * cos,
    )


@njit(cache=True)
def _interpolate(distance_m: Any, u: float, v: float, outside_m: float) -> float:
    """Bilinear distance at the point (u columns, v rows) from the grid's corner."""
    height, width = distance_m.shape
    # Written so that a point that is not finite counts as outside.
    if not (0.0 <= u < width and 0.0 <= v < height):
        return outside_m
    u = min(max(u - 0.5, 0.0), width - 1.0)
    v = min(max(v - 0.5, 0.0), height - 1.0)
    # Unsigned indices spare the check for negative ones.
    c, r = np.uint32(u), np.uint32(v)
    c1 = np.uint32(min(c + 1, width - 1))
    r1 = np.uint32(min(r + 1, height - 1))
    fu, fv = u - c, v - r
    low: float = (1.0 - fu) * distance_m[r, c] + fu * distance_m[r, c1]
    high: float = (1.0 - fu) * distance_m[r1, c] + fu * distance_m[r1, c1]
    return (1.0 - fv) * low + fv * high


@njit(cache=True)
def _clearances(
    distance_m: Any,
    frame: Any,
    body: Any,
    reach_m: float,
    poses: Any,
    outside_m: float,
    enough_m: float,
    clearance: Any,
) -> None:
    for n in range(poses.shape[0]):
        clearance[n] = pose_clearance(
            distance_m,
            frame,
            body,
            reach_m,
            poses[n, 0],
            poses[n, 1],
            poses[n, 2],
            outside_m,
            enough_m,
        )


def _contains(footprint: Footprint, x: float, y: float) -> bool:
    """Whether the point lies in the outline (ray casting along +x)."""
    inside = False
    corners = footprint.vertices
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
        if (ay > y) != (by > y) and ax + (y - ay) * (bx - ax) / (by - ay) > x:
            inside = not inside
    return inside
