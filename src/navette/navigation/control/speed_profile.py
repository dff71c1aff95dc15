"""Speed limits along a piece: bends, wheels and braking distance."""

import math

import numpy as np

from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece

# Share of the turn rate and of the brakes that the plan uses; the rest corrects
# errors (real wheels turn 10–25 % slower than commanded).
_TURN_SHARE = 0.8
_BRAKE_SHARE = 0.8
_DELAY_S = 0.15  # from a command to the motion


def cruise_speed(piece: DrivePiece, params: ControlParams) -> float:
    """Return the speed (m/s) on a straight, free stretch in the piece's direction."""
    return params.cruise_speed_mps if piece.direction > 0 else params.reverse_speed_mps


def speed_profile(piece: DrivePiece, params: ControlParams) -> list[float]:
    """Return the speed limit (m/s) at each sample of the piece.

    1. In a bend of curvature κ: ``|v κ|`` ≤ turn rate, ``v² |κ|`` ≤ lateral
       acceleration, and the outer wheel ``v (1 + |κ| b/2)`` ≤ wheel speed.
    2. Backwards from each slow point: ``v² ≤ v_next² + 2 a d``, so that the robot is
       slow before the bend, not in it. With e = v² + 2as the recursion is a running
       minimum of e.
    """
    kappa = np.abs(np.asarray(piece.curvature))
    s = np.asarray(piece.s)
    bend = np.maximum(kappa, 1e-9)
    cruise = cruise_speed(piece, params)
    speed = np.minimum(cruise, _TURN_SHARE * params.max_turn_rate_radps / bend)
    speed = np.minimum(speed, np.sqrt(params.lateral_acceleration_mps2 / bend))
    if params.max_wheel_speed_mps:
        rim = params.max_wheel_speed_mps / (1 + kappa * params.wheel_separation_m / 2)
        speed = np.minimum(speed, rim)
    a2 = 2 * _BRAKE_SHARE * params.deceleration_mps2
    energy = np.minimum.accumulate((speed**2 + a2 * s)[::-1])[::-1]
    return [float(v) for v in np.sqrt(energy - a2 * s)]


def approach_speed(distance: float, speed: float, params: ControlParams) -> float:
    """Return the speed (m/s) at ``distance`` metres before a stop: ``v ≤ sqrt(2 a d)``.

    The distance is reduced by what the robot drives before the command acts. The
    root's infinite slope at the end is limited by ``d / 0.3 s``: a drive that lags
    would overshoot on the bare root.
    """
    left = max(0.0, distance - _DELAY_S * abs(speed))
    return min(
        math.sqrt(2 * _BRAKE_SHARE * params.deceleration_mps2 * left),
        max(0.0, distance) / 0.3,
    )


def stopping_distance(speed: float, params: ControlParams) -> float:
    """Return the distance (m) from which :func:`approach_speed` is this speed."""
    brakes = speed**2 / (2 * _BRAKE_SHARE * params.deceleration_mps2)
    return max(_DELAY_S * speed + brakes, 0.3 * speed)
