import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    DistanceGrid,
    DistanceLevels,
    GridSpec,
    body_clearance,
    body_points,
    distance_levels,
    grid_frame,
    level_metres,
    make_body,
    pose_clearance,
    pose_is_clear,
)

BODY = Footprint(((-0.5, -0.7), (1.5, -0.7), (1.5, 0.7), (-0.5, 0.7)))
SPEC = GridSpec(0.1, 120, 90, Pose2(-4.0, 2.0, 0.7))
HALF_DIAGONAL = 0.1 * math.sqrt(0.5)


METRES = level_metres(0.1, 20.0)


def field_with(*cells: tuple[int, int], spec: GridSpec = SPEC) -> DistanceLevels:
    occupied = np.zeros(spec.shape, np.uint8)
    for row, column in cells:
        occupied[row, column] = 1
    return DistanceLevels(distance_levels(occupied, METRES), METRES)


def brute_force(body: np.ndarray, pose: Pose2, post: tuple[float, float]) -> float:
    """Least distance of the body's points to one obstacle's centre, metres."""
    gaps = pose.apply(body[:, :2]) - post
    return float((np.hypot(gaps[:, 0], gaps[:, 1]) - body[:, 2]).min())


def test_clearance_equals_brute_force_to_a_fraction_of_a_cell() -> None:
    rng = np.random.default_rng(1)
    field, post = field_with((40, 60)), SPEC.center_of(40, 60)
    body = body_points(BODY, 0.1)
    corner = SPEC.center_of(25, 25)
    poses = [
        Pose2(corner[0] + x, corner[1] + y, yaw)
        for x, y, yaw in rng.uniform((-1, -1, -3), (1, 1, 3), (200, 3))
    ]
    expected = [brute_force(body, pose, post) - HALF_DIAGONAL for pose in poses]
    found = body_clearance(field, SPEC, body, np.array(poses), outside_m=20.0)
    np.testing.assert_allclose(found, expected, atol=0.02)


def test_a_post_inside_the_outline_is_detected() -> None:
    body = body_points(BODY, 0.1)
    pose = Pose2(*SPEC.center_of(45, 60), 0.3)
    for ahead, left in ((0.0, 0.0), (0.6, 0.0), (1.0, 0.3), (0.2, -0.4)):
        x, y = pose.apply(np.array([[ahead, left]]))[0]
        field = field_with(SPEC.cell_of(x, y))
        assert body_clearance(field, SPEC, body, np.array([pose]))[0] < 0.0
        outline = np.ascontiguousarray(body[body[:, 2] == 0][:, :2])
        assert body_clearance(field, SPEC, outline, np.array([pose]))[0] > 0.0


def test_inner_discs_never_lower_the_clearance_to_outside_obstacles() -> None:
    body = body_points(BODY, 0.1)
    outline = body[body[:, 2] == 0]
    for post in ((3.0, 0.2), (-0.6, 0.75), (0.5, 0.8), (1.55, 0.0), (-3.0, -2.0)):
        pose = Pose2(0.0, 0.0, 0.0)
        assert brute_force(body, pose, post) == brute_force(outline, pose, post)


def test_points_outside_the_grid_have_the_given_distance() -> None:
    field = field_with((40, 60))
    body = np.array([[0.0, 0.0]])
    far = np.array([[100.0, 0.0, 0.0], [math.nan, 0.0, 0.0]])
    assert body_clearance(field, SPEC, body, far) == pytest.approx(-HALF_DIAGONAL)
    found = body_clearance(field, SPEC, body, far, outside_m=3.0)
    assert found == pytest.approx(3.0 - HALF_DIAGONAL)


def test_no_poses_give_no_clearances() -> None:
    field, body = field_with((40, 60)), np.zeros((1, 2))
    assert body_clearance(field, SPEC, body, np.empty((0, 3))).shape == (0,)


def test_enough_gives_a_lower_bound() -> None:
    field = field_with((10, 10))
    poses = np.array([[*SPEC.center_of(60, 80), 0.0]])
    body = body_points(BODY, 0.1)
    exact = body_clearance(field, SPEC, body, poses)[0]
    quick = body_clearance(field, SPEC, body, poses, enough_m=0.5)[0]
    assert 0.5 <= quick < exact


def test_pose_is_clear_agrees_with_the_clearance() -> None:
    rng = np.random.default_rng(2)
    field = field_with((40, 60), (20, 90), (70, 30))
    body = make_body(body_points(BODY, 0.1))
    grid = DistanceGrid(field, grid_frame(SPEC), 0.0)
    for _ in range(300):
        x, y = SPEC.center_of(*rng.integers((20, 20), (70, 100)))
        yaw, needed = rng.uniform(-3, 3), rng.uniform(0, 1)
        exact = pose_clearance(grid, body, x, y, yaw, math.inf)
        clear = pose_is_clear(grid, body, x, y, yaw, needed)
        # The centre's shortcut trusts the field to be 1-Lipschitz between cells.
        assert clear == (exact >= needed) or abs(exact - needed) < 0.01


def levels(shape: tuple[int, ...], dtype: type) -> DistanceLevels:
    return DistanceLevels(np.zeros(shape, dtype), METRES)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"distances": levels((3, 3), np.uint16)}, "level: shape"),
        ({"distances": levels(SPEC.shape, np.float64)}, "level: dtype float64"),
        ({"body": np.zeros((0, 2))}, r"body: shape \(0, 2\)"),
        ({"body": np.zeros((4, 5))}, r"body: shape \(4, 5\)"),
        ({"poses": np.zeros((4, 2))}, r"poses: shape \(4, 2\)"),
    ],
)
def test_bad_input_is_named(change, text) -> None:
    good = {
        "distances": levels(SPEC.shape, np.uint16),
        "body": np.zeros((1, 2)),
        "poses": np.zeros((1, 3)),
    }
    with pytest.raises(InvalidValueError, match=text):
        body_clearance(spec=SPEC, **(good | change))
