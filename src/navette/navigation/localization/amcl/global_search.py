"""Search the whole map for the poses from which a scan fits.

Random particles rarely hit the right pose of a large map. Here all free cells (at a
coarse spacing) and headings are scored with a blurred field, and the best ones are
refined, so that a few particles per candidate suffice.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.navigation.localization.amcl.likelihood_field import (
    LikelihoodField,
    Points,
    Poses,
)

_HEADINGS = 48
_SPACING_M = 0.25
_MOST_POSES = 600_000
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
    if not len(points) or not len(field.free):
        return Candidates(np.empty((0, 3)), np.empty(0))
    few = _spread(points, _BEAMS)
    poses = _coarse_poses(field)
    coarse = field.blurred(_BLUR_M, _RANDOM).scores(poses, few)
    count = min(_RANKED, len(poses))
    best = np.argpartition(-coarse, count - 1)[:count]
    best = best[np.argsort(-coarse[best], kind="stable")]
    # Neighbours of a place that fits well must not displace the other places.
    bins = np.floor(poses[best] / (_APART_M, _APART_M, _APART_RAD))
    first_of_place = np.sort(np.unique(bins, axis=0, return_index=True)[1])[:_PLACES]
    best = best[np.union1d(np.arange(min(_REFINED, count)), first_of_place)]
    refined, scores = field.refined(poses[best], points, 0.1, math.radians(3.0))
    order = np.argsort(-scores, kind="stable")
    chosen = different(refined[order], _CANDIDATES)
    return Candidates(refined[order][chosen], scores[order][chosen])


def different(poses: Poses, most: int) -> NDArray[np.int64]:
    """Return indices of poses that differ from all earlier chosen ones."""
    chosen: list[int] = []
    for index, (x, y, yaw) in enumerate(poses):
        others = poses[chosen]
        near = np.hypot(others[:, 0] - x, others[:, 1] - y) < _APART_M
        turn = np.abs((others[:, 2] - yaw + math.pi) % (2 * math.pi) - math.pi)
        if not (near & (turn < _APART_RAD)).any():
            chosen.append(index)
            if len(chosen) == most:
                break
    return np.array(chosen, np.int64)


def _spread(points: Points, count: int) -> Points:
    """Return at most ``count`` of the points, in equal steps."""
    if len(points) <= count:
        return points
    return points[np.linspace(0, len(points) - 1, count).round().astype(np.int64)]


def _coarse_poses(field: LikelihoodField) -> Poses:
    spec = field.spec
    spacing_m = _SPACING_M
    while True:
        step = max(1, round(spacing_m / spec.resolution))
        offset = step // 2
        on_grid = ((field.free % step) == offset).all(axis=1)
        if not on_grid.any():  # narrow places between the grid's lines
            on_grid = np.ones(len(field.free), np.bool_)
        cells = field.free[on_grid]
        if len(cells) * _HEADINGS <= _MOST_POSES:
            break
        spacing_m *= 1.3
    centers = spec.centers_of(cells)
    headings = np.arange(_HEADINGS) * (2 * math.pi / _HEADINGS) - math.pi
    poses = np.empty((len(centers), _HEADINGS, 3))
    poses[:, :, :2] = centers[:, None]
    poses[:, :, 2] = headings
    return poses.reshape(-1, 3)
