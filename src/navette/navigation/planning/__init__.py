"""Planning: grid searches, and paths that the footprint can drive."""

from navette.navigation.planning import astar, breadth_first, dijkstra
from navette.navigation.planning.navigator import Navigator
from navette.navigation.planning.new_map import NewMap
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.planner import Goal, Plan, Planner
from navette.navigation.planning.reports import (
    NavigatorReport,
    Phase,
    RobotMotion,
    State,
)

__all__ = [
    "PlannerParams",
    "Planner",
    "Goal",
    "Plan",
    "NewMap",
    "Outcome",
    "Navigator",
    "RobotMotion",
    "NavigatorReport",
    "Phase",
    "State",
]
