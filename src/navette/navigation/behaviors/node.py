"""The node ``behaviors``: Nav2's behavior actions, one at a time.

The node publishes commands only while a goal is active: zeros while an input is stale
and until the robot is at rest, then none. A new goal of any behavior preempts the
active one.
"""

from dataclasses import replace
from typing import Any

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Twist, TwistStamped
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.std_msgs.msg import Empty
from navette.navigation.behaviors.motions import MeasuredMotion
from navette.navigation.behaviors.params import BehaviorParams
from navette.navigation.behaviors.runner import AssistedTeleop, BehaviorInputs
from navette.navigation.behaviors.servers.actions import BEHAVIOR_ACTIONS
from navette.navigation.behaviors.servers.behavior_server import BehaviorServer
from navette.navigation.grids import CollisionCheck
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.navigation.servers.motion_node import MotionNode
from navette.runtime.stage.commander import Commander
from navette.runtime.stage.stage_node import Input, Output


class BehaviorNode(MotionNode):
    """Spin, back up, drive straight, wait, assist an operator."""

    PARAMS = BehaviorParams
    INPUTS = (
        # Poses to place costmaps, also while no behavior is active.
        replace(MotionNode.MOTION_INPUTS[0], most_hz=20.0),
        *MotionNode.MOTION_INPUTS[1:],
        Input.of(
            topics.CMD_VEL_TELEOP,
            "commands of the operator, for assisted_teleop",
            other_types=("geometry_msgs/msg/TwistStamped",),
            callback="on_teleop",
        ),
        Input.of(
            topics.PREEMPT_TELEOP,
            "ends assisted_teleop: the operator has finished",
            callback="on_preempt_teleop",
        ),
        Input.of(
            topics.COMMANDER,
            "whether the commands are masked: time does not count then",
            callback="on_commander",
        ),
    )
    OUTPUTS = (
        Output.of(topics.CMD_VEL_NAV, "velocity command"),
        Output.of(topics.CMD_VEL_ASSISTED, "command of assisted_teleop"),
    )

    params: BehaviorParams
    _located_ns: int | None  # arrival of the newest usable odometry
    _active: BehaviorServer | None = None  # destroy_node() may run before __init__ ends

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("behaviors", **kwargs)
        self._start()
        self._commander = Commander()
        self._lifecycle = StageLifecycle(
            self,
            "behavior_server",
            on_inactive=lambda: self._stop_at_once("behavior_server was deactivated"),
        )
        self._servers = [
            BehaviorServer(self, spec, host=self, activation=self._lifecycle)
            for spec in BEHAVIOR_ACTIONS
        ]
        self._last_ns = 0
        self._timer = self._new_timer()

    def on_odometry(self, msg: Odometry) -> None:
        """Store the newest pose."""
        jumps = self._tracker.jumps
        if self._tracker.update(msg):
            if self._tracker.jumps != jumps:
                self._obstacles.relocate()
            self._located_ns = self._now_ns
            self._odometry_period.note(self._now_ns)

    def on_teleop(self, msg: Twist | TwistStamped) -> None:
        """Pass a command on to the active assisted_teleop."""
        twist = msg.twist if isinstance(msg, TwistStamped) else msg
        teleop = self._active and self._active.behavior
        if isinstance(teleop, AssistedTeleop):
            teleop.receive((twist.linear.x, twist.angular.z))

    def on_preempt_teleop(self, msg: Empty) -> None:
        """End the active assisted_teleop with success."""
        teleop = self._active and self._active.behavior
        if isinstance(teleop, AssistedTeleop):
            teleop.is_finished = True

    def on_commander(self, msg: DiagnosticStatus) -> None:
        """Note which topics of commands the arbiter masks."""
        self._commander = Commander.of(msg)

    def on_params_changed(self, old: BehaviorParams) -> None:
        """Use the new values; an active goal is aborted."""
        self._stop_at_once("the parameters were changed")
        self.destroy_timer(self._timer)
        self._timer = self._new_timer()
        self._start()

    def on_time_jump(self) -> None:
        """Abort the goal, stop the robot, and drop all inputs."""
        self._stop_at_once("the clock was set back")
        self._start()

    def destroy_node(self) -> None:
        """Stop the robot, then destroy the node."""
        if self._active is not None and self.context.ok():
            self._send(self._active, (0.0, 0.0))
        super().destroy_node()

    def _start(self) -> None:
        self._start_tracking()
        self.collision = CollisionCheck(self.params.body())
        self._located_ns = None
        self._odometry_period.reset()
        self._costmap_period.reset()

    def _new_timer(self) -> Any:
        return self.create_timer(1 / self.params.rate_hz, self._tick, autostart=False)

    def begin(self, server: BehaviorServer) -> None:
        """Make a server's goal the only one."""
        if self._active is not None and self._active is not server:
            self._send(self._active, (0.0, 0.0))
            self._active.abort(f"preempted by {server.spec.name}")
        self._active = server
        self._last_ns = self._now_ns
        self._timer.reset()

    def _tick(self) -> None:
        """Place the obstacles, step the goal, publish its command."""
        server = self._active
        if server is None:
            return
        now_ns = self._now_ns
        dt, self._last_ns = (now_ns - self._last_ns) / 1e9, now_ns
        output = server.spec.output
        paused = bool(output) and self._commander.masks(self.resolve_topic_name(output))
        self._send(server, server.step(self._inputs(), dt, paused=paused))
        if self._active is server and not server.is_active:
            self._active = None
            self._timer.cancel()

    def _inputs(self) -> BehaviorInputs:
        self._place_obstacles()
        motion = None
        if self._is_recent(self._located_ns, self._odometry_timeout_s):
            pose = self._tracker.predicted_now(self._now_ns)
            motion = pose and MeasuredMotion(
                pose, *self._tracker.velocity, self._tracker.in_odom(pose)
            )
        recent = self._is_recent(self._obstacles.placed_ns, self._costmap_timeout_s)
        return BehaviorInputs(motion, recent)

    def _is_recent(self, arrival_ns: int | None, timeout_s: float) -> bool:
        return (
            arrival_ns is not None and 0 <= self._now_ns - arrival_ns <= timeout_s * 1e9
        )

    def _place_obstacles(self) -> None:
        params = self.params
        speed = max(params.max_speed_mps, abs(self._tracker.velocity[0]))
        reach_m = self.collision.reach(speed) + speed * params.simulate_ahead_s
        found = self._placed_obstacles(reach_m, reach_m)
        if found is not None:
            self.collision.set_obstacles(*found)

    def _stop_at_once(self, reason: str) -> None:
        if self._active is not None:
            self._send(self._active, (0.0, 0.0))
            self._active.abort(reason)
            self._active = None
            self._timer.cancel()

    def _send(
        self, server: BehaviorServer, command: tuple[float, float] | None
    ) -> None:
        if command is None or not server.spec.output:
            return
        twist = Twist()
        twist.linear.x, twist.angular.z = command
        self.publish(server.spec.output, twist)
