"""The simulated robot as a node: topics, frames, commands, contacts."""

import math
from collections import defaultdict
from dataclasses import dataclass, field, replace
from typing import Any

import pytest

from navette.errors import ParameterError
from navette.geometry import Pose2
from navette.msgs.ackermann_msgs.msg import AckermannDriveStamped
from navette.msgs.geometry_msgs.msg import Twist, TwistStamped, Vector3
from navette.msgs.std_msgs.msg import Bool, Empty
from navette.runtime import Context, Executor, Node, Parameter, VirtualClock
from navette.runtime.stage.odometry import PoseTracker
from navette.sim import Scene, World, load_robot, load_world
from navette.sim.node import SimNode

SECOND = 10**9


@dataclass
class Run:
    """A SimNode with subscriptions."""

    sim: SimNode
    ears: Node
    executor: Executor
    received: dict[str, list[Any]] = field(default_factory=lambda: defaultdict(list))

    def listen(self, *topics: str) -> None:
        for topic in topics:
            publisher = self.sim.publishers_by_topic[topic]
            self.ears.create_subscription(
                publisher.msg_type,
                topic,
                self.received[topic].append,
                publisher.qos_profile,
            )

    def drive(self, linear: float, angular: float) -> None:
        publisher = self.ears.create_publisher(Twist, "/cmd_vel", 10)
        command = Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))
        self.ears.create_timer(0.1, lambda: publisher.publish(command))

    def spin(self, seconds: float) -> None:
        self.executor.spin_for(round(seconds * SECOND))


def _run(
    scene: Scene | None = None,
    robot: str = "course",
    start: Pose2 | None = None,
    **parameters: object,
) -> Run:
    context = Context(clock=VirtualClock())
    context.init(args=[])
    known = load_robot(robot)
    assert known.params_file is not None
    context.overrides.add_file(known.params_file)
    context.overrides.add("sim", parameters, "test")
    scene = (scene or load_world("course")).with_robot(known.model)
    sim = SimNode(scene, start=start, context=context)
    ears = Node("ears", context=context)
    executor = Executor(context=context)
    executor.add_node(sim)
    executor.add_node(ears)
    return Run(sim, ears, executor)


def test_rates_and_stamps() -> None:
    run = _run(odometry_rate_hz=50.0, tf_rate_hz=50.0)
    run.listen("/lidar", "/odom/filtered", "/clock", "/tf", "/imu", "/ground_truth")
    run.spin(1.0)
    counts = {topic: len(messages) for topic, messages in run.received.items()}
    assert counts == {
        "/lidar": 10,
        "/odom/filtered": 50,
        "/clock": 100,
        "/tf": 50 + 10,
        "/imu": 100,
        "/ground_truth": 50,
    }
    stamp = run.received["/lidar"][0].header.stamp
    assert (stamp.sec, stamp.nanosec) == (0, 100_000_000)
    last = run.received["/clock"][-1].clock
    assert (last.sec, last.nanosec) == (1, 0)


def test_the_course_profile_has_the_public_frames() -> None:
    run = _run()
    run.listen("/odom/filtered", "/ground_truth", "/lidar", "/tf", "/tf_static")
    run.spin(0.2)
    odometry = run.received["/odom/filtered"][-1]
    assert odometry.header.frame_id == "sim_world"
    assert odometry.child_frame_id == "robot/chassis/lidar"
    assert odometry.pose.pose.position.x == pytest.approx(-6.0 + 1.3, abs=0.01)
    truth = run.received["/ground_truth"][-1]
    assert truth.child_frame_id == "robot"
    assert truth.pose.pose.position.x == pytest.approx(-6.0, abs=0.01)
    assert run.received["/lidar"][-1].header.frame_id == "robot/chassis/lidar"
    moving = {t.child_frame_id for m in run.received["/tf"] for t in m.transforms}
    assert moving == {
        "robot",
        "robot/left_wheel",
        "robot/right_wheel",
        "robot/caster",
    }
    (static,) = run.received["/tf_static"]
    parents = {t.child_frame_id: t.header.frame_id for t in static.transforms}
    assert parents["robot/chassis"] == "robot"
    assert parents["robot/chassis/lidar"] == "robot/chassis"
    optical = "robot/chassis/camera/optical"
    assert parents[optical] == "robot/chassis/camera"


