"""Test tools: a graph of nodes in virtual time, without sleeps."""

from navette.testing.harness import GraphHarness, Probe

__all__ = ["GraphHarness", "Probe"]
