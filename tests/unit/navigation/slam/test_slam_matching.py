"""Search and refinement of a scan's pose on a map of other scans."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.geometry import Pose2, angle_difference
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.motion import inverted
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import PosePrior, refine
from navette.navigation.slam.scan_points import Points, moved_points, scan_points
from navette.navigation.slam.score_grid import make_score_grid
from navette.navigation.slam.tracking import LocalMap, match
from slam_office import office, scan_at

PARAMS = SlamParams()
WALLS = office()
HERE = Pose2(2.0, 1.5, 0.3)


def points_at(pose: Pose2, seed: int = 0, stddev_m: float = 0.01) -> Points:
    noise = np.random.default_rng(seed)
    scan = scan_at(WALLS, pose, noise=noise, stddev_m=stddev_m)
    return scan_points(
        scan, Pose2(0.0, 0.0, 0.0), max_range_m=30.0, spacing_m=0.05, max_points=240
    )


def local_map(poses: list[Pose2]) -> LocalMap:
    parts = [moved_points(points_at(p, seed=i + 1), p) for i, p in enumerate(poses)]
    return LocalMap(np.concatenate(parts), PARAMS, levels=6)


AROUND = [Pose2(2.0 + 0.3 * k, 1.5, 0.3 - 0.1 * k) for k in range(-3, 3)]
LOCAL = local_map(AROUND)


def test_the_search_finds_the_best_pose_of_the_window_exactly() -> None:
    """As the exhaustive search over the same grid does."""
    points = points_at(HERE)
    grid = make_score_grid(moved_points(points, HERE), 0.1, 4)
    center = Pose2(HERE.x + 0.23, HERE.y - 0.31, HERE.yaw + 0.11)
    window = SearchWindow(0.4, 0.2)
    found = search(grid, points, center, window)
    assert found is not None
    reach = float(np.quantile(np.hypot(points[:, 0], points[:, 1]), 0.9))
    turns = math.ceil(0.2 / (0.1 / reach))
    best = 0.0
    for turn in range(-turns, turns + 1):
        yaw = center.yaw + turn * 0.1 / reach
        placed = moved_points(points, Pose2(center.x, center.y, yaw))
        cells = np.floor((placed[:, :2] - (grid.x, grid.y)) / 0.1).astype(int)
        for dx in range(-4, 5):
            for dy in range(-4, 5):
                c, r = cells[:, 0] + dx, cells[:, 1] + dy
                height, width = grid.levels.shape[1:]
                inside = (c >= 0) & (r >= 0) & (c < width) & (r < height)
                total = grid.levels[0][r[inside], c[inside]].sum() / 250.0
                best = max(best, total / len(points))
    assert found.score == pytest.approx(best, abs=1e-9)
    assert found.pose.distance_to(HERE) < 0.12


def test_a_window_without_the_place_gives_nothing() -> None:
    grid = make_score_grid(moved_points(points_at(HERE), HERE), 0.1, 4)
    far = Pose2(100.0, 100.0, 0.0)
    assert search(grid, points_at(HERE), far, SearchWindow(1.0, 0.5)) is None


def test_a_large_window_is_searched_with_any_start() -> None:
    center = Pose2(HERE.x - 3.0, HERE.y + 2.5, HERE.yaw + 0.5)
    window = SearchWindow(4.0, 0.7)
    found = search(LOCAL.grid, points_at(HERE), center, window, min_score=0.5)
    assert found is not None
    assert found.pose.distance_to(HERE) < 0.15
    assert abs(angle_difference(found.pose.yaw, HERE.yaw)) < 0.05


@settings(max_examples=40)
@given(
    st.floats(-0.15, 0.15),
    st.floats(-0.15, 0.15),
    st.floats(-0.12, 0.12),
    st.integers(0, 1000),
)
def test_known_offsets_are_recovered_far_below_a_cell(
    dx: float, dy: float, turn: float, seed: int
) -> None:
    truth = Pose2(HERE.x + 0.07, HERE.y - 0.03, HERE.yaw)
    start = Pose2(truth.x + dx, truth.y + dy, truth.yaw + turn)
    points = points_at(truth, seed=seed + 10)
    prior = PosePrior(start, inverted(np.diag([0.1**2, 0.1**2, 0.08**2])))
    found = match(LOCAL, points, prior, PARAMS)
    assert found is not None
    assert found.pose.distance_to(truth) < 0.01
    assert abs(angle_difference(found.pose.yaw, truth.yaw)) < 0.005
    assert found.overlap > 0.9


def test_without_noise_the_pose_is_exact() -> None:
    def clean(pose: Pose2) -> Points:
        return points_at(pose, stddev_m=0.0)

    local = LocalMap(moved_points(clean(HERE), HERE), PARAMS)
    start = Pose2(HERE.x + 0.05, HERE.y - 0.04, HERE.yaw + 0.02)
    found = refine(local.surface, clean(HERE), start, noise_m=0.02)
    assert found.pose.distance_to(HERE) < 0.002
    assert abs(found.pose.yaw - HERE.yaw) < 5e-4


def corridor(x: float, seed: int) -> Points:
    """Return the points at x between two walls along x, without ends, in the map."""
    walls = np.array([(-99.0, -1.0, 99.0, -1.0), (-99.0, 1.0, 99.0, 1.0)])
    scan = scan_at(walls, Pose2(x, 0.0, 0.0), noise=np.random.default_rng(seed))
    return scan_points(
        scan, Pose2(x, 0.0, 0.0), max_range_m=30.0, spacing_m=0.05, max_points=240
    )


def test_a_corridor_gives_little_information_along_itself() -> None:
    parts = [corridor(0.37 * k - 4.0, seed=k) for k in range(12)]
    local = LocalMap(np.concatenate(parts), PARAMS)
    start = Pose2(0.1, 0.05, 0.02)
    odometry = np.diag([0.1**2, 0.1**2, 0.05**2])
    found = refine(
        local.surface,
        corridor(0.0, seed=99),
        start,
        noise_m=PARAMS.match_noise_m,
        prior=PosePrior(start, inverted(odometry)),
    )
    covariance = inverted(found.information + inverted(odometry))
    along, across, yaw = np.sqrt(np.diag(covariance))
    assert along > 5 * across
    assert across < 0.01
    assert yaw < 0.01
    assert found.pose.x == pytest.approx(0.1, abs=0.05)  # as predicted
    assert found.pose.y == pytest.approx(0.0, abs=0.01)
    assert found.pose.yaw == pytest.approx(0.0, abs=0.005)


def test_the_covariance_covers_the_error() -> None:
    """The mean squared Mahalanobis distance is not above three (3 dof)."""
    total, trials = 0.0, 30
    for seed in range(trials):
        truth = Pose2(2.0 + 0.01 * seed, 1.45, 0.25)
        prior = PosePrior(truth, inverted(np.diag([0.2**2, 0.2**2, 0.1**2])))
        found = match(LOCAL, points_at(truth, seed=100 + seed), prior, PARAMS)
        assert found is not None
        error = np.array(found.pose) - np.array(truth)
        total += float(error @ found.information @ error)
    assert total / trials < 3.0


def test_a_scan_of_another_place_does_not_match() -> None:
    elsewhere = points_at(Pose2(14.0, 10.0, 1.0))
    prior = PosePrior(Pose2(50.0, 50.0, 0.0), inverted(np.diag([0.1, 0.1, 0.1])))
    assert match(LOCAL, elsewhere, prior, PARAMS) is None


def test_too_few_points_do_not_match() -> None:
    prior = PosePrior(HERE, np.eye(3))
    assert match(LOCAL, points_at(HERE)[:5], prior, PARAMS) is None


def test_a_surface_that_few_points_meet_exactly_wins_over_many_blurred_ones() -> None:
    """Scans that share a third of their surfaces: several maxima score higher."""
    arm = np.arange(0.0, 5.0, 0.05)
    zero, one = np.zeros_like(arm), np.ones_like(arm)
    points = np.concatenate(
        [
            np.column_stack([arm, zero, zero, one]),
            np.column_stack([zero, arm, one, zero]),
        ]
    )
    noise = np.random.default_rng(1)
    parts = [points[noise.random(len(points)) < 0.4]]
    for offset in (-1.2, -0.6, 0.6, 1.2):
        blurred = points[noise.random(len(points)) < 0.55] + (offset, offset, 0.0, 0.0)
        blurred[:, :2] += noise.normal(0.0, 0.06, (len(blurred), 2))
        parts.append(blurred)
    local = LocalMap(np.concatenate(parts), PARAMS, levels=6)
    prior = PosePrior(Pose2(0.6, 0.6, 0.0), np.diag([1 / 0.6**2] * 2 + [1 / 0.01**2]))
    found = match(local, points, prior, PARAMS)
    assert found is not None
    assert math.hypot(found.pose.x, found.pose.y) < 0.05
