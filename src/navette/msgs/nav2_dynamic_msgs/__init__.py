"""Interfaces of nav2_dynamic_msgs."""
