"""Check a path against the obstacles with the robot's footprint."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.navigation.grids import (
    body_clearance,
    exact_clearances,
    make_outline,
)
from navette.navigation.planning.path_shape import Poses
from navette.navigation.planning.planning_grid import BodyShape, PlanningGrid

# Tolerance, so that a body at rest is not closer than itself.
_SLACK_M = 1e-3


@dataclass(frozen=True)
class FootprintCheck:
    """Clearance (N,) in metres at each pose; ``first_bad`` is None if all poses fit."""

    clearance_m: NDArray[np.float64]
    first_bad: int | None

    @property
    def fits(self) -> bool:
        return self.first_bad is None


def check_path(
    poses: Poses, grid: PlanningGrid, body: BodyShape, margin_m: float | None = None
) -> FootprintCheck:
    """Check every pose (N, 3) of a path against the margin.

    From a start with less clearance than the margin, the path may continue along poses
    with no less clearance than the start; from the first pose with the margin on, the
    margin applies. Where the distance field cannot prove the margin, the clearance is
    the exact one that control checks its commands with.
    """
    margin = grid.margin_m if margin_m is None else margin_m
    clearance = clearances(poses, grid, body, enough_m=margin)
    tight = clearance < margin
    if tight.any():
        clearance[tight] = exact_clearances(
            grid.exact_obstacles,
            make_outline(body.footprint),
            poses[tight],
            margin,
        )
    needed = np.full(len(poses), margin)
    if clearance[0] < margin:
        enough = clearance >= margin
        escape = int(np.argmax(enough)) if enough.any() else len(poses)
        needed[:escape] = clearance[0] - _SLACK_M
    bad = np.flatnonzero(clearance < needed)
    return FootprintCheck(clearance, int(bad[0]) if len(bad) else None)


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
