"""Exact signed distance between a polygon and obstacles, without a distance field.

Planning and control use the same measure: the distance from the outline to the points
at which beams ended (see :mod:`navette.navigation.grids.sub_cells`), or, in a lethal
cell without points, to its centre less half a cell. The sampled distance field of
:mod:`navette.navigation.grids.clearance` is a fast lower bound for thousands of poses,
but changes by a cell when the body moves by a millimetre, which is too coarse to decide
whether a motion leads away from an obstacle or whether a body fits a tight gap.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Footprint
from navette.navigation.grids.clearance import HALF_DIAGONAL
from navette.navigation.grids.spec import GridFrame, GridSpec, grid_frame
from navette.navigation.grids.sub_cells import (
    NO_POINTS,
    SUB_CELLS,
    CellMarks,
    Points,
    mask_at,
)

Array = NDArray[np.float64]

_BLOCK = 16  # cells of a row that are skipped at once where none is lethal
_LEVEL = 1e-9  # sine of an angle that is none


class Outline(NamedTuple):
    """A body's outline for kernels: vertices (K, 2) and circumscribed radius, m."""

    vertices: Array
    radius_m: float


class ObstacleGrid(NamedTuple):
    """Lethal cells for kernels.

    Attributes:
        lethal: (H, W) uint8, 1 = lethal.
        frame: the grid's frame.
        marks: the points within the cells.
    """

    lethal: NDArray[np.uint8]
    frame: GridFrame
    marks: CellMarks


def make_outline(footprint: Footprint) -> Outline:
    """Return the outline of a footprint (base frame)."""
    vertices = np.array(footprint.vertices, np.float64)
    return Outline(vertices, float(footprint.circumscribed_radius))


def make_obstacles(
    lethal: NDArray[np.uint8], spec: GridSpec, points: Points = NO_POINTS
) -> ObstacleGrid:
    """Return the lethal cells (H, W) of a grid.

    Args:
        lethal: (H, W) uint8, 1 = lethal.
        spec: their geometry.
        points: (N, 2) in the grid's frame, m, where beams ended.
    """
    cells, marks = np.ascontiguousarray(lethal), CellMarks.of(spec, points)
    return ObstacleGrid(cells, grid_frame(spec), marks)


def exact_clearances(
    obstacles: ObstacleGrid, outline: Outline, poses: Array, horizon_m: float
) -> Array:
    """Return (N,) the clearance in metres of the outline at poses (N, 3), at most the
    horizon; negative = the body overlaps an obstacle's cell.
    """
    clearance = np.empty(len(poses))
    _exact_clearances(obstacles, outline, np.ascontiguousarray(poses), horizon_m,
                      clearance)  # fmt: skip
    return clearance


@kernel(allocates=False, signature="float64(float64[:, ::1], float64, float64)")
def signed_distance(outline: Array, x: float, y: float) -> float:
    """Return the distance (m) of (x, y) to the polygon (K, 2), negative inside."""
    best = np.inf
    inside = False
    count = outline.shape[0]
    ax, ay = outline[count - 1, 0], outline[count - 1, 1]
    for k in range(count):
        bx, by = outline[k, 0], outline[k, 1]
        ex, ey = bx - ax, by - ay
        px, py = x - ax, y - ay
        t = min(1.0, max(0.0, (px * ex + py * ey) / (ex * ex + ey * ey)))
        dx, dy = px - t * ex, py - t * ey
        best = min(best, dx * dx + dy * dy)
        if (ay > y) != (by > y) and px < ex * py / ey:
            inside = not inside
        ax, ay = bx, by
    distance = math.sqrt(best)
    return -distance if inside else distance


@kernel(allocates=False)
def bounding_box(outline: Array) -> tuple[float, float, float, float]:
    """Return the centre x, y of the box around a polygon (K, 2), and half its size."""
    low_x = high_x = outline[0, 0]
    low_y = high_y = outline[0, 1]
    for k in range(1, outline.shape[0]):
        low_x, high_x = min(low_x, outline[k, 0]), max(high_x, outline[k, 0])
        low_y, high_y = min(low_y, outline[k, 1]), max(high_y, outline[k, 1])
    x, y = 0.5 * (low_x + high_x), 0.5 * (low_y + high_y)
    return x, y, high_x - x, high_y - y


@kernel(allocates=False)
def off_box(box: tuple[float, float, float, float], x: float, y: float) -> float:
    """Return a distance that is no larger than the one to the polygon in the box."""
    off: float = max(abs(x - box[0]) - box[2], abs(y - box[1]) - box[3])
    return off


