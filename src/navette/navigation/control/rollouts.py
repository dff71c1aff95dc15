"""Compiled rollouts of command sequences, and their cost."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.storage.kernels import kernel

Array = NDArray[np.float64]

# Metres that a radian of heading error or of turning in place counts as.
METRES_PER_RADIAN = 0.5
# Cost of a rollout that collides; earlier collisions cost more.
COLLISION = 200.0


class DriveLimits(NamedTuple):
    """Limits of a differential drive; m, s, rad."""

    max_speed: float
    max_reverse: float
    max_turn_rate: float
    acceleration: float
    deceleration: float
    turn_acceleration: float
    lateral_acceleration: float


class CostWeights(NamedTuple):
    """Weights of the critics; see ControlParams."""

    align: float
    heading: float
    progress: float
    clearance: float
    clearance_m: float
    reverse: float
    effort: float
    margin_m: float


class PathWindow(NamedTuple):
    """The path near the robot.

    Attributes:
        x, y: (N,) positions in the map, from the pose nearest to the robot on.
        cos, sin: (N,) of the headings.
        measure: (N,) metres along it, with turns in place converted to metres.
        direction: (N,) 1 forward, −1 reverse, 0 turn in place, to the next pose.
    """

    x: Array
    y: Array
    cos: Array
    sin: Array
    measure: Array
    direction: NDArray[np.int8]


class LocalField(NamedTuple):
    """Distance to the obstacles around the robot.

    Attributes:
        distance_m: (H, W) float32 between cell centres.
        x, y: corner of cell (0, 0) in the map; the grid is not rotated.
        resolution: edge of a cell, m.
    """

    distance_m: NDArray[np.float32]
    x: float
    y: float
    resolution: float


@kernel(nogil=True)
def rollout_costs(
    candidates: Array,
    start: Array,
    step_s: float,
    limits: DriveLimits,
    path: PathWindow,
    field: LocalField,
    body: Array,
    reach_m: float,
    weights: CostWeights,
    costs: Array,
) -> None:
    """Write the cost of every candidate.

    Args:
        candidates: (K, T, 2) speed and turn rate; limited here in place.
        start: x, y, yaw, speed, turn rate.
        step_s: time of a step.
        limits: limits of the drive.
        path: the path to follow.
        field: distance to obstacles.
        body: (P, 3) x, y, disc radius, base frame.
        reach_m: largest distance of a body point from the base.
        weights: weights of the critics.
        costs: (K,), written.
    """
    for k in range(candidates.shape[0]):
        costs[k] = _cost(
            candidates[k], start, step_s, limits, path, field, body, reach_m, weights
        )


@kernel(nogil=True)
def _cost(
    commands: Array,
    start: Array,
    step_s: float,
    limits: DriveLimits,
    path: PathWindow,
    field: LocalField,
    body: Array,
    reach_m: float,
    weights: CostWeights,
) -> float:
    x, y, v, w = start[0], start[1], start[3], start[4]
    c, s = math.cos(start[2]), math.sin(start[2])
    steps = commands.shape[0]
    last = path.x.shape[0] - 1
    at = 0
    cost = 0.0
    faster, slower = limits.acceleration * step_s, limits.deceleration * step_s
    turn_change = limits.turn_acceleration * step_s
    for t in range(steps):
        # 1. the command within the limits
        v_to = min(limits.max_speed, max(-limits.max_reverse, commands[t, 0]))
        w_to = min(limits.max_turn_rate, max(-limits.max_turn_rate, commands[t, 1]))
        change = slower if v_to * v < 0.0 or abs(v_to) < abs(v) else faster
        v += min(change, max(-change, v_to - v))
        dw = min(turn_change, max(-turn_change, w_to - w))
        w += dw
        if abs(v * w) > limits.lateral_acceleration:
            v = math.copysign(limits.lateral_acceleration / abs(w), v)
        commands[t, 0], commands[t, 1] = v, w
        # 2. the motion, with the heading at half of the step
        cos, sin = _small_rotation(0.5 * w * step_s)
        c, s = c * cos - s * sin, s * cos + c * sin
        x += v * step_s * c
        y += v * step_s * s
        c, s = c * cos - s * sin, s * cos + c * sin
        # 3. obstacles
        clearance = _clearance(field, body, reach_m, x, y, c, s, weights.clearance_m)
        if clearance < weights.clearance_m:
            lack = (weights.clearance_m - clearance) / weights.clearance_m
            cost += weights.clearance * lack * lack * step_s
            if clearance < weights.margin_m:
                depth = 1.0 + min(1.0, (weights.margin_m - clearance) / 0.1)
                cost += COLLISION * depth * (1.0 - 0.5 * t / steps) / steps
        # 4. the path
        at = _nearest(path, at, last, x, y, c, s)
        dx, dy = x - path.x[at], y - path.y[at]
        cost += weights.align * (dx * dx + dy * dy) * step_s
        turned = 2.0 * (1.0 - c * path.cos[at] - s * path.sin[at])
        cost += weights.heading * turned * step_s
        if v * path.direction[at] < 0.0:
            cost += weights.reverse * abs(v) * step_s
        cost += weights.effort * dw * dw
    ahead = path.measure[last] - path.measure[at]
    dx, dy = x - path.x[at], y - path.y[at]
    ahead += 0.5 * math.sqrt(dx * dx + dy * dy)
    total: float = cost + weights.progress * ahead
    return total


@kernel(nogil=True)
def _small_rotation(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle below 0.5 rad, to 1e-6."""
    a2 = angle * angle
    return 1.0 - a2 * (0.5 - a2 / 24.0), angle * (1.0 - a2 * (1.0 / 6.0 - a2 / 120.0))


