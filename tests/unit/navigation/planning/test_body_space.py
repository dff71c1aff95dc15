"""The flood over poses of the body against what geometry gives."""

import numpy as np
import pytest

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    GridSpec,
    exact_clearances,
    make_obstacles,
    make_outline,
)
from navette.navigation.planning import pose_flood
from navette.navigation.planning.body_space import BodySpace
from navette.navigation.planning.close_look import close_map
from navette.navigation.planning.drive_path import DriveMoves, DrivePath
from navette.navigation.planning.pose_flood import Fit

BODY = Footprint(((0.5, 0.2), (-0.5, 0.2), (-0.5, -0.2), (0.5, -0.2)))
START = Pose2(1.0, 2.0, 0.0)


def driven(
    space: BodySpace,
    cells: np.ndarray,
    moves: DriveMoves,
    seen: BodySpace | None = None,
    fit: Fit | None = None,
    **heading: float,
) -> DrivePath:
    """Return a path; without more, all space was seen and all open poses fit."""
    if fit is None:
        nothing = make_obstacles(np.zeros((1, 1), np.uint8), GridSpec(1.0, 1, 1))
        fit = space.fit(space, nothing, 0.0, 0.0, 0.0)._replace(sure=space._open)
    return space.drive_to(cells, moves, seen or space, fit, **heading)


def wall(gap_m: float, grid_yaw: float = 0.0) -> tuple[np.ndarray, GridSpec]:
    """A wall across a room of 4 m, with a gap in its middle."""
    spec = GridSpec(0.02, 200, 200, Pose2(0.0, 0.0, grid_yaw))
    lethal = np.zeros(spec.shape, np.bool_)
    lethal[:, 100:104] = True
    half = round(gap_m / 2 / spec.resolution)
    lethal[100 - half : 100 + half, 100:104] = False
    return lethal, spec


def beyond(gap_m: float, margin_m: float | None, grid_yaw: float = 0.0) -> bool:
    lethal, spec = wall(gap_m, grid_yaw)
    start = spec.origin @ START
    space = BodySpace(lethal, spec, BODY, start, margin_m=margin_m)
    return bool(space.reached_from(np.array([space.start]))[100, 160])


@pytest.mark.parametrize("grid_yaw", [0.0, 0.7])
@pytest.mark.parametrize(
    ("gap_m", "margin_m", "passes"),
    [
        (0.36, None, False),  # narrower than the body
        (0.52, None, True),
        (0.44, 0.03, False),
        (0.52, 0.03, True),
    ],
)
def test_a_gap_is_passed_if_the_body_fits_through(
    gap_m: float, margin_m: float | None, passes: bool, grid_yaw: float
) -> None:
    assert beyond(gap_m, margin_m, grid_yaw) == passes


def test_from_within_an_enclosure_nothing_outside_is_reached() -> None:
    spec = GridSpec(0.05, 80, 80)
    lethal = np.zeros(spec.shape, np.bool_)
    lethal[20:60, 20:60] = True
    lethal[21:59, 21:59] = False
    space = BodySpace(lethal, spec, BODY, Pose2(0.6, 0.6, 0.0))
    inside = space.reached_from(np.array([[40, 40]]))
    assert inside[40, 40]
    assert not inside[:20].any()
    assert not inside[:, 60:].any()
    both = space.reached_from(np.array([[40, 40], space.start]))
    outside = space.reached_from(np.array([space.start]))
    np.testing.assert_array_equal(both, inside | outside)


def test_the_start_is_open_even_within_an_obstacle() -> None:
    spec = GridSpec(0.05, 40, 40)
    space = BodySpace(np.ones(spec.shape, np.bool_), spec, BODY, Pose2(1, 1, 0))
    reached = space.reached_from(np.array([space.start]))
    assert reached.sum() == 1


