"""A path by the motions of a drive, or the proof that none exists: two floods.

Poses are cells and headings, one bit each. Moves are straight, forward and in reverse,
and to the next heading: in place, or along an arc; an omnidirectional drive also
slides. Of the poses in a cell and heading the first continues, from its exact position,
as in hybrid A* (Dolgov et al. 2008). Start and goal, from which moves are undone, are
flooded in turns (Pohl 1971): the smaller of two separate regions decides.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import ACKERMANN, OMNI, Pose2

HEADINGS = 64
HEADING_RAD = math.tau / HEADINGS
_MOST_POSES = 16_000_000  # of one flood, at 12 bytes
_AROUND = 4  # cells beside two floods' path in which one exact path is looked for
_STRAIGHT = 1.5  # cells of a straight motion: it always leaves its cell

Masks = NDArray[np.uint64]
"""(H, W) a bit for each heading."""


class DriveMoves(NamedTuple):
    """What a drive can do.

    Attributes:
        drive: differential, ackermann or omni.
        radius_m: radius of the tightest arc of an Ackermann drive.
        reverses: whether it drives in reverse, and sideways.
    """

    drive: str
    radius_m: float
    reverses: bool = True

    def table(self, size_m: float) -> NDArray[np.float64]:
        """Return moves (N, 3): cells, headings, direction from the heading in rad."""
        ways = (1, -1) if self.reverses else (1,)
        if self.drive == ACKERMANN:
            chord = 2 * self.radius_m * math.sin(math.pi / HEADINGS) / size_m
            moves = [(way * chord, turn, 0.0) for way in ways for turn in (0, 1, -1)]
        else:
            sideways = self.drive == OMNI and self.reverses
            sides = (0.0, math.pi / 2) if sideways else (0.0,)
            moves = [(way * _STRAIGHT, 0, side) for side in sides for way in ways]
            moves += [(0.0, 1, 0.0), (0.0, -1, 0.0)]
        return np.array(moves, np.float64)


class DrivePath(NamedTuple):
    """Result of :func:`find_drive_path`.

    Attributes:
        poses: (M, 3) x, y (m), yaw (rad) of a path of about the fewest moves, or None.
        is_proof: without poses: whether all motions from one end were tried.
    """

    poses: NDArray[np.float64] | None
    is_proof: bool


def find_drive_path(
    open_: Masks,
    start: Pose2,
    size_m: float,
    cells: NDArray[np.int64],
    headings: NDArray[np.int64],
    moves: DriveMoves,
) -> DrivePath:
    """Return a path through open poses to one of cells (N, 2) at one of headings.

    Args:
        open_: poses of the body that nothing closes.
        start: pose in the frame of the grid; heading 0 is its yaw.
        size_m: edge of a cell.
        cells: row, column of the ends.
        headings: indices of the headings at the ends.
        moves: those of the drive.
    """
    table = moves.table(size_m)
    undone = table * (-1.0, -1.0, 1.0)
    steps = _steps(np.array([table, undone]), start.yaw)
    begin = np.array([[start.x / size_m, start.y / size_m, 0.0]])
    bits = np.uint64(1) << headings.astype(np.uint64)
    nth, which = np.nonzero(open_[tuple(cells.T)][:, None] & bits)
    ends = np.column_stack([cells[nth, ::-1] + 0.5, headings[which]])
    met = _flood(open_, begin, ends, steps, both=True)
    if not met.chains:
        return DrivePath(None, is_proof=met.is_complete)
    # Where two floods meet they are off by a part of a cell: one along them is exact.
    corridor = np.zeros_like(open_)
    for uv in met.chains:
        _copy_around(corridor, open_, uv.astype(np.int64))
    exact = _flood(corridor, begin, ends, steps, both=False)
    if not exact.chains:
        return DrivePath(None, is_proof=False)
    path = exact.chains[0]
    yaw = wrapped(start.yaw + path[:, 2] * HEADING_RAD)
    return DrivePath(np.column_stack([path[:, :2] * size_m, yaw]), is_proof=True)


def wrapped(yaw: NDArray[np.floating[Any]]) -> NDArray[np.float64]:
    """Return angles in [−π, π)."""
    return np.asarray(np.remainder(yaw + math.pi, math.tau) - math.pi)


def _steps(
    table: NDArray[np.float64], yaw: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return du, dv in cells (2, headings, moves, 2), and the headings after them.

    The first half of the tables (2, N, 3) is for the flood from the start, the second,
    the same moves undone, for that from the ends.
    """
    length, turn, aside = np.moveaxis(table[:, None], -1, 0)
    heading = np.arange(HEADINGS)[:, None]
    along = yaw + (heading + 0.5 * turn) * HEADING_RAD + aside
    shift = np.stack([length * np.cos(along), length * np.sin(along)], axis=-1)
    return shift, ((heading + turn) % HEADINGS).astype(np.int64)


