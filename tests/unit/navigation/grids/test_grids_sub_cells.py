"""Points within lethal cells, and clearances to them."""

import numpy as np
import pytest

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    LETHAL,
    CellWindow,
    GridSpec,
    HitPoints,
    cell_points,
    exact_clearances,
    make_obstacles,
    make_outline,
    mark_points,
    marked_cells,
    point_radius,
    points_to_message,
)
from navette.navigation.grids.sub_cells import CellMarks, mask_at

SPEC = GridSpec(0.1, 60, 40, Pose2(-1.0, -2.0, 0.3))


def marked(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    masks = np.zeros(SPEC.shape, np.uint64)
    return masks, mark_points(masks, SPEC, points)


def some_points(count: int) -> np.ndarray:
    uv = np.random.default_rng(1).uniform((0, 0), (6.0, 4.0), (count, 2))
    return SPEC.origin.apply(uv)


def test_points_come_back_to_half_a_sub_cell() -> None:
    points = some_points(40)
    masks, cells = marked(points)
    lethal = np.zeros(SPEC.shape, np.int8)
    lethal[tuple(cells.T)] = LETHAL
    found = marked_cells(masks, SPEC, lethal, CellWindow.whole(SPEC.shape))
    back = found.points
    gaps = np.hypot(*(points[:, None] - back[None]).transpose(2, 0, 1))
    assert gaps.min(axis=1).max() <= 2**0.5 * point_radius(0.1) + 1e-9
    assert len(cells) == len({SPEC.cell_of(x, y) for x, y in points.tolist()})
    assert (found.cells == cells).all()
    assert found.counts.sum() == len(back)
    ends = np.cumsum(found.counts)
    for cell, middle, end, count in zip(
        cells, found.middles, ends, found.counts, strict=True
    ):
        its_own = back[end - count : end]
        np.testing.assert_allclose(middle, its_own.mean(axis=0))
        assert {SPEC.cell_of(x, y) for x, y in its_own.tolist()} == {tuple(cell)}


def test_points_outside_the_grid_are_ignored() -> None:
    masks, cells = marked(np.array([(50.0, 0.0), (-50.0, 1.0)]))
    assert not masks.any()
    assert len(cells) == 0


def test_a_newer_scan_replaces_the_points_of_its_cells() -> None:
    masks, _ = marked(SPEC.origin.apply(np.array([(1.01, 1.01), (2.01, 2.01)])))
    mark_points(masks, SPEC, SPEC.origin.apply(np.array([(1.09, 1.09)])))
    assert masks[10, 10] == np.uint64(1) << np.uint64(7 * 8 + 7)
    assert masks[20, 20] == 1


def test_clearance_is_that_of_the_points() -> None:
    outline = make_outline(Footprint(((0.2, 0.15), (-0.2, 0.15), (-0.2, -0.15),
                                      (0.2, -0.15))))  # fmt: skip
    points = some_points(30)
    _, cells = marked(points)
    lethal = np.zeros(SPEC.shape, np.uint8)
    lethal[tuple(cells.T)] = 1
    rng = np.random.default_rng(2)
    poses = np.column_stack([some_points(50), rng.uniform(-3, 3, 50)])
    exact = exact_clearances(make_obstacles(lethal, SPEC, points), outline, poses, 1.0)
    for pose, found in zip(poses, exact, strict=True):
        x, y = np.abs(Pose2(*pose).inverse().apply(points)).T
        outside = np.hypot(np.maximum(x - 0.2, 0), np.maximum(y - 0.15, 0))
        inside = np.minimum(np.maximum(x - 0.2, y - 0.15), 0)
        assert abs(min(1.0, (outside + inside).min()) - found) < 0.02


def test_cells_without_points_are_covered_by_a_circle() -> None:
    points = cell_points(np.zeros(1, np.uint64), SPEC, np.array([(3, 4)]), 0.01)
    away = np.hypot(*(points - SPEC.center_of(3, 4)).T)
    np.testing.assert_allclose(away, 0.04)


def test_clouds_are_found_by_stamp() -> None:
    clouds, points = HitPoints(), np.array([(1.5, -2.25), (0.0, 3.0)])
    stamp_ns = clouds.receive(points_to_message(points, "map", 1_500_000_000))
    assert stamp_ns == 1_500_000_000
    found = clouds.at(stamp_ns)
    assert found is not None
    np.testing.assert_array_equal(found, points)
    assert clouds.at(1) is None


@pytest.mark.parametrize("far_m", [1e30, -1e30, 3.2e8, 5.0])
def test_points_far_outside_do_not_mark_the_cells_of_the_grid(far_m: float) -> None:
    spec = GridSpec(0.1, 60, 40, Pose2(0.0, 0.0, 0.0))
    marks = CellMarks.of(spec, np.array([(1.05, 2.0 * 2**32 * 0.1), (2.05, far_m)]))
    outline = make_outline(Footprint(((0.2, 0.15), (-0.2, 0.15), (-0.2, -0.15),
                                      (0.2, -0.15))))  # fmt: skip
    for row, column in ((0, 10), (0, 20)):
        assert mask_at(marks, row, column) == 0
    lethal = np.zeros(spec.shape, np.uint8)
    lethal[0, 20] = 1
    poses = np.array([(2.05, 0.5, 0.3)])
    far = make_obstacles(lethal, spec, np.array([(2.05, far_m)]))
    expected = exact_clearances(make_obstacles(lethal, spec), outline, poses, 1.0)
    assert exact_clearances(far, outline, poses, 1.0) == expected


@pytest.mark.parametrize(
    "pose", [(1.0, 1.0, np.nan), (1.0, 1.0, np.inf), (np.nan, 1.0, 0.0)]
)
def test_a_pose_that_is_not_finite_overlaps(pose: tuple[float, float, float]) -> None:
    spec = GridSpec(0.05, 40, 40)
    obstacles = make_obstacles(np.ones(spec.shape, np.uint8), spec)
    body = make_outline(Footprint(((0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2))))
    assert exact_clearances(obstacles, body, np.array([pose]), 0.3)[0] < 0.0
