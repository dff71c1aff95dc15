"""Cells inside areas of lethal cells, which the proof of no path skips."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.planning.body_space import BodySpace

#: A rectangle, a base at the rear end, a thin body, a triangle, an arrow.
BODIES = {
    "rectangle": ((0.35, 0.15), (-0.2, 0.15), (-0.2, -0.15), (0.35, -0.15)),
    "car": ((0.5, 0.15), (-0.05, 0.15), (-0.05, -0.15), (0.5, -0.15)),
    "thin": ((0.4, 0.04), (-0.4, 0.04), (-0.4, -0.04), (0.4, -0.04)),
    "triangle": ((0.5, 0.0), (-0.1, 0.2), (-0.1, -0.2)),
    "arrow": ((0.4, 0.0), (-0.3, 0.3), (-0.05, 0.0), (-0.3, -0.3)),
}


def areas(seed: int, shape: tuple[int, int]) -> np.ndarray:
    """Return large and small rectangles of lethal cells, and single ones."""
    rng = np.random.default_rng(seed)
    lethal = rng.random(shape) < 0.01
    for _ in range(rng.integers(1, 5)):
        row, column = rng.integers(0, shape)
        height, width = rng.integers(1, 25, 2)
        lethal[row : row + height, column : column + width] = True
    return lethal


@pytest.mark.parametrize("body", BODIES)
@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    margin_m=st.sampled_from((None, 0.0, 0.03)),
    resolution=st.sampled_from((0.03, 0.05, 0.1)),
    yaw=st.floats(-3.0, 3.0),
)
def test_large_areas_close_what_all_of_their_cells_close(
    body: str, seed: int, margin_m: float | None, resolution: float, yaw: float
) -> None:
    spec = GridSpec(resolution, 50, 40, Pose2(1.0, -2.0, 0.4))
    lethal, start = areas(seed, spec.shape), Pose2(1.5, -1.0, yaw)
    even = np.indices(spec.shape).sum(axis=0) % 2 == 0  # no cell has neighbours
    whole, some, others = (
        BodySpace(cells, spec, Footprint(BODIES[body]), start, margin_m=margin_m)._open
        for cells in (lethal, lethal & even, lethal & ~even)
    )
    np.testing.assert_array_equal(whole, some & others)
