"""Compiled rollouts of command sequences, and their cost.

The samples of a chunk advance together, one float32 array per quantity, so that the
compiler vectorises the loops over them. Positions are relative to the robot: float32
has 0.1 µm there, and centimetres at UTM coordinates. The cost of a sample does not
depend on the others.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.control.drive_models import (
    ACKERMANN,
    CURVATURE,
    DIFFERENTIAL,
    FORWARD,
    SIDE,
    TURN_RATE,
    DriveLimits,
    advance_ackermann,
    advance_differential,
    advance_omni,
)

Array = NDArray[np.float64]
Array32 = NDArray[np.float32]
Indices = NDArray[np.int32]

# Metres that a radian of heading error or of turning in place counts as.
METRES_PER_RADIAN = 0.5
# Cost of a rollout that collides; earlier collisions cost more.
COLLISION = 200.0
# Cost of the path left on average, relative to that left at the end.
DELAY_SHARE = 0.5
# Share of the clearance cost that counts where the path has as little clearance.
SHARE_ON_PATH = 0.25
# Clearance of the path below which that of the samples is interpolated.
TIGHT_M = 0.12
# Samples that advance together: their arrays stay in the first-level cache.
CHUNK = 256
# Poses of the path that a sample may advance in one step.
_MOST_POSES = 8

# Rows of poses (4, n): position (m), cosine and sine of the heading.
_X, _Y, _COS, _SIN = 0, 1, 2, 3


class CostWeights(NamedTuple):
    """Weights of the critics in float32; see ControlParams."""

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


class PathTable(NamedTuple):
    """A :class:`PathWindow` for kernels.

    Attributes:
        poses: (6, N + reach) float32, rows x, y (relative to the robot), cos, sin,
            measure, direction; the last pose is repeated.
        reach: number of poses that a sample can advance in one step.
    """

    poses: Array32
    reach: int

    @classmethod
    def of(cls, path: PathWindow, x: float, y: float, farthest_m: float) -> "PathTable":
        """Args: path; position of the robot (m, map); longest motion in a step (m)."""
        measure = path.measure
        count = len(measure)
        spacing = (measure[-1] - measure[0]) / max(count - 1, 1)
        reach = min(_MOST_POSES, math.ceil(farthest_m / max(spacing, 1e-3)) + 1)
        poses = np.empty((6, count + reach), np.float32)
        _fill_poses(path, x, y, poses)
        return cls(poses, reach)


@kernel(allocates=False)
def _fill_poses(path: PathWindow, x: float, y: float, poses: Array32) -> None:
    last = path.x.size - 1
    for k in range(poses.shape[1]):
        i = min(k, last)
        poses[0, k], poses[1, k] = path.x[i] - x, path.y[i] - y
        poses[2, k], poses[3, k] = path.cos[i], path.sin[i]
        poses[4, k], poses[5, k] = path.measure[i] - path.measure[0], path.direction[i]


class LocalField(NamedTuple):
    """Distance to the obstacles around the robot.

    Attributes:
        distance_m: (H, W) float32 at cell centres; the border is far from all.
        x, y: corner of cell (0, 0) in the map; the grid is not rotated.
        resolution: edge of a cell, m.
        half_cell_m: half the edge of the obstacles' cells: they may fill them.
    """

    distance_m: Array32
    x: float
    y: float
    resolution: float
    half_cell_m: float


class RolloutBody(NamedTuple):
    """Points (P, 3) x, y, disc radius of the body, base frame, and their reach; m."""

    points: Array32
    reach_m: float

    @classmethod
    def of(cls, points: Array) -> "RolloutBody":
        """Args: points; see :func:`navette.navigation.grids.body_points`."""
        reach = float(np.hypot(points[:, 0], points[:, 1]).max())
        return cls(np.ascontiguousarray(points, np.float32), reach)


@kernel(fastmath=True)
def rollout_costs(
    commands: Array32,
    start: Array,
    step_s: float,
    drive: int,
    limits: DriveLimits,
    path: PathTable,
    field: LocalField,
    body: RolloutBody,
    weights: CostWeights,
    costs: Array32,
) -> None:
    """Write the cost of every sample.

    Args:
        commands: (T, D, K) of K samples at T steps, limited here in place; D is
            speed and turn rate (differential), speed and curvature (Ackermann), or
            speed, speed to the left and turn rate (omni).
        start: yaw, forward speed, speed to the left, turn rate, curvature.
        step_s: time of a step.
        drive: code of the drive.
        limits: limits of the drive.
        path: the path to follow, relative to the robot.
        field: distance to obstacles, relative to the robot.
        body: points of the body.
        weights: weights of the critics.
        costs: (K,), written.
    """
    count = costs.shape[0]
    on_path = _lack_on_path(path, field, body, weights.clearance_m)
    for first in range(0, count, CHUNK):
        last = min(count, first + CHUNK)
        _chunk_costs(commands, first, start, step_s, drive, limits, path, on_path,
                     field, body, weights, costs[first:last])  # fmt: skip


@kernel(fastmath=True)
def _lack_on_path(
    path: PathTable, field: LocalField, body: RolloutBody, enough_m: float
) -> Array32:
    """Return (N,) the squared lack of clearance (m²) at each pose of the path."""
    count = path.poses.shape[1]
    near = np.empty((5, count), np.float32)
    index, cells = np.empty(count, np.int32), np.empty(count, np.int32)
    lack = np.zeros(count, np.float32)
    found = _near_obstacles(path.poses, field, body, enough_m, near, index, cells)
    if found > 0:
        _clearances(field, body, enough_m, near, found, True)
        for i in range(found):
            less = np.float32(enough_m) - near[4, i]
            lack[np.uint32(index[i])] = less * less
    return lack


@kernel(fastmath=True)
def _chunk_costs(
    commands: Array32,
    first: int,
    start: Array,
    step_s: float,
    drive: int,
    limits: DriveLimits,
    path: PathTable,
    on_path: Array32,
    field: LocalField,
    body: RolloutBody,
    weights: CostWeights,
    costs: Array32,
) -> None:
    n = costs.size
    last = first + n
    steps = commands.shape[0]
    pose, speed = np.empty((4, n), np.float32), np.empty((4, n), np.float32)
    pose[_X], pose[_Y] = 0.0, 0.0
    pose[_COS], pose[_SIN] = math.cos(start[0]), math.sin(start[0])
    for row in range(4):
        speed[row] = start[1 + row]
    steering = CURVATURE if drive == ACKERMANN else TURN_RATE
    before, apart = np.empty(n, np.float32), np.empty(n, np.float32)
    at = np.zeros(n, np.int32)
    near = np.empty((5, n), np.float32)
    index, cells = np.empty(n, np.int32), np.empty(n, np.int32)
    is_tight: Any = _largest(on_path) > (weights.clearance_m - np.float32(TIGHT_M)) ** 2
    costs[:] = 0.0
    for t in range(steps):
        before[:] = speed[steering]
        speeds, turns = commands[t, 0, first:last], commands[t, 1, first:last]
        if drive == DIFFERENTIAL:
            advance_differential(limits, step_s, speeds, turns, speed)
        elif drive == ACKERMANN:
            advance_ackermann(limits, step_s, speeds, turns, speed)
        else:
            rates = commands[t, 2, first:last]
            advance_omni(limits, step_s, speeds, turns, rates, speed)
        _effort_costs(before, speed[steering], weights.effort, costs)
        move(pose, speed, step_s)
        _nearest(path, pose, at, apart)
        found = _near_obstacles(pose, field, body, weights.clearance_m, near, index,
                                cells)  # fmt: skip
        if found > 0:
            _clearances(field, body, weights.clearance_m, near, found, is_tight)
            earlier: Any = np.float32((1.0 - 0.5 * t / steps) / steps)
            _clearance_costs(near[4], found, index, on_path, at, weights, step_s,
                             earlier, costs)  # fmt: skip
        _path_costs(pose, speed[FORWARD], path, at, apart, weights, step_s, costs)
        _delay_costs(path, at, weights.progress, steps, costs)
    _remaining_costs(pose, path, at, weights.progress, costs)


@kernel(allocates=False)
def _largest(values: Array32) -> float:
    # Not values.max(): its machine code imports Numba's implementation, and SciPy.
    largest: float = values[0]
    for value in values:
        largest = max(largest, value)
    return largest


@kernel(allocates=False, fastmath=True)
def _effort_costs(
    before: Array32, after: Array32, weight: float, costs: Array32
) -> None:
    for i in range(costs.size):
        change = after[i] - before[i]
        costs[i] += weight * change * change


@kernel(fastmath=True)
def move(pose: Array32, speed: Array32, step_s: float) -> None:
    """Drive a step, with the heading at half of it.

    Cosine and sine of half the turn are series, to 1e-6 below 0.5 rad.
    """
    F = np.float32
    x, y, cos, sin = pose[_X], pose[_Y], pose[_COS], pose[_SIN]
    forward, side, turn_rate = speed[FORWARD], speed[SIDE], speed[TURN_RATE]
    for i in range(x.size):
        half = F(0.5) * turn_rate[i] * step_s
        a2 = half * half
        ch = F(1.0) - a2 * (F(0.5) - a2 * F(1.0 / 24.0))
        sh = half * (F(1.0) - a2 * (F(1.0 / 6.0) - a2 * F(1.0 / 120.0)))
        c, s = cos[i] * ch - sin[i] * sh, sin[i] * ch + cos[i] * sh
        x[i] += step_s * (forward[i] * c - side[i] * s)
        y[i] += step_s * (forward[i] * s + side[i] * c)
        cos[i], sin[i] = c * ch - s * sh, s * ch + c * sh


@kernel(fastmath=True)
def _near_obstacles(
    pose: Array32,
    field: LocalField,
    body: RolloutBody,
    enough_m: float,
    near: Array32,
    index: Indices,
    cells: Indices,
) -> int:
    """Collect the samples whose clearance may be less than enough; return how many.

    Rows 0-3 of ``near`` get u, v (cells), cosine and sine (cells per metre), ``index``
    the samples; ``cells`` is overwritten.
    """
    F: Any = np.float32
    per_metre = F(1.0 / field.resolution)
    left, bottom = F(field.x / field.resolution), F(field.y / field.resolution)
    half_cell = max(field.half_cell_m, 0.5 * field.resolution)
    # Between the centres of two cells it is up to √2 cells more than between points.
    needed = F(enough_m + body.reach_m + half_cell + 1.5 * field.resolution)
    x, y, cos, sin = pose[_X], pose[_Y], pose[_COS], pose[_SIN]
    _cells_of(field.distance_m.shape, x, y, per_metre, left, bottom, cells)
    flat = field.distance_m.reshape(-1)
    found = 0
    for i in range(x.size):  # without a branch: every other one would be mispredicted
        index[found] = i
        found += flat[np.uint32(cells[i])] < needed
    u, v, across, along = near[0], near[1], near[2], near[3]
    for k in range(found):
        of = np.uint32(index[k])
        u[k], v[k] = x[of] * per_metre - left, y[of] * per_metre - bottom
        across[k], along[k] = cos[of] * per_metre, sin[of] * per_metre
    return found


@kernel(fastmath=True)
def _cells_of(
    shape: tuple[int, int],
    x: Array32,
    y: Array32,
    per_metre: float,
    left: float,
    bottom: float,
    cells: Indices,
) -> None:
    """Write the flat index of the cell of every position, or of one at the border."""
    F, I = np.float32, np.int32
    right, top, stride = F(shape[1] - 1), F(shape[0] - 1), I(shape[1])
    for i in range(x.size):
        u, v = x[i] * per_metre - left, y[i] * per_metre - bottom
        column, row = I(min(right, max(F(0.0), u))), I(min(top, max(F(0.0), v)))
        cells[i] = row * stride + column


@kernel(fastmath=True)
def _clearances(
    field: LocalField,
    body: RolloutBody,
    enough_m: float,
    near: Array32,
    count: int,
    exact: bool,
) -> None:
    """Write the clearance of the bodies to row 4 of ``near``; at most enough.

    ``exact``: bilinear between cell centres, at twice the time; otherwise that of the
    cell, less half a cell.
    """
    for i in range(count):
        near[4, i] = enough_m
    grid = field.distance_m
    flat, cells = grid.reshape(-1), np.empty(count, np.int32)
    half_cell = field.half_cell_m
    if not exact:
        half_cell = max(half_cell, 0.5 * field.resolution)
    for k in range(body.points.shape[0]):
        point = body.points[k]
        less: Any = np.float32(point[2] + half_cell)
        if exact:
            _lower_between(grid, point, less, near[:, :count])
        else:
            _cells_of_point(grid.shape, point, near, cells)
            _lower(flat, cells, less, near[4])


@kernel(fastmath=True)
def _lower_between(field: Array32, point: Array32, less: float, near: Array32) -> None:
    """Lower the clearances to that of a body point, between four cell centres."""
    F, I = np.float32, np.int32
    flat, stride = field.reshape(-1), I(field.shape[1])
    right, top = F(field.shape[1] - 1.001), F(field.shape[0] - 1.001)
    bx, by = point[0], point[1]
    u, v, cos, sin, least = near[0], near[1], near[2], near[3], near[4]
    for i in range(least.size):
        pu = min(right, max(F(0.0), u[i] + cos[i] * bx - sin[i] * by - F(0.5)))
        pv = min(top, max(F(0.0), v[i] + sin[i] * bx + cos[i] * by - F(0.5)))
        column, row = I(pu), I(pv)
        fu, fv = pu - F(column), pv - F(row)
        low = np.uint32(row * stride + column)
        high = low + np.uint32(stride)
        a, b = flat[low], flat[low + np.uint32(1)]
        c, d = flat[high], flat[high + np.uint32(1)]
        below, above = a + (b - a) * fu, c + (d - c) * fu
        least[i] = min(least[i], below + (above - below) * fv - less)


@kernel(fastmath=True)
def _cells_of_point(
    shape: tuple[int, int], point: Array32, near: Array32, cells: Indices
) -> None:
    """Write the flat index of the cell of a body point for every sample."""
    F, I = np.float32, np.int32
    right, top, stride = F(shape[1] - 1), F(shape[0] - 1), I(shape[1])
    bx, by = point[0], point[1]
    u, v, cos, sin = near[0], near[1], near[2], near[3]
    for i in range(cells.size):
        pu = u[i] + cos[i] * bx - sin[i] * by
        pv = v[i] + sin[i] * bx + cos[i] * by
        column = I(min(right, max(F(0.0), pu)))
        row = I(min(top, max(F(0.0), pv)))
        cells[i] = row * stride + column


@kernel(allocates=False, fastmath=True)
def _lower(flat: Array32, cells: Indices, less: float, least: Array32) -> None:
    """Lower the clearances to that of a body point, in the cells."""
    for i in range(cells.size):
        there = flat[np.uint32(cells[i])] - less
        least[i] = min(least[i], there)


@kernel(fastmath=True)
def _clearance_costs(
    clearance: Array32,
    count: int,
    index: Indices,
    on_path: Array32,
    at: Indices,
    weights: CostWeights,
    step_s: float,
    earlier: float,
    costs: Array32,
) -> None:
    """Add the costs of collisions, and of little clearance.

    Where the path itself has little, only a share of that counts: at its full cost the
    robot would wait before a narrow passage.
    """
    F = np.float32
    enough, margin = weights.clearance_m, weights.margin_m
    per_lack = weights.clearance * step_s / (enough * enough)
    collision = F(COLLISION) * earlier
    for i in range(count):
        sample = np.uint32(index[i])
        lack = enough - clearance[i]
        square = lack * lack
        less = square - on_path[np.uint32(at[sample])]
        counted = max(less, F(SHARE_ON_PATH) * square)
        depth = F(1.0) + min(F(1.0), (margin - clearance[i]) * F(10.0))
        collides = collision * depth if clearance[i] < margin else F(0.0)
        costs[sample] += per_lack * counted + collides


@kernel(fastmath=True)
def _nearest(path: PathTable, pose: Array32, at: Indices, apart: Array32) -> None:
    """Advance every sample to the nearest of the poses that it can have reached.

    ``apart`` gets the squared distance, in which 2 (1 − cos θ) stands for θ².
    """
    x, y, cos, sin = pose[_X], pose[_Y], pose[_COS], pose[_SIN]
    px, py, pc, ps = path.poses[0], path.poses[1], path.poses[2], path.poses[3]
    last = np.int32(path.poses.shape[1] - 1 - path.reach)
    count = np.uint32(path.reach + 1)
    for i in range(at.size):
        nearest = first = np.uint32(at[i])
        x_i, y_i, cos_i, sin_i = x[i], y[i], cos[i], sin[i]
        least: Any = np.float32(1e30)
        for k in range(count):
            to = first + np.uint32(k)
            there = _squared_distance(
                x_i, y_i, sin_i, cos_i, px[to], py[to], ps[to], pc[to]
            )
            nearest = to if there < least else nearest
            least = min(least, there)
        apart[i] = least
        at[i] = min(np.int32(nearest), last)


@kernel(allocates=False, fastmath={"contract"})
def _squared_distance(
    x: float, y: float, sin: float, cos: float,
    px: float, py: float, ps: float, pc: float,
) -> float:  # fmt: skip
    """Return the squared distance of two poses, see :func:`_nearest`."""
    per_turn: Any = np.float32(2.0 * METRES_PER_RADIAN**2)
    dx, dy = x - px, y - py
    squared: float = dy * dy + (dx * dx + (per_turn - per_turn * (sin * ps + cos * pc)))
    return squared


@kernel(fastmath=True)
def _path_costs(
    pose: Array32,
    forward: Array32,
    path: PathTable,
    at: Indices,
    apart: Array32,
    weights: CostWeights,
    step_s: float,
    costs: Array32,
) -> None:
    """Add the costs of the distance from the path and of driving against it."""
    F = np.float32
    cos, sin = pose[_COS], pose[_SIN]
    pc, ps, direction = path.poses[2], path.poses[3], path.poses[5]
    per_turn = F(METRES_PER_RADIAN**2)
    for i in range(at.size):
        near = np.uint32(at[i])
        turned = F(2.0) * (F(1.0) - cos[i] * pc[near] - sin[i] * ps[near])
        away = apart[i] - per_turn * turned
        against = max(F(0.0), -forward[i] * direction[near])
        cost = weights.align * away + weights.heading * turned
        costs[i] += (cost + weights.reverse * against) * step_s


@kernel(allocates=False, fastmath=True)
def _delay_costs(
    path: PathTable, at: Indices, weight: float, steps: int, costs: Array32
) -> None:
    """Add the mean cost of the path that is left: to arrive later costs more.

    With the path left at the end of the rollout alone, a path shorter than the
    horizon can be driven at its end as well as now, and at every step again later.
    """
    measure = path.poses[4]
    end = measure[-1]
    share = np.float32(DELAY_SHARE / steps) * weight
    for i in range(at.size):
        costs[i] += share * (end - measure[np.uint32(at[i])])


@kernel(allocates=False, fastmath=True)
def _remaining_costs(
    pose: Array32, path: PathTable, at: Indices, weight: float, costs: Array32
) -> None:
    """Add the cost of the path that is left at the end of the rollout."""
    px, py, measure = path.poses[0], path.poses[1], path.poses[4]
    end = measure[-1]
    for i in range(at.size):
        near = np.uint32(at[i])
        dx, dy = pose[_X, i] - px[near], pose[_Y, i] - py[near]
        ahead = end - measure[near] + np.float32(0.5) * math.sqrt(dx * dx + dy * dy)
        costs[i] += weight * ahead
