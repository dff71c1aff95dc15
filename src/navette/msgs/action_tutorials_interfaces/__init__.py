"""Interfaces of action_tutorials_interfaces."""
