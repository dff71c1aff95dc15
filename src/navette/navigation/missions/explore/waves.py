"""Distances along cells, connected sets and lines of sight in a grid."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import NO_CELLS, CellWindow
from navette.navigation.missions.explore.cell_kinds import (
    FREE,
    OCCUPIED,
    PASSABLE,
    CellIndices,
    Kinds,
)

UNREACHED = np.iinfo(np.int32).max


class Reached(NamedTuple):
    """Cells that a wave reached.

    Attributes:
        steps: (h, w) number of steps to the cells of ``window``, or ``UNREACHED``.
        window: a part of the map.
        is_all: whether no cell is further away than the wave went.
    """

    steps: NDArray[np.int32]
    window: CellWindow
    is_all: bool

    def within(self, window: CellWindow) -> NDArray[np.int32]:
        """Return the steps to the cells of another window of the map."""
        found = np.full(window.shape, UNREACHED, np.int32)
        both = self.window.intersection(window)
        if not both.is_empty:
            here = both.shifted(-window.first_row, -window.first_column)
            mine = both.shifted(-self.window.first_row, -self.window.first_column)
            found[here.slices] = self.steps[mine.slices]
        return found


def steps_from(start: tuple[int, int], kinds: Kinds, limit: int) -> Reached:
    """Return the cells within ``limit`` steps from a cell, which may be outside.

    Steps alternate between four and eight neighbours, so that their number is near to
    the Euclidean distance (octagonal distance). They lead through free cells until the
    first passable one, and from there on through passable ones.
    """
    row, column = start
    cell = CellWindow(row, row + 1, column, column + 1)
    if cell.grown(0, kinds.shape) != cell:
        return Reached(np.empty((0, 0), np.int32), NO_CELLS, is_all=True)
    sources = np.array([start], np.int64)
    return _spread_from(sources, kinds, cell.grown(limit, kinds.shape), limit, PASSABLE)


def steps_to(sources: CellIndices, kinds: Kinds, limit: int) -> Reached:
    """Return the cells within ``limit`` steps through free cells to the sources."""
    window = CellWindow.of_cells(sources).grown(limit, kinds.shape)
    return _spread_from(sources, kinds, window, limit, FREE)


def _spread_from(
    sources: CellIndices, kinds: Kinds, window: CellWindow, limit: int, then: int
) -> Reached:
    steps = np.full(window.shape, UNREACHED, np.int32)
    is_all = _spread(kinds, window, steps, sources, then, limit)
    return Reached(steps, window, bool(is_all))


def connected_sets(cells: CellIndices, least: int) -> list[CellIndices]:
    """Return the connected sets (eight neighbours) of at least so many cells.

    ``cells`` and each of the sets are in the order of the rows.
    """
    if not len(cells):
        return []
    labels = np.empty(len(cells), np.int64)
    count = _label(cells, np.empty(len(cells), np.int64), labels)
    sizes = np.bincount(labels, minlength=count)
    is_large = sizes[labels] >= least
    cells, labels = cells[is_large], labels[is_large]
    cells = cells[np.argsort(labels, kind="stable")]
    ends = np.cumsum(sizes[sizes >= least])
    return np.split(cells, ends[:-1]) if len(ends) else []


@kernel
def first_that_sees(candidates: Any, cells: Any, kinds: Any, least: int) -> Any:
    """Return the index of the first candidate that sees ``least`` of the cells.

    Args:
        candidates, cells: (N, 2), (K, 2) indices.
        kinds: (H, W); an occupied cell ends a line of sight.

    If none sees as many, return the one that sees most; -1 if none sees any.
    """
    best, most = -1, 0
    for i in range(len(candidates)):
        seen = 0
        for k in range(len(cells)):
            if _is_clear(candidates[i], cells[k], kinds):
                seen += 1
        if seen > most:
            best, most = i, seen
        if most >= least:
            break
    return best


@kernel
def _is_clear(begin: Any, end: Any, kinds: Any) -> Any:
    """Return whether no cell of the line between two cells is occupied."""
    count = max(abs(end[0] - begin[0]), abs(end[1] - begin[1]))
    for i in range(1, count):
        row = begin[0] + int(np.rint(i * (end[0] - begin[0]) / count))
        column = begin[1] + int(np.rint(i * (end[1] - begin[1]) / count))
        if (kinds[row, column] & OCCUPIED) != 0:
            return False
    return True


@kernel
def _spread(
    kinds: Any, window: CellWindow, steps: Any, sources: Any, then: int, limit: int
) -> Any:
    """Write the steps of a wave from the sources; return whether it ended by itself.

    The wave crosses free cells until its first cell of the kind ``then``, and from
    there on cells of that kind.
    """
    top, left = window.first_row, window.first_column
    here = np.empty((max(len(sources), 64), 2), np.int32)
    count, size = 0, 0
    has_left = False
    for i in range(len(sources)):
        row, column = sources[i, 0] - top, sources[i, 1] - left
        if steps[row, column] != 0:
            steps[row, column] = 0
            here[size, 0], here[size, 1] = row, column
            size += 1
            has_left |= (kinds[sources[i, 0], sources[i, 1]] & then) != 0
    there = np.empty((64, 2), np.int32)
    while size > 0 and count < limit:
        count += 1
        if len(there) < 8 * size:
            there = np.empty((16 * size, 2), np.int32)
        crossed = then if has_left else FREE
        found = 0
        for i in range(size):
            found = _visit(here[i], count, steps, kinds, window, crossed, there, found)
        if not has_left:
            for i in range(found):
                kind = kinds[there[i, 0] + top, there[i, 1] + left]
                has_left |= (kind & then) != 0
        here, there, size = there, here, found
    return size == 0


@kernel(allocates=False)
def _visit(
    cell: Any,
    count: int,
    steps: Any,
    kinds: Any,
    window: CellWindow,
    crossed: int,
    queue: Any,
    end: int,
) -> int:
    """Append the neighbours of a cell that were not reached to the queue."""
    row, column = cell
    down, right = (-1, 1, 0, 0, -1, -1, 1, 1), (0, 0, -1, 1, -1, 1, -1, 1)
    for k in range(4 if count % 2 == 1 else 8):
        # Negative ones become very large.
        r, c = np.uintp(row + down[k]), np.uintp(column + right[k])
        if r >= steps.shape[0] or c >= steps.shape[1] or steps[r, c] != UNREACHED:
            continue
        at = r + np.uintp(window.first_row), c + np.uintp(window.first_column)
        if (kinds[at] & crossed) != 0:
            steps[r, c] = count
            queue[end, 0], queue[end, 1] = r, c
            end += 1
    return end


@kernel(allocates=False)
def _label(cells: Any, parents: Any, labels: Any) -> int:
    """Write the number of its connected set for each cell; return their count.

    The sets are numbered in the order of their first cells.
    """
    begin = above = end_above = 0  # of the row, and of the row above it
    for i in range(len(cells)):
        parents[i] = i
        row, column = cells[i]
        if i == 0 or cells[i - 1, 0] != row:
            above = begin if i > 0 and cells[i - 1, 0] == row - 1 else i
            begin = end_above = i
        elif cells[i - 1, 1] == column - 1:
            _join(parents, i - 1, i)
        while above < end_above and cells[above, 1] < column - 1:
            above += 1
        k = above
        while k < end_above and cells[k, 1] <= column + 1:
            _join(parents, k, i)
            k += 1
    count = 0
    for i in range(len(cells)):
        first = _first(parents, i)
        if first == i:
            labels[i] = count
            count += 1
        else:
            labels[i] = labels[first]
    return count


@kernel(allocates=False)
def _join(parents: Any, a: int, b: int) -> None:
    """Unite the sets of two cells under the first cell of both."""
    a, b = _first(parents, a), _first(parents, b)
    parents[max(a, b)] = min(a, b)


@kernel(allocates=False)
def _first(parents: Any, i: int) -> int:
    while parents[i] != i:
        parents[i] = parents[parents[i]]
        i = parents[i]
    return i
