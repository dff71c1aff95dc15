"""Floods through the poses of a body, from a start and from ends.

Poses are cells and headings, one bit each. Of the poses in a cell and heading the first
that fits continues, from its exact position, as in hybrid A* (Dolgov et al. 2008). A
flood continues from its pose nearest to where the other began, along cells that are
open at any heading, or in the order of moves, so that paths have the fewest.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import (
    ObstacleGrid,
    Outline,
    exact_clearance,
    sparse_zeros,
)
from navette.navigation.planning.bucket_queue import WAITING, BucketQueue, pop, push

HEADINGS = 64
HEADING_RAD = math.tau / HEADINGS
MOST_MOVES = 8  # of a drive
_ROOM = 2_000_000  # poses of a guided flood; of another, those still to be moved
_MOST_POSES = 40_000_000  # of one flood: two to four seconds
_MOST_FITTED = 2_000_000  # exact checks of one flood: up to nine seconds
_PART_M = 0.025  # least motion of a point of the body between checks of a move
_LARGE_BYTES = 1 << 20  # most floods reach few poses of a map
_COUNT, _DONE, _LOWEST, _FITTED = 0, 1, 2, 3  # of a flood's state

Masks = NDArray[np.uint64]
"""(H, W) a bit for each heading."""

Steps = tuple[NDArray[np.float64], NDArray[np.int64]]
"""du, dv in cells (2, headings, moves, 2) and the headings after (2, headings, moves).

