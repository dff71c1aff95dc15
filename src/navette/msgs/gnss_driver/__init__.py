"""Interfaces of gnss_driver."""
