"""Navette's ``launch_ros``."""

__all__ = []
