"""Properties of the map: standing posts stay, what is gone goes, at all distances."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.geometry import Pose2
from navette.navigation.costmap import CostmapParams, PlanarScan, ScanCostmap
from navette.navigation.grids import placed
from navette.navigation.mapping import MapMemory, MapMemoryParams, PlacedCostmap

ROOM_M = 10.0
COSTMAPS = {
    resolution: ScanCostmap(CostmapParams(resolution_m=resolution, size_m=22.0))
    for resolution in (0.05, 0.1)
}


class Scanner:
    """A scanner in a round room, and the map that it makes."""

    def __init__(
        self, resolution_m: float, beams: int, noise_m: float, wall: bool, seed: int
    ) -> None:
        self.rng = np.random.default_rng(seed)
        self.beams, self.noise_m, self.wall = beams, noise_m, wall
        self.angles = np.linspace(-np.pi, np.pi, beams, endpoint=False)
        self.costmap = COSTMAPS[resolution_m]
        params = MapMemoryParams(resolution_m=resolution_m, size_m=24.0)
        self.memory = MapMemory(params)

    def scan(self, posts: np.ndarray) -> None:
        """Fuse a scan of posts (N, 3) x, y, radius from somewhere near the middle."""
        at = Pose2(*self.rng.uniform((-1, -1, -math.pi), (1, 1, math.pi)))
        ranges = self._ranges(posts, at) + self.rng.normal(0, self.noise_m, self.beams)
        scan = PlanarScan(
            ranges.astype(np.float32), -np.pi, 2 * np.pi / self.beams, 0.05, 20.0
        )
        self.memory.fuse(
            PlacedCostmap(
                self.costmap.build(scan),
                placed(self.costmap.spec, at),
                (at.x, at.y),
                at,
                0,
                hits=at.apply(self.costmap.hits(scan)),
            )
        )

    def lethal_near(self, x: float, y: float, reach_m: float) -> int:
        lethal = np.argwhere(self.memory.cells >= 100)
        centers = self.memory.spec.centers_of(lethal)
        return int((np.hypot(*(centers - (x, y)).T) <= reach_m).sum())

    def _ranges(self, posts: np.ndarray, at: Pose2) -> np.ndarray:
        directions = np.column_stack(
            [np.cos(self.angles + at.yaw), np.sin(self.angles + at.yaw)]
        )
        along = directions @ np.array((at.x, at.y))
        inside = ROOM_M**2 - (at.x**2 + at.y**2 - along**2)
        least = -along + np.sqrt(inside) if self.wall else np.full(self.beams, np.inf)
        for x, y, radius in posts.tolist():
            off = np.array((x - at.x, y - at.y))
            along = directions @ off
            inside = radius**2 - (off @ off - along**2)
            hit = along - np.sqrt(np.maximum(inside, 0.0))
            least = np.where((inside > 0) & (along > 0), np.minimum(least, hit), least)
        return least


def scanners(*, walls: tuple[bool, ...]) -> st.SearchStrategy[Scanner]:
    return st.builds(
        Scanner,
        st.sampled_from(sorted(COSTMAPS)),
        st.sampled_from([360, 640, 1080]),
        st.sampled_from([0.0, 0.001, 0.005]),
        st.sampled_from(walls),
        st.integers(0, 10_000),
    )


def post_at(distance_m: float, bearing: float, radius_m: float) -> list[float]:
    return [
        distance_m * math.cos(bearing),
        distance_m * math.sin(bearing),
        radius_m,
    ]


RING = st.builds(
    lambda distance_m, radius_m, turn: np.array(
        [post_at(distance_m, turn + k * math.pi / 8, radius_m) for k in range(16)]
    ),
    st.floats(1.8, 9.0),
    st.floats(0.02, 0.05),
    st.floats(0.0, 0.39),
)


@pytest.mark.long
@settings(max_examples=5)
@given(scanners(walls=(True, False)), RING)
def test_a_standing_post_is_never_lost(scanner: Scanner, posts: np.ndarray) -> None:
    reach_m = 0.71 * scanner.memory.spec.resolution + posts[0, 2] + 0.02
    seen: set[int] = set()
    for _ in range(30):
        scanner.scan(posts)
        found = {
            k
            for k, (x, y, _) in enumerate(posts.tolist())
            if scanner.lethal_near(x, y, reach_m)
        }
        assert not seen - found
        seen |= found
    assert seen


@pytest.mark.long
@settings(max_examples=8)
@given(
    scanners(walls=(True,)),
    st.floats(1.8, 8.0),
    st.floats(0.0, 6.2),
    st.floats(0.1, 0.4),
)
def test_what_is_gone_leaves_the_map(
    scanner: Scanner, distance_m: float, bearing: float, radius_m: float
) -> None:
    x, y, _ = post = post_at(distance_m, bearing, radius_m)
    for _ in range(5):
        scanner.scan(np.array([post]))
    assert scanner.lethal_near(x, y, radius_m + 0.1)
    gap_m = distance_m * 2 * math.pi / scanner.beams
    for _ in range(20 + round(600 * gap_m)):
        scanner.scan(np.empty((0, 3)))
    assert scanner.lethal_near(x, y, radius_m + 0.1) == 0
