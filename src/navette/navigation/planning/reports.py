"""Inputs and outputs of the navigator."""

import math
from dataclasses import dataclass
from enum import StrEnum

from navette.geometry import Pose2
from navette.navigation.planning.outcome import Outcome


class State(StrEnum):
    """State of the planner."""

    WAITING_FOR_GOAL = "waiting_for_goal"
    WAITING_FOR_ROBOT = "waiting_for_robot_to_reach_goal"


class Phase(StrEnum):
    """Activity of the planner; a failure is reported by its own name instead."""

    WAITING_FOR_GOAL = "waiting_for_goal"
    WAITING_FOR_MAP = "waiting_for_map"
    WAITING_FOR_ODOMETRY = "waiting_for_odometry"
    LOCALIZING = "localizing"
    PLANNING = "planning"
    FOLLOWING = "following"
    PAUSED = "paused"
    REACHED = "reached"


@dataclass(frozen=True)
class RobotMotion:
    """Pose in the map frame and velocity (m/s, rad/s)."""

    pose: Pose2
    speed_mps: float
    turn_rate_radps: float

    @property
    def is_stationary(self) -> bool:
        return abs(self.speed_mps) < 0.02 and abs(self.turn_rate_radps) < 0.05


@dataclass(frozen=True)
class NavigatorReport:
    """Status of the navigator.

    Attributes:
        message: phase, or the named failure.
        goal_id: number of goals received so far.
        retry: how often the same goal was received again after it had failed, as
            recoveries of the behaviour tree do.
        result: how the goal ended; empty until then.
        plan: outcome of the newest plan; empty before the first.
        replans: number of plans for this goal after the first.
        fault: error of a user's method that ended the goal.
    """

    message: str = Phase.WAITING_FOR_GOAL
    state: State = State.WAITING_FOR_GOAL
    goal_id: int = 0
    retry: int = 0
    goal_x: float = math.nan
    goal_y: float = math.nan
    distance_left_m: float = 0.0
    result: str = ""
    plan: str = ""
    margin_m: float = math.nan
    replans: int = 0
    fault: str = ""

    def followed_by(self, goal_x: float, goal_y: float) -> "NavigatorReport":
        """Return the first report of the next goal."""
        same = (goal_x, goal_y) == (self.goal_x, self.goal_y)
        again = same and self.failed and self.message != Outcome.CANCELED
        return NavigatorReport(
            goal_id=self.goal_id + 1,
            retry=self.retry + 1 if again else 0,
            goal_x=goal_x,
            goal_y=goal_y,
        )

    @property
    def failed(self) -> bool:
        """Whether the message names a failure."""
        return self.message in set(Outcome)
