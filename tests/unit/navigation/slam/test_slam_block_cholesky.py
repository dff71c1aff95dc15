"""Sparse equations in blocks of 3 x 3."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.navigation.slam.block_cholesky import BlockCholesky


def dense(size: int, pairs: np.ndarray, diagonal: np.ndarray, beside: np.ndarray):
    matrix = np.zeros((size, size, 3, 3))
    matrix[range(size), range(size)] = diagonal
    for (row, column), block in zip(pairs, beside, strict=True):
        matrix[row, column] += block
        matrix[column, row] += block.T
    return matrix.transpose(0, 2, 1, 3).reshape(3 * size, 3 * size)


@given(st.integers(1, 90), st.integers(0, 200), st.integers(0, 2**32 - 1))
def test_equals_dense_equations(size: int, count: int, seed: int) -> None:
    """Any connections, several blocks at a place, and nodes that nothing connects."""
    random = np.random.default_rng(seed)
    pairs = random.integers(size, size=(count, 2))
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    beside = random.normal(size=(len(pairs), 3, 3))
    diagonal = np.broadcast_to(np.eye(3), (size, 3, 3))
    right = random.normal(size=(size, 3))
    matrix = dense(size, pairs, 0.0 * diagonal, beside)
    lowest = np.linalg.eigvalsh(matrix).min()
    diagonal = (1.0 - lowest) * diagonal
    solution = BlockCholesky(size, pairs).solve(diagonal, beside, right)
    assert solution is not None
    matrix += (1.0 - lowest) * np.eye(3 * size)
    expected = np.linalg.solve(matrix, right.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(solution, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("lowest", [0.0, -1e-3, -10.0])
def test_a_matrix_that_is_not_positive_definite_has_no_solution(lowest: float) -> None:
    pairs = np.array([[0, 1], [1, 2]])
    diagonal = np.broadcast_to(np.diag([2.0, 2.0, lowest]), (3, 3, 3))
    solver = BlockCholesky(3, pairs)
    assert solver.solve(diagonal, np.zeros((2, 3, 3)), np.ones((3, 3))) is None


def test_a_band_stays_a_band() -> None:
    """A chain has one block below each of its diagonal's, but the last."""
    chain = np.column_stack([np.arange(999), np.arange(1, 1000)])
    random = np.random.default_rng(1)
    shuffled = random.permutation(1000)[chain]
    assert len(BlockCholesky(1000, shuffled)._rows) == 1999
