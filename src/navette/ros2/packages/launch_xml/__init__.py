"""Navette's ``launch_xml``."""
