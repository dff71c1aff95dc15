"""Interfaces of service_msgs."""
