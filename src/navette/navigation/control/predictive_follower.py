"""Follow a path by model-predictive path integral control."""

import copy
import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.geometry import ACKERMANN, Footprint, Pose2, advanced, wrap_angles
from navette.navigation.control.command_gate import CommandGate
from navette.navigation.control.controller_parts import TurnParts
from navette.navigation.control.follower import (
    BLOCKED_SCALE,
    BaseFollower,
    TrackingErrors,
    try_out,
)
from navette.navigation.control.limits import (
    STOP,
    SpeedCap,
    VelocityCommand,
    approach,
    brake,
    clamp,
)
from navette.navigation.control.local_field import local_field, open_field
from navette.navigation.control.methods import CONTROLLERS
from navette.navigation.control.mppi import MotionState, Mppi
from navette.navigation.control.params import ControlParams
from navette.navigation.control.records import (
    FollowerInputs,
    FollowerOutput,
    Rollouts,
    check_poses,
)
from navette.navigation.control.rollouts import (
    METRES_PER_RADIAN,
    PathWindow,
    RolloutBody,
)
from navette.navigation.control.rotate import TurnInPlace
from navette.navigation.control.states import ControlState, LimitedBy
from navette.navigation.grids import (
    NONE_UNSEEN,
    body_points,
)

_CELL_M = 0.05  # of the distance field
_FIELD_MARGIN_M = 0.15  # distances beyond clearance, body and this are not used
_DELAY_S = 0.05  # from the command to the motion
_BEHIND = 2  # poses of the path behind the robot that stay in the window
_SEARCH_M = 2.0  # how far ahead on the path the robot may already be
_BODY_REACH_M = 1.0  # of the robot and the clearance that it keeps
_BODY_SPACING_M = 0.15  # of the points that represent the body in rollouts
# Rest of the path, turns included, at which its end is reached, and the heading error
# there of a drive that cannot turn in place.
_END_M = 0.15
_END_YAW_RAD = 0.08
# This near to a change of direction, a robot that drives in the new direction at this
# speed has made it.
_CUSP_M, _CUSP_MPS = 0.25, 0.05
# Commands below these for this long: no rollout is better than to stand.
_STILL_MPS, _STILL_RADPS, _STILL_S = 0.02, 0.05, 2.0


class _Mode(NamedTuple):
    """Limits of the motion, with the gate and the optimiser for them."""

    params: ControlParams
    gate: CommandGate
    mppi: Mppi

    @classmethod
    def of(
        cls, params: ControlParams, body: NDArray[np.float64], *, swerves: bool
    ) -> "_Mode":
        mppi = Mppi(params, body, swerves=swerves)
        return cls(params, CommandGate(params), mppi)


