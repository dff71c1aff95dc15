"""Servers of the planner node: Nav2's actions and services."""
