"""Whether a map is in the frame of the simulated world."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.stack.map_fit import fits_world

# A room of 8 m × 6 m with a box, as outlines.
WALLS = ((0.0, -3.0, 8.0, 0.2), (0.0, 3.0, 8.0, 0.2), (-4.0, 0.0, 0.2, 6.0),
         (4.0, 0.0, 0.2, 6.0), (1.5, 1.0, 1.0, 0.6))  # fmt: skip
OUTLINES = [
    np.array(
        [
            (x - w / 2, y - h / 2),
            (x + w / 2, y - h / 2),
            (x + w / 2, y + h / 2),
            (x - w / 2, y + h / 2),
        ]
    )
    for x, y, w, h in WALLS
]


def room(map_T_world: Pose2) -> tuple[np.ndarray, GridSpec]:
    """Return a map of the room whose frame lies elsewhere."""
    spec = GridSpec(0.05, 240, 240, Pose2(-6.0, -6.0, 0.0))
    row, column = np.indices(spec.shape)
    cells = np.stack([row.ravel(), column.ravel()], axis=1)
    world = map_T_world.inverse().apply(spec.centers_of(cells))
    occupied = np.zeros(len(cells), bool)
    for x, y, w, h in WALLS:
        away = np.abs(world - (x, y))
        occupied |= (away[:, 0] <= w / 2) & (away[:, 1] <= h / 2)
    return np.where(occupied, 100, 0).astype(np.int8).reshape(spec.shape), spec


def test_a_map_in_the_frame_of_the_world_fits() -> None:
    assert fits_world(*room(Pose2(0.0, 0.0, 0.0)), OUTLINES)


@pytest.mark.parametrize(
    "map_T_world", [(2.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 0.5), (-3, 1, 2)]
)
def test_a_map_in_another_frame_does_not(
    map_T_world: tuple[float, float, float],
) -> None:
    assert not fits_world(*room(Pose2(*map_T_world)), OUTLINES)


def test_a_map_of_a_part_of_the_world_fits() -> None:
    cells, spec = room(Pose2(0.0, 0.0, 0.0))
    cells[:, 120:] = -1
    assert fits_world(cells, spec, OUTLINES)


def test_a_map_whose_furniture_was_moved_fits() -> None:
    cells, spec = room(Pose2(0.0, 0.0, 0.0))
    cells[90:110, 70:91] = 100
    assert fits_world(cells, spec, OUTLINES)


def test_the_origin_may_be_turned() -> None:
    """The cells are stored in another order; the frame is the world's."""
    cells, spec = room(Pose2(0.0, 0.0, 0.0))
    origin = Pose2(spec.origin.x, spec.origin.y + 12.0, -math.pi / 2)
    turned = GridSpec(0.05, 240, 240, origin)
    assert fits_world(np.rot90(cells, 1).copy(), turned, OUTLINES)


def test_a_map_without_obstacles_cannot_be_placed() -> None:
    _, spec = room(Pose2(0.0, 0.0, 0.0))
    assert not fits_world(np.zeros(spec.shape, np.int8), spec, OUTLINES)
