# SPDX-License-Identifier: Apache-2.0
"""The simulated robot as a node."""

from collections.abc import Callable
from functools import partial
from typing import Any

from navette.errors import InvalidInputError, ParameterError
from navette.geometry import Pose2, Transform3
from navette.geometry.messages import time_message, transform_message
from navette.msgs import get_interface, topics
from navette.msgs.ackermann_msgs.msg import AckermannDriveStamped
from navette.msgs.geometry_msgs.msg import Twist, TwistStamped
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.std_msgs.msg import Bool, Empty, String
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.runtime import (
    Input,
    Output,
    PacedClock,
    StageNode,
    Timer,
    VirtualClock,
)
from navette.sim import messages
from navette.sim.description import describe_robot, describe_world
from navette.sim.frames import RobotFrames
from navette.sim.params import CONTROL_PERIOD_S, FIXED_AT_START, SimParams
from navette.sim.robot_state import Motion
from navette.sim.run_control import RunControl
from navette.sim.scene import Scene
from navette.sim.sensor_messages import hazards_message
from navette.sim.sensor_outputs import output_of
from navette.sim.sensor_specs import ContactSensor, GnssSensor, LidarSensor, Sensor
from navette.sim.sensor_topics import SensorTopic, sensors_of, topics_of
from navette.sim.simulator import Simulator
from navette.sim.wheel_odometry import PlanarCovariances

_ACTORS_HZ = 20.0
_NEW_MAP = "/slam/restart"
_SETTLE_S = 0.3  # after a reset, until scans are placed by the new estimate
_HEARTBEAT_S = 0.1  # steps physics and reports contacts without any subscriber


