"""Moving obstacles in control: shares of a command, and the predictive controller."""

import math

import numpy as np
import pytest

from navette.geometry import Footprint, Pose2
from navette.navigation.control.limits import VelocityCommand
from navette.navigation.control.moving_obstacles import counts_as_static, safe_share
from navette.navigation.control.params import ControlParams
from navette.navigation.control.predictive_follower import PredictiveFollower
from navette.navigation.control.records import FollowerInputs
from navette.navigation.grids import (
    NO_DISCS,
    GridSpec,
    MovingDiscs,
    disc_outlines,
    inside_discs,
    without_discs,
)

HERE = Pose2(0.0, 0.0, 0.0)
BODY_M, MARGIN_M = 0.3, 0.2
BODY = Footprint.from_flat((0.25, 0.2, -0.25, 0.2, -0.25, -0.2, 0.25, -0.2))


def _discs(*rows: tuple[float, ...]) -> np.ndarray:
    return np.array(rows, np.float64).reshape(-1, 5)


@pytest.mark.parametrize(
    ("disc", "expected"),
    [
        ((5.0, 3.0, 0.0, 0.0, 0.3), 1.0),  # far from the way
        ((2.0, -2.0, 0.0, 1.0, 0.3), 0.5),  # crosses where the robot would be
        ((2.0, 1.5, 0.0, 1.0, 0.3), 1.0),  # has passed
        ((1.0, 0.0, 1.5, 0.0, 0.3), 1.0),  # drives ahead, faster
        ((0.8, 0.0, 0.0, 0.0, 0.3), 0.0),  # is in the way
    ],
)
def test_share_of_a_command_yields_to_what_crosses(
    disc: tuple[float, ...], expected: float
) -> None:
    def share(motion: VelocityCommand, pose: Pose2) -> float:
        return safe_share(pose, motion, _discs(disc), BODY_M, MARGIN_M)

    ahead = share(VelocityCommand(1.0, 0.0), HERE)
    assert ahead <= expected if expected < 1.0 else ahead == 1.0
    turned_right = Pose2(HERE.x, HERE.y, HERE.yaw - math.pi / 2)
    assert share(VelocityCommand(0.0, 0.0, 1.0), turned_right) == ahead


def test_nothing_moving_changes_nothing() -> None:
    motion = VelocityCommand(1.0, 0.5)
    assert safe_share(HERE, motion, NO_DISCS, BODY_M, MARGIN_M) == 1.0


def _drive(discs: np.ndarray, seconds: float = 8.0) -> tuple[float, float]:
    """Return the least distance of the bodies, and where the robot ends (x)."""
    params = ControlParams(
        method="mppi", cruise_speed_mps=1.0, max_speed_mps=1.0, acceleration_mps2=1.5,
        deceleration_mps2=1.5, max_turn_rate_radps=1.5, turn_acceleration_radps2=4.0,
        evasion_factor=2.0, max_deviation_m=2.0,
    )  # fmt: skip
    follower = PredictiveFollower(params)
    along = np.arange(0.0, 8.0, 0.1)
    follower.set_path(np.column_stack([along, 0 * along, 0 * along]))
    follower.set_obstacles(np.empty((0, 2)), 0.05)
    pose, speed, turn_rate, least = HERE, 0.0, 0.0, math.inf
    now, dt = MovingDiscs(discs, 0), 0.05
    for step in range(round(seconds / dt)):
        moved = now.at(round(step * dt * 1e9), 100.0)
        follower.set_moving(moved)
        command = follower.step(FollowerInputs(pose, speed, turn_rate), dt).command
        speed, turn_rate = command.speed, command.turn_rate
        pose = Pose2(
            pose.x + speed * dt * math.cos(pose.yaw),
            pose.y + speed * dt * math.sin(pose.yaw),
            pose.yaw + turn_rate * dt,
        )
        if len(moved):
            away = np.hypot(moved[:, 0] - pose.x, moved[:, 1] - pose.y) - moved[:, 4]
            least = min(least, float(away.min()))
    return least - BODY.circumscribed_radius, pose.x


@pytest.mark.parametrize(
    "discs",
    [
        _discs((4.0, -4.0, 0.0, 1.0, 0.5)),  # crosses
        _discs((8.0, 0.0, -1.2, 0.0, 0.5)),  # comes along the path
        _discs((4.0, -4.0, 0.0, 1.0, 0.5), (6.0, 5.0, -0.3, -1.0, 0.5)),
    ],
)
def test_predictive_controller_avoids_where_obstacles_will_be(
    discs: np.ndarray,
) -> None:
    least, x = _drive(discs)
    assert least > 0.05
    assert x > 4.0


def test_discs_expire_and_cover_points_and_cells() -> None:
    discs = _discs((1.0, 1.0, 1.0, 0.0, 0.3))
    moving = MovingDiscs(discs, 1_000_000_000)
    assert moving.at(1_500_000_000, 1.0)[0, :2].tolist() == [1.5, 1.0]
    assert not len(moving.at(3_000_000_000, 1.0))
    points = np.array([[1.0, 1.25], [1.0, 1.6]])
    assert inside_discs(points, discs, 0.1).tolist() == [True, False]
    assert np.allclose(np.hypot(*(disc_outlines(discs) - (1.0, 1.0)).T), 0.3)
    spec = GridSpec(0.1, 30, 30, Pose2(0.0, 0.0, 0.3))
    cells = np.full(spec.shape, 100, np.int8)
    kept = without_discs(cells, spec, discs, 0.1)
    assert kept[spec.cell_of(1.0, 1.0)] == -1
    assert kept[spec.cell_of(1.0, 1.6)] == 100
    assert (cells == 100).all()


@pytest.mark.parametrize(
    ("speed_mps", "counting"), [(0.0, [0, 3]), (1.5, [0, 1, 3]), (-1.5, [0, 1, 3])]
)
def test_what_the_robot_reaches_before_it_stops_counts_where_it_is(
    speed_mps: float, counting: list[int]
) -> None:
    """A wall of which more and more is seen is taken for an obstacle that recedes."""
    params = ControlParams(
        footprint_m=(0.3, 0.2, -0.3, 0.2, -0.3, -0.2, 0.3, -0.2),
        deceleration_mps2=1.5,
    )
    points = np.array([(0.34, 0.1), (0.9, 0.1), (2.0, 0.1), (2.0, 3.0)])
    discs = np.array([(1.2, 0.1, 0.5, 0.0, 0.8)])
    kept = counts_as_static(points, discs, Pose2(0, 0, 0), speed_mps, params)
    assert np.flatnonzero(kept).tolist() == counting
    discs[0, 2] = -0.5
    kept = counts_as_static(points, discs, Pose2(0, 0, 0), speed_mps, params)
    assert np.flatnonzero(kept).tolist() == [0, 3], (
        "it comes closer: prediction avoids it"
    )
    discs[0, 2] = -0.1
    assert counts_as_static(points, discs, Pose2(0, 0, 0), speed_mps, params).all()
