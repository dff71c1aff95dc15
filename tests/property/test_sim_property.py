"""Properties of the simulator's geometry against plain definitions."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.sim import Simulator, World, load_robot
from navette.sim.occupancy_map import merge_runs
from navette.sim.profile import convex_hull, footprint_of

ROBOT = load_robot("course").model
OUTLINE = np.array(footprint_of(ROBOT))


@given(hnp.arrays(np.bool_, st.tuples(st.integers(1, 12), st.integers(1, 12))))
def test_merged_runs_cover_each_cell_once(grid: NDArray[np.bool_]) -> None:
    covered = np.zeros(grid.shape, dtype=int)
    for row, column, rows, columns in merge_runs(grid):
        covered[row : row + rows, column : column + columns] += 1
    np.testing.assert_array_equal(covered, grid.astype(int))


@given(
    st.floats(3.5, 9.0),
    st.floats(-math.pi, math.pi),
    st.floats(-math.pi, math.pi),
    st.floats(0.1, 1.0),
)
@settings(max_examples=30)
def test_clearance_to_a_column_is_the_distance_to_the_body(
    distance: float, bearing: float, yaw: float, radius: float
) -> None:
    """Tall column, so the nearest points lie at the body's height: a planar problem.

    The body's parts are boxes and wheels, which the outline's hull only bounds.
    """
    column = (distance * math.cos(bearing), distance * math.sin(bearing))
    world = World().add_cylinder(column, radius, height=3.0)
    scene = world.scene().with_robot(ROBOT)
    measured = Simulator(scene, start=Pose2(0, 0, yaw)).clearance().distance
    centre = Pose2(0, 0, yaw).inverse().apply(np.array([column]))[0]
    parts = [
        ((-0.5, 1.5), (-0.5, 0.5)),
        ((-0.4, 0.4), (0.5, 0.7)),
        ((-0.4, 0.4), (-0.7, -0.5)),
    ]
    expected = min(
        math.hypot(
            max(xs[0] - centre[0], 0, centre[0] - xs[1]),
            max(ys[0] - centre[1], 0, centre[1] - ys[1]),
        )
        for xs, ys in parts
    )
    assert abs(measured - (expected - radius)) < 2e-3


@given(st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5)), min_size=3, max_size=30))
def test_hull_is_convex_and_holds_every_point(
    points: list[tuple[float, float]],
) -> None:
    hull = convex_hull(points)
    if len(hull) < 3:
        return
    corners = np.array(hull)
    ahead = np.roll(corners, -1, axis=0) - corners
    for x, y in points:
        to_point = np.array([x, y]) - corners
        side = ahead[:, 0] * to_point[:, 1] - ahead[:, 1] * to_point[:, 0]
        assert side.min() > -1e-4
