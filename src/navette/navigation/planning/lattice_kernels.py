"""Compiled kernels of the lattice search.

Costs are in units; see :mod:`.traversal`. Array columns are named by the constants.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import (
    Body,
    DistanceGrid,
    ObstacleGrid,
    Outline,
    exact_clearance,
    pose_clearance,
    pose_is_clear,
)
from navette.navigation.planning.bucket_queue import (
    WAITING,
    BucketQueue,
    pop,
    push,
    reserve,
)
from navette.navigation.planning.dijkstra import UNREACHED, Guide, to_go

SHIFT = 10
BUCKETS = 1 << 13
# Values kept per bin are ROOM − g, so that memory never written (0) is the worst.
ROOM = 1 << 30
NOWHERE = 1 << 60
# The heuristic ignores headings and underestimates; weighted A* (Pohl 1970) gives up
# optimality, within this factor, to avoid expanding every turn in place.
HEURISTIC_WEIGHT = 1.5
# Ends this near the goal cost the same: manoeuvring for centimetres is useless.
GOOD_ENOUGH_M = 0.1
# Additional cost factor of a pose at the margin, relative to a comfortable one.
DISCOMFORT = 2.0
# Additional cost factor of a pose that touches an obstacle, relative to one at the
# margin: from a start within the margin, the path leads away from the obstacle first.
TOUCHING = 10.0

# Columns of Tree.links.
HEADING, G, PARENT, MOVE, ESCAPING = 0, 1, 2, 3, 4


class LatticeScene(NamedTuple):
    """Map and body for the kernels; see :class:`.lattice.LatticeWorld`."""

    grid: DistanceGrid
    factors: NDArray[np.float32]
    guide: Guide
    body: Body
    obstacles: ObstacleGrid
    outline: Outline
    unseen: ObstacleGrid
    unseen_distance: DistanceGrid
    margin_m: float
    comfort_m: float


class MoveTable(NamedTuple):
    """The moves; see :class:`.lattice_motions.Motions`. Costs in units."""

    offsets: NDArray[np.float64]
    counts: NDArray[np.int64]
    costs: NDArray[np.float64]
    cusp_cost: float
    directions: NDArray[np.int8]
    turns: NDArray[np.int64]
    headings: int


class Tree(NamedTuple):
    """The search tree and the best pose per bin.

    Attributes:
        position: (M, 2) x, y.
        links: (M, 5) int32: heading, g, parent, move, escaping.
        kept: (rows · columns · headings,) ROOM − g of the best pose in each bin.
        bin_cells: edge of a bin in cells.
        bins_wide: bins in a row.
        queue: the open list; see :mod:`.bucket_queue`.
    """

    position: NDArray[np.float64]
    links: NDArray[np.int32]
    kept: NDArray[np.int32]
    bin_cells: float
    bins_wide: int
    queue: BucketQueue


@kernel
def grow(
    scene: Any,
    moves: Any,
    tree: Any,
    start: tuple[float, float, float],
    goal: Any,
    pool: Any,
    budget: int,
) -> tuple[int, int]:
    """Grow the tree from ``start``; return (node at the goal or −1, nodes expanded).

    ``goal`` is x, y, tolerance, yaw or NaN, yaw tolerance, units per metre off, and
    units of a metre.
    """
    queue = tree.queue
    clearance = _clearance(scene, start[0], start[1], start[2], scene.margin_m)
    escape_m = clearance - 1e-3
    bucket = _add_root(scene, tree, start, clearance < scene.margin_m)
    # int64 from the start: a literal would compile the callee a second time.
    used: Any = np.int64(1)
    push(pool, queue, bucket, used - 1)
    expanded = 0
    best, best_node = np.int64(NOWHERE), -1
    turn = 2 * np.pi / moves.headings
    while queue.state[WAITING] > 0 and expanded < budget and bucket < best >> SHIFT:
        node = pop(pool, queue, bucket)
        if node < 0:
            bucket += 1
            continue
        x, y = tree.position[node, 0], tree.position[node, 1]
        heading: Any = np.int64(tree.links[node, HEADING])
        at = _bin(tree, scene.grid.frame, x, y, heading, moves.headings)
        if node != 0 and tree.kept[at] != ROOM - tree.links[node, G]:
            continue
        expanded += 1
        yaw = start[2] + heading * turn
        if not tree.links[node, ESCAPING]:
            total = tree.links[node, G] + _arrival(scene, goal, x, y, yaw)
            if total < best:
                best, best_node = total, node
        pool = reserve(pool, queue, moves.counts.shape[0])
        used, bucket = _branch(
            scene, moves, tree, node, yaw, escape_m, used, pool, bucket
        )
    return best_node, expanded


@kernel(allocates=False)
def _add_root(scene: Any, tree: Any, start: Any, escaping: bool) -> int:
    """Create the root; return its bucket."""
    tree.position[0, 0], tree.position[0, 1] = start[0], start[1]
    tree.links[0, HEADING], tree.links[0, G] = 0, 0
    tree.links[0, PARENT], tree.links[0, MOVE] = -1, -1
    tree.links[0, ESCAPING] = escaping
    u, v = _to_cells(scene.grid.frame, start[0], start[1])
    ahead = to_go(scene.guide, int(v), int(u))
    nothing: Any = np.int64(0)  # a literal would compile the callee a second time
    return _estimate(nothing, ahead) >> SHIFT


@kernel(allocates=False)
def _branch(
    scene: Any,
    moves: Any,
    tree: Any,
    node: int,
    yaw: float,
    escape_m: float,
    used: int,
    pool: Any,
    bucket: int,
) -> tuple[int, int]:
    """Try every move from ``node``; return (nodes in the tree, first bucket in use).

    The weighted heuristic is inconsistent: f may decrease along a move, and the first
    bucket with it.
    """
    first = bucket
    x, y = tree.position[node, 0], tree.position[node, 1]
    cos, sin = math.cos(yaw), math.sin(yaw)
    escaping = tree.links[node, ESCAPING] != 0
    needed = escape_m if escaping else scene.margin_m
    for m in range(moves.counts.shape[0]):
        end = moves.counts[m] - 1
        dx, dy = moves.offsets[m, end, 0], moves.offsets[m, end, 1]
        dyaw = moves.offsets[m, end, 2]
        x_new, y_new = x + cos * dx - sin * dy, y + sin * dx + cos * dy
        ahead, factor = _cell_values(scene, x_new, y_new)
        if factor < 0.0 or (ahead >= UNREACHED and not escaping):
            continue
        heading = np.int64(tree.links[node, HEADING] + moves.turns[m]) % moves.headings
        at = _bin(tree, scene.grid.frame, x_new, y_new, heading, moves.headings)
        g = tree.links[node, G] + _step_cost(moves, tree.links[node, MOVE], m, factor)
        if ROOM - g <= tree.kept[at] or used >= tree.links.shape[0]:
            continue
        if not _fits(scene, moves, m, x, y, yaw, needed):
            continue
        clearance = _clearance(scene, x_new, y_new, yaw + dyaw, scene.comfort_m)
        lack = (scene.comfort_m - clearance) / (scene.comfort_m - scene.margin_m)
        if lack > 0.0:
            within = 1.0 - clearance / scene.margin_m if escaping else 0.0
            factor = DISCOMFORT * lack + TOUCHING * max(0.0, within)
            g += np.int64(moves.costs[m] * factor)
        if ROOM - g <= tree.kept[at]:
            continue
        tree.kept[at] = ROOM - g
        tree.position[used, 0], tree.position[used, 1] = x_new, y_new
        tree.links[used, HEADING], tree.links[used, G] = heading, g
        tree.links[used, PARENT], tree.links[used, MOVE] = node, m
        tree.links[used, ESCAPING] = escaping and clearance < scene.margin_m
        slot = _estimate(g, ahead) >> SHIFT
        first = slot if slot < first else first
        last = first + BUCKETS - 2
        push(pool, tree.queue, slot if slot < last else last, used)
        used += 1
    return used, first


@kernel(allocates=False)
def _estimate(g: int, ahead: int) -> int:
    """Return f, the estimated cost of a path through this pose."""
    return g + (int(HEURISTIC_WEIGHT * ahead) if ahead < UNREACHED else 0)


@kernel(allocates=False)
def _step_cost(moves: Any, before: int, m: int, factor: float) -> int:
    cost = moves.costs[m] * factor
    if before >= 0 and moves.directions[before] * moves.directions[m] < 0:
        cost += moves.cusp_cost
    return int(cost)


@kernel(allocates=False)
def _fits(
    scene: Any, moves: Any, m: int, x: float, y: float, yaw: float, needed_m: float
) -> bool:
    """Return whether the body keeps its clearance at every sample of move ``m``."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    for k in range(moves.counts[m]):
        dx, dy = moves.offsets[m, k, 0], moves.offsets[m, k, 1]
        px, py = x + cos * dx - sin * dy, y + sin * dx + cos * dy
        pyaw = yaw + moves.offsets[m, k, 2]
        if pose_is_clear(scene.grid, scene.body, px, py, pyaw, needed_m):
            continue
        if _exact(scene, px, py, pyaw, needed_m) < needed_m:
            return False
    return moves.directions[m] >= 0 or _is_seen(scene, moves, m, x, y, yaw)