@kernel(nogil=True)
def _nearest(
    path: PathWindow, at: int, last: int, x: float, y: float, c: float, s: float
) -> int:
    """Advance along the path while one of the next two poses is nearer."""
    here = _apart(path, at, x, y, c, s)
    while at < last:
        following = _apart(path, at + 1, x, y, c, s)
        if following > here:
            if at + 2 > last:
                break
            following = _apart(path, at + 2, x, y, c, s)
            if following > here:
                break
            at += 1
        at += 1
        here = following
    return at


@kernel(nogil=True)
def _apart(path: PathWindow, i: int, x: float, y: float, c: float, s: float) -> float:
    """Return a squared distance between poses; 2 (1 − cos θ) stands for θ²."""
    dx, dy = x - path.x[i], y - path.y[i]
    turned = 2.0 * (1.0 - c * path.cos[i] - s * path.sin[i])
    apart: float = dx * dx + dy * dy + METRES_PER_RADIAN**2 * turned
    return apart


@kernel(nogil=True)
def _clearance(
    field: LocalField,
    body: Array,
    reach_m: float,
    x: float,
    y: float,
    c: float,
    s: float,
    enough_m: float,
) -> float:
    """Return the clearance of the body, from the nearest cells; at most enough."""
    per_metre = 1.0 / field.resolution
    u, v = (x - field.x) * per_metre, (y - field.y) * per_metre
    height, width = field.distance_m.shape
    half_cell = 0.5 * field.resolution
    if not (0.0 <= u < width and 0.0 <= v < height):
        return enough_m
    here = field.distance_m[np.uint32(v), np.uint32(u)] - half_cell
    if here - reach_m >= enough_m:
        return enough_m
    c, s = c * per_metre, s * per_metre
    least = enough_m
    for k in range(body.shape[0]):
        bx, by = body[k, 0], body[k, 1]
        pu, pv = u + c * bx - s * by, v + s * bx + c * by
        if 0.0 <= pu < width and 0.0 <= pv < height:
            there = field.distance_m[np.uint32(pv), np.uint32(pu)] - body[k, 2]
            least = min(least, there - half_cell)
    return least
