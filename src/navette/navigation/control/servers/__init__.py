"""Servers of the control node: Nav2's actions."""
