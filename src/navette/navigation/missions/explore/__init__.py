"""Exploration of an unknown world by frontiers."""
