"""The node ``control``: path, odometry and costmap in, velocity commands out.

The node publishes no command before its first path. With a path it publishes at every
step, zeros while an input is stale. At rest it publishes ``idle_zeros`` zero commands
and then none. While the arbiter masks its commands (an operator drives, or a stop is
engaged) the node is paused: it publishes none and keeps the path. When destroyed it
publishes a zero.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from navette.errors import InvalidInputError, InvalidValueError
from navette.geometry import Footprint, Pose2
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.geometry_msgs.msg import Twist
from navette.msgs.nav2_dynamic_msgs.msg import ObstacleArray
from navette.msgs.nav2_msgs.msg import SpeedLimit
from navette.msgs.nav_msgs.msg import Odometry, Path
from navette.navigation.control.command_gate import InputAges
from navette.navigation.control.explanations import Situation
from navette.navigation.control.follower import BaseFollower
from navette.navigation.control.followers import make_follower
from navette.navigation.control.limits import NO_CAP, STOP, SpeedCap, VelocityCommand
from navette.navigation.control.moving_obstacles import counts_as_static
from navette.navigation.control.params import ControlParams
from navette.navigation.control.records import (
    PAUSED,
    UNKNOWN_POSE,
    FollowerInputs,
    FollowerOutput,
)
from navette.navigation.control.servers.follow_path import FollowPathServer
from navette.navigation.control.servers.reports import ControlReports
from navette.navigation.control.states import ControlState
from navette.navigation.grids import (
    NO_DISCS,
    MovingDiscs,
    discs_from_message,
)
from navette.navigation.grids.checks import check_frame
from navette.navigation.grids.stall_monitor import StallMonitor
from navette.navigation.servers.lifecycle import StageLifecycle
from navette.navigation.servers.motion_node import MotionNode
from navette.params.plugins import MethodFaultError
from navette.runtime.stage.commander import Commander
from navette.runtime.stage.path_messages import Poses, poses_of
from navette.runtime.stage.stage_node import Input, Output
from navette.runtime.stage.status import status_output

_NEVER = -(1 << 62)
# Age of the moving obstacles from which they are obsolete.
_MOVING_TIMEOUT_S = 0.5
# Status of a planner before its first goal.
_NO_GOAL_YET = "waiting_for_goal"


class ControlNode(MotionNode):
    """Follow /path to its end; stop on stale or invalid inputs."""

    PARAMS = ControlParams
    INPUTS = (
        Input.of(
            topics.PATH,
            "path to follow; an empty path stops",
            callback="on_path",
        ),
        *MotionNode.MOTION_INPUTS,
        Input.of(
            topics.TRACKED_OBSTACLES,
            "moving obstacles, which are avoided where they will be",
            callback="on_moving",
        ),
        Input.of(
            topics.PLANNER_STATUS,
            "liveliness of the planner",
            rate_hz=2.0,
            timeout_s=2.0,
            callback="on_planner_status",
        ),
        Input.of(
            topics.SPEED_LIMIT,
            "temporary speed limit; 0: none",
            callback="on_speed_limit",
        ),
        Input.of(
            topics.COMMANDER,
            "who commands; none: control does",
            callback="on_commander",
        ),
    )
    OUTPUTS = (
        Output.of(
            topics.CMD_VEL_NAV,
            "velocity command",
            rate_hz=20.0,
        ),
        status_output(topics.CONTROL_STATUS.name),
        Output.of(
            topics.COLLISION_MONITOR_STATE,
            "what the collision check does to the commands, on change",
        ),
        Output.of(
            topics.LOCAL_FOOTPRINT,
            "the robot's outline on the map, only while it is subscribed to",
            rate_hz=20.0,
        ),
        Output.of(
            topics.TRAJECTORIES,
            "motions that MPPI compares, only while it is subscribed to",
            rate_hz=5.0,
        ),
    )

    params: ControlParams
    _zeros_left = 0  # destroy_node() may run before __init__ ends

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("control", **kwargs)
        params = self.params
        self._follower = make_follower(params)
        if isinstance(self._follower, BaseFollower):
            self._follower.warm_up()
        self._speed_limits = NO_CAP
        self._path = np.empty((0, 3))
        self._follows_goal = False  # the path is that of a follow_path goal …
        self._method = ""  # … which may name a steering method
        self._fault = ""  # newest of the user's method
        self._moving = MovingDiscs(NO_DISCS, 0)
        self._placed_ns = _NEVER  # arrival of the costmap that the follower uses
        self._odometry: Odometry | None = None  # newest, not used yet
        self._odometry_ns = self._located_ns = _NEVER  # arrivals of newest and used
        self._planner_ns = _NEVER
        self._odometry_frame = ""
        self._planner_state = ""
        self._is_paused = False
        self._stall = StallMonitor(params.stall_time_s)
        self._commanded = STOP
        self._output_topic = self.resolve_topic_name(topics.CMD_VEL_NAV.name)
        self._reports = ControlReports(self, host=self)
        self._timer = self.create_timer(1 / params.rate_hz, self._tick)
        self._lifecycle = StageLifecycle(
            self, "controller_server", on_inactive=lambda: self.on_path(Path())
        )
        self._follow_server = FollowPathServer(
            self, host=self, activation=self._lifecycle
        )

    def on_path(self, msg: Path) -> None:
        """Follow a new path, or report why it is refused."""
        self._replace_path()
        if msg.poses:
            check_frame("path", msg.header.frame_id, self.params.map_frame)
            if not self._lifecycle.is_active:
                raise InvalidInputError("inactive", "controller_server is not active")
        self._try_path(poses_of(msg))

    def on_input_dropped(self, topic: str, msg: Any, error: InvalidInputError) -> None:
        """Stop for an invalid path: the previous one is obsolete."""
        if topic == topics.PATH.name:
            self._replace_path()
            state = {
                "unknown_frame": ControlState.UNKNOWN_FRAME,
                "inactive": ControlState.IDLE,
            }.get(error.reason, ControlState.INVALID_PATH)
            self._follower.reset(state)

    def on_odometry(self, msg: Odometry) -> None:
        """Store the newest message for the next step."""
        self._odometry = msg
        self._odometry_period.note(self._now_ns)
        self._odometry_ns = self._now_ns
        self._odometry_frame = msg.child_frame_id

    def on_moving(self, msg: ObstacleArray) -> None:
        """Store the moving obstacles."""
        self._moving = discs_from_message(msg, self.params.map_frame)

    def on_planner_status(self, msg: DiagnosticStatus) -> None:
        """Note that the planner is alive; drop the path if the planner restarted."""
        self._planner_ns = self._now_ns
        before, self._planner_state = self._planner_state, msg.message
        restarted = msg.message == _NO_GOAL_YET and before not in ("", _NO_GOAL_YET)
        if restarted and self._follower.has_path and not self._follows_goal:
            self.get_logger().warning("the planner restarted: path dropped")
            self.on_path(Path())

    def on_speed_limit(self, msg: SpeedLimit) -> None:
        """Limit the speed, in percent or m/s; 0: no limit."""
        limit = msg.speed_limit
        if not (math.isfinite(limit) and limit >= 0):
            raise InvalidInputError(
                "out_of_range",
                f"speed_limit is {limit!r}; must be finite and >= 0 (0: none)",
            )
        if limit == 0:
            self._speed_limits = NO_CAP
        elif msg.percentage:
            self._speed_limits = SpeedCap.percentage(limit, self.params)
        else:
            self._speed_limits = SpeedCap(limit, limit)
        self._follower.limit_speed(self._speed_limits)

    def on_commander(self, msg: DiagnosticStatus) -> None:
        """Pause while the commands do not reach the wheels."""
        is_masked = Commander.of(msg).masks(self._output_topic)
        if is_masked != self._is_paused:
            self._is_paused = is_masked
            self._pause_follower()
            self._stall.reset()
            self._commanded = STOP
            self._tick()

    def on_params_changed(self, old: ControlParams) -> None:
        """Follow the same path with the new parameters."""
        params = self.params
        if (params.base_frame, params.map_frame) != (old.base_frame, old.map_frame):
            self._start_tracking()
            self._located_ns = _NEVER
        footprint = Footprint.from_flat(params.footprint_m)
        self._obstacles.configure(footprint, params.blind_reverse_m)
        self._stall = StallMonitor(params.stall_time_s)
        if params.rate_hz != old.rate_hz:
            self.destroy_timer(self._timer)
            self._timer = self.create_timer(1 / params.rate_hz, self._tick)
        drove = self._follower.has_path
        self._new_follower(params)
        if drove:
            self._try_path(self._path)

    def on_time_jump(self) -> None:
        """Drop all inputs, stop, and wait for the next path."""
        self._tracker.reset()
        self._follow_server.interrupt("the clock was set back")
        self._new_follower(self.params)
        self._path = np.empty((0, 3))
        self._maps.forget()
        self._obstacles.reset()
        self._moving = MovingDiscs(NO_DISCS, 0)
        self._odometry_period.reset()
        self._costmap_period.reset()
        self._odometry = None
        self._odometry_ns = self._located_ns = _NEVER
        self._planner_ns, self._planner_state = _NEVER, ""
        self._stall = StallMonitor(self.params.stall_time_s)
        self._commanded = STOP

    def destroy_node(self) -> None:
        """Stop the robot, then destroy the node."""
        if self._zeros_left and self.context.ok():
            self.publish(topics.CMD_VEL_NAV.name, Twist())
            self._zeros_left = 0
        super().destroy_node()

    def _new_follower(self, params: ControlParams) -> None:
        """Replace the follower; obstacles are placed for it before it moves."""
        if self._method:
            params = replace(params, method=self._method)
        self._follower = make_follower(params)
        self._follower.limit_speed(self._speed_limits)
        self._placed_ns = _NEVER

    def _replace_path(self) -> None:
        """Forget the last path for one of the topic."""
        self._planner_ns = self._now_ns
        self._follow_server.interrupt(f"preempted by a path on {topics.PATH.name}")
        self._begin(goal=False)

    def _begin(self, *, goal: bool, method: str = "") -> None:
        """Forget the last path before a new one."""
        self._follows_goal = goal
        if method != self._method:
            self._method = method
            self._new_follower(self.params)
        self._zeros_left = self.params.idle_zeros
        self._path = np.empty((0, 3))

    def _try_path(self, poses: Poses) -> None:
        try:
            self._set_path(poses)
        except InvalidValueError as error:
            self.get_logger().error(str(error))
            self._follower.reset(ControlState.INVALID_PATH)

    def _set_path(self, poses: Poses) -> None:
        try:
            self._follower.set_path(poses)
        except MethodFaultError as error:
            self._on_fault(error)
        self._path = poses

    def frame_on_map(self, frame_id: str) -> Pose2 | None:
        return self._tracker.frame_on_map(frame_id)

    def follow_goal(self, poses: Poses, method: str) -> None:
        """Follow the path of a goal with a steering method; empty: the configured."""
        self._begin(goal=True, method=method)
        self._set_path(poses)

    def stop_goal(self) -> bool:
        """Stop if the path is that of a goal; return whether it was."""
        was_goal = self._follows_goal
        if was_goal:
            self._begin(goal=False)
            self._follower.reset()
        return was_goal

    def _tick(self) -> None:
        """Locate the robot, place the costmap, step the follower, publish."""
        self._locate()
        self._reports.publish_footprint(self._tracker.predicted_now(self._now_ns))
        self._place_costmap()
        self._follower.set_moving(self._moving.at(self._now_ns, _MOVING_TIMEOUT_S))
        if self._is_paused and self._follower.has_path:
            self._reports.state(PAUSED)
            self._follow_server.step_paused()
            return
        speed, turn_rate = self._tracker.velocity
        pose = self._tracker.predicted_now(self._now_ns) or UNKNOWN_POSE
        inputs = FollowerInputs(
            pose, speed, turn_rate, self._ages(), self._tracker.side_speed
        )
        output = self._stopped_if_stalled(inputs, self._step(inputs))
        self._send(output)
        self._reports.state(output)
        self._reports.collision(output)
        self._reports.publish_rollouts(self._follower.rollouts)
        fresh = inputs.ages.odometry_s <= inputs.ages.odometry_timeout_s
        self._follow_server.step(output, inputs, fresh=fresh)

    def _step(self, inputs: FollowerInputs) -> FollowerOutput:
        """Step the follower; a fault of a user's method stops the robot."""
        dt = 1 / self.params.rate_hz
        try:
            return self._follower.step(inputs, dt)
        except MethodFaultError as error:
            self._on_fault(error)
            return self._follower.step(inputs, dt)

    def _pause_follower(self, last: VelocityCommand | None = None) -> None:
        try:
            self._follower.pause(last)
        except MethodFaultError as error:
            self._on_fault(error)

    def _on_fault(self, error: MethodFaultError) -> None:
        """Stop, and log a fault of a user's method once."""
        self._follower.reset(ControlState.METHOD_FAILED)
        if str(error) != self._fault:
            self._fault = str(error)
            self.get_logger().error(f"{self._fault}\nThe robot stops.")

    def _stopped_if_stalled(
        self, inputs: FollowerInputs, output: FollowerOutput
    ) -> FollowerOutput:
        """Stop instead of pushing against an obstacle that no sensor detects."""
        pose = inputs.pose
        measured = (inputs.speed, inputs.turn_rate, inputs.side_speed)
        dt = 1 / self.params.rate_hz
        stalls = inputs.plausible and self._stall.update(
            self._commanded, pose, measured, dt, self._delay_s()
        )
        if output.state.moves and (stalls or self._stall.forbids(output.command, pose)):
            self._pause_follower(STOP)
            output = output._replace(command=STOP, state=ControlState.STALLED)
        self._commanded = output.command
        return output

    def _delay_s(self) -> float:
        """Return the time from a command until its motion is measured here.

        Twice the age of the newest odometry: there and back; the period of control is
        not a delay.
        """
        stamp_ns = self._tracker.stamp_ns
        age_s = 0.0 if stamp_ns is None else (self._now_ns - stamp_ns) / 1e9
        params = self.params
        return 2 * max(0.0, age_s - 1 / params.rate_hz)

    def _locate(self) -> None:
        jumps = self._tracker.jumps
        if self._odometry is not None and self._tracker.update(self._odometry):
            self._located_ns = self._odometry_ns
        self._odometry = None
        if self._tracker.jumps != jumps:
            self._relocate()

    def _relocate(self) -> None:
        """Follow the path from where the robot is on it after a jump of the pose."""
        self._obstacles.relocate()
        if self._follower.has_path:
            self._try_path(self._path)

    def _ages(self) -> InputAges:
        return InputAges(
            odometry_s=self._age_s(self._located_ns),
            costmap_s=self._age_s(self._placed_ns),
            # The client of a goal need not be alive: its path has an end.
            planner_s=0.0 if self._follows_goal else self._age_s(self._planner_ns),
            odometry_timeout_s=self._odometry_timeout_s,
            costmap_timeout_s=self._costmap_timeout_s,
        )

    def _age_s(self, arrival_ns: int) -> float:
        """Return seconds since an arrival; infinite for never and after a jump back."""
        age_ns = self._now_ns - arrival_ns
        return age_ns / 1e9 if arrival_ns != _NEVER and age_ns >= 0 else math.inf

    def _place_costmap(self) -> None:
        """Convert the newest costmap to obstacles once its pose is available."""
        if not (self.params.collision_check and self._follower.has_path):
            return
        obstacles = self._placed_obstacles(
            self._follower.obstacle_reach_m, self._follower.unseen_reach_m
        )
        if obstacles is not None and self._obstacles.placed_ns is not None:
            moving = self._moving.at(self._now_ns, _MOVING_TIMEOUT_S)
            if len(moving):
                here = self._tracker.predicted_now(self._now_ns) or UNKNOWN_POSE
                speed = math.hypot(self._tracker.velocity[0], self._tracker.side_speed)
                points = obstacles.points
                kept = counts_as_static(points, moving, here, speed, self.params)
                obstacles = obstacles._replace(points=points[kept])
            self._follower.set_obstacles(*obstacles)
            self._placed_ns = self._obstacles.placed_ns

    def _send(self, output: FollowerOutput) -> None:
        """Publish the command; at rest, ``idle_zeros`` zeros and then nothing."""
        if output.state.rests:
            if not self._zeros_left:
                return
            self._zeros_left -= 1
        twist = Twist()
        twist.linear.x, twist.angular.z, twist.linear.y = output.command
        self.publish(topics.CMD_VEL_NAV.name, twist)

    def situation(self) -> Situation:
        """Return what an explanation of a stop requires."""
        frame = self._odometry_frame
        return Situation(
            pose=self._tracker.latest,
            path=self._path,
            odometry_frame=frame,
            base_T_odometry=self._tracker.transform_to_base(frame) if frame else None,
            ages=self._ages(),
            odometry_arrived=self._odometry_ns != _NEVER,
        )