@CONTROLLERS.register("mppi")
class PredictiveFollower(BaseFollower):
    """Follow paths of poses by sampling command sequences."""

    Params = ControlParams

    def __init__(self, params: ControlParams) -> None:
        self._parts = TurnParts.of(params)
        footprint = Footprint.from_flat(params.footprint_m)
        self._body = body_points(footprint, _BODY_SPACING_M)
        self._body_reach_m = RolloutBody.of(self._body).reach_m
        self._calm = _Mode.of(params, self._body, swerves=False)
        self._evasive = _Mode.of(evasive(params), self._body, swerves=True)
        self._mode = self._calm
        self._field = open_field()
        super().__init__(params, self._parts.collision)

    def warm_up(self) -> None:
        try_out(copy.deepcopy(self))

    def reset(self, rest: ControlState = ControlState.IDLE) -> None:
        super().reset(rest)
        self._path: PathWindow | None = None
        self._at = self._first = 0
        self._last_turn: TurnInPlace | None = None
        self._cross_track = self._heading_error = 0.0
        self._sampled_at: MotionState | None = None  # of the last step
        self._still_s = 0.0
        self._mode.mppi.reset()

    @property
    def obstacle_reach_m(self) -> float:
        reach_m = self._params.cruise_speed_mps * self._mode.mppi.horizon_s + 0.5
        return max(super().obstacle_reach_m, reach_m)

    @property
    def unseen_reach_m(self) -> float:
        return self._collision.reach(self._evasive.params.reverse_speed_mps)

    def set_path(self, poses: NDArray[np.float64]) -> None:
        try:
            check_poses(poses)
        except InvalidValueError:
            self.reset()
            raise
        last, clearance, drove = self._last, self._clearance, self.has_path
        if len(poses) == 0:
            self.reset()
            return
        if not drove:
            self.reset()
        self._path = _window(poses)
        self._at = self._first = 0
        self._last_turn = None
        self._rest = None
        self._last, self._clearance = last, clearance

    def pause(self, last: VelocityCommand | None = None) -> None:
        self._last = last
        self._mode.mppi.reset()

    def set_obstacles(
        self,
        points: NDArray[np.float64],
        half_cell: float,
        unseen: NDArray[np.float64] = NONE_UNSEEN,
    ) -> None:
        super().set_obstacles(points, half_cell, unseen)
        reach_m = self._params.mppi_clearance_m + self._body_reach_m + _FIELD_MARGIN_M
        self._field = local_field(
            points,
            _CELL_M,
            reach_m,
            half_cell,
        )

    def step(self, inputs: FollowerInputs, dt: float) -> FollowerOutput:
        self._sampled_at = None
        stopped = self._at_rest(inputs)
        if stopped is not None:
            return stopped
        assert self._path is not None, "a path is being followed"
        self._scale, self._limited_by = 1.0, LimitedBy.NONE
        self._advance(self._path, inputs)
        last = self._last or self._measured(inputs)
        if self._arrived(self._path, inputs):
            turning = self._turn_to_end(self._path, inputs, last, dt)
            return turning or self._come_to_rest(last, dt)
        self._last_turn = None
        discs = self._near_discs(inputs.pose)
        self._choose_mode(self._evasive if len(discs) else self._calm)
        params = self._mode.params
        last = clamp(last, params)
        deviates = abs(self._cross_track) > params.max_deviation_m
        if deviates and not len(discs):  # to avoid something may require it
            return self._emit(brake(last, params, dt), ControlState.OFF_PATH)
        self._mode.mppi.limit_speed(self._limits_at(inputs.pose))
        ahead = advanced(
            inputs.pose, last.speed, last.turn_rate, _DELAY_S, side=last.side
        )
        self._sampled_at = MotionState(*ahead, *last)
        wanted = self._mode.mppi.step(
            self._sampled_at,
            self._near(self._path),
            self._field,
            dt,
            discs,
        )
        command = approach(last, wanted, params, dt)
        eased = self._gate.eased(command, inputs.ages)
        output = self._keep_clear(inputs.pose, eased)
        if output.state == ControlState.BLOCKED and last == STOP:
            return self._free_start(inputs, dt) or output
        self._still_s = self._still_s + dt if _is_still(output.command) else 0.0
        if self._still_s > _STILL_S and not len(discs):
            # The planner may know another path.
            return output._replace(state=ControlState.BLOCKED)
        return output

    def rollouts(self, most: int) -> Rollouts | None:
        if self._sampled_at is None:
            return None
        return self._mode.mppi.rollouts(self._sampled_at, most)

    def _free_start(self, inputs: FollowerInputs, dt: float) -> FollowerOutput | None:
        """Start with the cheapest candidate that the obstacles allow; None: stand.

        At rest their mean can be refused at every step alike: between the points that
        represent the body in rollouts, a post is up to a centimetre nearer.
        """
        for wanted in self._mode.mppi.alternatives():
            command = approach(STOP, wanted, self._mode.params, dt)
            eased = self._gate.eased(command, inputs.ages)
            is_free = self._collision.check(inputs.pose, eased).scale == 1.0
            if is_free and eased != STOP:
                return self._emit(eased, ControlState.FOLLOWING)
        return None

    def _near_discs(self, pose: Pose2) -> NDArray[np.float64]:
        """Return the moving obstacles that the robot can meet within the horizon."""
        discs = self._discs
        if not len(discs):
            return discs
        away = np.hypot(discs[:, 0] - pose.x, discs[:, 1] - pose.y)
        speeds = np.hypot(discs[:, 2], discs[:, 3]) + self._params.cruise_speed_mps
        reach = speeds * self._calm.mppi.horizon_s + discs[:, 4] + _BODY_REACH_M
        return discs[away <= reach]

    def _choose_mode(self, mode: "_Mode") -> None:
        if mode is not self._mode:
            mode.mppi.continue_from(self._mode.mppi)
            self._mode, self._gate = mode, mode.gate

    def _turn_to_end(
        self,
        path: PathWindow,
        inputs: FollowerInputs,
        last: VelocityCommand,
        dt: float,
    ) -> FollowerOutput | None:
        """Turn in place to the heading at the end, more exactly than samples do.

        None when the heading is reached or the path requires none.
        """
        params = self._params
        if path.direction[-1] != 0 or params.drive == ACKERMANN:
            return None
        if self._last_turn is None:
            end = math.atan2(path.sin[-1], path.cos[-1])
            self._last_turn = TurnInPlace(end, 0.0, self._parts, both_directions=False)
        decision = self._last_turn.step(inputs)
        if decision is None:
            return None
        last = clamp(last, params)
        if decision.brakes:
            return self._emit(brake(last, params, dt), decision.state)
        self._parts.turn_gain.update(last.turn_rate, inputs.turn_rate, dt)
        command = approach(last, decision.command, params, dt)
        eased = self._gate.eased(command, inputs.ages)
        return self._keep_clear(inputs.pose, eased)

    def _come_to_rest(self, last: VelocityCommand, dt: float) -> FollowerOutput:
        """Brake at the end of the path; the path ends at rest."""
        command = brake(clamp(last, self._params), self._params, dt)
        if command != STOP:
            return self._emit(command, ControlState.FOLLOWING)
        self._rest = ControlState.REACHED
        return self._stop(ControlState.REACHED)

    def _limits_at(self, pose: Pose2) -> SpeedCap:
        """Return the limits; in reverse also that of space that was never seen."""
        reverse = min(self._mode.params.reverse_speed_mps, self._speed_limits.reverse)
        seen = self._collision.reverse_share(pose, reverse)
        return SpeedCap(self._speed_limits.forward, seen * reverse)

    def _keep_clear(self, pose: Pose2, command: VelocityCommand) -> FollowerOutput:
        """Scale the command to what the obstacles allow, at worst a stop."""
        if not self._params.collision_check:
            return self._emit(command, ControlState.FOLLOWING)
        scale, self._clearance = self._collision.check(pose, command)
        if scale < BLOCKED_SCALE:
            return self._emit(STOP, ControlState.BLOCKED)
        self._set_scale(min(1.0, scale))
        return self._emit(command.scaled(self._scale), ControlState.FOLLOWING)

    def _advance(self, path: PathWindow, inputs: FollowerInputs) -> None:
        """Move to the pose of the path nearest to the robot; never back.

        Rollouts often turn round before a cusp. The robot then drives over the poses
        before it again: matched with those, no motion is progress, and it would stand.
        """
        pose = inputs.pose
        c, s = math.cos(pose.yaw), math.sin(pose.yaw)
        here = pose.x, pose.y, c, s
        at = _nearest_index(path, self._at, _SEARCH_M, here)
        cusp = _cusp_made(path, at, inputs.speed)
        if cusp is not None:
            self._first, at = cusp, _nearest_index(path, cusp, _SEARCH_M, here)
        self._at = at
        dx, dy = pose.x - float(path.x[at]), pose.y - float(path.y[at])
        path_c, path_s = float(path.cos[at]), float(path.sin[at])
        self._cross_track = math.copysign(math.hypot(dx, dy), path_c * dy - path_s * dx)
        error = math.acos(max(-1.0, min(1.0, c * path_c + s * path_s)))
        self._heading_error = math.copysign(error, path_c * s - path_s * c)

    def _near(self, path: PathWindow) -> PathWindow:
        """Return the stretch that the robot can drive within the horizon."""
        first = max(self._first, self._at - _BEHIND)
        reach = self._params.cruise_speed_mps * self._mode.mppi.horizon_s + 0.5
        stop = int(path.measure.searchsorted(path.measure[self._at] + reach)) + 1
        near = slice(first, stop)
        return PathWindow(
            path.x[near],
            path.y[near],
            path.cos[near],
            path.sin[near],
            path.measure[near],
            path.direction[near],
        )

    def _arrived(self, path: PathWindow, inputs: FollowerInputs) -> bool:
        off = math.hypot(path.x[-1] - inputs.pose.x, path.y[-1] - inputs.pose.y)
        left = path.measure[-1] - path.measure[self._at]
        if off > self._params.goal_tolerance_m or left > _END_M:
            return False
        c, s = math.cos(inputs.pose.yaw), math.sin(inputs.pose.yaw)
        # A path that ends with a turn in place ends with a required heading; others
        # have the least turn left within ``_END_M``.
        if path.direction[-1] != 0 or self._params.drive != ACKERMANN:
            return True
        turned = c * path.cos[-1] + s * path.sin[-1]
        return bool(turned >= math.cos(_END_YAW_RAD))

    def _stop(self, state: ControlState) -> FollowerOutput:
        self._mode.mppi.reset()
        return super()._stop(state)

    def _errors(self) -> TrackingErrors:
        left = 0.0
        if self._path is not None and self.has_path:
            left = float(self._path.measure[-1] - self._path.measure[self._at])
        return TrackingErrors(self._cross_track, self._heading_error, left)


