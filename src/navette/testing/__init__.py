"""Test tools: a graph of nodes in virtual time, without sleeps."""

from navette.testing.goal_probe import GoalProbe
from navette.testing.harness import GraphHarness, Probe

__all__ = ["GoalProbe", "GraphHarness", "Probe"]
