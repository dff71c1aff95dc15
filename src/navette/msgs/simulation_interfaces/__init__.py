"""Interfaces of simulation_interfaces."""
