import math

import numpy as np
import pytest

from navette.errors import ParameterError
from navette.geometry import Pose2, quaternion_from_rpy
from navette.msgs.geometry_msgs.msg import (
    Point,
    Pose,
    PoseWithCovariance,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.grids import (
    GridSpec,
    grid_from_message,
    grid_to_message,
    window_from_message,
)
from navette.navigation.mapping.node import MapMemoryNode
from navette.runtime import Parameter, ns_to_stamp
from navette.runtime.testing import GraphHarness, Probe

SPEC = GridSpec(0.1, 61, 61, Pose2(-3.05, -3.05, 0.0))
AHEAD = 1.3  # of the sensor before the base, m
MS = 1_000_000


def odometry(
    x: float,
    yaw: float,
    stamp_ns: int,
    *,
    yaw_rate: float = 0.0,
    fall: float = 0.0,
    roll: float = 0.0,
) -> Odometry:
    qx, qy, qz, qw = quaternion_from_rpy(roll, 0.0, yaw)
    pose = Pose(
        position=Point(x=x, y=0.0), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)
    )
    return Odometry(
        header=Header(stamp=ns_to_stamp(stamp_ns), frame_id="map"),
        child_frame_id="base_link",
        pose=PoseWithCovariance(pose=pose),
        twist=TwistWithCovariance(
            twist=Twist(linear=Vector3(z=-fall), angular=Vector3(z=yaw_rate))
        ),
    )


def free() -> np.ndarray:
    return np.zeros(SPEC.shape, np.int8)


def with_post(ahead: float, left: float) -> np.ndarray:
    cells = free()
    cells[SPEC.cell_of(ahead, left)] = 100
    return cells


class Rig:
    """A map memory, its transforms, and what it publishes."""

    def __init__(self, graph: GraphHarness, **values) -> None:
        values = {"size_m": 20.0} | values
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        self.graph = graph
        self.node = graph.add(
            MapMemoryNode(context=graph.context, parameter_overrides=overrides)
        )
        self.maps: Probe = graph.collect(
            "/map", "nav_msgs/msg/OccupancyGrid", latched=True
        )
        mount = TransformStamped(
            header=Header(frame_id="base_link"),
            child_frame_id="lidar",
            transform=Transform(
                translation=Vector3(x=AHEAD), rotation=Quaternion(w=1.0)
            ),
        )
        graph.publish("/tf_static", TFMessage(transforms=[mount]), latched=True)
        graph.run_for(0.001)

    def odometry(self, x: float, yaw: float, stamp_ns: int, **values) -> None:
        self.graph.publish("/odom/filtered", odometry(x, yaw, stamp_ns, **values))

    def costmap(self, cells: np.ndarray, stamp_ns: int, frame: str = "lidar") -> None:
        self.graph.publish("/costmap", grid_to_message(cells, SPEC, frame, stamp_ns))

    def run_ms(self, milliseconds: float) -> None:
        self.graph.run_for(milliseconds / 1e3)

    def cell(self, x: float, y: float) -> int:
        cells, spec = grid_from_message(self.maps.last)
        return int(cells[spec.cell_of(x, y)])

    def lethal(self) -> list[tuple[float, float]]:
        cells, spec = grid_from_message(self.maps.last)
        return [spec.center_of(*cell) for cell in np.argwhere(cells == 100)]


