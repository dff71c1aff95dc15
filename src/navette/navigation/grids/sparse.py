"""Large arrays of zeros of which only the parts that are written occupy memory."""

import math
import mmap
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Scalar = TypeVar("Scalar", bound=np.generic)

# Below this NumPy's own arrays are as good: they use large pages, which are faster.
_LARGE_BYTES = 40 << 20


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


def padded_sparse(
    array: NDArray[Scalar], pad: tuple[tuple[int, int], tuple[int, int]]
) -> NDArray[Scalar]:
    """Return an array (H, W) of few non-zeros with zeros around, as numpy.pad does."""
    (above, below), (left, right) = pad
    height, width = array.shape
    shape = (above + height + below, left + width + right)
    padded = sparse_zeros(shape, array.dtype.type)
    for row in np.flatnonzero(array.any(axis=1)):
        columns = np.flatnonzero(array[row])
        padded[above + row, left + columns] = array[row, columns]
    return padded
