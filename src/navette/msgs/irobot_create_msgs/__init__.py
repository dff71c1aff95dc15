"""Interfaces of irobot_create_msgs."""
