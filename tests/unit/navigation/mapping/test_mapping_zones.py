import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.geometry.map_files import OccupancyMap, write_occupancy_map
from navette.msgs.nav2_msgs.msg import CostmapFilterInfo, SpeedLimit
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.navigation.grids import CellWindow, GridSpec, grid_from_message
from navette.navigation.grids.zones import KeepOutZones
from navette.navigation.mapping.zones import FilterMask
from navette.navigation.mapping.zones.node import ZonesNode
from navette.runtime import DurabilityPolicy, Parameter, QoSProfile
from navette.runtime.testing import GraphHarness

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness() as harness:
        yield harness


def mask_file(folder: Path, cells: np.ndarray, mode: str = "trinary") -> str:
    """Write a mask of 1 m cells whose corner is at (-5, -5)."""
    known = OccupancyMap(cells.astype(np.int8), 1.0, Pose2(-5.0, -5.0, 0.0))
    image = "png" if mode == "scale" else "pgm"
    written = write_occupancy_map(folder / "mask", known, mode=mode, image_format=image)
    return str(written)


def odometry(x: float, second: int) -> Odometry:
    message = Odometry(child_frame_id="base_link")
    message.header.frame_id = "map"
    message.header.stamp.sec = second
    message.pose.pose.position.x = x
    return message


def test_values_of_a_mask_are_scaled() -> None:
    cells = np.array([[0, 70, -1]], np.int8)
    mask = FilterMask(cells, GridSpec(1.0, 3, 1), 100.0, -1.0)
    assert mask.value_at(0.5, 0.5) == 100.0
    assert mask.value_at(1.5, 0.5) == 30.0
    assert mask.value_at(2.5, 0.5) is None
    assert mask.value_at(9.0, 0.5) is None
    keep = FilterMask(np.array([[0, 99, -1, 50]], np.int8), GridSpec(1.0, 4, 1), 7.0)
    assert keep.keep_out(99).tolist() == [[0, 100, 0, 0]]
    assert keep.keep_out(50).tolist() == [[0, 100, 0, 100]]


def test_zones_lie_on_other_grids() -> None:
    """A turned mask of coarse cells on a map of fine ones."""
    spec = GridSpec(1.0, 2, 1, Pose2(1.0, 0.0, math.pi / 2))
    zones = KeepOutZones(np.array([[0, 100]], np.int8), spec)
    fine = GridSpec(0.5, 6, 6, Pose2(-0.5, 0.0, 0.0))
    marked = np.zeros(fine.shape, np.int8)
    zones.mark(marked, fine, CellWindow.whole(fine.shape))
    rows, columns = np.nonzero(marked)
    # The zone covers x from 0 to 1 and y from 1 to 2.
    assert sorted(set(rows.tolist())) == [2, 3]
    assert sorted(set(columns.tolist())) == [1, 2]


def test_files_become_filters_and_limits(graph: GraphHarness, tmp_path: Path) -> None:
    cells = np.zeros((10, 10))
    cells[:, 5:] = 60
    parameters = [Parameter("speed_file", value=mask_file(tmp_path, cells, "scale"))]
    graph.add(ZonesNode(context=graph.context, parameter_overrides=parameters))
    limits: list[SpeedLimit] = []
    infos: list[CostmapFilterInfo] = []
    graph.node.create_subscription(SpeedLimit, "/speed_limit", limits.append, 10)
    graph.node.create_subscription(
        CostmapFilterInfo, "/speed_costmap_filter_info", infos.append, LATCHED
    )
    publisher = graph.node.create_publisher(Odometry, "/odom/filtered", 10)
    for second, x in enumerate((-2.0, 2.0, 2.5, -2.0), 1):
        graph.run_for(0.1)
        publisher.publish(odometry(x, second))
    graph.run_for(0.1)
    assert [each.speed_limit for each in limits] == pytest.approx([40.0, 0.0], abs=0.5)
    assert all(each.percentage for each in limits)
    assert infos[0].filter_mask_topic == "/speed_filter_mask"
    assert (infos[0].type, infos[0].base, infos[0].multiplier) == (1, 100.0, -1.0)


