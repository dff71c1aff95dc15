"""For any input, commands are finite and within the limits."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.navigation.control import (
    STOP,
    ControlParams,
    FollowerInputs,
    InputAges,
    PathFollower,
)
from navette.navigation.control.followers import make_follower
from navette.navigation.control.methods import CONTROLLERS

any_float = st.floats(allow_nan=True, allow_infinity=True)
metres = st.floats(-20, 20)
poses = st.lists(st.tuples(metres, metres, st.floats(-7, 7)), max_size=12)
inputs = st.builds(
    FollowerInputs,
    st.builds(Pose2, any_float | metres, any_float | metres, any_float | metres),
    any_float | st.floats(-2, 2),
    any_float | st.floats(-2, 2),
    st.builds(InputAges, st.sampled_from([0.0, 0.1, 9.0, math.inf, math.nan])),
)
methods = st.sampled_from(list(CONTROLLERS))
points = st.lists(st.tuples(metres, metres), max_size=30)


def as_array(rows: list[tuple[float, ...]], columns: int) -> np.ndarray:
    return np.array(rows, np.float64).reshape(-1, columns)


@given(methods, st.lists(poses, max_size=3), st.lists(inputs, max_size=15), points)
def test_commands_are_finite_and_within_limits(
    method: str,
    paths: list[list[tuple[float, float, float]]],
    steps: list[FollowerInputs],
    obstacles: list[tuple[float, float]],
) -> None:
    params = ControlParams(
        method=method,
        wheel_separation_m=0.5,
        max_wheel_speed_mps=0.6,
        max_deviation_m=100.0,
    )
    follower = make_follower(params)
    follower.set_obstacles(as_array(obstacles, 2), 0.05)
    for path in [*paths, []]:
        for step in steps:
            command, _ = output = follower.step(step, 0.05)[:2]
            assert all(map(math.isfinite, command)), output
            assert abs(command.speed) <= params.max_speed_mps
            assert abs(command.turn_rate) <= params.max_turn_rate_radps
            assert abs(command.speed) + 0.25 * abs(command.turn_rate) <= 0.6 + 1e-9
            if not step.ages.odometry_s <= params.odometry_timeout_s:
                assert command == STOP
        follower.set_path(as_array(path, 3))


@given(st.lists(st.tuples(any_float, any_float, any_float), min_size=1, max_size=5))
def test_a_path_is_accepted_or_refused_with_an_error(
    path: list[tuple[float, float, float]],
) -> None:
    follower = PathFollower(ControlParams())
    if np.all(np.isfinite(path)):
        return
    with pytest.raises(InvalidValueError):
        follower.set_path(as_array(path, 3))
    assert not follower.has_path
