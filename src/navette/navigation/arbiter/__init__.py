"""Arbiter: which source of velocity commands moves the robot."""

from navette.navigation.arbiter.arbiter import (
    EMERGENCY_STOP,
    IDLE,
    Arbiter,
    CommandLock,
    CommandSource,
)
from navette.navigation.arbiter.command_limits import CommandLimits, Velocity
from navette.navigation.arbiter.params import ArbiterParams

__all__ = [
    "EMERGENCY_STOP",
    "IDLE",
    "Arbiter",
    "ArbiterParams",
    "CommandLimits",
    "CommandLock",
    "CommandSource",
    "Velocity",
]