@kernel(allocates=False)
def _is_seen(scene: Any, moves: Any, m: int, x: float, y: float, yaw: float) -> bool:
    """Return whether the body stays in space that was seen at the end of move ``m``."""
    end = moves.counts[m] - 1
    dx, dy = moves.offsets[m, end, 0], moves.offsets[m, end, 1]
    cos, sin = math.cos(yaw), math.sin(yaw)
    px, py = x + cos * dx - sin * dy, y + sin * dx + cos * dy
    pyaw = yaw + moves.offsets[m, end, 2]
    if pose_is_clear(scene.unseen_distance, scene.body, px, py, pyaw, 0.0):
        return True
    # A cell under the edge of the body is part of the border, not entered.
    border = -0.5 * scene.unseen.frame.resolution
    depth: float = exact_clearance(scene.unseen, scene.outline, px, py, pyaw, 0.0)
    return bool(depth >= border)


@kernel(allocates=False)
def _exact(scene: Any, x: float, y: float, yaw: float, enough_m: float) -> float:
    """Return the exact clearance, where the distance field cannot prove enough."""
    clearance: float = exact_clearance(
        scene.obstacles, scene.outline, x, y, yaw, enough_m
    )
    return clearance


@kernel(allocates=False)
def _clearance(scene: Any, x: float, y: float, yaw: float, enough_m: float) -> float:
    clearance: float = pose_clearance(scene.grid, scene.body, x, y, yaw, enough_m)
    if clearance < scene.margin_m:
        return _exact(scene, x, y, yaw, scene.margin_m)
    return clearance


