"""The motor controller's limits and timeout; wheel odometry."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.sim import SimParams
from navette.sim.drive import CONTROL_PERIOD_NS, BodySpeed, SpeedRamp
from navette.sim.scene import DiffDrive
from navette.sim.wheel_odometry import WheelErrors, WheelOdometry

DRIVE = DiffDrive(
    left_joints=("l",), right_joints=("r",), wheel_separation=0.5, wheel_radius=0.1
)


def _run(ramp: SpeedRamp, seconds: float, start_ns: int = 0) -> list[BodySpeed]:
    ticks = round(seconds * 1e9 / CONTROL_PERIOD_NS)
    return [ramp.advance(start_ns + i * CONTROL_PERIOD_NS) for i in range(ticks)]


def test_acceleration_and_speed_are_limited() -> None:
    params = SimParams(
        max_speed_mps=1.0, max_accel_mps2=2.0, max_yaw_rate_radps=0.5,
        max_yaw_accel_radps2=1.0, command_timeout_s=0.0,
    )  # fmt: skip
    ramp = SpeedRamp(params)
    assert ramp.command(9.0, -9.0, 0)
    speeds = _run(ramp, 2.0)
    assert speeds[0] == BodySpeed(pytest.approx(0.02), pytest.approx(-0.01))
    assert speeds[-1] == BodySpeed(1.0, -0.5)
    assert math.isinf(ramp.constant_until_ns())


def test_reverse_has_its_own_limit() -> None:
    ramp = SpeedRamp(SimParams(max_reverse_speed_mps=0.2, command_timeout_s=0.0))
    ramp.command(-1.0, 0.0, 0)
    assert _run(ramp, 2.0)[-1].linear == -0.2


def test_a_command_timeout_stops_the_robot() -> None:
    ramp = SpeedRamp(SimParams(command_timeout_s=0.5, max_accel_mps2=10.0))
    ramp.command(0.5, 0.0, 0)
    speeds = _run(ramp, 1.0)
    assert speeds[49].linear == 0.5
    assert speeds[-1].linear == 0.0


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_non_finite_commands_have_no_effect(bad: float) -> None:
    ramp = SpeedRamp(SimParams(command_timeout_s=0.0))
    ramp.command(0.3, 0.1, 0)
    assert not ramp.command(bad, 0.0, 0)
    assert not ramp.command(0.0, bad, 0)
    assert _run(ramp, 2.0)[-1] == BodySpeed(0.3, 0.1)


def test_wheel_odometry_of_a_circle_closes() -> None:
    odometry = WheelOdometry(DRIVE, WheelErrors())
    rng = np.random.default_rng(0)
    start = Pose2(1.0, 2.0, 0.3)
    odometry.reset(start, (0.0, 0.0))
    radius, parts = 2.0, 7
    left = math.tau * (radius - 0.25) / 0.1
    right = math.tau * (radius + 0.25) / 0.1
    for i in range(1, parts + 1):
        wheels = (left * i / parts, right * i / parts)
        odometry.update(wheels, i * 10**9, rng)
    assert odometry.pose == pytest.approx(start, abs=1e-9)
    assert odometry.motion().speed == pytest.approx(math.tau * radius / parts)


def test_wheel_odometry_noise_grows_with_distance() -> None:
    ends = []
    for seed in range(200):
        odometry = WheelOdometry(DRIVE, WheelErrors(0.02))
        rng = np.random.default_rng(seed)
        for i in range(1, 26):
            odometry.update((i * 1.6, i * 1.6), i, rng)  # 4 m in all
        ends.append(odometry.pose.x)
    # Both sides average: 0.02 · sqrt(4 m) / sqrt(2); turning bends little.
    assert np.std(ends) == pytest.approx(0.028, rel=0.3)
