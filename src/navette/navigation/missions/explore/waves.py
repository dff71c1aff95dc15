"""Distances along cells, connected sets and lines of sight in a grid."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

Mask = NDArray[np.bool_]
CellIndices = NDArray[np.int64]
UNREACHED = np.iinfo(np.int32).max


def steps_from(
    start: tuple[int, int], first: Mask, then: Mask, limit: int = UNREACHED
) -> NDArray[np.int32]:
    """Return the number of steps (H, W) from a cell; ``UNREACHED`` beyond ``limit``.

    Steps alternate between four and eight neighbours, so that their number is near to
    the Euclidean distance (octagonal distance).

    Args:
        start: the cell of the robot, which may be outside the grid.
        first: (H, W) cells that may be crossed until the first one of ``then``,
            which is a part of them.
        then: (H, W) cells that may be crossed from there on.
    """
    steps = np.full(then.shape, UNREACHED, np.int32)
    height, width = then.shape
    if 0 <= start[0] < height and 0 <= start[1] < width:
        sources = np.array([start], np.int64)
        _spread(steps, sources, first, then, bool(then[start]), limit)
    return steps


def steps_to(sources: CellIndices, free: Mask, limit: int) -> NDArray[np.int32]:
    """Return the number of steps (H, W) through free cells to the sources (N, 2)."""
    steps = np.full(free.shape, UNREACHED, np.int32)
    _spread(steps, sources, free, free, True, limit)
    return steps


def connected_sets(mask: Mask) -> list[CellIndices]:
    """Return the connected sets (eight neighbours) of true cells, as (N, 2) indices.

    The order depends on the map only.
    """
    cells = np.argwhere(mask)
    if not len(cells):
        return []
    labels = np.full(mask.shape, -1, np.int32)
    count = _label(cells, mask, labels)
    of_cell = labels[cells[:, 0], cells[:, 1]]
    order = np.argsort(of_cell, kind="stable")
    ends = np.searchsorted(of_cell[order], np.arange(1, count))
    return np.split(cells[order], ends)


@kernel
def first_that_sees(candidates: Any, cells: Any, occupied: Any, least: int) -> Any:
    """Return the index of the first candidate that sees ``least`` of the cells.

    Args:
        candidates, cells: (N, 2), (K, 2) indices.
        occupied: (H, W) cells that end a line of sight.

    If none sees as many, return the one that sees most; -1 if none sees any.
    """
    best, most = -1, 0
    for i in range(len(candidates)):
        seen = 0
        for k in range(len(cells)):
            if _is_clear(candidates[i], cells[k], occupied):
                seen += 1
        if seen > most:
            best, most = i, seen
        if most >= least:
            break
    return best


@kernel
def _is_clear(begin: Any, end: Any, occupied: Any) -> Any:
    """Return whether no cell of the line between two cells is occupied."""
    count = max(abs(end[0] - begin[0]), abs(end[1] - begin[1]))
    for i in range(1, count):
        row = begin[0] + int(np.rint(i * (end[0] - begin[0]) / count))
        column = begin[1] + int(np.rint(i * (end[1] - begin[1]) / count))
        if occupied[row, column]:
            return False
    return True


@kernel
def _spread(
    steps: Any, sources: Any, first: Any, then: Any, has_left: Any, limit: Any
) -> None:
    """Write the steps of a wave that starts in the sources."""
    queue = np.empty((steps.size, 2), np.int32)
    begin, end = 0, 0
    for i in range(len(sources)):
        if steps[sources[i, 0], sources[i, 1]] != 0:
            steps[sources[i, 0], sources[i, 1]] = 0
            queue[end] = sources[i]
            end += 1
    count = 0
    while begin < end and count < limit:
        count += 1
        layer_end = end
        for i in range(begin, layer_end):
            allowed = then if has_left else first
            end = _visit(queue[i], count, steps, allowed, queue, end)
        begin = layer_end
        for i in range(begin, end):
            has_left = has_left or then[queue[i, 0], queue[i, 1]]


@kernel
def _visit(
    cell: Any, count: Any, steps: Any, allowed: Any, queue: Any, end: Any
) -> Any:
    """Append the neighbours of a cell that were not reached to the queue."""
    height, width = steps.shape
    for row in range(max(cell[0] - 1, 0), min(cell[0] + 2, height)):
        for column in range(max(cell[1] - 1, 0), min(cell[1] + 2, width)):
            is_corner = row != cell[0] and column != cell[1]
            if is_corner and count % 2 == 1:
                continue
            if allowed[row, column] and steps[row, column] == UNREACHED:
                steps[row, column] = count
                queue[end, 0], queue[end, 1] = row, column
                end += 1
    return end


@kernel
def _label(cells: Any, mask: Any, labels: Any) -> Any:
    """Write the number of its connected set into each cell; return their count."""
    height, width = mask.shape
    stack = np.empty((len(cells), 2), np.int32)
    count = 0
    for i in range(len(cells)):
        if labels[cells[i, 0], cells[i, 1]] >= 0:
            continue
        stack[0, 0], stack[0, 1] = cells[i, 0], cells[i, 1]
        labels[cells[i, 0], cells[i, 1]] = count
        size = 1
        while size > 0:
            size -= 1
            row, column = stack[size, 0], stack[size, 1]
            for r in range(max(row - 1, 0), min(row + 2, height)):
                for c in range(max(column - 1, 0), min(column + 2, width)):
                    if mask[r, c] and labels[r, c] < 0:
                        labels[r, c] = count
                        stack[size, 0], stack[size, 1] = r, c
                        size += 1
        count += 1
    return count