def test_a_close_map_has_obstacles_only_where_beams_ended() -> None:
    """Cells of 0.1 m that beams measured become free but for the points in them."""
    spec = GridSpec(0.1, 60, 60, Pose2(-3.0, -3.0, 0.0))
    occupancy = np.zeros(spec.shape, np.int8)
    occupancy[30, 20:40] = 100
    occupancy[10, 10] = 100  # not measured: stays
    hits = np.column_stack([np.arange(-0.99, 0.99, 0.01), np.full(198, 0.03)])
    ends = np.array([(-2.0, -1.0), (2.0, 1.0)])
    closer = close_map(occupancy, spec, hits, 100, ends, 0.6)
    fine = closer.spec
    assert fine.resolution == pytest.approx(0.025)
    rows = np.flatnonzero((closer.occupancy == 100).any(axis=1))
    y = [fine.center_of(int(row), 0)[1] for row in rows]
    wall_rows = [each for each in y if abs(each) < 0.2]
    assert wall_rows == [pytest.approx(0.0375)], "one row of 2.5 cm, not of 10 cm"
    lonely = fine.cell_of(*spec.center_of(10, 10))
    assert closer.occupancy[lonely] == 100
    for x, y_ in ends.tolist():
        assert fine.contains(*fine.cell_of(x, y_))


def bay() -> tuple[np.ndarray, GridSpec]:
    """A lane of 0.6 m, and a bay of 1.2 m × 0.6 m beside it."""
    spec = GridSpec(0.05, 120, 40)
    lethal = np.ones(spec.shape, np.bool_)
    lethal[4:16, 2:118] = False
    lethal[16:28, 60:84] = False
    return lethal, spec


@pytest.mark.parametrize(
    ("drive", "enters"),
    [("differential", False), ("ackermann", False), ("omni", True)],
)
def test_only_an_omnidirectional_drive_slides_into_a_bay(
    drive: str, enters: bool
) -> None:
    lethal, spec = bay()
    start = Pose2(1.0, 0.5, 0.0)
    space = BodySpace(lethal, spec, BODY, start, margin_m=0.03)
    moves = DriveMoves(drive, 0.8 if drive == "ackermann" else 0.0)
    path = driven(space, np.array([spec.cell_of(3.6, 1.1)]), moves)
    assert (path.poses is not None) == enters
    assert path.is_proof
    assert driven(space, np.array([spec.cell_of(5.0, 0.5)]), moves).poses is not None


@pytest.mark.parametrize(
    ("drive", "radius_m"), [("differential", 0.0), ("ackermann", 0.8)]
)
def test_a_path_of_driven_poses_keeps_the_margin_and_the_drive(
    drive: str, radius_m: float
) -> None:
    lethal, spec = wall(0.56)
    start = Pose2(0.9, 1.2, 0.4)
    space = BodySpace(lethal, spec, BODY, start, margin_m=0.04)
    goal = np.array([spec.cell_of(3.2, 2.0)])
    path = driven(space, goal, DriveMoves(drive, radius_m)).poses
    assert path is not None
    assert path[0] == pytest.approx(start, abs=1e-6)
    obstacles = make_obstacles(lethal.astype(np.uint8), spec)
    clearance = exact_clearances(obstacles, make_outline(BODY), path, 0.1)
    assert clearance.min() > 0.04 - 0.75 * spec.resolution
    steps, turns = np.diff(path[:, :2], axis=0), np.diff(path[:, 2])
    turns = np.abs(np.remainder(turns + np.pi, 2 * np.pi) - np.pi)
    middle = path[:-1, 2] + np.diff(np.unwrap(path[:, 2])) / 2
    aside = np.cos(middle) * steps[:, 1] - np.sin(middle) * steps[:, 0]
    assert np.abs(aside).max() < 1e-4
    if radius_m:
        assert (turns * radius_m <= 1.01 * np.hypot(*steps.T)).all()