def test_odometry_of_the_lidar_frame_gives_the_base_pose() -> None:
    """Checks the velocity of a point ahead of the axle, in its own frame."""
    run = _run(World().scene(), start=Pose2(0, 0, 0.4))
    run.listen("/odom/filtered")
    tracker = PoseTracker(run.ears, "robot", "sim_world")
    run.drive(0.4, 0.5)
    run.spin(3.0)
    last = run.received["/odom/filtered"][-1]
    assert last.twist.twist.linear.y == pytest.approx(0.5 * 1.3, abs=0.02)
    assert tracker.update(last)
    truth = run.sim.simulator.pose().to_pose2()
    assert tracker.latest == pytest.approx(truth, abs=1e-3)
    assert tracker.velocity == pytest.approx((0.4, 0.5), abs=0.01)


def test_other_robots_have_map_odom_and_base_link() -> None:
    run = _run(load_world("arena"), robot="turtlebot3_burger")
    run.listen("/odom/filtered", "/tf_static", "/lidar")
    run.spin(0.3)
    odometry = run.received["/odom/filtered"][-1]
    frames = odometry.header.frame_id, odometry.child_frame_id
    assert frames == ("odom", "base_footprint")
    (static,) = run.received["/tf_static"]
    parents = {t.child_frame_id: t.header.frame_id for t in static.transforms}
    assert parents["odom"] == "map"
    assert parents["base_link"] == "base_footprint"
    assert parents["base_scan"] == parents["imu_link"] == "base_link"
    assert run.received["/lidar"][-1].header.frame_id == "base_scan"


def test_the_burgers_scan_begins_ahead_and_its_joints_are_named() -> None:
    scene = World().add_box((1.0, 0.0), (0.2, 0.4)).add_box((0.0, 2.0), (0.4, 0.2))
    run = _run(scene.scene(), robot="burger", lidar_noise_m=0.0)
    run.listen("/lidar", "/joint_states")
    run.drive(0.2, 0.0)
    run.spin(1.0)
    scan = run.received["/lidar"][0]
    assert (len(scan.ranges), scan.angle_min) == (360, 0.0)
    assert scan.angle_max == pytest.approx(2 * math.pi, abs=1e-3)
    assert (scan.range_min, scan.range_max) == pytest.approx((0.12, 3.5))
    assert scan.ranges[0] == pytest.approx(0.9 + 0.032, abs=0.02)
    assert scan.ranges[90] == pytest.approx(1.9, abs=0.05)  # to the left
    assert math.isinf(scan.ranges[180])
    stamps = [msg.header.stamp.nanosec for msg in run.received["/lidar"][:2]]
    assert (stamps[1] - stamps[0]) % 10**9 == 200_000_000
    joints = run.received["/joint_states"][-1]
    assert joints.name == ["wheel_left_joint", "wheel_right_joint"]
    assert joints.velocity == pytest.approx([0.2 / 0.033] * 2, rel=0.05)


def test_camera_has_its_camera_info() -> None:
    run = _run()
    run.listen("/camera", "/camera_info")
    run.spin(0.11)
    image, info = run.received["/camera"][0], run.received["/camera_info"][0]
    assert (image.width, image.height, image.encoding) == (320, 240, "rgb8")
    assert len(image.data) == 320 * 240 * 3
    assert info.header == image.header
    assert info.k[0] == pytest.approx(160 / math.tan(1.047 / 2))
    assert image.header.frame_id == "robot/chassis/camera/optical"


def test_a_sensor_without_subscribers_is_never_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = _run()

    def fail(*_: object) -> None:
        raise AssertionError("read without a listener")

    for name in ("scan", "image", "imu"):
        monkeypatch.setattr(run.sim.simulator, name, fail)
    run.spin(0.5)
    assert run.sim.simulator.now_ns == SECOND // 2  # time advanced


def test_descriptions_reach_late_subscribers() -> None:
    run = _run()
    run.spin(1.0)
    run.listen("/robot_description", "/world_description", "/tf_static")
    run.spin(0.1)
    assert '<link name="robot/chassis">' in run.received["/robot_description"][0].data
    assert '<link name="sim_world">' in run.received["/world_description"][0].data
    assert run.received["/tf_static"]


