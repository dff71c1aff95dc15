"""Limits of commanded motion, shared by controller and behaviors: unit and range."""

from typing import Any

from navette.params import param

# Braking distances and times divide by these.
_LEAST = 0.01


def speed_limit(default: float, meaning: str) -> Any:
    """Make a field for a speed."""
    return param(default, meaning, unit="m/s", above=0.0)


def turn_rate_limit(default: float, meaning: str) -> Any:
    """Make a field for a turn rate."""
    return param(default, meaning, unit="rad/s", above=0.0)


def acceleration_limit(default: float, meaning: str) -> Any:
    """Make a field for an acceleration or a deceleration."""
    return param(default, meaning, unit="m/s²", at_least=_LEAST)


def turn_acceleration_limit(default: float, meaning: str) -> Any:
    """Make a field for a change of the turn rate."""
    return param(default, meaning, unit="rad/s²", at_least=_LEAST)
