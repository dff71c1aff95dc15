"""Candidate command sequences that follow the path.

Before a passage with centimetres on each side nearly all noise collides, and the mean
of the rest is at rest. A sequence that tracks the path, slowly if need be, is always
among the candidates.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.control.drive_models import ACKERMANN, OMNI, DriveLimits
from navette.navigation.control.rollouts import PathTable

Array32 = NDArray[np.float32]

SHARES = (1.0, 0.5, 0.2)
"""Speed of each candidate, as a share of the limit."""

_LOOKAHEAD_M = 0.25
_HEADING_GAIN = 2.0  # turn rate per heading error, 1/s


@kernel
def fill_path_candidates(
    commands: Array32,
    yaw: float,
    path: PathTable,
    limits: DriveLimits,
    drive: int,
    shares: Array32,
    step_s: float,
) -> None:
    """Fill commands (T, D, K) of K sequences that track the path.

    The robot is at the origin with heading ``yaw``; the path is relative to it. Each
    step moves towards the pose a lookahead farther on, not past a change of direction,
    or turns in place where the path does.
    """
    poses = path.poses
    last = poses.shape[1] - 1 - path.reach
    for k in range(shares.size):
        x, y, heading, at = 0.0, 0.0, yaw, 0
        for t in range(commands.shape[0]):
            at = _nearest(poses, last, at, x, y, heading)
            direction = poses[5, at]
            ahead = at
            while (
                ahead < last
                and poses[5, ahead] == direction
                and poses[4, ahead] - poses[4, at] < _LOOKAHEAD_M
            ):
                ahead += 1
            cos, sin = math.cos(heading), math.sin(heading)
            dx, dy = poses[0, ahead] - x, poses[1, ahead] - y
            forward, left = cos * dx + sin * dy, cos * dy - sin * dx
            off = math.atan2(
                poses[3, ahead] * cos - poses[2, ahead] * sin,
                poses[2, ahead] * cos + poses[3, ahead] * sin,
            )
            away = math.hypot(forward, left)
            speed = min(shares[k] * limits.max_speed, away / step_s)
            side, turn = 0.0, 0.0
            if drive == OMNI:
                share = speed / away if away > 1e-6 else 0.0
                speed, side = share * forward, share * left
                turn = _clipped(_HEADING_GAIN * off, limits.max_turn_rate)
                commands[t, 1, k], commands[t, 2, k] = side, turn
            else:
                if forward * direction <= 0.0:  # that pose is passed
                    speed = 0.0
                elif direction < 0:
                    speed = -min(speed, shares[k] * limits.max_reverse)
                curvature = 2.0 * left / max(away * away, 1e-4)
                if drive == ACKERMANN:
                    curvature = _clipped(curvature, limits.max_curvature)
                    commands[t, 1, k] = curvature
                    turn = speed * curvature
                else:
                    turn = speed * curvature if direction else _HEADING_GAIN * off
                    turn = _clipped(turn, limits.max_turn_rate)
                    commands[t, 1, k] = turn
            commands[t, 0, k] = speed
            x += step_s * (cos * speed - sin * side)
            y += step_s * (sin * speed + cos * side)
            heading += step_s * turn


@kernel
def _nearest(
    poses: Array32, last: int, first: int, x: float, y: float, heading: float
) -> int:
    """Return the nearest of the next poses, in position and heading."""
    cos, sin = math.cos(heading), math.sin(heading)
    best, least = first, np.inf
    for i in range(first, last + 1):
        if poses[4, i] - poses[4, first] > 2 * _LOOKAHEAD_M:
            break
        dx, dy = poses[0, i] - x, poses[1, i] - y
        turned = 1.0 - cos * poses[2, i] - sin * poses[3, i]
        there = dx * dx + dy * dy + 0.5 * turned
        if there < least:
            best, least = i, there
    return best


@kernel
def _clipped(value: Any, most: Any) -> Any:
    return min(most, max(-most, value))
