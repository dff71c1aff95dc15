"""Interfaces of composition_interfaces."""
