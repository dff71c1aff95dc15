"""Nav2's services of the global costmap, and what clearing does to the map."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearCostmapAroundRobot,
    ClearCostmapExceptRegion,
    ClearEntireCostmap,
    GetCost,
    GetCostmap,
)
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.navigation.grids import (
    GridSpec,
    SquareRegion,
    grid_from_message,
    grid_to_message,
)
from navette.navigation.grids.costmap_values import costmap_values
from navette.navigation.mapping import MapMemory, MapMemoryParams
from navette.navigation.mapping.memory import PlacedCostmap
from navette.navigation.mapping.node import MapMemoryNode
from navette.runtime import Parameter
from navette.runtime.stage.path_messages import pose_message
from navette.runtime.testing import GraphHarness
from navette.runtime.time import ns_to_stamp

SPEC = GridSpec(0.1, 40, 40, Pose2(-2.0, -2.0, 0.0))


class MappedRobot:
    """A robot at (1, 0) that has seen a wall around it and sees nothing any more."""

    def __init__(self, graph: GraphHarness) -> None:
        self.graph = graph
        self.node = graph.add(
            MapMemoryNode(
                context=graph.context,
                parameter_overrides=[
                    Parameter("size_m", value=10.0),
                    Parameter("footprint_m", value=[0.2, 0.2, -0.2, 0.0, 0.2, -0.2]),
                ],
            )
        )
        self.maps = graph.collect("/map", OccupancyGrid, latched=True)
        self.costmaps = graph.collect(
            "/global_costmap/costmap", OccupancyGrid, latched=True
        )
        graph.node.create_timer(0.1, self._move)
        graph.run_for(0.3)

    def see(self, cells: np.ndarray) -> None:
        msg = grid_to_message(cells, SPEC, "base_link", self.graph.now_ns)
        self.graph.publish("/costmap", msg)
        self.graph.run_for(0.3)

    def _move(self) -> None:
        msg = Odometry(child_frame_id="base_link")
        msg.header.frame_id = "map"
        msg.header.stamp = ns_to_stamp(self.graph.now_ns)
        msg.pose.pose = pose_message(Pose2(1.0, 0.0, 0.0))
        self.graph.publish("/odom/filtered", msg)

    def value(self, x: float, y: float) -> int:
        cells, spec = grid_from_message(self.maps.last)
        return int(cells[spec.cell_of(x, y)])

    def call(self, service: Any, name: str, **fields: Any) -> Any:
        response = self.graph.call(
            service, f"/global_costmap/{name}", service.Request(**fields)
        )
        self.graph.run_for(0.1)
        return response


@pytest.fixture
def robot() -> Iterator[MappedRobot]:
    with GraphHarness() as graph:
        made = MappedRobot(graph)
        cells = np.zeros(SPEC.shape, np.int8)
        cells[:, 35] = 100
        cells[30:, 35] = 40
        made.see(cells)
        made.node._newest = None  # what was seen last is not fused again
        assert made.value(2.55, 0.05) == 100
        yield made


def test_the_map_has_nav2s_name_too(robot: MappedRobot) -> None:
    assert robot.costmaps.last == robot.maps.last


def test_clear_entirely(robot: MappedRobot) -> None:
    robot.call(ClearEntireCostmap, "clear_entirely_global_costmap")
    assert (np.asarray(robot.maps.last.data) == -1).all()
    assert robot.costmaps.last == robot.maps.last


def test_what_is_seen_now_is_fused_again_at_once(robot: MappedRobot) -> None:
    cells = np.zeros(SPEC.shape, np.int8)
    cells[10, 10] = 100
    robot.see(cells)
    robot.call(ClearEntireCostmap, "clear_entirely_global_costmap")
    assert robot.value(0.05, -0.95) == 100
    assert robot.value(2.55, 0.05) == 0
    assert robot.value(-3.0, 0.0) == -1


@pytest.mark.parametrize(
    "name", ["clear_around_global_costmap", "clear_costmap_around_robot"]
)
def test_clear_around_the_robot(robot: MappedRobot, name: str) -> None:
    robot.call(ClearCostmapAroundRobot, name, reset_distance=2.0)
    assert robot.value(1.55, 0.05) == -1
    assert robot.value(0.15, -0.85) == -1
    assert robot.value(2.55, 0.05) == 100
    assert robot.value(-0.5, 0.0) == 0


@pytest.mark.parametrize(
    "name", ["clear_around_pose_global_costmap", "clear_costmap_around_pose"]
)
def test_clear_around_a_pose(robot: MappedRobot, name: str) -> None:
    pose = PoseStamped(pose=pose_message(Pose2(1.5, 0.0, 0.0)))
    pose.header.frame_id = "base_link"
    robot.call(ClearCostmapAroundPose, name, pose=pose, reset_distance=1.0)
    assert robot.value(2.55, 0.05) == -1
    assert robot.value(2.55, 0.75) == 100
    pose.header.frame_id = "moon"
    before = robot.maps.count
    robot.call(ClearCostmapAroundPose, name, pose=pose, reset_distance=1.0)
    assert robot.maps.count == before


@pytest.mark.parametrize(
    "name", ["clear_except_global_costmap", "clear_costmap_except_region"]
)
def test_clear_all_but_a_region(robot: MappedRobot, name: str) -> None:
    robot.call(ClearCostmapExceptRegion, name, reset_distance=2.0)
    assert robot.value(1.55, 0.05) == 0
    assert robot.value(2.55, 0.05) == -1
    for invalid in (math.nan, -1.0):
        robot.call(ClearCostmapExceptRegion, name, reset_distance=invalid)
        assert robot.value(1.55, 0.05) == 0


def test_get_costmap_has_nav2s_costs(robot: MappedRobot) -> None:
    costmap = robot.call(GetCostmap, "get_costmap").map
    cells, spec = grid_from_message(robot.maps.last)
    assert (costmap.metadata.size_x, costmap.metadata.size_y) == (
        spec.width,
        spec.height,
    )
    assert costmap.header.frame_id == "map"
    data = np.asarray(costmap.data).reshape(spec.shape)
    assert set(np.unique(data).tolist()) == {0, 254, 255} | {
        int(costmap_values(np.array([40], np.int8))[0])
    }
    assert (data[cells == 100] == 254).all()
    assert (data[cells == -1] == 255).all()


def test_costs_are_published_as_the_occupancies_they_came_from() -> None:
    """nav2_costmap_2d publishes cost c as 1 + 97 (c - 1) // 251, and 253 as 99."""
    occupancies = np.arange(-1, 101, dtype=np.int8)
    costs = costmap_values(occupancies).astype(int)
    published = [
        {0: 0, 253: 99, 254: 100, 255: -1}.get(c, 1 + 97 * (c - 1) // 251)
        for c in costs.tolist()
    ]
    assert published == occupancies.tolist()


def test_get_cost_at_a_point_and_under_the_footprint(robot: MappedRobot) -> None:
    def cost(x: float, y: float, *, footprint: bool = False) -> float:
        request = {"x": x, "y": y, "use_footprint": footprint}
        response = robot.call(GetCost, "get_cost_global_costmap", **request)
        return float(response.cost)

    assert cost(2.55, 0.05) == 254.0
    assert cost(2.4, 0.05) == 0.0
    assert cost(2.4, 0.05, footprint=True) == 254.0
    assert cost(-4.0, 0.0) == 255.0
    assert cost(40.0, 0.0) == -1.0
    assert cost(math.nan, 0.0) == -1.0


@pytest.mark.parametrize("fusion", ["overwrite", "log_odds"])
def test_clearing_restores_the_loaded_map(fusion: str) -> None:
    memory = MapMemory(MapMemoryParams(fusion=fusion))
    cells = np.full((30, 50), -1, np.int8)
    cells[5:25, 5:45] = 0
    cells[5, :] = 100
    spec = GridSpec(0.05, 50, 30, Pose2(1.0, 2.0, 0.3))
    memory.load(cells, spec)
    assert memory.spec == spec
    loaded = memory.occupancy()
    assert (loaded == cells).all()
    memory.clear(SquareRegion(1.5, 2.8, 1.0))
    assert (memory.occupancy() == cells).all()
    memory.reset()
    assert (memory.occupancy() == cells).all()


def test_clearing_restores_the_loaded_map_after_growth() -> None:
    """Towards the loaded map's first row and column, whose places change."""
    memory = MapMemory(MapMemoryParams(growth_m=1.0, erase_range_m=50.0))
    loaded = np.full((20, 30), -1, np.int8)
    loaded[4:16, 6:24] = 0
    loaded[10, 6:24] = 100
    memory.load(loaded, GridSpec(0.1, 30, 20, Pose2(0.0, 0.0, 0.0)))
    free = np.zeros((40, 50), np.int8)
    spec = GridSpec(0.1, 50, 40, Pose2(-2.5, -2.4, 0.0))
    memory.fuse(PlacedCostmap(free, spec, (0.5, 0.5), Pose2(0.5, 0.5, 0.0), 0))
    assert memory.spec.origin.x == pytest.approx(-3.0)
    assert memory.spec.origin.y == pytest.approx(-3.0)
    seen = memory.occupancy()
    assert (seen[30:50, 30:60] != loaded).any()
    memory.clear(SquareRegion(0.0, 0.0, 20.0))
    expected = np.full(memory.spec.shape, -1, np.int8)
    expected[30:50, 30:60] = loaded
    np.testing.assert_array_equal(memory.occupancy(), expected)


def test_a_loaded_map_keeps_its_exact_geometry(robot: MappedRobot) -> None:
    """Messages round it: their resolution is a float32."""
    spec = GridSpec(1 / 30, 30, 20, Pose2(0.1, 0.2, 0.3))
    robot.node.load_map(np.zeros(spec.shape, np.int8), spec)
    assert robot.node._memory.spec == spec
