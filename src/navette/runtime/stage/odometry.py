"""Pose of the robot's base in the map frame, from odometry and tf."""

import math
from collections import deque

from navette.errors import InvalidInputError
from navette.geometry import Pose2, Transform3, advanced, angle_difference
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.nav_msgs.msg import Odometry
from navette.runtime.input_check import FARTHEST
from navette.runtime.node import Node
from navette.runtime.planar_odometry import HERE, REST, PlanarOdometry
from navette.runtime.qos import DurabilityPolicy, QoSProfile
from navette.runtime.stage.stage_node import StageNode
from navette.runtime.tf import Buffer, TransformException, TransformListener

_LONGEST_PREDICTION_S = 0.25
# A pose this far from the one before: the robot was carried to another place.
_CARRIED_M = 1.0
# A correction of map_T_odom that moves the robot further is a jump.
_JUMP_M, _JUMP_RAD = 0.15, 0.1
# Time without a transform after which that is reported.
_STARTING_NS = 2_000_000_000
_LOCALIZED = "localized"  # state once the pose is found
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class PoseTracker:
    """Pose of the base in the map frame with a short history, updated by odometry.

    The odometry's child frame may be another frame of the robot, such as a lidar in
    front of the axle; static transforms convert its pose to the base's. The history is
    kept in the odometry's frame. If that is not the map frame, the newest transform
    between the two is applied to all of it (REP 105: map_T_odom is corrected in steps,
    odom_T_base is continuous). Without a transform the pose is unknown.

    Args:
        node: the node that receives the transforms.
        base_frame: the frame that navigation controls.
        map_frame: the frame of the poses.
        history_s: how long poses are kept for :meth:`pose_at`, in s.
        topic: the node's input, under which a stage counts unusable messages.
    """

    def __init__(
        self,
        node: Node,
        base_frame: str,
        map_frame: str,
        history_s: float = 5.0,
        topic: str = topics.ODOMETRY.name,
    ) -> None:
        self.base_frame = base_frame
        self.map_frame = map_frame
        self.buffer = Buffer()
        self.buffer.attach(node)
        self._node = node
        self._topic = topic
        self._history_ns = round(history_s * 1e9)
        self._history: deque[PlanarOdometry] = deque()
        self._shared_odometry = node.context.planar_odometry
        self._odom_frame = ""
        self._map_T_odom = HERE
        self._latest = HERE  # map_T_base of the newest in the history
        #: Number of jumps of map_T_odom: what was placed in the map before, such as a
        #: path or obstacles, has to be placed again.
        self.jumps = 0
        self._motion = REST
        self._first: Pose2 | None = None  # odom_T_base
        # Received only if odometry needs moving transforms.
        self._on_invalid = node.drop_input if isinstance(node, StageNode) else None
        self._listener = TransformListener(
            self.buffer, node, static_only=True, on_invalid=self._on_invalid
        )
        self._moving_listener: TransformListener | None = None
        self._is_searched_for = False  # another node reports that the pose is unknown
        self._child_T_base: tuple[str, Pose2] | None = None
        self._waits_since_ns: int | None = None
        self._newest_transform: tuple[Transform3, Pose2] | None = None

    @property
    def latest(self) -> Pose2 | None:
        """The newest map_T_base, or None."""
        return self._latest if self._history else None

    @property
    def first(self) -> Pose2 | None:
        """The map_T_base where the robot was put down, or None."""
        return self._first and self._on_map(self._first)

    @property
    def stamp_ns(self) -> int | None:
        """The stamp of :attr:`latest`."""
        return self._motion.stamp_ns if self._history else None

    @property
    def velocity(self) -> tuple[float, float]:
        """Forward speed of the base (m/s) and turn rate (rad/s)."""
        return self._motion.speed, self._motion.turn_rate

    @property
    def side_speed(self) -> float:
        """Speed of the base to the left (m/s)."""
        return self._motion.side_speed

    def update(self, odometry: Odometry) -> bool:
        """Use a message that is not changed any more.

        Return False if it is unusable, and log the reason.
        """
        frame_id = odometry.header.frame_id
        child_T_base = self._base_in(odometry.child_frame_id)
        map_T_odom = self._odom_in_map(frame_id)
        if child_T_base is None or map_T_odom is None:
            return False
        motion = self._shared_odometry.of(odometry, child_T_base)
        odom_T_base = motion.odom_T_base
        on_map = odom_T_base if map_T_odom is HERE else map_T_odom @ odom_T_base
        if not _is_near(on_map):
            self._drop_pose(on_map)
            return False
        if frame_id != self._odom_frame:
            self._odom_frame = frame_id
            self._history.clear()
        self._store(motion, on_map, map_T_odom)
        return True

    def pose_at(self, stamp_ns: int) -> Pose2 | None:
        """Return map_T_base, interpolated at a stamp; None outside the history."""
        history = self._history
        if not history or not history[0].stamp_ns <= stamp_ns <= history[-1].stamp_ns:
            return None
        # From the end: the stamps are those of the last messages.
        index = len(history) - 1
        while history[index].stamp_ns > stamp_ns:
            index -= 1
        before_ns, before, *_ = history[index]
        if before_ns == stamp_ns:
            return self._on_map(before)
        after_ns, after, *_ = history[index + 1]
        share = (stamp_ns - before_ns) / (after_ns - before_ns)
        return self._on_map(before.interpolate(after, share))

    def in_odom(self, map_T_base: Pose2) -> Pose2:
        """Return odom_T_base of a pose: continuous, for lengths of motions."""
        if self._map_T_odom is HERE:
            return map_T_base
        return self._map_T_odom.inverse() @ map_T_base

    def predicted_at(self, stamp_ns: int) -> Pose2 | None:
        """Return map_T_base at a stamp, interpolated or predicted.

        The prediction continues the newest motion for at most 0.25 s.
        """
        if not self._history:
            return None
        latest_ns, _, speed, side_speed, turn_rate = self._motion
        if stamp_ns <= latest_ns:
            return self.pose_at(stamp_ns)
        seconds = min((stamp_ns - latest_ns) / 1e9, _LONGEST_PREDICTION_S)
        return advanced(self._latest, speed, turn_rate, seconds, side=side_speed)

    def predicted_now(self, now_ns: int) -> Pose2 | None:
        """Return map_T_base now, or that of odometry stamped ahead of the clock."""
        stamp_ns = self.stamp_ns
        return None if stamp_ns is None else self.predicted_at(max(now_ns, stamp_ns))

    def transform_to_base(self, frame_id: str) -> Pose2 | None:
        """Return base_T_frame of a frame fixed to the robot, or None."""
        transform = self._static(self.base_frame, frame_id)
        if transform is None:
            return None
        base_T_frame = transform.to_pose2()
        if not _is_near(base_T_frame):
            self._drop("out_of_range", f"transform {base_T_frame} to {frame_id!r}")
            return None
        return base_T_frame

    def frame_on_map(self, frame_id: str) -> Pose2 | None:
        """Return the present pose of a frame in the map frame; None if unknown.

        Frames of the robot that are not connected to the map on /tf are placed with
        the pose of the odometry.
        """
        if frame_id == self.map_frame:
            return HERE
        if frame_id == self.base_frame:
            return self.latest
        try:
            return self.buffer.lookup(self.map_frame, frame_id, 0).to_pose2()
        except TransformException:
            pass  # not connected to the map: try the frames of the robot
        try:
            base_T_frame = self.buffer.lookup(self.base_frame, frame_id, 0)
        except TransformException:
            return None
        return self.latest and self.latest @ base_T_frame.to_pose2()

    def reset(self) -> None:
        """Delete the history: a new run, or a jump backward in time."""
        self._history.clear()
        self._motion = REST

    def _on_map(self, odom_T_base: Pose2) -> Pose2:
        """Return map_T_base; the same numbers if both frames are one."""
        if self._map_T_odom is HERE:
            return odom_T_base
        return self._map_T_odom @ odom_T_base

    def _store(self, motion: PlanarOdometry, on_map: Pose2, map_T_odom: Pose2) -> None:
        history, stamp_ns, odom_T_base = self._history, motion[0], motion[1]
        if history and stamp_ns <= history[-1].stamp_ns:
            if stamp_ns == history[-1].stamp_ns:
                history.pop()
            else:
                history.clear()  # time jumped backward
        was_carried = True
        if history:
            before = history[-1].odom_T_base
            moved = math.hypot(odom_T_base.x - before.x, odom_T_base.y - before.y)
            was_carried = moved > _CARRIED_M
        if map_T_odom is not self._map_T_odom:
            before = self._on_map(odom_T_base)  # by the transform until now
            self._map_T_odom = map_T_odom
            if history:
                moved = before.distance_to(on_map)
                turned = abs(angle_difference(before.yaw, on_map.yaw))
                self.jumps += moved > _JUMP_M or turned > _JUMP_RAD
                was_carried |= moved > _CARRIED_M
        if was_carried:
            self._first = odom_T_base
        history.append(motion)
        self._motion, self._latest = motion, on_map
        while history[0].stamp_ns < stamp_ns - self._history_ns:
            history.popleft()

    def _base_in(self, child: str) -> Pose2 | None:
        """Return child_T_base, looked up once per frame name."""
        if self._child_T_base is None or self._child_T_base[0] != child:
            transform = self._static(child, self.base_frame)
            if transform is None:
                return None
            self._child_T_base = child, _plain(transform.to_pose2())
        return self._child_T_base[1]

    def _odom_in_map(self, frame: str) -> Pose2 | None:
        """Return the newest map_T_odom."""
        if frame == self.map_frame:
            return HERE
        try:
            transform = self.buffer.lookup(self.map_frame, frame, 0)
        except TransformException as error:
            if self._moving_listener is None:
                self._moving_listener = TransformListener(
                    self.buffer, self._node, on_invalid=self._on_invalid
                )
                self._await_localization()
            if not self._is_searched_for:
                self._await_frame(error)
            return None
        known = self._newest_transform
        if known is None or known[0] is not transform:
            known = transform, _plain(transform.to_pose2())
            self._newest_transform = known
        return known[1]

    def _await_localization(self) -> None:
        """Receive the state of the node that publishes the transform to the map.

        While it searches for the pose the transform is missing, and it reports that.
        """

        def note(msg: DiagnosticStatus) -> None:
            is_own = msg.name == self._node.get_name()
            self._is_searched_for = not is_own and msg.message != _LOCALIZED

        self._node.create_subscription(
            DiagnosticStatus,
            topics.LOCALIZATION_STATUS.name,
            note,
            _LATCHED,
            shared=True,
        )

    def _await_frame(self, error: TransformException) -> None:
        """Report a missing transform, unless its publisher may be starting."""
        now_ns = self._node.get_clock().now().nanoseconds
        if self._waits_since_ns is None or now_ns < self._waits_since_ns:
            self._waits_since_ns = now_ns
        if now_ns - self._waits_since_ns >= _STARTING_NS:
            self._drop("unknown_frame", str(error))

    def _static(self, target: str, source: str) -> Transform3 | None:
        if target == source:
            return Transform3.identity()
        try:
            return self.buffer.lookup(target, source, 0)
        except TransformException as error:
            self._await_frame(error)
            return None

    def _drop_pose(self, map_T_base: Pose2) -> None:
        if all(map(math.isfinite, map_T_base)):
            detail = f"pose {map_T_base} in {self.map_frame!r}"
            self._drop("out_of_range", detail)
        else:
            self._drop("not_finite", "odometry is not finite")

    def _drop(self, reason: str, detail: str) -> None:
        if isinstance(self._node, StageNode):
            self._node.drop_input(self._topic, InvalidInputError(reason, detail))
        else:
            self._node.get_logger().warning(
                f"odometry not used: {detail}", throttle_duration_sec=5.0
            )


def _plain(pose: Pose2) -> Pose2:
    """Return ``HERE`` itself for the identity, which is not multiplied with."""
    return HERE if pose == HERE else pose


def _is_near(pose: Pose2) -> bool:
    """Whether cells and distances can be computed with it; not if it is not finite."""
    x, y, yaw = pose
    return -FARTHEST <= x <= FARTHEST and -FARTHEST <= y <= FARTHEST and yaw == yaw
