"""Kernels that collect obstacle points, against their steps one by one."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    FREE,
    LETHAL,
    UNKNOWN,
    CellWindow,
    GridSpec,
    Layer,
    MapPart,
    ObstacleTracker,
    ReceivedMap,
    cell_points,
    grid_frame,
    grid_to_message,
    mark_points,
    obstacle_points,
    points_to_message,
)
from navette.navigation.grids.map_obstacles import (
    LethalCells,
    MapObstacles,
    Region,
    _hidden,
)
from navette.navigation.grids.obstacle_points import points_within
from navette.navigation.grids.obstacles import _seen_also
from navette.navigation.grids.sub_cells import CellMarks

SEEDS = st.integers(0, 10_000)


def some_pose(rng: np.random.Generator) -> Pose2:
    x, y, yaw = rng.uniform((-5, -5, -3.1), (5, 5, 3.1)).tolist()
    return Pose2(x, y, yaw)


def some_grid(rng: np.random.Generator) -> tuple[np.ndarray, GridSpec]:
    height, width = rng.integers(1, 150, 2).tolist()
    spec = GridSpec(float(rng.choice([0.05, 0.1])), width, height, some_pose(rng))
    share = rng.choice([0.0, 0.01, 0.3])
    cells = rng.integers(UNKNOWN, LETHAL, spec.shape, np.int8)
    cells[rng.random(spec.shape) < share] = LETHAL
    return cells, spec


def centres(spec: GridSpec, cells: np.ndarray) -> np.ndarray:
    return spec.centers_of(np.argwhere(cells))


def inside(cells: np.ndarray, lethal: int) -> np.ndarray:
    """Return the lethal cells between four others."""
    is_lethal = np.pad(cells >= lethal, 1)
    center = is_lethal[1:-1, 1:-1]
    across = is_lethal[1:-1, :-2] & is_lethal[1:-1, 2:]
    along = is_lethal[:-2, 1:-1] & is_lethal[2:, 1:-1]
    return center & across & along


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS)
def test_obstacle_points_are_the_lethal_cells_within_reach(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells, spec = some_grid(rng)
    map_T_grid, around = some_pose(rng), some_pose(rng)
    reach_m, lethal = float(rng.uniform(0, 6)), int(rng.integers(1, LETHAL + 1))
    found = obstacle_points(
        cells, spec, map_T_grid, lethal_cost=lethal, around=around, reach_m=reach_m
    )
    left_out = inside(cells, lethal)
    step = round(0.1 / spec.resolution)
    left_out[::step, ::step] = False
    plain = map_T_grid.apply(centres(spec, (cells >= lethal) & ~left_out))
    away = np.hypot(*(plain - (around.x, around.y)).T)
    np.testing.assert_allclose(found, plain[away <= reach_m], atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS)
def test_cells_inside_filled_areas_are_not_needed(seed: int) -> None:
    """The distance from every other place is that from all lethal cells."""
    rng = np.random.default_rng(seed)
    spec = GridSpec(0.05, 40, 30, some_pose(rng))
    cells = np.zeros(spec.shape, np.int8)
    for _ in range(4):
        row, column = rng.integers(0, 25), rng.integers(0, 35)
        cells[
            row : row + rng.integers(1, 15), column : column + rng.integers(1, 15)
        ] = LETHAL
    found = obstacle_points(
        cells,
        spec,
        Pose2(0.0, 0.0, 0.0),
        lethal_cost=LETHAL,
        around=Pose2(0.0, 0.0, 0.0),
        reach_m=99.0,
    )
    plain = centres(spec, cells >= LETHAL)
    assert len(found) < len(plain) or not inside(cells, LETHAL).any()
    for place in centres(spec, cells < LETHAL):
        nearest = np.hypot(*(plain - place).T).min()
        assert np.hypot(*(found - place).T).min() <= nearest + 1e-9
    # No body of 16 cm, the smallest, stands between those inside.
    for place in plain:
        assert np.hypot(*(found - place).T).min() < 0.08


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS)
def test_placed_points_within_reach(seed: int) -> None:
    rng = np.random.default_rng(seed)
    map_T_frame, around, reach_m = some_pose(rng), some_pose(rng), rng.uniform(0, 8)
    points = rng.uniform(-6, 6, (int(rng.integers(0, 50)), 2))
    found = points_within(points, map_T_frame, around=around, reach_m=reach_m)
    plain = map_T_frame.apply(points)
    away = np.hypot(*(plain - (around.x, around.y)).T)
    np.testing.assert_allclose(found, plain[away <= reach_m], atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS)
def test_points_in_known_cells_are_left_out(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells, spec = some_grid(rng)
    points = rng.uniform(-12, 12, (40, 2))

    body_x, body_y, body_m = *rng.uniform(-6, 6, 2), rng.uniform(0, 6)

    def is_seen(x: float, y: float) -> bool:
        row, column = cell = spec.cell_of(x, y)
        if not spec.contains(*cell) or cells[cell] == UNKNOWN:
            return False
        if cells[cell] >= 100 or math.hypot(x - body_x, y - body_y) > body_m:
            return True
        around = cells[max(0, row - 1) : row + 2, max(0, column - 1) : column + 2]
        return not (around >= 100).any()

    reach_m = float(rng.uniform(4, 20))
    plain = [
        point
        for point in points.tolist()
        if math.dist(point, (body_x, body_y)) <= reach_m and not is_seen(*point)
    ]
    near = LethalCells(points, np.arange(len(points) + 1), points)
    region = body_x, body_y, reach_m, body_m
    found = _hidden(near, cells, grid_frame(spec), 100, region)
    np.testing.assert_array_equal(found, np.array(plain).reshape(-1, 2))


@settings(max_examples=30, deadline=None)
@given(seed=SEEDS, radius_m=st.sampled_from([None, 0.003]))
def test_cells_collected_before_the_robot_moved_give_the_same_points(
    seed: int, radius_m: float | None
) -> None:
    rng = np.random.default_rng(seed)
    cells, spec = some_grid(rng)
    shown, placed = some_grid(rng)
    size = np.array((spec.width, spec.height)) * spec.resolution
    hits = points_to_message(spec.origin.apply(rng.random((50, 2)) * size), "map", 7)

    def make() -> MapObstacles:
        obstacles = MapObstacles()
        obstacles.receive_points(hits)
        obstacles.receive(cells, spec, 7)
        return obstacles

    used, around = make(), some_pose(rng)
    for step in range(6):
        around = around @ Pose2(0.4, 0.0, 0.3)
        region = Region(around, 2.0 + 0.1 * step, LETHAL - step // 4, radius_m)
        found, plain = (
            obstacles.hidden_from(Layer(shown, placed), region, 0.3)
            for obstacles in (used, make())
        )
        np.testing.assert_allclose(found, plain, atol=1e-9)


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS, count=st.sampled_from([0, 1, 200]))
def test_points_of_a_few_cells_are_those_of_the_whole_grid(
    seed: int, count: int
) -> None:
    rng = np.random.default_rng(seed)
    _, spec = some_grid(rng)
    size = np.array((spec.width, spec.height)) * spec.resolution
    hits = spec.origin.apply(rng.uniform(-0.2, 1.2, (count, 2)) * size)
    cells = np.argwhere(rng.random(spec.shape) < 0.1)
    masks = np.zeros(spec.shape, np.uint64)
    mark_points(masks, spec, hits)
    marks = CellMarks.of(spec, hits)
    first, found = marks.points_by_cell(spec, spec.centers_of(cells), 0.003)
    plain = [
        cell_points(masks[tuple(cell)][None], spec, cell[None], 0.003) for cell in cells
    ]
    assert np.diff(first).tolist() == [len(points) for points in plain]
    assert first[-1] == len(found)
    if plain:
        np.testing.assert_allclose(found, np.vstack(plain), atol=1e-9)


def test_cells_that_a_map_has_shown_stay_seen() -> None:
    """Clearing the map near the robot must not make known space unseen."""
    spec = GridSpec(0.1, 6, 4, Pose2(0.0, 0.0, 0.0))
    before = np.zeros(spec.shape, np.int8)
    before[0] = UNKNOWN
    now = np.full(spec.shape, UNKNOWN, np.int8)
    now[1, 2] = LETHAL
    whole = CellWindow.whole(spec.shape)
    seen = _seen_also(Layer(now, spec), Layer(before, spec), whole, LETHAL)
    assert (seen.cells[0] == UNKNOWN).all()
    assert (seen.cells[1:] != UNKNOWN).all()
    assert seen.cells[1, 2] == LETHAL, "what is known now counts"
    assert (now[2:] == UNKNOWN).all(), "the map itself is not changed"


def test_a_map_that_shows_no_less_is_used_as_it_is() -> None:
    spec = GridSpec(0.1, 6, 4, Pose2(0.0, 0.0, 0.0))
    first = Layer(np.full(spec.shape, UNKNOWN, np.int8), spec)
    more = Layer(np.zeros(spec.shape, np.int8), spec)
    whole = CellWindow.whole(spec.shape)
    assert _seen_also(first, None, whole, LETHAL) is first
    assert _seen_also(more, first, whole, LETHAL) is more


def test_a_map_that_grew_keeps_what_the_smaller_one_has_shown() -> None:
    small = GridSpec(0.1, 6, 4, Pose2(0.0, 0.0, 0.0))
    large = GridSpec(0.1, 26, 24, Pose2(-1.0, -1.0, 0.0))
    now = Layer(np.full(large.shape, UNKNOWN, np.int8), large)
    before = Layer(np.zeros(small.shape, np.int8), small)
    seen = _seen_also(now, before, CellWindow.whole(large.shape), LETHAL)
    inside = seen.cells[10:14, 10:16]
    assert (inside != UNKNOWN).all()
    assert (seen.cells != UNKNOWN).sum() == inside.size
    for window, has_lost in (
        (CellWindow(13, 24, 15, 26), True),
        (CellWindow(14, 24, 0, 26), False),
        (CellWindow(0, 24, 16, 26), False),
        (CellWindow(0, 24, 0, 10), False),
        (CellWindow(0, 11, 0, 11), True),
    ):
        assert (_seen_also(now, before, window, LETHAL) is not now) == has_lost, window


def test_a_map_that_only_grew_is_used_as_it_is() -> None:
    """Growth must not cost a copy of the whole map."""
    small = GridSpec(0.1, 6, 4, Pose2(0.3, 0.2, 0.5))
    large = GridSpec(0.1, 9, 11, small.origin @ Pose2(-0.2, -0.4, 0.0))
    cells = np.full(large.shape, UNKNOWN, np.int8)
    cells[4:8, 2:8] = 0
    now, before = Layer(cells, large), Layer(np.zeros(small.shape, np.int8), small)
    assert _seen_also(now, before, CellWindow.whole(large.shape), LETHAL) is now
    cells[7, 7] = UNKNOWN
    assert (
        _seen_also(now, before, CellWindow.whole(large.shape), LETHAL).cells[7, 7] == 0
    )


AFAR = Pose2(500.0, 0.0, 0.0)


class Driving:
    """The poses of a robot that drives about in the map."""

    map_frame = "map"
    first = Pose2(0.0, 0.0, 0.0)

    def __init__(self) -> None:
        self.pose = self.first

    def predicted_at(self, stamp_ns: int) -> Pose2:
        return self.pose

    def predicted_now(self, now_ns: int) -> Pose2:
        return self.pose

    def transform_to_base(self, frame_id: str) -> Pose2:
        return self.first


def test_only_the_cells_near_the_robot_are_kept_of_a_map_that_lost_some() -> None:
    """After a loop closure each map loses cells: a copy of all would take 10 ms."""
    spec = GridSpec(0.1, 60, 40, Pose2(1.0, 2.0, 0.3))
    rng = np.random.default_rng(1)
    values = np.array([UNKNOWN, FREE, LETHAL], np.int8)
    before, now = rng.choice(values, (2, *spec.shape))
    window = CellWindow(5, 25, 10, 50)
    seen = _seen_also(Layer(now, spec), Layer(before, spec), window, LETHAL)
    known = ((now != UNKNOWN) | (before == FREE))[window.slices]
    np.testing.assert_array_equal(seen.cells != UNKNOWN, known)
    later = _seen_also(Layer(now, spec), seen, CellWindow(0, 20, 20, 60), LETHAL)
    again = ((now != UNKNOWN) | (before == FREE))[5:20, 20:50]
    np.testing.assert_array_equal(later.cells[5:, :30] != UNKNOWN, again)
    only_now = now[:20, 20:60] != UNKNOWN
    np.testing.assert_array_equal(later.cells[:, 30:] != UNKNOWN, only_now[:, 30:])


def test_a_robot_that_leaves_what_is_kept_sees_the_newest_map() -> None:
    poses = Driving()
    outline = Footprint.from_flat((0.2, 0.2, -0.2, 0.2, -0.2, -0.2, 0.2, -0.2))
    tracker = ObstacleTracker(poses, outline, hand_m=0.0)
    spec = GridSpec(0.1, 600, 100, Pose2(-5.0, -5.0, 0.0))
    cells = np.zeros(spec.shape, np.int8)
    tracker.remember(ReceivedMap(cells, spec), None, 0, 0, LETHAL)
    cells = cells.copy()
    cells[50:60, 60:70] = UNKNOWN  # near the robot
    cells[50:60, 400:410] = UNKNOWN  # 35 m ahead
    tracker.remember(ReceivedMap(cells, spec), None, 1, 0, LETHAL)
    unseen = []
    for x in (0.0, 1.0, 36.0):
        poses.pose = Pose2(x, 0.0, 0.0)
        grid = np.full((3, 3), UNKNOWN, np.int8)
        tracker.receive(grid_to_message(grid, GridSpec(0.1, 3, 3), "map", 1), 0)
        placed = tracker.place(0, LETHAL, reach_m=3.0, unseen_reach_m=3.0)
        assert placed is not None
        unseen.append(len(placed.unseen))
    assert unseen == [0, 0, 100]


def test_an_obstacle_that_is_cleared_from_the_map_is_not_seen_any_more() -> None:
    """A robot that backs up would touch it: its lidar does not look there."""
    outline = Footprint.from_flat((0.2, 0.2, -0.2, 0.2, -0.2, -0.2, 0.2, -0.2))
    tracker = ObstacleTracker(Driving(), outline, hand_m=0.0)
    spec = GridSpec(0.1, 100, 100, Pose2(-5.0, -5.0, 0.0))
    cells = np.zeros(spec.shape, np.int8)
    cells[45:48, 40:42] = LETHAL  # behind the robot
    tracker.remember(ReceivedMap(cells, spec), None, 0, 0, LETHAL)
    cleared = cells.copy()
    cleared[30:70, 30:70] = UNKNOWN
    for stamp_ns in (1, 2):  # also in the map after the next
        tracker.remember(ReceivedMap(cleared, spec), None, stamp_ns, 0, LETHAL)
    grid = np.full((3, 3), UNKNOWN, np.int8)
    tracker.receive(grid_to_message(grid, GridSpec(0.1, 3, 3), "map", 1), 0)
    placed = tracker.place(0, LETHAL, reach_m=3.0, unseen_reach_m=3.0)
    assert placed is not None
    assert len(placed.points) == 0
    centers = np.array([(x, y) for y in (-0.45, -0.35, -0.25) for x in (-0.95, -0.85)])
    np.testing.assert_allclose(placed.unseen, centers)


def test_a_new_map_may_be_far_from_the_robot() -> None:
    outline = Footprint.from_flat((0.2, 0.2, -0.2, 0.2, -0.2, -0.2, 0.2, -0.2))
    tracker = ObstacleTracker(Driving(), outline, hand_m=0.0)
    for stamp_ns, spec in enumerate(
        (GridSpec(0.1, 60, 60, Pose2(-3.0, -3.0, 0.0)), GridSpec(0.05, 40, 40, AFAR))
    ):
        cells = np.zeros(spec.shape, np.int8)
        tracker.remember(ReceivedMap(cells, spec), None, stamp_ns, 0, LETHAL)
    grid = grid_to_message(np.zeros((3, 3), np.int8), GridSpec(0.1, 3, 3), "map", 1)
    tracker.receive(grid, 0)
    placed = tracker.place(0, LETHAL, reach_m=1.0, unseen_reach_m=1.0)
    assert placed is not None
    assert len(placed.unseen) > 0  # this map does not show the place of the robot


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS)
def test_parts_of_a_map_give_the_same_obstacles_as_whole_maps(seed: int) -> None:
    """Also where cells that were known become unknown, which have been seen."""
    rng = np.random.default_rng(seed)
    spec = GridSpec(0.1, 90, 90, Pose2(-4.5, -4.5, 0.0))
    cells = rng.choice(np.array([UNKNOWN, FREE], np.int8), spec.shape)
    costmap = np.full((3, 3), UNKNOWN, np.int8)
    poses = Driving()
    outline = Footprint.from_flat((0.2, 0.2, -0.2, 0.2, -0.2, -0.2, 0.2, -0.2))
    by_parts = ObstacleTracker(poses, outline, hand_m=0.0)
    by_wholes = ObstacleTracker(poses, outline, hand_m=0.0)
    known = ReceivedMap(cells.copy(), spec)
    by_parts.remember(known, None, 0, 0, LETHAL)
    by_wholes.remember(ReceivedMap(cells.copy(), spec), None, 0, 0, LETHAL)
    for stamp_ns in range(1, 8):
        poses.pose = Pose2(*rng.uniform(-2.0, 2.0, 2).tolist(), 0.0)
        row, column = rng.integers(0, 80, 2).tolist()
        window = CellWindow(row, row + 10, column, column + 10)
        values = np.array([UNKNOWN, FREE, LETHAL], np.int8)
        part = rng.choice(values, window.shape, p=rng.dirichlet((0.3, 1, 1)))
        cells[window.slices] = part
        by_parts.remember(known, MapPart(part, window), stamp_ns, 0, LETHAL)
        by_wholes.remember(ReceivedMap(cells.copy(), spec), None, stamp_ns, 0, LETHAL)
        np.testing.assert_array_equal(known.cells, cells)
        grid = grid_to_message(costmap, GridSpec(0.1, 3, 3), "map", stamp_ns)
        placed = []
        for tracker in (by_parts, by_wholes):
            tracker.receive(grid, 0)
            placed.append(tracker.place(0, LETHAL, reach_m=2.0, unseen_reach_m=1.0))
        assert placed[0] is not None
        assert placed[1] is not None
        for one, other in zip(*placed, strict=True):
            np.testing.assert_array_equal(one, other)
