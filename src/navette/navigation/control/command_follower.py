"""Follow a path by a function of state, path and obstacles that returns a command."""

import math
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference
from navette.navigation.control.controller_parts import collision_check
from navette.navigation.control.follower import (
    BLOCKED_SCALE,
    BaseFollower,
    TrackingErrors,
    nearest_index,
)
from navette.navigation.control.limits import (
    SpeedCap,
    VelocityCommand,
    approach,
    brake,
    clamp,
)
from navette.navigation.control.params import ControlParams
from navette.navigation.control.records import (
    FollowerInputs,
    FollowerOutput,
    check_poses,
)
from navette.navigation.control.speed_profile import approach_speed
from navette.navigation.control.states import ControlState, LimitedBy
from navette.navigation.grids import NONE_UNSEEN, disc_outlines
from navette.params.plugins import checked_array, own_call

_AHEAD_M = 2.0  # how far along the path the robot may be beyond the last place
_OBSTACLES_M = 6.0  # distance around the robot within which obstacles are given
_STOPPED_MPS = 0.05


class DriveState(NamedTuple):
    """State of the robot for a controller; map frame."""

    x: float
    """m"""
    y: float
    """m"""
    yaw: float
    """rad"""
    speed: float
    """forward, m/s"""
    turn_rate: float
    """counter-clockwise, rad/s"""
    dt: float
    """time until the next call, s"""
    side_speed: float = 0.0
    """to the left, m/s"""


class CommandMethod(Protocol):
    """A controller as a function of arrays.

    With an attribute ``end_heading_tolerance_rad`` the path ends only with its last
    heading.
    """

    def command(
        self,
        state: DriveState,
        path: NDArray[np.float64],
        obstacles: NDArray[np.float64],
    ) -> Any:
        """Return the speed (m/s) and the turn rate (rad/s).

        A third value is the speed to the left (m/s) of an omnidirectional drive.

        Args:
            state: of the robot.
            path: (N, 3) x, y, yaw (m, rad, map) from the pose nearest to the robot on.
            obstacles: (M, 2) x, y (m, map) of occupied cells near the robot, and of the
                outlines of what moves.
        """


