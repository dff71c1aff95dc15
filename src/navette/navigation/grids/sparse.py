"""Large arrays in small pages.

Of an array of zeros only the parts that are written occupy memory. And no write takes
long: the first one in a page of 2 MB, which NumPy requests from 4 MB on, zeroes all of
it, 0.1 to 25 ms, while the commands of a robot wait.
"""

import contextlib
import math
import mmap
import sys
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids.windows import CellWindow

Scalar = TypeVar("Scalar", bound=np.generic)

# NumPy's own arrays have small pages below.
_LARGE_BYTES = 4 << 20
_POPULATE_WRITE = 23  # MADV_POPULATE_WRITE of Linux, which mmap does not name
_NO_COLUMN = 1 << 40
_BLOCK = 64  # cells that are tested for non-zeros together
_STRIP = 256  # rows that are copied before their memory is returned
# Reserved memory of an array that grows: its edges, four times as long.
_RESERVED = 16
# A grid with such an edge gets much room on each side, into which it grows without a
# copy: that of 200 m takes 30 ms, in which the robot gets no command. Rows of a small
# grid would be in pages of their own, which slows all kernels.
_WIDE_CELLS, _WIDE_ROOM = 1000, 3000


def sparse_zeros(
    shape: tuple[int, ...], dtype: type[Scalar], *, large_bytes: int = _LARGE_BYTES
) -> NDArray[Scalar]:
    """Return zeros, in small pages if there are many.

    With large pages, a narrow band of writes through a map would occupy all of it.

    Args:
        shape: of the array.
        dtype: of its values.
        large_bytes: size from which small pages are used. NumPy may write the zeros of
            up to 32 MB, which takes longer than to use a small part of them.
    """
    return _zeros(shape, dtype, large_bytes)[0]


