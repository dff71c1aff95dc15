"""Drive along one piece of the path: turn to it, steer, choose the speed."""

import math

from navette.geometry import ACKERMANN, wrap_angle
from navette.navigation.control.controller_parts import ControllerParts
from navette.navigation.control.limits import STOP, VelocityCommand
from navette.navigation.control.path_pieces import DrivePiece
from navette.navigation.control.piece_progress import PathPoint, PieceProgress
from navette.navigation.control.predicted_motion import PredictedMotion
from navette.navigation.control.records import FollowerInputs, StepDecision
from navette.navigation.control.rotate import STANDSTILL_MPS, TurnInPlace
from navette.navigation.control.speed_profile import (
    approach_speed,
    cruise_speed,
    speed_profile,
    stopping_distance,
)
from navette.navigation.control.states import ControlState, LimitedBy

_HYSTERESIS_RAD = 0.4  # additional heading error that a moving robot tolerates
_SLOWEST = 0.3  # least share of the speed at low clearance or a heading error
_ALIGNED = 0.95  # cosine of a heading error that hardly slows the robot down
_PREVIEW_S = 0.15  # delay of the drive
_STOP_SHARE = 0.3  # of the goal tolerance: distance at which a piece is complete
_ROUNDING_MPS = 1e-9


class PieceDrive:
    """Drive one :class:`DrivePiece` to its end.

    Args:
        piece: the stretch to drive.
        parts: parameters and shared parts of the controller.
        start_window: how far along the piece (m) the robot may already be.
    """

    def __init__(
        self, piece: DrivePiece, parts: ControllerParts, start_window: float
    ) -> None:
        self._piece = piece
        self._parts = parts
        self._cruise = cruise_speed(piece, parts.params)
        self._speeds = speed_profile(piece, parts.params)
        self._progress = PieceProgress(piece, start_window)
        self._predicted = PredictedMotion(piece)
        self._turn: TurnInPlace | None = None
        self.at = PathPoint(0, 0.0, 0.0, 0.0)

    @property
    def distance_left(self) -> float:
        """Arc length (m) to the end of the piece."""
        return max(0.0, self._piece.length - self.at.s)

    def step(self, inputs: FollowerInputs) -> StepDecision | None:
        """Return the next command, or None at the end of the piece."""
        parts, params = self._parts, self._parts.params
        self.at = at = self._progress.update(inputs.pose)
        if self._piece.length - at.s <= _STOP_SHARE * params.goal_tolerance_m:
            return None
        if abs(at.cross_track) > params.max_deviation_m:
            return StepDecision(STOP, ControlState.OFF_PATH, brakes=True)
        turning = self._turn_first(inputs)
        if turning is not None:
            return turning
        if inputs.speed * self._piece.direction < -STANDSTILL_MPS:
            return StepDecision(STOP, ControlState.FOLLOWING, brakes=True)
        kappa = parts.steering.curvature(self._piece, at, inputs.pose, inputs.speed)
        speed, cause = self._speed(kappa, inputs.speed)
        v = speed * self._piece.direction
        command = VelocityCommand(v, v * kappa / parts.turn_gain.value)
        return StepDecision(command, ControlState.FOLLOWING, limited_by=cause)

    def reconsider(self) -> None:
        """Choose the direction of a turn again: the chosen one is blocked."""
        if self._turn is not None:
            self._turn.reconsider()

    def _turn_first(self, inputs: FollowerInputs) -> StepDecision | None:
        """Turn in place to the path while the heading error is too large to drive."""
        params = self._parts.params
        if params.drive == ACKERMANN:
            return None
        if self._turn is None:
            error = abs(self.at.heading_error)
            moving = abs(inputs.speed) > STANDSTILL_MPS
            tolerable = params.rotate_above_rad + _HYSTERESIS_RAD
            if error <= (tolerable if moving else params.rotate_above_rad):
                return None
            travel = self._piece.heading[self.at.sample]
            back = math.pi if self._piece.direction < 0 else 0.0
            self._turn = TurnInPlace(
                wrap_angle(travel + back),
                0.0,
                self._parts,
                # For a small error, steering beats a turn of nearly 360°.
                both_directions=error > tolerable,
            )
        decision = self._turn.step(inputs)
        if decision is None or (
            decision.state is ControlState.BLOCKED and not self._turn.both_directions
        ):
            self._turn = None
            return None
        return decision

    def _free_m(self, speed: float) -> float:
        """Return the distance (m) to a collision along the predicted motion."""
        params = self._parts.params
        if not params.collision_check:
            return math.inf
        v = max(abs(speed), self._cruise)
        ahead = stopping_distance(v, params)
        poses = self._predicted.poses(self.at, ahead, params.lookahead_m)
        tight = self._parts.collision.first_tight(poses)
        if tight == len(poses):
            return math.inf
        first = min(self.at.sample + 1, len(self._piece.s) - 1)
        return max(0.0, self._piece.s[first + max(0, tight - 1)] - self.at.s)

    def _speed(self, kappa: float, speed: float) -> tuple[float, LimitedBy]:
        """Return the least of the limits, and which one that is."""
        params = self._parts.params
        ahead = self._piece.index_at(self.at.s + _PREVIEW_S * abs(speed))
        left = self._piece.length - self.at.s
        bend = min(self._speeds[self.at.sample], self._speeds[ahead])
        if kappa:
            turn_rate = params.max_turn_rate_radps * self._parts.turn_gain.value
            bend = min(bend, turn_rate / abs(kappa))
        limits = [
            (self._cruise, LimitedBy.NONE),
            (bend, LimitedBy.BEND),
            (approach_speed(left, speed, params), LimitedBy.PATH_END),
        ]
        v, cause = min(limits)
        if cause is LimitedBy.BEND and self._cruise - v < _ROUNDING_MPS:
            cause = LimitedBy.NONE  # the profile of a straight stretch, rounded
        aligned = math.cos(self.at.heading_error)
        v *= max(_SLOWEST, aligned)
        if aligned < _ALIGNED:
            cause = LimitedBy.HEADING
        # The check of the command decides last; it stops the robot.
        free = approach_speed(self._free_m(speed), speed, params)
        free = max(free, _SLOWEST * self._cruise)
        v, cause = min((v, cause), (free, LimitedBy.CLEARANCE))
        return v, cause
