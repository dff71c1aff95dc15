"""The map is rebuilt in a worker while the present one is used and changed."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, SquareRegion, placed
from navette.navigation.mapping import MapMemory, MapMemoryParams, PlacedCostmap
from navette.navigation.mapping.rebuilding import RebuildingMemory

PARAMS = MapMemoryParams(size_m=4.0, growth_m=2.0, max_size_m=60.0)
SPEC = GridSpec(0.1, 41, 41, Pose2(-2.02, -2.02, 0.0))


class SlowWorker:
    """Computes on request."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Any, Any, Any]] = []

    def run(
        self,
        compute: Callable[[], Any],
        finish: Callable[[Any], None],
        *,
        is_dropped: Callable[[], bool],
    ) -> None:
        self.waiting.append((compute, finish, is_dropped))

    def complete(self) -> None:
        """Complete the oldest computation."""
        compute, finish, is_dropped = self.waiting.pop(0)
        result = compute()
        if not is_dropped():
            finish(result)


class Rig:
    def __init__(self) -> None:
        self.worker = SlowWorker()
        self.rebuilt = 0
        self.map = RebuildingMemory(
            MapMemory(PARAMS), self.worker, on_rebuilt=self.on_rebuilt
        )

    def on_rebuilt(self) -> None:
        self.rebuilt += 1

    def fuse(self, costmap: PlacedCostmap) -> None:
        assert self.map.change(lambda memory: memory.fuse(costmap))


@pytest.fixture
def rig() -> Rig:
    return Rig()


def costmap(x: float) -> PlacedCostmap:
    pose = Pose2(x, 0.3 * x, 0.1 * x)
    cells = np.zeros(SPEC.shape, np.int8)
    hits = pose.apply(np.array([[1.0, y] for y in np.arange(-1.0, 1.0, 0.05)]))
    return PlacedCostmap(cells, placed(SPEC, pose), (x, 0.3 * x), pose, 0, hits=hits)


def fused(*places: float) -> MapMemory:
    memory = MapMemory(PARAMS)
    for x in places:
        memory.fuse(costmap(x))
    return memory


def assert_same(memory: MapMemory, expected: MapMemory) -> None:
    assert memory.spec == expected.spec
    np.testing.assert_array_equal(memory.cells, expected.cells)
    np.testing.assert_array_equal(memory.hit_points(), expected.hit_points())


def test_the_map_is_in_use_until_the_rebuilt_one_has_what_was_fused_meanwhile(
    rig: Rig,
) -> None:
    rig.fuse(costmap(0.0))
    rig.map.rebuild([costmap(0.2), costmap(5.0)])
    rig.fuse(costmap(10.0))
    assert_same(rig.map.memory, fused(0.0, 10.0))
    assert rig.rebuilt == 0
    rig.worker.complete()
    assert rig.rebuilt == 1
    assert_same(rig.map.memory, fused(0.2, 5.0, 10.0))
    assert rig.map.memory.take_change() is None, "readers need the whole map"
    rig.fuse(costmap(12.0))
    assert_same(rig.map.memory, fused(0.2, 5.0, 10.0, 12.0))


def test_what_is_cleared_meanwhile_is_cleared_from_both(rig: Rig) -> None:
    region = SquareRegion(1.0, 0.0, 0.5)
    rig.map.rebuild([costmap(0.0)])
    rig.map.change(lambda memory: memory.clear(region))
    rig.worker.complete()
    expected = fused(0.0)
    expected.clear(region)
    assert_same(rig.map.memory, expected)


def test_the_last_correction_counts(rig: Rig) -> None:
    rig.map.rebuild([costmap(0.0)])
    rig.fuse(costmap(3.0))
    rig.map.rebuild([costmap(1.0), costmap(3.5)])
    rig.worker.complete()
    assert rig.rebuilt == 0
    rig.worker.complete()
    assert rig.rebuilt == 1
    assert_same(rig.map.memory, fused(1.0, 3.5))


def test_a_map_that_is_reset_meanwhile_stays_so(rig: Rig) -> None:
    rig.map.rebuild([costmap(0.0)])
    rig.map.drop()
    rig.map.memory.reset()
    rig.worker.complete()
    assert rig.rebuilt == 0
    assert_same(rig.map.memory, MapMemory(PARAMS))


def test_a_loaded_map_is_under_the_rebuilt_one(rig: Rig) -> None:
    cells = np.full((40, 40), 100, np.int8)
    rig.map.memory.load(cells, GridSpec(0.1, 40, 40, Pose2(10.0, 0.0, 0.0)))
    rig.map.rebuild([costmap(10.0)])
    rig.worker.complete()
    memory = rig.map.memory
    assert memory.cells[memory.spec.cell_of(13.5, 3.5)] == 100
    assert memory.cells[memory.spec.cell_of(10.0, 3.0)] == 0