def copied(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a copy, in small pages if it is large."""
    return padded(array, ((0, 0), (0, 0)))


def padded(array: NDArray[Scalar], pad: "Padding", value: float = 0) -> NDArray[Scalar]:
    """Return an array (H, W) with a border, in small pages if it is large.

    Args:
        array: the inner part.
        pad: cells to add.
        value: of the border.
    """
    (above, below), (left, right) = pad
    height, width = array.shape
    shape = (above + height + below, left + width + right)
    larger, memory = _zeros(shape, array.dtype.type)
    if memory is not None:
        _provide_pages(memory)
    middle = larger[above : above + height]
    if value:
        larger[:above], larger[above + height :] = value, value
        middle[:, :left], middle[:, left + width :] = value, value
    middle[:, left : left + width] = array
    return larger


class GrowthMemory:
    """Memory of an array that grows: what it had needs no new pages.

    16 MB of them take 10 to 50 ms, in which the robot gets no command.
    """

    def __init__(self) -> None:
        self._array: NDArray[Any] | None = None
        self._memory: mmap.mmap | None = None

    def padded(
        self, array: NDArray[Scalar], pad: "Padding", value: float
    ) -> NDArray[Scalar]:
        """Return :func:`padded`; do not use the array of the last call any more.

        If that is ``array``, and there is room, its values move within the memory.
        """
        (above, below), (left, right) = pad
        height, width = array.shape
        shape = (above + height + below, left + width + right)
        length = math.prod(shape) * array.itemsize
        memory = self._memory if array is self._array else None
        if length < _LARGE_BYTES:
            return padded(array, pad, value)
        if memory is None or len(memory) < length:
            memory = _small_pages(_RESERVED * length)
        larger: NDArray[Scalar] = np.ndarray(shape, array.dtype, memory)
        columns = slice(left, left + width)
        # From the last row on: a row moves to where only rows after it have been.
        for first in reversed(range(0, height, _STRIP)):
            strip = array[first : first + _STRIP]
            row = above + first
            larger[row : row + len(strip), columns] = strip
        larger[:above] = larger[above + height :] = value
        larger[:, :left] = larger[:, columns.stop :] = value
        self._array, self._memory = larger, memory
        return larger


def _zeros(
    shape: tuple[int, ...], dtype: type[Scalar], large_bytes: int = _LARGE_BYTES
) -> tuple[NDArray[Scalar], mmap.mmap | None]:
    """Return :func:`sparse_zeros`, and their memory if it is not NumPy's."""
    length = math.prod(shape) * np.dtype(dtype).itemsize
    if length < large_bytes:
        return np.zeros(shape, dtype), None
    memory = _small_pages(length)
    return np.ndarray(shape, dtype, memory), memory


def _small_pages(length: int) -> mmap.mmap:
    """Return zeroed memory; on Linux a page that is only read occupies none of it."""
    if sys.platform != "linux":
        return mmap.mmap(-1, length)
    memory = mmap.mmap(-1, length, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    with contextlib.suppress(OSError):  # a kernel without large pages
        memory.madvise(mmap.MADV_NOHUGEPAGE)
    return memory


def _provide_pages(memory: mmap.mmap) -> None:
    """Get all pages at once: 16 MB take 4 ms to fill then, instead of 10."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):  # a kernel before 5.14
            memory.madvise(_POPULATE_WRITE)


Padding = tuple[tuple[int, int], tuple[int, int]]
"""Cells added above and below, left and right, as for :func:`numpy.pad`."""


class RowSpans:
    """The columns of each row that may have been written: from ``first`` to ``last``.

    To find the few non-zeros of a large array takes longer than to copy them.
    """

    def __init__(self, rows: int) -> None:
        self.first = np.full(rows, _NO_COLUMN, np.int64)
        self.last = np.zeros(rows, np.int64)

    def add(self, window: CellWindow) -> None:
        """Add the cells of a window."""
        first = self.first[window.first_row : window.last_row]
        last = self.last[window.first_row : window.last_row]
        np.minimum(first, window.first_column, out=first)
        np.maximum(last, window.last_column, out=last)

    def columns(self, rows: slice) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the first column of each of these rows, and the one after the last."""
        return self.first[rows], self.last[rows]

    def grow(self, pad: Padding) -> None:
        """Follow arrays that are padded."""
        rows, (left, _) = pad
        self.first = np.pad(self.first + left, rows, constant_values=_NO_COLUMN)
        self.last = np.pad(self.last + left, rows, constant_values=0)


class SparseGrid(Generic[Scalar]):
    """Zeros (H, W) with unused space around them, which growing uses without a copy.

    Attributes:
        cells: (H, W) the array, a part of a larger one: replaced when it grows.
    """

    def __init__(self, shape: tuple[int, int], dtype: type[Scalar]) -> None:
        self._dtype = dtype
        self._reserve(shape)

    def clear(self) -> None:
        """Replace the array by zeros."""
        self._reserve(self.cells.shape)

    def grow(self, pad: Padding, written: RowSpans) -> None:
        """Add zeros around, as :func:`numpy.pad` does.

        Args:
            pad: cells to add.
            written: contains all non-zeros.
        """
        (above, below), (left, right) = pad
        before = self.cells
        height, width = before.shape
        shape = (above + height + below, left + width + right)
        row, column = self._row - above, self._column - left
        most_rows, most_columns = self._space.shape
        has_space = row >= 0 and row + shape[0] <= most_rows
        if has_space and column >= 0 and column + shape[1] < most_columns:
            self._use(row, column, shape)
            return
        memory, top, row_bytes = self._memory, self._row, self._space.strides[0]
        self._reserve(shape)
        for first in range(0, height, _STRIP):
            strip = slice(first, first + _STRIP)
            at, columns = (above + first, left), written.columns(strip)
            _copy_non_zeros(before[strip], self.cells, at, *columns)
            if memory is not None:
                _release(memory, (top + strip.stop) * row_bytes)

    def _reserve(self, shape: tuple[int, ...]) -> None:
        height, width = shape
        edge = max(shape)
        room = edge // 2 if edge < _WIDE_CELLS else _WIDE_ROOM
        # One column more, so that kernels always get a part of the rows.
        size = (height + 2 * room, width + 2 * room + 1)
        self._space, self._memory = _zeros(size, self._dtype)
        self._use(room, room, (height, width))

    def _use(self, row: int, column: int, shape: tuple[int, int]) -> None:
        self._row, self._column = row, column
        rows, columns = slice(row, row + shape[0]), slice(column, column + shape[1])
        self.cells: NDArray[Scalar] = self._space[rows, columns]


def _release(memory: mmap.mmap, length: int) -> None:
    """Return the first bytes of memory that is not read again to the system."""
    whole_pages = min(length, len(memory)) // mmap.PAGESIZE * mmap.PAGESIZE
    if whole_pages and sys.platform == "linux":
        memory.madvise(mmap.MADV_DONTNEED, 0, whole_pages)


@kernel
def _copy_non_zeros(
    array: Any, padded: Any, at: tuple[int, int], first: Any, last: Any
) -> None:
    """Copy the non-zeros of each row: a page without one stays without memory.

    Zeros are skipped by the block, which takes a third of the time.
    """
    for row in range(first.size):
        line, copied = array[row], padded[at[0] + row]
        for start in range(first[row], last[row], _BLOCK):
            block = line[start : min(start + _BLOCK, last[row])]
            bits = block[0]
            for k in range(block.size):
                bits |= block[k]
            if bits == 0:
                continue
            for k in range(block.size):
                if block[k] != 0:
                    copied[at[1] + start + k] = block[k]
