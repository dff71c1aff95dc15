"""Cost and time of collision with moving obstacles along predicted motion.

Obstacles are discs that keep their velocity; the robot is the disc around its body.
Both assumptions get worse with time, so that a later collision costs less and the
clearance that is kept grows.
"""

import math

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Footprint, Pose2
from navette.navigation.control.drive_models import (
    ACKERMANN,
    FORWARD,
    OMNI,
    SIDE,
    TURN_RATE,
)
from navette.navigation.control.limits import VelocityCommand
from navette.navigation.control.params import ControlParams
from navette.navigation.control.rollouts import move
from navette.navigation.grids import inside_discs

Array = NDArray[np.float64]
Array32 = NDArray[np.float32]

# Cost of a rollout that collides at once; at its end it is a third of that.
_COLLISION = 400.0
# Growth of the clearance to be kept: error of the obstacle's velocity, m/s.
_VELOCITY_ERROR_MPS = 0.1
_CLEARANCE_WEIGHT = 30.0
# Shares of a command that are tried, the largest free one is used.
_SHARES = (1.0, 0.75, 0.5, 0.25, 0.0)
_SPAN_S = 2.5
_STEP_S = 0.1
# What is added to the radius of a moving obstacle to take its returns out of the static
# obstacles, and to the robot's distance to stop to leave them in.
_RETURNS_M = 0.2
_NEAR_M = 0.05
# Obstacles slower than this are avoided where they are: the estimated velocity of a
# wall of which more and less is seen swings around zero.
_SLOW_MPS = 0.15


def counts_as_static(
    points: Array, discs: Array, pose: Pose2, speed_mps: float, params: ControlParams
) -> NDArray[np.bool_]:
    """Return (N,) which measured points (N, 2) are obstacles where they are.

    All but the returns of moving obstacles, which are avoided where they will be.
    Within the circle around the body all count, and within the distance that the robot
    requires to stop also those of receding ones: a surface of which more and more is
    seen looks as if it moved.
    """
    discs = discs[np.hypot(discs[:, 2], discs[:, 3]) >= _SLOW_MPS]
    speed = abs(speed_mps)
    stop_m = speed * (params.reaction_s + speed / (2 * params.deceleration_mps2))
    body_m = Footprint.from_flat(params.footprint_m).circumscribed_radius
    off_m = np.hypot(points[:, 0] - pose.x, points[:, 1] - pose.y) - body_m
    away = (discs[:, 0] - pose.x) * discs[:, 2] + (discs[:, 1] - pose.y) * discs[:, 3]
    receding = inside_discs(points, discs[away > 0], _RETURNS_M)
    coming = inside_discs(points, discs[away <= 0], _RETURNS_M)
    return (off_m <= 0.0) | ~coming & ((off_m <= stop_m + _NEAR_M) | ~receding)


@kernel(fastmath=True)
def add_moving_costs(
    commands: Array32,
    yaw: float,
    step_s: float,
    drive: int,
    discs: Array32,
    body: tuple[float, float],
    costs: Array32,
) -> None:
    """Add what the samples cost by moving obstacles.

    Args:
        commands: (T, D, K) that the robot can follow, as of ``rollout_costs``.
        yaw: of the robot in the map.
        step_s: time of a step, float32.
        drive: code of the drive.
        discs: (M, 5) x, y (relative to the robot), vx, vy, radius.
        body: radius of the robot's disc, and distance below which closeness costs.
        costs: (K,), changed.
    """
    F = np.float32
    steps, count = commands.shape[0], costs.shape[0]
    pose, speed = np.zeros((4, count), np.float32), np.zeros((4, count), np.float32)
    pose[2], pose[3] = math.cos(yaw), math.sin(yaw)
    least, before = np.empty(count, np.float32), np.empty(count, np.float32)
    free = np.ones(count, np.float32)
    weight = F(_CLEARANCE_WEIGHT) * step_s
    for t in range(steps):
        speed[FORWARD] = commands[t, 0]
        if drive == OMNI:
            speed[SIDE], speed[TURN_RATE] = commands[t, 1], commands[t, 2]
        elif drive == ACKERMANN:
            speed[TURN_RATE] = commands[t, 0] * commands[t, 1]
        else:
            speed[TURN_RATE] = commands[t, 1]
        move(pose, speed, step_s)
        time = F(t + 1) * step_s
        keep = F(body[1]) + F(_VELOCITY_ERROR_MPS) * time
        least[:] = keep
        for m in range(discs.shape[0]):
            x, y = discs[m, 0] + time * discs[m, 2], discs[m, 1] + time * discs[m, 3]
            least, before = before, least
            _lower_to_disc(pose, x, y, discs[m, 4] + F(body[0]), before, least)
        crash = F(_COLLISION * (1.0 - 0.67 * t / steps))
        for i in range(count):
            lack = min(F(1.0), (keep - least[i]) / keep)
            hit = least[i] < F(0.0)
            costs[i] += free[i] * (weight * lack * lack + (crash if hit else F(0.0)))
            free[i] *= F(0.0) if hit else F(1.0)


@kernel(fastmath=True)
def _lower_to_disc(
    pose: Array32, x: float, y: float, reach: float, before: Array32, least: Array32
) -> None:
    """Write the gaps (K,) of the robot ``before``, or what is left beside one disc.

    Two arrays: in one, LLVM would store through a mask, which is slow on AMD.
    """
    for i in range(least.size):
        dx, dy = x - pose[0, i], y - pose[1, i]
        least[i] = min(before[i], math.sqrt(dx * dx + dy * dy) - reach)


@kernel(
    signature="float64(float64[::1], UniTuple(float64, 3), float64, float64, float64,"
    " float64[:, ::1])"
)
def _first_contact(
    pose: Array,
    motion: tuple[float, float, float],
    body: float,
    margin: float,
    span: float,
    discs: Array,
) -> float:
    """Return when (s) a constant motion comes within a margin of a disc; ``span``."""
    x, y, yaw = pose
    v, omega, side = motion
    steps = int(span / _STEP_S)
    now = np.empty(discs.shape[0])
    for m in range(discs.shape[0]):
        now[m] = math.hypot(discs[m, 0] - x, discs[m, 1] - y) - discs[m, 4] - body
    for i in range(1, steps + 1):
        time = i * _STEP_S
        middle = yaw + 0.5 * omega * _STEP_S
        c, s = math.cos(middle), math.sin(middle)
        x += _STEP_S * (v * c - side * s)
        y += _STEP_S * (v * s + side * c)
        yaw += omega * _STEP_S
        for m in range(discs.shape[0]):
            dx = discs[m, 0] + time * discs[m, 2] - x
            dy = discs[m, 1] + time * discs[m, 3] - y
            gap = math.hypot(dx, dy) - discs[m, 4] - body
            # An obstacle within the margin may leave it.
            if gap < min(margin, now[m] - 0.02):
                return time
    return span


def safe_share(
    pose: Pose2,
    motion: VelocityCommand,
    discs: Array,
    body_m: float,
    margin_m: float,
) -> float:
    """Return the share of a motion that yields to moving obstacles.

    The largest share that stays clear for 2.5 s; if none does, the one that stays clear
    longest.
    """
    if not len(discs):
        return 1.0
    start = np.array(pose, np.float64)
    best_s, best = -1.0, 0.0
    for share in _SHARES:
        free_s = _first_contact(
            start, (*motion.scaled(share),), body_m, margin_m, _SPAN_S, discs
        )
        if free_s >= _SPAN_S:
            return share
        if free_s > best_s + 1e-9:
            best_s, best = free_s, share
    return best
