"""Servers that several stages offer under their own names."""
