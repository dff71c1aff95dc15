"""Obstacles around a pose, as points in the map."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids.spec import FREE, GridSpec

PART = 64  # cells of a row that are searched at once
# Distance of the points inside filled areas: no body fits between them.
_INSIDE_M = 0.1


def obstacle_points(
    cost: NDArray[np.int8],
    spec: GridSpec,
    map_T_grid: Pose2,
    *,
    lethal_cost: int,
    around: Pose2,
    reach_m: float,
) -> NDArray[np.float64]:
    """Return centres (N, 2), metres, map, of the lethal cells within reach of a pose.

    Inside filled areas, as in maps of buildings, only a cell every 0.1 m is returned:
    from outside, the nearest lethal cell is at the border.

    Args:
        cost: (H, W), or flat in that order; 0 … 100, −1 unknown. Unknown cells
            do not count as obstacles: the grid is unknown behind every hit, and may
            be unknown under the body.
        spec: geometry of ``cost`` in its frame.
        map_T_grid: pose of that frame in the map at the costmap's stamp.
        lethal_cost: value from which a cell is an obstacle.
        around: centre of the region (map).
        reach_m: radius of the region.

    Raises:
        InvalidValueError: the size of ``cost`` does not match ``spec``.
    """
    if cost.size != spec.width * spec.height:
        raise InvalidValueError(
            f"costmap of {cost.size} cells: expected {spec.width} x {spec.height}"
        )
    map_T_origin = map_T_grid @ spec.origin
    origin_T_around = map_T_origin.inverse() @ around
    return _gather(
        cost.reshape(spec.shape),
        lethal_cost,
        origin_T_around.x / spec.resolution,
        origin_T_around.y / spec.resolution,
        reach_m / spec.resolution,
        spec.resolution,
        max(1, int(_INSIDE_M / spec.resolution + 1e-6)),
        *map_T_origin,
    )


def points_within(
    points: NDArray[np.float64],
    map_T_frame: Pose2,
    *,
    around: Pose2,
    reach_m: float,
) -> NDArray[np.float64]:
    """Return the points (N, 2) of a frame, m, within reach of a pose, in the map."""
    found: NDArray[np.float64] = _within(
        points, np.array(map_T_frame), np.array(around), float(reach_m)
    )
    return found


@kernel
def _within(points: Any, map_T_frame: Any, around: Any, reach: float) -> Any:
    x, y, yaw = map_T_frame
    c, s = math.cos(yaw), math.sin(yaw)
    kept = np.empty_like(points)
    count = 0
    for k in range(points.shape[0]):
        px = x + c * points[k, 0] - s * points[k, 1]
        py = y + s * points[k, 0] + c * points[k, 1]
        if (px - around[0]) ** 2 + (py - around[1]) ** 2 <= reach * reach:
            kept[count, 0], kept[count, 1] = px, py
            count += 1
    return kept[:count]


@kernel(allocates=False)
def holds_lethal(line: Any, lethal: int) -> bool:
    """Return whether a part of a row has a lethal cell: most have none.

    This is vectorised, which finding the cells is not.
    """
    highest = np.int8(FREE)
    for k in range(line.size):
        highest = max(highest, line[k])
    return bool(highest >= lethal)


@kernel
def _gather(
    cost: Any,
    lethal: int,
    column: float,
    row: float,
    reach: float,
    resolution: float,
    step: int,
    x: float,
    y: float,
    yaw: float,
) -> NDArray[np.float64]:
    """Return lethal cells within ``reach`` of (column, row), all in cells, as points.

    ``step``: of the cells inside filled areas. ``x, y, yaw``: pose of the grid's corner
    in the frame of the points.
    """
    top, left = max(0, int(row - reach)), max(0, int(column - reach))
    bottom = max(top, min(cost.shape[0], int(row + reach) + 1))
    right = max(left, min(cost.shape[1], int(column + reach) + 1))
    points = np.empty((256, 2))
    count = 0
    c, s = math.cos(yaw) * resolution, math.sin(yaw) * resolution
    for i in range(top, bottom):
        v = i + 0.5
        for first in range(left, right, PART):
            line = cost[i, first : min(right, first + PART)]
            if not holds_lethal(line, lethal):
                continue
            if count + PART > points.shape[0]:
                points = np.concatenate((points, np.empty_like(points)))
            for j in range(line.size):
                u = first + j + 0.5
                if line[j] < lethal or (u - column) ** 2 + (v - row) ** 2 > reach**2:
                    continue
                on_step = i % step == 0 and (first + j) % step == 0
                if on_step or not _is_inside(cost, i, first + j, lethal):
                    points[count, 0] = x + c * u - s * v
                    points[count, 1] = y + s * u + c * v
                    count += 1
    return points[:count].copy()


@kernel(allocates=False)
def _is_inside(cost: Any, row: int, column: int, lethal: int) -> bool:
    """Return whether the four cells beside a cell are lethal, too."""
    height, width = cost.shape
    if not (0 < row < height - 1 and 0 < column < width - 1):
        return False
    across = min(cost[row, column - 1], cost[row, column + 1])
    along = min(cost[row - 1, column], cost[row + 1, column])
    return bool(min(across, along) >= lethal)
