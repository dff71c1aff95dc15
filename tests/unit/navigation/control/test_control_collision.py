"""Predicted motion against obstacles, and the last gate."""

import math

import numpy as np
import pytest

from navette.geometry import Footprint, Pose2
from navette.navigation.control import (
    CommandGate,
    ControlParams,
    ControlState,
    InputAges,
    VelocityCommand,
)
from navette.navigation.grids import (
    CollisionCheck,
    GridSpec,
    MovingBody,
    obstacle_points,
    signed_distance,
)

BODY = Footprint(((1.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (1.5, -0.5)))
ORIGIN = Pose2(0.0, 0.0, 0.0)


def checker(*points: tuple[float, float]) -> CollisionCheck:
    check = CollisionCheck(
        MovingBody(
            footprint=BODY,
            margin_m=0.1,
            horizon_m=0.5,
            reaction_s=0.2,
            deceleration_mps2=1.0,
            turn_acceleration_radps2=2.0,
        )
    )
    check.set_obstacles(np.array(points, np.float64).reshape(-1, 2), 0.05)
    return check


def test_the_distance_to_the_outline_is_signed() -> None:
    outline = np.array(BODY.vertices)
    assert signed_distance(outline, 2.0, 0.0) == pytest.approx(0.5)
    assert signed_distance(outline, 0.0, 0.1) == pytest.approx(-0.4)
    assert signed_distance(outline, 1.8, 0.9) == pytest.approx(0.5)


def test_clearance_is_from_the_body_to_the_edge_of_the_cell() -> None:
    assert checker((1.85, 0.0)).clearance(ORIGIN) == pytest.approx(0.3)
    assert checker((9.0, 0.0)).clearance(ORIGIN) == pytest.approx(0.5)
    assert checker().clearance(ORIGIN) == pytest.approx(0.5)


def test_a_free_motion_is_unchanged() -> None:
    assert checker((0.0, 5.0)).check(ORIGIN, VelocityCommand(1.0, 0.2)).scale == 1.0
    assert checker().check(ORIGIN, VelocityCommand(1.0, 0.2)).scale == 1.0


@pytest.mark.parametrize("gap", [0.4, 0.6, 1.0])
def test_the_scaled_speed_can_still_stop_at_the_margin(gap: float) -> None:
    scale, _ = checker((1.55 + gap, 0.0)).check(ORIGIN, VelocityCommand(2.0, 0.0))
    v = 2.0 * scale
    stop = 0.2 * v + v * v / 2
    assert gap - 0.1 - 0.12 <= stop <= gap - 0.1 + 1e-6


def test_a_turn_is_checked_over_its_whole_sweep() -> None:
    check = checker((1.2, 1.0))
    assert not check.turn_is_free(ORIGIN, math.pi / 2)
    assert check.turn_is_free(ORIGIN, -math.pi / 2)
    assert check.turn_is_free(ORIGIN, 0.05)


def test_moving_away_is_never_forbidden() -> None:
    close = checker((1.57, 0.0))
    assert close.check(ORIGIN, VelocityCommand(0.5, 0.0)).scale == 0.0
    assert close.check(ORIGIN, VelocityCommand(-0.5, 0.0)).scale == 1.0
    inside = checker((1.3, 0.0))
    assert inside.check(ORIGIN, VelocityCommand(-0.5, 0.0)).scale == 1.0
    assert inside.check(ORIGIN, VelocityCommand(0.5, 0.0)).scale == 0.0


def test_passing_along_a_wall_closer_than_the_margin_is_allowed() -> None:
    wall = [(0.1 * i, 0.62) for i in range(-20, 60)]
    check = checker(*wall)
    assert check.clearance(ORIGIN) == pytest.approx(0.07)
    assert check.check(ORIGIN, VelocityCommand(0.5, 0.0)).scale == 1.0
    assert check.check(ORIGIN, VelocityCommand(0.5, 0.5)).scale < 0.5


def blind_behind(first_x: float) -> CollisionCheck:
    """Unseen cells of 0.1 m behind the body, whose end is at x = -0.5."""
    check = checker()
    xs = first_x - 0.05 - 0.1 * np.arange(10)
    cells = [(x, y) for x in xs for y in np.arange(-0.75, 0.8, 0.1)]
    check.set_obstacles(np.empty((0, 2)), 0.05, np.array(cells))
    return check


def test_the_body_does_not_back_into_unseen_space() -> None:
    check = blind_behind(-0.7)
    # The nearest centres lie 0.25 m behind the body.
    assert 1.0 <= check.free_time(ORIGIN, -0.2, 0.0, 5.0) <= 1.25
    assert check.free_time(ORIGIN, 0.2, 0.0, 5.0) == 5.0
    assert check.turn_is_free(ORIGIN, math.pi)
    scale = check.check(ORIGIN, VelocityCommand(-1.0, 0.0)).scale
    assert 0.2 < 0.2 * scale + scale**2 / 2 <= 0.25 + 1e-6
    assert check.reverse_share(ORIGIN, 1.0) == pytest.approx(scale)


def test_less_than_a_step_of_seen_space_is_used_to_a_centimetre() -> None:
    """As behind a robot that was put down facing a wall."""
    check = blind_behind(-0.48)  # the nearest centres lie 0.03 m behind the body
    assert 0.1 <= check.free_time(ORIGIN, -0.2, 0.0, 5.0) <= 0.15 + 1e-9
    scale = check.check(ORIGIN, VelocityCommand(-0.4, 0.0)).scale
    assert 0.02 < 0.4 * scale * (0.2 + 0.4 * scale / 2) <= 0.03 + 1e-6


def test_a_body_over_the_border_of_unseen_space_does_not_enter_further() -> None:
    check = blind_behind(-0.43)  # 2 cm over the nearest centres
    assert check.check(ORIGIN, VelocityCommand(-0.3, 0.0)).scale == 0.0
    assert check.check(ORIGIN, VelocityCommand(0.3, 0.0)).scale == 1.0


def test_reversing_along_unseen_space_is_allowed() -> None:
    check = checker()
    beside = [(x, 0.53) for x in np.arange(-3.0, 2.0, 0.1)]
    check.set_obstacles(np.empty((0, 2)), 0.05, np.array(beside))
    assert check.check(ORIGIN, VelocityCommand(-0.3, 0.0)).scale == 1.0


def test_the_reach_covers_braking_from_the_speed() -> None:
    radius = BODY.circumscribed_radius
    assert checker().reach(1.0) > radius + 0.2 + 0.5 + 0.5


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.5])
def test_obstacle_points_are_lethal_cells_placed_in_the_map(yaw: float) -> None:
    spec = GridSpec(0.1, 100, 100, Pose2(-5.0, -5.0, 0.0))
    cost = np.full(spec.shape, -1, np.int8)
    cost[60, 70] = 100
    cost[60, 71] = 99
    cost[0, 0] = 100
    map_T_grid = Pose2(20.0, 10.0, yaw)
    points = obstacle_points(
        cost, spec, map_T_grid, lethal_cost=100, around=map_T_grid, reach_m=3.0
    )
    expected = map_T_grid @ Pose2(2.05, 1.05, 0.0)
    assert points == pytest.approx(np.array([[expected.x, expected.y]]))


