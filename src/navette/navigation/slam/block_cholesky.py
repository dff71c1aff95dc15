"""Sparse symmetric equations in blocks of 3 x 3, solved by Cholesky's factorisation.

The unknowns are eliminated in the order of minimum degree (Tinney and Walker 1967),
which keeps the factor sparse; each column is subtracted from those to its right (George
and Liu 1981, "Computer Solution of Large Sparse Positive Definite Systems").
"""

import math

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


class BlockCholesky:
    """Solver of equations whose matrices have their blocks at the same places.

    Args:
        size: number N of block rows.
        pairs: (E, 2) block row and column of each block beside the diagonal, with the
            transposed block on the other side; a pair may occur several times.
    """

    def __init__(self, size: int, pairs: Indices) -> None:
        self._order, below = _eliminate(size, pairs)
        place = np.empty(size, np.int64)
        place[self._order] = np.arange(size)
        columns = [np.append(k, np.sort(place[nodes])) for k, nodes in enumerate(below)]
        self._start = np.cumsum([0, *map(len, columns)])
        self._rows = np.concatenate([np.empty(0, np.int64), *columns])
        # Where the blocks are in the factor, which is the triangle below the diagonal.
        first, second = place[pairs].T
        self._is_above = first < second
        low, high = np.minimum(first, second), np.maximum(first, second)
        column_of = np.repeat(np.arange(size), np.diff(self._start))
        keys = column_of * size + self._rows
        self._slots = np.searchsorted(keys, low * size + high)

    def solve(self, diagonal: Floats, beside: Floats, right: Floats) -> Floats | None:
        """Return the solution (N, 3); None: the matrix is not positive definite.

        Args:
            diagonal: (N, 3, 3) blocks on the diagonal.
            beside: (E, 3, 3) blocks of the pairs; those of one place are added.
            right: (N, 3) right side.
        """
        factor = np.zeros((len(self._rows), 3, 3))
        factor[self._start[:-1]] = diagonal[self._order]
        turned = np.where(
            self._is_above[:, None, None], beside.transpose(0, 2, 1), beside
        )
        np.add.at(factor, self._slots, turned)
        ordered = right[self._order]
        if not _factorise(self._start, self._rows, factor):
            return None
        _substitute_forward(self._start, self._rows, factor, ordered)
        _substitute_backward(self._start, self._rows, factor, ordered)
        solution = np.empty_like(right)
        solution[self._order] = ordered
        return solution


def _eliminate(size: int, pairs: Indices) -> tuple[Indices, list[Indices]]:
    """Return the order of elimination, and each column's rows below the diagonal.

    The node with the fewest neighbours is next. To eliminate it connects its neighbours
    with each other; they are the rows of its column. ``links`` has a bit per neighbour.
    """
    node_bit = np.uint64(1) << (np.arange(size) % 64).astype(np.uint64)
    links = np.zeros((size, size // 64 + 1), np.uint64)
    for one, other in (pairs.T, pairs.T[::-1]):
        np.bitwise_or.at(links, (one, other // 64), node_bit[other])
    degree = np.bitwise_count(links).sum(axis=1, dtype=np.int64)
    order, below = np.empty(size, np.int64), []
    for k in range(size):
        node = order[k] = degree.argmin()
        bits = np.unpackbits(links[node].view(np.uint8), count=size, bitorder="little")
        around = np.flatnonzero(bits)
        joined = links[around] | links[node]
        joined[:, node // 64] &= ~node_bit[node]
        joined[np.arange(len(around)), around // 64] &= ~node_bit[around]
        links[around] = joined
        degree[around] = np.bitwise_count(joined).sum(axis=1, dtype=np.int64)
        degree[node] = size  # eliminated
        below.append(around)
    return order, below


@kernel(allocates=False)
def _factorise(start: Indices, rows: Indices, factor: Floats) -> bool:
    """Replace the matrix by its factor; False: it is not positive definite."""
    for column in range(len(start) - 1):
        first, end = start[column], start[column + 1]
        if not _factorise_block(factor, first):
            return False
        for k in range(first + 1, end):
            _divide(factor, k, first)
        for k in range(first + 1, end):
            slot = start[rows[k]]
            for m in range(k, end):
                while rows[slot] != rows[m]:
                    slot += 1
                _subtract_product(factor, slot, m, k)
    return True


@kernel(allocates=False)
def _factorise_block(factor: Floats, at: int) -> bool:
    """Replace a block on the diagonal by its lower factor."""
    for i in range(3):
        for j in range(i + 1):
            value = factor[at, i, j]
            for k in range(j):
                value -= factor[at, i, k] * factor[at, j, k]
            if i != j:
                factor[at, i, j] = value / factor[at, j, j]
            elif value > 0.0:
                factor[at, i, i] = math.sqrt(value)
            else:
                return False
    return True


@kernel(allocates=False)
def _divide(factor: Floats, at: int, diagonal: int) -> None:
    """Multiply a block by the inverse transposed factor on the diagonal."""
    for i in range(3):
        for j in range(3):
            value = factor[at, i, j]
            for k in range(j):
                value -= factor[at, i, k] * factor[diagonal, j, k]
            factor[at, i, j] = value / factor[diagonal, j, j]


@kernel(allocates=False)
def _subtract_product(factor: Floats, at: int, left: int, right: int) -> None:
    """Subtract a block times another one, transposed."""
    for i in range(3):
        for j in range(3):
            value = 0.0
            for k in range(3):
                value += factor[left, i, k] * factor[right, j, k]
            factor[at, i, j] -= value


@kernel(allocates=False)
def _substitute_forward(
    start: Indices, rows: Indices, factor: Floats, x: Floats
) -> None:
    """Replace the right side (N, 3) by the factor's inverse times it."""
    for column in range(len(start) - 1):
        first = start[column]
        for i in range(3):
            for k in range(i):
                x[column, i] -= factor[first, i, k] * x[column, k]
            x[column, i] /= factor[first, i, i]
        for m in range(first + 1, start[column + 1]):
            for i in range(3):
                for k in range(3):
                    x[rows[m], i] -= factor[m, i, k] * x[column, k]


@kernel(allocates=False)
def _substitute_backward(
    start: Indices, rows: Indices, factor: Floats, x: Floats
) -> None:
    """Replace (N, 3) by the transposed factor's inverse times it."""
    for column in range(len(start) - 2, -1, -1):
        first = start[column]
        for m in range(first + 1, start[column + 1]):
            for i in range(3):
                for k in range(3):
                    x[column, i] -= factor[m, k, i] * x[rows[m], k]
        for i in range(2, -1, -1):
            for k in range(i + 1, 3):
                x[column, i] -= factor[first, k, i] * x[column, k]
            x[column, i] /= factor[first, i, i]
