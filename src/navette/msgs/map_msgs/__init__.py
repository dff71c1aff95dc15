"""Interfaces of map_msgs."""
