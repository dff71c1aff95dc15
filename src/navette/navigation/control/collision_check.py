"""Predict the commanded motion and keep the body clear of the obstacles.

The clearance is exact: signed distance from obstacle points (cell centres, less half
a cell) to the outline, at each predicted pose. A sampled distance field, as the
planner uses for its thousands of poses, jumps by a cell when the body moves by a
millimetre; "moving away is allowed" could not be told from that.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.control.limits import Command

Array = NDArray[np.float64]

_STEP_M = 0.05  # no point of the body moves farther between predicted poses
_SLACK_M = 0.02  # a body closer than the margin may come this much closer yet …
_FLOOR_M = 0.02  # … but not below this
_MAX_POSES = 400
_COSTMAP_AGE_S = 0.25  # obstacles are gathered once and used until the next costmap


class Verdict(NamedTuple):
    """``scale`` of the command that is safe; ``clearance`` of the body now, metres."""

    scale: float
    clearance: float


class CollisionCheck:
    """Scales a command so that the robot can stop before it comes too close.

    Args:
        footprint: outline about the axle.
        margin: clearance (m) that the motion must keep.
        horizon: clearance (m) beyond which the exact value does not matter.
        reaction: seconds until a new command shows in the motion.
        deceleration, turn_deceleration: brakes, m/s² and rad/s².
    """

    def __init__(
        self,
        footprint: Footprint,
        *,
        margin: float,
        horizon: float,
        reaction: float,
        deceleration: float,
        turn_deceleration: float,
    ) -> None:
        self._outline = np.array(footprint.vertices, np.float64)
        self._radius = footprint.circumscribed_radius
        self._margin = margin
        self._horizon = max(horizon, margin + 0.1)
        self._reaction = reaction
        self._deceleration = deceleration
        self._turn_deceleration = turn_deceleration
        self._points = np.empty((0, 2))
        self._half_cell = 0.0

    def set_obstacles(self, points: Array, half_cell: float) -> None:
        """Obstacle cell centres (N, 2), metres, map; half a cell's edge."""
        self._points = np.ascontiguousarray(points, np.float64)
        self._half_cell = half_cell

    def reach(self, speed: float) -> float:
        """Distance (m) around the robot within which obstacles matter."""
        stop = speed * (self._reaction + speed / (2 * self._deceleration))
        return self._radius + stop + self._horizon + _STEP_M + speed * _COSTMAP_AGE_S

    def check(self, pose: Pose2, motion: Command) -> Verdict:
        """How much of ``motion`` may be commanded at ``pose`` (map).

        Keeping the command for the reaction time t_r and braking then on the same
        arc uses the arc up to ``k t_r + k² t_b / 2`` seconds of full motion, where k
        scales the command and t_b is the braking time from full; solved for k with
        the part of the arc that is free.
        """
        v, omega = motion
        brake = max(abs(v) / self._deceleration, abs(omega) / self._turn_deceleration)
        if brake == 0.0:
            return Verdict(1.0, self.clearance(pose))
        needed = self._reaction + brake / 2
        free, clearance = self._free(pose, v, omega, needed)
        if free >= needed:
            return Verdict(1.0, clearance)
        root = math.sqrt(self._reaction**2 + 2 * brake * free)
        return Verdict((root - self._reaction) / brake, clearance)

    def turn_is_free(self, pose: Pose2, turn: float) -> bool:
        """Whether turning in place by ``turn`` rad keeps the body clear."""
        free, _ = self._free(pose, 0.0, math.copysign(1.0, turn), abs(turn))
        return free >= abs(turn)

    def clearance(self, pose: Pose2) -> float:
        """Clearance (m) of the body at ``pose``, at most the horizon."""
        return self._free(pose, 0.0, 0.0, 0.0)[1]

    def _free(
        self, pose: Pose2, v: float, omega: float, duration: float
    ) -> tuple[float, float]:
        travel = (abs(v) + abs(omega) * self._radius) * duration
        poses = min(_MAX_POSES, math.ceil(travel / _STEP_M))
        return free_motion(
            self._points,
            self._outline,
            np.array((pose.x, pose.y, pose.yaw, v, omega, duration)),
            poses,
            np.array((self._radius, self._half_cell, self._margin, self._horizon)),
        )


