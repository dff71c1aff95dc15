"""A path by the motions of a drive, or the proof that none exists: two floods.

Poses are cells and headings, one bit each. Moves are straight, forward and in reverse,
and to the next heading: in place, or along an arc; an omnidirectional drive also
slides. Of the poses in a cell and heading the first continues, from its exact position,
as in hybrid A* (Dolgov et al. 2008). Start and goal, from which moves are undone, are
flooded in turns (Pohl 1971): the smaller of two separate regions decides. At first each
flood continues from its pose nearest to where the other began, along cells that are
open at any heading: most paths are found long before all poses between are reached.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import ACKERMANN, OMNI, Pose2
from navette.navigation.grids import sparse_zeros
from navette.navigation.planning.bucket_queue import WAITING, BucketQueue, pop, push

HEADINGS = 64
HEADING_RAD = math.tau / HEADINGS
_ROOM = 2_000_000  # poses of a guided flood; of another, those still to be moved
_MOST_POSES = 40_000_000  # of one flood: two to four seconds
_LARGE_BYTES = 1 << 20  # most floods reach few poses of a map
_AROUND = 4  # cells beside two floods' path in which one exact path is looked for
_STRAIGHT = 1.5  # cells of a straight motion: it always leaves its cell
_MOST_MOVES = 8  # of a drive
_COUNT, _DONE, _LOWEST = 0, 1, 2  # of a flood's state

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
        poses: (M, 3) x, y (m), yaw (rad) of a path, or None. Near it, none has fewer
            moves.
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
    first = np.floor(begin[:, 1::-1]).astype(np.int64)
    toward = _away_from(open_, cells), _away_from(open_, first)
    met = _flood(open_, begin, ends, steps, toward, both=True)
    if not met.is_complete:
        met = _flood(open_, begin, ends, steps, None, both=True)
    if not met.chains:
        return DrivePath(None, is_proof=met.is_complete)
    # Where two floods meet they are off by a part of a cell: one along them is exact,
    # or one from the start to all poses decides.
    corridor = np.zeros_like(open_)
    for chain in met.chains:
        _copy_around(corridor, open_, chain[:, :2])
    exact = _flood(corridor, begin, ends, steps, None, both=False)
    if not exact.chains:
        exact = _flood(open_, begin, ends, steps, None, both=False)
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


class _Flood(NamedTuple):
    """The poses that moves reach from some poses.

    Attributes:
        reached: (H, W) the poses.
        origin: (H, W, headings) how each was reached, see :func:`_make_moves`; 0: not.
        poses: (N, 3) u, v in cells, heading of each, as it was reached first; used in
            a circle, unless the flood is guided.
        state: number of poses; of those whose moves were made in order; the bucket
            before which all are empty.
        queue: indices of the poses whose moves are to be made, by ``toward``.
        pool: of the queue.
        toward: (H, W) cells to where the other flood began; without cells: the moves
            are made in the order of the poses, so that paths have the fewest.
        shift: (headings, moves, 2) du, dv in cells.
        after: (headings, moves) heading after each.
    """

    reached: Masks
    origin: NDArray[np.uint8]
    poses: NDArray[np.float32]
    state: NDArray[np.int64]
    queue: BucketQueue
    pool: NDArray[np.int64]
    toward: NDArray[np.int32]
    shift: NDArray[np.float64]
    after: NDArray[np.int64]

    @classmethod
    def of(
        cls,
        open_: Masks,
        begin: NDArray[np.float64],
        toward: NDArray[np.int32] | None,
        shift: NDArray[np.float64],
        after: NDArray[np.int64],
    ) -> "_Flood":
        """Return a flood that begins at poses (N, 3) u, v, heading."""
        reached = sparse_zeros(open_.shape, np.uint64, large_bytes=_LARGE_BYTES)
        shape = *open_.shape, HEADINGS
        origin = sparse_zeros(shape, np.uint8, large_bytes=_LARGE_BYTES)
        poses = np.empty((_ROOM, 3), np.float32)
        poses[: len(begin)] = begin
        column, row, heading = poses[: len(begin)].astype(np.int64).T  # as rounded
        bits = np.uint64(1) << heading.astype(np.uint64)
        np.bitwise_or.at(reached, (row, column), bits)
        if toward is None:
            toward = np.empty((0, 0), np.int32)
        buckets = 1 << int(toward.max(initial=0) + 1).bit_length()
        queue = BucketQueue.empty(buckets, 0)
        pool = np.empty(_ROOM + 1, np.int64)
        state = np.array([len(begin), 0, 0])
        flood = cls(reached, origin, poses, state, queue, pool, toward, shift, after)
        _queue_first(flood)
        return flood


def _flood(
    open_: Masks,
    start: NDArray[np.float64],
    ends: NDArray[np.float64],
    steps: tuple[NDArray[np.float64], NDArray[np.int64]],
    toward: tuple[NDArray[np.int32], NDArray[np.int32]] | None,
    *,
    both: bool,
) -> _Meeting:
    """Flood from poses (N, 3) u, v, heading: from both ends in turns, or the start."""
    to_ends, to_start = toward or (None, None)
    shift, after = steps
    floods = (
        _Flood.of(open_, start, to_ends, shift[0], after[0]),
        _Flood.of(open_, ends, to_start, shift[1], after[1]),
    )
    row, column, heading, is_complete = _spread(open_, *floods, both)
    if row < 0:
        return _Meeting((), is_complete)
    last = [row, column, heading]
    return _Meeting(tuple(_chain(each, last) for each in floods), is_complete=True)


def _copy_around(to: Masks, of: Masks, cells: NDArray[np.int64]) -> None:
    """Copy the cells (N, 2: row, column) and those around them."""
    height, width = of.shape
    for i, j in np.ndindex(2 * _AROUND + 1, 2 * _AROUND + 1):
        rows = (cells[:, 0] + i - _AROUND).clip(0, height - 1)
        columns = (cells[:, 1] + j - _AROUND).clip(0, width - 1)
        to[rows, columns] = of[rows, columns]


def _chain(flood: _Flood, last: list[int]) -> NDArray[np.int64]:
    """Return (M, 4) row, column, heading, move from where a flood began to a pose."""
    (row, column, k), rows = last, []
    while code := int(flood.origin[row, column, k]):
        move = (code - 1) % _MOST_MOVES
        rows.append((row, column, k, move))
        k = int(k - flood.after[0, move]) % HEADINGS
        du, dv = flood.shift[k, move].tolist()
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


@kernel
def _away_from(open_: Masks, cells: NDArray[np.int64]) -> NDArray[np.int32]:
    """Return (H, W) the steps to cells (N, 2) through cells open at any heading.

    Cells without a path to them get more than any other.
    """
    height, width = open_.shape
    steps = np.full((height, width), -1, np.int32)
    queue = np.empty(height * width, np.int32)
    done, count, most = 0, 0, 0
    for n in range(cells.shape[0]):
        row, column = cells[n, 0], cells[n, 1]
        if steps[row, column] < 0:
            steps[row, column] = 0
            queue[count] = row * width + column
            count += 1
    while done < count:
        row, column = queue[done] // width, queue[done] % width
        done += 1
        most = steps[row, column]
        for i in range(max(0, row - 1), min(height, row + 2)):
            for j in range(max(0, column - 1), min(width, column + 2)):
                if steps[i, j] < 0 and open_[i, j] != 0:
                    steps[i, j] = most + 1
                    queue[count] = i * width + j
                    count += 1
    for row in range(height):
        for column in range(width):
            if steps[row, column] < 0:
                steps[row, column] = most + 1
    return steps


@kernel(allocates=False)
def _queue_first(flood: _Flood) -> None:
    """Queue the poses where a flood begins."""
    if flood.toward.size:
        for index in range(flood.state[_COUNT]):
            _queue(flood, index)


@kernel(allocates=False, forceinline=True)
def _queue(flood: Any, index: int) -> None:
    u, v = flood.poses[index, 0], flood.poses[index, 1]
    bucket = flood.toward[int(v), int(u)]
    push(flood.pool, flood.queue, bucket, index)
    flood.state[_LOWEST] = min(flood.state[_LOWEST], bucket)


@kernel(allocates=False, forceinline=True)
def _next(flood: Any) -> int:
    """Return the pose whose moves are made next, or −1."""
    state = flood.state
    if flood.toward.size == 0:
        if state[_DONE] == state[_COUNT]:
            return -1
        state[_DONE] += 1
        return int((state[_DONE] - 1) % flood.poses.shape[0])
    while flood.queue.state[WAITING]:
        index = pop(flood.pool, flood.queue, state[_LOWEST])
        if index >= 0:
            return int(index)
        state[_LOWEST] += 1
    return -1


@kernel(allocates=False)
def _spread(
    open_: Masks, start: _Flood, end: _Flood, both: bool
) -> tuple[int, int, int, bool]:
    """Spread two floods in turns, or the first, until they meet.

    Returns:
        Row, column and heading where the floods meet, else −1 and whether all poses
        were reached that can be.
    """
    mine, other = start, end
    while True:
        index = _next(mine)
        if index < 0:
            return -1, -1, -1, True
        u, v, heading = mine.poses[index]
        bit = np.uint64(1) << np.uint64(heading)
        if other.reached[int(v), int(u)] & bit:
            return int(v), int(u), int(heading), True
        if not _make_moves(open_, mine, u, v, int(heading)):
            return -1, -1, -1, False
        if both:
            mine, other = other, mine


@kernel(allocates=False, forceinline=True)
def _make_moves(open_: Masks, flood: Any, u: float, v: float, k: int) -> bool:
    """Reach poses by each move from one; return whether there was room for all.

    A pose is reached from the cell that lies ``floor(-shift)`` away, or the next, as
    within both cells the positions are any. ``origin`` is 1 + the move + the number of
    moves · (4 · rows + columns), these + 1 as rounded positions may add another cell.
    """
    height, width = open_.shape
    one, state = np.uint64(1), flood.state
    bit = one << np.uint64(k)
    for m in range(flood.after.shape[1]):
        # As it is stored: rounded, a position may lie in the next cell.
        x = np.float32(u + flood.shift[k, m, 0])
        y = np.float32(v + flood.shift[k, m, 1])
        if not (0.0 <= x < width and 0.0 <= y < height):
            continue
        row, column, heading = int(y), int(x), flood.after[k, m]
        new = one << np.uint64(heading)
        if flood.reached[row, column] & new or not open_[row, column] & new:
            continue
        middle = open_[int(0.5 * (v + y)), int(0.5 * (u + x))]
        if not middle & (bit | new):
            continue
        count = state[_COUNT]
        if count - state[_DONE] >= flood.poses.shape[0] or count >= _MOST_POSES:
            return False
        at = count % flood.poses.shape[0]
        rows = int(v) - row - math.floor(-flood.shift[k, m, 1]) + 1
        columns = int(u) - column - math.floor(-flood.shift[k, m, 0]) + 1
        code = 1 + m + _MOST_MOVES * (4 * rows + columns)
        flood.origin[row, column, heading] = code
        flood.reached[row, column] |= new
        flood.poses[at, 0], flood.poses[at, 1] = x, y
        flood.poses[at, 2] = heading
        state[_COUNT] = count + 1
        if flood.toward.size:
            _queue(flood, at)
    return True
