import math

import numpy as np
import pytest

from navette.errors import ParameterError
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearEntireCostmap,
    GetCost,
    GetCostmap,
)
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import Header
from navette.navigation.costmap.node import CostmapNode
from navette.navigation.grids import grid_from_message
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness, Probe


def scan(ranges, stamp_ns: int = 0, **values) -> LaserScan:
    stamp = Time(sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
    fields = {
        "angle_min": -0.1,
        "angle_increment": 0.01,
        "range_min": 0.1,
        "range_max": 20.0,
    }
    return LaserScan(
        header=Header(stamp=stamp, frame_id="lidar"),
        ranges=np.asarray(ranges, np.float32),
        **(fields | values),
    )


def started(graph: GraphHarness, **values) -> tuple[CostmapNode, Probe]:
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = CostmapNode(context=graph.context, parameter_overrides=overrides)
    return graph.add(node), graph.collect("/costmap", "nav_msgs/msg/OccupancyGrid")


def test_one_costmap_for_each_scan_in_its_frame_and_with_its_stamp() -> None:
    with GraphHarness() as graph:
        _, costmaps = started(graph)
        graph.run_for(0.1)
        assert costmaps.count == 0
        for stamp_ns in (50_000_000, 1_250_000_000):
            graph.publish("/lidar", scan([3.0] * 21, stamp_ns))
        graph.run_for(0.1)
        assert costmaps.count == 2
        msg = costmaps.last
        assert msg.header.frame_id == "lidar"
        assert (msg.header.stamp.sec, msg.header.stamp.nanosec) == (1, 250_000_000)
        cells, spec = grid_from_message(msg)
        assert (spec.width, spec.resolution) == (301, 0.1)
        assert cells[150, 150] == 0
        assert cells[spec.cell_of(3.0, 0.0)] == 100
        assert cells[spec.cell_of(3.5, 0.0)] == -1


def test_parameters_apply_to_the_next_scan() -> None:
    with GraphHarness() as graph:
        node, costmaps = started(graph, resolution_m=0.05, size_m=10.0)
        graph.publish("/lidar", scan([3.0] * 21))
        graph.run_for(0.1)
        assert costmaps.last.info.width == 201
        node.set_parameters([Parameter("size_m", value=4.0)])
        graph.publish("/lidar", scan([3.0] * 21))
        graph.run_for(0.1)
        assert costmaps.last.info.width == 81


@pytest.mark.parametrize(("rate_hz", "used"), [(20.0, 9), (0.0, 20)])
def test_scans_are_used_at_most_at_a_rate_that_may_change(rate_hz, used) -> None:
    with GraphHarness() as graph:
        node, costmaps = started(graph, rate_hz=10.0)
        node.set_parameters([Parameter("rate_hz", value=rate_hz)])
        for k in range(20):  # 50 a second
            graph.publish("/lidar", scan([3.0] * 21, k * 20_000_000))
            graph.run_for(0.02)
        assert costmaps.count == used


def test_wrong_parameters_are_refused() -> None:
    with GraphHarness() as graph:
        with pytest.raises(ParameterError, match="inflation_method"):
            started(graph, inflation_method="cubic")
        node, _ = started(graph)
        results = node.set_parameters([Parameter("size_m", value=1000.0)])
        assert not results[0].successful
        assert node.params.size_m == 30.0


def test_an_invalid_scan_gives_no_costmap_and_the_next_one_works() -> None:
    with GraphHarness() as graph:
        _, costmaps = started(graph)
        graph.publish("/lidar", LaserScan())
        graph.publish("/lidar", scan([1.0], range_max=math.nan))
        graph.run_for(0.1)
        assert costmaps.count == 0
        graph.publish("/lidar", scan([]))  # nothing measured: the robot must not drive
        graph.publish("/lidar", scan([math.nan, math.inf, -1.0, 3.0]))
        graph.run_for(0.1)
        assert costmaps.count == 1


def test_nav2s_local_costmap_is_the_newest_one() -> None:
    with GraphHarness() as graph:
        _, costmaps = started(graph)
        empty = graph.call(
            GetCostmap, "/local_costmap/get_costmap", GetCostmap.Request()
        )
        assert empty.map.metadata.size_x == 0
        local = graph.collect("/local_costmap/costmap", OccupancyGrid, latched=True)
        graph.run_for(0.1)
        graph.publish("/lidar", scan([3.0] * 21))
        graph.run_for(0.1)
        assert local.last == costmaps.last
        found = graph.call(
            GetCostmap, "/local_costmap/get_costmap", GetCostmap.Request()
        )
        assert found.map.header.frame_id == "lidar"
        data = np.asarray(found.map.data).reshape(301, 301)
        assert (data == 254).sum() == (np.asarray(costmaps.last.data) == 100).sum() > 0
        point = GetCost.Request(x=3.0, y=0.0)
        cost = graph.call(GetCost, "/local_costmap/get_cost_local_costmap", point)
        assert cost.cost == 254.0


def test_nav2s_local_costmap_is_cleared_until_the_next_scan() -> None:
    with GraphHarness() as graph:
        _, costmaps = started(graph)
        local = graph.collect("/local_costmap/costmap", OccupancyGrid, latched=True)
        graph.run_for(0.1)
        graph.publish("/lidar", scan([3.0] * 21))
        graph.run_for(0.1)
        whole = np.asarray(local.last.data).reshape(301, 301)
        near = ClearCostmapAroundPose.Request(reset_distance=0.2)
        near.pose.header.frame_id = "lidar"
        near.pose.pose.position.x = 3.0
        near.pose.pose.orientation.w = 1.0
        name = "/local_costmap/clear_around_pose_local_costmap"
        graph.call(ClearCostmapAroundPose, name, near)
        graph.run_for(0.1)
        part = np.asarray(local.last.data).reshape(301, 301)
        assert 0 < (part == 100).sum() < (whole == 100).sum()
        name = "/local_costmap/clear_entirely_local_costmap"
        graph.call(ClearEntireCostmap, name, ClearEntireCostmap.Request())
        found = graph.call(
            GetCostmap, "/local_costmap/get_costmap", GetCostmap.Request()
        )
        assert not np.any(found.map.data)
        assert costmaps.count == 1  # the robot's own collision check is unaffected
        graph.publish("/lidar", scan([3.0] * 21))
        graph.run_for(0.1)
        assert np.array_equal(np.asarray(local.last.data).reshape(301, 301), whole)
