"""Points and normals of scans."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import PlanarScan
from navette.navigation.slam.scan_points import moved_points, scan_points
from slam_office import box, office, scan_at

HERE = Pose2(0.0, 0.0, 0.0)


def points_of(scan: PlanarScan, pose: Pose2 = HERE, **options: float) -> np.ndarray:
    values = {"max_range_m": 30.0, "spacing_m": 0.05, "max_points": 1000} | options
    return scan_points(scan, pose, **values)  # type: ignore[arg-type]


def test_normals_point_from_the_wall_to_the_sensor() -> None:
    points = points_of(scan_at(office(), Pose2(8.0, 1.5, 0.0)))
    below = points[np.abs(points[:, 1] + 1.5) < 1e-3]
    assert len(below) > 20
    has_normal = np.hypot(below[:, 2], below[:, 3]) > 0.5
    assert has_normal.mean() > 0.8
    np.testing.assert_allclose(below[has_normal][:, 3], 1.0, atol=0.05)


def test_the_pose_of_the_sensor_moves_points_and_normals() -> None:
    scan = scan_at(office(), Pose2(8.0, 1.5, 0.0))
    mounted = Pose2(0.3, -0.1, math.pi / 2)
    np.testing.assert_allclose(
        points_of(scan, mounted), moved_points(points_of(scan), mounted), atol=1e-12
    )


def test_invalid_and_far_beams_give_no_points() -> None:
    ranges = np.array([np.nan, np.inf, -np.inf, 0.0, 0.04, 2.0, 9.0, 12.0], np.float32)
    scan = PlanarScan(ranges, 0.0, 0.1, 0.05, 10.0)
    points = points_of(scan, max_range_m=5.0)
    assert len(points) == 1
    assert np.hypot(*points[0, :2]) == pytest.approx(2.0)


@pytest.mark.parametrize("most", [30, 100, 240])
def test_a_scan_has_at_most_so_many_points_evenly_spaced(most: int) -> None:
    scan = scan_at(office(), Pose2(8.0, 1.5, 0.3), beams=1440)
    points = points_of(scan, max_points=most)
    assert most / 2 < len(points) <= most


def test_clutter_has_no_normals() -> None:
    ranges = 3.0 + 0.4 * np.random.default_rng(0).normal(size=360)
    scan = PlanarScan(ranges.astype(np.float32), 0.0, math.tau / 360, 0.05, 10.0)
    points = points_of(scan)
    assert (np.hypot(points[:, 2], points[:, 3]) > 0.5).sum() < 0.2 * 360


def test_the_ends_of_a_scan_of_a_bare_corridor_are_left_out() -> None:
    walls = np.array([(-99.0, -1.0, 99.0, -1.0), (-99.0, 1.0, 99.0, 1.0)])
    points = points_of(scan_at(walls, Pose2(0.0, 0.0, 0.0), range_m=10.0))
    assert len(points) > 100
    assert (np.abs(points[:, 3]) > 0.99).all()


def test_a_thin_leg_is_kept() -> None:
    walls = np.array([*box(-3.0, -3.0, 6.0, 6.0), *box(1.5, 0.0, 0.03, 0.03)])
    points = points_of(scan_at(walls, Pose2(0.0, 0.0, 0.0)))
    legs = np.linalg.norm(points[:, :2] - (1.5, 0.015), axis=1) < 0.05
    assert legs.any()
