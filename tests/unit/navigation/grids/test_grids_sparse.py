"""Large arrays in small pages."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest

from navette.navigation.grids import (
    CellWindow,
    GrowthMemory,
    RowSpans,
    SparseGrid,
    copied,
    padded,
    sparse_zeros,
)


@pytest.mark.parametrize("shape", [(3, 5), (8000, 8000)])
def test_zeros_of_any_size_are_arrays_for_kernels(shape: tuple[int, int]) -> None:
    zeros = sparse_zeros(shape, np.uint64)
    assert zeros.shape == shape
    assert zeros.dtype == np.uint64
    assert zeros.flags.carray
    assert not zeros[::7, -1].any()
    zeros[1, 2] = 7
    assert zeros[1].sum() == 7


def test_growth_equals_numpys_padding() -> None:
    """Within the space around the grid, beyond it on each side, and in between."""
    rng = np.random.default_rng(1)
    for pad in (
        ((3, 0), (5, 7)),
        ((30, 0), (0, 0)),
        ((0, 30), (0, 0)),
        ((0, 0), (30, 0)),
        ((0, 0), (0, 30)),
        ((20, 20), (20, 20)),
    ):
        grid = SparseGrid((40, 30), np.uint64)
        grid.cells[:] = rng.integers(0, 2**63, (40, 30)).astype(np.uint64)
        grid.cells[rng.random((40, 30)) < 0.95] = 0
        whole = RowSpans(40)
        whole.add(CellWindow.whole((40, 30)))
        expected = np.pad(grid.cells, pad)
        grid.grow(pad, whole)
        np.testing.assert_array_equal(grid.cells, expected)
        assert not grid.cells.flags.c_contiguous, "kernels are compiled for one layout"


def test_only_what_was_written_is_copied_when_a_grid_grows_again() -> None:
    grid = SparseGrid((40, 30), np.uint8)
    written = RowSpans(40)
    for window, pad in (
        (CellWindow(5, 9, 20, 30), ((2, 0), (0, 10))),
        (CellWindow(6, 12, 0, 4), ((0, 30), (5, 0))),
        (CellWindow(7, 8, 39, 40), ((1, 1), (100, 1))),
    ):
        grid.cells[window.slices] = 9
        written.add(window)
        before = grid.cells.copy()
        grid.grow(pad, written)
        np.testing.assert_array_equal(grid.cells, np.pad(before, pad))
        written.grow(pad)


def test_a_large_grid_returns_the_memory_of_its_copied_rows() -> None:
    """Its values survive, whichever rows they are in."""
    grid = SparseGrid((2000, 2000), np.uint64)
    rows, columns = np.random.default_rng(2).integers(0, 2000, (2, 500))
    grid.cells[rows, columns] = 1 + np.arange(500, dtype=np.uint64)
    written = RowSpans(2000)
    for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
        written.add(CellWindow(row, row + 1, column, column + 1))
    before = grid.cells
    expected = before[rows, columns].copy()
    grid.grow(((3100, 10), (20, 3100)), written)
    assert grid.cells.shape == (5110, 5120)
    assert not np.shares_memory(before, grid.cells)
    np.testing.assert_array_equal(grid.cells[rows + 3100, columns + 20], expected)
    assert np.count_nonzero(grid.cells) == len(np.unique(rows * 2000 + columns))


def test_a_wide_grid_grows_far_without_a_copy() -> None:
    grid = SparseGrid((1000, 800), np.uint64)
    before = grid.cells
    before[0, 0] = 7
    grid.grow(((3000, 3000), (0, 3000)), RowSpans(1000))
    assert np.shares_memory(before, grid.cells)
    assert grid.cells[3000, 0] == 7


def test_a_cleared_grid_keeps_its_extent() -> None:
    grid = SparseGrid((4, 5), np.uint8)
    grid.cells[:] = 1
    grid.clear()
    np.testing.assert_array_equal(grid.cells, np.zeros((4, 5), np.uint8))


def occupied_mb() -> float:
    """Return the memory of this process."""
    status = Path("/proc/self/status").read_text()
    found = re.search(r"VmRSS:\s+(\d+) kB", status)
    assert found is not None
    return int(found[1]) / 1000


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_scattered_writes_occupy_a_small_page_each() -> None:
    zeros = sparse_zeros((64, 1 << 20), np.uint8)
    zeros[0, 0] = 1
    before_mb = occupied_mb()
    zeros[:, 7] = 1
    assert occupied_mb() < before_mb + 4


@pytest.mark.parametrize("shape", [(4, 6), (2500, 2000)])
@pytest.mark.parametrize(
    ("kind", "value"), [(np.int8, -1), (np.uint16, 0), (np.float32, np.nan)]
)
def test_padding_equals_numpys(
    shape: tuple[int, int], kind: type[np.generic], value: float
) -> None:
    cells = np.random.default_rng(3).integers(0, 99, shape).astype(kind)
    pad = ((3, 0), (5, 2))
    expected = np.pad(cells, pad, constant_values=value)
    np.testing.assert_array_equal(padded(cells, pad, value), expected)
    assert padded(cells, pad, value).dtype == kind


@pytest.mark.parametrize("shape", [(4, 6), (1900, 2300)])
@pytest.mark.parametrize(("kind", "value"), [(np.int8, -1), (np.float32, np.nan)])
def test_padding_within_its_memory_equals_numpys(
    shape: tuple[int, int], kind: type[np.generic], value: float
) -> None:
    """Also beyond the memory that is reserved: the edges become 4.5 times as long."""
    rng = np.random.default_rng(4)
    memory = GrowthMemory()
    grown = rng.integers(0, 99, shape).astype(kind)
    for pad in (
        ((3, 0), (5, 2)),
        ((0, 300), (0, 0)),
        ((0, 0), (0, 1)),
        ((0, 0), (400, 0)),
        ((257, 1), (0, 0)),
        ((3 * shape[0], 0), (0, 3 * shape[1])),
    ):
        expected = np.pad(grown, pad, constant_values=value)
        grown = memory.padded(grown, pad, value)
        np.testing.assert_array_equal(grown, expected)
        assert grown.dtype == kind
        grown[tuple(rng.integers(0, grown.shape))] = 7


def test_a_large_array_stays_where_it_is_when_it_grows() -> None:
    memory = GrowthMemory()
    first = memory.padded(np.zeros((2000, 2200), np.int8), ((0, 1), (0, 0)), -1)
    second = memory.padded(first, ((5, 0), (9, 0)), -1)
    assert np.shares_memory(first, second)
    third = memory.padded(second.copy(), ((5, 0), (0, 0)), -1)
    assert not np.shares_memory(second, third), "another array may still be used"


def test_a_copy_changes_independently() -> None:
    cells = np.arange(6).reshape(2, 3)
    other = copied(cells)
    other[0, 0] = 9
    assert cells[0, 0] == 0
    np.testing.assert_array_equal(other.ravel()[1:], cells.ravel()[1:])
