"""The node ``reflex``: pressed bumpers in, commands that back the robot off out.

The node publishes nothing until a bumper is pressed. Its commands have a higher
priority in the arbiter than navigation's, which is paused meanwhile and then plans
another path: the costmap has marked what was touched. An operator's commands have a
higher one still.
"""

from typing import Any, ClassVar

from navette.errors import InvalidInputError
from navette.msgs import topics
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.irobot_create_msgs.msg import HazardDetection, HazardDetectionVector
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.behaviors.reflex.params import ReflexParams
from navette.navigation.behaviors.reflex.reflex import BumperReflex, Contacts
from navette.runtime.stage.odometry import PoseTracker
from navette.runtime.stage.stage_node import Input, Output, StageNode

_FRESH_NS = 500_000_000  # of odometry


class ReflexNode(StageNode):
    """Stop and back off after a contact."""

    PARAMS = ReflexParams
    INPUTS: ClassVar = (
        Input.of(topics.HAZARDS, "the bumpers that are pressed", callback="on_hazards"),
        Input.of(topics.ODOMETRY, "how far the robot moved", callback="on_odometry"),
    )
    OUTPUTS: ClassVar = (
        Output.of(topics.CMD_VEL_REFLEX, "velocity command, only after a contact"),
    )

    params: ReflexParams

    def __init__(self, node_name: str = "reflex", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._reflex = BumperReflex(self.params)
        self._tracker = PoseTracker(self, self.params.base_frame, self.params.map_frame)
        self._timer = self._new_timer()

    def on_hazards(self, msg: HazardDetectionVector) -> None:
        """Begin the reflex if a bumper is newly pressed."""
        pressed = [
            each.header.frame_id
            for each in msg.detections
            if each.type == HazardDetection.BUMP
        ]
        ahead = [self._is_ahead(frame) for frame in pressed]
        contacts = Contacts(any(ahead), not all(ahead))
        now_ns = self.get_clock().now_ns
        if self._reflex.touch(contacts, now_ns):
            self.get_logger().warning(
                f"contact at {', '.join(pressed)}: stop and back off"
            )
            self._timer.reset()
            self._tick()

    def on_odometry(self, msg: Odometry) -> None:
        """Store the newest pose."""
        self._tracker.update(msg)

    def on_params_changed(self, old: ReflexParams) -> None:
        """Use the new values; an active reflex ends."""
        self._reflex = BumperReflex(self.params)
        self.destroy_timer(self._timer)
        self._timer = self._new_timer()

    def on_time_jump(self) -> None:
        """Forget the contacts and the pose."""
        self._reflex.reset()
        self._tracker.reset()
        self._timer.cancel()

    def _new_timer(self) -> Any:
        return self.create_timer(1 / self.params.rate_hz, self._tick, autostart=False)

    def _tick(self) -> None:
        now_ns = self.get_clock().now_ns
        pose, stamp_ns = self._tracker.latest, self._tracker.stamp_ns
        is_fresh = stamp_ns is not None and now_ns - stamp_ns <= _FRESH_NS
        odom_T_base = self._tracker.in_odom(pose) if pose and is_fresh else None
        speed = self._reflex.step(odom_T_base, now_ns)
        if speed is None:
            self._timer.cancel()
            return
        command = Twist()
        command.linear.x = speed
        self.publish(topics.CMD_VEL_REFLEX.name, command)

    def _is_ahead(self, frame: str) -> bool:
        """Whether a bumper is in the front half of the robot.

        Raises:
            InvalidInputError: its place is not known.
        """
        pose = self._tracker.transform_to_base(frame)
        if pose is None:
            raise InvalidInputError(
                "unknown_frame",
                f"bumper {frame!r} is not fixed to {self.params.base_frame!r} by "
                f"{topics.TF_STATIC.name}",
            )
        return pose.x >= 0.0
