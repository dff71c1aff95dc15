"""Voxels: marking, clearing by ray against a brute-force definition, the window."""

import itertools
import math

import numpy as np
import pytest

from navette.navigation.costmap.layers.voxels import VoxelWindow

RES, Z_RES, Z_COUNT = 0.25, 0.2, 8


def window(size_m: float = 4.0, **values: float) -> VoxelWindow:
    made = VoxelWindow(
        size_m, RES, origin_z=0.0, z_resolution=Z_RES, z_voxels=Z_COUNT, **values
    )
    made.move_to(0.0, 0.0)
    return made


def filled(made: VoxelWindow, reach: float) -> dict[tuple[int, int, int], bool]:
    """Mark every voxel within a reach; return their indices."""
    n = round(reach / RES)
    indices = list(itertools.product(range(-n, n), range(-n, n), range(Z_COUNT)))
    centres = (np.array(indices) + 0.5) * (RES, RES, Z_RES)
    made.mark(centres)
    return dict.fromkeys(indices, True)


def is_marked(made: VoxelWindow, index: tuple[int, int, int]) -> bool:
    x, y, z = index
    count = made._count
    return bool(made._columns[y % count, x % count] >> z & 1)


def chord(origin: np.ndarray, end: np.ndarray, index: tuple[int, int, int]) -> float:
    """Length of a segment within a voxel: the slab method, m."""
    edges = np.array((RES, RES, Z_RES))
    low = np.array(index) * edges
    enter, leave = 0.0, 1.0
    for k in range(3):
        d = end[k] - origin[k]
        if d == 0.0:
            if not low[k] <= origin[k] < low[k] + edges[k]:
                return 0.0
            continue
        near, far = sorted(
            ((low[k] - origin[k]) / d, (low[k] + edges[k] - origin[k]) / d)
        )
        enter, leave = max(enter, near), min(leave, far)
    return max(0.0, leave - enter) * float(np.linalg.norm(end - origin))


@pytest.mark.parametrize("seed", range(20))
def test_a_ray_clears_the_voxels_that_it_crosses(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made = window()
    indices = filled(made, 1.5)
    origin = rng.uniform((-1.4, -1.4, 0.1), (1.4, 1.4, 1.5))
    end = rng.uniform((-3.0, -3.0, -0.5), (3.0, 3.0, 2.5))
    if seed % 4 == 0:
        end[seed // 4 % 3] = origin[seed // 4 % 3]  # parallel to a plane of voxels
    margin, least = 0.3, 0.05
    made.clear(origin, end[None], margin=margin, least_chord=least)
    length = float(np.linalg.norm(end - origin))
    last = origin + (end - origin) * max(0.0, 1.0 - margin / length)
    for index in indices:
        crossed = chord(origin, last, index)
        if abs(crossed - least) < 1e-9:
            continue  # on the limit: rounding decides
        assert is_marked(made, index) == (crossed < least), (index, crossed)


def test_marks_are_the_voxels_of_the_points() -> None:
    made = window()
    points = np.array([[0.3, -0.6, 0.45], [9.0, 0.0, 0.5], [0.3, 0.3, 9.0]])
    made.mark(points)
    assert is_marked(made, (1, -3, 2))
    assert made.obstacles().tolist() == [[0.375, -0.625]]


def test_a_column_needs_more_voxels_than_the_threshold() -> None:
    made = window(mark_threshold=1)
    made.mark(np.array([[0.1, 0.1, 0.1]]))
    assert not len(made.obstacles())
    made.mark(np.array([[0.1, 0.1, 0.5]]))
    assert len(made.obstacles()) == 1


@pytest.mark.parametrize("seed", range(10))
def test_the_window_keeps_what_stays_within_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    made = window()
    known: set[tuple[float, float]] = set()
    x = y = 0.0
    for _ in range(30):
        x, y = x + rng.uniform(-1.5, 1.5), y + rng.uniform(-1.5, 1.5)
        made.move_to(x, y)
        corner = [math.floor(v / RES) - made._count // 2 for v in (x, y)]
        known = {
            p
            for p in known
            if all(
                0 <= math.floor(v / RES) - c < made._count
                for v, c in zip(p, corner, strict=True)
            )
        }
        point = np.array([[x + rng.uniform(-1, 1), y + rng.uniform(-1, 1), 0.5]])
        made.mark(point)
        cell = np.floor(point[0, :2] / RES)
        known.add(tuple(((cell + 0.5) * RES).tolist()))
        assert {tuple(p) for p in made.obstacles().tolist()} == known


def test_missing_floor_is_an_obstacle_until_floor_is_seen() -> None:
    made = window()
    place = np.array([[0.6, 0.6]])
    made.mark_drops(place, np.empty((0, 2)))
    assert len(made.obstacles()) == 1
    origin = np.array([-1.0, -1.0, 0.4])
    made.clear(origin, np.array([[1.9, 1.9, 0.1]]), margin=0.0, least_chord=0.0)
    assert len(made.obstacles()) == 1  # a ray above it proves nothing
    made.mark_drops(np.empty((0, 2)), place)
    assert not len(made.obstacles())


def test_before_the_window_is_placed_nothing_is_marked() -> None:
    made = VoxelWindow(2.0, RES, origin_z=0, z_resolution=Z_RES, z_voxels=Z_COUNT)
    made.mark(np.zeros((1, 3)))
    made.clear(np.zeros(3), np.ones((1, 3)), margin=0.0, least_chord=0.0)
    assert not len(made.obstacles())


def test_nothing_outside_the_window_is_touched() -> None:
    made = window(1.0)
    far = np.array([[1e6, -1e6, 0.5], [-3.0, 0.0, 0.5]])
    made.mark(far)
    assert not len(made.obstacles())
    made.mark(np.array([[0.1, 0.1, 0.5]]))
    made.clear(np.array([2.0, 2.0, 0.5]), far, margin=0.0, least_chord=0.0)
    assert len(made.obstacles()) == 1
