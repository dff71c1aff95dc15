"""The sensors of a robot as topics: messages, frames, no work without subscribers."""

import math
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.irobot_create_msgs.msg import HazardDetection
from navette.ros2.packages.sensor_msgs_py.point_cloud2 import read_points
from navette.runtime import Context, Executor, Node, VirtualClock
from navette.sim import World, load_robot
from navette.sim.mounting import mount_of, with_sensors
from navette.sim.node import SimNode
from navette.sim.sensor_specs import LidarSensor, Sensor

ALL = ("d435", "vlp16", "os1_32", "hc_sr04", "hc_sr04@rear", "bumper", "neo_m8n")
# In one second; the sixth of 6 Hz comes at its end.
TOPICS = {
    "/depth/image": 5,
    "/depth/camera_info": 5,
    "/depth/points": 5,
    "/points": 10,
    "/points/os1_32": 10,
    "/sonar": 10,
    "/sonar/hc_sr04_rear": 10,
    "/hazard_detection": 50,
    "/fix": 5,
}


class Robot:
    """A Jackal with sensors in a world, and what was received from it."""

    def __init__(self, *sensors: str, world: World | None = None) -> None:
        context = Context(clock=VirtualClock())
        context.init(args=[])
        model = with_sensors(load_robot("jackal").model, map(mount_of, sensors))
        scene = (world or World().add_walls((6.0, 6.0))).scene().with_robot(model)
        self.sim = SimNode(scene, start=Pose2(0.0, 0.0, 0.0), context=context)
        self.node = Node("listener", context=context)
        self.executor = Executor(context=context)
        self.executor.add_node(self.sim)
        self.executor.add_node(self.node)
        self.received: dict[str, list[Any]] = {}
        self.reads: Counter[tuple[str, int]] = Counter()
        read = self.sim.simulator.read

        def counted(kind: type[Sensor], index: int = 0) -> Any:
            self.reads[kind.__name__, index] += 1
            return read(kind, index)

        self.sim.simulator.read = counted  # type: ignore[method-assign]

    def listen(self, *topics: str) -> None:
        for topic in topics:
            like = self.sim.publishers_by_topic[topic]
            found = self.received.setdefault(topic, [])
            self.node.create_subscription(
                like.msg_type, topic, found.append, like.qos_profile
            )

    def run(self, seconds: float) -> None:
        self.executor.spin_for(round(seconds * 1e9))


def test_every_sensor_publishes_at_its_rate() -> None:
    robot = Robot(*ALL)
    robot.listen(*TOPICS)
    robot.run(1.0)
    counts = {topic: len(found) for topic, found in robot.received.items()}
    assert counts == TOPICS


def test_a_sensor_without_a_subscriber_measures_nothing() -> None:
    robot = Robot(*ALL)
    robot.run(1.0)
    assert not robot.reads
    robot.listen("/sonar")
    robot.run(1.0)
    assert set(robot.reads) == {("SonarSensor", 0)}


def test_the_topics_of_a_sensor_share_one_measurement() -> None:
    robot = Robot("d435")
    robot.listen("/depth/image", "/depth/points", "/depth/camera_info")
    robot.run(1.0)
    assert robot.reads == {("DepthCameraSensor", 0): 5}
    image, cloud = (robot.received[f"/depth/{n}"][3] for n in ("image", "points"))
    assert image.header == cloud.header
    depths = np.asarray(image.data).view("<f4").reshape(image.height, image.width)
    z = read_points(cloud, ["z"])["z"].reshape(cloud.height, cloud.width)
    seen = np.isfinite(depths)
    assert np.array_equal(z[seen], depths[seen])
    assert np.isnan(z[~seen]).all()


def test_a_depth_image_and_its_cloud_agree_with_the_camera_info() -> None:
    robot = Robot("d435")
    robot.listen("/depth/image", "/depth/points", "/depth/camera_info", "/tf_static")
    robot.run(0.4)
    info = robot.received["/depth/camera_info"][0]
    cloud = robot.received["/depth/points"][0]
    image = robot.received["/depth/image"][0]
    assert (image.encoding, image.step) == ("32FC1", 4 * image.width)
    assert (cloud.height, cloud.width) == (120, 212)
    points = read_points(cloud, ["x", "y", "z"]).reshape(cloud.height, cloud.width)
    row, column = 90, 40
    x, y, z = (float(points[axis][row, column]) for axis in "xyz")
    # Pixel centres lie at half integers, as in the renderer.
    u = info.k[0] * x / z + info.k[2]
    v = info.k[4] * y / z + info.k[5]
    assert (u, v) == (pytest.approx(column + 0.5, abs=1e-3), pytest.approx(row + 0.5))
    frame = cloud.header.frame_id
    assert frame.endswith("d435/optical")
    names = {
        t.child_frame_id for m in robot.received["/tf_static"] for t in m.transforms
    }
    assert frame in names


