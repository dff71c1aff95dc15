"""Frontiers of random maps: of updates and of whole maps, near the robot and in all."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.grids import CellWindow, GridSpec
from navette.navigation.missions.explore.frontiers import (
    FrontierParams,
    FrontierSearch,
)

SIDE = 60
SPEC = GridSpec(0.1, SIDE, SIDE, Pose2(-3.0, -3.0, 0.0))
PARAMS = FrontierParams(
    clearance_m=0.25, min_length_m=0.3, viewpoint_m=0.6, max_length_m=1.0
)
EVERYTHING = 1 << 20  # steps

seeds = st.integers(0, 2**32 - 1)


def random_map(rng: np.random.Generator) -> NDArray[np.int8]:
    """Return free space with boxes of occupied and unknown cells."""
    cells = np.zeros(SPEC.shape, np.int8)
    for value in rng.choice([100, -1, 100, -1, 30], 25).tolist():
        cells[random_window(rng, 12).slices] = value
    return cells


def random_window(rng: np.random.Generator, most: int) -> CellWindow:
    row, column = rng.integers(0, SIDE, 2).tolist()
    height, width = rng.integers(1, most, 2).tolist()
    return CellWindow(row, min(row + height, SIDE), column, min(column + width, SIDE))


def robots(rng: np.random.Generator) -> Sequence[tuple[float, float]]:
    return [tuple(rng.uniform(-2.9, 2.9, 2).tolist()) for _ in range(3)]


@given(seeds)
def test_updates_of_parts_equal_a_new_search(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = random_map(rng)
    search = FrontierSearch.of(cells, SPEC, PARAMS)
    for _ in range(6):
        window = random_window(rng, 30)
        cells[window.slices] = random_map(rng)[window.slices]
        search.update(cells[window.slices], window)
    whole = FrontierSearch.of(cells, SPEC, PARAMS)
    np.testing.assert_array_equal(search._map.kinds, whole._map.kinds)
    for robot in robots(rng):
        assert search.explore(robot) == whole.explore(robot)


@given(seeds)
def test_new_parameters_equal_a_new_search(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = random_map(rng)
    before = FrontierParams(clearance_m=0.5, passage_m=0.1)
    search = FrontierSearch.of(cells, SPEC, before)
    search.set_params(PARAMS)
    whole = FrontierSearch.of(cells, SPEC, PARAMS)
    for robot in robots(rng):
        assert search.explore(robot) == whole.explore(robot)


@given(seeds, st.sampled_from([1, 5, 14]), st.sampled_from([0.0, 1.0, 3.0]))
def test_a_search_that_begins_near_the_robot_finds_the_best_of_the_map(
    seed: int, first_steps: int, gain: float
) -> None:
    rng = np.random.default_rng(seed)
    search = FrontierSearch.of(random_map(rng), SPEC, replace(PARAMS, gain=gain))
    for robot in robots(rng):
        near = search.explore(robot, first_steps=first_steps)
        assert near == search.explore(robot, first_steps=EVERYTHING)
