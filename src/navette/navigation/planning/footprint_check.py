"""Check a path against the obstacles with the robot's footprint."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.geometry import wrap_angles
from navette.navigation.grids import (
    body_clearance,
    exact_clearances,
    make_outline,
)
from navette.navigation.planning.path_shape import Poses
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid

# Tolerance, so that a body at rest is not closer than itself.
_SLACK_M = 1e-3
# Between two poses, no point of the body moves farther than this unchecked.
_STEP_M = 0.025


@dataclass(frozen=True)
class FootprintCheck:
    """Clearance (N,) in metres at each pose, or less on the way to it.

    ``first_bad`` is None if all poses fit.
    """

    clearance_m: NDArray[np.float64]
    first_bad: int | None

    @property
    def fits(self) -> bool:
        return self.first_bad is None


def check_path(
    poses: Poses, grid: PlanningGrid, body: BodyShape, margin_m: float | None = None
) -> FootprintCheck:
    """Check every pose (N, 3) of a path, and the motion to it, against the margin.

    From a start with less clearance than the margin, the path may continue along poses
    with no less clearance than the start; from the first pose with the margin on, the
    margin applies. Where the distance field cannot prove the margin, the clearance is
    the exact one that control checks its commands with.
    """
    margin = grid.margin_m if margin_m is None else margin_m
    steps = np.diff(poses, axis=0)
    steps[:, 2] = wrap_angles(steps[:, 2])
    # A point of the body moves no farther than this from pose to pose.
    motions = np.hypot(steps[:, 0], steps[:, 1])
    motions += body.circumscribed_m * np.abs(steps[:, 2])
    enough = margin + 0.5 * motions.max(initial=0.0)
    clearance = clearances(poses, grid, body, enough_m=enough)
    tight = clearance < enough
    if tight.any():
        clearance[tight] = exact_body_clearances(poses[tight], grid, body, enough)
        # On the way from one pose to the next it is at least this.
        lowest = 0.5 * (clearance[:-1] + clearance[1:] - motions)
        before = np.flatnonzero(lowest < margin)
        before, between = _between(before, poses, steps, motions)
        there = exact_body_clearances(between, grid, body, margin)
        np.minimum.at(clearance, before + 1, there)
    needed = np.full(len(poses), margin)
    if clearance[0] < margin:
        roomy = clearance >= margin
        escape = int(np.argmax(roomy)) if roomy.any() else len(poses)
        needed[:escape] = clearance[0] - _SLACK_M
    bad = np.flatnonzero(clearance < needed)
    return FootprintCheck(clearance, int(bad[0]) if len(bad) else None)


def _between(
    before: NDArray[np.intp], poses: Poses, steps: Poses, motions: NDArray[np.float64]
) -> tuple[NDArray[np.intp], Poses]:
    """Return the poses (M, 3) passed after some of the path, and the indices of these.

    ``steps`` (N − 1, 3) lead from pose to pose, and ``motions`` are their lengths, m.
    """
    counts = np.ceil(motions[before] / _STEP_M).astype(np.intp)
    parts = [np.arange(1, count) / count for count in counts.tolist()]
    before = np.repeat(before, np.maximum(counts - 1, 0))
    shares = np.concatenate([*parts, np.empty(0)])
    return before, poses[before] + shares[:, None] * steps[before]


def exact_body_clearances(
    poses: Poses, grid: PlanningGrid, body: BodyShape, horizon_m: float
) -> NDArray[np.float64]:
    """Return (N,) metres between body and obstacles, at most the horizon."""
    outline = make_outline(body.footprint)
    return exact_clearances(grid.exact_obstacles, outline, poses, horizon_m)


def clearances(
    poses: Poses, grid: PlanningGrid, body: BodyShape, *, enough_m: float = np.inf
) -> NDArray[np.float64]:
    """Return (N,) metres between body and obstacles; see :func:`body_clearance`."""
    return body_clearance(
        grid.distances,
        grid.spec,
        body.points,
        np.ascontiguousarray(poses),
        outside_m=grid.outside_m,
        enough_m=enough_m,
    )
