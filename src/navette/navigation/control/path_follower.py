"""The controller: follow a path piece by piece."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import ACKERMANN, Footprint, Pose2
from navette.navigation.control.command_gate import CommandGate, InputAges
from navette.navigation.control.controller_parts import ControllerParts
from navette.navigation.control.drive import PieceDrive
from navette.navigation.control.limits import (
    NO_CAP,
    STOP,
    SpeedCap,
    VelocityCommand,
    approach,
    brake,
    clamp,
)
from navette.navigation.control.moving_obstacles import safe_share
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece, Piece, split_path
from navette.navigation.control.records import (
    FollowerInputs,
    FollowerOutput,
    StepDecision,
)
from navette.navigation.control.rotate import TurnInPlace
from navette.navigation.control.states import ControlState, LimitedBy
from navette.navigation.grids import NO_DISCS, NONE_UNSEEN

_START_WINDOW_M = 2.0  # how far along a new path the robot may already be
_BLOCKED_SCALE = 0.1  # below this share of the command the robot is blocked …
_FREED_SCALE = 0.3  # … and starts again only above this
_STOPPED_MPS = 0.05


class PathFollower:
    """Follow paths of poses; :meth:`step` returns the next command.

    Without a path or with invalid inputs the command is zero.
    """

    def __init__(self, params: ControlParams) -> None:
        self._params = params
        self._gate = CommandGate(params)
        self._parts = ControllerParts.of(params)
        self._speed_limits = NO_CAP
        self._discs = NO_DISCS
        self._body_m = Footprint.from_flat(params.footprint_m).circumscribed_radius
        self.reset()

    def reset(self, rest: ControlState = ControlState.IDLE) -> None:
        """Drop the path and stop at once; ``rest`` is the state to report."""
        self._parts.steering.reset()
        self._pieces: list[Piece] = []
        self._active: PieceDrive | TurnInPlace | None = None
        self._goal = (0.0, 0.0)
        self._rest: ControlState | None = rest
        self._last: VelocityCommand | None = None
        self._clearance = math.inf
        self._scale = 1.0
        self._limited_by = LimitedBy.NONE
        self._blocked = False

    @property
    def has_path(self) -> bool:
        """Whether a path is being followed."""
        return self._rest is None

    @property
    def obstacle_reach_m(self) -> float:
        """Distance around the robot within which obstacles matter."""
        return self._parts.collision.reach(self._params.max_speed_mps)

    @property
    def unseen_reach_m(self) -> float:
        """Distance around the robot within which unseen space matters."""
        return self._parts.collision.reach(self._params.reverse_speed_mps)

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

    def pause(self) -> None:
        """Continue later from the robot's motion then, not from the last command."""
        self._last = None
        self._parts.steering.reset()

    def set_obstacles(
        self,
        points: NDArray[np.float64],
        half_cell: float,
        unseen: NDArray[np.float64] = NONE_UNSEEN,
    ) -> None:
        """Store the values of :class:`navette.navigation.grids.Obstacles`."""
        self._parts.collision.set_obstacles(points, half_cell, unseen)

    def set_moving(self, discs: NDArray[np.float64]) -> None:
        """Store moving obstacles (M, 5) x, y, vx, vy, radius; map, now."""
        self._discs = discs

    def limit_speed(self, limits: SpeedCap) -> None:
        """Drive no faster than these limits, from the next step on."""
        self._speed_limits = limits

    def step(self, inputs: FollowerInputs, dt: float) -> FollowerOutput:
        """Return the command for the next ``dt`` seconds.

        1. stop on stale inputs; 2. update the turn gain; 3. steer along the piece;
        4. accelerate within the limits; 5. slow down while inputs are late;
        6. keep clear of obstacles; 7. gate.
        """
        stale = self._gate.stale(inputs.ages)
        if self._rest is not None or stale is not None or not inputs.plausible:
            output = self._stop(self._rest or stale or ControlState.STALE_ODOMETRY)
            self._last = None  # continue from the measured motion
            return output
        last = self._last or VelocityCommand(inputs.speed, inputs.turn_rate)
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
        self._blocked = scale < (_FREED_SCALE if self._blocked else _BLOCKED_SCALE)
        if self._blocked:
            if self._active is not None:
                self._active.reconsider()
            return STOP, True
        margin_m = self._params.moving_clearance_m / 2
        arc = motion.speed, motion.turn_rate
        yielding = safe_share(pose, arc, self._discs, self._body_m, margin_m)
        self._scale = scale = min(1.0, scale, yielding)
        if scale < 1.0:
            self._limited_by = LimitedBy.COLLISION_CHECK
        return command.scaled(scale), False

    def _stop(self, state: ControlState) -> FollowerOutput:
        return self._emit(STOP, state)

    def _emit(self, command: VelocityCommand, state: ControlState) -> FollowerOutput:
        """Pass the command through the gate and store it as the last one."""
        refusal = self._gate.refusal(command)
        if refusal is not None:
            command, state = STOP, refusal
        # At rest an operator may drive: start again from the measured motion.
        self._last = command if self._rest is None else None
        drive = self._active if isinstance(self._active, PieceDrive) else None
        left = drive.distance_left if drive else 0.0
        for piece in self._pieces[1 if drive else 0 :]:
            left += piece.length if isinstance(piece, DrivePiece) else 0.0
        return FollowerOutput(
            command,
            state,
            drive.at.cross_track if drive else 0.0,
            drive.at.heading_error if drive else 0.0,
            left,
            self._clearance,
            self._scale,
            self._limited_by,
        )
