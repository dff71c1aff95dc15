"""Moving obstacles as discs: from the message of the tracking, predicted in time."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidInputError
from navette.geometry import Pose2
from navette.geometry.messages import stamp_of
from navette.msgs.nav2_dynamic_msgs.msg import ObstacleArray
from navette.navigation.grids.checks import check_frame
from navette.navigation.grids.spec import UNKNOWN, Cells, GridSpec

Array = NDArray[np.float64]


class MovingDiscs(NamedTuple):
    """Discs (M, 5) x, y (m), vx, vy (m/s), radius (m) in the map at a stamp."""

    discs: Array
    stamp_ns: int

    def at(self, stamp_ns: int, longest_s: float) -> Array:
        """Return the discs (M, 5) moved to a stamp; none after ``longest_s``."""
        seconds = (stamp_ns - self.stamp_ns) / 1e9
        if not len(self.discs) or abs(seconds) > longest_s:
            return NO_DISCS
        moved = self.discs.copy()
        moved[:, :2] += seconds * moved[:, 2:4]
        return moved


_OUTLINE_POINTS = 24
NO_DISCS: Array = np.empty((0, 5))


def discs_from_message(msg: ObstacleArray, frame: str) -> MovingDiscs:
    """Return the discs of a message in a frame.

    Raises:
        InvalidInputError: another frame, or a value that is not finite or negative.
    """
    if msg.obstacles:
        check_frame("obstacles", msg.header.frame_id, frame)
    rows = [
        (o.position.x, o.position.y, o.velocity.x, o.velocity.y,
         max(o.size.x, o.size.y) / 2)
        for o in msg.obstacles
    ]  # fmt: skip
    for row in rows:
        if not all(map(math.isfinite, row)) or row[4] < 0:
            raise InvalidInputError("not_finite", f"obstacle {row}; expected finite")
    discs = np.array(rows, np.float64).reshape(-1, 5)
    return MovingDiscs(discs, stamp_of(msg.header))


def inside_discs(points: Array, discs: Array, margin_m: float) -> NDArray[np.bool_]:
    """Return (N,) which points (N, 2) lie in a disc (M, 5) grown by a margin."""
    inside = np.zeros(len(points), np.bool_)
    for x, y, _, _, radius in discs.tolist():
        reach = radius + margin_m
        away = points - (x, y)
        inside |= (away * away).sum(axis=1) <= reach * reach
    return inside


def disc_outlines(discs: Array) -> Array:
    """Return points (N, 2) on the circles of discs (M, 5)."""
    angles = np.arange(_OUTLINE_POINTS) * (2 * math.pi / _OUTLINE_POINTS)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    points: Array = discs[:, None, :2] + discs[:, None, 4:] * circle
    return points.reshape(-1, 2)


def without_discs(cells: Cells, spec: GridSpec, discs: Array, margin_m: float) -> Cells:
    """Return the grid (H, W) with unknown cells in the discs (M, 5), grown."""
    if not len(discs):
        return cells
    kept = cells.copy()
    for x, y, _, _, radius in discs.tolist():
        centre = spec.origin.inverse() @ Pose2(x, y, 0.0)
        u, v = centre.x / spec.resolution - 0.5, centre.y / spec.resolution - 0.5
        reach = (radius + margin_m) / spec.resolution
        top, bottom = max(0, int(v - reach)), max(0, int(v + reach) + 2)
        left, right = max(0, int(u - reach)), max(0, int(u + reach) + 2)
        window = kept[top:bottom, left:right]
        rows = np.arange(top, top + window.shape[0])[:, None] - v
        columns = np.arange(left, left + window.shape[1])[None, :] - u
        window[rows * rows + columns * columns <= reach * reach] = UNKNOWN
    return kept