class SimNode(StageNode):
    """One robot in one world: subscribes to commands, publishes sensors and truth.

    Physics advances when a message with a subscriber, a command or the periodic step is
    due. A message is created only while its topic has a subscriber. Before the first
    command the robot does not move (it may fall to the floor).

    Args:
        scene: the world with the robot in it.
        start: initial pose; None takes the pose in the scene.
    """

    PARAMS = SimParams
    FIXED_AT_START = FIXED_AT_START
    INPUTS = (
        Input.of(
            topics.CMD_VEL,
            "commanded velocity; clamped to the limits, zero after the timeout",
            other_types=("geometry_msgs/msg/TwistStamped",),
            callback="on_cmd_vel",
        ),
        Input.of(
            topics.DRIVE,
            "speed and steering angle of an Ackermann drive, beside /cmd_vel",
            callback="on_drive",
        ),
        Input.of(
            topics.EMERGENCY_STOP,
            "true stops the robot, whatever is commanded",
            callback="on_emergency_stop",
        ),
        Input.of(
            topics.EMERGENCY_STOP_RELEASE,
            "releases the stop: the robot follows commands again",
            callback="on_release",
        ),
    )
    OUTPUTS = (
        Output.of(topics.CLOCK, "time", rate_hz=100.0),
        Output.of(topics.LIDAR, "scan", rate_hz=10),
        Output.of(topics.IMU, "orientation, turn rate, specific force"),
        Output.of(topics.CAMERA, "image", rate_hz=30),
        Output.of(topics.CAMERA_INFO, "intrinsics of the camera", rate_hz=30),
        Output.of(topics.DEPTH_IMAGE, "depth camera: metres, 32FC1", rate_hz=10),
        Output.of(topics.DEPTH_INFO, "intrinsics of the depth camera", rate_hz=10),
        Output.of(topics.DEPTH_POINTS, "a point for each pixel", rate_hz=10),
        Output.of(topics.POINTS, "lidar with several rings", rate_hz=10),
        Output.of(topics.SONAR, "range of the nearest echo", rate_hz=10),
        Output.of(topics.HAZARDS, "the bumpers that are pressed", rate_hz=50),
        Output.of(topics.FIX, "position on the Earth"),
        Output.of(topics.ODOMETRY, "estimated pose and velocity", rate_hz=50),
        Output.of(
            topics.WHEEL_ODOMETRY,
            "dead reckoning by the wheels, for a filter",
            rate_hz=50,
        ),
        Output.of(
            topics.GROUND_TRUTH,
            "true pose of the axle midpoint in the world frame",
            rate_hz=50,
        ),
        Output.of(topics.TF, "moving frames", rate_hz=50),
        Output.of(topics.TF_STATIC, "fixed frames"),
        Output.of(topics.JOINT_STATES, "angles and speeds of the wheels", rate_hz=10),
        Output.of(topics.CONTACTS, "contacts with obstacles since the start"),
        Output.of(
            topics.ACTORS, "moving models of the world, as they stand", rate_hz=20
        ),
        Output.of(topics.EMERGENCY_STOP_ACTIVE, "whether the robot is stopped"),
        Output.of(topics.CANCEL_GOAL, "after a reset by a service"),
        Output.of(topics.INITIAL_POSE, "the start, after a reset by a service"),
        Output.of(topics.ROBOT_DESCRIPTION, "URDF of the robot"),
        Output.of(topics.WORLD_DESCRIPTION, "URDF of the world"),
    )

    _forget_graph: Callable[[], None] | None = None  # also if construction failed

    def __init__(
        self,
        scene: Scene,
        *,
        start: Pose2 | None = None,
        node_name: str = "sim",
        **kwargs: Any,
    ) -> None:
        super().__init__(node_name, **kwargs)
        self.simulator = Simulator(scene, self.params, start=start)
        for lidar in self.simulator.lidars:
            lidar.warm_up()
        self._sensor_topics = tuple(topics_of(self.simulator.compiled.robot.model))
        #: The newest reading of each sensor: its topics share one.
        self._readings: dict[tuple[type[Sensor], int], tuple[int, Any]] = {}
        if topics.LIDAR.name not in {each.name for each in self._sensor_topics}:
            self.get_logger().warning(
                "the robot has no laser scanner: without /lidar there is no costmap "
                "and navigation does not drive the robot"
            )
        if (
            "gnss" in self.params.fused_sensors
            and not self.simulator.devices[GnssSensor]
        ):
            raise ParameterError(
                f"parameter 'localization': {self.params.localization!r}; the robot "
                "has no GNSS receiver (a sensor of type navsat)"
            )
        self._origin_ns = self.get_clock().now_ns
        self.frames = RobotFrames(self.simulator.compiled.robot, self.params)
        p = self.params
        self._child_frame = p.odometry_child_frame or p.base_frame
        self._base_T_child = self.frames.fixed_pose(self._child_frame)
        self._contacts_reported = 0
        self._is_stopped = False
        self._sleepers: list[tuple[Timer, tuple[str, ...]]] = []
        self._publish_latched()
        self._create_timers()
        self._serve_run_control()
        self._forget_graph = self.context.graph.on_change(self._wake_and_rest)
        self._wake_and_rest()

    def destroy_node(self) -> None:
        if self._forget_graph is not None:
            self._forget_graph()
        super().destroy_node()

    def reset(self) -> None:
        """Reset robot and world to the start; the clock continues."""
        self.simulator.reset()
        self._readings.clear()
        self._origin_ns = self.get_clock().now_ns
        if self._contacts_reported:
            self._publish_contacts()

    def _start_again(self) -> None:
        """Reset, and leave no part of the run before: goal, pose estimate, maps.

        SLAM begins a new map; other nodes that locate the robot get an initial pose.
        """
        self.reset()
        self.publish(topics.CANCEL_GOAL.name, Empty())
        self._call("std_srvs/srv/Empty", _NEW_MAP)
        if self.params.locator != "slam":
            estimate = messages.estimate_of(self._truth(self.stamp_ns))
            self.publish(topics.INITIAL_POSE.name, estimate)

        def clear() -> None:
            self.destroy_timer(timer)
            self._call("nav2_msgs/srv/ClearEntireCostmap")

        timer = self.create_timer(_SETTLE_S, clear)

    def _call(self, kind: str, only: str = "") -> None:
        """Call the services of a type; nothing waits for the responses."""
        service: Any = get_interface(kind)
        for name, types in self.get_service_names_and_types():
            if kind in types and only in ("", name):
                client = self.create_client(service, name)
                done = client.call_async(service.Request())
                done.add_done_callback(partial(_destroy, self, client))

    def on_cmd_vel(self, msg: Twist | TwistStamped) -> None:
        """Apply a command; an invalid one is dropped and the last one stays."""
        self._advance()
        if self._is_stopped:
            return
        twist = msg.twist if isinstance(msg, TwistStamped) else msg
        self.simulator.command(twist.linear.x, twist.angular.z, twist.linear.y)

    def on_drive(self, msg: AckermannDriveStamped) -> None:
        """Apply speed and steering angle; an invalid command is dropped."""
        if not self.simulator.has_steering:
            raise InvalidInputError(
                "no_steering",
                f"{topics.DRIVE.name} is for robots with steered wheels; use "
                f"{topics.CMD_VEL.name}",
            )
        self._advance()
        if not self._is_stopped:
            self.simulator.steer(msg.drive.speed, msg.drive.steering_angle)

    def on_emergency_stop(self, msg: Bool) -> None:
        """Stop and ignore commands until the release."""
        if msg.data:
            self._advance()
            self.simulator.command(0.0, 0.0)
            self._set_stopped(stopped=True)

    def on_release(self, msg: Empty) -> None:
        """Obey the commands that arrive from now on."""
        self._set_stopped(stopped=False)

    def _set_stopped(self, *, stopped: bool) -> None:
        if stopped != self._is_stopped:
            self._is_stopped = stopped
            self.publish(topics.EMERGENCY_STOP_ACTIVE.name, Bool(data=stopped))

    def on_params_changed(self, old: SimParams) -> None:
        self.simulator.change_params(self.params)

    @property
    def stamp_ns(self) -> int:
        """Stamp of the simulator's state."""
        return self._origin_ns + self.simulator.now_ns

    def _advance(self) -> int:
        """Advance physics to the current time; return the stamp of its state."""
        self.simulator.advance_to(self._clock.now_ns - self._origin_ns)
        return self.stamp_ns

    # Outputs

    def _publish_latched(self) -> None:
        p, stamp = self.params, self._origin_ns
        transforms = [
            transform_message(stamp, f.parent, f.name, f.parent_T_frame)
            for f in self.frames.fixed
        ]
        if p.odometry_frame != p.map_frame and not p.is_corrected:
            origin = Transform3.identity()
            transforms.append(
                transform_message(stamp, p.map_frame, p.odometry_frame, origin)
            )
        self.publish(topics.TF_STATIC.name, TFMessage(transforms=transforms))
        compiled = self.simulator.compiled
        robot = describe_robot(compiled, self.frames)
        self.publish(topics.EMERGENCY_STOP_ACTIVE.name, Bool(data=False))
        self.publish(topics.ROBOT_DESCRIPTION.name, String(data=robot))
        world = describe_world(compiled, p.map_frame)
        self.publish(topics.WORLD_DESCRIPTION.name, String(data=world))

    def _create_timers(self) -> None:
        p = self.params
        self.create_timer(_HEARTBEAT_S, self._beat)
        self._every(p.clock_rate_hz, self._publish_clock, topics.CLOCK.name)
        rate_hz, wheels = p.odometry_rate_hz, topics.WHEEL_ODOMETRY.name
        self._every(rate_hz, self._publish_wheels, wheels)
        if not p.filters_odometry:
            self._every(rate_hz, self._publish_odometry, topics.ODOMETRY.name)
            self._every(p.tf_rate_hz, self._publish_base_tf, topics.TF.name)
        self._every(rate_hz, self._publish_truth, topics.GROUND_TRUTH.name)
        joints = topics.JOINT_STATES.name
        self._every(p.joint_tf_rate_hz, self._publish_joints, joints)
        if self.simulator.actors:
            self._every(_ACTORS_HZ, self._publish_actors, topics.ACTORS.name)
        if self.frames.moving:
            self._every(p.joint_tf_rate_hz, self._publish_joint_tf, topics.TF.name)
        for topic in self._sensor_topics:
            self._add_publisher(topic)
            frame = self.frames.of_sensor(topic.link, topic.sensor)
            publish = partial(self._publish_sensor, topic, frame)
            self._every(topic.sensor.rate_hz, publish, topic.name)
        bumpers = self.simulator.devices[ContactSensor]
        if bumpers:
            rate_hz = max(each.sensor.rate_hz for each in bumpers)
            self._every(rate_hz, self._publish_bumpers, topics.HAZARDS.name)

    def _serve_run_control(self) -> None:
        clock = self.context.clock
        control = RunControl(
            clock if isinstance(clock, VirtualClock) else None,
            clock if isinstance(clock, PacedClock) else None,
            round(1e9 * CONTROL_PERIOD_S),
            reset=self._start_again,
        )
        for name, (kind, serve) in control.services.items():
            self.create_service(kind, f"~/{name}", serve)

    def _every(
        self, rate_hz: float, publish: Callable[[int], None], *names: str
    ) -> None:
        """Call ``publish(stamp)`` at a rate while the topic has a subscriber."""

        def tick() -> None:
            publish(self._advance())

        timer = self.create_timer(1.0 / rate_hz, tick, autostart=False)
        self._sleepers.append((timer, names))

    def _wake_and_rest(self) -> None:
        """Run the timers of the topics that have a subscriber, and no others."""
        for timer, names in self._sleepers:
            wanted = any(map(self.has_listeners, names))
            if wanted and timer.is_canceled():
                timer.reset()
            elif not wanted and not timer.is_canceled():
                timer.cancel()

    def _add_publisher(self, topic: SensorTopic) -> None:
        """Create the publisher of a further sensor of its kind."""
        if topic.name not in self.publishers_by_topic:
            like = self.publishers_by_topic[topic.stack.name]
            self.publishers_by_topic[topic.name] = self.create_publisher(
                like.msg_type, topic.name, like.qos_profile
            )

    def _publish_sensor(self, topic: SensorTopic, frame: str, stamp_ns: int) -> None:
        sensor, output = topic.sensor, output_of(topic)
        publisher = self.publishers_by_topic[topic.name]
        if isinstance(sensor, LidarSensor) and not publisher.is_used(stamp_ns):
            self.simulator.skip_scan(topic.index)
            return
        reading = None
        if output.needs_reading:
            reading = self._reading(type(sensor), topic.index, stamp_ns)
        # With the noise of the parameters, which the message states.
        used = self.simulator.devices[type(sensor)][topic.index].sensor
        self.hand_over(topic.name, output.message(reading, used, stamp_ns, frame))

    def _reading(self, kind: type[Sensor], index: int, stamp_ns: int) -> Any:
        """Measure, at most once at a time."""
        newest = self._readings.get((kind, index))
        if newest is None or newest[0] != stamp_ns:
            newest = stamp_ns, self.simulator.read(kind, index)
            self._readings[kind, index] = newest
        return newest[1]

    def _publish_bumpers(self, stamp_ns: int) -> None:
        model = self.simulator.compiled.robot.model
        states = [
            (
                self.frames.of_sensor(link, sensor),
                self._reading(ContactSensor, index, stamp_ns),
            )
            for index, (link, sensor) in enumerate(sensors_of(model, ContactSensor))
        ]
        message = hazards_message(states, stamp_ns, self.frames.base)
        self.publish(topics.HAZARDS.name, message)

    def _beat(self) -> None:
        self._advance()
        episodes = self.simulator.contacts.episodes
        for episode in episodes[self._contacts_reported :]:
            self.get_logger().warning(
                f"contact: {episode.part} touched {episode.obstacle}"
            )
        if len(episodes) != self._contacts_reported:
            self._publish_contacts()

    def _publish_contacts(self) -> None:
        episodes = self.simulator.contacts.episodes
        self._contacts_reported = len(episodes)
        message = messages.contacts_message(
            episodes, self.stamp_ns, self.params.map_frame
        )
        self.publish(topics.CONTACTS.name, message)

    def _publish_clock(self, stamp_ns: int) -> None:
        self.publish(topics.CLOCK.name, Clock(clock=time_message(stamp_ns)))

    def _publish_odometry(self, stamp_ns: int) -> None:
        if self.params.believes_truth:
            pose, motion = self.simulator.pose(), self.simulator.motion()
            message = self._odometry_message(stamp_ns, pose, motion, None)
        else:
            message = self._wheel_message(stamp_ns)
        self.hand_over(topics.ODOMETRY.name, message)

    def _publish_wheels(self, stamp_ns: int) -> None:
        self.hand_over(topics.WHEEL_ODOMETRY.name, self._wheel_message(stamp_ns))

    def _wheel_message(self, stamp_ns: int) -> Odometry:
        wheels = self.simulator.wheel_odometry()
        reported = wheels.motion()
        motion = Motion(
            (reported.speed, reported.side, 0.0), (0.0, 0.0, reported.yaw_rate)
        )
        covariances = PlanarCovariances(wheels.pose_covariance, reported.covariance)
        pose = Transform3.from_pose2(wheels.pose)
        return self._odometry_message(stamp_ns, pose, motion, covariances)

    def _odometry_message(
        self,
        stamp_ns: int,
        odom_T_base: Transform3,
        motion: Motion,
        covariances: PlanarCovariances | None,
    ) -> Odometry:
        return messages.odometry_message(
            stamp_ns,
            (self.params.odometry_frame, self._child_frame),
            odom_T_base,
            motion,
            self._base_T_child,
            covariances,
        )

    def _believed_pose(self) -> Transform3:
        if self.params.believes_truth:
            return self.simulator.pose()
        return Transform3.from_pose2(self.simulator.wheel_odometry().pose)

    def _publish_truth(self, stamp_ns: int) -> None:
        self.hand_over(topics.GROUND_TRUTH.name, self._truth(stamp_ns))

    def _truth(self, stamp_ns: int) -> Odometry:
        return messages.odometry_message(
            stamp_ns,
            (self.params.map_frame, self.params.base_frame),
            self.simulator.pose(),
            self.simulator.motion(),
            Transform3.identity(),
        )

    def _publish_base_tf(self, stamp_ns: int) -> None:
        p = self.params
        transform = transform_message(
            stamp_ns, p.odometry_frame, p.base_frame, self._believed_pose()
        )
        self.publish(topics.TF.name, TFMessage(transforms=[transform]))

    def _publish_joint_tf(self, stamp_ns: int) -> None:
        transforms = [
            transform_message(
                stamp_ns, self.frames.base, frame, self.simulator.link_in_base(link)
            )
            for link, frame in self.frames.moving.items()
        ]
        self.publish(topics.TF.name, TFMessage(transforms=transforms))

    def _publish_joints(self, stamp_ns: int) -> None:
        joints = self.simulator.state.wheel_joints()
        message = messages.joint_message(joints, stamp_ns)
        self.publish(topics.JOINT_STATES.name, message)

    def _publish_actors(self, stamp_ns: int) -> None:
        poses = self.simulator.actors.poses(self.simulator.now_ns)
        message = messages.actors_message(poses, stamp_ns, self.params.map_frame)
        self.publish(topics.ACTORS.name, message)


def _destroy(node: StageNode, client: Any, _response: object) -> None:
    node.destroy_client(client)
