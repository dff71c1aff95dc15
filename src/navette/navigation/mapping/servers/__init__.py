"""Servers of the map memory node: Nav2's map services."""
