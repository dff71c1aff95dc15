"""The controller: follow a path piece by piece."""

import copy
import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import ACKERMANN, Pose2
from navette.navigation.control.command_gate import InputAges
from navette.navigation.control.controller_parts import ControllerParts
from navette.navigation.control.drive import PieceDrive
from navette.navigation.control.follower import (
    BLOCKED_SCALE,
    BaseFollower,
    TrackingErrors,
    try_out,
)
from navette.navigation.control.limits import (
    STOP,
    VelocityCommand,
    approach,
    brake,
    clamp,
)
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece, Piece, split_path
from navette.navigation.control.records import (
    FollowerInputs,
    FollowerOutput,
    StepDecision,
)
from navette.navigation.control.rotate import TurnInPlace
from navette.navigation.control.states import ControlState, LimitedBy

_START_WINDOW_M = 2.0  # how far along a new path the robot may already be
_FREED_SCALE = 0.3  # share of the command from which a blocked robot starts again
_STOPPED_MPS = 0.05
# Changes of the curvature (1/m) that a blocked robot tries, and the share of the cruise
# speed at which it does: over 0.3 m they deviate by 5 cm from the steered arc.
_OTHER_CURVATURES = (-0.25, 0.25, -0.5, 0.5, -0.75, 0.75, -1.0, 1.0)
_SLOW_SHARE = 0.3


