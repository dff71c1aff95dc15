"""Smooth a path that was planned elsewhere, piece by piece between its cusps."""

import itertools

import numpy as np

from navette.geometry import wrap_angles
from navette.navigation.planning.path_shape import (
    Poses,
    directions,
    headed,
    joined,
    resample,
    smooth,
    turn_in_place,
)
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid


def smooth_path(
    poses: Poses, grid: PlanningGrid, body: BodyShape, spacing_m: float
) -> Poses:
    """Return the path (N, 3) with rounded corners and headings along it.

    The path is divided where the direction of travel changes between forward, reverse
    and turning in place. Turns in place stay; the ends of each other piece stay in
    their positions, and its points move as in :func:`smooth`. The last heading is kept
    by a turn in place.
    """
    if len(poses) < 2:
        return poses
    last_yaw = float(poses[-1, 2])
    poses = _with_headings(poses)
    travel = directions(poses)
    cuts = np.flatnonzero(np.diff(travel)) + 1
    bounds = [0, *cuts.tolist(), len(travel)]
    keep_m = body.circumscribed_m + grid.margin_m
    pieces: list[Poses] = []
    for first, last in itertools.pairwise(bounds):
        piece = poses[first : last + 1]
        if travel[first] == 0:
            pieces.append(piece)
            continue
        line = resample(smooth(resample(piece[:, :2], spacing_m), grid, keep_m),
                        spacing_m)  # fmt: skip
        smoothed = headed(line)
        if travel[first] < 0:
            smoothed[:, 2] = wrap_angles(smoothed[:, 2] + np.pi)
        pieces.append(smoothed)
    whole = joined(*pieces)
    x, y, yaw = whole[-1].tolist()
    return joined(whole, turn_in_place(x, y, yaw, last_yaw))


def _with_headings(poses: Poses) -> Poses:
    """Return the path with headings along it if its publisher did not set them.

    Headings across the travel (all are zero, for example) cannot mean reverse either.
    """
    steps = np.diff(poses[:, :2], axis=0)
    moves = np.hypot(steps[:, 0], steps[:, 1]) > 1e-6
    travel = np.arctan2(steps[:, 1], steps[:, 0])
    along = np.abs(np.cos(travel[:, None] - np.stack([poses[:-1, 2], poses[1:, 2]], 1)))
    if not np.any(along.max(axis=1)[moves] < 0.5):
        return poses
    return headed(poses[np.concatenate([[True], moves]), :2])
