"""Pose prediction at constant velocity."""

import math

from navette.geometry import Pose2


def advanced(pose: Pose2, speed: float, turn_rate: float, seconds: float) -> Pose2:
    """Return the pose after an arc at constant speed (m/s) and turn rate (rad/s).

    The chord of the arc has the length v t · sin(θ/2)/(θ/2), in the direction of half
    the turn θ = ω t.
    """
    half = turn_rate * seconds / 2
    chord = speed * seconds * (math.sin(half) / half if abs(half) > 1e-6 else 1.0)
    return pose @ Pose2(chord * math.cos(half), chord * math.sin(half), 2 * half)
