"""Motion sets of the drives, and the paths that they give."""

import math
from dataclasses import replace

import numpy as np
import pytest
from planning_worlds import empty_map, fill

from navette.errors import ParameterError
from navette.geometry import DRIVES, Pose2
from navette.navigation.control import ControlParams
from navette.navigation.grids import UNKNOWN, GridSpec
from navette.navigation.planning import (
    Goal,
    NewMap,
    Outcome,
    Planner,
    PlannerParams,
)
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.lattice_motions import MOVES, Motions
from navette.navigation.planning.path_shape import bend, directions, lengths

RADIUS_M = 0.85
PARAMS = {
    "differential": PlannerParams(clearance_margin_m=0.1, comfort_m=0.1),
    "ackermann": PlannerParams(
        drive="ackermann",
        min_turning_radius_m=RADIUS_M,
        clearance_margin_m=0.1,
        comfort_m=0.1,
    ),
    "omni": PlannerParams(drive="omni", clearance_margin_m=0.1, comfort_m=0.1),
}


def plan(drive: str, start: Pose2, goal: Goal) -> np.ndarray:
    """Return the poses in a room of 8 m with a wall in the middle."""
    occupancy, spec = empty_map(8, 8)
    fill(occupancy, spec, (3.8, 4.2), (0.0, 4.5))
    planner = Planner(PARAMS[drive])
    planner.set_map(NewMap(occupancy, spec))
    found = planner.plan(start, goal)
    assert found.outcome.has_path
    return found.poses


def turned(poses: np.ndarray) -> np.ndarray:
    """Return (N − 1,) radians between successive poses."""
    steps = np.diff(poses[:, 2])
    return np.asarray(np.abs(np.remainder(steps + np.pi, 2 * np.pi) - np.pi))


def test_every_drive_has_a_motion_set() -> None:
    assert tuple(MOVES) == DRIVES
    for drive in DRIVES:
        motions = Motions(step_m=0.3, reach_m=0.4, drive=drive)
        assert len(set(motions.moves)) == len(motions.moves)
        assert len(motions.offsets) == len(motions.costs_m) == len(motions.moves)
        assert (motions.costs_m > 0).all()


def test_only_an_ackermann_drive_does_not_turn_in_place() -> None:
    for drive in DRIVES:
        spins = [m for m in MOVES[drive] if not (m.forward or m.side)]
        assert bool(spins) == (drive != "ackermann")


@pytest.mark.parametrize(
    "goal", [Goal(6.5, 2.0), Goal(6.5, 2.0, math.pi / 2), Goal(1.0, 2.0, -2.0)]
)
def test_an_ackermann_path_keeps_the_least_radius(goal: Goal) -> None:
    poses = plan("ackermann", Pose2(1.5, 2.0, 0.0), goal)
    assert np.all(turned(poses) * RADIUS_M <= 1.02 * lengths(poses) + 1e-6)
    assert math.dist(poses[-1, :2], (goal.x, goal.y)) < 0.5
    if goal.yaw is not None:
        assert abs(math.remainder(poses[-1, 2] - goal.yaw, math.tau)) <= 0.2 + 1e-9


def test_an_ackermann_drive_reverses_to_a_goal_behind_it() -> None:
    poses = plan("ackermann", Pose2(2.5, 2.0, 0.0), Goal(1.2, 2.0, 0.0))
    assert turned(poses).max() < 0.1, "it backs up instead of turning around"


def test_an_omnidirectional_drive_moves_sideways_between_walls() -> None:
    """The corridor is narrower than the body's diagonal."""
    occupancy, spec = empty_map(4, 4)
    fill(occupancy, spec, (0.0, 1.65), (0.0, 4.0))
    fill(occupancy, spec, (2.35, 4.0), (0.0, 4.0))
    planner = Planner(PARAMS["omni"])
    planner.set_map(NewMap(occupancy, spec))
    poses = planner.plan(Pose2(2.0, 0.6, 0.0), Goal(2.0, 3.2, 0.0)).poses
    assert math.dist(poses[-1, :2], (2.0, 3.2)) < 0.5
    assert np.abs(poses[:, 2]).max() < 0.2


def test_drive_and_radius_must_agree() -> None:
    with pytest.raises(ParameterError, match="min_turning_radius_m"):
        PlannerParams(drive="ackermann")
    with pytest.raises(ParameterError, match="min_turning_radius_m"):
        PlannerParams(min_turning_radius_m=1.0)


