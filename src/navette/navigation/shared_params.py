"""Parameters that several stages have: frames, body, limits of motion, inputs."""

from dataclasses import dataclass
from typing import Any

from navette.errors import InvalidValueError, ParameterError
from navette.geometry import ACKERMANN, DIFFERENTIAL, DRIVES, Footprint
from navette.params import Params, param

# Braking distances and times divide by these.
_LEAST = 0.01


def speed_limit(default: float, meaning: str) -> Any:
    """Make a field for a speed or a turn rate."""
    return param(default, meaning, above=0.0)


def acceleration_limit(default: float, meaning: str) -> Any:
    """Make a field for an acceleration, a deceleration or a change of the turn rate."""
    return param(default, meaning, at_least=_LEAST)


@dataclass(frozen=True, kw_only=True)
class FrameParams(Params):
    """Frames of the map and of the robot."""

    map_frame: str = param("map", "frame of the map, the path, the goals and the pose")
    base_frame: str = param("base_link", "frame of the robot's base: the axle's middle")


@dataclass(frozen=True, kw_only=True)
class BodyParams(FrameParams):
    """The robot's drive and outline, and what it must not touch."""

    drive: str = param(
        DIFFERENTIAL,
        "motions of the base: turns in place, bends of a least radius (ackermann), or "
        "sideways, too (omni)",
        choices=DRIVES,
    )
    footprint_m: tuple[float, ...] = param(
        (0.25, 0.2, -0.25, 0.2, -0.25, -0.2, 0.25, -0.2),
        "outline of the body in the base frame: x1, y1, x2, y2, …",
    )
    lethal_cost: int = param(
        100, "cost from which a cell is an obstacle", at_least=1, at_most=100
    )
    blind_reverse_m: float = param(
        0.1,
        "how far the body may move beyond its outline, where the robot was put down, "
        "into space behind it that no beam has measured, backing up and turning",
        at_least=0.0,
        at_most=10.0,
    )

    def check(self) -> None:
        super().check()
        check_footprint(self.footprint_m)


@dataclass(frozen=True, kw_only=True)
class BendParams(BodyParams):
    """The body, and the bends that its drive can follow."""

    min_turning_radius_m: float = param(
        0.0, "ackermann: least radius of a bend", at_least=0.0
    )

    def check(self) -> None:
        super().check()
        if (self.drive == ACKERMANN) != (self.min_turning_radius_m > 0):
            raise ParameterError(
                f"min_turning_radius_m {self.min_turning_radius_m:g}: must be > 0 with "
                f"drive {ACKERMANN!r} and 0 with others; drive is {self.drive!r}"
            )


@dataclass(frozen=True, kw_only=True)
class MotionParams(BodyParams):
    """What the stages that command motion have in common."""

    rate_hz: float = param(20.0, "commands per second", at_least=10.0, at_most=1000.0)
    reaction_s: float = param(
        0.2, "delay from command to motion", at_least=0.0, at_most=5.0
    )
    stall_time_s: float = param(
        0.3,
        "no motion for this long, though commanded, stops the robot; 0: never",
        at_least=0.0,
        at_most=10.0,
    )
    odometry_timeout_s: float = param(
        0.14, "least age of odometry that stops the robot", above=0.0
    )
    costmap_timeout_s: float = param(
        0.19, "least age of the costmap that stops the robot", above=0.0
    )
    stale_periods: float = param(
        3.2,
        "odometry and costmap are stale after this many of their measured periods (up "
        "to 0.42 s), if that is longer than their timeouts",
        at_least=1.0,
        at_most=100.0,
    )


def check_footprint(footprint_m: tuple[float, ...]) -> None:
    """Raise ParameterError unless the values are an outline."""
    try:
        Footprint.from_flat(footprint_m)
    except InvalidValueError as error:
        raise ParameterError(f"parameter 'footprint_m': {error}") from error