def evasive(params: ControlParams) -> ControlParams:
    """Return the parameters with the limits for avoiding moving obstacles."""
    factor = params.evasion_factor
    return replace(
        params,
        reverse_speed_mps=min(
            factor * params.reverse_speed_mps, params.cruise_speed_mps
        ),
        max_turn_rate_radps=factor * params.max_turn_rate_radps,
        acceleration_mps2=factor * params.acceleration_mps2,
        deceleration_mps2=factor * params.deceleration_mps2,
        turn_acceleration_radps2=factor * params.turn_acceleration_radps2,
        lateral_acceleration_mps2=factor * params.lateral_acceleration_mps2,
    )


@kernel
def _nearest_index(
    path: PathWindow, at: int, ahead_m: float, pose: tuple[float, float, float, float]
) -> int:
    """Return the index of the pose nearest to x, y, cos, sin, as for other followers.

    See :func:`navette.navigation.control.follower.nearest_index`.
    """
    x, y, c, s = pose
    count = path.measure.size
    while True:
        limit = path.measure[at] + ahead_m
        best, least, i = at, np.inf, at
        while i == at or (i < count and path.measure[i] < limit):
            cosine = min(1.0, max(-1.0, c * path.cos[i] + s * path.sin[i]))
            away = math.hypot(x - path.x[i], y - path.y[i])
            there = away + METRES_PER_RADIAN * math.acos(cosine)
            if there < least:
                best, least = i, there
            i += 1
        if best == at or best + 1 < i:
            return best
        at = best