@pytest.mark.parametrize("length_m", [0.3, -0.3])
@pytest.mark.parametrize("turn", [0.35, -0.9])
def test_a_bend_is_an_arc_of_the_length_and_the_turn(
    length_m: float, turn: float
) -> None:
    start = Pose2(1.0, 2.0, 2.9)
    poses = bend(start, turn, length_m)
    centre = start.apply(np.array([(0.0, length_m / turn)]))[0]
    away = np.hypot(*(poses[:, :2] - centre).T)
    np.testing.assert_allclose(away, abs(length_m / turn))
    assert turned(poses).sum() == pytest.approx(abs(turn))
    assert set(directions(poses)) == {math.copysign(1, length_m)}


def planner_before_a_passage() -> Planner:
    """A car's planner in a room with a passage, 6 cm wide on each side of the body."""
    occupancy, spec = empty_map(8, 8)
    low, high = 3.79, 4.21
    fill(occupancy, spec, (3.0, 5.0), (0.0, low))
    fill(occupancy, spec, (3.0, 5.0), (high, 8.0))
    along = np.arange(3.0, 5.0, 0.02)
    across = np.arange(0.0, 8.0, 0.02)
    across = across[(across < low) | (across > high)]
    walls = [(x, y) for y in (low, high) for x in along]
    walls += [(x, y) for x in (3.0, 5.0) for y in across]
    params = replace(
        PARAMS["ackermann"],
        footprint_m=(0.455, 0.15, -0.125, 0.15, -0.125, -0.15, 0.455, -0.15),
    )
    planner = Planner(params)
    planner.set_map(NewMap(occupancy, spec, np.array(walls)))
    return planner


@pytest.mark.parametrize("yaw", [0.0, 1.5])
def test_a_car_passes_a_long_passage_with_six_centimetres_on_each_side(
    yaw: float,
) -> None:
    """The heading of the passage is none of the search's without a bend first."""
    planner = planner_before_a_passage()
    found = planner.plan(Pose2(1.5, 4.6, yaw), Goal(6.5, 4.0))
    assert found.outcome.has_path
    assert found.margin_m > 0.02
    assert (turned(found.poses) <= lengths(found.poses) / RADIUS_M + 0.05).all()


@pytest.mark.parametrize("yaw_deg", [-10.0, -7.0])
def test_a_rough_path_that_does_not_fit_proves_nothing(yaw_deg: float) -> None:
    """Beside the mouth: a longer search may find what all rough motions do not."""
    start = Pose2(2.5, 3.75, math.radians(yaw_deg))
    found = planner_before_a_passage().plan(start, Goal(6.5, 4.0))
    assert found.outcome is not Outcome.NO_PATH


def test_a_robot_off_the_middle_of_a_passage_plans_what_the_controller_allows() -> None:
    """With less clearance than the controller's margin, it would stay blocked."""
    occupancy, spec = empty_map(8, 8)
    low, high = 3.77, 4.23
    fill(occupancy, spec, (2.0, 6.0), (0.0, low))
    fill(occupancy, spec, (2.0, 6.0), (high, 8.0))
    along = np.arange(2.0, 6.0, 0.02)
    walls = np.array([(x, y) for y in (low, high) for x in along])
    body = (0.3, 0.2, -0.3, 0.2, -0.3, -0.2, 0.3, -0.2)
    planner = Planner(replace(PARAMS["differential"], footprint_m=body))
    planner.set_map(NewMap(occupancy, spec, walls))
    found = planner.plan(Pose2(3.0, 4.01, 0.0), Goal(7.0, 4.0))
    assert found.outcome.has_path
    assert found.margin_m >= ControlParams().collision_margin_m


def lane_with_a_bay() -> tuple[np.ndarray, GridSpec]:
    """A room, a lane of 0.4 m from it, and a bay of 1 m × 0.4 m beside the lane."""
    spec = GridSpec(0.05, 160, 160)
    occupancy = np.zeros(spec.shape, np.int8)
    fill(occupancy, spec, (4.0, 8.0), (0.0, 8.0))
    fill(occupancy, spec, (4.0, 7.6), (1.0, 1.4), 0)
    fill(occupancy, spec, (6.0, 7.0), (1.4, 1.8), 0)
    return occupancy, spec


