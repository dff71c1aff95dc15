"""Arrays of zeros that occupy memory only where they are written."""

import numpy as np
import pytest

from navette.navigation.grids import padded_sparse, sparse_zeros


@pytest.mark.parametrize("shape", [(3, 5), (8000, 8000)])
def test_zeros_of_any_size_are_arrays_for_kernels(shape: tuple[int, int]) -> None:
    zeros = sparse_zeros(shape, np.uint64)
    assert zeros.shape == shape
    assert zeros.dtype == np.uint64
    assert zeros.flags.carray
    assert not zeros[::7, -1].any()
    zeros[1, 2] = 7
    assert zeros[1].sum() == 7


def test_padding_equals_that_of_numpy() -> None:
    rng = np.random.default_rng(1)
    array = rng.integers(0, 2**63, (40, 30)).astype(np.uint64)
    array[rng.random(array.shape) < 0.95] = 0
    pad = ((3, 0), (5, 7))
    np.testing.assert_array_equal(padded_sparse(array, pad), np.pad(array, pad))
