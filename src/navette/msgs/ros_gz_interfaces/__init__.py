"""Interfaces of ros_gz_interfaces."""
