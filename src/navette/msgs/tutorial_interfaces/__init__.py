"""Interfaces of tutorial_interfaces."""
