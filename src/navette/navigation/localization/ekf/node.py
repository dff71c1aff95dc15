"""The filter's node: odometry, IMU, GNSS in, pose estimate out.

Before the first measurement the node publishes nothing. Without measurements it
predicts for ``sensor_timeout_s``, then stops publishing until a measurement arrives, so
that the controller stops. The status is ``localized`` or ``lost``; navigation stops a
robot that is lost. Positions that contradict the estimate are not used; the filter
continues when they agree again, or from them when they show position and heading.
Stamps are those of the measurements and never decrease.
After a jump in the measurements' time (a bag that loops) the filter resets.
"""

import math
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from navette.errors import InvalidInputError, ParameterError, TransformError
from navette.geometry import Quaternion, Transform3, largest_stddev
from navette.geometry.messages import transform_message
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.localization.ekf.consistency import (
    ConsistencyMonitor,
    FilterState,
)
from navette.navigation.localization.ekf.filter import Estimate, Fused, PlanarEkf
from navette.navigation.localization.ekf.history import OrderedEkf
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.messages import (
    PLANAR_POSE,
    odometry_message,
    pose_of,
    transform_of,
)
from navette.navigation.localization.ekf.params import (
    FIXED_AT_START,
    SOURCES,
    EkfParams,
)
from navette.navigation.localization.ekf.realignment import Realignment
from navette.navigation.localization.ekf.sensors import (
    KINDS,
    FilterInput,
    ImuInput,
)
from navette.navigation.localization.ekf.state import (
    PLANAR,
    YAW,
    X,
    Y,
    is_covariance,
    planar_covariance,
)
from navette.runtime import (
    Buffer,
    Input,
    Output,
    StageNode,
    TransformListener,
    stamp_to_ns,
)
from navette.runtime.stage.path_messages import pose_of as pose_of_message
from navette.runtime.stage.status import StatusReporter, status_output

_WARNING_PERIOD_NS = 5_000_000_000
_LEVEL: Quaternion = (0.0, 0.0, 0.0, 1.0)
# Of an initial pose without variances; those of RViz.
_INITIAL_COVARIANCE = np.diag([0.25, 0.25, 0.0685])


def _input(source: str, type_name: str, role: str) -> Input:
    role = f"{role}; the parameter of that name sets the topic"
    return Input(
        topic=source,
        type=type_name,
        role=role,
        callback=f"on_{source}",
        checks_contents=False,  # only the fields that its configuration uses
    )