def test_clouds_of_lidars_are_organized_where_the_driver_does_so() -> None:
    robot = Robot("vlp16", "os1_32")
    robot.listen("/points", "/points/os1_32")
    robot.run(0.4)
    velodyne, ouster = (found[0] for found in robot.received.values())
    names = ["x", "y", "z", "intensity", "ring"]
    assert [field.name for field in velodyne.fields] == names
    assert (ouster.height, ouster.width) == (32, 1024)
    assert velodyne.height == 1
    assert velodyne.is_dense
    points = read_points(velodyne)
    assert set(points["ring"].tolist()) <= set(range(16))
    elevation = np.arctan2(points["z"], np.hypot(points["x"], points["y"]))
    expected = np.linspace(-math.radians(15), math.radians(15), 16)[points["ring"]]
    assert np.abs(elevation - expected).max() < 1e-3


def test_a_robot_with_a_ring_lidar_alone_has_a_planar_scan(tmp_path: Path) -> None:
    file = tmp_path / "cart.yaml"
    file.write_text("lidar_beams: 2\nsensors: {vlp16: vlp16}\n", encoding="utf-8")
    model = load_robot(file).model
    links = []
    for link in model.links:
        kept = tuple(s for s in link.sensors if type(s) is not LidarSensor)
        links.append(replace(link, sensors=kept))
    scene = World().add_walls((6.0, 6.0)).scene()
    context = Context(clock=VirtualClock())
    context.init(args=[])
    scene = scene.with_robot(replace(model, links=tuple(links)))
    sim = SimNode(scene, start=Pose2(0, 0, 0), context=context)
    executor = Executor(context=context)
    executor.add_node(sim)
    node = Node("listener", context=context)
    executor.add_node(node)
    found: list[Any] = []
    node.create_subscription(
        sim.publishers_by_topic["/lidar"].msg_type, "/lidar", found.append, 10
    )
    executor.spin_for(200_000_000)
    assert len(found[0].ranges) == 1800
    assert found[0].ranges[900] == pytest.approx(3.0, abs=0.2)


def test_ranges_and_fixes() -> None:
    robot = Robot("hc_sr04", "neo_m8n")
    robot.listen("/sonar", "/fix/neo_m8n")  # the Jackal has a receiver
    robot.run(0.3)
    reading, fix = robot.received["/sonar"][0], robot.received["/fix/neo_m8n"][0]
    assert reading.radiation_type == reading.ULTRASOUND
    assert reading.field_of_view == pytest.approx(math.radians(15.0))
    assert reading.range == pytest.approx(2.75, abs=0.1)
    assert fix.status.status == fix.status.STATUS_FIX
    assert fix.position_covariance[0] == pytest.approx((2.5 / 1.1774) ** 2)
    assert abs(fix.latitude) < 1e-3


def test_pressed_bumpers_are_hazards_in_their_frames() -> None:
    robot = Robot("bumper", world=World().add_box((1.0, 0.0), (0.2, 6.0)))
    robot.listen("/hazard_detection", "/tf_static")
    publisher = robot.node.create_publisher(Twist, "/cmd_vel", 10)
    command = Twist()
    command.linear.x = 0.5
    robot.node.create_timer(0.1, lambda: publisher.publish(command))
    robot.run(3.0)
    first, last = (robot.received["/hazard_detection"][i] for i in (0, -1))
    assert list(first.detections) == []
    frames = {each.header.frame_id for each in last.detections}
    # A flat wall touches both ends of a flat front.
    assert frames == {"bump_front_left", "bump_front_right"}
    assert {each.type for each in last.detections} == {HazardDetection.BUMP}
    static = robot.received["/tf_static"][0].transforms
    place = next(t for t in static if t.child_frame_id == "bump_front_center")
    assert place.transform.translation.x > 0.2
