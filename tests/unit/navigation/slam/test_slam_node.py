"""The node ``slam``: map → odom, pose, status, map, saved maps."""

import gc
import math
import tracemalloc
from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pytest

from navette.errors import ParameterError
from navette.geometry import Pose2, Transform3, quaternion_from_rpy
from navette.geometry.map_files import read_occupancy_map
from navette.geometry.messages import header, transform_message
from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped
from navette.msgs.nav2_msgs.srv import SaveMap
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_srvs.srv import Empty as EmptySrv
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.slam.node import SlamNode
from navette.runtime import DurabilityPolicy, Parameter, QoSProfile
from navette.runtime.stage.path_messages import pose_message, pose_of
from navette.runtime.testing import GraphHarness, Probe
from slam_office import Step, drive, loop

STEPS = list(drive(seed=2, poses=loop(0.1)[:60]))
TF, ODOMETRY, SCAN = "/tf", "/odom/filtered", "/lidar"
UPRIGHT = Transform3((0.0, 0.0, 0.2), (0.0, 0.0, 0.0, 1.0))


def start(graph: GraphHarness, **values: Any) -> SlamNode:
    static = graph.node.create_publisher(
        TFMessage,
        "/tf_static",
        QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    )
    mount = values.pop("mount", UPRIGHT)
    static.publish(
        TFMessage(transforms=[transform_message(0, "base_link", "laser", mount)])
    )
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    return graph.add(SlamNode(context=graph.context, parameter_overrides=overrides))


def scan_message(step: Step, *, mirrored: bool = False) -> LaserScan:
    scan = step.scan
    ranges = scan.ranges
    if mirrored:  # the beams of a scanner upside down run clockwise
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        order = np.argsort(-angles)
        return LaserScan(
            header=header(step.stamp_ns, "laser"),
            angle_min=-float(angles[order[0]]),
            angle_increment=scan.angle_increment,
            range_min=scan.range_min,
            range_max=scan.range_max,
            ranges=ranges[order],
        )
    return LaserScan(
        header=header(step.stamp_ns, "laser"),
        angle_min=scan.angle_min,
        angle_increment=scan.angle_increment,
        range_min=scan.range_min,
        range_max=scan.range_max,
        ranges=ranges,
    )


def publish_step(
    graph: GraphHarness, step: Step, *, odometry: bool = True, **options: Any
) -> None:
    graph.publish(SCAN, scan_message(step, **options))
    if odometry:
        message = Odometry(
            header=header(step.stamp_ns, "odom"), child_frame_id="base_link"
        )
        message.pose.pose = pose_message(step.odom_T_base)
        graph.publish(ODOMETRY, message)


def feed(graph: GraphHarness, steps: list[Step], **options: Any) -> None:
    for step in steps:
        publish_step(graph, step, **options)
        graph.run_for(0.2)


def poses(probe: Probe) -> list[Pose2]:
    return [pose_of(each.pose.pose) for each in probe.messages]


def test_pose_transform_and_status_follow_each_scan() -> None:
    with GraphHarness() as graph:
        start(graph, start_x_m=1.5, start_y_m=1.5)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        transforms = graph.collect(TF, TFMessage)
        status = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
        )
        feed(graph, STEPS)
        assert found.count == transforms.count == len(STEPS)
        assert status.messages[0].message == "localizing"
        assert status.last.message == "localized"
        for step, pose, message in zip(
            STEPS, poses(found), transforms.messages, strict=True
        ):
            assert pose.distance_to(step.truth) < 0.03
            (transform,) = message.transforms
            assert transform.header.frame_id == "map"
            assert transform.child_frame_id == "odom"
            moved = transform.transform.translation
            q = transform.transform.rotation
            map_T_odom = Pose2(moved.x, moved.y, 2 * math.atan2(q.z, q.w))
            assert (map_T_odom @ step.odom_T_base).distance_to(pose) < 1e-9
        covariance = np.asarray(found.last.pose.covariance).reshape(6, 6)
        assert 0.0 < covariance[0, 0] < 0.01
        assert 0.0 < covariance[5, 5] < 0.01


