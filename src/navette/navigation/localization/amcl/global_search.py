"""Search the whole map for the poses from which a scan fits.

Random particles rarely hit the right pose of a large map. Here all free cells (at a
coarse spacing) and headings are scored with a blurred field, and the best ones are
refined, so that a few particles per candidate suffice. On a large map, blocks of such
cells are scored first, with the best value that any cell of a block may have, and only
the best blocks are searched: time and memory stay within bounds.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, wrap_angles
from navette.navigation.localization.amcl.bins import bin_keys
from navette.navigation.localization.amcl.likelihood_field import (
    LikelihoodField,
    Points,
    Poses,
)
from navette.navigation.localization.amcl.recent_scans import thinned

_HEADINGS = 48
_SPACING_M = 0.25
_MOST_POSES, _MOST_BLOCKS = 600_000, 2_500_000
_MOST_CELLS = _MOST_POSES // _HEADINGS
_BLOCK = 4  # edge of a block of coarse cells; twice as many until they are few enough
_BEAMS = 24
_BLUR_M, _RANDOM = 0.35, 0.2
_REFINED = 250  # coarse poses that are refined, the best ones …
_PLACES, _RANKED = 250, 8000  # … and those of so many places, among so many
_CANDIDATES = 100  # and at most so many different ones of them are returned
_APART_M, _APART_RAD = 0.5, 0.35


class Candidates(NamedTuple):
    """Poses from which a scan fits the map, the best one first.

    Attributes:
        poses: (N, 3) x, y, yaw in the map.
        scores: (N,) mean log likelihood of the beams.
    """

    poses: Poses
    scores: NDArray[np.float64]


def search_map(field: LikelihoodField, points: Points) -> Candidates:
    """Return the poses of the base from which the points (M, 2), base, fit the map."""
    is_free = field.is_free()
    if not len(points) or not is_free.any():
        return Candidates(np.empty((0, 3)), np.empty(0))
    few = thinned(points, _BEAMS)
    blurred = field.blurred(_BLUR_M, _RANDOM)
    poses = _coarse_poses(blurred, is_free, few)
    coarse = blurred.scores(poses, few)
    count = min(_RANKED, len(poses))
    best = np.argpartition(-coarse, count - 1)[:count]
    best = best[np.argsort(-coarse[best], kind="stable")]
    # Neighbours of a place that fits well must not displace the other places.
    keys = bin_keys(poses[best], _APART_M, _APART_RAD)
    first_of_place = np.sort(np.unique(keys, return_index=True)[1])[:_PLACES]
    best = best[np.union1d(np.arange(min(_REFINED, count)), first_of_place)]
    refined, scores = field.refined(poses[best], points, 0.1, math.radians(3.0))
    order = np.argsort(-scores, kind="stable")
    chosen = different(refined[order], _CANDIDATES)
    return Candidates(refined[order][chosen], scores[order][chosen])


def different(poses: Poses, most: int) -> NDArray[np.int64]:
    """Return indices of poses that differ from all earlier chosen ones."""
    chosen: list[int] = []
    for index, pose in enumerate(poses):
        if not is_same(poses[chosen], Pose2(*pose)).any():
            chosen.append(index)
            if len(chosen) == most:
                break
    return np.array(chosen, np.int64)


def is_same(poses: Poses, pose: Pose2) -> NDArray[np.bool_]:
    """Return which poses (N, 3) are of the same place and heading as another one."""
    near = np.hypot(poses[:, 0] - pose.x, poses[:, 1] - pose.y) < _APART_M
    turn = np.abs(wrap_angles(poses[:, 2] - pose.yaw))
    same: NDArray[np.bool_] = near & (turn < _APART_RAD)
    return same


def _coarse_poses(
    field: LikelihoodField, is_free: NDArray[np.bool_], points: Points
) -> Poses:
    """Return poses (N, 3) at free cells, the most promising ones of a large map."""
    step = max(1, round(_SPACING_M / field.spec.resolution))
    offset = step // 2
    on_grid = is_free[offset::step, offset::step]
    if not on_grid.any():  # narrow places between the grid's lines
        free = np.argwhere(is_free)
        return _with_headings(field, free[:: -(-len(free) // _MOST_CELLS)])
    if on_grid.sum() <= _MOST_CELLS:
        return _with_headings(field, offset + step * np.argwhere(on_grid))
    edge = _BLOCK
    while np.count_nonzero(_blocks(on_grid, edge)) * _HEADINGS > _MOST_BLOCKS:
        edge *= 2
    blocks = np.argwhere(_blocks(on_grid, edge))
    centers = blocks * (edge * step) + offset + (edge - 1) * step // 2
    poses = _with_headings(field, centers)
    half_diagonal_m = math.hypot(0.5, 0.5) * edge * step * field.spec.resolution
    bounds = field.best_within(half_diagonal_m).scores(poses, points)
    kept = min(len(poses), _MOST_POSES // edge**2)
    best = np.sort(np.argpartition(-bounds, kept - 1)[:kept])
    inside = np.argwhere(np.ones((edge, edge), np.bool_))
    cells = (edge * blocks[best // _HEADINGS, None] + inside).reshape(-1, 2)
    headings = np.repeat(poses[best, 2], edge**2)
    rows, columns = np.minimum(cells, np.array(on_grid.shape) - 1).T
    chosen = on_grid[rows, columns] & (cells < on_grid.shape).all(axis=1)
    places = field.spec.centers_of(offset + step * cells[chosen])
    return np.column_stack([places, headings[chosen]])


def _blocks(on_grid: NDArray[np.bool_], edge: int) -> NDArray[np.bool_]:
    """Return whether squares of ``edge`` × ``edge`` cells have a free one."""
    height, width = (-(-size // edge) for size in on_grid.shape)
    padded = np.zeros((height * edge, width * edge), np.bool_)
    padded[: on_grid.shape[0], : on_grid.shape[1]] = on_grid
    tiles = padded.reshape(height, edge, width, edge)
    found: NDArray[np.bool_] = np.logical_or.reduce(tiles, axis=(1, 3))
    return found


def _with_headings(field: LikelihoodField, cells: NDArray[np.int64]) -> Poses:
    """Return the poses (N · headings, 3) at the centres of cells (N, 2)."""
    headings = np.arange(_HEADINGS) * (2 * math.pi / _HEADINGS) - math.pi
    poses = np.empty((len(cells), _HEADINGS, 3))
    poses[:, :, :2] = field.spec.centers_of(cells)[:, None]
    poses[:, :, 2] = headings
    return poses.reshape(-1, 3)