The first half is for a flood from the start, the second, the same moves undone, for one
from the ends.
"""

Toward = tuple[NDArray[np.int32], NDArray[np.int32]]
"""(H, W) cells to the ends, and to the start; see :func:`away_from`."""


class Fit(NamedTuple):
    """Exact clearance of a body, for moves that no cell proves to be free.

    Attributes:
        sure: (H, W) poses that keep the margin wherever in their cell the base is, and
            during any move to there except a turn in place.
        sure_turns: (H, W) turns in place from a heading to the next that keep it, too.
        obstacles: in the map frame.
        outline: of the body.
        map_T_grid: (3,) x, y (m), yaw of the grid.
        start: (3,) x, y (m), yaw of the start in the map.
        size_m: edge of a cell.
        margin_m: clearance that the body keeps.
        near_m: clearance that it keeps near the start.
        reach_m: how far from the start that is.
    """

    sure: Masks
    sure_turns: Masks
    obstacles: ObstacleGrid
    outline: Outline
    map_T_grid: NDArray[np.float64]
    start: NDArray[np.float64]
    size_m: float
    margin_m: float
    near_m: float
    reach_m: float


class Space(NamedTuple):
    """Where the body may be.

    Attributes:
        open: (H, W) poses.
        turns: (H, W) turns in place from a heading to the next.
        seen: (H, W) poses between which a blind move is allowed.
        is_turn: (moves,) whether a move is a turn in place.
        is_blind: (moves,) whether no sensor looks where a move goes.
        motions: (moves,) metres that a point of the body moves at most.
        fit: decides about open poses.
    """

    open: Masks
    turns: Masks
    seen: Masks
    is_turn: NDArray[np.bool_]
    is_blind: NDArray[np.bool_]
    motions: NDArray[np.float64]
    fit: Fit


class Meeting(NamedTuple):
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
        origin: (H, W, headings) how each was reached, see :func:`_add`; 0: not.
        poses: (N, 3) u, v in cells, heading of each, as it was reached first; used in
            a circle, unless the flood is guided.
        state: number of poses; of those whose moves were made in order; the bucket
            before which all are empty; number of exact checks.
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
        state = np.array([len(begin), 0, 0, 0])
        flood = cls(reached, origin, poses, state, queue, pool, toward, shift, after)
        _queue_first(flood)
        return flood


def flood(
    space: Space,
    start: NDArray[np.float64],
    ends: NDArray[np.float64],
    steps: Steps,
    toward: Toward | None,
    *,
    both: bool,
) -> Meeting:
    """Flood from poses (N, 3) u, v, heading: from both ends in turns, or the start."""
    to_ends, to_start = toward or (None, None)
    shift, after = steps
    floods = (
        _Flood.of(space.open, start, to_ends, shift[0], after[0]),
        _Flood.of(space.open, ends, to_start, shift[1], after[1]),
    )
    row, column, heading, is_complete = _spread(space, *floods, both)
    if row < 0:
        return Meeting((), is_complete)
    last = [row, column, heading]
    return Meeting(tuple(_chain(each, last) for each in floods), is_complete=True)


def _chain(flood: _Flood, last: list[int]) -> NDArray[np.int64]:
    """Return (M, 4) row, column, heading, move from where a flood began to a pose."""
    (row, column, k), rows = last, []
    while code := int(flood.origin[row, column, k]):
        move = (code - 1) % MOST_MOVES
        rows.append((row, column, k, move))
        k = int(k - flood.after[0, move]) % HEADINGS
        du, dv = flood.shift[k, move].tolist()
        more = (code - 1) // MOST_MOVES
        row += math.floor(-dv) + more // 4 - 1
        column += math.floor(-du) + more % 4 - 1
    return np.array([(row, column, k, 0), *rows[::-1]], np.int64)


@kernel
def away_from(open_: Masks, cells: NDArray[np.int64]) -> NDArray[np.int32]:
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
    space: Space, start: _Flood, end: _Flood, both: bool
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
        if not _make_moves(space, mine, u, v, int(heading)):
            return -1, -1, -1, False
        if both:
            mine, other = other, mine


@kernel(allocates=False)
def _reserve(fit: Any, u: Any, v: Any, heading: float, horizon_m: float) -> float:
    """Return the clearance at an exact pose beyond what the body keeps there, m."""
    c, s = math.cos(fit.map_T_grid[2]), math.sin(fit.map_T_grid[2])
    gx, gy = u * fit.size_m, v * fit.size_m
    x = fit.map_T_grid[0] + c * gx - s * gy
    y = fit.map_T_grid[1] + s * gx + c * gy
    away = math.hypot(x - fit.start[0], y - fit.start[1])
    needed = fit.near_m if away <= fit.reach_m else fit.margin_m
    yaw = fit.start[2] + heading * HEADING_RAD
    most = needed + horizon_m
    there = exact_clearance(fit.obstacles, fit.outline, x, y, yaw, most)
    return float(there - needed)


@kernel(allocates=False)
def _fits_along(space: Any, flood: Any, u: Any, v: Any, k: int, m: int) -> bool:
    """Return whether the body keeps its clearance during a move from a free pose.

    From the end back, as far as each clearance proves (Mirtich 1996).
    """
    turn = (flood.after[k, m] - k + HEADINGS // 2) % HEADINGS - HEADINGS // 2
    left_m = whole_m = space.motions[m]
    while left_m > 0.0:
        flood.state[_FITTED] += 1
        share = left_m / whole_m
        x = np.float32(u + share * flood.shift[k, m, 0])
        y = np.float32(v + share * flood.shift[k, m, 1])
        reserve_m = _reserve(space.fit, x, y, k + share * turn, left_m)
        if reserve_m < 0.0:
            return False
        left_m -= max(reserve_m, _PART_M)
    return True


@kernel(allocates=False, forceinline=True)
def _is_sure(
    space: Any, m: int, row: int, column: int, new: np.uint64, turn: np.uint64
) -> bool:
    """Return whether move ``m`` to a pose needs no exact check."""
    if space.is_turn[m]:
        return bool(space.fit.sure_turns[row, column] & turn)
    return bool(space.fit.sure[row, column] & new)


@kernel(allocates=False, forceinline=True)
def _make_moves(space: Any, flood: Any, u: float, v: float, k: int) -> bool:
    """Reach poses by each move from one; return whether there was room for all."""
    open_, seen = space.open, space.seen
    height, width = open_.shape
    one = np.uint64(1)
    bit = one << np.uint64(k)
    is_seen = seen[int(v), int(u)] & bit
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
        sees = is_seen and seen[row, column] & new
        if not middle & (bit | new) or (space.is_blind[m] and not sees):
            continue
        turn = bit if heading == (k + 1) % HEADINGS else new
        if space.is_turn[m] and not space.turns[row, column] & turn:
            continue
        if not _is_sure(space, m, row, column, new, turn):
            if flood.state[_FITTED] >= _MOST_FITTED:
                return False
            if not _fits_along(space, flood, u, v, k, m):
                continue
        if not _add(flood, u, v, k, m, x, y):
            return False
    return True


@kernel(allocates=False, forceinline=True)
def _add(flood: Any, u: float, v: float, k: int, m: int, x: Any, y: Any) -> bool:
    """Add the pose at x, y that a move from another reaches, if there is room.

    A pose is reached from the cell that lies ``floor(-shift)`` away, or the next, as
    within both cells the positions are any. ``origin`` is 1 + the move + the number of
    moves · (4 · rows + columns), these + 1 as rounded positions may add another cell.
    """
    state, room = flood.state, flood.poses.shape[0]
    count = state[_COUNT]
    if count - state[_DONE] >= room or count >= _MOST_POSES:
        return False
    row, column, heading = int(y), int(x), flood.after[k, m]
    rows = int(v) - row - math.floor(-flood.shift[k, m, 1]) + 1
    columns = int(u) - column - math.floor(-flood.shift[k, m, 0]) + 1
    code = 1 + m + MOST_MOVES * (4 * rows + columns)
    flood.origin[row, column, heading] = code
    flood.reached[row, column] |= np.uint64(1) << np.uint64(heading)
    at = count % room
    flood.poses[at, 0], flood.poses[at, 1] = x, y
    flood.poses[at, 2] = heading
    state[_COUNT] = count + 1
    if flood.toward.size:
        _queue(flood, at)
    return True