def test_a_car_has_no_path_into_a_bay_that_only_sliding_enters() -> None:
    """The body fits everywhere, and the search has far more poses than budget."""
    params = replace(
        PARAMS["ackermann"],
        goal_tolerance_m=0.1,
        path_end_tolerance_m=0.05,
        footprint_m=(0.775, 0.15, -0.125, 0.15, -0.125, -0.15, 0.775, -0.15),
        max_expansions=4_000,
    )
    planner = Planner(params)
    planner.set_map(NewMap(*lane_with_a_bay()))
    found = planner.plan(Pose2(2.0, 5.0, 2.0), Goal(6.175, 1.6))
    assert found.outcome is Outcome.NO_PATH


@pytest.mark.parametrize(
    ("drive", "yaw"),
    [
        ("differential", 3.1),
        ("omni", 3.1),
        ("ackermann", 3.1),
        ("ackermann", 0.0),
        ("ackermann", None),
    ],
)
def test_a_path_through_a_tight_place_is_found_after_the_search_limit(
    drive: str, yaw: float | None
) -> None:
    """A lane in which the body cannot turn, entered from a corner beside it."""
    params = replace(
        PARAMS[drive],
        footprint_m=(0.775, 0.15, -0.125, 0.15, -0.125, -0.15, 0.775, -0.15),
        max_expansions=100,
    )
    planner = Planner(params)
    occupancy, spec = lane_with_a_bay()
    fill(occupancy, spec, (4.0, 7.6), (0.9, 1.4), 0)
    planner.set_map(NewMap(occupancy, spec))
    found = planner.plan(Pose2(2.0, 5.0, 2.0), Goal(6.4, 1.15, yaw))
    assert found.outcome.has_path
    assert found.expansions >= params.max_expansions, "the search has no path"
    grid = planner.map.opened(found.margin_m, Pose2(2.0, 5.0, 2.0))
    assert check_path(found.poses, grid, planner.body).fits
    if yaw is not None:
        assert abs(math.remainder(found.poses[-1, 2] - yaw, math.tau)) <= 0.2
    if drive == "ackermann":
        arcs = lengths(found.poses) / RADIUS_M
        assert (turned(found.poses) <= 1.02 * arcs + 1e-6).all()


@pytest.mark.parametrize("gap_m", [0.08, 0.1])
def test_a_robot_put_down_facing_a_wall_backs_up_a_little_and_turns(
    gap_m: float,
) -> None:
    """Its lidar covers 270°: behind it only the width of a hand counts as free."""
    occupancy, spec = empty_map(8, 8)
    fill(occupancy, spec, (2.0, 2.0 + 2.0), (0.0, 8.0))
    fill(occupancy, spec, (0.0, 2.0 - gap_m - 0.5 + 0.02), (0.0, 8.0), UNKNOWN)
    fill(occupancy, spec, (0.0, 2.0), (4.8, 8.0), 0)  # what it sees on its left
    params = replace(
        PARAMS["differential"],
        footprint_m=(0.25, 0.2, -0.25, 0.2, -0.25, -0.2, 0.25, -0.2),
        blind_reverse_m=0.1,
    )
    planner = Planner(params)
    planner.set_map(NewMap(occupancy, spec))
    start = Pose2(2.0 - gap_m - 0.25, 3.0, 0.0)
    planner.put_down_at = start
    found = planner.plan(start, Goal(1.0, 6.5))
    assert found.outcome.has_path
    backed = lengths(found.poses)[directions(found.poses) < 0].sum()
    assert backed <= 0.05
    grid = planner.map.opened(found.margin_m, start)
    assert check_path(found.poses, grid, planner.body).fits


@pytest.mark.parametrize("front_m", [0.06, 0.1])
def test_a_car_leaves_a_parking_place_shorter_than_any_motion_of_the_search(
    front_m: float,
) -> None:
    occupancy, spec = empty_map(8, 6, 0.05)
    fill(occupancy, spec, (0.0, 8.0), (0.0, 2.75))
    fill(occupancy, spec, (0.0, 4.0 - 0.13 - 0.15), (0.0, 3.2))
    fill(occupancy, spec, (4.0 + 0.45 + front_m, 8.0), (0.0, 3.2))
    params = replace(
        PARAMS["ackermann"],
        footprint_m=(0.45, 0.14, -0.13, 0.14, -0.13, -0.14, 0.45, -0.14),
    )
    planner = Planner(params)
    planner.set_map(NewMap(occupancy, spec))
    start = Pose2(4.0, 3.0, 0.0)
    found = planner.plan(start, Goal(6.5, 4.5))
    assert found.outcome.has_path
    assert (np.diff(directions(found.poses)) != 0).sum() >= 3
    grid = planner.map.opened(found.margin_m, start)
    assert check_path(found.poses, grid, planner.body).fits
