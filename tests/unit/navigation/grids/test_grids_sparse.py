"""Arrays of zeros that occupy memory only where they are written."""

import numpy as np
import pytest

from navette.navigation.grids import CellWindow, RowSpans, padded_sparse, sparse_zeros


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
    whole = RowSpans(40)
    whole.add(CellWindow.whole(array.shape))
    padded = padded_sparse(array, pad, whole)
    np.testing.assert_array_equal(padded, np.pad(array, pad))


def test_only_what_was_written_is_copied_when_an_array_grows_again() -> None:
    array = np.zeros((40, 30), np.uint64)
    written = RowSpans(40)
    for window, pad in (
        (CellWindow(5, 9, 20, 30), ((2, 0), (0, 10))),
        (CellWindow(6, 12, 0, 4), ((0, 3), (5, 0))),
        (CellWindow(7, 8, 39, 40), ((1, 1), (1, 1))),
    ):
        array[window.slices] = 9
        written.add(window)
        before, array = array, padded_sparse(array, pad, written)
        np.testing.assert_array_equal(array, np.pad(before, pad))
        written.grow(pad)
