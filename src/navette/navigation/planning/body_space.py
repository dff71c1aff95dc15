"""Reachability of the body: the proof that no path exists.

The configuration space of the body (Lozano-Pérez 1983) as one bit per heading and cell:
every obstacle closes the poses at which the body covers it, and a flood fill through
the open poses finds everything reachable. A search that exhausts its budget proves
nothing; a flood fill that does not reach the goal proves that no path exists.
"""

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Footprint, Pose2, wrap_angles
from navette.navigation.grids import (
    GridSpec,
    ObstacleGrid,
    bounding_box,
    make_outline,
    off_box,
    signed_distance,
)
from navette.navigation.planning.drive_path import (
    DriveMoves,
    DrivePath,
    find_drive_path,
)
from navette.navigation.planning.pose_flood import HEADING_RAD, HEADINGS, Fit, Masks

# Headings that stand for a bin, in bins: those in it, its own, and those to the next.
_BIN, _MIDDLE, _TURN = np.linspace(-0.5, 0.5, 5), np.zeros(1), np.linspace(0.0, 1.0, 5)


class BodySpace:
    """Poses of the body that no obstacle closes.

    Without a margin a cell is closed only if the body fits nowhere in it: cells that
    are not reached are certainly unreachable. With a margin the body is placed at the
    cell's centre with the middle heading of each bin: cells that are reached are
    certainly reachable.

    Args:
        lethal: (H, W) obstacles.
        spec: their geometry in the map frame.
        footprint: outline of the body.
        start: pose of the body in the map, always open; headings count from its own.
        margin_m: clearance that the body keeps, or None.
    """

    def __init__(
        self,
        lethal: NDArray[np.bool_],
        spec: GridSpec,
        footprint: Footprint,
        start: Pose2,
        *,
        margin_m: float | None = None,
    ) -> None:
        self._lethal, self._margin_m = lethal, margin_m
        self._spec, self._start, self._outline = spec, start, make_outline(footprint)
        if margin_m is None:
            anywhere_m = -spec.resolution * math.sqrt(0.5)
            self._open = self._opened(anywhere_m, _BIN, any_heading=False)
        else:
            self._open = self._opened(margin_m, _MIDDLE, any_heading=True)
        self.start = spec.cell_of(start.x, start.y)
        self._open_at_start = self._open[self.start]
        self._open[self.start] = ~np.uint64(0)
        self._near_start: tuple[tuple[slice, slice], BodySpace] | None = None

    @cached_property
    def turns(self) -> Masks:
        """(H, W) turns in place from each heading to the next that nothing closes."""
        return self._opened(self._margin_m or 0.0, _TURN, any_heading=True)

    def _opened(
        self, least_m: float, headings: NDArray[np.float64], *, any_heading: bool
    ) -> Masks:
        """Return (H, W) the bins of headings that no lethal cell closes.

        Args:
            least_m: distance from the body to a cell's centre below which it closes.
            headings: of the body, in bins from that of each bin.
            any_heading: a bin is closed if one of them is, or only if all are.
        """
        spec, outline = self._spec, self._outline
        reach = math.ceil((outline.radius_m + max(0.0, least_m)) / spec.resolution)
        stamp = np.zeros((2 * reach + 1, 2 * reach + 1), np.uint64)
        grid_yaw = spec.origin.yaw - self._start.yaw
        _fill_stamp(
            stamp,
            outline.vertices,
            spec.resolution,
            grid_yaw,
            headings,
            least_m,
            any_heading,
        )
        closed = np.zeros((spec.height + 2 * reach, spec.width + 2 * reach), np.uint64)
        _close(closed, self._lethal, np.ascontiguousarray(stamp[::-1, ::-1]))
        inner = slice(reach, -reach or None)
        return np.ascontiguousarray(~closed[inner, inner])

    def close(self, cells: NDArray[np.bool_]) -> None:
        """Close cells (H, W) for the base."""
        self._open[cells] = 0

    def open_near_start(self, other: "BodySpace", reach_m: float) -> None:
        """Open what is open in another space of the same cells near the start."""
        reach = math.ceil(reach_m / self._spec.resolution)
        row, column = self.start
        near = (
            slice(max(0, row - reach), row + reach + 1),
            slice(max(0, column - reach), column + reach + 1),
        )
        self._open[near] |= other._open[near]
        self._near_start = near, other

    def reached_from(self, cells: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return (H, W) the cells that the body reaches from any of cells (N, 2)."""
        reached = np.zeros_like(self._open)
        _flood(self._open, reached, np.ascontiguousarray(cells, np.int64))
        return np.asarray(reached != 0)

    def fit(
        self,
        turns: "BodySpace",
        obstacles: ObstacleGrid,
        margin_m: float,
        near_m: float,
        reach_m: float,
    ) -> Fit:
        """Return the check of exact moves; those to poses that are open here need none.

        The margin of this space includes the motion within a cell and that of a move.
        Poses in the cell of the start need the check where obstacles close them.

        Args:
            turns: space in which turns in place that are open need no check; its
                margin includes the motion within a cell.
            obstacles: in the map frame.
            margin_m: clearance that the body keeps.
            near_m: clearance that it keeps near the start.
            reach_m: how far from the start that is.
        """
        sure = self._open.copy()
        sure[self.start] = self._open_at_start
        return Fit(
            sure,
            turns.turns,
            obstacles,
            self._outline,
            np.array(self._spec.origin),
            np.array(self._start),
            self._spec.resolution,
            margin_m,
            near_m,
            reach_m,
        )

    def drive_to(
        self,
        cells: NDArray[np.int64],
        moves: DriveMoves,
        seen: "BodySpace",
        fit: Fit,
        yaw: float | None = None,
        tolerance_rad: float = 0.0,
        *,
        thorough: bool = True,
    ) -> DrivePath:
        """Return a path by the moves of a drive from the start to one of cells (N, 2).

        In reverse and sideways it moves between poses that are open in ``seen`` too;
        ``fit`` decides about the exact poses. With a yaw (map) the last heading is
        within the tolerance of it, or the nearest. Unless ``thorough``, long floods
        are not tried.
        """
        frame = self._spec.origin
        local = frame.inverse() @ self._start
        headings = np.arange(HEADINGS)
        if yaw is not None:
            off = np.abs(wrap_angles(headings * HEADING_RAD + (self._start.yaw - yaw)))
            headings = headings[off <= max(tolerance_rad, HEADING_RAD / 2 + 1e-9)]
        turns = self.turns.copy()
        if self._near_start is not None:
            near, other = self._near_start
            turns[near] |= other.turns[near]
        found = find_drive_path(
            self._open,
            turns,
            seen._open,
            local,
            self._spec.resolution,
            cells,
            headings,
            moves,
            fit,
            thorough=thorough,
        )
        if found.poses is None:
            return found
        xy = frame.apply(found.poses[:, :2])
        yaws = wrap_angles(found.poses[:, 2] + frame.yaw)
        return DrivePath(np.column_stack([xy, yaws]), found.is_proof)


@kernel(allocates=False)
def _fill_stamp(
    stamp: Masks,
    vertices: NDArray[np.float64],
    size: float,
    grid_yaw: float,
    headings: NDArray[np.float64],
    least: float,
    any_heading: bool,
) -> None:
    """Set the bits of the headings at which the body covers each offset in cells."""
    edge = stamp.shape[0]
    box = bounding_box(vertices)
    for k in range(HEADINGS):
        bit = np.uint64(1) << np.uint64(k)
        for part in range(headings.size):
            yaw = 2 * np.pi * (k + headings[part]) / HEADINGS - grid_yaw
            c, s = np.cos(yaw), np.sin(yaw)
            for i in range(edge):
                for j in range(edge):
                    if part and (stamp[i, j] & bit != 0) == any_heading:
                        continue  # decided
                    x, y = (j - edge // 2) * size, (i - edge // 2) * size
                    bx, by = c * x + s * y, c * y - s * x
                    near = off_box(box, bx, by) < least
                    if near and signed_distance(vertices, bx, by) < least:
                        stamp[i, j] |= bit
                    else:
                        stamp[i, j] &= ~bit


@kernel
def _close(closed: Masks, lethal: NDArray[np.bool_], stamp: Masks) -> None:
    """Close the poses at which the body covers a lethal cell.

    A body that covers a cell inside an area of lethal cells covers its border too, or
    lies within: such a cell closes only the poses of a base in it.
    """
    height, width = lethal.shape
    middle = stamp.shape[0] // 2
    split = _split_headings(stamp)
    rest = stamp & split
    for row in range(height):
        for column in range(width):
            if not lethal[row, column]:
                continue
            if not _is_inside(lethal, row, column):
                _stamp(closed, row, column, stamp)
                continue
            closed[row + middle, column + middle] |= stamp[middle, middle]
            if split:
                _stamp(closed, row, column, rest)


@kernel(allocates=False)
def _stamp(closed: Masks, row: int, column: int, stamp: Masks) -> None:
    edge = stamp.shape[0]
    for i in range(edge):
        line = closed[row + i, column : column + edge]
        for j in range(edge):
            line[j] |= stamp[i, j]


@kernel(allocates=False)
def _is_inside(lethal: NDArray[np.bool_], row: int, column: int) -> bool:
    """Return whether the four neighbours of a cell are lethal too."""
    height, width = lethal.shape
    if row == 0 or column == 0 or row == height - 1 or column == width - 1:
        return False
    return bool(
        lethal[row - 1, column]
        and lethal[row + 1, column]
        and lethal[row, column - 1]
        and lethal[row, column + 1]
    )


@kernel(allocates=False)
def _split_headings(stamp: Masks) -> np.uint64:
    """Return the headings at which no steps within the body lead to its base.

    From each covered cell one of the two neighbours nearer to the base must be covered,
    so that neighbouring cells connect all of the body.
    """
    edge, middle = stamp.shape[0], stamp.shape[0] // 2
    split = np.uint64(0)
    for i in range(edge):
        for j in range(edge):
            if i == middle and j == middle:
                continue
            nearer = np.uint64(0)
            if i != middle:
                nearer |= stamp[i + (1 if i < middle else -1), j]
            if j != middle:
                nearer |= stamp[i, j + (1 if j < middle else -1)]
            split |= stamp[i, j] & ~nearer
    return split


@kernel
def _flood(open_: Masks, reached: Masks, cells: NDArray[np.int64]) -> None:
    """Reach neighbouring cells with the same heading, and neighbouring headings."""
    height, width = open_.shape
    stack, count = np.empty(open_.size, np.int64), 0
    is_waiting = np.zeros(open_.shape, np.bool_)  # in the stack, once
    for n in range(cells.shape[0]):
        row, column = cells[n, 0], cells[n, 1]
        reached[row, column] = open_[row, column]
        if not is_waiting[row, column]:
            is_waiting[row, column] = True
            stack[count] = row * width + column
            count += 1
    while count > 0:
        count -= 1
        row, column = stack[count] // width, stack[count] % width
        is_waiting[row, column] = False
        here = reached[row, column]
        for i in range(max(0, row - 1), min(height, row + 2)):
            for j in range(max(0, column - 1), min(width, column + 2)):
                new = here & open_[i, j] & ~reached[i, j]
                if new == 0:
                    continue
                reached[i, j] = _turned(reached[i, j] | new, open_[i, j])
                if not is_waiting[i, j]:
                    is_waiting[i, j] = True
                    stack[count] = i * width + j
                    count += 1


@kernel(allocates=False)
def _turned(mask: np.uint64, open_: np.uint64) -> np.uint64:
    """Return the headings that turning in place reaches from those of a mask."""
    one, last = np.uint64(1), np.uint64(HEADINGS - 1)
    while True:
        left = (mask << one) | (mask >> last)
        right = (mask >> one) | (mask << last)
        more = (mask | left | right) & open_
        if more == mask:
            return mask
        mask = more
