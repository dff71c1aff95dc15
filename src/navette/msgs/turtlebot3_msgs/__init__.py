"""Interfaces of turtlebot3_msgs."""
