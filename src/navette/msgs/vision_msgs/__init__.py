"""Interfaces of vision_msgs."""
