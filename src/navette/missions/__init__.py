"""What to do next: goals in order, and what became of each."""

from navette.missions.params import MissionParams
from navette.missions.sequence import GoalOutcome, GoalSequence, PlannerReport

__all__ = ["GoalSequence", "GoalOutcome", "PlannerReport", "MissionParams"]
