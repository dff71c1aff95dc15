from typing import NamedTuple

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.navigation.grids import (
    GridSpec,
    MapComparison,
    placed,
)

MAP = GridSpec(0.1, 100, 80, Pose2(-5.0, -4.0, 0.0))
SEEN = GridSpec(0.1, 40, 40, Pose2(-2.0, -2.0, 0.0))
ORIGIN = Pose2(0.0, 0.0, 0.0)


def free(spec: GridSpec) -> np.ndarray:
    return np.zeros(spec.shape, np.int8)


class Changes(NamedTuple):
    appeared: int
    vanished: int


def changes(remembered, seen, pose=ORIGIN, radius=1.5) -> Changes:
    compared = MapComparison(
        remembered, MAP, seen, placed(SEEN, pose), (pose.x, pose.y), radius
    )
    return Changes(compared.count_appeared(), compared.count_vanished())


def test_equal_grids_do_not_contradict() -> None:
    seen, remembered = free(SEEN), free(MAP)
    seen[20, 25] = remembered[40, 55] = 100
    assert changes(remembered, seen) == Changes(0, 0)


def test_one_cell_aside_is_the_same_obstacle_from_another_angle() -> None:
    seen, remembered = free(SEEN), free(MAP)
    seen[20, 25] = remembered[41, 54] = 100
    assert changes(remembered, seen) == Changes(0, 0)


def test_new_obstacles_count_in_unknown_parts_of_the_map_too() -> None:
    seen = free(SEEN)
    seen[18:22, 25] = 100
    assert changes(free(MAP), seen) == Changes(4, 0)
    assert changes(np.full(MAP.shape, -1, np.int8), seen) == Changes(4, 0)


def test_vanished_obstacles_count_only_where_seen_free() -> None:
    remembered = free(MAP)
    remembered[38:42, 55] = 100
    seen = free(SEEN)
    assert changes(remembered, seen) == Changes(0, 4)
    assert changes(remembered, np.full(SEEN.shape, -1, np.int8)) == Changes(0, 0)


@pytest.mark.parametrize(("apart_m", "count"), [(0.0, 4), (0.2, 4), (0.3, 0)])
def test_what_vanished_near_an_obstacle_may_count_as_a_part_of_it(
    apart_m: float, count: int
) -> None:
    remembered, seen = free(MAP), free(SEEN)
    remembered[38:42, 55] = 100
    seen[18:22, 28] = 100  # 0.3 m behind
    compared = MapComparison(remembered, MAP, seen, SEEN, (0.0, 0.0), 1.5)
    assert compared.count_vanished(apart_m) == count


def test_only_cells_within_the_radius_count() -> None:
    seen, remembered = free(SEEN), free(MAP)
    seen[20, 38] = 100
    remembered[40, 68] = 100
    remembered[5, 5] = 100
    assert changes(remembered, seen) == Changes(0, 0)
    assert changes(free(MAP), seen, radius=3.0) == Changes(1, 0)


def test_rotated_and_partly_outside() -> None:
    seen = np.full(SEEN.shape, 100, np.int8)
    found = changes(free(MAP), seen, Pose2(4.8, 3.8, 0.7), radius=9.0)
    assert 0 < found.appeared < seen.size
    assert changes(free(MAP), seen, Pose2(50.0, 0.0, 0.7), radius=9.0) == Changes(0, 0)


def test_bad_input_is_named() -> None:
    with pytest.raises(InvalidValueError, match="radius_m: -1"):
        changes(free(MAP), free(SEEN), radius=-1.0)
    with pytest.raises(InvalidValueError, match="seen: shape"):
        changes(free(MAP), free(MAP))
