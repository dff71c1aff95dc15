"""Zones of a mask on a map: the whole map against the parts that changed."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import label

from navette.geometry import Pose2
from navette.navigation.grids import LETHAL, CellWindow, GridSpec, MapPart, ReceivedMap
from navette.navigation.grids.zones import KeepOutZones, ZonedMap

SIDE = 40


def window(rng: np.random.Generator) -> CellWindow:
    row, column = rng.integers(0, SIDE, 2).tolist()
    height, width = rng.integers(1, 15, 2).tolist()
    return CellWindow(row, min(row + height, SIDE), column, min(column + width, SIDE))


def pose(rng: np.random.Generator, most: float) -> Pose2:
    return Pose2(*rng.uniform(-most, most, 2), rng.uniform(-np.pi, np.pi))


@given(st.integers(0, 2**32 - 1), st.booleans())
def test_a_zoned_map_has_the_cells_of_the_map_and_of_the_zones(
    seed: int, is_shared: bool
) -> None:
    rng = np.random.default_rng(seed)
    spec = GridSpec(0.1, SIDE, SIDE, pose(rng, 3.0))
    mask_spec = GridSpec(0.17, 25, 30, pose(rng, 3.0))
    mask = np.zeros(mask_spec.shape, np.int8)
    rows, columns = sorted(rng.integers(0, 30, 2)), sorted(rng.integers(0, 25, 2))
    mask[rows[0] : rows[1] + 1, columns[0] : columns[1] + 1] = LETHAL
    received = ReceivedMap(rng.integers(-1, 99, spec.shape).astype(np.int8), spec)
    zoned = ZonedMap(KeepOutZones(mask, mask_spec))
    zoned.update(received, CellWindow.whole(spec.shape))
    for _ in range(4):
        part = window(rng)
        new = rng.integers(-1, 99, part.shape).astype(np.int8)
        changed = received.update(MapPart(new, part))
        before = zoned.update(received, CellWindow(0, 0, 0, 0))
        kept = before.copy()
        if is_shared:
            zoned.share()
        cells = zoned.update(received, changed)
        if is_shared:
            np.testing.assert_array_equal(before, kept)
    centres = spec.centers_of(np.argwhere(np.ones(spec.shape)))
    uv = mask_spec.origin.inverse().apply(centres) / mask_spec.resolution
    column, row = np.floor(uv).astype(int).T
    inside = (column >= 0) & (column < 25) & (row >= 0) & (row < 30)
    forbidden = np.zeros(len(centres), bool)
    forbidden[inside] = mask[row[inside], column[inside]] == LETHAL
    expected = np.where(forbidden.reshape(spec.shape), LETHAL, received.cells)
    np.testing.assert_array_equal(cells, expected)


@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([0.02, 0.05, 0.07, 0.1]),
    st.booleans(),
)
def test_a_line_of_one_cell_of_a_mask_closes_a_coarser_map(
    seed: int, edge_m: float, is_row: bool
) -> None:
    rng = np.random.default_rng(seed)
    spec = GridSpec(0.1, SIDE, SIDE, Pose2(-2.0, -2.0, 0.0))
    turn = Pose2(*rng.uniform(-0.5, 0.5, 2), rng.uniform(-np.pi, np.pi))
    length = round(8.0 / edge_m)
    corner = Pose2(-length * edge_m / 2, -length * edge_m / 2, 0.0)
    mask = np.zeros((length, length), np.int8)
    line = length // 2 + int(rng.integers(-5, 5))
    mask[(line, slice(None)) if is_row else (slice(None), line)] = LETHAL
    occupancy = np.zeros(spec.shape, np.int8)
    zones = KeepOutZones(mask, GridSpec(edge_m, length, length, turn @ corner))
    zones.mark(occupancy, spec, CellWindow.whole(spec.shape))
    count = label(occupancy != LETHAL)[1]
    assert count >= 2
    # A zone grows by less than a cell of the map.
    rows, columns = np.nonzero(occupancy == LETHAL)
    centres = spec.centers_of(np.column_stack([rows, columns]))
    local = (turn @ corner).inverse().apply(centres)[:, 1 if is_row else 0]
    assert np.abs(local - (line + 0.5) * edge_m).max() <= edge_m / 2 + 0.0708
