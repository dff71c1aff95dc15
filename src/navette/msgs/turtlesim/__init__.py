"""Interfaces of turtlesim."""