def _is_still(command: VelocityCommand) -> bool:
    speed = max(abs(command.speed), abs(command.side))
    return speed < _STILL_MPS and abs(command.turn_rate) < _STILL_RADPS


def _cusp_made(path: PathWindow, at: int, speed: float) -> int | None:
    """Return the index of the next change of direction if the robot has made it."""
    direction = path.direction[at]
    if direction * speed > -_CUSP_MPS:
        return None
    stop = int(np.searchsorted(path.measure, path.measure[at] + _CUSP_M, "right"))
    others = np.flatnonzero(path.direction[at:stop] != direction)
    if not len(others) or path.direction[at + others[0]] == 0:
        return None
    return at + int(others[0])


def _window(poses: NDArray[np.float64]) -> PathWindow:
    steps = np.diff(poses[:, :2], axis=0)
    metres = np.hypot(steps[:, 0], steps[:, 1])
    turned = np.abs(wrap_angles(np.diff(poses[:, 2])))
    spin = np.where(metres < 1e-6, METRES_PER_RADIAN * turned, 0.0)
    measure = np.concatenate([[0.0], np.cumsum(metres + spin)])
    along = steps[:, 0] * np.cos(poses[:-1, 2]) + steps[:, 1] * np.sin(poses[:-1, 2])
    direction = np.where(along >= 0, 1, -1).astype(np.int8)
    direction[metres < 1e-6] = 0
    direction = np.append(direction, direction[-1:] if len(direction) else [0])
    x, y, yaw = np.ascontiguousarray(poses.T)
    return PathWindow(
        x, y, np.cos(yaw), np.sin(yaw), measure, direction.astype(np.int8)
    )
