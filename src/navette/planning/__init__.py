"""How to get there: searches on the grid, and paths that the body can drive."""

from navette.planning.navigator import Navigator
from navette.planning.outcome import Outcome
from navette.planning.params import PlannerParams
from navette.planning.planner import Goal, Plan, Planner
from navette.planning.reports import Phase, Report, RobotState, State

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
