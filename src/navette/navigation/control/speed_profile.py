"""How fast each point of a piece may be passed."""

import math

import numpy as np

from navette.navigation.control.limits import MotionLimits
from navette.navigation.control.path_pieces import DrivePiece

# Share of the turn rate and of the brakes that the plan uses; the rest corrects
# errors (real wheels turn 10–25 % slower than commanded).
_TURN_SHARE = 0.8
_BRAKE_SHARE = 0.8


def speed_profile(
    piece: DrivePiece, cruise: float, lateral: float, limits: MotionLimits
) -> list[float]:
    """Speed limit (m/s) at each sample of the piece.

    1. In a bend of curvature κ: ``|v κ|`` ≤ turn rate, ``v² |κ|`` ≤ lateral
       acceleration, and the outer wheel ``v (1 + |κ| b/2)`` ≤ wheel speed.
    2. Backwards from each slow point: ``v² ≤ v_next² + 2 a d``, so that the robot is
       slow before the bend, not in it. With e = v² + 2as the recursion is a running
       minimum of e.
    """
    kappa = np.abs(np.asarray(piece.curvature))
    s = np.asarray(piece.s)
    bend = np.maximum(kappa, 1e-9)
    speed = np.minimum(cruise, _TURN_SHARE * limits.turn_rate / bend)
    speed = np.minimum(speed, np.sqrt(lateral / bend))
    if limits.wheel_speed:
        rim = limits.wheel_speed / (1 + kappa * limits.wheel_separation / 2)
        speed = np.minimum(speed, rim)
    a2 = 2 * _BRAKE_SHARE * limits.deceleration
    energy = np.minimum.accumulate((speed**2 + a2 * s)[::-1])[::-1]
    return [float(v) for v in np.sqrt(energy - a2 * s)]


def approach_speed(distance: float, speed: float, deceleration: float) -> float:
    """Speed (m/s) at ``distance`` metres before a stop: ``v ≤ sqrt(2 a d)``.

    The distance is shortened by what passes before the command acts, and the root's
    infinite slope at the end is cut off by ``d / 0.3 s``: a drive that lags would
    overshoot on the bare root.
    """
    left = max(0.0, distance - 0.15 * abs(speed))
    return min(
        math.sqrt(2 * _BRAKE_SHARE * deceleration * left), max(0.0, distance) / 0.3
    )
