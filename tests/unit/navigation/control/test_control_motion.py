"""Limits, turning in place, speed along the path, the learned turn gain."""

import math
from dataclasses import replace

import numpy as np
import pytest

from navette.navigation.control.command_gate import CommandGate
from navette.navigation.control.limits import (
    STOP,
    VelocityCommand,
    approach,
    brake,
    clamp,
)
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import sample_piece
from navette.navigation.control.rotate import (
    choose_direction,
    remaining_turn,
    turn_rate,
)
from navette.navigation.control.speed_profile import approach_speed, speed_profile
from navette.navigation.control.states import ControlState
from navette.navigation.control.turn_gain import TurnGain

PARAMS = ControlParams(
    cruise_speed_mps=1.0,
    max_speed_mps=1.0,
    max_turn_rate_radps=1.0,
    acceleration_mps2=0.5,
    deceleration_mps2=1.0,
    turn_acceleration_radps2=2.0,
    wheel_separation_m=1.2,
    max_wheel_speed_mps=1.2,
)


def test_clamping_keeps_the_arc() -> None:
    clamped = clamp(VelocityCommand(4.0, 2.0), PARAMS)
    assert clamped.speed == pytest.approx(2 * clamped.turn_rate)
    assert clamped.speed <= 1.0


def test_no_wheel_turns_faster_than_it_can() -> None:
    v, omega, _ = clamp(VelocityCommand(1.0, 1.0), PARAMS)
    assert v + omega * 0.6 == pytest.approx(1.2)
    assert v == pytest.approx(omega)


def test_speed_grows_and_falls_at_its_own_rates() -> None:
    assert approach(
        VelocityCommand(0.2, 0), VelocityCommand(1, 0), PARAMS, 0.1
    ).speed == pytest.approx(0.25)
    assert approach(
        VelocityCommand(0.8, 0), VelocityCommand(0, 0), PARAMS, 0.1
    ).speed == pytest.approx(0.7)


def test_reversing_goes_through_standstill() -> None:
    assert (
        approach(VelocityCommand(0.05, 0), VelocityCommand(-1, 0), PARAMS, 0.1).speed
        == 0.0
    )


def test_braking_stays_on_the_arc() -> None:
    braked = brake(VelocityCommand(0.8, 0.4), PARAMS, 0.1)
    assert braked == pytest.approx((0.7, 0.35, 0.0))
    assert brake(VelocityCommand(0.05, 0.4), PARAMS, 0.1) == STOP
    assert brake(VelocityCommand(0.0, -0.5), PARAMS, 0.1) == pytest.approx(
        (0.0, -0.3, 0.0)
    )


def test_the_turn_rate_law_brakes_in_time() -> None:
    assert turn_rate(3.0, 0.0, PARAMS) == 1.0
    assert turn_rate(-3.0, 0.0, PARAMS) == -1.0
    assert 0 < turn_rate(0.1, 0.0, PARAMS) < 0.4
    assert turn_rate(0.05, 1.0, PARAMS) == 0.0


@pytest.mark.parametrize(
    ("target", "yaw", "rate", "planned", "direction"),
    [
        (1.0, 0.0, 0.0, 0.0, 1),
        (-1.0, 0.0, 0.0, 0.0, -1),
        (3.0, -3.0, 0.0, 0.0, -1),
        (math.pi - 0.1, 0.0, -0.5, 0.0, -1),  # 180°: keep turning
        (-math.pi / 2, 0.0, 0.0, 1.5 * math.pi, 1),  # planned the longer direction
        (-0.2, 0.0, 0.0, 1.0, -1),  # beyond the target already
        (-0.6, 0.0, 0.0, 1.0, -1),  # not 360° for a short planned turn
    ],
)
def test_the_direction_of_a_turn(
    target: float, yaw: float, rate: float, planned: float, direction: int
) -> None:
    assert choose_direction(target, yaw, rate, planned) == direction


def test_the_remaining_turn() -> None:
    assert remaining_turn(1.0, 0.0, 1) == pytest.approx(1.0)
    assert remaining_turn(1.0, 0.0, -1) == pytest.approx(1.0 - math.tau)
    assert remaining_turn(1.0, 1.2, 1) == pytest.approx(-0.2)


