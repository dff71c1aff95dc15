"""Nav2's behavior actions: goal to behavior, behavior to feedback."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from navette.geometry import ACKERMANN
from navette.msgs import topics
from navette.msgs.nav2_msgs.action import (
    AssistedTeleop,
    BackUp,
    DriveOnHeading,
    Spin,
    Wait,
)
from navette.navigation.behaviors import runner
from navette.navigation.behaviors.motions import DriveStraight, TurnBy
from navette.navigation.behaviors.params import BehaviorParams
from navette.navigation.behaviors.runner import Behavior, BehaviorEnd, MotionBehavior
from navette.navigation.grids import CollisionCheck
from navette.runtime.time import Duration

MakeBehavior = Callable[[Any, BehaviorParams, CollisionCheck], Behavior | BehaviorEnd]
"""Returns the behavior of a goal, or why the goal is refused."""

MakeFeedback = Callable[[float], dict[str, Any]]
"""Returns the feedback's fields from the behavior's progress."""


@dataclass(frozen=True, kw_only=True)
class BehaviorAction:
    """An action of the behavior server.

    Attributes:
        action: its type.
        name: its name.
        output: topic of the commands; empty: it commands nothing.
    """

    action: Any
    name: str
    behavior: MakeBehavior
    feedback: MakeFeedback
    output: str = topics.CMD_VEL_NAV.name


def _spin(
    goal: Any, params: BehaviorParams, collision: CollisionCheck
) -> Behavior | BehaviorEnd:
    if not math.isfinite(goal.target_yaw):
        return BehaviorEnd("UNKNOWN", f"target_yaw {goal.target_yaw}: must be finite")
    if params.drive == ACKERMANN:
        return BehaviorEnd("UNKNOWN", "an Ackermann drive cannot turn in place")
    motion = TurnBy(goal.target_yaw, params)
    return MotionBehavior(motion, params, collision, _allowance_s(goal))


def _back_up(
    goal: Any, params: BehaviorParams, collision: CollisionCheck
) -> Behavior | BehaviorEnd:
    """Drive back; the signs of distance and speed do not matter, as in Nav2."""
    refusal = _refusal(goal)
    if refusal is not None:
        return refusal
    motion = DriveStraight(-abs(goal.target.x), goal.speed, params)
    return MotionBehavior(motion, params, collision, _allowance_s(goal))


def _drive_on_heading(
    goal: Any, params: BehaviorParams, collision: CollisionCheck
) -> Behavior | BehaviorEnd:
    refusal = _refusal(goal)
    if refusal is not None:
        return refusal
    if (goal.target.x > 0) != (goal.speed > 0):
        text = f"target.x {goal.target.x:g} and speed {goal.speed:g}: signs differ"
        return BehaviorEnd("INVALID_INPUT", text)
    motion = DriveStraight(goal.target.x, goal.speed, params)
    return MotionBehavior(motion, params, collision, _allowance_s(goal))


def _refusal(goal: Any) -> BehaviorEnd | None:
    """Return why a goal that drives straight is refused."""
    target, speed = goal.target, goal.speed
    if not all(map(math.isfinite, (target.x, target.y, target.z, speed))):
        return BehaviorEnd("INVALID_INPUT", "target and speed must be finite")
    if target.y or target.z:
        text = f"target.y {target.y:g}, target.z {target.z:g}: must be 0"
        return BehaviorEnd("INVALID_INPUT", text)
    if target.x and not speed:
        return BehaviorEnd("INVALID_INPUT", "speed 0: the target is never reached")
    return None


def _wait(
    goal: Any, params: BehaviorParams, collision: CollisionCheck
) -> Behavior | BehaviorEnd:
    return runner.Waiting(_seconds(goal.time))


def _assisted_teleop(
    goal: Any, params: BehaviorParams, collision: CollisionCheck
) -> Behavior | BehaviorEnd:
    return runner.AssistedTeleop(params, collision, _allowance_s(goal))


def _allowance_s(goal: Any) -> float:
    return _seconds(goal.time_allowance)


def _seconds(duration: Any) -> float:
    return Duration.from_msg(duration).nanoseconds / 1e9


def _duration(seconds: float) -> Any:
    return Duration(seconds=seconds).to_msg()


BEHAVIOR_ACTIONS = (
    BehaviorAction(
        action=Spin,
        name="spin",
        behavior=_spin,
        feedback=lambda angle: {"angular_distance_traveled": angle},
    ),
    BehaviorAction(
        action=BackUp,
        name="backup",
        behavior=_back_up,
        feedback=lambda metres: {"distance_traveled": metres},
    ),
    BehaviorAction(
        action=DriveOnHeading,
        name="drive_on_heading",
        behavior=_drive_on_heading,
        feedback=lambda metres: {"distance_traveled": metres},
    ),
    BehaviorAction(
        action=Wait,
        name="wait",
        behavior=_wait,
        feedback=lambda left_s: {"time_left": _duration(left_s)},
        output="",
    ),
    BehaviorAction(
        action=AssistedTeleop,
        name="assisted_teleop",
        behavior=_assisted_teleop,
        feedback=lambda elapsed_s: {"current_teleop_duration": _duration(elapsed_s)},
        output=topics.CMD_VEL_ASSISTED.name,
    ),
)
