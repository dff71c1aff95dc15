"""What to do next: goals in order, and what became of each."""

from navette.navigation.missions.params import MissionParams
from navette.navigation.missions.sequence import (
    GoalOutcome,
    GoalSequence,
    PlannerReport,
)

__all__ = ["GoalSequence", "GoalOutcome", "PlannerReport", "MissionParams"]