def arc(radius: float) -> np.ndarray:
    phi = np.linspace(0, math.pi / 2, 200)
    bend = np.stack((radius * np.sin(phi), radius * (1 - np.cos(phi))), axis=1)
    return np.concatenate((np.array([[-4.0, 0.0]]), bend))


def test_the_robot_is_slow_before_the_bend() -> None:
    piece = sample_piece(arc(0.5), 1)
    speeds = np.array(speed_profile(piece, PARAMS))
    s = np.array(piece.s)
    assert speeds[0] == 1.0
    assert np.all(speeds[(s > 4.1) & (s < 4.5)] <= 0.8 * 0.5 * 1.03)
    assert np.all(np.diff(speeds**2) >= -2 * 0.8 * 1.0 * np.diff(s) - 1e-9)


def test_wheel_speed_and_lateral_acceleration_bound_the_speed_in_bends() -> None:
    piece = sample_piece(arc(1.0), 1)
    gentle = replace(PARAMS, lateral_acceleration_mps2=0.1)
    assert min(speed_profile(piece, gentle)) == pytest.approx(math.sqrt(0.1), rel=0.02)
    slow_wheels = replace(
        PARAMS,
        max_turn_rate_radps=5.0,
        max_wheel_speed_mps=0.8,
        lateral_acceleration_mps2=9.0,
    )
    assert min(speed_profile(piece, slow_wheels)) == pytest.approx(0.5, rel=0.02)


def test_the_approach_ends_in_zero() -> None:
    assert approach_speed(0.0, 0.0, PARAMS) == 0.0
    assert approach_speed(-0.1, 0.5, PARAMS) == 0.0
    assert approach_speed(2.0, 0.0, PARAMS) == pytest.approx(math.sqrt(3.2))


@pytest.mark.parametrize("turning", [0.75, 0.85, 1.0])
def test_the_turn_gain_is_learned(turning: float) -> None:
    gain = TurnGain()
    rate = 0.0
    for k in range(200):
        commanded = 0.8 * math.sin(0.05 * k)
        gain.update(commanded, rate, 0.05)
        rate += (turning * commanded - rate) * 0.05 / 0.15
    assert gain.value == pytest.approx(turning, abs=0.04)


def test_the_turn_gain_stays_bounded_for_a_stuck_or_straight_robot() -> None:
    gain = TurnGain()
    for _ in range(100):
        gain.update(0.0, 0.3, 0.05)
    assert gain.value == 1.0
    for _ in range(400):
        gain.update(0.8, 0.0, 0.05)
    assert gain.value == 0.7


def test_the_gate_covers_the_curvature_and_the_speed_to_the_left() -> None:
    car = ControlParams(drive="ackermann", min_turning_radius_m=0.8)
    gate = CommandGate(car)
    assert gate.refusal(VelocityCommand(0.8, 1.0)) is None
    assert gate.refusal(VelocityCommand(0.4, 0.6)) is ControlState.COMMAND_OVER_LIMIT
    assert gate.refusal(VelocityCommand(0.8, 0, 0.1)) is ControlState.COMMAND_OVER_LIMIT
    platform = CommandGate(ControlParams(drive="omni", max_side_speed_mps=0.5))
    assert platform.refusal(VelocityCommand(0.0, 0.3, -0.5)) is None
    fast = VelocityCommand(0.0, 0.0, 0.6)
    assert platform.refusal(fast) is ControlState.COMMAND_OVER_LIMIT
    broken = VelocityCommand(0.0, 0.0, math.nan)
    assert platform.refusal(broken) is ControlState.COMMAND_NOT_FINITE


def test_a_steered_drive_turns_as_much_as_its_speed_allows() -> None:
    car = ControlParams(drive="ackermann", min_turning_radius_m=0.8)
    assert clamp(VelocityCommand(0.4, 1.0), car) == pytest.approx((0.4, 0.5, 0.0))
    assert clamp(VelocityCommand(0.0, 1.0), car) == STOP


def test_an_omnidirectional_drive_keeps_its_direction_within_the_limits() -> None:
    platform = ControlParams(drive="omni", max_side_speed_mps=0.5, max_speed_mps=1.0)
    slowed = clamp(VelocityCommand(1.0, 0.0, 1.0), platform)
    assert slowed == pytest.approx((0.5, 0.0, 0.5))
