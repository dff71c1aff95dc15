"""Interfaces of gazebo_msgs."""
