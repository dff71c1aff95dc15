"""Closures in places that look alike."""

import numpy as np

from navette.geometry import Pose2
from navette.navigation.slam.correlative import SearchWindow, search
from navette.navigation.slam.loop_closure import slides
from navette.navigation.slam.params import SlamParams
from navette.navigation.slam.refinement import refine
from navette.navigation.slam.scan_points import Points, moved_points, scan_points
from navette.navigation.slam.tracking import LocalMap
from slam_office import Segments, office, scan_at

PARAMS = SlamParams()


def chunk(walls: Segments, start: Pose2, seed: int) -> Points:
    """Return the points of ten scans over 4 m of driving, in the map."""
    noise, parts = np.random.default_rng(seed), []
    for k in range(10):
        pose = start @ Pose2(0.4 * k, 0.0, 0.0)
        points = scan_points(
            scan_at(walls, pose, noise=noise), Pose2(0.0, 0.0, 0.0),
            max_range_m=30.0, spacing_m=0.05, max_points=240,
        )  # fmt: skip
        parts.append(moved_points(points, pose))
    return np.concatenate(parts)


def is_ambiguous(walls: Segments, start: Pose2) -> bool:
    local = LocalMap(chunk(walls, start, 1), PARAMS, levels=7)
    sample = np.ascontiguousarray(chunk(walls, start, 2)[::6])
    refined = refine(
        local.surface, sample, Pose2(0.0, 0.0, 0.0), noise_m=PARAMS.match_noise_m
    )
    assert refined.overlap > 0.9
    found = search(local.grid, sample, refined.pose, SearchWindow(0.2, 0.02))
    assert found is not None
    return slides(local, sample, refined, found.score)


def test_a_bare_corridor_fits_in_many_places() -> None:
    walls = np.array([(-99.0, -1.0, 99.0, -1.0), (-99.0, 1.0, 99.0, 1.0)])
    assert is_ambiguous(walls, Pose2(0.0, 0.0, 0.0))


def test_an_office_with_furniture_fits_in_one() -> None:
    assert not is_ambiguous(office(), Pose2(5.0, 1.5, 0.0))