def test_a_map_is_published_at_the_start_also_for_late_subscribers() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph, map_frame="world")
        rig.run_ms(500)
        late = graph.collect("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
        rig.run_ms(10)
        assert rig.maps.count == late.count == 1
        assert late.last.header.frame_id == "world"
        cells, spec = grid_from_message(late.last)
        assert (cells == -1).all()
        assert spec.shape == (200, 200)


def test_a_robot_that_leaves_the_largest_map_is_reported_once(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with GraphHarness() as graph:
        rig = Rig(graph, max_size_m=20.0)
        reports = []
        for step, x in enumerate((0.0, 30.0, 31.0, 3.0, 40.0)):
            rig.odometry(x, 0.0, step * 2000 * MS)
            rig.costmap(with_post(1.0, 0.5), step * 2000 * MS)
            rig.run_ms(2000)
            reports.append(capsys.readouterr().err.count("outside of the map"))
        assert reports == [0, 1, 0, 0, 1]


def test_an_empty_first_scan_does_not_become_the_map() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(0.0, 0.0, 0)
        rig.costmap(np.full(SPEC.shape, -1, np.int8), 0)
        rig.run_ms(20)
        assert rig.maps.count == 1
        rig.odometry(0.0, 0.0, 20 * MS)
        rig.costmap(with_post(1.0, 0.5), 20 * MS)
        rig.run_ms(20)
        assert rig.maps.count == 2
        assert rig.maps.last.header.stamp == ns_to_stamp(20 * MS)


def test_cells_are_placed_at_the_measured_positions() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(2.0, math.pi / 2, 0)
        rig.costmap(with_post(1.0, 0.5), 0)
        rig.run_ms(20)
        (post,) = rig.lethal()
        assert post == pytest.approx((2.0 - 0.5, AHEAD + 1.0), abs=0.11)
        assert rig.cell(2.0, AHEAD) == 0
        assert rig.cell(-4.0, 0.0) == -1


def test_a_costmap_is_placed_with_the_pose_at_its_stamp() -> None:
    """Stale odometry would leave phantom cells."""
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(0.0, 0.0, 0)
        rig.costmap(with_post(1.0, 0.0), 50 * MS)
        rig.run_ms(20)
        assert rig.maps.count == 1
        rig.odometry(1.0, 0.0, 100 * MS)
        rig.run_ms(20)
        assert rig.maps.count == 2
        (post,) = rig.lethal()
        assert post == pytest.approx((0.5 + AHEAD + 1.0, 0.0), abs=0.11)


def test_without_odometry_costmaps_are_dropped() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph, pose_wait_s=0.3)
        rig.costmap(with_post(1.0, 0.0), 50 * MS)
        rig.run_ms(400)
        rig.odometry(0.0, 0.0, 40 * MS)
        rig.odometry(0.0, 0.0, 60 * MS)
        rig.run_ms(100)
        assert rig.maps.count == 1


def test_a_costmap_in_an_unknown_frame_is_dropped() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(0.0, 0.0, 0)
        rig.costmap(with_post(1.0, 0.0), 0, frame="radar")
        rig.run_ms(20)
        assert rig.maps.count == 1


def test_odometry_with_huge_coordinates_is_ignored() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(1e300, 0.0, 0)
        rig.costmap(with_post(1.0, 0.0), 0)
        rig.run_ms(20)
        assert rig.maps.count == 1


def test_a_stationary_robot_publishes_no_new_map() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        for k in range(30):
            rig.odometry(0.0, 0.0, 100 * k * MS)
            rig.costmap(with_post(1.0, 0.0), 100 * k * MS)
            rig.run_ms(100)
        assert rig.maps.count == 2


def test_a_new_obstacle_is_fused_while_the_robot_is_stationary() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        appears_ms = 1500
        for k in range(30):
            cells = free()
            if 100 * k >= appears_ms:
                cells[25:35, 45] = 100
            rig.odometry(0.0, 0.0, 100 * k * MS)
            rig.costmap(cells, 100 * k * MS)
            rig.run_ms(100)
        assert rig.maps.count == 3
        assert len(rig.lethal()) == 10
        assert rig.maps.last.header.stamp == ns_to_stamp(appears_ms * MS)


@pytest.mark.parametrize("yaw_rate", [0.6, 3.0])
def test_turning_in_place_fuses_unless_too_fast(yaw_rate) -> None:
    with GraphHarness() as graph:
        rig = Rig(graph, fuse_on_change=False)
        rig.odometry(0.0, 0.0, 0)
        rig.costmap(free(), 0)
        rig.run_ms(10)
        for k in range(1, 31):
            rig.odometry(0.0, k * 0.1 * yaw_rate, 100 * k * MS, yaw_rate=yaw_rate)
            rig.costmap(free(), 100 * k * MS)
            rig.run_ms(100)
        assert rig.maps.count == 2 + (3 if yaw_rate == 0.6 else 0)


def test_moving_fuses_on_the_timer() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph, fuse_on_change=False)
        for k in range(61):
            rig.odometry(0.1 * k, 0.0, 100 * k * MS)
            rig.costmap(free(), 100 * k * MS)
            rig.run_ms(100)
        # First one, then every second tick of the timer: 2 m.
        assert rig.maps.count == 2 + 3


@pytest.mark.parametrize("motion", [{"fall": 3.0}, {"roll": -0.3}])
def test_scans_while_falling_are_not_fused(motion) -> None:
    """The course robot spawns at 1 m: its first scans pass over every obstacle."""
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(0.0, 0.0, 0, **motion)
        rig.costmap(free(), 0)
        rig.run_ms(20)
        assert rig.maps.count == 1
        rig.odometry(0.0, 0.0, 100 * MS)
        rig.costmap(with_post(1.0, 0.0), 100 * MS)
        rig.run_ms(20)
        assert rig.maps.count == 2


