"""Navette's ``launch_yaml``."""
