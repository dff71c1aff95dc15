"""Predict the commanded motion and keep the body clear of the obstacles.

The clearance is exact at each predicted pose; see
:mod:`navette.navigation.grids.exact_clearance`.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Footprint, Pose2
from navette.navigation.grids.exact_clearance import body_distance, signed_distance

Array = NDArray[np.float64]

_STEP_M = 0.05  # largest motion of a body point between predicted poses
_FINER = 5  # times as many of them where the body is within the margin
_SLACK_M = 0.02  # a body within the margin may come this much closer …
_FLOOR_M = 0.02  # … but not below this
_ROUNDING_M = 1e-6
_MAX_POSES = 400
_TOUCH_M = 1e-3  # changes of distance that are none
NONE_UNSEEN = np.empty((0, 2))
_COSTMAP_AGE_S = 0.6  # obstacles are gathered once and used until the next costmap


class Verdict(NamedTuple):
    """Safe ``scale`` of the command, and present ``clearance`` of the body (m)."""

    scale: float
    clearance: float


@dataclass(frozen=True, kw_only=True)
class MovingBody:
    """The robot's outline, the clearance that it keeps, and how it stops.

    ``horizon_m`` is the clearance beyond which the exact value does not matter.
    """

    footprint: Footprint
    margin_m: float
    horizon_m: float
    reaction_s: float
    deceleration_mps2: float
    turn_acceleration_radps2: float


class CollisionCheck:
    """Scale a command so that the robot can stop before the collision margin."""

    def __init__(self, body: MovingBody) -> None:
        self._body = body
        self._outline = np.array(body.footprint.vertices, np.float64)
        self._radius = body.footprint.circumscribed_radius
        self._horizon = max(body.horizon_m, body.margin_m + 0.1)
        self._points = np.empty((0, 2))
        self._half_cell = 0.0
        self._unseen = NONE_UNSEEN

    def set_obstacles(
        self, points: Array, half_cell: float, unseen: Array = NONE_UNSEEN
    ) -> None:
        """Store what the body keeps clear of; metres, map.

        Args:
            points: centres (N, 2) of obstacle cells.
            half_cell: half the edge of their cells.
            unseen: centres (M, 2) of cells that were never seen, which the body does
                not cover in reverse.
        """
        self._points = np.ascontiguousarray(points, np.float64)
        self._half_cell = half_cell
        self._unseen = np.ascontiguousarray(unseen, np.float64)

    def reach(self, speed: float) -> float:
        """Return the distance (m) around the robot within which obstacles matter."""
        body = self._body
        stop = speed * (body.reaction_s + speed / (2 * body.deceleration_mps2))
        return self._radius + stop + self._horizon + _STEP_M + speed * _COSTMAP_AGE_S

    def check(self, pose: Pose2, motion: Sequence[float]) -> Verdict:
        """Return the share of ``motion`` that is safe at ``pose`` (map).

        ``motion`` is the speed (m/s), the turn rate (rad/s) and, for a drive that moves
        sideways, the speed to the left.

        The robot keeps the command for the reaction time t_r and then brakes on the
        same arc. Scaled by k, this takes ``k t_r + k² t_b / 2`` seconds of the full
        motion, where t_b is the braking time from full; solved for k with the part
        of the arc that is free.
        """
        v, omega = motion[:2]
        side = motion[2] if len(motion) > 2 else 0.0
        body = self._body
        brake = max(
            math.hypot(v, side) / body.deceleration_mps2,
            abs(omega) / body.turn_acceleration_radps2,
        )
        if brake == 0.0:
            return Verdict(1.0, self.clearance(pose))
        needed = body.reaction_s + brake / 2
        free, clearance = self._free(pose, v, omega, needed, side)
        if free >= needed:
            return Verdict(1.0, clearance)
        return Verdict(self._share(free, brake), clearance)

    def free_time(self, pose: Pose2, v: float, omega: float, span_s: float) -> float:
        """Return how long (s, ≤ ``span_s``) a constant motion stays clear."""
        return self._free(pose, v, omega, span_s)[0]

    def first_tight(self, poses: Array) -> int:
        """Return the index of the first of poses (N, 3) within the margin, or N."""
        body = (self._radius, self._half_cell, self._body.margin_m)
        poses = np.ascontiguousarray(poses)
        first: int = tight_pose(self._points, self._outline, poses, np.array(body))
        return first

    def reverse_share(self, pose: Pose2, speed: float) -> float:
        """Return the share of a reverse ``speed`` (m/s) that unseen space allows."""
        if not len(self._unseen):
            return 1.0
        brake = speed / self._body.deceleration_mps2
        needed = self._body.reaction_s + brake / 2
        free = self._seen_time(pose, -speed, 0.0, needed)
        return 1.0 if free >= needed else self._share(free, brake)

    def turn_is_free(self, pose: Pose2, turn: float) -> bool:
        """Return whether turning in place by ``turn`` rad keeps the body clear."""
        free, _ = self._free(pose, 0.0, math.copysign(1.0, turn), abs(turn))
        return free >= abs(turn)

    def clearance(self, pose: Pose2) -> float:
        """Return the clearance (m) of the body at ``pose``, at most the horizon."""
        return self._free(pose, 0.0, 0.0, 0.0)[1]

    def _share(self, free: float, brake: float) -> float:
        """Return k with ``k t_r + k² t_b / 2`` equal to the free time of the motion."""
        reaction = self._body.reaction_s
        return (math.sqrt(reaction**2 + 2 * brake * free) - reaction) / brake

    def _free(
        self, pose: Pose2, v: float, omega: float, duration: float, side: float = 0.0
    ) -> tuple[float, float]:
        if len(self._unseen) and (v < 0.0 or side != 0.0):
            duration = self._seen_time(pose, v, omega, duration, side)
        return free_motion(
            self._points,
            self._outline,
            np.array((pose.x, pose.y, pose.yaw, v, omega, side, duration)),
            self._poses(v, omega, duration, side),
            np.array(
                (
                    self._radius,
                    self._half_cell,
                    self._body.margin_m,
                    self._horizon,
                )
            ),
        )

    def _seen_time(
        self, pose: Pose2, v: float, omega: float, duration: float, side: float = 0.0
    ) -> float:
        """Return how long (s) the motion stays in space that was seen."""
        return seen_motion(
            self._unseen,
            self._outline,
            np.array((pose.x, pose.y, pose.yaw, v, omega, side, duration)),
            self._poses(v, omega, duration, side),
            self._radius,
        )

    def _poses(self, v: float, omega: float, duration: float, side: float) -> int:
        travel = (math.hypot(v, side) + abs(omega) * self._radius) * duration
        return min(_MAX_POSES, math.ceil(travel / _STEP_M))


@kernel(allocates=False, signature="float64(float64, float64)")
def _least(now: float, margin: float) -> float:
    """Return the clearance to keep: within the margin, along and away is allowed."""
    if now >= margin:
        return margin
    # Whatever is allowed below the floor adds up, step by step, to a contact.
    return max(_FLOOR_M, now - _SLACK_M) if now > _FLOOR_M else now - _ROUNDING_M


@kernel(allocates=False, signature="UniTuple(float64, 3)(float64[::1], float64)")
def _moved(motion: Array, t: float) -> tuple[float, float, float]:
    """Return the pose after ``t`` seconds of a motion, see :func:`free_motion`."""
    yaw, v, omega, side = motion[2], motion[3], motion[4], motion[5]
    turned = omega * t
    half = turned / 2
    # Chord of the arc: v t · sin(θ/2)/(θ/2), in the direction of half the turn.
    chord = t * (math.sin(half) / half if abs(half) > 1e-6 else 1.0)
    cos, sin = chord * math.cos(yaw + half), chord * math.sin(yaw + half)
    x = motion[0] + v * cos - side * sin
    y = motion[1] + v * sin + side * cos
    return x, y, yaw + turned


@kernel(
    allocates=False,
    signature="UniTuple(float64, 2)(float64[:, ::1], float64[:, ::1], float64[::1],"
    " int64, float64[::1])",
)
def free_motion(
    points: Array, outline: Array, motion: Array, poses: int, body: Array
) -> tuple[float, float]:
    """Return how long a motion of constant speed and turn rate stays clear.

    Args:
        points: obstacles (N, 2), metres, map.
        outline: polygon (K, 2), metres, base.
        motion: x, y, yaw (map), v, ω, speed to the left, and duration (s).
        poses: number of poses to predict over the duration.
        body: circumscribed radius, half a cell, margin, horizon; metres.

    Returns:
        Seconds of free motion, and the present clearance (m, ≤ horizon).
    """
    x, y, yaw, duration = motion[0], motion[1], motion[2], motion[6]
    radius, half_cell, margin, horizon = body
    reach = radius + half_cell
    far = half_cell + horizon
    now = body_distance(points, outline, x, y, yaw, reach, far) - half_cell
    least = _least(now, margin)
    if now < margin:  # a corner passes the body between coarse steps
        poses *= _FINER
    for i in range(1, poses + 1):
        px, py, pyaw = _moved(motion, duration * i / poses)
        near = half_cell + least + _SLACK_M
        there = body_distance(points, outline, px, py, pyaw, reach, near)
        if there - half_cell < least:
            return duration * (i - 1) / poses, now
    return duration, now


@kernel(
    allocates=False,
    signature="int64(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1])",
)
def tight_pose(points: Array, outline: Array, poses: Array, body: Array) -> int:
    """Return the index of the first of poses (N, 3) within the margin, or N.

    The clearance at the first pose is kept where it is below the margin.

    Args:
        points: obstacles (N, 2), metres, map.
        outline: polygon (K, 2), metres, base.
        poses: x, y, yaw (map).
        body: circumscribed radius, half a cell, margin; metres.
    """
    radius, half_cell, margin = body
    reach, near = radius + half_cell, half_cell + margin + _SLACK_M
    least = margin
    for i in range(poses.shape[0]):
        x, y, yaw = poses[i, 0], poses[i, 1], poses[i, 2]
        there = body_distance(points, outline, x, y, yaw, reach, near) - half_cell
        if i == 0:
            least = _least(there, margin)
        if there < least:
            return i
    count: int = poses.shape[0]
    return count


@kernel(
    allocates=False,
    signature="int64(float64[:, ::1], float64[:, ::1], float64[::1], float64,"
    " float64, float64, int64)",
)
def _first_unseen(
    unseen: Array,
    outline: Array,
    motion: Array,
    radius: float,
    begin_s: float,
    step_s: float,
    count: int,
) -> int:
    """Return which of the poses at ``begin_s`` + i ``step_s`` covers a point first.

    i is 1 … count, or count + 1 where none does.
    """
    first = count + 1
    for k in range(unseen.shape[0]):
        least = np.inf
        for i in range(first):
            x, y, yaw = motion[0], motion[1], motion[2]
            if i:
                x, y, yaw = _moved(motion, begin_s + i * step_s)
            dx, dy = unseen[k, 0] - x, unseen[k, 1] - y
            if dx * dx + dy * dy >= radius * radius:
                continue
            c, s = math.cos(yaw), math.sin(yaw)
            there = signed_distance(outline, c * dx + s * dy, c * dy - s * dx)
            if i == 0:
                least = there - _TOUCH_M
            elif there < min(0.0, least):
                first = i
                break
    return first


@kernel(
    allocates=False,
    signature="float64(float64[:, ::1], float64[:, ::1], float64[::1], int64, float64)",
)
def seen_motion(
    unseen: Array, outline: Array, motion: Array, poses: int, radius: float
) -> float:
    """Return how long (s) a motion covers none of the points ``unseen`` (N, 2).

    A point under the edge of the body may stay there, but not get further under it.
    Where the motion ends the poses are finer: a robot may have been put down with less
    than a step of space behind it. Other arguments as in :func:`free_motion`.
    """
    duration: float = motion[6]
    if poses == 0:
        return duration
    step_s = duration / poses
    first = _first_unseen(unseen, outline, motion, radius, 0.0, step_s, poses)
    if first > poses:
        return duration
    begin_s, finer_s = (first - 1) * step_s, step_s / _FINER
    finer = _first_unseen(unseen, outline, motion, radius, begin_s, finer_s, _FINER)
    return begin_s + (finer - 1) * finer_s