class PathFollower(BaseFollower):
    """Follow paths of poses; :meth:`step` returns the next command.

    Without a path or with invalid inputs the command is zero.
    """

    def __init__(self, params: ControlParams) -> None:
        self._parts = ControllerParts.of(params)
        super().__init__(params, self._parts.collision)

    def warm_up(self) -> None:
        try_out(copy.deepcopy(self))

    def reset(self, rest: ControlState = ControlState.IDLE) -> None:
        super().reset(rest)
        self._parts.steering.reset()
        self._pieces: list[Piece] = []
        self._active: PieceDrive | TurnInPlace | None = None
        self._goal = (0.0, 0.0)
        self._blocked = False

    def set_path(self, poses: NDArray[np.float64]) -> None:
        """Replace the path by (N, 3) x, y, yaw (m, rad, map); an empty one stops.

        A robot that already moves along the new path does not stop for it.

        Raises:
            InvalidValueError: not (N, 3) or not finite; the follower is then reset.
        """
        last, clearance = self._last, self._clearance
        self.reset()
        if len(poses) == 0:
            return
        self._pieces = split_path(poses, self._params)
        if self._params.drive == ACKERMANN:
            # A bend at a corner is the best that the steering can do.
            drives = (p for p in self._pieces if isinstance(p, DrivePiece))
            self._pieces = list(drives)
        self._goal = (float(poses[-1, 0]), float(poses[-1, 1]))
        self._rest = None
        self._last, self._clearance = last, clearance
        self._activate(_START_WINDOW_M)

    def pause(self, last: VelocityCommand | None = None) -> None:
        self._last = last
        self._parts.steering.reset()

    def step(self, inputs: FollowerInputs, dt: float) -> FollowerOutput:
        """Return the command for the next ``dt`` seconds.

        1. stop on stale inputs; 2. update the turn gain; 3. steer along the piece;
        4. accelerate within the limits; 5. slow down while inputs are late;
        6. keep clear of obstacles; 7. gate.
        """
        stopped = self._at_rest(inputs)
        if stopped is not None:
            return stopped
        last = self._last or self._measured(inputs)
        last = clamp(last, self._params)
        self._parts.turn_gain.update(last.turn_rate, inputs.turn_rate, dt)
        decision = self._steer(inputs)
        decision = decision._replace(
            command=self._speed_limits.applied_to(decision.command)
        )
        if decision.state.rests:
            return self._stop(decision.state)
        self._limited_by = decision.limited_by
        if decision.brakes:
            command = brake(last, self._params, dt)
        else:
            command = approach(last, decision.command, self._params, dt)
            if abs(command.speed) < abs(decision.command.speed) - 1e-6:
                self._limited_by = LimitedBy.ACCELERATION
        command = self._eased(command, inputs.ages)
        command, blocked = self._keep_clear(inputs.pose, decision, command)
        if blocked and abs(inputs.speed) < _STOPPED_MPS + abs(last.speed):
            other = self._other_arc(inputs.pose, decision.command)
            if other is not None:
                command = approach(last, other, self._params, dt)
                command, blocked = self._eased(command, inputs.ages), False
        state = ControlState.BLOCKED if blocked else decision.state
        return self._emit(command, state)

    def _steer(self, inputs: FollowerInputs) -> StepDecision:
        """Step the active piece; at its end the next one, at the last one stop."""
        while self._active is not None:
            decision = self._active.step(inputs)
            if decision is not None:
                return decision
            self._pieces.pop(0)
            self._activate()
        if abs(inputs.speed) > _STOPPED_MPS:
            return StepDecision(STOP, ControlState.FOLLOWING, brakes=True)
        missed = math.dist(self._goal, (inputs.pose.x, inputs.pose.y))
        reached = missed <= self._params.goal_tolerance_m
        self._rest = ControlState.REACHED if reached else ControlState.MISSED_GOAL
        return StepDecision(STOP, self._rest)

    def _activate(self, start_window: float = 0.3) -> None:
        """Start the first remaining piece."""
        if not self._pieces:
            self._active = None
            return
        piece = self._pieces[0]
        if isinstance(piece, DrivePiece):
            self._active = PieceDrive(piece, self._parts, start_window)
        else:
            self._active = TurnInPlace(piece.yaw, piece.turn, self._parts)

    def _eased(self, command: VelocityCommand, ages: InputAges) -> VelocityCommand:
        eased = self._gate.eased(command, ages)
        if eased != command:
            self._limited_by = LimitedBy.LATE_DATA
        return eased

    def _keep_clear(
        self, pose: Pose2, decision: StepDecision, command: VelocityCommand
    ) -> tuple[VelocityCommand, bool]:
        """Scale the command to what the obstacles allow; True if that is a stop."""
        self._scale = 1.0
        if not self._params.collision_check:
            return command, False
        # While blocked, check the full decision: the first small command from rest is
        # always free, and the robot would creep towards the obstacle.
        checked = clamp(decision.command, self._params) if self._blocked else command
        motion = VelocityCommand(
            checked.speed, checked.turn_rate * self._parts.turn_gain.value
        )
        scale, self._clearance = self._parts.collision.check(pose, motion)
        self._blocked = scale < (_FREED_SCALE if self._blocked else BLOCKED_SCALE)
        if self._blocked:
            if self._active is not None:
                self._active.reconsider()
            return STOP, True
        self._yield_to_moving(pose, motion, scale)
        return command.scaled(self._scale), False

    def _other_arc(
        self, pose: Pose2, wanted: VelocityCommand
    ) -> VelocityCommand | None:
        """Return a slow command on a free arc near the steered one; None: none is.

        Steering cuts corners by a few centimetres, which a path in a tight place does
        not leave. The robot would stand there, and each new path would be the same.
        The last arc is straight: beside a wall it stays free when no bend is.
        """
        params, gain = self._params, self._parts.turn_gain.value
        if not wanted.speed:
            return None
        slow = _SLOW_SHARE * (
            params.cruise_speed_mps if wanted.speed > 0 else -params.reverse_speed_mps
        )
        steered = wanted.turn_rate / wanted.speed
        curvatures = [steered + change for change in _OTHER_CURVATURES]
        for curvature in (*curvatures, 0.0):
            other = clamp(VelocityCommand(slow, slow * curvature), params)
            motion = other.speed, other.turn_rate * gain
            if self._parts.collision.check(pose, motion).scale == 1.0:
                return other
        return None

    def _errors(self) -> TrackingErrors:
        drive = self._active if isinstance(self._active, PieceDrive) else None
        left = drive.distance_left if drive else 0.0
        for piece in self._pieces[1 if drive else 0 :]:
            left += piece.length if isinstance(piece, DrivePiece) else 0.0
        if drive is None:
            return TrackingErrors(distance_left_m=left)
        return TrackingErrors(drive.at.cross_track, drive.at.heading_error, left)
