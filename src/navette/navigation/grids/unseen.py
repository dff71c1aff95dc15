"""Space that was never seen, which a robot does not back into.

A lidar that covers 270° leaves the space behind a robot unseen where the robot was put
down. Space is seen if the map or the newest scan shows it, whatever it shows.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Footprint, Pose2
from navette.navigation.grids.exact_clearance import (
    Outline,
    make_outline,
    signed_distance,
)
from navette.navigation.grids.spec import UNKNOWN, GridSpec, grid_frame

Array = NDArray[np.float64]

# Largest part into which a cell at the border of the start area is divided.
_PART_M = 0.02
_MOST_PARTS = 16  # per side of a large cell
# No robot backs into space that it cannot see faster than it stops in this distance.
FARTHEST_M = 10.0


class Layer(NamedTuple):
    """Cells (H, W), −1 = not seen, with their geometry in the map frame."""

    cells: NDArray[np.int8]
    spec: GridSpec


class StartArea(NamedTuple):
    """The body where the robot was put down, and the width of a seam around it.

    The space was free when the robot was put down, with the width of a hand around it.
    Where the robot has backed into the seam, a turn in place stays within that width.
    """

    outline: Outline
    map_T_base: Pose2
    seam_m: float

    @classmethod
    def of(cls, footprint: Footprint, map_T_base: Pose2, hand_m: float) -> "StartArea":
        """Return the area of a body with ``hand_m`` free around it."""
        outline = make_outline(footprint)
        back_m = max(0.0, -float(outline.vertices[:, 0].min()))
        swing_m = outline.radius_m - back_m
        return cls(outline, map_T_base, max(0.0, hand_m - swing_m))


def unseen_points(
    layers: tuple[Layer, ...], start: StartArea, around: Pose2, reach_m: float
) -> Array:
    """Return centres (N, 2), m, of the cells that no layer has seen.

    Cells at the border of the start area are divided to represent the border exactly.

    Args:
        layers: one or two; the cells are those of the first, continued outside it.
        start: area that counts as seen.
        around: centre of the region (map).
        reach_m: radius of the region, at most 10 m of which are searched.
    """
    first, last = layers[0], layers[-1]
    return _unseen(
        first.cells,
        grid_frame(first.spec),
        last.cells,
        grid_frame(last.spec),
        start.outline.vertices,
        np.array(start.map_T_base),
        start.outline.radius_m + start.seam_m,
        start.seam_m,
        np.array((around.x, around.y)),
        min(reach_m, FARTHEST_M),
    )


def unseen_mask(layer: Layer, start: StartArea) -> NDArray[np.uint8]:
    """Return (H, W) 1 where a cell was not seen and lies outside the start area."""
    mask: NDArray[np.uint8] = (layer.cells == UNKNOWN).astype(np.uint8)
    _clear_start(
        mask,
        grid_frame(layer.spec),
        start.outline.vertices,
        np.array(start.map_T_base),
        start.outline.radius_m + start.seam_m,
        start.seam_m,
    )
    return mask


@kernel
def _unseen(
    cells: Any,
    frame: Any,
    other: Any,
    other_frame: Any,
    outline: Array,
    start: Array,
    start_reach: float,
    seam: float,
    around: Array,
    reach: float,
) -> Array:
    size = frame.resolution
    dx, dy = around[0] - frame.x, around[1] - frame.y
    u = (frame.cos * dx + frame.sin * dy) / size
    v = (frame.cos * dy - frame.sin * dx) / size
    top, left = math.floor(v - reach / size), math.floor(u - reach / size)
    count = math.ceil(2 * reach / size) + 1
    parts = max(1, min(_MOST_PARTS, math.ceil(size / _PART_M)))
    points = np.empty((count * count + parts * parts, 2))
    found = 0
    for row in range(top, top + count):
        for column in range(left, left + count):
            if _is_known(cells, row, column):
                continue
            gx, gy = (column + 0.5) * size, (row + 0.5) * size
            x = frame.x + frame.cos * gx - frame.sin * gy
            y = frame.y + frame.sin * gx + frame.cos * gy
            if (x - around[0]) ** 2 + (y - around[1]) ** 2 > reach * reach:
                continue
            dx, dy = x - other_frame.x, y - other_frame.y
            there_u = (other_frame.cos * dx + other_frame.sin * dy) / (
                other_frame.resolution
            )
            there_v = (other_frame.cos * dy - other_frame.sin * dx) / (
                other_frame.resolution
            )
            if _is_known(other, math.floor(there_v), math.floor(there_u)):
                continue
            if found + parts * parts > points.shape[0]:
                points = np.concatenate((points, np.empty_like(points)))
            near = _to_start(outline, start, start_reach + size, x, y) - seam
            if near > size:
                points[found, 0], points[found, 1] = x, y
                found += 1
            elif near > -size:
                found = _divide(
                    points, found, (x, y), frame, parts, outline, start, seam
                )
    return points[:found].copy()


@kernel
def _divide(
    points: Array,
    found: int,
    center: Any,
    frame: Any,
    parts: int,
    outline: Array,
    start: Array,
    seam: float,
) -> int:
    """Append the parts of a cell that lie outside the start area."""
    step = frame.resolution / parts
    for i in range(parts):
        for j in range(parts):
            gx = (j + 0.5) * step - 0.5 * frame.resolution
            gy = (i + 0.5) * step - 0.5 * frame.resolution
            x = center[0] + frame.cos * gx - frame.sin * gy
            y = center[1] + frame.sin * gx + frame.cos * gy
            if _to_start(outline, start, np.inf, x, y) > seam:
                points[found, 0], points[found, 1] = x, y
                found += 1
    return found


@kernel
def _clear_start(
    mask: Any, frame: Any, outline: Array, start: Array, reach: float, seam: float
) -> None:
    size = frame.resolution
    dx, dy = start[0] - frame.x, start[1] - frame.y
    u = (frame.cos * dx + frame.sin * dy) / size
    v = (frame.cos * dy - frame.sin * dx) / size
    span = reach / size + 2
    for row in range(max(0, int(v - span)), min(mask.shape[0], int(v + span) + 1)):
        for column in range(
            max(0, int(u - span)), min(mask.shape[1], int(u + span) + 1)
        ):
            gx, gy = (column + 0.5) * size, (row + 0.5) * size
            x = frame.x + frame.cos * gx - frame.sin * gy
            y = frame.y + frame.sin * gx + frame.cos * gy
            # Control looks closer than a cell.
            if _to_start(outline, start, reach + size, x, y) <= seam + 0.5 * size:
                mask[row, column] = 0


@kernel
def _is_known(cells: Any, row: int, column: int) -> bool:
    inside = 0 <= row < cells.shape[0] and 0 <= column < cells.shape[1]
    return bool(inside and cells[row, column] != UNKNOWN)


@kernel
def _to_start(outline: Array, start: Array, reach: float, x: float, y: float) -> float:
    """Return the distance (m) to the body at the start; infinite beyond its reach."""
    dx, dy = x - start[0], y - start[1]
    if dx * dx + dy * dy > reach * reach:
        return np.inf
    c, s = math.cos(start[2]), math.sin(start[2])
    distance: float = signed_distance(outline, c * dx + s * dy, c * dy - s * dx)
    return distance