def test_a_robot_without_a_lidar_is_logged(
    capfd: pytest.CaptureFixture[str],
) -> None:
    model = load_robot("jackal").model
    blind = tuple(replace(link, sensors=()) for link in model.links)
    context = Context(clock=VirtualClock())
    context.init(args=[])
    SimNode(World().scene().with_robot(replace(model, links=blind)), context=context)
    assert "no laser scanner" in capfd.readouterr().err


def test_commands_drive_and_time_out() -> None:
    run = _run(World().scene())
    publisher = run.ears.create_publisher(Twist, "/cmd_vel", 10)
    publisher.publish(Twist(linear=Vector3(x=0.5)))
    run.spin(0.45)
    assert run.sim.simulator.motion().linear[0] == pytest.approx(0.5, abs=0.05)
    run.spin(1.0)
    assert abs(run.sim.simulator.motion().linear[0]) < 0.01


def test_both_types_of_command_drive() -> None:
    run = _run(World().scene())
    plain = run.ears.create_publisher(Twist, "/cmd_vel", 10)
    stamped = run.ears.create_publisher(TwistStamped, "/cmd_vel", 10)
    plain.publish(Twist(linear=Vector3(x=0.2)))
    run.spin(0.4)
    stamped.publish(TwistStamped(twist=Twist(linear=Vector3(x=0.4))))
    run.spin(0.4)
    assert run.sim.simulator.motion().linear[0] == pytest.approx(0.4, abs=0.02)


def test_the_emergency_stop_beats_every_command_until_its_release() -> None:
    run = _run(World().scene())
    run.listen("/emergency_stop/active")
    stop = run.ears.create_publisher(Bool, "/emergency_stop", 10)
    release = run.ears.create_publisher(Empty, "/emergency_stop/release", 10)
    run.drive(0.5, 0.0)
    run.spin(1.0)
    stop.publish(Bool(data=True))
    run.spin(0.5)
    assert abs(run.sim.simulator.motion().linear[0]) < 0.01
    stop.publish(Bool(data=False))  # not a release
    run.spin(2.0)
    assert abs(run.sim.simulator.motion().linear[0]) < 0.01
    release.publish(Empty())
    run.spin(1.0)
    assert run.sim.simulator.motion().linear[0] == pytest.approx(0.5, abs=0.02)
    states = [msg.data for msg in run.received["/emergency_stop/active"]]
    assert states == [False, True, False]


def test_bad_commands_are_refused_and_logged() -> None:
    run = _run(World().scene())
    logged: list[Any] = []
    from navette.msgs.rcl_interfaces.msg import Log

    run.ears.create_subscription(Log, "/rosout", logged.append, 10)
    publisher = run.ears.create_publisher(Twist, "/cmd_vel", 10)
    publisher.publish(Twist(linear=Vector3(x=math.nan)))
    run.spin(0.5)
    assert any("refused /cmd_vel" in record.msg for record in logged)
    assert abs(run.sim.simulator.motion().linear[0]) < 1e-3


def test_contacts_are_reported() -> None:
    run = _run(World().add_box((3.0, 0.0), (1.0, 4.0)).scene())
    run.listen("/contacts")
    run.drive(0.8, 0.0)
    run.spin(4.0)
    (message,) = run.received["/contacts"]
    (reported,) = message.status
    assert "robot/chassis touched box" in reported.message
    facts = {pair.key: pair.value for pair in reported.values}
    assert set(facts) >= {"part", "obstacle", "time_s", "frame"}
    assert facts["obstacle"] == "box_1"
    # The box begins 2.5 m ahead.
    assert float(facts["x_m"]) == pytest.approx(2.5, abs=0.02)
    assert abs(float(facts["y_m"])) < 0.55  # a corner of the chassis
    assert run.sim.simulator.contacts.count == 1

    # A later subscriber receives past contacts; after a reset there are none.
    run.received.clear()
    run.listen("/contacts")
    run.spin(0.1)
    (late,) = run.received["/contacts"]
    assert late == message
    run.sim.reset()
    run.spin(0.2)
    assert run.received["/contacts"][-1].status == []


def test_limits_change_while_running_and_frames_do_not() -> None:
    run = _run(World().scene())
    (limit,) = run.sim.set_parameters([Parameter("max_speed_mps", value=0.2)])
    assert limit.successful
    (frame,) = run.sim.set_parameters([Parameter("map_frame", value="other")])
    assert not frame.successful
    assert "start" in frame.reason
    run.drive(1.0, 0.0)
    run.spin(2.0)
    assert run.sim.simulator.motion().linear[0] == pytest.approx(0.2, abs=0.01)


