"""In any world the body keeps its margin along every path."""

import math

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.planning import Goal, NewMap, Planner, PlannerParams

OUTLINE = (0.6, 0.25, -0.2, 0.25, -0.2, -0.25, 0.6, -0.25)
"""A body that sweeps much more when it turns than it is wide (m)."""

PARAMS = PlannerParams(
    footprint_m=OUTLINE,
    clearance_margin_m=0.1,
    tight_margin_m=0.1,
    comfort_m=0.1,
    max_expansions=8000,
)
SIDE_M = 5.0
SPEC = GridSpec(0.1, 50, 50, Pose2(-1.0, 2.0, 0.3))
PLANNER = Planner(PARAMS)

UNIT = st.floats(0.0, 1.0)
BLOCKS = st.lists(st.tuples(UNIT, UNIT, UNIT, UNIT), max_size=9)


@settings(max_examples=60)
@given(BLOCKS, st.tuples(UNIT, UNIT, UNIT), st.tuples(UNIT, UNIT))
# The search over poses leaves the map here.
@example([(0.75, 0.875, 1.0, 1.0)], (0.875, 1.0, 0.046875), (0.0, 0.0))
def test_paths_keep_the_margin_and_end_at_the_goal(
    blocks: list[tuple[float, float, float, float]],
    start: tuple[float, float, float],
    goal: tuple[float, float],
) -> None:
    occupancy = np.zeros(SPEC.shape, np.int8)
    for u, v, width, height in blocks:
        row, column = int(v * 49), int(u * 49)
        occupancy[
            row : row + 1 + int(8 * height), column : column + 1 + int(8 * width)
        ] = 100
    begin = pose_in_grid(*start)
    end = pose_in_grid(*goal, 0.0)
    PLANNER.set_map(NewMap(occupancy, SPEC))
    plan = PLANNER.plan(begin, Goal(end.x, end.y))
    assert plan.outcome.has_path == bool(len(plan.poses))
    if not plan.outcome.has_path:
        return
    np.testing.assert_allclose(plan.poses[0, :2], begin[:2])
    assert math.dist(plan.poses[-1, :2], end[:2]) <= PARAMS.goal_tolerance_m
    check_margin(plan.poses, occupancy, begin)
    check_steps(plan.poses)


def pose_in_grid(u: float, v: float, turn: float) -> Pose2:
    """A pose at the share u, v of the grid's sides, off its rim."""
    inner = SIDE_M - 0.2
    return SPEC.origin @ Pose2(0.1 + u * inner, 0.1 + v * inner, turn * 6.28)


def check_margin(poses: np.ndarray, occupancy: np.ndarray, begin: Pose2) -> None:
    """No obstacle nearer than the margin, once the body is that far from all."""
    points = SPEC.centers_of(np.argwhere(occupancy == 100))
    # Obstacles inside the body at the start are ignored.
    points = points[signed_distances(points, begin) > 0]
    clearance = np.array(
        [
            signed_distances(points, Pose2(*p)).min(initial=math.inf)
            for p in poses.tolist()
        ]
    )
    margin = PARAMS.clearance_margin_m
    free = np.flatnonzero(clearance >= margin + SPEC.resolution)
    first = free[0] if len(free) else len(clearance)
    assert clearance[first:].min(initial=math.inf) >= margin
    assert clearance[:first].min(initial=math.inf) >= min(margin, clearance[0]) - 0.05


def check_steps(poses: np.ndarray) -> None:
    """Poses lie close together; where the body moves it moves along its heading."""
    step = np.diff(poses[:, :2], axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    assert length.max(initial=0.0) <= PARAMS.path_spacing_m + 1e-6
    turn = np.remainder(np.diff(poses[:, 2]) + np.pi, 2 * np.pi) - np.pi
    middle = poses[:-1, 2] + turn / 2
    moves = length > 0.02
    along = step[:, 0] * np.cos(middle) + step[:, 1] * np.sin(middle)
    assert (np.abs(along[moves]) >= 0.8 * length[moves]).all()


def signed_distances(points: np.ndarray, pose: Pose2) -> np.ndarray:
    """(N,) distance (m) of points from the body's outline, negative inside.

    Polygon against points, exact; shares nothing with the planner's own check.
    """
    local = pose.inverse().apply(points.reshape(-1, 2))
    corners = np.array(Footprint.from_flat(OUTLINE).vertices)
    ends = np.roll(corners, -1, axis=0)
    edges = ends - corners
    offsets = local[:, None] - corners[None]
    along = np.clip((offsets * edges).sum(-1) / (edges**2).sum(-1), 0, 1)
    gaps = offsets - along[..., None] * edges
    distance = np.hypot(gaps[..., 0], gaps[..., 1]).min(axis=1)
    low, high = corners.min(axis=0), corners.max(axis=0)
    inside = ((local > low) & (local < high)).all(axis=1)
    return np.where(inside, -distance, distance)
