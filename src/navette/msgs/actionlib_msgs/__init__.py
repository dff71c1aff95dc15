"""Interfaces of actionlib_msgs."""
