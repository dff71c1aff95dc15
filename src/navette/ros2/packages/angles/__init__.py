"""angles: normalised angles and the shortest rotation between them, in rad."""

import math

_TURN = 2.0 * math.pi
_ROUNDING = 1e-12


def normalize_angle_positive(angle: float) -> float:
    """Return the angle in [0, 2π)."""
    return angle % _TURN


def normalize_angle(angle: float) -> float:
    """Return the angle in (−π, π]."""
    positive = normalize_angle_positive(angle)
    return positive - _TURN if positive > math.pi else positive


def shortest_angular_distance(from_angle: float, to_angle: float) -> float:
    """Return the rotation in (−π, π] from one angle to the other."""
    return normalize_angle(to_angle - from_angle)


def two_pi_complement(angle: float) -> float:
    """Return the rotation to the same angle in the other direction."""
    angle = math.fmod(angle, _TURN) if abs(angle) > _TURN else angle
    return angle - _TURN if angle > 0.0 else angle + _TURN


def shortest_angular_distance_with_limits(
    from_angle: float, to_angle: float, left_limit: float, right_limit: float
) -> tuple[bool, float]:
    """Return whether a rotation within the limits exists, and the shortest rotation.

    Allowed are the angles from ``left_limit`` counter-clockwise to ``right_limit``,
    both in [−π, π]: [0.25, −0.25] contains π, not 0. If an angle is not allowed, the
    rotation leads to the nearer limit.
    """
    rotations = _both_ways(from_angle, to_angle)
    is_allowed, low, high = _to_limits(from_angle, left_limit, right_limit)
    if not is_allowed:
        return False, _towards(low, high, rotations)
    for rotation in rotations:
        if low - _ROUNDING <= rotation <= high + _ROUNDING:
            return True, rotation
    _, low, high = _to_limits(to_angle, left_limit, right_limit)
    return False, _towards(-high, -low, rotations)


def shortest_angular_distance_with_large_limits(
    from_angle: float, to_angle: float, left_limit: float, right_limit: float
) -> tuple[bool, float]:
    """Return whether a rotation within the limits exists, and the shortest one.

    Limits and angles are not normalised, as of a joint that turns more than once.
    """
    rotations = _both_ways(from_angle, to_angle)
    if left_limit <= right_limit:
        for rotation in rotations:
            if left_limit <= from_angle + rotation <= right_limit:
                return left_limit <= from_angle <= right_limit, rotation
    return False, rotations[0]


def _both_ways(from_angle: float, to_angle: float) -> tuple[float, float]:
    """Return the rotations to an angle, the shorter one first."""
    shortest = shortest_angular_distance(from_angle, to_angle)
    return shortest, two_pi_complement(shortest)


def _to_limits(angle: float, left: float, right: float) -> tuple[bool, float, float]:
    """Return whether an angle is allowed, and the rotations (−, +) to the limits."""
    to_left, to_right = -((angle - left) % _TURN), (right - angle) % _TURN
    if left == -math.pi and right == math.pi:
        return True, to_left, _TURN + to_left
    # Of an angle that is not allowed, the two rotations are more than a turn apart.
    if to_right - to_left < _TURN or to_left == 0.0 or to_right == 0.0:
        return True, to_left, to_right
    return False, to_right - _TURN, to_left + _TURN


def _towards(low: float, high: float, rotations: tuple[float, float]) -> float:
    """Return the rotation in the direction of the nearer limit."""
    if abs(low) == abs(high):
        return rotations[0]
    return min(rotations) if abs(low) < abs(high) else max(rotations)