@njit("float64(float64[:, ::1], float64, float64)", cache=True)
def signed_distance(outline: Array, x: float, y: float) -> float:
    """Distance of (x, y) to the polygon (K, 2), negative inside; metres."""
    best = np.inf
    inside = False
    count = outline.shape[0]
    ax, ay = outline[count - 1, 0], outline[count - 1, 1]
    for k in range(count):
        bx, by = outline[k, 0], outline[k, 1]
        ex, ey = bx - ax, by - ay
        px, py = x - ax, y - ay
        t = min(1.0, max(0.0, (px * ex + py * ey) / (ex * ex + ey * ey)))
        dx, dy = px - t * ex, py - t * ey
        best = min(best, dx * dx + dy * dy)
        if (ay > y) != (by > y) and px < ex * py / ey:
            inside = not inside
        ax, ay = bx, by
    distance = math.sqrt(best)
    return -distance if inside else distance


@njit(
    "float64(float64[:, ::1], float64[:, ::1], float64, float64, float64, float64,"
    " float64)",
    cache=True,
)
def body_distance(
    points: Array,
    outline: Array,
    x: float,
    y: float,
    yaw: float,
    radius: float,
    horizon: float,
) -> float:
    """Least signed distance (m) of the body at a pose to the points, ≤ horizon."""
    c, s = math.cos(yaw), math.sin(yaw)
    best = horizon
    for i in range(points.shape[0]):
        dx, dy = points[i, 0] - x, points[i, 1] - y
        near = radius + best
        if near <= 0.0 or dx * dx + dy * dy >= near * near:
            continue
        best = min(best, signed_distance(outline, c * dx + s * dy, c * dy - s * dx))
    return best


@njit(
    "UniTuple(float64, 2)(float64[:, ::1], float64[:, ::1], float64[::1], int64,"
    " float64[::1])",
    cache=True,
)
def free_motion(
    points: Array, outline: Array, motion: Array, poses: int, body: Array
) -> tuple[float, float]:
    """How long a motion of constant speed and turn rate stays clear.

    Args:
        points: obstacles (N, 2), metres, map.
        outline: polygon (K, 2), metres, base.
        motion: x, y, yaw (map), v, ω and duration (s) of the motion.
        poses: how many poses to predict over the duration.
        body: circumscribed radius, half a cell, margin, horizon; metres.

    Returns:
        Seconds of the motion that are free, and the clearance now (m, ≤ horizon).
    """
    x, y, yaw, v, omega, duration = motion
    radius, half_cell, margin, horizon = body
    reach = radius + half_cell
    far = half_cell + horizon
    now = body_distance(points, outline, x, y, yaw, reach, far) - half_cell
    least = margin
    if now < margin:
        # Too close already: away and along is allowed, nearer hardly.
        least = max(_FLOOR_M, now - _SLACK_M) if now > _FLOOR_M else now - 1e-3
    for i in range(1, poses + 1):
        t = duration * i / poses
        turned = omega * t
        half = turned / 2
        # Chord of the arc: v t · sin(θ/2)/(θ/2), in the direction of half the turn.
        chord = v * t * (math.sin(half) / half if abs(half) > 1e-6 else 1.0)
        px = x + chord * math.cos(yaw + half)
        py = y + chord * math.sin(yaw + half)
        near = half_cell + least + _SLACK_M
        there = body_distance(points, outline, px, py, yaw + turned, reach, near)
        if there - half_cell < least:
            return duration * (i - 1) / poses, now
    return duration, now