@kernel(
    allocates=False,
    signature="float64(float64[:, ::1], float64[:, ::1], float64, float64, float64,"
    " float64, float64)",
)
def body_distance(
    points: Array,
    outline: Array,
    x: float,
    y: float,
    yaw: float,
    radius: float,
    horizon: float,
) -> float:
    """Return the least signed distance (m) from the body to the points, ≤ horizon."""
    c, s = math.cos(yaw), math.sin(yaw)
    box = bounding_box(outline)
    best = horizon
    for i in range(points.shape[0]):
        dx, dy = points[i, 0] - x, points[i, 1] - y
        near = radius + best
        if near <= 0.0 or dx * dx + dy * dy >= near * near:
            continue
        px, py = c * dx + s * dy, c * dy - s * dx
        if off_box(box, px, py) < best:
            best = min(best, signed_distance(outline, px, py))
    return best


@kernel(allocates=False)
def exact_clearance(
    obstacles: ObstacleGrid,
    outline: Outline,
    x: float,
    y: float,
    yaw: float,
    horizon_m: float,
) -> float:
    """:func:`exact_clearances` at one pose, for other kernels."""
    frame = obstacles.frame
    size = frame.resolution
    dx, dy = x - frame.x, y - frame.y
    u = (frame.cos * dx + frame.sin * dy) / size
    v = (frame.cos * dy - frame.sin * dx) / size
    reach = (outline.radius_m + horizon_m) / size + 1.0
    height, width = obstacles.lethal.shape
    # In this form a pose that is not finite overlaps.
    inside = -reach <= u <= width + reach and -reach <= v <= height + reach
    if not (inside and abs(yaw) < np.inf):
        return -outline.radius_m
    first_row, last_row = max(0, int(v - reach)), min(height, int(v + reach) + 1)
    first, last = max(0, int(u - reach)), min(width, int(u + reach) + 1)
    # Rotation from the grid's axes to the body's.
    c, s = math.cos(yaw), math.sin(yaw)
    cos = c * frame.cos + s * frame.sin
    sin = s * frame.cos - c * frame.sin
    box = bounding_box(outline.vertices)
    # Cells along a row for each metre in the directions of the body.
    along = 1.0 / (size * (cos if abs(cos) > _LEVEL else _LEVEL))
    across = 1.0 / (size * (sin if abs(sin) > _LEVEL else _LEVEL))
    best = horizon_m
    for row in range(first_row, last_row):
        line = obstacles.lethal[row]
        gy = (row + 0.5 - v) * size
        # Columns at which a cell may be nearer to the body than the nearest so far.
        off = best + HALF_DIAGONAL * size
        ahead, beside = (box[0] - sin * gy) * along, (cos * gy - box[1]) * across
        long, wide = (box[2] + off) * abs(along), (box[3] + off) * abs(across)
        begin = max(first, int(max(ahead - long, beside - wide) + u - 0.5))
        end = min(last, int(min(ahead + long, beside + wide) + u + 1.5))
        for block in range(begin, end, _BLOCK):
            if not _any(line, block):
                continue
            for column in range(block, min(block + _BLOCK, end)):
                if not line[column]:
                    continue
                gx = (column + 0.5 - u) * size
                bx, by = cos * gx + sin * gy, cos * gy - sin * gx
                if off_box(box, bx, by) - HALF_DIAGONAL * size >= best:
                    continue
                distance = signed_distance(outline.vertices, bx, by)
                if distance - HALF_DIAGONAL * size >= best:
                    continue
                mask = mask_at(obstacles.marks, row, column)
                if mask == 0:
                    best = min(best, distance - 0.5 * size)
                else:
                    best = min(best, _of_points(outline, mask, size, bx, by, cos, sin))
    return best


@kernel(allocates=False)
def _any(line: NDArray[np.uint8], begin: int) -> bool:
    """Return whether a cell of a block is lethal."""
    found = np.uint8(0)
    if begin + _BLOCK <= line.size:
        for k in range(_BLOCK):  # the constant length is vectorised
            found |= line[np.uintp(begin + k)]
    else:
        for column in range(begin, line.size):
            found |= line[column]
    return bool(found)


@kernel(allocates=False)
def _of_points(
    outline: Outline,
    mask: np.uint64,
    size: float,
    x: float,
    y: float,
    cos: float,
    sin: float,
) -> float:
    """Least distance to the points of a cell centred at (x, y), both in the base."""
    best = np.inf
    step = size / SUB_CELLS
    for bit in range(SUB_CELLS * SUB_CELLS):
        if not (mask >> np.uint64(bit)) & np.uint64(1):
            continue
        gx = (bit % SUB_CELLS + 0.5) * step - 0.5 * size
        gy = (bit // SUB_CELLS + 0.5) * step - 0.5 * size
        distance = signed_distance(
            outline.vertices, x + cos * gx + sin * gy, y + cos * gy - sin * gx
        )
        best = min(best, distance)
    return best - 0.5 * step


@kernel(allocates=False)
def _exact_clearances(
    obstacles: ObstacleGrid,
    outline: Outline,
    poses: Array,
    horizon_m: float,
    clearance: Array,
) -> None:
    for n in range(poses.shape[0]):
        clearance[n] = exact_clearance(
            obstacles, outline, poses[n, 0], poses[n, 1], poses[n, 2], horizon_m
        )
