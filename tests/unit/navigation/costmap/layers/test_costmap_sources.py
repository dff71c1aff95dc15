"""The costmap node with sources of an obstacle layer."""

import math

import numpy as np
import pytest

from navette.errors import ParameterError
from navette.geometry.messages import header
from navette.msgs.geometry_msgs.msg import (
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from navette.msgs.irobot_create_msgs.msg import HazardDetection, HazardDetectionVector
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import LaserScan, PointCloud2, Range
from navette.msgs.std_msgs.msg import Header
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.costmap.node import CostmapNode
from navette.navigation.grids import grid_from_message
from navette.navigation.grids.hit_points import points_from_message
from navette.ros2.packages.sensor_msgs_py.point_cloud2 import create_cloud_xyz32
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness, Probe

STAMP = 100_000_000


def started(graph: GraphHarness, **values: object) -> tuple[CostmapNode, Probe]:
    """A node with a cloud, a range finder and a bumper as sources."""
    prefix = "obstacle_layer"
    given: dict[str, object] = {
        f"{prefix}.observation_sources": "camera sonar bumper",
        f"{prefix}.camera.topic": "/cloud",
        f"{prefix}.sonar.topic": "/sonar",
        f"{prefix}.sonar.data_type": "Range",
        f"{prefix}.bumper.topic": "/hazard_detection",
        f"{prefix}.bumper.data_type": "HazardDetectionVector",
        "map_frame": "odom",
        **{name.replace("__", "."): value for name, value in values.items()},
    }
    overrides = [Parameter(name, value=value) for name, value in given.items()]
    node = graph.add(CostmapNode(context=graph.context, parameter_overrides=overrides))
    half = math.sqrt(0.5)
    mounts = {
        "lidar": ((0.2, 0.0, 0.2), Quaternion(w=1.0)),
        # Looks straight ahead: z ahead, x to the right (REP 103).
        "optical": ((0.2, 0.0, 0.8), Quaternion(x=-0.5, y=0.5, z=-0.5, w=0.5)),
        "left": ((0.0, 0.2, 0.2), Quaternion(z=half, w=half)),
        "bump_front": ((0.3, 0.0, 0.1), Quaternion(w=1.0)),
    }
    transforms = [
        TransformStamped(
            header=Header(frame_id="base_link"),
            child_frame_id=name,
            transform=Transform(translation=Vector3(x=x, y=y, z=z), rotation=rotation),
        )
        for name, ((x, y, z), rotation) in mounts.items()
    ]
    graph.publish("/tf_static", TFMessage(transforms=transforms), latched=True)
    return node, graph.collect("/costmap", "nav_msgs/msg/OccupancyGrid")


def odometry(x: float = 0.0, stamp_ns: int = STAMP) -> Odometry:
    msg = Odometry(header=header(stamp_ns, "odom"), child_frame_id="base_link")
    msg.pose.pose.position.x = x
    msg.pose.pose.orientation.w = 1.0
    return msg


def cloud(*points: tuple[float, float, float], frame: str = "optical") -> PointCloud2:
    return create_cloud_xyz32(header(STAMP, frame), list(points))


def scan(stamp_ns: int = STAMP) -> LaserScan:
    """Nothing within range."""
    return LaserScan(
        header=header(stamp_ns, "lidar"),
        angle_min=-3.0,
        angle_increment=0.01,
        range_min=0.1,
        range_max=10.0,
        ranges=np.full(600, np.inf, np.float32),
    )


def lethal_at(msg: object, x: float, y: float) -> bool:
    """Whether a place in the base frame is lethal; the lidar is 0.2 m ahead."""
    cells, spec = grid_from_message(msg)
    return bool(cells[spec.cell_of(x - 0.2, y)] == 100)


def test_a_cloud_marks_the_costmap_and_its_points() -> None:
    with GraphHarness() as graph:
        node, costmaps = started(graph)
        points = graph.collect("/costmap/points", "sensor_msgs/msg/PointCloud2")
        graph.run_for(0.1)
        graph.publish("/odom/filtered", odometry())
        # In the optical frame: 1.5 m ahead, 0.3 m to the right, 0.3 m below the lens.
        graph.publish("/cloud", cloud((0.3, 0.3, 1.5)))
        graph.publish("/lidar", scan())
        graph.run_for(0.1)
        assert not node.dropped_inputs
        assert lethal_at(costmaps.last, 1.7, -0.3)
        [hit] = points_from_message(points.last)
        assert hit == pytest.approx((1.5, -0.3), abs=0.03)


def test_what_was_seen_stays_at_its_place_while_the_robot_moves() -> None:
    with GraphHarness() as graph:
        _, costmaps = started(graph)
        graph.run_for(0.1)
        graph.publish("/odom/filtered", odometry())
        graph.publish("/cloud", cloud((0.0, 0.3, 1.5)))
        graph.run_for(0.1)
        graph.publish("/odom/filtered", odometry(1.0, 2 * STAMP))
        graph.publish("/lidar", scan(2 * STAMP))
        graph.run_for(0.1)
        assert lethal_at(costmaps.last, 0.7, 0.0)


def test_a_range_and_a_contact_mark_the_costmap() -> None:
    with GraphHarness() as graph:
        node, costmaps = started(graph)
        graph.run_for(0.1)
        graph.publish("/odom/filtered", odometry())
        for _ in range(8):
            graph.publish(
                "/sonar",
                Range(
                    header=header(STAMP, "left"),
                    min_range=0.02,
                    max_range=4.0,
                    field_of_view=0.3,
                    range=0.8,
                ),
            )
        bump = HazardDetection(
            header=header(STAMP, "bump_front"), type=HazardDetection.BUMP
        )
        graph.publish(
            "/hazard_detection",
            HazardDetectionVector(header=header(STAMP, "base_link"), detections=[bump]),
        )
        graph.publish("/lidar", scan())
        graph.run_for(0.1)
        assert not node.dropped_inputs
        assert lethal_at(costmaps.last, 0.0, 1.0)
        assert lethal_at(costmaps.last, 0.36, 0.0)


@pytest.mark.parametrize(
    ("msg", "reason"),
    [
        (cloud((0.0, 0.0, 1.0), frame="nowhere"), "unknown_frame"),
        (
            create_cloud_xyz32(header(60 * 10**9, "optical"), [(0.0, 0.3, 1.5)]),
            "unknown_pose",
        ),
        (
            PointCloud2(header=header(STAMP, "optical"), width=9, height=1),
            "invalid_cloud",
        ),
    ],
)
def test_unusable_observations_are_dropped_by_name(
    msg: PointCloud2, reason: str
) -> None:
    with GraphHarness() as graph:
        node, costmaps = started(graph)
        graph.run_for(0.1)
        graph.publish("/odom/filtered", odometry())
        graph.publish("/odom/filtered", odometry(0.0, 2 * STAMP))
        graph.publish("/cloud", msg)
        graph.publish("/lidar", scan())
        graph.run_for(0.1)
        assert ("/cloud", reason) in node.dropped_inputs
        cells, _ = grid_from_message(costmaps.last)
        assert not (cells == 100).any()


def test_without_a_required_source_there_is_no_costmap() -> None:
    with GraphHarness() as graph:
        _, costmaps = started(graph, obstacle_layer__camera__expected_update_rate=0.5)
        graph.publish_every(0.1, "/odom/filtered", lambda ns: odometry(0.0, ns))
        graph.publish_every(0.1, "/lidar", scan)
        graph.run_for(0.4)
        assert costmaps.count
        graph.run_for(1.0)
        count = costmaps.count
        graph.run_for(1.0)
        assert costmaps.count == count
        late = create_cloud_xyz32(header(graph.now_ns, "optical"), [(0.0, 0.3, 1.5)])
        graph.publish("/cloud", late)
        graph.run_for(0.3)
        assert costmaps.count > count


def test_a_source_needs_a_topic() -> None:
    with GraphHarness() as graph:
        name = "obstacle_layer.observation_sources"
        with pytest.raises(ParameterError, match=r"obstacle_layer\.eye\.topic"):
            CostmapNode(
                context=graph.context,
                parameter_overrides=[Parameter(name, value="eye")],
            )


def test_without_sources_nothing_is_subscribed_to_but_the_scan() -> None:
    with GraphHarness() as graph:
        node = graph.add(CostmapNode(context=graph.context))
        topics = {each.topic_name for each in node.subscriptions}
        assert topics == {"/lidar"} | {t for t in topics if "parameter" in t}