def test_a_body_moves_in_reverse_only_where_space_was_seen() -> None:
    """A lane in which the body cannot turn."""
    spec = GridSpec(0.05, 120, 40)
    lethal = np.ones(spec.shape, np.bool_)
    lethal[14:26, 2:118] = False
    start, goal = Pose2(5.0, 1.0, 0.0), np.array([spec.cell_of(2.0, 1.0)])
    space = BodySpace(lethal, spec, BODY, start, margin_m=0.0)
    moves = DriveMoves("ackermann", 0.8)
    path = driven(space, goal, moves).poses
    assert path is not None
    assert (np.diff(path[:, 0]) < 0).all()
    unseen = np.zeros(spec.shape, np.bool_)
    unseen[:, :60] = True
    seen = BodySpace(unseen, spec, BODY, start, margin_m=0.0)
    assert driven(space, goal, moves, seen=seen) == (None, True)
    near = np.array([spec.cell_of(4.2, 1.0)])
    assert driven(space, near, moves, seen=seen).poses is not None


@pytest.mark.parametrize("y", [1.0, 1.01, 1.02, 1.035])
def test_exact_poses_decide_in_a_lane_that_no_cell_proves(y: float) -> None:
    """3 cm to each side in the middle; within a cell the body may move by 3.5 cm."""
    spec = GridSpec(0.05, 120, 40)
    lethal = np.zeros(spec.shape, np.bool_)
    lethal[14], lethal[26] = True, True  # centres 0.6 m apart
    obstacles = make_obstacles(lethal.astype(np.uint8), spec)
    body = Footprint(((0.5, 0.245), (-0.5, 0.245), (-0.5, -0.245), (0.5, -0.245)))
    start, goal = Pose2(1.0, y + 0.005, 0.0), np.array([spec.cell_of(4.0, 1.02)])
    margin_m, within_cell_m = 0.02, 0.036
    loose = BodySpace(lethal, spec, body, start, margin_m=margin_m - within_cell_m)
    sure = BodySpace(lethal, spec, body, start, margin_m=margin_m + within_cell_m)
    moves = DriveMoves("differential", 0.0)
    assert driven(sure, goal, moves) == (None, True)
    outline = make_outline(body)
    clearance = exact_clearances(obstacles, outline, np.array([start]), 1.0)[0]
    fit = sure.fit(sure, obstacles, margin_m, margin_m, 0.0)
    path = driven(loose, goal, moves, fit=fit).poses
    assert (path is not None) == (clearance >= margin_m)
    if path is not None:
        kept = exact_clearances(obstacles, outline, path, 1.0)
        assert kept.min() >= margin_m - 1e-6


@pytest.mark.parametrize("drive", ["differential", "ackermann", "omni"])
@pytest.mark.parametrize("seed", range(4))
def test_a_long_body_keeps_its_clearance_between_the_poses_of_its_path(
    drive: str, seed: int
) -> None:
    """Between two headings the front of this body moves by 15 cm."""
    spec, margin_m, within_cell_m = GridSpec(0.05, 160, 120), 0.03, 0.036
    body = Footprint(((1.5, 0.3), (-0.4, 0.3), (-0.4, -0.3), (1.5, -0.3)))
    outline, moves = make_outline(body), DriveMoves(drive, 0.8)
    lethal = np.zeros(spec.shape, np.bool_)
    posts = np.random.default_rng(seed).uniform((3.0, 0.5), (6.0, 5.5), (10, 2))
    for x, y in posts:
        lethal[spec.cell_of(x, y)] = True
    obstacles = make_obstacles(lethal.astype(np.uint8), spec)
    start, goal = Pose2(1.5, 3.0, 0.0), np.array([spec.cell_of(7.0, 3.0)])

    def space(least_m: float) -> BodySpace:
        return BodySpace(lethal, spec, body, start, margin_m=least_m)

    driven_m = moves.longest_m(spec.resolution, outline.radius_m)
    proven = space(margin_m + within_cell_m + driven_m)
    turns = space(margin_m + within_cell_m)
    fit = proven.fit(turns, obstacles, margin_m, margin_m, 0.0)
    path = driven(space(margin_m), goal, moves, fit=fit).poses
    assert path is not None
    steps = np.diff(np.column_stack([path[:, :2], np.unwrap(path[:, 2])]), axis=0)
    for share in np.linspace(0.0, 1.0, 20):
        kept = exact_clearances(obstacles, outline, path[:-1] + share * steps, 1.0)
        # From check to check no point moves farther than 2.5 cm.
        assert kept.min() >= margin_m - 0.0125


