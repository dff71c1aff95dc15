"""Test tools: a graph of nodes in virtual time, without sleeps."""

from navette.runtime.testing.goal_probe import GoalProbe
from navette.runtime.testing.harness import GraphHarness, Probe

__all__ = ["GoalProbe", "GraphHarness", "Probe"]