@kernel(allocates=False)
def _cell_values(scene: Any, x: float, y: float) -> tuple[int, float]:
    """Return (cost to go, cost factor) at a point; the factor is −1 outside.

    The cost to go is interpolated between cell centres: per cell it would jump by the
    cost of several moves.
    """
    u, v = _to_cells(scene.grid.frame, x, y)
    guide = scene.guide
    cost, stride = guide.grid.cost, guide.grid.stride
    height, width = cost.size // stride - 2, stride - 2
    if not (0.0 <= u < width and 0.0 <= v < height):
        return NOWHERE, -1.0
    row, column = int(v), int(u)
    ahead = to_go(guide, row, column)
    factor = float(scene.factors[cost[(row + 1) * stride + column + 1]])
    u, v = u - 0.5, v - 0.5
    if not (0.0 <= u < width - 1 and 0.0 <= v < height - 1):
        return ahead, factor
    row, column = int(v), int(u)
    a, b = to_go(guide, row, column), to_go(guide, row, column + 1)
    c, d = to_go(guide, row + 1, column), to_go(guide, row + 1, column + 1)
    if a >= UNREACHED or b >= UNREACHED or c >= UNREACHED or d >= UNREACHED:
        return ahead, factor
    u, v = u - column, v - row
    return int((a + (b - a) * u) * (1.0 - v) + (c + (d - c) * u) * v), factor


@kernel(allocates=False)
def _to_cells(frame: Any, x: float, y: float) -> tuple[float, float]:
    dx, dy = x - frame[0], y - frame[1]
    u = (frame[2] * dx + frame[3] * dy) / frame[4]
    return u, (frame[2] * dy - frame[3] * dx) / frame[4]


@kernel(allocates=False)
def _bin(tree: Any, frame: Any, x: float, y: float, heading: int, headings: int) -> int:
    u, v = _to_cells(frame, x, y)
    row, column = int(v / tree.bin_cells), int(u / tree.bin_cells)
    at: int = (row * tree.bins_wide + column) * headings + heading
    return at


@kernel(allocates=False)
def _arrival(scene: Any, goal: Any, x: float, y: float, yaw: float) -> int:
    """Return the cost in units of ending here; NOWHERE outside the goal.

    It grows with the distance to the goal and with lack of clearance, up to the cost of
    a metre driven.
    """
    off = math.hypot(x - goal[0], y - goal[1])
    if off > goal[2]:
        return NOWHERE
    if not math.isnan(goal[3]):
        error = abs((yaw - goal[3] + math.pi) % (2 * math.pi) - math.pi)
        if error > goal[4]:
            return NOWHERE
    lack = scene.comfort_m - _clearance(scene, x, y, yaw, scene.comfort_m)
    cramped = lack / (scene.comfort_m - scene.margin_m) if lack > 0.0 else 0.0
    off = off - GOOD_ENOUGH_M if off > GOOD_ENOUGH_M else 0.0
    return int(goal[5] * off + goal[6] * cramped)