def test_a_turn_at_the_start_is_checked_too() -> None:
    """A body that faces a wall 5 cm away turns only after it has backed up."""
    spec = GridSpec(0.025, 160, 120)
    lethal = np.zeros(spec.shape, np.bool_)
    lethal[:, 100] = True
    obstacles, outline = (
        make_obstacles(lethal.astype(np.uint8), spec),
        make_outline(BODY),
    )
    start, goal = Pose2(1.9, 1.5, 0.0), np.array([spec.cell_of(0.8, 1.5)])
    loose = BodySpace(lethal, spec, BODY, start, margin_m=0.02 - 0.018)
    sure = BodySpace(lethal, spec, BODY, start, margin_m=0.02 + 0.018)
    fit = sure.fit(sure, obstacles, 0.02, 0.02, outline.radius_m)
    far = np.zeros(spec.shape, np.bool_)
    far[:, :52] = True  # unseen space begins 10 cm behind the body
    seen = BodySpace(far, spec, BODY, start, margin_m=0.0)
    moves = DriveMoves("differential", 0.0)
    path = driven(loose, goal, moves, seen=seen, fit=fit).poses
    assert path is not None
    assert exact_clearances(obstacles, outline, path, 1.0).min() >= 0.02 - 1e-6
    assert path[:, 0].min() < 0.9
    assert path[1, 0] < 1.9, "back first"


@pytest.mark.parametrize("drive", ["differential", "ackermann"])
def test_a_small_region_around_the_goal_decides(drive: str) -> None:
    """A hall of 40 m × 40 m, and a closet with a slit beside it."""
    spec = GridSpec(0.05, 800, 800)
    lethal = np.zeros(spec.shape, np.bool_)
    lethal[780, :] = lethal[780:, 770] = True
    lethal[780, 790:793] = False  # 0.15 m
    start, goal = Pose2(5.0, 5.0, 0.3), np.array([[790, 785]])
    space = BodySpace(lethal, spec, BODY, start, margin_m=0.0)
    path = driven(space, goal, DriveMoves(drive, 0.8))
    assert path == (None, True)
    there = driven(space, np.array([[700, 700]]), DriveMoves(drive, 0.8))
    assert there.poses is not None


def test_two_large_regions_are_proven_separate_beyond_a_guided_flood(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two halves of a hall of 0.6 million poses each; within one a path is short."""
    monkeypatch.setattr(pose_flood, "_ROOM", 100_000)
    lethal, spec = np.zeros((200, 200), np.bool_), GridSpec(0.05, 200, 200)
    lethal[100] = True
    space = BodySpace(lethal, spec, BODY, Pose2(5.0, 2.5, 0.3), margin_m=0.0)
    far, near = np.array([[150, 100]]), np.array([[60, 120]])
    moves = DriveMoves("ackermann", 0.8)
    assert driven(space, far, moves) == (None, True)
    assert driven(space, near, moves).poses is not None
    monkeypatch.setattr(pose_flood, "_ROOM", 1_000)
    assert driven(space, far, moves) == (None, False)


def test_the_last_heading_is_the_one_wanted() -> None:
    spec = GridSpec(0.05, 100, 60)
    space = BodySpace(
        np.zeros(spec.shape, np.bool_), spec, BODY, Pose2(1.0, 1.0, 0.5), margin_m=0.0
    )
    goal, moves = np.array([spec.cell_of(4.0, 2.0)]), DriveMoves("ackermann", 0.8)
    path = driven(space, goal, moves, yaw=-2.0, tolerance_rad=0.2).poses
    assert path is not None
    assert path[-1] == pytest.approx([4.0, 2.0, -2.0], abs=0.2)
