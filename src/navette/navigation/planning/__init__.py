"""How to get there: searches on the grid, and paths that the body can drive."""

from navette.navigation.planning.navigator import Navigator
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.planner import Goal, Plan, Planner
from navette.navigation.planning.reports import Phase, Report, RobotState, State

__all__ = [
    "PlannerParams",
    "Planner",
    "Goal",
    "Plan",
    "Outcome",
    "Navigator",
    "RobotState",
    "Report",
    "Phase",
    "State",
]
