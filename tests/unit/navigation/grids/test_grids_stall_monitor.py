"""Commanded against measured motion."""

import pytest

from navette.geometry import Pose2
from navette.navigation.grids.stall_monitor import StallMonitor

HERE = Pose2(0.0, 0.0, 0.0)
DT = 0.05
AHEAD = (0.4, 0.0)


def time_to_stall(
    command: tuple[float, float], measured: tuple[float, float], limit_s: float = 3.0
) -> float | None:
    """Drive freely for a second, then measure this; seconds until it stalls."""
    monitor = StallMonitor(0.3)
    for _ in range(20):
        assert not monitor.update(command, HERE, command, DT)
    for step in range(round(limit_s / DT)):
        if monitor.update(command, HERE, measured, DT):
            return (step + 1) * DT
    return None


@pytest.mark.parametrize("command", [(0.1, 0.0), (-0.4, 0.2), (2.0, 0.0), (0.0, -0.5)])
def test_a_robot_that_does_not_move_stalls_within_half_a_second(
    command: tuple[float, float],
) -> None:
    seconds = time_to_stall(command, (0.0, 0.0))
    assert seconds is not None
    assert 0.2 <= seconds <= 0.4


@pytest.mark.parametrize(
    ("command", "measured"),
    [
        (AHEAD, (0.2, 0.0)),
        ((0.0, 1.0), (0.0, 0.5)),
        ((0.0, 0.0), (0.0, 0.0)),
        ((0.01, 0.02), (0.0, 0.0)),
    ],
)
def test_slow_motion_and_rest_do_not_count(
    command: tuple[float, float], measured: tuple[float, float]
) -> None:
    assert time_to_stall(command, measured) is None


def test_motion_against_the_command_counts() -> None:
    assert time_to_stall(AHEAD, (-0.4, 0.0)) is not None


def test_starting_does_not_count() -> None:
    monitor = StallMonitor(0.3)
    speed = 0.0
    for step in range(40):
        command = (min(0.5, 0.05 * (step + 1)), 0.0)
        assert not monitor.update(command, HERE, (speed, 0.0), DT)
        speed += 0.25 * (command[0] - speed)


def test_a_sudden_stop_and_a_turn_back_do_not_count() -> None:
    monitor = StallMonitor(0.3)
    commands = [(1.0, 1.0)] * 10 + [(0.0, 0.0)] * 10 + [(0.0, -1.0)] * 10
    for command in commands:
        assert not monitor.update(command, HERE, command, DT)


def stalled() -> StallMonitor:
    monitor = StallMonitor(0.3)
    while not monitor.update(AHEAD, HERE, (0.0, 0.0), DT):
        pass
    return monitor


def test_the_same_motion_is_forbidden_until_the_robot_is_elsewhere() -> None:
    monitor = stalled()
    assert monitor.forbids((0.1, 0.3), HERE)
    assert not monitor.forbids((-0.1, 0.0), HERE)
    assert not monitor.forbids((0.0, 1.0), HERE)
    assert not monitor.forbids((0.01, -0.1), HERE), "a turn that drifts"
    assert monitor.forbids(AHEAD, Pose2(-0.1, 0.0, 0.0))
    assert not monitor.forbids(AHEAD, Pose2(-0.5, 0.0, 0.0))
    assert not monitor.forbids(AHEAD, HERE)


def test_after_a_turn_or_ten_seconds_the_robot_may_try_again() -> None:
    assert not stalled().forbids(AHEAD, Pose2(0.0, 0.0, 1.5))
    monitor = stalled()
    for _ in range(201):
        monitor.update((0.0, 0.0), HERE, (0.0, 0.0), DT)
    assert not monitor.forbids(AHEAD, HERE)


def test_a_stalled_turn_forbids_only_that_turn() -> None:
    monitor = StallMonitor(0.3)
    while not monitor.update((0.0, 1.0), HERE, (0.0, 0.0), DT):
        pass
    assert monitor.forbids((0.0, 0.5), HERE)
    assert not monitor.forbids((0.0, -0.5), HERE)
    assert not monitor.forbids((0.2, 0.5), HERE)


def test_zero_switches_it_off() -> None:
    monitor = StallMonitor(0.0)
    assert not any(monitor.update(AHEAD, HERE, (0.0, 0.0), DT) for _ in range(100))


@pytest.mark.parametrize(("delay_s", "stalls"), [(0.0, True), (0.5, False)])
def test_motion_that_is_measured_late_is_not_a_stall(
    delay_s: float, stalls: bool
) -> None:
    """A robot behind a slow network starts from rest."""
    monitor = StallMonitor(0.3)
    found = [
        monitor.update(
            (0.5, 0.0), Pose2(0, 0, 0), (0.5 if at >= 10 else 0.0, 0.0), 0.05, delay_s
        )
        for at in range(30)
    ]
    assert any(found) == stalls


def test_a_stall_behind_a_slow_network_is_found_after_the_delay() -> None:
    monitor = StallMonitor(0.3)
    found = [
        monitor.update((0.5, 0.0), Pose2(0, 0, 0), (0.0, 0.0), 0.05, 0.5)
        for _ in range(30)
    ]
    assert 10 <= found.index(True) <= 16


def test_a_turn_that_is_blocked_does_not_forbid_to_back_up() -> None:
    """The wheels slip sideways: the robot backs up as commanded, but does not turn."""
    monitor = StallMonitor(0.3)
    stalls = [monitor.update((-0.05, 1.0), HERE, (-0.05, 0.0), DT) for _ in range(20)]
    assert any(stalls)
    assert monitor.forbids((0.0, 1.0), HERE)
    assert monitor.forbids((-0.01, 0.5), HERE), "sampled commands are never exact"
    assert not monitor.forbids((0.0, -1.0), HERE)
    assert not monitor.forbids((-0.3, 0.0), HERE)
    assert not monitor.forbids((-0.3, 0.5), HERE)