def test_off_the_grid_there_are_no_obstacle_points() -> None:
    spec = GridSpec(0.1, 10, 10)
    cost = np.full(spec.shape, 100, np.int8)
    far = Pose2(-50.0, 80.0, 0.0)
    points = obstacle_points(
        cost, spec, ORIGIN, lethal_cost=100, around=far, reach_m=3.0
    )
    assert points.shape == (0, 2)


GATE = CommandGate(
    ControlParams(
        max_speed_mps=1.0,
        max_turn_rate_radps=2.0,
        odometry_timeout_s=0.3,
        costmap_timeout_s=0.3,
        planner_timeout_s=2.0,
    )
)


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (VelocityCommand(1.0, 2.0), None),
        (VelocityCommand(-1.0, -2.0), None),
        (VelocityCommand(1.01, 0.0), ControlState.COMMAND_OVER_LIMIT),
        (VelocityCommand(0.0, -2.01), ControlState.COMMAND_OVER_LIMIT),
        (VelocityCommand(math.nan, 0.0), ControlState.COMMAND_NOT_FINITE),
        (VelocityCommand(0.0, math.inf), ControlState.COMMAND_NOT_FINITE),
    ],
)
def test_the_gate_refuses_invalid_commands(
    command: VelocityCommand, reason: ControlState | None
) -> None:
    assert GATE.refusal(command) is reason


@pytest.mark.parametrize(
    ("ages", "reason"),
    [
        (InputAges(odometry_s=0.31), ControlState.STALE_ODOMETRY),
        (InputAges(costmap_s=0.31), ControlState.STALE_COSTMAP),
        (InputAges(planner_s=2.1), ControlState.STALE_PATH),
        (InputAges(odometry_s=math.inf), ControlState.STALE_ODOMETRY),
        (InputAges(odometry_s=math.nan), ControlState.STALE_ODOMETRY),
        (InputAges(0.3, 0.3, 2.0), None),
    ],
)
def test_the_gate_stops_on_stale_inputs(
    ages: InputAges, reason: ControlState | None
) -> None:
    assert GATE.stale(ages) is reason


def test_below_the_floor_no_motion_comes_closer_at_all() -> None:
    """A millimetre at every step would add up to a contact."""
    check = checker((1.5 + 0.05 + 0.015, 0.0))
    assert check.clearance(ORIGIN) == pytest.approx(0.015)
    assert check.check(ORIGIN, (0.004, 0.0)).scale == 0.0
    assert check.check(ORIGIN, (-0.2, 0.0)).scale == 1.0


def test_within_the_margin_no_edge_of_the_body_jumps_over_a_point() -> None:
    """A narrow wheel passes a post; 5 cm before and after, both are clear of it."""
    wheel = ((0.005, 0.3), (0.005, 0.312), (-0.005, 0.312), (-0.005, 0.3))
    body = MovingBody(
        footprint=Footprint(
            ((0.5, -0.3), (0.5, 0.3), *wheel, (-0.5, 0.3), (-0.5, -0.3))
        ),
        margin_m=0.025,
        horizon_m=0.5,
        reaction_s=0.495,
        deceleration_mps2=10.0,
        turn_acceleration_radps2=2.0,
    )
    check = CollisionCheck(body)
    check.set_obstacles(np.array([[0.025, 0.3215]]), 0.0)
    assert check.check(Pose2(0.05, 0.0, 0.0), (0.0, 0.0)).clearance > 0.02
    scale, clearance = check.check(ORIGIN, (0.1, 0.0))
    assert clearance == pytest.approx(0.0215)
    assert scale < 0.5
