"""Obstacles that moved away at a distance, and thin posts that beams miss."""

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.costmap import CostmapParams, PlanarScan, ScanCostmap
from navette.navigation.grids import placed
from navette.navigation.grids.sub_cells import SUB_CELLS
from navette.navigation.mapping.memory import MapMemory, PlacedCostmap
from navette.navigation.mapping.params import MapMemoryParams
from navette.navigation.mapping.scan_beams import (
    ScanBeams,
    has_echo,
    possible_directions,
)

BEAMS = np.linspace(-np.pi, np.pi, 720, endpoint=False)
COSTMAP = ScanCostmap(CostmapParams(resolution_m=0.05, size_m=22.0))


def ranges_to(discs: np.ndarray, at: Pose2) -> np.ndarray:
    """Return the distance to discs (N, 3) x, y, radius in a round room of 10 m."""
    directions = np.column_stack([np.cos(BEAMS + at.yaw), np.sin(BEAMS + at.yaw)])
    least = np.full(len(BEAMS), np.inf)
    for *center, radius in [*discs.tolist(), (0.0, 0.0, 10.0)]:
        off = np.array(center) - (at.x, at.y)
        along = directions @ off
        inside = radius**2 - (off @ off - along**2)
        root = np.sqrt(np.maximum(inside, 0.0))
        far = along + root if radius == 10.0 else along - root
        least = np.where((inside > 0) & (far > 0), np.minimum(least, far), least)
    return least


def fuse(memory: MapMemory, discs: np.ndarray, at: Pose2) -> None:
    scan = PlanarScan(
        ranges_to(discs, at).astype(np.float32), -np.pi, np.pi / 360, 0.05, 20.0
    )
    there = placed(COSTMAP.spec, at)
    hits = at.apply(COSTMAP.hits(scan))
    cells = COSTMAP.build(scan)
    memory.fuse(PlacedCostmap(cells, there, (at.x, at.y), at, 0, hits=hits))


def lethal_near(memory: MapMemory, x: float, y: float, reach_m: float) -> int:
    lethal = np.argwhere(memory.occupancy() >= 100)
    centers = memory.spec.centers_of(lethal)
    return int((np.hypot(*(centers - (x, y)).T) <= reach_m).sum())


def views(count: int) -> list[Pose2]:
    rng = np.random.default_rng(3)
    return [Pose2(*rng.uniform((-1, -1, -3), (1, 1, 3))) for _ in range(count)]


def test_a_box_that_crossed_the_room_leaves_no_trail_beyond_the_erase_range() -> None:
    memory = MapMemory(MapMemoryParams(resolution_m=0.05, size_m=24.0))
    poses = views(60)
    for k, pose in enumerate(poses[:20]):
        fuse(memory, np.array([(-3.0 + 0.3 * k, 7.0, 0.3)]), pose)
    for pose in poses[20:]:
        fuse(memory, np.array([(2.7, 7.0, 0.3)]), pose)
    assert sum(lethal_near(memory, x, 7.0, 0.4) for x in np.arange(-3, 2, 0.5)) == 0
    assert lethal_near(memory, 2.7, 7.0, 0.4)


@pytest.mark.long
def test_thin_posts_stay_at_every_range() -> None:
    memory = MapMemory(MapMemoryParams(resolution_m=0.05, size_m=24.0))
    where = [(r, a) for r in (2.5, 4.5, 6.5, 8.5) for a in np.arange(0.1, 6.2, 0.35)]
    posts = np.array([(r * np.cos(a), r * np.sin(a), 0.02) for r, a in where])
    seen: set[int] = set()
    for pose in views(60):
        fuse(memory, posts, pose)
        found = {
            k for k, (x, y, _) in enumerate(posts) if lethal_near(memory, x, y, 0.09)
        }
        assert not seen - found
        seen |= found
    assert len(seen) >= len(posts) - 1


def directions(points: list[tuple[float, float]], hits: np.ndarray) -> list[int]:
    """Return in how many of 32 directions from each point a post may be."""
    edge_m = 0.05 / SUB_CELLS
    beams = scan_of(hits)
    found = [possible_directions(x, y, edge_m, beams) for x, y in points]
    return [int(bits).bit_count() for bits in found]


def scan_of(hits: np.ndarray) -> ScanBeams:
    """Return the beams of a scan from the origin in a costmap without obstacles."""
    spec = COSTMAP.spec
    return ScanBeams.of(hits, (0.0, 0.0), np.zeros(spec.shape, np.int8), spec)


def fan(*angles: float, range_m: float = 5.0) -> np.ndarray:
    return range_m * np.column_stack([np.cos(angles), np.sin(angles)])


def test_a_beam_beside_a_point_leaves_the_directions_away_from_it() -> None:
    one_side = fan(-0.5, 0.002, 0.5)  # 4 mm to the left of (2, 0)
    [left] = directions([(2.0, 0.0)], one_side)
    assert 8 <= left <= 18
    assert directions([(2.0, 0.0)], fan(-0.5, -0.002, 0.002, 0.5)) == [0]
    assert directions([(2.0, 0.0)], fan(-0.5, -0.015, 0.015, 0.5)) == [32]


def test_a_beam_that_ends_at_the_point_or_before_proves_nothing() -> None:
    near = fan(-0.003, 0.003, range_m=2.05)
    assert directions([(2.0, 0.0)], near) == [32]
    assert directions([(2.0, 0.0)], fan(-0.003, 0.003, range_m=1.0)) == [32]


def test_beams_without_an_echo_are_between_the_others() -> None:
    steps = [k * 0.004 + 0.002 for k in range(-200, 200) if abs(k) > 9]
    assert directions([(2.0, 0.0)], fan(*steps)) == [0]
    coarse = [k * 0.04 + 0.02 for k in range(-20, 20) if abs(k) > 4]
    assert directions([(2.0, 0.0)], fan(*coarse)) == [32]


def test_an_echo_beside_another_post_does_not_free_its_cell() -> None:
    beams = scan_of(np.array([(2.0, 0.28)]))
    assert not has_echo(2.0, 0.0, beams)
    assert has_echo(2.0, 0.2, beams)


def test_a_post_at_the_end_of_the_range_is_kept_without_an_echo() -> None:
    memory = MapMemory(MapMemoryParams(resolution_m=0.05, size_m=12.0))
    posts = np.array([(3.5, 0.0, 0.045), (1.5, 1.5, 0.1)])
    turns = np.random.default_rng(1).uniform(-0.02, 0.02, 60).tolist()
    for k, turn in enumerate(turns):
        x = 0.0 if k < 5 else -0.046 - 0.0005 * k
        at = Pose2(x, 0.0, turn)
        ranges = ranges_to(posts, at)
        ranges[ranges > 3.5] = np.inf
        scan = PlanarScan(ranges.astype(np.float32), -np.pi, np.pi / 360, 0.05, 3.5)
        there = placed(COSTMAP.spec, at)
        hits = at.apply(COSTMAP.hits(scan))
        cells = COSTMAP.build(scan)
        memory.fuse(PlacedCostmap(cells, there, (x, 0.0), at, 0, hits=hits))
        assert lethal_near(memory, 3.5, 0.0, 0.1)