def test_masks_of_other_nodes_are_used(graph: GraphHarness, tmp_path: Path) -> None:
    graph.add(ZonesNode(context=graph.context))
    zones: list[OccupancyGrid] = []
    graph.node.create_subscription(
        OccupancyGrid, "/keepout_zones", zones.append, LATCHED
    )
    mask = graph.node.create_publisher(OccupancyGrid, "/my_mask", LATCHED)
    info = graph.node.create_publisher(
        CostmapFilterInfo, "/keepout_costmap_filter_info", LATCHED
    )
    grid = OccupancyGrid()
    grid.header.frame_id = "map"
    grid.info.resolution, grid.info.width, grid.info.height = 1.0, 2, 1
    grid.data = np.array([100, 0], np.int8)
    mask.publish(grid)
    for multiplier in (1.0, 0.0):  # the scale does not count for type 0
        info.publish(
            CostmapFilterInfo(filter_mask_topic="/my_mask", multiplier=multiplier)
        )
        graph.run_for(0.2)
        assert grid_from_message(zones[-1])[0].tolist() == [[100, 0]]
    assert len(zones) == 2


@pytest.mark.parametrize(
    ("kind", "base", "multiplier", "limits"),
    [
        (1, 100.0, -1.0, [40.0, 0.0, 1.0, 0.0]),
        (2, 0.0, 0.01, [0.6, 0.0, 0.99, 0.0]),
        (2, 1.0, -0.01, [0.4, 0.0, 0.01, 0.0]),
        (1, 0.0, 0.0, [0.01, 0.0, 0.01, 0.0]),  # 0 would be no limit
    ],
)
def test_speed_limits_by_type_and_scale(
    graph: GraphHarness,
    kind: int,
    base: float,
    multiplier: float,
    limits: list[float],
) -> None:
    """A cell of 0 has no limit, as in Nav2; neither has a place outside the mask."""
    graph.add(ZonesNode(context=graph.context))
    found: list[SpeedLimit] = []
    graph.node.create_subscription(SpeedLimit, "/speed_limit", found.append, 10)
    mask = graph.node.create_publisher(OccupancyGrid, "/my_mask", LATCHED)
    info = graph.node.create_publisher(
        CostmapFilterInfo, "/speed_costmap_filter_info", LATCHED
    )
    grid = OccupancyGrid()
    grid.header.frame_id = "map"
    grid.info.resolution, grid.info.width, grid.info.height = 1.0, 3, 1
    grid.info.origin.position.y = -0.5
    grid.data = np.array([60, 0, 99], np.int8)
    mask.publish(grid)
    info.publish(
        CostmapFilterInfo(
            type=kind, filter_mask_topic="/my_mask", base=base, multiplier=multiplier
        )
    )
    publisher = graph.node.create_publisher(Odometry, "/odom/filtered", 10)
    for second, x in enumerate((0.5, 1.5, 2.5, 9.0), 1):
        graph.run_for(0.1)
        publisher.publish(odometry(x, second))
    graph.run_for(0.1)
    assert [each.speed_limit for each in found] == pytest.approx(limits, rel=1e-5)
    assert {each.percentage for each in found} == {kind == 1}


def test_a_limit_of_the_same_value_in_another_unit_is_published(
    graph: GraphHarness,
) -> None:
    """1 % of the speed becomes 1 m/s, during a drive."""
    graph.add(ZonesNode(context=graph.context))
    found: list[SpeedLimit] = []
    graph.node.create_subscription(SpeedLimit, "/speed_limit", found.append, 10)
    mask = graph.node.create_publisher(OccupancyGrid, "/my_mask", LATCHED)
    info = graph.node.create_publisher(
        CostmapFilterInfo, "/speed_costmap_filter_info", LATCHED
    )
    grid = OccupancyGrid()
    grid.header.frame_id = "map"
    grid.info.resolution, grid.info.width, grid.info.height = 1.0, 1, 1
    grid.data = np.array([1], np.int8)
    mask.publish(grid)
    publisher = graph.node.create_publisher(Odometry, "/odom/filtered", 10)
    for kind in (1, 2):
        info.publish(
            CostmapFilterInfo(type=kind, filter_mask_topic="/my_mask", multiplier=1.0)
        )
        graph.run_for(0.1)
        publisher.publish(odometry(0.5, kind))
        graph.run_for(0.1)
    limits = [(each.percentage, each.speed_limit) for each in found]
    assert limits == [(True, 1.0), (False, 1.0)]


@pytest.mark.parametrize("topic", ["", "not a name", "/odom/filtered"])
def test_a_mask_on_an_unusable_topic_is_dropped(
    topic: str, graph: GraphHarness, capsys: pytest.CaptureFixture[str]
) -> None:
    """The topic is empty, not a name, or has messages of another type."""
    graph.add(ZonesNode(context=graph.context))
    info = graph.node.create_publisher(
        CostmapFilterInfo, "/keepout_costmap_filter_info", LATCHED
    )
    info.publish(CostmapFilterInfo(filter_mask_topic=topic, multiplier=1.0))
    graph.run_for(0.1)
    assert "filter_mask_topic" in capsys.readouterr().err
