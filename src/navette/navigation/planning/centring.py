"""Centre a line in tight places: an elastic band (Quinlan and Khatib 1993).

A route of the grid may be half a cell off the middle of a door, and cross it at an
angle. Here each point moves sideways to where the body, with the heading of the line,
has more clearance, and then towards the midpoint of its neighbours; repeatedly.
"""

import numpy as np
from numpy.typing import NDArray

from navette.navigation.planning.footprint_check import exact_body_clearances
from navette.navigation.planning.path_shape import Points, Poses, headed
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid

_ROUNDS = 40
_STEP_M = 0.01
# Clearance, above the margin, from which a point need not move.
_ENOUGH_M = 0.05


def centred(points: Points, grid: PlanningGrid, body: BodyShape) -> Points:
    """Return the line (N, 2) with the largest least clearance; the ends stay."""
    line = points.copy()
    best, best_least = line, -np.inf
    enough = grid.margin_m + _ENOUGH_M
    for _ in range(_ROUNDS):
        poses = headed(line)
        here = exact_body_clearances(poses, grid, body, enough)
        least = here[1:-1].min(initial=enough)
        if least > best_least + 1e-4:
            best, best_least = line.copy(), least
        tight = here < enough
        tight[[0, -1]] = False
        if not tight.any():
            break
        line[tight] = _pushed(poses[tight], here[tight], grid, body, enough)
        # The neighbours too, or the line gets kinks.
        near = np.convolve(tight, np.ones(5))[2 : len(tight) + 2] > 0
        near[[0, -1]] = False
        middles = 0.5 * line[1:-1] + 0.25 * (line[:-2] + line[2:])
        line[1:-1][near[1:-1]] = middles[near[1:-1]]
    return best


def _pushed(
    poses: Poses,
    here: NDArray[np.float64],
    grid: PlanningGrid,
    body: BodyShape,
    enough: float,
) -> Points:
    """Return the positions (N, 2) a step to the side with more clearance."""
    side = np.column_stack([-np.sin(poses[:, 2]), np.cos(poses[:, 2])]) * _STEP_M
    moved = []
    for sign in (1.0, -1.0):
        shifted = poses.copy()
        shifted[:, :2] += sign * side
        moved.append(exact_body_clearances(shifted, grid, body, enough))
    left, right = moved
    step = np.where(left > np.maximum(here, right), 1.0, 0.0)
    step = np.where(right > np.maximum(here, left), -1.0, step)
    return np.asarray(poses[:, :2] + step[:, None] * side)
