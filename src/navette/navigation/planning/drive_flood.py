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
_MOST_WAITING = 2_000_000  # poses whose moves are still to be made, of one flood
_AROUND = 4  # cells beside two floods' path in which one exact path is looked for
_STRAIGHT = 1.5  # cells of a straight motion: it always leaves its cell
_MOST_MOVES = 8  # of a drive

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
    # Where two floods meet they are off by a part of a cell: one along them is exact,
    # or one from the start to all poses decides.
    corridor = np.zeros_like(open_)
    for chain in met.chains:
        _copy_around(corridor, open_, chain[:, :2])
    exact = _flood(corridor, begin, ends, steps, both=False)
    if not exact.chains:
        exact = _flood(open_, begin, ends, steps, both=False)
    if not exact.chains:
        return DrivePath(None, is_proof=exact.is_complete)
    path = _replayed(begin[0], exact.chains[0], steps)
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
        chains: (M, 4) row, column, heading and the move to there, from the start to
            where the floods met, and (K, 4) from an end to there; empty if they did
            not meet.
        is_complete: all poses were reached that can be.
    """

    chains: tuple[NDArray[np.int64], ...]
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
    waiting = np.empty((2, _MOST_WAITING, 3), np.float32)
    count, reached = np.zeros(2, np.int64), np.zeros((2, *open_.shape), np.uint64)
    # Pages of what is not reached are never touched.
    origin = np.zeros((2, *open_.shape, HEADINGS), np.uint8)
    for side, poses in enumerate((start, ends)):
        count[side] = n = len(poses)
        waiting[side, :n] = poses
        column, row, heading = waiting[side, :n].astype(np.int64).T  # as it is rounded
        bits = np.uint64(1) << heading.astype(np.uint64)
        np.bitwise_or.at(reached[side], (row, column), bits)
    *met, is_complete = _flood_both(
        open_, reached, origin, waiting, count, *steps, both
    )
    if met[0] < 0:
        return _Meeting((), is_complete)
    chains = (_chain(origin, side, met, steps) for side in range(2))
    return _Meeting(tuple(chains), is_complete=True)


def _copy_around(to: Masks, of: Masks, cells: NDArray[np.int64]) -> None:
    """Copy the cells (N, 2: row, column) and those around them."""
    height, width = of.shape
    for i, j in np.ndindex(2 * _AROUND + 1, 2 * _AROUND + 1):
        rows = (cells[:, 0] + i - _AROUND).clip(0, height - 1)
        columns = (cells[:, 1] + j - _AROUND).clip(0, width - 1)
        to[rows, columns] = of[rows, columns]


def _chain(
    origin: NDArray[np.uint8],
    side: int,
    last: list[int],
    steps: tuple[NDArray[np.float64], NDArray[np.int64]],
) -> NDArray[np.int64]:
    """Return (M, 4) row, column, heading, move from where a flood began to a pose."""
    shift, after = steps
    (row, column, k), rows = last, []
    while code := int(origin[side, row, column, k]):
        move = (code - 1) % _MOST_MOVES
        rows.append((row, column, k, move))
        k = int(k - after[side, 0, move]) % HEADINGS
        du, dv = shift[side, k, move].tolist()
        more = (code - 1) // _MOST_MOVES
        row += math.floor(-dv) + more // 4 - 1
        column += math.floor(-du) + more % 4 - 1
    return np.array([(row, column, k, 0), *rows[::-1]], np.int64)


def _replayed(
    start: NDArray[np.float64],
    chain: NDArray[np.int64],
    steps: tuple[NDArray[np.float64], NDArray[np.int64]],
) -> NDArray[np.float64]:
    """Return the exact poses (M, 3) u, v, heading of a flood's chain from the start."""
    shift, after = steps[0][0], steps[1][0]
    poses = np.empty((len(chain), 3), np.float32)
    poses[0] = start
    for i, (k, move) in enumerate(zip(chain[:-1, 2], chain[1:, 3], strict=True)):
        poses[i + 1, :2] = poses[i, :2] + shift[k, move]
        poses[i + 1, 2] = after[k, move]
    return poses.astype(np.float64)


@kernel(allocates=False)
def _flood_both(
    open_: Masks,
    reached: Any,
    origin: Any,
    waiting: Any,
    count: Any,
    shift: Any,
    after: Any,
    both: bool,
) -> tuple[int, int, int, bool]:
    """Reach poses by moves, breadth first, from both ends in turns or from the first.

    Args:
        open_: open poses.
        reached: (2, H, W) the ends; becomes what each flood reaches.
        origin: (2, H, W, headings) 0; becomes how each pose was reached, see below.
        waiting: (2, N, 3) u, v in cells, heading; the first ``count`` are the ends.
            Used in a circle.
        count: (2,) poses of each flood; grows.
        shift: du, dv of each flood, heading and move.
        after: heading after each.

    Returns:
        Row, column and heading where the floods meet, else −1 and whether all poses
        were reached that can be.

    A pose is reached from the cell that lies ``floor(-shift)`` away, or the next, as
    within both cells the positions are any. ``origin`` is 1 + the move + the number of
    moves · (4 · rows + columns), these + 1 as rounded positions may add another cell.
    """
    height, width = open_.shape
    one, room = np.uint64(1), waiting.shape[1]
    done, other_done, side = 0, 0, 0
    while done < count[side]:
        u, v = waiting[side, done % room, 0], waiting[side, done % room, 1]
        k = int(waiting[side, done % room, 2])
        bit = one << np.uint64(k)
        if reached[1 - side, int(v), int(u)] & bit:
            return int(v), int(u), k, True
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
            if count[side] - done == room:
                return -1, -1, -1, False
            rows = int(v) - row - math.floor(-shift[side, k, m, 1]) + 1
            columns = int(u) - column - math.floor(-shift[side, k, m, 0]) + 1
            code = 1 + m + _MOST_MOVES * (4 * rows + columns)
            origin[side, row, column, heading] = code
            reached[side, row, column] |= new
            at = count[side] % room
            waiting[side, at, 0], waiting[side, at, 1] = x, y
            waiting[side, at, 2] = heading
            count[side] += 1
        done += 1
        if both:
            done, other_done, side = other_done, done, 1 - side
    return -1, -1, -1, True
