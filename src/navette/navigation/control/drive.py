"""Drive along one piece of the path: steering, speed, turning to it first."""

import math
from dataclasses import dataclass

from navette.geometry import wrap_angle
from navette.navigation.control.collision_check import CollisionCheck
from navette.navigation.control.cross_track_pid import CrossTrackPid
from navette.navigation.control.limits import STOP, Command, MotionLimits
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece
from navette.navigation.control.path_progress import PathPoint, PathProgress
from navette.navigation.control.pure_pursuit import PurePursuit
from navette.navigation.control.records import FollowerInputs, Wanted
from navette.navigation.control.rotate import STANDSTILL_MPS, TurnInPlace
from navette.navigation.control.speed_profile import approach_speed, speed_profile
from navette.navigation.control.states import ControlState
from navette.navigation.control.turn_gain import TurnGain

Steering = PurePursuit | CrossTrackPid

_HYSTERESIS_RAD = 0.4  # a moving robot bears more heading error before it stops
_SLOWEST = 0.3  # share of the speed that low clearance or a heading error leaves
_PREVIEW_S = 0.15  # the drive answers about this late
_STOP_SHARE = 0.3  # of the goal tolerance: where a piece counts as driven


@dataclass(frozen=True)
class Equipment:
    """What all pieces of all paths share; built once."""

    params: ControlParams
    limits: MotionLimits
    steering: Steering
    collision: CollisionCheck
    turn_gain: TurnGain


class PieceDrive:
    """Drives one :class:`DrivePiece` to its end.

    ``start_window`` is how far along it (m) the robot may already be.
    """

    def __init__(
        self, piece: DrivePiece, equipment: Equipment, start_window: float
    ) -> None:
        self._piece = piece
        self._with = equipment
        params = equipment.params
        self._cruise = (
            params.cruise_speed_mps if piece.direction > 0 else params.reverse_speed_mps
        )
        self._speeds = speed_profile(
            piece, self._cruise, params.lateral_acceleration_mps2, equipment.limits
        )
        self._progress = PathProgress(piece, start_window)
        self._turn: TurnInPlace | None = None
        self.at = PathPoint(0, 0.0, 0.0, 0.0)

    @property
    def distance_left(self) -> float:
        """Arc length (m) to the end of the piece."""
        return max(0.0, self._piece.length - self.at.s)

    def step(self, inputs: FollowerInputs, clearance: float) -> Wanted | None:
        """The next command, or None at the end of the piece.

        ``clearance`` (m) of the body, as the last check found it.
        """
        params = self._with.params
        self.at = at = self._progress.update(inputs.pose)
        if self._piece.length - at.s <= _STOP_SHARE * params.goal_tolerance_m:
            return None
        if abs(at.cross_track) > params.max_deviation_m:
            return Wanted(STOP, ControlState.OFF_PATH, brakes=True)
        turning = self._turn_first(inputs)
        if turning is not None:
            return turning
        if inputs.speed * self._piece.direction < -STANDSTILL_MPS:
            return Wanted(STOP, ControlState.FOLLOWING, brakes=True)
        kappa = self._with.steering.curvature(
            self._piece, at, inputs.pose, inputs.speed
        )
        v = self._speed(kappa, inputs.speed, clearance) * self._piece.direction
        command = Command(v, v * kappa / self._with.turn_gain.value)
        return Wanted(command, ControlState.FOLLOWING)

    def reconsider(self) -> None:
        """The motion turned out blocked: choose the way to turn again."""
        if self._turn is not None:
            self._turn.reconsider()

    def _turn_first(self, inputs: FollowerInputs) -> Wanted | None:
        """Turn in place to the path while the heading error is too big to drive."""
        params = self._with.params
        if self._turn is None:
            error = abs(self.at.heading_error)
            moving = abs(inputs.speed) > STANDSTILL_MPS
            bearable = params.rotate_above_rad + _HYSTERESIS_RAD
            if error <= (bearable if moving else params.rotate_above_rad):
                return None
            travel = self._piece.heading[self.at.sample]
            back = math.pi if self._piece.direction < 0 else 0.0
            self._turn = TurnInPlace(
                wrap_angle(travel + back),
                0.0,
                tolerance=params.turn_tolerance_rad,
                limits=self._with.limits,
                is_free=self._with.collision.turn_is_free,
                # Rather steer than nearly a lap round.
                either_way=error > bearable,
            )
        wanted = self._turn.step(inputs, self._with.turn_gain.value)
        if wanted is None or (
            wanted.state is ControlState.BLOCKED and not self._turn.either_way
        ):
            self._turn = None
            return None
        return wanted

    def _speed(self, kappa: float, speed: float, clearance: float) -> float:
        """Least of the limits: bends, end of the piece, errors, obstacles."""
        params, limits = self._with.params, self._with.limits
        ahead = self._piece.index_at(self.at.s + _PREVIEW_S * abs(speed))
        left = self._piece.length - self.at.s
        v = min(
            self._speeds[self.at.sample],
            self._speeds[ahead],
            approach_speed(left, speed, limits.deceleration),
        )
        if kappa:
            v = min(v, limits.turn_rate * self._with.turn_gain.value / abs(kappa))
        v *= max(_SLOWEST, math.cos(self.at.heading_error))
        span = params.slow_clearance_m - params.collision_margin_m
        if span > 0 and clearance < params.slow_clearance_m:
            share = (clearance - params.collision_margin_m) / span
            v = min(v, self._cruise * max(_SLOWEST, share))
        return v
