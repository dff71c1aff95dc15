import dataclasses
import math

import numpy as np
import pytest

from navette.errors import ParameterError
from navette.geometry import Pose2
from navette.navigation.grids import CellWindow, GridSpec, marked_cells, placed
from navette.navigation.mapping import MapMemory, MapMemoryParams, PlacedCostmap

SMALL = {"size_m": 10.0, "growth_m": 2.0, "max_size_m": 20.0}
SPEC = GridSpec(0.1, 41, 41, Pose2(-2.02, -2.02, 0.0))
ORIGIN = Pose2(0.0, 0.0, 0.0)


def memory(**values) -> MapMemory:
    return MapMemory(MapMemoryParams(**(SMALL | values)))


def costmap(cells: np.ndarray, pose: Pose2 = ORIGIN) -> PlacedCostmap:
    return PlacedCostmap(cells, placed(SPEC, pose), (pose.x, pose.y), pose, 0)


def unknown() -> np.ndarray:
    return np.full(SPEC.shape, -1, np.int8)


def free() -> np.ndarray:
    return np.zeros(SPEC.shape, np.int8)


def at(mem: MapMemory, x: float, y: float) -> int:
    return int(mem.occupancy()[mem.spec.cell_of(x, y)])


def test_the_initial_map_is_unknown_and_centred_at_the_parameters() -> None:
    mem = memory(center_x_m=3.0, center_y_m=-1.0)
    assert (mem.occupancy() == -1).all()
    assert mem.spec.shape == (100, 100)
    assert mem.spec.origin == Pose2(-2.0, -6.0, 0.0)


def test_known_cells_overwrite_and_unknown_cells_keep() -> None:
    mem = memory()
    first, second = free(), unknown()
    first[10:30, 25] = 100
    mem.fuse(costmap(first))
    second[15, 25] = 0
    mem.fuse(costmap(second))
    row, column = mem.spec.cell_of(*SPEC.center_of(15, 25))
    cells = mem.occupancy()
    assert cells[row, column] == 0
    assert cells[row - 1, column] == cells[row + 1, column] == 100


def test_an_empty_costmap_is_not_fused() -> None:
    mem = memory()
    assert not mem.fuse(costmap(unknown(), Pose2(50.0, 0.0, 0.0)))
    assert mem.spec.shape == (100, 100)
    assert mem.fuse(costmap(free()))


def test_max_never_lowers() -> None:
    mem, first = memory(fusion="max"), free()
    first[20, 30] = 100
    mem.fuse(costmap(first))
    mem.fuse(costmap(free()))
    assert at(mem, *SPEC.center_of(20, 30)) == 100


def test_log_odds_change_only_with_enough_evidence() -> None:
    mem, hit = memory(fusion="log_odds", erase_range_m=0.0), free()
    hit[20, 30] = 100
    post = SPEC.center_of(20, 30)
    for _ in range(3):
        mem.fuse(costmap(hit))
    assert at(mem, *post) == 100
    assert at(mem, *SPEC.center_of(5, 5)) == 0
    mem.fuse(costmap(free()))
    assert at(mem, *post) == 100
    for _ in range(6):
        mem.fuse(costmap(free()))
    assert at(mem, *post) == 0


def test_log_odds_in_between_are_percent_below_lethal() -> None:
    mem = memory(fusion="log_odds", hit_probability=0.6, miss_probability=0.4)
    hit = unknown()
    hit[20, 30] = 100
    mem.fuse(costmap(hit))
    assert at(mem, *SPEC.center_of(20, 30)) == 60
    assert (mem.occupancy() >= 0).sum() == 1