class EkfNode(StageNode):
    """Planar extended Kalman filter with robot_localization's parameters."""

    PARAMS = EkfParams
    FIXED_AT_START = FIXED_AT_START
    INPUTS: ClassVar = (
        _input("odom0", "nav_msgs/msg/Odometry", "wheel odometry"),
        _input("odom1", "nav_msgs/msg/Odometry", "other odometry"),
        _input("pose0", "geometry_msgs/msg/PoseWithCovarianceStamped", "pose"),
        _input("twist0", "geometry_msgs/msg/TwistWithCovarianceStamped", "velocity"),
        _input("imu0", "sensor_msgs/msg/Imu", "heading, turn rate, acceleration"),
        _input("gps0", "sensor_msgs/msg/NavSatFix", "position of the antenna"),
        Input.of(
            topics.INITIAL_POSE,
            "pose that replaces the estimate",
            callback="on_initial_pose",
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(
            topics.ODOMETRY,
            "estimated pose and velocity",
            rate_hz=30.0,
        ),
        Output.of(
            topics.TF,
            "the same",
            rate_hz=30.0,
        ),
        status_output(topics.LOCALIZATION_STATUS.name),
    )

    params: EkfParams
    _is_fresh: bool  # a measurement was used since the last publication
    _arrived_ns: int  # arrival of the last measurement
    _published_ns: int  # stamp of the last publication
    _is_paused: bool  # no measurements for the sensor timeout

    def __init__(self, node_name: str = "ekf", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._warned_ns: dict[str, int] = {}
        self._status = StatusReporter(self, topics.LOCALIZATION_STATUS.name)
        self._buffer = Buffer(node=self)
        # A filter in the map frame needs odom → base, which moves.
        self._listener = TransformListener(
            self._buffer,
            self,
            static_only=not self._is_on_map,
            on_invalid=self.drop_input,
        )
        self._start()
        self._filter.ekf.warm_up()
        self._timer = self.create_timer(1.0 / self.params.frequency_hz, self.on_timer)

    def inputs(self) -> tuple[Input, ...]:
        if not self.params.used:
            raise ParameterError(
                f"node {self.get_fully_qualified_name()}: no input; set the topic "
                f"of at least one of {', '.join(SOURCES)}"
            )
        sources = (
            replace(
                usual,
                topic=getattr(self.params, usual.topic),
                depth=getattr(self.params, f"{usual.topic}_queue_size"),
            )
            for usual in self.INPUTS
            if usual.topic in self.params.used
        )
        return *sources, self.INPUTS[-1]

    def on_odom0(self, msg: Any) -> None:
        self._take("odom0", msg)

    def on_odom1(self, msg: Any) -> None:
        self._take("odom1", msg)

    def on_pose0(self, msg: Any) -> None:
        self._take("pose0", msg)

    def on_twist0(self, msg: Any) -> None:
        self._take("twist0", msg)

    def on_imu0(self, msg: Any) -> None:
        self._take("imu0", msg)

    def on_gps0(self, msg: Any) -> None:
        self._take("gps0", msg)

    def on_initial_pose(self, msg: PoseWithCovarianceStamped) -> None:
        """Continue from a pose of a person or program."""
        params = self.params
        frame_id = msg.header.frame_id or params.world_frame
        is_of_map = frame_id == params.map_frame != params.world_frame
        if is_of_map and not params.publish_status:
            return  # for the node that publishes map → odom and the status
        try:
            world_T_frame = self.in_world(frame_id).to_pose2()
        except TransformError as error:
            text = f"initial pose not used: {error}"
            raise InvalidInputError("unknown_frame", text) from None
        pose = world_T_frame @ pose_of_message(msg.pose.pose)
        given = np.asarray(msg.pose.covariance).reshape(6, 6)[PLANAR_POSE]
        usable = is_covariance(given) and given.diagonal().all()
        self._filter.set_pose(pose, given if usable else _INITIAL_COVARIANCE)
        self._forget_contradictions()
        self.get_logger().info(
            f"initial pose: ({pose.x:.2f}, {pose.y:.2f}), heading {pose.yaw:.2f} rad"
        )

    def on_timer(self) -> None:
        """Publish the newest estimate, or a prediction from it."""
        newest_ns = self._filter.ekf.stamp_ns
        if newest_ns is None:
            return
        waited_ns = 0 if self._is_fresh else self._now_ns() - self._arrived_ns
        if waited_ns > round(self.params.sensor_timeout_s * 1e9):
            self._pause()
            return
        self._is_fresh = False
        estimate = self._filter.ekf.estimate_at(newest_ns + waited_ns)
        if estimate is not None and estimate.stamp_ns > self._published_ns:
            self._published_ns = estimate.stamp_ns
            self._publish(estimate)
            self._judge(estimate)

    def on_params_changed(self, old: EkfParams) -> None:
        """Apply a new rate at once; reset for any other change."""
        if self.params.frequency_hz != old.frequency_hz:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(
                1.0 / self.params.frequency_hz, self.on_timer
            )
        if replace(self.params, frequency_hz=old.frequency_hz) != old:
            self._start()

    def base_in(self, child: str) -> Transform3:
        """Return child_T_base of a frame fixed to the robot."""
        return self._lookup(child, self.params.base_link_frame)

    def in_world(self, frame: str) -> Transform3:
        """Return world_T_frame of a frame in which poses are given."""
        return self._lookup(self.params.world_frame, frame)

    @property
    def _is_on_map(self) -> bool:
        params = self.params
        return params.world_frame == params.map_frame != params.odom_frame

    @property
    def _attitude(self) -> Quaternion:
        """Measured orientation of the base; level without an IMU."""
        imu = self._sensors.get("imu0")
        return imu.attitude if isinstance(imu, ImuInput) else _LEVEL

    def _start(self) -> None:
        params = self.params
        noise, initial = (
            planar_covariance(getattr(params, name), name)
            for name in ("process_noise_covariance", "initial_estimate_covariance")
        )
        known = frozenset({X, Y, YAW}) if params.initial_pose_is_known else frozenset()
        self._filter = OrderedEkf(
            PlanarEkf(
                noise,
                initial,
                np.array(params.initial_state)[PLANAR],
                known,
                scales_noise=params.dynamic_process_noise_covariance,
            ),
            round(params.history_length_s * 1e9),
            round(params.max_gap_s * 1e9),
        )
        limit_m = params.lost_stddev_m if params.measures_position else math.inf
        self._consistency = ConsistencyMonitor(round(params.lost_time_s * 1e9), limit_m)
        self._realignment = Realignment()
        self._sensors: dict[str, FilterInput] = {
            source: KINDS[source](source, params, self) for source in params.used
        }
        self._reset()

    def _reset(self) -> None:
        self._filter.reset()
        self._forget_contradictions()
        for sensor in self._sensors.values():
            sensor.reset()
        self._is_fresh = False
        self._arrived_ns = 0
        self._published_ns = -1
        self._is_paused = False

    def _take(self, source: str, msg: Any) -> None:
        stamp_ns = stamp_to_ns(msg.header.stamp)
        if self._filter.is_new_run(source, stamp_ns):
            self.get_logger().info(
                f"{source}: time jumped to {stamp_ns / 1e9:.3f} s, the filter resets"
            )
            self._reset()
        try:
            # The sensors check their results.
            with np.errstate(all="ignore"):
                for measurement in self._sensors[source].measurements(msg, stamp_ns):
                    self._use(measurement)
        except InvalidInputError as error:
            raise InvalidInputError(
                error.reason, f"{source} not used: {error.detail}"
            ) from None
        except TransformError as error:
            raise InvalidInputError(
                "unknown_frame", f"{source} not used: {error}"
            ) from None

    def _use(self, measurement: Measurement) -> None:
        doubted = measurement.is_position and self._consistency.contradicts(
            measurement.source
        )
        if doubted:
            measurement = replace(measurement, threshold=0.0)
        fused = self._filter.step(measurement)
        self._note(measurement, fused)
        if doubted and fused is Fused.REJECTED:
            self._realign(measurement)
            return
        if measurement.is_position:
            self._realignment.clear()
        if fused is not Fused.USED:
            at = f"{measurement.source} at {measurement.stamp_ns / 1e9:.3f} s"
            self._warn(measurement.source, f"{at} not used: {fused.value}")

    def _note(self, measurement: Measurement, fused: Fused) -> None:
        if fused in (Fused.USED, Fused.REJECTED):
            if self._filter.innovation is not None:
                self._consistency.note(measurement, self._filter.innovation)
            self._is_fresh = True
            self._arrived_ns = self._now_ns()
            self._is_paused = False

    def _realign(self, measurement: Measurement) -> None:
        """Continue from positions of a sensor that shows where the robot is."""
        innovation, now = self._filter.innovation, self._filter.ekf.snapshot
        if innovation is None:
            return
        self._realignment.add(innovation.state, measurement)
        is_measured = self.params.measures_heading
        variance = float(now.covariance[YAW, YAW]) if is_measured else math.inf
        found = self._realignment.solve(now.state, variance)
        if found is None:
            return
        pose, covariance = found
        self._filter.set_pose(pose, covariance)
        self._forget_contradictions()
        self.get_logger().info(
            f"pose found by {measurement.source}: ({pose.x:.2f}, {pose.y:.2f}), "
            f"heading {pose.yaw:.2f} rad"
        )

    def _forget_contradictions(self) -> None:
        self._consistency.reset()
        self._realignment.clear()

    def _judge(self, estimate: Estimate) -> None:
        """Report whether the filter is lost."""
        stddev_m = largest_stddev(estimate.covariance)
        state = self._consistency.update(stddev_m, estimate.stamp_ns)
        cause = self._consistency.cause
        if cause and self._status.state != state and self.params.publish_status:
            self.get_logger().warning(
                f"lost: {cause}; navigation stops. Publish the pose on "
                f"{topics.INITIAL_POSE.name}, or drive by hand until fixes show it"
            )
        self._report(state, cause, stddev_m=stddev_m)

    def _report(self, state: FilterState, cause: str = "", **details: Any) -> None:
        if not self.params.publish_status:
            return
        if cause:
            details["reason"] = cause
        level = StatusReporter.ERROR if cause else StatusReporter.OK
        self._status.report(state, level, cause=cause, **details)

    def _publish(self, estimate: Estimate) -> None:
        params = self.params
        message = odometry_message(
            estimate, params.world_frame, params.base_link_frame, self._attitude
        )
        self.hand_over(topics.ODOMETRY.name, message)
        if params.publish_tf:
            self._publish_transform(estimate)

    def _publish_transform(self, estimate: Estimate) -> None:
        params = self.params
        child = params.base_link_frame
        transform = transform_of(estimate, self._attitude)
        if self._is_on_map:
            child = params.odom_frame
            try:
                base_T_odom = self._lookup(params.base_link_frame, child)
            except TransformError as error:
                self._warn("tf", f"/tf not published: {error}")
                return
            transform = Transform3.from_pose2(pose_of(estimate)) @ base_T_odom
        stamped = transform_message(
            estimate.stamp_ns, params.world_frame, child, transform
        )
        self.hand_over(topics.TF.name, TFMessage(transforms=[stamped]))

    def _lookup(self, target: str, source: str) -> Transform3:
        if target == source:
            return Transform3.identity()
        try:
            return self._buffer.lookup(target, source, 0)
        except TransformError as error:
            raise TransformError(f"no transform {target} → {source}: {error}") from None

    def _pause(self) -> None:
        if not self._is_paused:
            self._is_paused = True
            self.get_logger().warning(
                "nothing is published: no measurement within sensor_timeout_s"
            )
            if self._published_ns >= 0:
                self._report(FilterState.LOST, "no measurement arrives")

    def _warn(self, about: str, text: str) -> None:
        """Log a warning at most every five seconds for each subject."""
        now_ns = self._now_ns()
        if (
            now_ns - self._warned_ns.get(about, -_WARNING_PERIOD_NS)
            >= _WARNING_PERIOD_NS
        ):
            self._warned_ns[about] = now_ns
            self.get_logger().warning(text)

    def _now_ns(self) -> int:
        return self.get_clock().now_ns
