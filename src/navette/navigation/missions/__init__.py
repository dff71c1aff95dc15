"""Missions: goals in order, and their results."""

from navette.navigation.missions.params import MissionParams
from navette.navigation.missions.sequence import (
    TIMED_OUT,
    GoalOutcome,
    GoalSequence,
    PlannerReport,
)

__all__ = [
    "GoalSequence",
    "GoalOutcome",
    "PlannerReport",
    "MissionParams",
    "TIMED_OUT",
]
