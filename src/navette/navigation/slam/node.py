"""The SLAM node: scans and odometry in, ``map → odom``, pose and map out.

Before the first scan the node publishes nothing. A scan waits for the odometry at its
stamp; without odometry the node predicts by constant velocity and publishes the pose
only. Where nothing is in reach of the scanner, the odometry continues the pose, whose
covariance grows; the status is ``localized`` at the level of a warning. When scans
contradict the map, or the pose is too uncertain, the status is ``lost``: navigation
stops.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any, ClassVar, NamedTuple, TypeVar

import numpy as np

from navette.errors import InvalidInputError
from navette.geometry import Pose2, Transform3
from navette.geometry.messages import header, transform_message
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.nav_msgs.msg import Path as PathMsg
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.tf2_msgs.msg import TFMessage
from navette.navigation.grids import grid_to_message, upward_of
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.navigation.slam.graph_file import read_graph
from navette.navigation.slam.match_status import MatchStatus
from navette.navigation.slam.messages import planar_scan
from navette.navigation.slam.params import MAPPING, SlamParams
from navette.navigation.slam.rendering import MapRenderer, MapScan
from navette.navigation.slam.scan_graph import ScanGraph
from navette.navigation.slam.servers.map_services import SlamMapServices
from navette.navigation.slam.slam import Slam, SlamEstimate
from navette.runtime import Input, Output, StageNode, stamp_to_ns
from navette.runtime.stage.attitude import AttitudeTracker
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.path_messages import pose_message, pose_of
from navette.runtime.stage.status import StatusReporter, status_output
from navette.runtime.tf.exceptions import TransformException
from navette.runtime.worker import Worker

T = TypeVar("T")

_PLANAR = np.ix_([0, 1, 5], [0, 1, 5])
# Scans that wait for their odometry, or until the whole map is searched; older ones
# are left out.
_WAITING = 16
# Of the period between two matched scans, so that jitter of the scanner skips none.
_EARLY = 0.8
# Scans among which one is matched, for the same reason.
_CHOICE = 2
# States on the topic of the localization's status; navigation stops unless localized.
_WAITING_FOR_SCANS, _LOCALIZED, _LOST = "localizing", "localized", "lost"
# Scans in a row without a match that are reported: a robot passes single gaps.
_REPORTED = 10
# Between two logs that scans do not match or match again: along the limit of the
# scanner's range they alternate.
_LOG_PERIOD_S = 10.0
_REASONS = {
    MatchStatus.NO_ECHOES: "nothing is in reach of the scanner; odometry alone",
    MatchStatus.NOTHING_MAPPED: "nothing mapped is in sight; odometry alone",
    MatchStatus.LOST_CONTRADICTED: "the scans contradict the map",
    MatchStatus.LOST_UNCERTAIN: "the position is too uncertain without matching scans",
    MatchStatus.LOST_NO_ECHOES: "nothing is in reach of the scanner",
    MatchStatus.LOST_NOWHERE: "the scans fit nowhere in the map",
    MatchStatus.LOST_AMBIGUOUS: "the scans fit at several places of the map",
}
_LEVELS = {
    _WAITING_FOR_SCANS: StatusReporter.WARN,
    _LOCALIZED: StatusReporter.OK,
    _LOST: StatusReporter.ERROR,
}
_TO_MAPPED = "Drive by hand to a place that is mapped"
_ADVICE = {
    MatchStatus.LOST_AMBIGUOUS: "Drive by hand until the robot sees what is at one of "
    "these places only, or publish its pose on /initialpose",
}


class _Found(NamedTuple):
    """Where the robot is by a scan, and the map then."""

    estimate: SlamEstimate
    match_status: MatchStatus
    unmatched_in_a_row: int
    key_scans: int
    loop_closures: int
    #: Stamp (ns) and pose of each key scan, if earlier poses changed.
    trajectory: list[tuple[int, Pose2]]


class SlamNode(StageNode):
    """Build a map, localise in it and correct the odometry."""

    PARAMS = SlamParams
    INPUTS: ClassVar = (
        Input.of(
            topics.LIDAR, "laser scan", rate_hz=10.0, timeout_s=0.5, callback="on_scan"
        ),
        Input.of(
            topics.ODOMETRY,
            "pose in the odometry's frame",
            rate_hz=10.0,
            timeout_s=0.5,
            callback="on_odometry",
        ),
        Input.of(
            topics.INITIAL_POSE,
            "pose of the robot in a known map, roughly, according to a person",
            callback="on_initial_pose",
        ),
    )
    OUTPUTS: ClassVar = (
        Output.of(topics.TF, "map → odom, after each scan", rate_hz=10.0),
        Output.of(topics.SLAM_POSE, "pose with covariance at each scan", rate_hz=10.0),
        Output.of(topics.AMCL_POSE, "the same under Nav2's name"),
        status_output(topics.LOCALIZATION_STATUS.name),
        Output.of(
            topics.TRAJECTORY,
            "corrected poses at the key scans, after each loop closure",
        ),
        Output.of(topics.SLAM_MAP, "map of the key scans, while it is subscribed to"),
    )
    FIXED_AT_START = frozenset(
        {"map_frame", "odom_frame", "base_frame"}
        | {"known_map", "mode", "searches_start"}
        | {"start_x_m", "start_y_m", "start_yaw_rad"}
    )

    params: SlamParams
    _taken_ns: int

    def __init__(self, node_name: str = "slam", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        # Programs of Nav2 wait for the node that locates the robot.
        self._lifecycle = StageLifecycle(self, "amcl")
        self._status = StatusReporter(self, topics.LOCALIZATION_STATUS.name)
        self.restart()
        self._timer = self.create_timer(self.params.map_period_s, self._publish_map)
        self._services = SlamMapServices(self, session=self)

    def inputs(self) -> tuple[Input, ...]:
        scans, *others = self.INPUTS
        return replace(scans, most_hz=_CHOICE * self.params.rate_hz), *others

    @cached_property
    def _matcher(self) -> Worker:
        """Computes all that uses the SLAM, in order.

        A robot that is lost is searched for in the whole map. A map being drawn must
        not delay it.
        """
        return Worker(self)

    def destroy_node(self) -> None:
        """End the search, then destroy the node; also before ``__init__`` ends."""
        if "_matcher" in vars(self):
            self._matcher.close()
        super().destroy_node()

    def on_initial_pose(self, msg: PoseWithCovarianceStamped) -> None:
        """Place the robot in the known map."""
        frame_id = msg.header.frame_id
        if frame_id not in ("", self.params.map_frame):
            raise InvalidInputError(
                "unknown_frame",
                f"frame {frame_id!r}; expected {self.params.map_frame!r}",
            )
        if not self._slam.is_map_known:
            self.get_logger().warning(
                "initial pose ignored: this map began where the robot was put down"
            )
        pose = pose_of(msg.pose.pose)
        self._use(lambda slam: slam.place(pose))

    def on_odometry(self, msg: Odometry) -> None:
        """Store the pose; use the scans that waited for it."""
        if self._tracker.update(msg):
            self._attitude.update(msg)
            self._use_waiting()

    def on_scan(self, msg: LaserScan) -> None:
        """Use the scan as soon as the odometry at its stamp is there."""
        stamp_ns = stamp_to_ns(msg.header.stamp)
        period_ns = round(_EARLY * 1e9 / self.params.rate_hz)
        if stamp_ns < self._taken_ns + period_ns:
            return
        self._taken_ns = stamp_ns
        self._waiting.append((stamp_ns, msg))
        self._use_waiting()

    def on_params_changed(self, old: SlamParams) -> None:
        """Use the new values from the next scan on; the map is kept."""
        self.change_rate(topics.LIDAR.name, _CHOICE * self.params.rate_hz)
        self._use(partial(_set_params, params=self.params))
        if self.params.map_period_s != old.map_period_s:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(self.params.map_period_s, self._publish_map)

    def on_time_jump(self) -> None:
        """Begin a new map."""
        self.restart()

    def restart(self) -> None:
        """Begin as the parameters say: the robot stands at its start."""
        params = self.params
        start: Pose2 | None
        start = Pose2(params.start_x_m, params.start_y_m, params.start_yaw_rad)
        graph = None
        if params.known_map:
            graph = read_graph(Path(params.known_map).expanduser(), params)
            start = None if params.searches_start else start
        self._tracker = PoseTracker(self, params.base_frame, params.odom_frame)
        self._attitude = AttitudeTracker()
        self._waiting: deque[tuple[int, LaserScan]] = deque(maxlen=_WAITING)
        self._taken_ns = -(10**18)
        self._newest_ns = 0
        self.is_paused = False
        self._begin(start, graph, is_mapping=params.mode == MAPPING)

    def continue_map(self, graph: ScanGraph, start: Pose2, *, is_mapping: bool) -> None:
        """Continue a map, or localize in it."""
        self._begin(start, graph, is_mapping=is_mapping)

    def _begin(
        self, start: Pose2 | None, graph: ScanGraph | None, *, is_mapping: bool
    ) -> None:
        slam = Slam(
            self.params,
            start,
            graph=graph,
            is_mapping=is_mapping,
            trajectory_length=1,
        )
        self._set_slam(slam)

    async def empty_map(self) -> None:
        """Begin a new map where the robot is."""
        slam: Any = await self._matcher.submit(self._slam.emptied)
        self._set_slam(slam)

    async def copied_graph(self) -> ScanGraph:
        """Return a copy of the present scans and poses."""
        graph = await self._matcher.submit(self._slam.graph.copy)
        assert graph is not None, "copies are graphs"
        return graph

    def _set_slam(self, slam: Slam) -> None:
        self._slam = slam
        self._reason = ""  # why no scan matches, as reported last
        self._renderer = MapRenderer(self.params)
        self.key_scans, self._drawn_keys = len(slam.graph), 0
        self._status.report(_WAITING_FOR_SCANS, StatusReporter.WARN)

    def _use(
        self, change: Callable[[Slam], T], finish: Callable[[T], None] = lambda _: None
    ) -> None:
        """Use the present SLAM after what is to be done with it already."""
        slam = self._slam
        self._matcher.run(
            partial(change, slam), finish, is_dropped=lambda: self._slam is not slam
        )

    def pause(self, is_paused: bool) -> None:
        """Leave scans out, or use them again; the odometry continues the pose."""
        if is_paused != self.is_paused:
            text = "paused: scans are left out" if is_paused else "continued"
            self.get_logger().info(text)
        self.is_paused = is_paused

    def _use_waiting(self) -> None:
        wait_ns = round(self.params.pose_wait_s * 1e9)
        while self._waiting and not self._matcher.is_busy:
            stamp_ns, msg = self._waiting[0]
            pose = self._tracker.pose_at(stamp_ns)
            known_ns = self._tracker.stamp_ns
            is_coming = known_ns is None or known_ns < stamp_ns
            if pose is None and is_coming and self._taken_ns < stamp_ns + wait_ns:
                return
            self._waiting.popleft()
            try:
                self._use_scan(stamp_ns, msg, pose)
            except InvalidInputError as error:
                self.drop_input(topics.LIDAR.name, error)

    def _use_scan(
        self, stamp_ns: int, msg: LaserScan, odom_T_base: Pose2 | None
    ) -> None:
        if self.is_paused:
            self._use(
                lambda slam: _found(slam, slam.predicted(odom_T_base)),
                partial(self._publish_found, stamp_ns, odom_T_base),
            )
            return
        scan, base_T_sensor = planar_scan(
            msg,
            self._base_T_sensor(msg.header.frame_id),
            upward_of(self._attitude.at(stamp_ns)),
        )
        self._use(
            lambda slam: _found(
                slam,
                slam.add(stamp_ns, scan, odom_T_base, base_T_sensor=base_T_sensor),
            ),
            partial(self._publish_found, stamp_ns, odom_T_base),
        )

    def _publish_found(
        self, stamp_ns: int, odom_T_base: Pose2 | None, found: _Found | None
    ) -> None:
        if found is not None:
            self._newest_ns, self.key_scans = stamp_ns, found.key_scans
            self._report(found)
            self._publish_pose(stamp_ns, found.estimate)
            if found.trajectory:
                self._publish_trajectory(found.trajectory)
            if odom_T_base is not None:
                self._publish_transform(
                    stamp_ns, found.estimate.map_T_base @ odom_T_base.inverse()
                )
        self._use_waiting()

    def _base_T_sensor(self, frame_id: str) -> Transform3:  # noqa: N802 - frame notation
        base = self.params.base_frame
        if frame_id in ("", base):
            return Transform3.identity()
        try:
            return self._tracker.buffer.lookup(base, frame_id, 0)
        except TransformException as error:
            raise InvalidInputError("no_transform", str(error)) from None

    def _report(self, found: _Found) -> None:
        """Report how the pose is known; log when that changes."""
        match_status, state = found.match_status, self._state_of(found)
        reason = ""
        if state != _LOCALIZED or found.unmatched_in_a_row >= _REPORTED:
            reason = _REASONS.get(match_status, "")
        self._log_change(state, match_status, reason)
        level = _LEVELS[state]
        if reason and state == _LOCALIZED:
            level = StatusReporter.WARN
        self._reason = reason
        spread = float(np.sqrt(np.trace(found.estimate.covariance[:2, :2])))
        self._status.report(
            state,
            level,
            cause=reason,
            position_stddev_m=spread,
            key_scans=found.key_scans,
            loop_closures=found.loop_closures,
            **({"reason": reason} if reason else {}),
        )

    def _state_of(self, found: _Found) -> str:
        match_status = found.match_status
        if match_status.is_lost:
            return _LOST
        if match_status is MatchStatus.STARTING:
            return _WAITING_FOR_SCANS
        if match_status is MatchStatus.CONTRADICTED:
            return self._status.state
        return _LOCALIZED

    def _log_change(self, state: str, match_status: MatchStatus, reason: str) -> None:
        before, log = self._status.state, self.get_logger()
        if state == _LOST and before != _LOST:
            log.error(
                f"lost: {reason}; navigation stops. "
                f"{_ADVICE.get(match_status, _TO_MAPPED)}"
            )
        elif state == _LOCALIZED and before == _LOST:
            log.info("localized again")
        elif reason and not self._reason:
            log.warning(
                f"{reason}: the pose becomes less certain until scans match again",
                throttle_duration_sec=_LOG_PERIOD_S,
            )
        elif self._reason and not reason:
            log.info("scans match again", throttle_duration_sec=_LOG_PERIOD_S)

    def _publish_pose(self, stamp_ns: int, estimate: SlamEstimate) -> None:
        message = PoseWithCovarianceStamped(
            header=header(stamp_ns, self.params.map_frame)
        )
        message.pose.pose = pose_message(estimate.map_T_base)
        covariance = np.zeros((6, 6))
        covariance[_PLANAR] = estimate.covariance
        message.pose.covariance = covariance.reshape(-1)
        self.publish(topics.SLAM_POSE.name, message)
        self.publish(topics.AMCL_POSE.name, message)

    def _publish_trajectory(self, trajectory: list[tuple[int, Pose2]]) -> None:
        """Publish where the robot was at the key scans, by the present map."""
        frame = self.params.map_frame
        path = PathMsg(header=header(self._newest_ns, frame))
        path.poses = [
            PoseStamped(header=header(stamp_ns, frame), pose=pose_message(pose))
            for stamp_ns, pose in trajectory
        ]
        self.hand_over(topics.TRAJECTORY.name, path)

    def _publish_transform(self, stamp_ns: int, map_T_odom: Pose2) -> None:
        params = self.params
        valid_ns = stamp_ns + round(params.transform_tolerance_s * 1e9)
        stamped = transform_message(
            valid_ns,
            params.map_frame,
            params.odom_frame,
            Transform3.from_pose2(map_T_odom),
        )
        self.publish(topics.TF.name, TFMessage(transforms=[stamped]))

    def _publish_map(self) -> None:
        """Publish the map if it has grown and a program subscribes to it."""
        keys = self.key_scans
        is_new = keys != self._drawn_keys and self.has_listeners(topics.SLAM_MAP.name)
        if is_new and not self.worker.is_busy:
            self._drawn_keys = keys
            self._use(Slam.placed_scans, self._draw)

    def _draw(self, scans: list[MapScan]) -> None:
        renderer = self._renderer
        self.worker.run(
            self._drawer(scans),
            partial(self.publish, topics.SLAM_MAP.name),
            is_dropped=lambda: self._renderer is not renderer,  # another map began
        )

    async def map_drawer(self) -> Callable[[], OccupancyGrid]:
        """Return what draws the present map, in the worker: 2 s with 2,000 scans."""
        scans: Any = await self._matcher.submit(self._slam.placed_scans)
        return self._drawer(scans)

    def _drawer(self, scans: list[MapScan]) -> Callable[[], OccupancyGrid]:
        renderer, frame_id = self._renderer, self.params.map_frame
        stamp_ns = self._newest_ns
        return lambda: grid_to_message(*renderer.render(scans), frame_id, stamp_ns)


def _found(slam: Slam, estimate: SlamEstimate | None) -> _Found | None:
    if estimate is None:
        return None
    graph = slam.graph
    trajectory = [
        (key.stamp_ns, graph.pose(node))
        for node, key in enumerate(graph.keys if estimate.is_corrected else ())
    ]
    return _Found(
        estimate,
        slam.match_status,
        slam.unmatched_in_a_row,
        len(graph),
        slam.loop_closures,
        trajectory,
    )


def _set_params(slam: Slam, params: SlamParams) -> None:
    slam.params = params