def test_without_odometry_the_pose_is_published_a_little_later() -> None:
    with GraphHarness() as graph:
        start(graph, start_x_m=1.5, start_y_m=1.5, rate_hz=20.0)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        transforms = graph.collect(TF, TFMessage)
        feed(graph, STEPS[:30], odometry=False)
        assert found.count == 28
        assert transforms.count == 0
        assert poses(found)[-1].distance_to(STEPS[27].truth) < 0.05


def test_a_scanner_upside_down_sees_the_same() -> None:
    flipped = Transform3((0.0, 0.0, 0.2), quaternion_from_rpy(math.pi, 0.0, 0.0))
    with GraphHarness() as graph:
        start(graph, start_x_m=1.5, start_y_m=1.5, mount=flipped)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        feed(graph, STEPS, mirrored=True)
        assert poses(found)[-1].distance_to(STEPS[-1].truth) < 0.05


def test_a_tilted_scanner_and_an_unknown_frame_are_refused() -> None:
    tilted = Transform3((0.0, 0.0, 0.2), quaternion_from_rpy(0.0, 0.5, 0.0))
    with GraphHarness() as graph:
        node = start(graph, mount=tilted)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        feed(graph, STEPS[:3])
        assert found.count == 0
        assert node.dropped_inputs[SCAN, "not_planar"] == 3
    with GraphHarness() as graph:
        node = start(graph, base_frame="chassis")
        feed(graph, STEPS[:3])
        assert node.dropped_inputs[SCAN, "no_transform"] >= 1


def with_scan(step: Step, ranges: Any) -> Step:
    scan = replace(step.scan, ranges=np.asarray(ranges, np.float32))
    return step._replace(scan=scan)


def test_without_echoes_the_odometry_is_used_and_reported() -> None:
    with GraphHarness() as graph:
        start(graph, lost_scans=5)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        status = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
        )
        feed(graph, STEPS[:20])
        seen = found.last.pose.covariance[0]
        feed(graph, [with_scan(step, np.full(360, np.inf)) for step in STEPS[20:32]])
        assert status.last.message == "localized"
        assert status.last.level == b"\x01"
        values = {each.key: each.value for each in status.last.values}
        assert "odometry alone" in values["reason"]
        assert found.last.pose.covariance[0] > 3 * seen
        feed(graph, STEPS[32:36])
        assert status.last.level == b"\x00"
        assert not any(each.key == "reason" for each in status.last.values)
        assert {each.message for each in status.messages} == {
            "localizing",
            "localized",
        }


def test_a_robot_whose_scans_contradict_the_map_is_lost_until_they_match() -> None:
    with GraphHarness() as graph:
        start(graph, lost_scans=5)
        status = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
        )
        feed(graph, STEPS[:20])
        feed(graph, [with_scan(step, np.full(360, 0.8)) for step in STEPS[20:27]])
        assert status.last.message == "lost"
        assert status.last.level == b"\x02"
        values = {each.key: each.value for each in status.last.values}
        assert values["reason"]
        assert float(values["position_stddev_m"]) > 1.0
        feed(graph, STEPS[27:31])
        assert status.last.message == "localized"


def test_the_map_is_published_while_it_is_subscribed_to() -> None:
    with GraphHarness() as graph:
        start(graph, map_period_s=1.0)
        feed(graph, STEPS[:20])
        maps = graph.collect("/slam/map", "nav_msgs/msg/OccupancyGrid", latched=True)
        graph.run_for(1.5)
        first = maps.last
        assert first.header.frame_id == "map"
        assert set(np.unique(first.data)) == {-1, 0, 100}
        feed(graph, STEPS[20:])
        assert maps.count > 1
        known = [int((np.asarray(each.data) >= 0).sum()) for each in maps.messages]
        assert known == sorted(known)


