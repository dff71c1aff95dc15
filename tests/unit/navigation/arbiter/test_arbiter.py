"""Priorities, timeouts, locks, emergency stop and limits of the arbiter."""

import math

import pytest

from navette.errors import UnknownNameError
from navette.navigation.arbiter import (
    EMERGENCY_STOP,
    IDLE,
    Arbiter,
    CommandLimits,
    CommandLock,
    CommandSource,
    Velocity,
)

MS = 1_000_000
SECOND = 1000 * MS
ZERO = Velocity()
AHEAD, BACK = Velocity(vx=0.4), Velocity(vx=-0.2)


def arbiter(**limits: float) -> Arbiter:
    return Arbiter(
        [
            CommandSource("navigation", 10),
            CommandSource("external", 50, hold_ns=SECOND, is_direct=True),
            CommandSource("operator", 100, hold_ns=SECOND, scales=True),
        ],
        [CommandLock("pause", 20)],
        CommandLimits(**limits),
    )


@pytest.fixture
def mux() -> Arbiter:
    return arbiter()


def test_a_command_passes_at_once(mux: Arbiter) -> None:
    assert mux.decide(0).commander == IDLE
    assert mux.receive("navigation", AHEAD, 1) == AHEAD
    assert mux.decide(1).commander == "navigation"


def test_the_highest_priority_masks_the_others(mux: Arbiter) -> None:
    mux.receive("navigation", AHEAD, 0)
    assert mux.receive("operator", BACK, 1) == BACK
    assert mux.receive("navigation", AHEAD, 2) is None
    assert mux.masked(2) == ["external", "navigation"]


def test_an_expired_command_is_followed_by_zero(mux: Arbiter) -> None:
    mux.receive("navigation", AHEAD, 0)
    assert mux.step(500 * MS - 1) is None
    assert mux.step(500 * MS) == ZERO
    assert mux.decide(500 * MS).commander == IDLE
    assert mux.step(501 * MS) is None


def test_the_operator_holds_the_robot_before_navigation_resumes(mux: Arbiter) -> None:
    mux.receive("operator", AHEAD, 0)
    assert mux.receive("navigation", AHEAD, 500 * MS) == ZERO
    assert mux.decide(1499 * MS).commander == "operator"
    assert mux.receive("navigation", AHEAD, 1500 * MS) == AHEAD


def test_a_held_robot_receives_zeros_repeatedly(mux: Arbiter) -> None:
    mux.receive("operator", AHEAD, 0)
    times = [ms for ms in range(500, 1000, 20) if mux.step(ms * MS) == ZERO]
    assert times == [500, 600, 700, 800, 900]


def test_a_lock_masks_the_priorities_below_its_own(mux: Arbiter) -> None:
    mux.receive("navigation", AHEAD, 0)
    assert mux.set_lock("pause", engaged=True, now_ns=1) == ZERO
    assert mux.decide(1).commander == "pause"
    assert mux.receive("navigation", AHEAD, 2) is None
    assert mux.receive("operator", BACK, 3) == BACK
    mux.set_lock("pause", engaged=False, now_ns=4)
    assert mux.decide(SECOND * 9).commander == IDLE


def test_a_lock_that_expires_is_engaged() -> None:
    mux = Arbiter([], [CommandLock("beat", 40, timeout_ns=SECOND)])
    assert mux.decide(0).commander == "beat"  # no message yet
    mux.set_lock("beat", engaged=False, now_ns=0)
    assert mux.decide(SECOND - 1).commander == IDLE
    assert mux.decide(SECOND).commander == "beat"
    mux.set_lock("beat", engaged=False, now_ns=SECOND)
    assert mux.decide(SECOND).commander == IDLE


def test_the_emergency_stop_masks_all_until_it_is_released(mux: Arbiter) -> None:
    mux.receive("operator", AHEAD, 0)
    assert mux.stop(1) == ZERO
    assert mux.receive("operator", AHEAD, 2) is None
    assert mux.decide(2).commander == EMERGENCY_STOP
    mux.reset()  # the clock was set back
    assert mux.decide(0).commander == EMERGENCY_STOP
    mux.receive("operator", AHEAD, 3)
    mux.release(4)
    assert mux.decide(4).commander == IDLE  # earlier commands do not count
    assert mux.receive("operator", AHEAD, 5) == AHEAD


def test_a_direct_source_masks_navigation_and_is_not_repeated(mux: Arbiter) -> None:
    mux.receive("navigation", AHEAD, 0)
    assert mux.receive("external", BACK, 1) is None
    assert mux.receive("navigation", AHEAD, 2) is None
    assert mux.step(500 * MS + 1) == ZERO


def test_a_direct_source_is_overruled_at_once(mux: Arbiter) -> None:
    mux.receive("operator", AHEAD, 0)
    assert mux.receive("external", BACK, 1) == AHEAD
    mux.stop(2)
    assert mux.receive("external", BACK, 3) == ZERO
    mux.release(4)
    assert mux.receive("external", BACK, 5) is None


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("source", ["navigation", "operator"])
def test_a_command_that_is_not_finite_is_refused(
    mux: Arbiter, source: str, bad: float
) -> None:
    assert mux.receive(source, Velocity(wz=bad), 0) == ZERO
    assert mux.refusal(source) == "command_not_finite"
    assert mux.receive(source, AHEAD, 1) == AHEAD
    assert mux.refusal(source) == ""


def test_a_command_over_the_limits_is_refused_or_scaled() -> None:
    mux = arbiter(max_speed_mps=0.5, max_turn_rate_radps=1.0)
    fast = Velocity(vx=1.0, wz=1.0)
    assert mux.receive("navigation", fast, 0) == ZERO
    assert mux.refusal("navigation") == "command_over_limit"
    assert mux.receive("operator", fast, 1) == Velocity(vx=0.5, wz=0.5)
    assert mux.receive("operator", Velocity(vx=0.5), 2) == Velocity(vx=0.5)


def test_a_source_without_timeout_commands_for_ever() -> None:
    mux = Arbiter([CommandSource("stick", 1, timeout_ns=0)])
    assert mux.receive("stick", AHEAD, 0) == AHEAD
    assert mux.decide(1 << 60).commander == "stick"


def test_an_unknown_source_is_named() -> None:
    with pytest.raises(UnknownNameError, match=r"joy.*navigation"):
        arbiter().receive("joy", AHEAD, 0)