def test_thin_posts_survive_every_heading() -> None:
    """A post of one cell neither vanishes nor spreads when pulled across a turn."""
    rng = np.random.default_rng(8)
    post = (1.23, -0.41)
    mem = memory()
    for pose in (
        Pose2(*p) for p in rng.uniform((-0.4, -0.4, -3), (0.4, 0.4, 3), (60, 3))
    ):
        cells = free()
        ahead = pose.inverse().apply(np.array([post]))[0]
        cells[SPEC.cell_of(*ahead)] = 100
        mem.fuse(costmap(cells, pose))
        lethal = np.argwhere(mem.occupancy() == 100)
        assert len(lethal) == 1
        assert math.dist(mem.spec.center_of(*lethal[0]), post) < 0.15


def test_distant_beams_do_not_erase_near_measurements() -> None:
    post, mem = (1.0, 0.0), memory(erase_range_m=1.5)
    near = free()
    near[SPEC.cell_of(*post)] = 100
    mem.fuse(costmap(near))
    mem.fuse(costmap(free(), Pose2(-0.9, 0.0, 0.0)))
    assert at(mem, *post) == 100
    mem.fuse(costmap(free(), Pose2(-0.4, 0.0, 0.0)))
    assert at(mem, *post) == 0


def test_the_map_grows_to_hold_known_cells_and_keeps_their_position() -> None:
    mem, first = memory(), free()
    first[20, 30] = 100
    mem.fuse(costmap(first))
    second = free()
    second[:, :10] = -1
    mem.fuse(costmap(second, Pose2(-4.1, 4.0, math.pi)))
    assert mem.spec.shape == (120, 120)
    assert mem.spec.origin == Pose2(-7.0, -5.0, 0.0)
    assert at(mem, *SPEC.center_of(20, 30)) == 100
    mem.fuse(costmap(second, Pose2(-4.1, 4.0, math.pi)))
    assert mem.spec.shape == (120, 120)


def test_unknown_cells_do_not_make_the_map_grow() -> None:
    mem, cells = memory(), unknown()
    cells[20, 20] = 0
    mem.fuse(costmap(cells, Pose2(4.8, 4.8, 0.3)))
    assert mem.spec.shape == (100, 100)


@pytest.mark.parametrize("fusion", ["overwrite", "max", "log_odds"])
def test_growth_is_bounded(fusion) -> None:
    mem = memory(fusion=fusion)
    for x in np.arange(0.0, 40.0, 1.5):
        mem.fuse(costmap(free(), Pose2(float(x), -float(x), 0.2)))
    assert mem.spec.shape == (200, 200)
    assert mem.occupancy().shape == (200, 200)
    assert at(mem, 9.0, -9.0) == 0


@pytest.mark.parametrize("fusion", ["overwrite", "max", "log_odds"])
@pytest.mark.parametrize("far", [30.0, 1e6, 9e8, -9e8])
def test_a_robot_far_outside_the_largest_map_leaves_it_as_it_is(
    fusion: str, far: float
) -> None:
    mem = memory(
        fusion=fusion, footprint_m=(0.5, 0.5, -0.5, 0.5, -0.5, -0.5, 0.5, -0.5)
    )
    assert mem.fuse(costmap(free(), Pose2(far, far, 0.3)))
    assert mem.spec.shape == (100, 100)
    assert (mem.occupancy() == -1).all()


def test_a_loaded_map_of_smaller_cells_gets_no_more_of_them() -> None:
    mem = memory()
    spec = GridSpec(SPEC.resolution / 2, 100, 100, Pose2(-2.5, -2.5, 0.0))
    mem.load(np.zeros(spec.shape, np.int8), spec)
    for x in np.arange(0.0, 40.0, 1.5):
        mem.fuse(costmap(free(), Pose2(float(x), 0.0, 0.0)))
    assert mem.spec.width == 180  # 200 less what does not fill growth_m


def test_cells_under_the_body_are_free() -> None:
    body = (-0.5, -0.7, 1.5, -0.7, 1.5, 0.7, -0.5, 0.7)
    for fusion in ("overwrite", "log_odds"):
        mem, cells = memory(fusion=fusion, footprint_m=body), unknown()
        cells[10:31, 10:31] = -1
        cells[20, 24] = 100
        cells[20, 40] = 100
        mem.fuse(costmap(cells))
        assert at(mem, *SPEC.center_of(20, 24)) == 0
        assert at(mem, 1.35, 0.55) == 0
        assert at(mem, -0.35, -0.55) == 0
        assert at(mem, 1.45, 0.0) == -1
        assert at(mem, *SPEC.center_of(20, 40)) == 100