def test_an_unknown_child_frame_lists_the_known() -> None:
    with pytest.raises(ParameterError, match="'nose' is not fixed"):
        _run(odometry_child_frame="nose")


def test_wheel_odometry_drifts() -> None:
    run = _run(
        World().scene(),
        robot="jackal",
        localization="odometry",
        wheel_noise_m=0.05,
        seed=3,
    )
    run.listen("/odom/filtered", "/ground_truth")
    run.drive(0.5, 0.4)
    run.spin(6.0)
    odometry, truth = (
        run.received["/odom/filtered"][-1],
        run.received["/ground_truth"][-1],
    )
    a, b = odometry.pose.pose.position, truth.pose.pose.position
    assert 0.01 < math.hypot(a.x - b.x, a.y - b.y) < 1.5
    assert odometry.twist.twist.linear.x == pytest.approx(0.5, abs=0.2)
    for stated in (odometry.pose.covariance, odometry.twist.covariance):
        assert (stated.reshape(6, 6).diagonal()[[0, 1, 5]] > 0).all()
    assert not truth.pose.covariance.any()


def test_the_same_run_twice_gives_the_same_messages() -> None:
    def record() -> list[Any]:
        run = _run(load_world("arena"), robot="jackal", seed=5, lidar_noise_m=0.01)
        run.listen("/lidar", "/odom/filtered", "/imu")
        run.drive(0.5, 0.2)
        run.spin(1.0)
        return [run.received[t] for t in ("/lidar", "/odom/filtered", "/imu")]

    assert record() == record()


def test_reset_restores_the_start() -> None:
    run = _run()
    run.drive(0.5, 0.0)
    run.spin(2.0)
    run.sim.reset()
    assert run.sim.simulator.pose().to_pose2() == pytest.approx(
        Pose2(-6, 0, 0), abs=0.01
    )
    run.listen("/odom/filtered")
    run.spin(0.1)
    stamp = run.received["/odom/filtered"][-1].header.stamp
    assert stamp.sec == 2  # the clock continues


def _drive(run: Run, speed: float, steering: float) -> None:
    publisher = run.ears.create_publisher(AckermannDriveStamped, "/drive", 10)
    msg = AckermannDriveStamped()
    msg.drive.speed, msg.drive.steering_angle = speed, steering
    run.ears.create_timer(0.1, lambda: publisher.publish(msg))


def test_drive_moves_a_steered_robot_and_an_emergency_stop_stops_it() -> None:
    run = _run(load_world("empty"), robot="racecar", start=Pose2(0, 0, 0))
    _drive(run, 0.8, 0.2)
    run.spin(1.0)
    motion = run.sim.simulator.motion()
    assert motion.linear[0] == pytest.approx(0.8, rel=0.03)
    assert motion.angular[2] == pytest.approx(0.8 * math.tan(0.2) / 0.3302, rel=0.05)
    stop = run.ears.create_publisher(Bool, "/emergency_stop", 10)
    stop.publish(Bool(data=True))
    run.spin(0.5)
    assert abs(run.sim.simulator.motion().linear[0]) < 0.02


def test_drive_is_refused_by_a_robot_without_steering(
    capsys: pytest.CaptureFixture[str],
) -> None:
    run = _run(load_world("empty"), robot="jackal", start=Pose2(0, 0, 0))
    _drive(run, 0.8, 0.2)
    run.spin(1.0)
    assert "refused /drive: no_steering" in capsys.readouterr().err
    assert abs(run.sim.simulator.motion().linear[0]) < 0.01


def test_a_twist_to_the_left_moves_a_mecanum_platform_sideways() -> None:
    run = _run(load_world("empty"), robot="mecanum", start=Pose2(0, 0, 0))
    publisher = run.ears.create_publisher(Twist, "/cmd_vel", 10)
    command = Twist(linear=Vector3(y=0.5))
    run.ears.create_timer(0.1, lambda: publisher.publish(command))
    run.spin(1.0)
    assert run.sim.simulator.motion().linear[1] == pytest.approx(0.5, abs=0.02)
