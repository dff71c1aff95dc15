"""Interfaces of slam_toolbox."""