class _Meeting(NamedTuple):
    """Result of floods from a start and from ends.

    Attributes:
        chains: (M, 3) u, v in cells and heading from the start to where they met, and
            (K, 3) from an end to there; empty if they did not meet.
        is_complete: there was room for all poses.
    """

    chains: tuple[NDArray[np.float64], ...]
    is_complete: bool


def _flood(
    open_: Masks,
    start: NDArray[np.float64],
    ends: NDArray[np.float64],
    steps: tuple[NDArray[np.float64], NDArray[np.int64]],
    *,
    both: bool,
) -> _Meeting:
    """Flood from poses (N, 3) u, v, heading: from both ends in turns, or the start."""
    position = np.empty((2, _MOST_POSES, 2), np.float32)
    links = np.empty((2, _MOST_POSES), np.uint32)
    count, reached = np.zeros(2, np.int64), np.zeros((2, *open_.shape), np.uint64)
    for side, poses in enumerate((start, ends)):
        count[side] = n = len(poses)
        position[side, :n] = poses[:, :2]
        column, row, heading = poses.astype(np.int64).T
        links[side, :n] = np.arange(n) * HEADINGS + heading
        bits = np.uint64(1) << heading.astype(np.uint64)
        np.bitwise_or.at(reached[side], (row, column), bits)
    met = _flood_both(open_, reached, position, links, count, *steps, both)
    if met[0] < 0:
        return _Meeting((), bool(count.max() < _MOST_POSES))
    chains = []
    for side in range(2):
        nth = _chain(links[side], met[side])[::-1]
        heading = links[side, nth] % HEADINGS
        chains.append(np.column_stack([position[side, nth], heading]))
    return _Meeting(tuple(chains), is_complete=True)


def _copy_around(to: Masks, of: Masks, cells: NDArray[np.int64]) -> None:
    """Copy the cells (N, 2: column, row) and those around them."""
    height, width = of.shape
    for i, j in np.ndindex(2 * _AROUND + 1, 2 * _AROUND + 1):
        rows = (cells[:, 1] + i - _AROUND).clip(0, height - 1)
        columns = (cells[:, 0] + j - _AROUND).clip(0, width - 1)
        to[rows, columns] = of[rows, columns]


def _chain(links: NDArray[np.uint32], last: int) -> list[int]:
    """Return the poses from one back to that where its flood began."""
    chain = [last]
    while (before := int(links[chain[-1]]) // HEADINGS) != chain[-1]:
        chain.append(before)
    return chain


@kernel(allocates=False)
def _flood_both(
    open_: Masks,
    reached: Any,
    position: Any,
    links: Any,
    count: Any,
    shift: Any,
    after: Any,
    both: bool,
) -> tuple[int, int]:
    """Reach poses by moves, breadth first, from both ends in turns or from the first.

    Args:
        open_: open poses.
        reached: (2, H, W) the ends; becomes what each flood reaches.
        position: (2, N, 2) u, v in cells; the first ``count`` of each are the ends.
        links: (2, N) index of the pose before · number of headings + heading.
        count: (2,) poses of each flood; grows.
        shift: du, dv of each flood, heading and move.
        after: heading after each.

    Returns:
        One pose of each flood in the same cell and heading; −1 if one flood ends, or
        has no room, before they meet.
    """
    height, width = open_.shape
    one = np.uint64(1)
    done, other_done, side = 0, 0, 0
    while done < count[side]:
        u, v = position[side, done, 0], position[side, done, 1]
        k = links[side, done] % HEADINGS
        bit = one << np.uint64(k)
        if reached[1 - side, int(v), int(u)] & bit:
            there = _find(position, links, 1 - side, count[1 - side], u, v, k)
            return (done, there) if side == 0 else (there, done)
        for m in range(after.shape[2]):
            # As it is stored: rounded, a position may lie in the next cell.
            x = np.float32(u + shift[side, k, m, 0])
            y = np.float32(v + shift[side, k, m, 1])
            if not (0.0 <= x < width and 0.0 <= y < height):
                continue
            row, column, heading = int(y), int(x), after[side, k, m]
            new = one << np.uint64(heading)
            if reached[side, row, column] & new or not open_[row, column] & new:
                continue
            middle = open_[int(0.5 * (v + y)), int(0.5 * (u + x))]
            if not middle & (bit | new):
                continue
            at = count[side]
            if at == links.shape[1]:
                return -1, -1
            reached[side, row, column] |= new
            position[side, at, 0], position[side, at, 1] = x, y
            links[side, at] = done * HEADINGS + heading
            count[side] = at + 1
        done += 1
        if both:
            done, other_done, side = other_done, done, 1 - side
    return -1, -1


@kernel(allocates=False)
def _find(
    position: Any, links: Any, side: int, count: int, u: float, v: float, k: int
) -> int:
    """Return the pose of a flood in the cell of (u, v) with heading k."""
    for n in range(count):
        if links[side, n] % HEADINGS != k:
            continue
        if int(position[side, n, 0]) == int(u) and int(position[side, n, 1]) == int(v):
            return n
    return -1
