"""Interfaces of statistics_msgs."""
