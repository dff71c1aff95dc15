"""Large arrays of zeros of which only the parts that are written occupy memory."""

import math
import mmap
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids.windows import CellWindow

Scalar = TypeVar("Scalar", bound=np.generic)

# Below this NumPy's own arrays are as good: they use large pages, which are faster.
_LARGE_BYTES = 40 << 20
_NO_COLUMN = 1 << 40


def sparse_zeros(shape: tuple[int, ...], dtype: type[Scalar]) -> NDArray[Scalar]:
    """Return zeros, in small pages if there are many.

    NumPy requests pages of 2 MB for large arrays, so that a narrow band of writes
    through a map occupies all of it.
    """
    size = math.prod(shape)
    length = size * np.dtype(dtype).itemsize
    if length < _LARGE_BYTES:
        return np.zeros(shape, dtype)
    return np.frombuffer(mmap.mmap(-1, length), dtype, size).reshape(shape)


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

    def grow(self, pad: Padding) -> None:
        """Follow arrays that are padded."""
        rows, (left, _) = pad
        self.first = np.pad(self.first + left, rows, constant_values=_NO_COLUMN)
        self.last = np.pad(self.last + left, rows, constant_values=0)


def padded_sparse(
    array: NDArray[Scalar], pad: Padding, written: RowSpans
) -> NDArray[Scalar]:
    """Return an array (H, W) of few non-zeros with zeros around, as numpy.pad does.

    All non-zeros are within ``written``.
    """
    (above, below), (left, right) = pad
    height, width = array.shape
    shape = (above + height + below, left + width + right)
    padded = sparse_zeros(shape, array.dtype.type)
    for row in np.flatnonzero(written.first < written.last).tolist():
        first = int(written.first[row])
        part = array[row, first : written.last[row]]
        columns = np.flatnonzero(part)
        padded[above + row, left + first + columns] = part[columns]
    return padded