class CommandFollower(BaseFollower):
    """Follow paths with a :class:`CommandMethod`.

    The method chooses the command. Stale inputs, the limits of speed and acceleration,
    the collision check and the end of the path are handled here.

    Args:
        params: limits and tolerances.
        method: the user's object.
        name: its name, for errors.
    """

    def __init__(self, params: ControlParams, method: CommandMethod, name: str) -> None:
        self._method = method
        self._name = f"controller {name}: command(state, path, obstacles)"
        self._obstacles = np.empty((0, 2))
        super().__init__(params, collision_check(params))

    def reset(self, rest: ControlState = ControlState.IDLE) -> None:
        super().reset(rest)
        self._path = np.empty((0, 3))
        self._measure = np.empty(0)
        self._at = 0
        self._cross_track = self._heading_error = 0.0

    @property
    def obstacle_reach_m(self) -> float:
        return max(super().obstacle_reach_m, _OBSTACLES_M)

    @property
    def unseen_reach_m(self) -> float:
        # The method may drive backwards at full speed.
        return self._collision.reach(self._params.max_speed_mps)

    def set_path(self, poses: NDArray[np.float64]) -> None:
        last, drove = self._last, self.has_path
        self.reset()
        if len(poses) == 0:
            return
        check_poses(poses)
        steps = np.diff(poses[:, :2], axis=0)
        self._path = poses
        self._measure = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
        self._rest, self._last = None, last
        if not drove:
            self._restart()

    def set_obstacles(
        self,
        points: NDArray[np.float64],
        half_cell: float,
        unseen: NDArray[np.float64] = NONE_UNSEEN,
    ) -> None:
        super().set_obstacles(points, half_cell, unseen)
        self._obstacles = points

    def pause(self, last: VelocityCommand | None = None) -> None:
        self._last = last
        self._restart()

    def step(self, inputs: FollowerInputs, dt: float) -> FollowerOutput:
        """Return the command for the next ``dt`` seconds.

        Raises:
            MethodFaultError: the method raised or returned something else.
        """
        stopped = self._at_rest(inputs)
        if stopped is not None:
            return stopped
        last = clamp(self._last or self._measured(inputs), self._params)
        self._advance(inputs.pose)
        if self._ends(inputs):
            if self._measured(inputs).planar_speed > _STOPPED_MPS:
                command = brake(last, self._params, dt)
                return self._emit(command, ControlState.FOLLOWING)
            self._rest = ControlState.REACHED
            return self._stop(ControlState.REACHED)
        if abs(self._cross_track) > self._params.max_deviation_m:
            return self._emit(brake(last, self._params, dt), ControlState.OFF_PATH)
        wanted = self._speed_limits.applied_to(self._wanted(inputs, dt))
        stopping = self._stopping(inputs).applied_to(wanted)
        if self._params.max_side_speed_mps > 0.0:
            # Its heading is apart from its motion: it may still turn at the end.
            stopping = stopping._replace(turn_rate=wanted.turn_rate)
        command = approach(last, stopping, self._params, dt)
        if stopping != wanted:
            self._limited_by = LimitedBy.PATH_END
        elif command != wanted:
            self._limited_by = LimitedBy.ACCELERATION
        else:
            self._limited_by = LimitedBy.NONE
        eased = self._gate.eased(command, inputs.ages)
        return self._keep_clear(inputs.pose, eased, brake(last, self._params, dt))

    def _stopping(self, inputs: FollowerInputs) -> SpeedCap:
        """Return the limits from which the robot can stop at the end of the path."""
        left = max(self._left_m, self._end_m(inputs.pose))
        speed = self._measured(inputs).planar_speed
        limit = approach_speed(left, speed, self._params)
        return SpeedCap(limit, limit)

    def _wanted(self, inputs: FollowerInputs, dt: float) -> VelocityCommand:
        motion = inputs.speed, inputs.turn_rate
        state = DriveState(*inputs.pose, *motion, dt, inputs.side_speed)
        returned = own_call(
            self._name,
            self._method.command,
            state,
            self._path[self._at :].copy(),
            np.concatenate([self._obstacles, disc_outlines(self._discs)]),
        )
        expected = "(speed, turn rate[, speed to the left]) in m/s and rad/s"
        values = checked_array(
            self._name, returned, expected, lambda shape: shape in ((2,), (3,))
        )
        return VelocityCommand(*values.tolist())

    def _keep_clear(
        self, pose: Pose2, command: VelocityCommand, braked: VelocityCommand
    ) -> FollowerOutput:
        """Scale the command to what the obstacles allow, at worst a stop.

        The robot cannot slow down at once. Where a new arc would require that, it
        brakes on the arc that it is driving, on which it was found free to stop.
        """
        if not self._params.collision_check:
            return self._emit(command, ControlState.FOLLOWING)
        scale, self._clearance = self._collision.check(pose, command)
        is_sudden = scale * command.planar_speed < braked.planar_speed
        if scale < 1.0 and is_sudden and self._collision.check(pose, braked).scale == 1:
            command, scale = braked, 1.0
            self._limited_by = LimitedBy.COLLISION_CHECK
        if scale < BLOCKED_SCALE:
            return self._stop(ControlState.BLOCKED)
        self._yield_to_moving(pose, command, scale)
        return self._emit(command.scaled(self._scale), ControlState.FOLLOWING)

    def _advance(self, pose: Pose2) -> None:
        """Move to the pose of the path nearest to the robot; never back."""
        self._at = nearest_index(
            self._measure,
            self._at,
            _AHEAD_M,
            lambda near: np.hypot(
                pose.x - self._path[near, 0], pose.y - self._path[near, 1]
            ),
        )
        x, y, yaw = self._path[self._at].tolist()
        dx, dy = pose.x - x, pose.y - y
        side = math.cos(yaw) * dy - math.sin(yaw) * dx
        self._cross_track = math.copysign(math.hypot(dx, dy), side)
        self._heading_error = angle_difference(pose.yaw, yaw)

    def _ends(self, inputs: FollowerInputs) -> bool:
        """Return whether the robot is at the end of the path."""
        tolerance = self._params.goal_tolerance_m
        if self._end_m(inputs.pose) > tolerance or self._left_m > tolerance:
            return False
        most = getattr(self._method, "end_heading_tolerance_rad", math.pi)
        error = angle_difference(inputs.pose.yaw, float(self._path[-1, 2]))
        return abs(error) <= most

    def _end_m(self, pose: Pose2) -> float:
        """Return the distance to the end of the path."""
        return math.dist(self._path[-1, :2], (pose.x, pose.y))

    @property
    def _left_m(self) -> float:
        """Length of the path that is left."""
        return float(self._measure[-1] - self._measure[self._at])

    def _restart(self) -> None:
        """Reset what the method has accumulated, if it supports that."""
        restart = getattr(self._method, "reset", None)
        if restart is not None:
            own_call(self._name, restart)

    def _errors(self) -> TrackingErrors:
        left = self._left_m if self.has_path else 0.0
        return TrackingErrors(self._cross_track, self._heading_error, left)
