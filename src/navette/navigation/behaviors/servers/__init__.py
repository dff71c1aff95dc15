"""Servers of the behaviors node: Nav2's actions."""
