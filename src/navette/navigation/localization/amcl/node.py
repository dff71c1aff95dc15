"""The node ``amcl``: scans, odometry and a known map in, map → odom out.

Without a map the status is ``no_map``. Without an initial pose the robot is
``localizing``: map → odom is published once the pose is found, for which the robot has
to move in places that look alike. A robot whose scans stop matching the map is
``lost``: the last correction stays, navigation stops, and the whole map is searched.
Scans with too few echoes are not used: the pose follows the odometry, and the
robot is ``lost`` once it is too uncertain.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidInputError, InvalidValueError
from navette.geometry import Pose2, Transform3
from navette.geometry.messages import transform_message
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import PoseWithCovarianceStamped
from navette.msgs.nav2_msgs.srv import SetInitialPose
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import Header
from navette.msgs.std_srvs.srv import Empty
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.grids import LEVEL, grid_from_message, is_floor, upward_of
from navette.navigation.localization.amcl.confidence import (
    DoubtCause,
    LocalizationState,
)
from navette.navigation.localization.amcl.estimate import Particles
from navette.navigation.localization.amcl.localizer import (
    Located,
    MapLocalizer,
    ScanView,
    default_covariance,
    is_usable,
)
from navette.navigation.localization.amcl.messages import (
    cloud_message,
    planar_covariance,
    scan_points,
    spatial_covariance,
)
from navette.navigation.localization.amcl.odometry_jumps import OdometryJumps
from navette.navigation.localization.amcl.params import AmclParams
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.runtime import Input, Output, StageNode, stamp_to_ns
from navette.runtime.input_check import input_check
from navette.runtime.stage.attitude import AttitudeTracker
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.path_messages import pose_message, pose_of
from navette.runtime.stage.status import StatusReporter, status_output
from navette.runtime.time import ns_to_stamp

T = TypeVar("T")

_HELP = f"publish the pose on {topics.INITIAL_POSE.name} to help"
#: What happens next, by the reason why the robot is not localized any more.
_NEXT = {
    DoubtCause.CONTRADICTED: f"the whole map is searched; {_HELP}",
    DoubtCause.UNCERTAIN: "drive the robot by hand to where the scanner sees things of "
    f"the map, or {_HELP}",
    DoubtCause.ELSEWHERE: f"it continues once one place is confirmed; {_HELP}",
}

_START = ("x", "y", "z", "yaw")
_MAP_TIMEOUT_NS = 2_000_000_000
# Time after which a pose that is still unknown is reported.
_FINDING_NS = 3_000_000_000
_LATEST_NS = (2**31 - 1) * 1_000_000_000  # of a message
_PLACE = ParameterDescriptor(
    description="where the robot starts, if set_initial_pose [m, rad]",
    floating_point_range=[FloatingPointRange(from_value=-1e6, to_value=1e6)],
)
_LEVELS = {
    LocalizationState.LOCALIZED: StatusReporter.OK,
    LocalizationState.LOCALIZING: StatusReporter.WARN,
}


class _Found(NamedTuple):
    """Where a scan places the robot, and the particles."""

    located: Located
    particles: Particles


def _located(localizer: MapLocalizer, view: ScanView) -> _Found:
    located = localizer.step(view)
    return _Found(located, localizer.filter.particles)


class AmclNode(StageNode):
    """Adaptive Monte Carlo localization with the names of Nav2's."""

    PARAMS = AmclParams
    FIXED_AT_START: ClassVar = ("seed", "random_seed", "scan_topic", "map_topic")
    INPUTS: ClassVar = (
        Input.of(topics.LIDAR, "laser scan", rate_hz=10.0, callback="on_scan"),
        Input.of(topics.ODOMETRY, "motion", rate_hz=10.0, callback="on_odometry"),
        Input.of(topics.STATIC_MAP, "the known map", callback="on_map"),
        Input.of(
            topics.INITIAL_POSE,
            "pose of the robot according to a person or program",
            callback="on_initial_pose",
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(topics.AMCL_POSE, "estimated pose with covariance"),
        Output.of(topics.PARTICLES, "the particles, only while it is subscribed to"),
        Output.of(topics.TF, "map → odom", rate_hz=10.0),
        status_output(topics.LOCALIZATION_STATUS.name),
    )

    params: AmclParams

    def __init__(self, node_name: str = "amcl", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._lifecycle = StageLifecycle(self, "amcl")
        # All that uses it is computed in the worker, in order: a search of a large map
        # takes longer than the robot may be without commands.
        self._localizer: MapLocalizer | None = None
        self._has_map = False
        self._given: tuple[Pose2, NDArray[np.float64]] | None = None
        self._map: OccupancyGrid | None = None
        self._waits_since_ns: int | None = None
        self._finding_since_ns: int | None = None
        self._state = LocalizationState.NO_MAP
        self._tracker, self._jumps = self._new_tracker(), OdometryJumps()
        self._attitude = AttitudeTracker()
        self._odom_covariance: Any = np.zeros(36)
        self._status = StatusReporter(self, topics.LOCALIZATION_STATUS.name)
        self._status.report(LocalizationState.NO_MAP, StatusReporter.ERROR)
        self.create_service(
            Empty, "reinitialize_global_localization", self.on_reinitialize
        )
        self.create_service(Empty, "request_nomotion_update", self.on_request_update)
        self.create_service(SetInitialPose, "set_initial_pose", self.on_set_pose)

    def declare_params(self) -> Any:
        """Declare Nav2's initial_pose.x, .y, .z and .yaw beside PARAMS."""
        self._start = [
            float(self.declare_parameter(f"initial_pose.{name}", 0.0, _PLACE).value)
            for name in _START
        ]
        return super().declare_params()

    def inputs(self) -> tuple[Input, ...]:
        params = self.params
        scans, odometry, known_map, start = self.INPUTS
        return (
            replace(scans, topic=params.scan_topic, most_hz=params.rate_hz),
            odometry,
            replace(known_map, topic=params.map_topic),
            start,
        )

    def on_odometry(self, msg: Odometry) -> None:
        """Store the pose of the odometry; correct the transform if it jumps."""
        if not self._tracker.update(msg):
            return
        self._attitude.update(msg)
        self._odom_covariance = msg.pose.covariance
        pose, stamp_ns = self._tracker.latest, self._tracker.stamp_ns
        assert pose is not None, "the tracker accepted the odometry"
        assert stamp_ns is not None, "with its stamp"
        new_T_old = self._jumps.step(pose, stamp_ns)
        if new_T_old is not None:
            self._use(
                lambda localizer: localizer.follow_jump(new_T_old),
                partial(self._publish_transform, stamp_ns=stamp_ns),
            )

    def on_map(self, msg: OccupancyGrid) -> None:
        """Localize on a map; another one keeps the pose."""
        if self._has_map and self.params.first_map_only:
            return
        self._map = msg
        self._begin(msg)

    def on_scan(self, msg: LaserScan) -> None:
        """Locate the robot at the stamp of the scan, unless one before is in use."""
        if not self._has_map:
            self._report_missing_map()
            return
        if not self._lifecycle.is_active or self.worker.is_busy:
            return
        stamp_ns = stamp_to_ns(msg.header.stamp)
        odom_T_base = self._tracker.predicted_at(stamp_ns)
        base_T_sensor = self._tracker.transform_to_base(msg.header.frame_id)
        if odom_T_base is None or base_T_sensor is None:
            return
        points = scan_points(msg, base_T_sensor, self.params)
        upward = upward_of(self._attitude.at(stamp_ns))
        if upward != LEVEL:
            points = points[~is_floor(points, self._height_of(msg), upward)]
        covariance = planar_covariance(self._odom_covariance)
        view = ScanView(points, odom_T_base, stamp_ns, len(msg.ranges), covariance)
        self._use(partial(_located, view=view), partial(self._publish, view=view))

    def _height_of(self, msg: LaserScan) -> float:
        """Return the height of the scanner above the base, m."""
        base, frame_id = self._tracker.base_frame, msg.header.frame_id
        if frame_id == base:
            return 0.0
        return self._tracker.buffer.lookup(base, frame_id, 0).translation[2]

    def on_initial_pose(self, msg: PoseWithCovarianceStamped) -> None:
        """Continue from a pose of a person or program."""
        frame = msg.header.frame_id or self.params.global_frame_id
        if frame != self.params.global_frame_id:
            raise InvalidInputError(
                "unknown_frame",
                f"initial pose in frame {frame!r}; expected "
                f"{self.params.global_frame_id!r}",
            )
        covariance = planar_covariance(msg.pose.covariance)
        if not is_usable(covariance):
            covariance = default_covariance(self.params)
        self._set_pose(pose_of(msg.pose.pose), covariance)

    def on_set_pose(self, request: Any, response: Any) -> Any:
        """Continue from a pose, as with ``/initialpose``."""
        try:
            input_check(topics.INITIAL_POSE.type)(request.pose)
            self.on_initial_pose(request.pose)
        except InvalidInputError as error:
            self.drop_input(topics.INITIAL_POSE.name, error)
        return response

    def on_reinitialize(self, request: Any, response: Any) -> Any:
        """Forget the pose and search the whole map."""
        self._given = None
        self._use(MapLocalizer.locate_globally)
        self.get_logger().info("global localization: the whole map is searched")
        return response

    def on_request_update(self, request: Any, response: Any) -> Any:
        """Update the filter at the next scan, also without motion."""
        self._use(MapLocalizer.request_update)
        return response

    def on_params_changed(self, old: AmclParams) -> None:
        """Start again with the new values, at the present pose."""
        new = self.params
        self.change_rate(new.scan_topic, new.rate_hz)
        if (new.base_frame_id, new.odom_frame_id) != (
            old.base_frame_id,
            old.odom_frame_id,
        ):
            self._tracker, self._jumps = self._new_tracker(), OdometryJumps()
        if self._map is not None:
            self._begin(self._map)

    def on_time_jump(self) -> None:
        """Drop the pose."""
        self._tracker.reset()
        if self._map is not None:
            self._begin(self._map, keeps_pose=False)

    def _new_tracker(self) -> PoseTracker:
        params = self.params
        return PoseTracker(self, params.base_frame_id, params.odom_frame_id)

    def _begin(self, msg: OccupancyGrid, *, keeps_pose: bool = True) -> None:
        """Localize on a map, from the present pose on."""
        try:
            cells, spec = grid_from_message(msg)
        except InvalidValueError as error:
            raise InvalidInputError("out_of_range", str(error)) from None
        params, given = self.params, self._given
        keeps_pose &= not params.always_reset_initial_pose
        first = given
        if given is None and params.set_initial_pose:
            x, y, _, yaw = self._start
            first = Pose2(x, y, yaw), default_covariance(params)

        def begin() -> LocalizationState:
            former, start = self._localizer, first
            self._localizer = MapLocalizer(params, cells, spec)
            if former is not None and keeps_pose:
                start = former.present_pose or given
            if start is not None:
                self._localizer.set_pose(*start)
            return self._localizer.confidence.state

        self._has_map = True
        self.worker.run(begin, self._report)

    def _use(
        self,
        change: Callable[[MapLocalizer], T],
        finish: Callable[[T], None] = lambda _: None,
    ) -> None:
        """Use the localizer in the worker, if there is a map."""

        def use() -> T:
            assert self._localizer is not None, "the map came first"
            return change(self._localizer)

        if self._has_map:
            self.worker.run(use, finish)

    def _report_missing_map(self) -> None:
        """Report once that scans arrive and no map does."""
        now_ns = self.get_clock().now_ns
        if self._waits_since_ns is None or now_ns < self._waits_since_ns:
            self._waits_since_ns = now_ns
        if now_ns - self._waits_since_ns >= _MAP_TIMEOUT_NS:
            self.get_logger().warning(
                f"no map has arrived on {self.params.map_topic}, and the pose is "
                "unknown without one; navigation waits for it: set map_file of "
                "map_memory (navette sim --map FILE.yaml, navette up map:=FILE.yaml), "
                "call map_server/load_map, or start a map server",
                once=True,
            )

    def _set_pose(self, pose: Pose2, covariance: NDArray[np.float64]) -> None:
        self._given = pose, covariance
        self.get_logger().info(
            f"initial pose: ({pose.x:.2f}, {pose.y:.2f}), heading {pose.yaw:.2f} rad"
        )
        if not self._has_map:
            self.get_logger().warning("no map has arrived yet; the pose is kept for it")
        self._use(lambda localizer: localizer.set_pose(pose, covariance))

    def _publish(self, found: _Found, view: ScanView) -> None:
        params, located = self.params, found.located
        odom_T_base, stamp_ns = view.odom_T_base, view.stamp_ns
        self._publish_transform(located.map_T_odom, stamp_ns)
        self._report_search(located, stamp_ns)
        estimate = located.estimate
        if estimate is None:
            self._report(located.state)
            return
        details: dict[str, Any] = {}
        if located.match is not None:
            details["match"] = located.match
        if located.cause is not None:
            details["reason"] = located.cause
        self._report(
            located.state,
            located.cause,
            echoes="enough" if view.is_informative else "too few",
            stddev_m=estimate.stddev_m,
            share=estimate.share,
            particles=len(found.particles),
            hypotheses=located.hypotheses,
            **details,
        )
        if not located.is_updated:
            return
        header = Header(stamp=ns_to_stamp(stamp_ns), frame_id=params.global_frame_id)
        if located.map_T_odom is not None:
            message = PoseWithCovarianceStamped(header=header)
            message.pose.pose = pose_message(located.map_T_odom @ odom_T_base)
            message.pose.covariance = spatial_covariance(estimate.covariance)
            self.publish(topics.AMCL_POSE.name, message)
        if self.has_listeners(topics.PARTICLES.name):
            particles = found.particles
            cloud = cloud_message(particles.poses, particles.weights, header)
            self.hand_over(topics.PARTICLES.name, cloud)

    def _publish_transform(self, map_T_odom: Pose2 | None, stamp_ns: int) -> None:
        params = self.params
        if map_T_odom is None or not params.tf_broadcast:
            return
        if not self._lifecycle.is_active:
            return
        transform = transform_message(
            min(stamp_ns + round(params.transform_tolerance * 1e9), _LATEST_NS),
            params.global_frame_id,
            params.odom_frame_id,
            Transform3.from_pose2(map_T_odom),
        )
        self.publish(topics.TF.name, TFMessage(transforms=[transform]))

    def _report_search(self, located: Located, stamp_ns: int) -> None:
        """Report once that an unknown pose is not found from where the robot is."""
        if located.map_T_odom is not None:
            self._finding_since_ns = None
            return
        since_ns = self._finding_since_ns
        if since_ns is None or stamp_ns < since_ns:
            self._finding_since_ns = since_ns = stamp_ns
        if stamp_ns - since_ns >= _FINDING_NS:
            self.get_logger().warning(
                "localizing: the pose on the map is unknown, and no single place "
                "explains the scans; navigation waits. Drive the robot by hand, until "
                f"the scans fit one place only, or {_HELP}",
                once=True,
            )

    def _report(
        self,
        state: LocalizationState,
        cause: DoubtCause | None = None,
        **details: Any,
    ) -> None:
        if state is not self._state:
            self._state = state
            log = self.get_logger()
            if cause is None or state is LocalizationState.LOCALIZED:
                log.info(f"localization: {state}")
            else:
                log.warning(f"{state}: {cause}; navigation stops: {_NEXT[cause]}")
        self._status.report(state, _LEVELS.get(state, StatusReporter.ERROR), **details)
