"""What a body can reach in a world, from exact geometry: the truth behind a drive.

For each heading, an obstacle closes the poses of the body inside the Minkowski sum of
the obstacle and the mirrored body (Lozano-Pérez 1983). For convex outlines that is an
intersection of half-planes. A flood through the open poses of a fine grid connects
them. This is independent of the planner: no map, no scan, no search.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import ACKERMANN, OMNI, Pose2
from navette.navigation.grids import GridSpec

HEADINGS = 72
# Cells along the longer edge of the world.
_CELLS = 360

# Clearance of a body that certainly fits, and of a start that is one.
_SURE_M, _START_M = 0.06, 0.02

Open = NDArray[np.bool_]
Points = NDArray[np.float64]


class Reach(StrEnum):
    """Result of exact geometry for a goal."""

    SURE = "sure"
    """The body gets there with 6 cm to every obstacle."""

    UNSURE = "unsure"
    ENCLOSED = "enclosed"
    """The body fits at the goal, and certainly does not get there."""

    BLOCKED = "blocked"
    """The body fits nowhere within the tolerance."""


def goal_reach(
    obstacles: Sequence[Points],
    body: Points,
    start: Pose2,
    goal: tuple[float, float],
    *,
    drive: str,
    tolerance_m: float,
    turning_radius_m: float = 0.0,
) -> Reach:
    """Return whether a body reaches a goal (m, map) within the tolerance.

    What is certain holds for every motion of the body; what is sure is a path on which
    a drive moves along its heading and turns in place, or steers forward with a least
    radius: a car does not back up into space that it has never measured.
    """
    radius = float(np.hypot(*body.T).max())
    ends = np.array([(start.x, start.y), goal])
    world = WorldGeometry.around(obstacles, body, ends, 1.5 * radius)
    at, size = world.index_of(start), world.spec.resolution
    loose = world.open_poses(-world.slack_m)
    loose[at] = True
    near = world.disc(goal, tolerance_m + size)
    if not loose[:, near].any():
        return Reach.BLOCKED
    if not connected(loose, at, sideways=True)[:, near].any():
        return Reach.ENCLOSED
    roomy = world.open_poses(_SURE_M)
    beside = world.disc((start.x, start.y), radius)
    roomy[:, beside] |= world.open_poses(_START_M)[:, beside]
    roomy[at] = True
    if drive == ACKERMANN:
        reached = steered(roomy, world.spec, start, turning_radius_m)
    else:
        reached = connected(roomy, at, sideways=drive == OMNI)
    inner = world.disc(goal, max(0.5 * tolerance_m, size))
    return Reach.SURE if reached[:, inner].any() else Reach.UNSURE


@dataclass(frozen=True)
class WorldGeometry:
    """Convex obstacles and a convex body, counter-clockwise outlines (N, 2), m.

    Attributes:
        obstacles: in the map frame.
        body: in the base frame.
        spec: cells of the poses, not rotated.
    """

    obstacles: Sequence[Points]
    body: Points
    spec: GridSpec

    @classmethod
    def around(
        cls, obstacles: Sequence[Points], body: Points, points: Points, beyond_m: float
    ) -> "WorldGeometry":
        """Return the geometry in cells that contain all obstacles and points (N, 2)."""
        corners = np.concatenate([*obstacles, points])
        low, high = corners.min(axis=0) - beyond_m, corners.max(axis=0) + beyond_m
        size = float((high - low).max()) / _CELLS
        width, height = np.ceil((high - low) / size).astype(int).tolist()
        spec = GridSpec(size, width, height, Pose2(float(low[0]), float(low[1]), 0.0))
        return cls(obstacles, body, spec)

    def open_poses(self, margin_m: float) -> Open:
        """Return (HEADINGS, H, W) where the body keeps a margin to every obstacle.

        A negative margin shrinks the closed poses.
        """
        spec = self.spec
        opened = np.ones((HEADINGS, spec.height, spec.width), np.bool_)
        for k in range(HEADINGS):
            c, s = math.cos(math.tau * k / HEADINGS), math.sin(math.tau * k / HEADINGS)
            mirrored = -self.body @ np.array([[c, s], [-s, c]])
            for outline in self.obstacles:
                self._close(opened[k], outline, mirrored, margin_m)
        return opened

    def _close(
        self, opened: Open, outline: Points, mirrored: Points, margin_m: float
    ) -> None:
        """Close the cells in the sum of two outlines, grown by the margin."""
        normals = np.concatenate([_normals(outline), _normals(mirrored)])
        offsets = (outline @ normals.T).max(axis=0) + (mirrored @ normals.T).max(axis=0)
        spec, origin = self.spec, np.array([self.spec.origin.x, self.spec.origin.y])
        low = outline.min(axis=0) + mirrored.min(axis=0) - margin_m - origin
        high = outline.max(axis=0) + mirrored.max(axis=0) + margin_m - origin
        first = np.maximum(np.floor(low / spec.resolution), 0).astype(int)
        last = np.ceil(high / spec.resolution).astype(int) + 1
        part = opened[first[1] : last[1], first[0] : last[0]]
        corner = origin + (first + 0.5) * spec.resolution
        _fill(part, corner, spec.resolution, normals, offsets + margin_m)

    @property
    def slack_m(self) -> float:
        """Farthest that a point of the body moves within a cell and half a heading."""
        radius = float(np.hypot(*self.body.T).max())
        return self.spec.resolution * math.sqrt(0.5) + radius * math.pi / HEADINGS

    def index_of(self, pose: Pose2) -> tuple[int, int, int]:
        """Return heading, row and column of a pose."""
        heading = round(pose.yaw / math.tau * HEADINGS) % HEADINGS
        return heading, *self.spec.cell_of(pose.x, pose.y)

    def disc(self, xy: tuple[float, float], radius_m: float) -> NDArray[np.bool_]:
        """Return (H, W) the cells with centres within a distance of a point."""
        spec = self.spec
        xs = spec.origin.x + (np.arange(spec.width) + 0.5) * spec.resolution
        ys = spec.origin.y + (np.arange(spec.height)[:, None] + 0.5) * spec.resolution
        return np.asarray(np.hypot(xs - xy[0], ys - xy[1]) <= radius_m)


def _normals(outline: Points) -> Points:
    """Return the outward normals (N, 2) of a convex outline, counter-clockwise."""
    edges = np.roll(outline, -1, axis=0) - outline
    lengths = np.hypot(*edges.T)
    edges, lengths = edges[lengths > 1e-9], lengths[lengths > 1e-9]
    normals: Points = np.stack([edges[:, 1], -edges[:, 0]], axis=1) / lengths[:, None]
    return normals


def connected(opened: Open, start: tuple[int, int, int], *, sideways: bool) -> Open:
    """Return (HEADINGS, H, W) the poses that are connected with a start.

    Without ``sideways`` the body moves along its heading, forward and in reverse.
    """
    reached = np.zeros_like(opened)
    if opened[start]:
        _flood(opened, reached, start, _moves(sideways=sideways))
    return reached


def steered(opened: Open, spec: GridSpec, start: Pose2, radius_m: float) -> Open:
    """Return (HEADINGS, H, W) the poses that a car reaches forward from a start.

    Each move is straight or an arc of the radius to the next heading. A pose keeps its
    exact position; the first in each cell continues, as in hybrid A* (Dolgov et al.
    2008).
    """
    reached = np.zeros_like(opened)
    step = math.tau / HEADINGS
    chord = 2 * radius_m * math.sin(step / 2)
    moves = np.array([(chord, turn) for turn in (0, 1, -1)])
    corner = (start.x - spec.origin.x, start.y - spec.origin.y)
    first = np.array([*corner, round(start.yaw / step) % HEADINGS])
    _steer(opened, reached, first, moves, spec.resolution)
    return reached


def _moves(*, sideways: bool) -> NDArray[np.int64]:
    """Return (HEADINGS, M, 3) the steps from a pose: heading, row, column."""
    steps = [(i, j) for i in range(-2, 3) for j in range(-2, 3) if math.gcd(i, j) == 1]
    table = []
    for k in range(HEADINGS):
        yaw = math.tau * k / HEADINGS
        along = [
            (0, i, j) for i, j in steps if sideways or _is_along(yaw, math.atan2(i, j))
        ]
        table.append([(1, 0, 0), (-1, 0, 0), *along])
    most = max(map(len, table))
    filled = [moves + [(0, 0, 0)] * (most - len(moves)) for moves in table]
    return np.array(filled, np.int64)


def _is_along(yaw: float, direction: float) -> bool:
    """Return whether a step goes along a heading, forward or in reverse."""
    off = (direction - yaw + math.pi / 2) % math.pi - math.pi / 2
    return abs(off) <= math.radians(16.0)


@kernel
def _fill(
    opened: Any, corner: Points, size: float, normals: Points, offsets: Points
) -> None:
    """Close the cells whose centres lie in an intersection of half-planes."""
    for i in range(opened.shape[0]):
        y = corner[1] + i * size
        for j in range(opened.shape[1]):
            x = corner[0] + j * size
            inside = True
            for k in range(offsets.size):
                if normals[k, 0] * x + normals[k, 1] * y > offsets[k]:
                    inside = False
                    break
            if inside:
                opened[i, j] = False


@kernel
def _steer(opened: Any, reached: Any, start: Any, moves: Any, size: float) -> None:
    """Flood from a start x, y (m, from the corner), heading by moves (length, turn)."""
    headings, height, width = opened.shape
    stack = np.empty((opened.size, 3), np.float32)
    stack[0] = start
    count = 1
    while count > 0:
        count -= 1
        x, y, k = stack[count, 0], stack[count, 1], int(stack[count, 2])
        for m in range(moves.shape[0]):
            length, turn = moves[m, 0], moves[m, 1]
            yaw = 2 * np.pi / headings * (k + 0.5 * turn)
            k2 = int(k + turn) % headings
            x2, y2 = x + length * math.cos(yaw), y + length * math.sin(yaw)
            row, column = int(y2 / size), int(x2 / size)
            if not (0 <= row < height and 0 <= column < width):
                continue
            between = opened[k, int((y + y2) / 2 / size), int((x + x2) / 2 / size)]
            if not between or not opened[k2, row, column] or reached[k2, row, column]:
                continue
            reached[k2, row, column] = True
            stack[count, 0], stack[count, 1], stack[count, 2] = x2, y2, k2
            count += 1


@kernel
def _flood(opened: Any, reached: Any, start: Any, moves: Any) -> None:
    headings, height, width = opened.shape
    stack = np.empty(opened.size, np.int64)
    reached[start[0], start[1], start[2]] = True
    stack[0] = (start[0] * height + start[1]) * width + start[2]
    count = 1
    while count > 0:
        count -= 1
        item = stack[count]
        k, row, column = (
            item // (height * width),
            item // width % height,
            item % width,
        )
        for m in range(moves.shape[1]):
            k2 = (k + moves[k, m, 0]) % headings
            row2, column2 = row + moves[k, m, 1], column + moves[k, m, 2]
            if not (0 <= row2 < height and 0 <= column2 < width):
                continue
            if opened[k2, row2, column2] and not reached[k2, row2, column2]:
                reached[k2, row2, column2] = True
                stack[count] = (k2 * height + row2) * width + column2
                count += 1
