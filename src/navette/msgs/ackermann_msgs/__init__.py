"""Interfaces of ackermann_msgs."""
