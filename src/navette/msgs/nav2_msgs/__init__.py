"""Interfaces of nav2_msgs."""