def test_a_jump_back_in_time_resets_the_map() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(0.0, 0.0, 5000 * MS)
        rig.costmap(with_post(1.0, 0.0), 5000 * MS)
        rig.run_ms(20)
        rig.odometry(0.0, 0.0, 100 * MS)
        rig.costmap(with_post(2.0, 0.0), 100 * MS)
        rig.run_ms(20)
        (post,) = rig.lethal()
        assert post == pytest.approx((AHEAD + 2.0, 0.0), abs=0.11)


def test_only_shape_parameters_reset_the_map() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph)
        rig.odometry(0.0, 0.0, 0)
        rig.costmap(with_post(1.0, 0.0), 0)
        rig.run_ms(20)
        rig.node.set_parameters(
            [
                Parameter("update_distance_m", value=0.2),
                Parameter("update_period_s", value=0.5),
            ]
        )
        rig.run_ms(20)
        assert rig.maps.count == 2
        rig.node.set_parameters([Parameter("fusion", value="log_odds")])
        rig.run_ms(20)
        assert rig.maps.count == 3
        assert not rig.lethal()
        rig.costmap(with_post(1.0, 0.0), 0)
        rig.run_ms(20)
        assert len(rig.lethal()) == 1


def test_wrong_parameters_are_refused() -> None:
    with GraphHarness() as graph, pytest.raises(ParameterError, match="fusion"):
        Rig(graph, fusion="mean")


def updates(rig: Rig, topic: str = "/map_updates") -> Probe:
    return rig.graph.collect(topic, "map_msgs/msg/OccupancyGridUpdate")


def drive(rig: Rig, steps: int) -> None:
    for step in range(steps):
        stamp_ns = (step * 200 + 50) * MS
        rig.odometry(0.5 * step, 0.1 * step, stamp_ns)
        rig.costmap(with_post(1.0, 0.1 * step), stamp_ns)
        rig.run_ms(200)


@pytest.mark.parametrize("fusion", ["overwrite", "max", "log_odds"])
def test_updates_applied_to_an_older_map_give_the_newest(fusion: str) -> None:
    with GraphHarness() as graph:
        rig = Rig(graph, update_distance_m=0.1, update_period_s=0.1, fusion=fusion)
        parts = updates(rig)
        others = updates(rig, "/global_costmap/costmap_updates")
        rig.run_ms(10)
        cells, spec = grid_from_message(rig.maps.last)
        cells = cells.copy()
        drive(rig, 8)
        whole, after = grid_from_message(rig.maps.last)
        assert after == spec
        assert rig.maps.count - 1 == parts.count == others.count >= 5
        for part in parts.messages:
            new, window = window_from_message(part, spec)
            cells[window.slices] = new
            assert new.size < 0.5 * cells.size
        np.testing.assert_array_equal(cells, whole)
        assert parts.last.header == rig.maps.last.header


def test_a_late_reader_under_nav2s_name_gets_the_newest_map() -> None:
    """Until the first one nothing is kept under it; then every map is published."""
    name, kind = "/global_costmap/costmap", "nav_msgs/msg/OccupancyGrid"
    with GraphHarness() as graph:
        rig = Rig(graph, update_distance_m=0.1, update_period_s=0.1)
        drive(rig, 4)
        rig.run_ms(500)
        first = graph.collect(name, kind, latched=True)
        rig.run_ms(10)
        assert first.count == 0
        rig.run_ms(100)
        assert first.messages == [rig.maps.last]
        drive(rig, 4)
        second = graph.collect(name, kind, latched=True)
        rig.run_ms(10)
        assert second.messages == [rig.maps.last]


def test_a_map_that_grows_is_published_whole_only() -> None:
    with GraphHarness() as graph:
        rig = Rig(graph, size_m=2.0, growth_m=2.0)
        parts = updates(rig)
        rig.run_ms(10)
        rig.odometry(0.0, 0.0, 50 * MS)
        rig.costmap(with_post(1.0, 0.5), 50 * MS)
        rig.run_ms(50)
        assert rig.maps.count == 2
        assert parts.count == 1
        assert parts.last.header == rig.maps.last.header
        assert (parts.last.width, parts.last.height) == (0, 0)


def test_whole_maps_are_published_to_new_subscribers_only() -> None:
    with GraphHarness() as graph:
        rig = Rig(
            graph,
            update_distance_m=0.1,
            update_period_s=0.1,
            always_send_full_map=False,
        )
        parts = updates(rig)
        rig.run_ms(10)
        before = rig.maps.count
        drive(rig, 8)
        # Once whole, to the subscription that is newer than the first map.
        assert rig.maps.count == before + 1
        assert parts.count >= 5
        late = graph.collect("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
        rig.run_ms(1500)
        assert late.last.header == parts.last.header
        assert rig.maps.count == before + 2
        assert len(rig.lethal()) == 1