def test_a_saved_map_is_continued(tmp_path: Path) -> None:
    with GraphHarness() as graph:
        start(graph, start_x_m=1.5, start_y_m=1.5)
        feed(graph, STEPS)
        request = SaveMap.Request(map_url=str(tmp_path / "office"))
        assert graph.call(SaveMap, "slam/save_map", request).result
        refused = SaveMap.Request(map_url=str(tmp_path / "no" / "office"))
        assert not graph.call(SaveMap, "slam/save_map", refused).result
    assert (read_occupancy_map(tmp_path / "office.yaml").cells == 100).any()
    known = str(tmp_path / "office.slam")
    for values in ({"start_x_m": 6.0, "start_y_m": 1.5}, {"searches_start": True}):
        with GraphHarness() as graph:
            node = start(graph, known_map=known, mode="localization", **values)
            found = graph.collect("/pose", PoseWithCovarianceStamped)
            feed(graph, STEPS[45:])
            assert poses(found)[-1].distance_to(STEPS[-1].truth) < 0.04
            keys = node.dropped_inputs
            assert not keys


def test_an_initial_pose_places_the_robot_in_a_known_map(tmp_path: Path) -> None:
    with GraphHarness() as graph:
        start(graph, start_x_m=1.5, start_y_m=1.5)
        feed(graph, STEPS)
        graph.call(
            SaveMap, "slam/save_map", SaveMap.Request(map_url=str(tmp_path / "office"))
        )
    with GraphHarness() as graph:
        known = str(tmp_path / "office.slam")
        start(graph, known_map=known, start_x_m=40.0, lost_scans=6)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        status = graph.collect(
            "/localization/status", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
        )
        feed(graph, STEPS[40:46])
        assert status.last.message == "lost"
        placed = PoseWithCovarianceStamped(header=header(0, "map"))
        placed.pose.pose = pose_message(STEPS[46].truth @ Pose2(0.1, -0.1, 0.1))
        graph.publish("/initialpose", placed)
        feed(graph, STEPS[46:])
        assert status.last.message == "localized"
        assert poses(found)[-1].distance_to(STEPS[-1].truth) < 0.04


def test_localization_needs_a_map() -> None:
    with GraphHarness() as graph, pytest.raises(ParameterError, match="known_map"):
        start(graph, mode="localization")


def test_after_a_restart_the_map_begins_at_the_start_again() -> None:
    with GraphHarness() as graph:
        start(graph, start_x_m=1.5, start_y_m=1.5, map_period_s=0.5)
        found = graph.collect("/pose", PoseWithCovarianceStamped)
        feed(graph, STEPS)
        assert poses(found)[-1].distance_to(STEPS[-1].truth) < 0.03
        maps = graph.collect("/slam/map", "nav_msgs/msg/OccupancyGrid", latched=True)
        graph.run_for(1.0)
        graph.call(EmptySrv, "slam/restart", EmptySrv.Request())
        before = found.count
        again = [
            step._replace(stamp_ns=STEPS[-1].stamp_ns + (index + 1) * 200_000_000)
            for index, step in enumerate(STEPS[:5])
        ]
        feed(graph, again)
        graph.run_for(1.0)
        assert found.count == before + 5
        assert poses(found)[before].distance_to(STEPS[0].truth) < 0.03
        first, last = (
            int((np.asarray(maps.messages[index].data) >= 0).sum()) for index in (0, -1)
        )
        assert last < first


def test_a_robot_that_stands_needs_no_more_memory() -> None:
    """The poses of all scans are kept for a recording's trajectory only."""
    with GraphHarness() as graph:
        start(graph)
        standing = [
            STEPS[0]._replace(stamp_ns=STEPS[0].stamp_ns + index * 200_000_000)
            for index in range(400)
        ]
        tracemalloc.start()
        traced = []
        for first in range(0, len(standing), 100):
            feed(graph, standing[first : first + 100])
            gc.collect()
            traced.append(tracemalloc.get_traced_memory()[0])
        tracemalloc.stop()
        # What is allocated once falls into one of the three; a leak is in each.
        assert min(np.diff(traced)) / 100 < 250, "bytes per scan"


class Interrupted(SlamNode):
    """Ends before its ``__init__`` does, as in a program that is stopped meanwhile."""

    def declare_params(self) -> NoReturn:
        raise RuntimeError("stopped")


def test_a_node_that_is_not_complete_can_be_destroyed() -> None:
    with GraphHarness() as graph:
        with pytest.raises(RuntimeError, match="stopped"):
            Interrupted(context=graph.context)
        [node] = [each for each in graph.context.nodes if isinstance(each, SlamNode)]
        node.destroy_node()
        assert node not in graph.context.nodes