def test_reset_clears_the_map() -> None:
    mem = memory()
    mem.fuse(costmap(free(), Pose2(8.0, 0.0, 0.0)))
    mem.reset()
    assert mem.spec.shape == (100, 100)
    assert (mem.occupancy() == -1).all()


def test_occupancy_returns_a_copy() -> None:
    mem = memory()
    mem.occupancy()[:] = 100
    assert (mem.occupancy() == -1).all()


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"fusion": "mean"}, "must be one of overwrite, max, log_odds"),
        ({"max_size_m": 5.0}, "'max_size_m': 5.0 m; must be at least size_m, 10.0 m"),
        ({"max_size_m": 1e6}, "at most 20000 cells"),
        ({"update_period_s": 0.0}, "'update_period_s'"),
    ],
)
def test_bad_parameters_are_named(values, text) -> None:
    with pytest.raises(ParameterError, match=text):
        memory(**values)


def test_bad_footprint_is_named() -> None:
    with pytest.raises(ParameterError, match="'footprint_m': footprint: 3 numbers"):
        memory(footprint_m=(0.0, 1.0, 2.0))


@pytest.mark.parametrize("fusion", ["overwrite", "log_odds"])
def test_clearing_keeps_what_stands_beside_the_body_in_a_blind_spot(
    fusion: str,
) -> None:
    spec = GridSpec(0.1, 40, 40, Pose2(-2.0, -2.0, 0.0))
    here = Pose2(0.0, 0.0, 0.0)
    hits = np.array([(-0.9, 0.03), (0.52, 0.03), (-1.6, 0.03)])
    memory = MapMemory(
        MapMemoryParams(
            fusion=fusion, size_m=6.0, footprint_m=(0.2, 0.2, -0.2, 0.0, 0.2, -0.2)
        )
    )
    seen = np.full(spec.shape, 0, np.int8)
    seen[tuple(np.array([spec.cell_of(*point) for point in hits.tolist()]).T)] = 100
    memory.fuse(PlacedCostmap(seen, spec, (0.0, 0.0), here, 1, hits=hits))
    ahead = np.zeros(spec.shape, np.int8)
    ahead[:, :20] = -1
    newest = PlacedCostmap(ahead, spec, (0.0, 0.0), here, 2, hits=hits[:0])
    beside = memory.points_in_blind_spot(newest)
    memory.clear()
    memory.fuse(newest)
    memory.restore(beside)
    cells = memory.occupancy()
    behind, before, far = (cells[memory.spec.cell_of(*p)] for p in hits.tolist())
    assert behind >= 97
    assert before < 50
    assert far == -1
    assert memory.hit_points() == pytest.approx(hits[:1], abs=0.007)


@pytest.mark.parametrize("seed", range(4))
def test_marked_cells_are_those_of_the_whole_map_after_every_scan(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mem = memory()
    for _ in range(20):
        pose = Pose2(*rng.uniform((-6, -6, -3), (6, 6, 3)))  # some scans enlarge it
        cells = rng.choice(
            np.array([-1, 0, 100], np.int8), SPEC.shape, p=[0.2, 0.75, 0.05]
        )
        seen = costmap(cells, pose)
        hits = seen.spec.centers_of(np.argwhere(cells == 100))
        mem.fuse(dataclasses.replace(seen, hits=hits))
        if rng.random() < 0.7:
            whole = CellWindow.whole(mem.spec.shape)
            expected = marked_cells(mem._masks.cells, mem.spec, mem.cells, whole)
            np.testing.assert_allclose(mem.hit_points(), expected.points, atol=1e-9)
